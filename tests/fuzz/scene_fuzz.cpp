// SPDX-License-Identifier: MIT
// Any text is a scene of the program `weave`, or is refused: by std::invalid_argument alone.
#include "scratch.hpp"

#include "../../examples/weave/scene_file.hpp"

#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        weave::read_scene(fuzz::file_of(data, size));
    } catch (const std::invalid_argument&) {
    }
    return 0;
}

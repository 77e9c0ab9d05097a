// SPDX-License-Identifier: MIT
// Any bytes are a saved system, or are refused: by std::invalid_argument alone.
#include "scratch.hpp"

#include <fibrant/solver/saved_system.hpp>

#include <stdexcept>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    try {
        const fibrant::solver::SavedSystem system(fuzz::file_of(data, size));
        fibrant::Vector x = fibrant::Vector::Ones(system.layout().unknowns()), y(x.size());
        system.apply(x, y);
    } catch (const std::invalid_argument&) {
    }
    return 0;
}

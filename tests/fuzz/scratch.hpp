// SPDX-License-Identifier: MIT
#pragma once
// Bytes of a fuzzer as a file, for readers that take a path.
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <unistd.h>

namespace fuzz {

/// A file of this process, written anew for each input.
inline std::string file_of(const std::uint8_t* data, std::size_t size, const void* more = nullptr, std::size_t more_size = 0) {
    static const std::string path =
        (std::filesystem::temp_directory_path() / ("fibrant_fuzz_" + std::to_string(getpid()))).string();
    std::FILE* file = std::fopen(path.c_str(), "wb");
    if (file == nullptr) return path;
    if (size > 0) std::fwrite(data, 1, size, file);
    if (more_size > 0) std::fwrite(more, 1, more_size, file);
    std::fclose(file);
    return path;
}

}  // namespace fuzz

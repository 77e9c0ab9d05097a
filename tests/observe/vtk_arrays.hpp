// SPDX-License-Identifier: MIT
#pragma once
/// @file Reads the arrays of a .vtp file.

#include <doctest/doctest.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace fibrant::test {

/// Values of a named array of a .vtp file, read by the rules of the format: a byte count, then the numbers, at its
/// offset behind the underscore.
template <class Number>
std::vector<Number> array_of(const std::string& file, const std::string& name, const std::string& after = "<Piece") {
    const std::size_t tag = file.find("Name=\"" + name + "\"", file.find(after));
    REQUIRE(tag != std::string::npos);
    const std::size_t at = file.find("offset=\"", tag) + 8;
    const std::size_t data = file.find("_", file.find("<AppendedData")) + 1 + std::stoul(file.substr(at));
    std::uint64_t bytes = 0;
    std::memcpy(&bytes, file.data() + data, sizeof bytes);
    std::vector<Number> values(bytes / sizeof(Number));
    std::memcpy(values.data(), file.data() + data + sizeof bytes, bytes);
    return values;
}

}  // namespace fibrant::test

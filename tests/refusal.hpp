// SPDX-License-Identifier: MIT
#pragma once
/// @file What a refusal of wrong input says.

#include <stdexcept>
#include <string>

namespace fibrant::test {

/// Message of the std::invalid_argument that `build` throws; empty if it throws none.
template <class Build>
std::string refusal(const Build& build) {
    try {
        build();
    } catch (const std::invalid_argument& error) {
        return error.what();
    }
    return {};
}

}  // namespace fibrant::test

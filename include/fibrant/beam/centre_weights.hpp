// SPDX-License-Identifier: MIT
#pragma once
/// @file A particle of the centreline of a beam whose nodes have more than a position.

#include <array>
#include <cstddef>

namespace fibrant::beam {

/// One scalar for the position of each node of an element; its other vectors, `Vectors` a node with the position, have none.
template <int Nodes, int Vectors>
struct CentreWeights {
    static constexpr int stride = Vectors;  ///< from one weighted vector of the element to the next
    std::array<double, static_cast<std::size_t>(Nodes)> weight{};

    constexpr std::size_t size() const noexcept { return weight.size(); }
    constexpr double operator[](std::size_t node) const noexcept { return weight[node]; }
    constexpr double back() const noexcept { return weight.back(); }
};

}  // namespace fibrant::beam

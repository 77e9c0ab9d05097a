// SPDX-License-Identifier: MIT
#pragma once
/// @file The numbers of the whole toolkit: double precision, columns of three components.

#include <fibrant/core/vectors.hpp>

#include <Eigen/SparseCore>

#include <cstddef>
#include <span>

namespace fibrant {

/// Compressed by columns, with the indices that solver libraries take.
using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

}  // namespace fibrant

namespace fibrant::core {

/// Container index from a signed one; the sign was checked where the index was made.
template <class I>
constexpr std::size_t at(I index) noexcept {
    return static_cast<std::size_t>(index);
}

/// Signed size of a container.
template <class Container>
constexpr Index count(const Container& container) noexcept {
    return static_cast<Index>(container.size());
}

/// Asks for what a loop will read some steps ahead, from where no order says: a hint, of which nothing depends.
inline void prefetch([[maybe_unused]] const void* address) noexcept {
#if defined(__GNUC__)
    __builtin_prefetch(address);
#endif
}

}  // namespace fibrant::core

// SPDX-License-Identifier: MIT
#pragma once
/// @file The model of bundles in tests of compositions, strands, ropes and mats: one, which is compiled once.

#include <support/models.hpp>

#include <fibrant/solver/float_block_cholesky.hpp>

namespace fibrant::test {

/// Friction, and plates where there are some, solved directly.
struct Bundle : RoughPressing {
    using Solver = solver::FloatBlockCholesky;
};

}  // namespace fibrant::test

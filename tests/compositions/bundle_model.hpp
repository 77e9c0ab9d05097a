// SPDX-License-Identifier: MIT
#pragma once
/// @file The model of bundles in tests of compositions, strands, ropes and mats.

#include <support/models.hpp>

namespace fibrant::test {

/// Friction, and plates where there are some; solved by `bundle_solver`.
using Bundle = EveryDirector;
inline constexpr const char* bundle_solver = "float_block_cholesky";

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Relative comparison of numbers of any size.

#include <doctest/doctest.h>

#include <limits>

namespace fibrant::test {

/// Within `tolerance` of the greater magnitude. `doctest::Approx` by itself adds 1 to that, and small numbers pass with any sign.
/// An expected 0 is met by 0 alone: what is 0 but for rounding is compared with a size of its own, `std::abs(x) < tolerance *
/// size`.
/// @param tolerance  relative [1]; left out: the rounding of a few thousand operations
inline doctest::Approx near(double expected, double tolerance = 1e-12) {
    return doctest::Approx(expected).epsilon(tolerance).scale(std::numeric_limits<double>::min());
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Relative comparison of numbers of any size.

#include <doctest/doctest.h>

#include <limits>

namespace fibrant::test {

/// Within `tolerance` of the greater magnitude. `doctest::Approx` by itself adds 1 to that, and small numbers pass with any sign. What should be 0 is
/// compared with a size of its own.
/// @param tolerance  relative [1]; left out: that of Approx
inline doctest::Approx near(double expected, double tolerance = 100.0 * static_cast<double>(std::numeric_limits<float>::epsilon())) {
    return doctest::Approx(expected).epsilon(tolerance).scale(0.0);
}

}  // namespace fibrant::test

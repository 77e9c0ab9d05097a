// SPDX-License-Identifier: MIT
// Two rods wound around each other twice as far, against Kirchhoff's rods on helices.
#include "wound_rods.hpp"

#include <doctest/doctest.h>

namespace two_ply_test {

TEST_CASE("two rods wound around each other on and on resist with the torque of Kirchhoff's helices") {
    check_wound({1.25, 2.5});
}

}  // namespace two_ply_test

// SPDX-License-Identifier: MIT
// Two rods wound around each other from straight ones, against Kirchhoff's rods on helices (two_ply.json).
#include "wound_rods.hpp"

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace two_ply_test {

TEST_CASE("the theory of this test is that of the table") {
    struct Case {
        double force, angle_deg;
        bool turns;
        double torque, line_load;
    };
    for (const Case& c :
         {Case{0.02, 5, true, 0.0063064829267596, 0.0053281152918279}, Case{0.02, 10, true, 0.01273412534829, 0.039413893657012},
          Case{0.02, 20, true, 0.026364268863612, 0.42584245045376}, Case{0.02, 35, true, 0.049475912022965, 3.0782172531535},
          Case{0.02, 10, false, 0.0010460338279923, 0.12001599544318}}) {
        const double angle = c.angle_deg * pi / 180.0;
        const two_ply::HelixTheory theory(rods(c.force, 1.0, 10), angle, r,
                                          c.turns ? std::sin(angle) * std::cos(angle) / r : 0.0);
        CHECK(std::abs(theory.torque / c.torque - 1.0) < 1e-10);
        CHECK(std::abs(theory.line_load / c.line_load - 1.0) < 1e-10);
    }
}

TEST_CASE("two rods wound around each other resist with the torque of Kirchhoff's helices") { check_wound({1.25}); }

TEST_CASE("a ply without a pull that is known is refused by name") {
    two_ply::TwoPlyParameters parameters = rods(0.02, 1.2, 40);
    parameters.force = core::unset;
    CHECK(test::refusal([&] { two_ply::straight_rods(parameters); }) ==
          "TwoPlyParameters.force = nan, but it must be finite and >= 0");
}

}  // namespace two_ply_test

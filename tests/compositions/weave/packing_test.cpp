// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/compositions/weave/packing.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace fibrant;

namespace packing_test {

using namespace fibrant::compositions::weave;

TEST_CASE("7, 19, 37 and 61 fibres are full hexagons") {
    for (const Index rings : {1, 2, 3, 4}) {
        const Index fibres = 1 + 3 * rings * (rings + 1);
        const Packing packing = compact_packing(fibres, 1.0, 1.0, 0.0);
        REQUIRE(core::count(packing.centres) == fibres);
        const auto m = static_cast<double>(rings);
        CHECK(packing.width == test::near(4.0 * m + 2.0, 1e-12));
        CHECK(packing.thickness == test::near(2.0 * std::sqrt(3.0) * m + 2.0, 1e-12));
        // Inside the hexagon: at most `rings` pitches from the centre along each of its three normals.
        for (const auto& c : packing.centres)
            for (const double angle : {0.0, 60.0, 120.0}) {
                const double a = (angle + 30.0) * std::numbers::pi / 180.0;
                CHECK(std::abs(c.x() * std::cos(a) + c.y() * std::sin(a)) <= std::sqrt(3.0) * m + 1e-12);
            }
    }
}

TEST_CASE("neighbours are one pitch apart, never closer, and the section is centred and symmetric") {
    for (const Index fibres : {1, 2, 3, 5, 6, 18, 19, 20, 76}) {
        for (const double aspect : {1.0, 1.7, 2.5, 6.0}) {
            const Packing packing = compact_packing(fibres, 0.02, aspect, 0.01);
            const auto& centres = packing.centres;
            double closest = 1.0;
            Eigen::Vector2d sum = Eigen::Vector2d::Zero();
            for (std::size_t a = 0; a < centres.size(); ++a) {
                sum += centres[a];
                bool mirrored = false;
                for (std::size_t b = 0; b < centres.size(); ++b) {
                    if (a != b) closest = std::min(closest, (centres[a] - centres[b]).norm());
                    mirrored = mirrored || (centres[a] + centres[b]).norm() < 1e-12;
                }
                CHECK(mirrored);
            }
            CHECK(sum.norm() < 1e-12);
            if (fibres > 1) CHECK(closest == test::near(2.0 * 0.02 * 1.01, 1e-12));
        }
    }
}

TEST_CASE("the outline has the aspect that is asked for, to a pitch in each direction") {
    for (const double aspect : {1.0, 2.0, 2.5, 4.0}) {
        const Packing packing = compact_packing(400, 1.0, aspect, 0.0);
        // An ellipse of that aspect which holds 400 cells of a hexagonal lattice.
        const double thickness = std::sqrt(4.0 / std::numbers::pi * 400.0 * 2.0 * std::sqrt(3.0) / aspect);
        CHECK(std::abs(packing.thickness - thickness) < 2.0);
        CHECK(std::abs(packing.width - aspect * thickness) < 2.0 * aspect);
    }
}

TEST_CASE("no site that was left out lies nearer to the centre than one that was taken") {
    const double aspect = 2.5;
    const Packing packing = compact_packing(76, 1.0, aspect, 0.0);
    const auto metric = [&](double x, double y) { return x * x / (aspect * aspect) + y * y; };
    double farthest = 0.0;
    for (const auto& c : packing.centres) farthest = std::max(farthest, metric(c.x(), c.y()));
    Index nearer = 0;
    for (int row = -20; row <= 20; ++row)
        for (int k = -40; k <= 40; ++k) {
            const double x = 2.0 * k + (row % 2 == 0 ? 1.0 : 0.0), y = std::sqrt(3.0) * row;
            if (metric(x, y) < farthest - 1e-9) ++nearer;
        }
    CHECK(nearer < 76);  // all of them taken, and at least one at the farthest distance
}

TEST_CASE("a packing that cannot be is refused by field, value and bound") {
    using test::refusal;
    CHECK(refusal([] { compact_packing(0, 1.0, 1.0, 0.0); }) == "compact_packing.fibres = 0, but it must be >= 1");
    CHECK(refusal([] { compact_packing(7, -1.0, 1.0, 0.0); }) == "compact_packing.radius = -1, but it must be finite and > 0");
    CHECK(refusal([] { compact_packing(7, 1.0, 0.5, 0.0); }) == "compact_packing.aspect = 0.5, but it must be finite and >= 1");
    CHECK(refusal([] { compact_packing(7, 1.0, 1.0, -0.1); }) == "compact_packing.gap = -0.1, but it must be finite and >= 0");
}

}  // namespace packing_test

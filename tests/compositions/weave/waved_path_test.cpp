// SPDX-License-Identifier: MIT
// Tows that begin over and under each other: as long as their fibres, as high as their pattern says, and no worse a start.
#include "near.hpp"
#include "small_weave.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/compositions/weave/measures.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace waved_path_test {

namespace cloth = fibrant::compositions::weave;

using Model = test::SmallWeave;
using test::small_fabric;

TEST_CASE("a waved path is as long as its fibre and passes where its tow is said to") {
    const double a = 0.2, p = 0.9;
    const cloth::TowWave wave{{-0.5 * p, 0.5 * p}, {a, -a}, {0.0, 0.0}, p, 1.25, cloth::nested(1.25)};
    const Eigen::Vector2d offset(0.3, 0.1);
    const cloth::WavedPath path(wave, offset, 3.0);
    Vec3 last = path.at(0.0);
    const int steps = 2000;
    double length = 0.0, least = 1.0, most = 0.0;
    for (int k = 1; k <= steps; ++k) {
        const Vec3 next = path.at(static_cast<double>(k) / steps);
        const double piece = (next - last).norm();
        length += piece, least = std::min(least, piece), most = std::max(most, piece), last = next;
    }
    CHECK(length == test::near(3.0, 1e-5));  // chords are shorter by (step kappa)^2 / 24
    CHECK(most == test::near(least, 1e-4));  // equal arcs
    CHECK(path.at(0.5).x() == 0.0);
    const auto height = [&](double x) { return wave.at(x, Eigen::Vector2d::Zero()); };
    CHECK(height(-0.5 * p).height == test::near(a, 1e-14));
    CHECK(height(0.5 * p).height == test::near(-a, 1e-14));
    CHECK(height(0.0).height_slope == test::near(-a * std::numbers::pi / p, 1e-14));
    CHECK(path.at(1.0).y() == test::near(offset.x(), 1e-14));  // beyond reach, as packed
    CHECK(wave.at(0.0, offset).across == test::near(1.25 * offset.x(), 1e-14));
    // Neighbours in two rows touch before and after: (spread r)^2 + h^2 = (2 r)^2.
    CHECK(std::hypot(1.25, std::sqrt(3.0) * cloth::nested(1.25)) == test::near(2.0, 1e-14));
    // Of a shallow wave the crimp is a quarter of its greatest slope squared.
    const cloth::WavedPath flat({{-0.5 * p, 0.5 * p}, {1e-2 * p, -1e-2 * p}, {1e-2 * p, -1e-2 * p}, p}, {0.0, 0.0}, p);
    const double slope = 1e-2 * std::numbers::pi;
    CHECK(p / (flat.ends()[1] - flat.ends()[0]) - 1.0 == test::near(0.25 * slope * slope, 1e-3));
}

TEST_CASE("tows begin waved where they are thick and can be, and say why where they cannot") {
    cloth::FabricParameters fabric = small_fabric();
    cloth::SettleParameters settle;
    CHECK_FALSE(cloth::begins_waved(fabric, settle));  // thin: flat ones part as fast
    settle.start = cloth::Start::waved;
    fabric.elements = 24;
    CHECK(cloth::no_wave(fabric) == "");
    CHECK(cloth::begins_waved(fabric, settle));
    fabric.elements = 8;
    CHECK_THROWS_WITH(cloth::begins_waved(fabric, settle), doctest::Contains("elements between crossings, for 4"));
}

TEST_CASE("a fabric that begins waved comes to the rest of a flat one, with a clean audit") {
    cloth::FabricParameters fabric = small_fabric();
    fabric.elements = 24;
    std::array<double, 2> crimp{};
    for (const cloth::Start start : {cloth::Start::flat, cloth::Start::waved}) {
        cloth::SettleParameters settle;
        settle.start = start;
        const bool waved = cloth::begins_waved(fabric, settle);
        simulation::Simulator<Model> simulator(cloth::unsettled_fabric(fabric, settle),
                                               cloth::model_parameters<Model>(fabric, settle));
        const simulation::Report report = simulator.run(cloth::settling<Model>(fabric, settle, waved));
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const double r = cloth::smallest_radius(fabric);
        const observe::Snapshot snapshot = simulator.snapshot();
        CHECK(cloth::audit(snapshot, fabric, proximity::GridSearch()).clean(settle.allowed_penetration_over_radius * r));
        crimp[waved ? 1 : 0] = cloth::crimp_measures(snapshot, fabric).warp;
        std::printf("%s: %td increments, %td Newton iterations, crimp %.5f\n", waved ? "waved" : "flat",
                    core::count(report.increments), report.counts.newton, crimp[waved ? 1 : 0]);
    }
    CHECK(crimp[1] == test::near(crimp[0], 0.02));
}

}  // namespace waved_path_test

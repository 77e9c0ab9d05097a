// SPDX-License-Identifier: MIT
// Work of holds that turn sections by many degrees an increment: that of couples over their angles, not of forces on chords.
#include "simulation/scenes.hpp"

#include <doctest/doctest.h>
#include <near.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace turned_work_test {

using simulation::Report;
using simulation::Simulator;
using test::Rod;

constexpr double degree = std::numbers::pi / 180.0;

struct Turned {
    Rod rod;
    scene::Assembly assembly;
    explicit Turned(Index elements = 8) {
        rod.radius = 0.02, rod.elements = elements;
        assembly.add(rod.specification());
    }
    template <simulation::Model M>
    Report run(double amplitude, Index increments) {
        Simulator<M> simulator(assembly, test::tight_parameters<M>(rod.radius));
        simulation::Loading<M> loading;
        loading.stages.resize(1);
        loading.stages[0].ramps = {{"motion", amplitude}}, loading.stages[0].increments = increments;
        const Report report = simulator.run(loading);
        REQUIRE_MESSAGE(report.converged, report.reason);
        return report;
    }
};

TEST_CASE("a rod twisted by 36 degrees an increment takes the work of its torque, G J angle^2 / 2 L") {
    Turned twisted;
    twisted.assembly.clamp(scene::first_end(0));
    twisted.assembly.hold_rotation(scene::last_end(0), Vec3(0, 0, 36 * degree));
    const double angle = 180 * degree, radius = twisted.rod.radius, shear = 0.5 * twisted.rod.young / (1 + twisted.rod.poisson);
    const double stored = 0.5 * shear * 0.5 * std::numbers::pi * std::pow(radius, 4) * angle * angle / twisted.rod.length;
    const Report report = twisted.run<test::Smooth>(5.0, 5);
    std::printf("twisted by 5 x 36 degrees: %d increments, work %.6f of theory, missing %.1e\n",
                static_cast<int>(report.increments.size()), report.energy.external / stored, report.energy.error() / stored);
    REQUIRE(report.increments.size() == 5);
    // On chords a fifteenth is missing, 1 - sin(36 degrees) / (36 degrees) = 0.0645.
    CHECK(report.energy.external == test::near(stored, 2e-3));  // (r t)^2 of the finite twist, 1e-3
    CHECK(std::abs(report.energy.error()) < 1e-4 * stored);     // torque grows evenly but for (r t)^2, over increments squared
}

TEST_CASE("a rod bent by its ends, which go around on arcs, takes the work of its moment, E I angle^2 / 2 L") {
    double missing[2];
    for (const Index increments : {4, 8}) {
        Turned bent(16);
        const double length = bent.rod.length, angle = 120 * degree;
        bent.assembly.clamp(scene::first_end(0));
        scene::Hold hold;
        hold.at = scene::last_end(0);
        hold.path = [=](double a) {
            const double radius = length / (a * angle + 1e-300);
            return a == 0.0 ? Vec3(Vec3::Zero())
                            : Vec3(radius * (1 - std::cos(a * angle)), 0, radius * std::sin(a * angle) - length);
        };
        bent.assembly.hold(hold);
        bent.assembly.hold_rotation(scene::last_end(0), Vec3(0, angle, 0));
        const double stored = 0.5 * bent.rod.bending_stiffness() * angle * angle / length;
        const Report report = bent.run<test::Smooth>(1.0, increments);
        double& missed = missing[increments == 4 ? 0 : 1];
        missed = report.energy.error() / stored;
        std::printf("bent by %d x %g degrees: work %.6f of theory, missing %.1e\n", static_cast<int>(increments),
                    120.0 / static_cast<double>(increments), report.energy.external / stored, missed);
        REQUIRE(report.increments.size() == static_cast<std::size_t>(increments));
        CHECK(report.energy.external == test::near(stored, 1e-3));  // no shear, so but for what elements miss
        CHECK(std::abs(missed) < 2e-4);  // on chords 0.046 and 0.011 of the moment, (angle of an increment)^2 / 6
    }
    CHECK(missing[0] / missing[1] == test::near(4.0, 0.1));  // of second order
}

TEST_CASE("a stretched rod that is turned as a whole takes no work, and keeps what it stores") {
    Turned turned;
    const Vec3 pivot(0.3, -0.2, 0.5), angle = 150 * degree * Vec3(0.6, 0, 0.8);
    turned.assembly.clamp(scene::first_end(0), Vec3::Zero(), angle, pivot);
    scene::Hold hold;  // 0.4 % further than it is long, turned about the same axis
    hold.at = scene::last_end(0), hold.pivot = pivot;
    hold.rotation = [=](double a) { return core::turn_about(angle.normalized(), a * angle.norm()); };
    hold.path = [=](double a) { return Vec3(hold.rotation(a) * Vec3(0, 0, 0.004 * turned.rod.length)); };
    turned.assembly.hold(hold);
    turned.assembly.hold_rotation(scene::last_end(0), angle);
    Simulator<test::Smooth> simulator(turned.assembly, test::tight_parameters<test::Smooth>(turned.rod.radius));
    const auto turn_to = [&](double amplitude, Index increments) {
        simulation::Loading<test::Smooth> loading;
        loading.stages.resize(1);
        loading.stages[0].ramps = {{"motion", amplitude}}, loading.stages[0].increments = increments;
        const Report report = simulator.run(loading);
        REQUIRE_MESSAGE(report.converged, report.reason);
        return report.energy;
    };
    const auto stretched = turn_to(1e-12, 1), there = turn_to(1.0, 4);
    const double stored = stretched.elastic, work = there.external - stretched.external;
    std::printf("turned by 4 x 37.5 degrees: stored %.1e more, work %.1e of what is stored\n", there.elastic / stored - 1.0,
                work / stored);
    REQUIRE(stored > 0.0);
    CHECK(there.elastic == test::near(stored, 1e-7));
    CHECK(std::abs(work) < 1e-6 * stored);
}

}  // namespace turned_work_test

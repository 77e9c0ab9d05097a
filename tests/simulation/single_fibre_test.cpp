// SPDX-License-Identifier: MIT
// One fibre through the whole simulator, against reference solutions of the same director rod that were found without
// finite elements (boundary-value problems, and the closed form of the uniform curve).
#include "simulation/scenes.hpp"

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace single_fibre_test {

using test::Rod;
using test::Smooth;
using Simulator = simulation::Simulator<Smooth>;
using Loading = simulation::Loading<Smooth>;

TEST_CASE("a cantilever under P L^2 / EI = 5 reaches the elastica's tip in one load step") {
    struct Case {
        double slenderness, tip_x, tip_z, energy;  // results.director of end_force.json
    };
    for (const Case& c : {Case{100, 1.4351777145384, 1.2306021733469, 0.00052100158209165},
                          Case{1000, 14.347255281111, 12.308643485742, 5.207754794948e-05}}) {
        CAPTURE(c.slenderness);
        Rod rod;
        rod.length = c.slenderness * rod.radius;
        Simulator simulator(rod.pushed(5.0), test::tight_parameters<Smooth>(rod.radius));
        const simulation::Report report = simulator.run(Loading{.increments = 1});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const Vec3 tip = simulator.value(scene::last_end(0));
        const double error = std::hypot(tip.x() - c.tip_x, tip.z() - c.tip_z) / rod.length;
        std::printf("L/r = %g: tip off by %.1e L, energy by %.1e, %td Newton iterations\n", c.slenderness, error,
                    report.energy.elastic / c.energy - 1.0, report.counts.newton);
        CHECK(error < 1e-6);  // 32 node intervals
        CHECK(std::abs(tip.y()) < 1e-12 * rod.length);
        CHECK(report.rejected_increments == 0);
        CHECK(report.counts.newton <= 12);
        CHECK(report.energy.elastic == test::near(c.energy, 3e-6));  // of the same mesh
        // The clamp carries the force and its moment about the root.
        const Vec3 load(5.0 * rod.bending_stiffness() / (rod.length * rod.length), 0, 0);
        CHECK((simulator.reaction(scene::first_end(0)) + load).norm() < 1e-6 * load.norm());
        Vec3 moment = Vec3::Zero();
        for (const scene::NodeVector g : {scene::NodeVector::director_1, scene::NodeVector::director_2})
            moment += simulator.value(scene::first_end(0), g).cross(simulator.reaction(scene::first_end(0), g));
        CHECK((moment + tip.cross(load)).norm() < 1e-6 * tip.cross(load).norm());
    }
}

TEST_CASE("a moment rolls a fibre up into a full circle") {
    // results.director of end_moment.json, one turn: the uniform curve of the director rod.
    Rod rod;
    rod.elements = 32;
    scene::Assembly assembly = rod.clamped();
    // A moment about a fixed axis is not conservative out of the plane, and its symmetric tangent is indefinite there
    // beyond a quarter turn; the fibre is held in its plane, where the tangent is exact.
    for (Index node = 0; node <= 2 * rod.elements; ++node) {
        scene::Hold plane;
        plane.at = {0, static_cast<double>(node) / static_cast<double>(2 * rod.elements)};
        for (const scene::NodeVector vector :
             {scene::NodeVector::position, scene::NodeVector::director_1, scene::NodeVector::director_2}) {
            const Mat3 across = Vec3::UnitY() * Vec3::UnitY().transpose();
            plane.vector = vector;
            plane.directions = vector == scene::NodeVector::director_2 ? Mat3(Mat3::Identity() - across) : across;
            assembly.hold(plane);
        }
    }
    const double moment = 2.0 * std::numbers::pi * rod.bending_stiffness() / rod.length;
    assembly.apply(scene::Moment{scene::last_end(0), scene::NodeVector::director_1, Vec3(0, moment, 0), "load"});
    Simulator simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
    const simulation::Report report = simulator.run(Loading{.increments = 12});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(report.rejected_increments == 0);
    const Vec3 tip = simulator.value(scene::last_end(0)), middle = simulator.value({0, 0.5});
    const double error = std::hypot(tip.x() - 4.865978569204e-05, tip.z() - 0.0055697776239427) / rod.length;
    std::printf("one turn: tip off by %.1e L, %td Newton iterations, energy balance %.1e\n", error, report.counts.newton,
                report.energy.error() / report.energy.elastic);
    CHECK(error < 5e-6);  // 64 node intervals
    CHECK(std::hypot(middle.x() - 0.63757367934751, middle.z() + 0.0027849950877388) < 5e-6 * rod.length);
    // The director turns by 30 degrees an increment, and the trapezoid takes chords for arcs.
    CHECK(std::abs(report.energy.error()) < 0.05 * report.energy.elastic);
}

TEST_CASE("a fibre whose clamp turns by 90 degrees turns with it and stays free of stress") {
    Rod rod;
    scene::Assembly assembly;
    const Vec3 pivot(0.3, 0.1, -0.2), turn(0, 0.5 * std::numbers::pi, 0);
    assembly.clamp(scene::first_end(assembly.add(rod.specification())), Vec3::Zero(), turn, pivot);
    Simulator simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
    const simulation::Report report = simulator.run(Loading{.increments = 6});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const Mat3 rotation(Eigen::AngleAxisd(turn.norm(), turn.normalized()));
    const Vector& rest = simulator.mesh().rest_state();
    double worst = 0.0;
    for (Index v = 0; v < rest.size() / 3; ++v) {
        const Vec3 start = rest.segment<3>(3 * v);
        const Vec3 expected = v % 3 == 0 ? Vec3(pivot + rotation * (start - pivot)) : Vec3(rotation * start);
        worst = std::max(worst, (simulator.state().segment<3>(3 * v) - expected).norm());
    }
    std::printf("turned clamp: off by %.1e, energy %.1e EI/L, %td Newton iterations\n", worst,
                report.energy.elastic / (rod.bending_stiffness() / rod.length), report.counts.newton);
    CHECK(worst < 1e-8 * rod.length);
    CHECK(report.energy.elastic < 1e-12 * rod.bending_stiffness() / rod.length);
    CHECK(std::abs(report.energy.external) < 1e-9 * rod.bending_stiffness() / rod.length);
}

TEST_CASE("the work of the loads is the energy stored, within the order of the trapezoidal rule") {
    const Rod rod;
    const auto error = [&](const scene::Assembly& assembly, Index increments) {
        Simulator simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
        const simulation::Report report = simulator.run(Loading{.increments = increments});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        REQUIRE(report.rejected_increments == 0);
        REQUIRE(report.energy.dissipated == 0.0);
        return std::abs(report.energy.error()) / report.energy.elastic;
    };
    // A dead force, and the other end led aside, where the work is that of the reactions.
    scene::Assembly led = rod.clamped();
    scene::Hold aside;  // free along the fibre, or it would be pressed before it bends
    aside.at = scene::last_end(0);
    aside.directions = Vec3::UnitX() * Vec3::UnitX().transpose();
    aside.displacement = Vec3(0.7 * rod.length, 0, 0);
    led.hold(aside);
    for (const scene::Assembly& assembly : {rod.pushed(5.0), led}) {
        const double coarse = error(assembly, 8), middle = error(assembly, 16), fine = error(assembly, 32);
        std::printf("energy balance off by %.1e %.1e %.1e in 8 16 32 increments\n", coarse, middle, fine);
        CHECK(fine < 1e-3);
        CHECK(coarse / middle == test::near(4.0, 0.15));
        CHECK(middle / fine == test::near(4.0, 0.08));
    }
}

TEST_CASE(
    "a half ring that is opened stays in its plane and symmetric, however its directors stand, if its ends keep their shape") {
    const double r = 0.05, ring = 20.0 * r, pi = std::numbers::pi;
    for (const bool shape : {false, true}) {
        scene::Assembly assembly;
        scene::FibreSpecification half;
        half.section = scene::circular(r), half.material = {1e4, 0.3}, half.elements = 20;
        half.curve = [=](double t) { return Vec3(-ring * std::cos(pi * t), 0.0, -ring * std::sin(pi * t)); };
        half.director = Vec3::UnitX() + 0.4 * Vec3::UnitY();  // oblique to the plane, by another angle than half a right one
        assembly.add(half);
        for (const double end : {0.0, 1.0}) {
            const Vec3 apart((end - 0.5) * 0.5 * ring, 0.0, 0.0);
            if (shape)
                assembly.clamp_section({0, end}, apart);
            else
                assembly.clamp({0, end}, apart);
        }
        Simulator simulator(assembly, test::tight_parameters<Smooth>(r));
        const simulation::Report report = simulator.run(Loading{.increments = 5});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        double aside = 0.0, uneven = 0.0;
        for (Index k = 0; k <= 2 * half.elements; ++k) {
            const double t = static_cast<double>(k) / static_cast<double>(2 * half.elements);
            const Vec3 one = simulator.value({0, t}), other = simulator.value({0, 1.0 - t});
            aside = std::max(aside, std::abs(one.y()) / r);
            uneven = std::max(uneven, Vec3(one.x() + other.x(), 0.0, one.z() - other.z()).norm() / r);
        }
        std::printf("half ring, %s: %.1e radii out of its plane, uneven by %.1e radii\n", shape ? "held in shape" : "clamped",
                    aside, uneven);
        if (shape) CHECK(aside < 1e-6);
        if (shape) CHECK(uneven < 1e-6);
        if (!shape) CHECK(aside > 1e-4);  // what a plain clamp does
    }
}

}  // namespace single_fibre_test

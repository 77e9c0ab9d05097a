// SPDX-License-Identifier: MIT
// What an accepted increment keeps: residual, depth of contact and sections as the parameters state them, turns that can be
// followed; and what the report says where a stage asks for less.
#include "simulation/scenes.hpp"

#include <fibrant/contact/contacts_with_tools.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

using namespace fibrant;

namespace acceptance_test {

using Pressing = test::EveryDirector;
using test::Smooth;

const double r = 0.02, pi = std::numbers::pi, young = 7300.0, poisson = 0.3;

struct Failures {
    std::vector<simulation::FailedAttempt> attempts{};
    void gave_up(const simulation::FailedAttempt& attempt) { attempts.push_back(attempt); }
};

scene::FibreSpecification fibre(const Vec3& from, const Vec3& to, Index elements) {
    return {.from = from, .to = to, .section = scene::circular(r), .material = {young, poisson}, .elements = elements};
}

TEST_CASE_TEMPLATE("a straight rod whose end is turned by any number of turns in one increment has the torque of all of them", M,
                   Smooth, test::EveryRod) {
    const double length = 400.0 * r, stiffness = young / (2.0 * (1.0 + poisson)) * 0.5 * pi * std::pow(r, 4);
    for (const double turns : {0.1, 0.25, 0.45, 0.55, 1.0, 1.5, -1.25}) {
        CAPTURE(turns);  // fewer than 1.86, where it buckles (Greenhill)
        scene::Assembly scene;
        scene.add(fibre(Vec3::Zero(), {length, 0, 0}, 20));
        scene.clamp(scene::first_end(0));
        scene::Hold turned;
        const double angle = 2.0 * pi * turns;
        turned.at = scene::last_end(0);
        scene.hold_position(scene::last_end(0));
        for (const auto vector : {scene::NodeVector::director_1, scene::NodeVector::director_2}) {
            turned.vector = vector;
            turned.rotation = [angle](double amplitude) { return Mat3(Eigen::AngleAxisd(amplitude * angle, Vec3::UnitX())); };
            scene.hold(turned);
        }
        auto parameters = test::model_parameters<M>(r);
        simulation::Simulator<M> simulator(scene, parameters);
        Failures failures;
        const simulation::Report report = simulator.run({.increments = 1}, failures);
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        // The twist is even, so what is stored tells the torque; of the director beam it is less by (r t)^2 (1 - nu) / (1 + nu).
        const double stored = simulator.equilibrium().elastic_energy(simulator.state()),
                     expected = 0.5 * stiffness * angle * angle / length;
        CHECK(std::abs(stored / expected - 1.0) < 3e-3);
        if (std::abs(turns) > 0.33) {
            REQUIRE_FALSE(failures.attempts.empty());
            CHECK(failures.attempts.front().reason.find("turns at once") != std::string::npos);
            CHECK(failures.attempts.front().newton == 0);
        }
        CHECK(report.rejected_increments == 0);  // a smaller increment was all it took
    }
}

TEST_CASE("normals of what is accepted are at rest as well, where flat fibres roll on their edges") {
    // Contact passes come to rest sooner than normals do: 1.14 of what is stated was left of their turns.
    scene::Assembly scene;
    for (const bool upper : {false, true}) {
        const double angle = upper ? 5.0 * pi / 180.0 : 0.0, half = 50.0 * r;
        const Vec3 along(std::sin(angle), std::cos(angle), 0.0), middle(0.0, 0.0, upper ? 3.5 * r : 0.0);
        scene::FibreSpecification flat = fibre(middle - half * along, middle + half * along, 16);
        flat.section = scene::elliptical(r, 2.0 * r);
        flat.director = upper ? Vec3(along.cross(Vec3::UnitZ())) : Vec3(Vec3::UnitZ());  // on its edge, on its face
        const Index own = scene.add(flat);
        for (const scene::Station& end : {scene::first_end(own), scene::last_end(own)})
            scene.clamp(end, upper ? Vec3(0.0, 0.0, -4.0 * r) : Vec3(Vec3::Zero()));
    }
    auto parameters = test::model_parameters<Pressing>(r);
    parameters.friction.friction_coefficient = 0.3;
    simulation::Simulator<Pressing> simulator(scene, parameters);
    const simulation::Report report = simulator.run({.increments = 5});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    std::printf("flat on edge: turn of normals over what is stated %.2f, %td Newton iterations\n", report.most_use.turn,
                report.counts.newton);
    CHECK(report.contact.active > 0);
    CHECK(report.most_use.greatest() <= 1.0);
}

TEST_CASE("two parallel rods under a line load: the residual that is accepted is the one that is stated") {
    double greatest = 0.0;
    for (const double load : {1e-6, 1e-5, 1e-4, 1e-3, 1e-2})
        for (const Index increments : {1, 3}) {
            CAPTURE(load);
            CAPTURE(increments);
            scene::Assembly scene;
            const double length = 100.0 * r;
            for (const double z : {0.0, 2.0}) {
                const Index of = scene.add(fibre({-0.5 * length, 0, z * r}, {0.5 * length, 0, z * r}, 10));
                scene.clamp(scene::first_end(of)), scene.clamp(scene::last_end(of));
            }
            for (int k = 1; k < 20; ++k)
                scene.apply(scene::DeadForce{{1, k / 20.0}, scene::NodeVector::position, Vec3(0, 0, -load), "motion"});
            simulation::Simulator<Smooth> simulator(scene, test::model_parameters<Smooth>(r));
            const simulation::Report report = simulator.run({.increments = increments});
            CAPTURE(report.reason);
            REQUIRE(report.converged);
            CHECK(report.residual <= 1e-4);
            CHECK(report.use.residual == report.residual / 1e-4);
            for (const simulation::IncrementReport& increment : report.increments) CHECK(increment.residual <= 1e-4);
            CHECK(report.most_use.residual <= 1.0);
            CHECK(report.most_use.penetration <= 1.0);
            CHECK(report.most_use.travel <= 1.0);
            greatest = std::max(greatest, report.residual);
        }
    std::printf("two rods: greatest residual %.2e\n", greatest);
}

/// Two crossed fibres, the upper one driven down by `approach` radii.
scene::Assembly crossed(double half, double gap, double approach, Index elements) {
    scene::Assembly scene;
    const double height = (2.0 + gap) * r;
    for (const double end : {0.0, 1.0}) {
        if (end == 0.0)
            scene.add(fibre({0, -half * r, 0}, {0, half * r, 0}, elements)),
                scene.add(fibre({-half * r, 0, height}, {half * r, 0, height}, elements));
        scene.clamp({0, end}), scene.clamp({1, end}, {0, 0, -approach * r});
    }
    return scene;
}

TEST_CASE("fibres that are pressed hard in one increment are no deeper in each other than allowed") {
    struct Case {
        double half, gap, approach;
        Index elements;
    };
    for (const Case& c : {Case{100, 0, 30, 16}, Case{50, 0, 30, 16}, Case{50, 10, 30, 10}, Case{25, 0, 10, 8}}) {
        CAPTURE(c.half);
        CAPTURE(c.approach);
        simulation::Simulator<Smooth> simulator(crossed(c.half, c.gap, c.approach, c.elements),
                                                test::model_parameters<Smooth>(r));
        const simulation::Report report = simulator.run({.increments = 1});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        CHECK(report.contact.active > 0);
        CHECK(report.contact.greatest_penetration <= 1e-2 * r);
        // Places that were too deep beside contact points are held to less.
        CHECK(report.use.penetration >= report.contact.greatest_penetration / (1e-2 * r) - 1e-3);
        std::printf("pressed %g of %g: depth %.3f of what is allowed, %ld iterations\n", c.approach, c.half,
                    report.use.penetration, static_cast<long>(report.counts.newton));
    }
}

TEST_CASE("a tool that presses hard in one increment does not sink in deeper than allowed") {
    scene::Assembly scene;
    scene.add(fibre({-50 * r, 0, 0}, {50 * r, 0, 0}, 10));
    scene.clamp(scene::first_end(0)), scene.clamp(scene::last_end(0));
    scene::Tool tool;
    tool.shape = scene::ToolShape::cylinder, tool.radius = 10.0 * r, tool.channel = "motion";
    tool.origin = {0, 0, 11.0 * r}, tool.axis = Vec3(0, 1, 0), tool.displacement = {0, 0, -5.0 * r};
    scene.add(tool);
    simulation::Simulator<Pressing> simulator(scene, test::model_parameters<Pressing>(r));
    const simulation::Report report = simulator.run({.increments = 1});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(report.contact.active > 0);
    CHECK(report.use.penetration <= 1.0);
    CHECK(report.contact.greatest_penetration <= 1e-2 * r);
}

TEST_CASE("a stage that is loose by its own word is taken by its word, and the report says by how much") {
    simulation::Simulator<Smooth> simulator(crossed(50, 0, 30, 16), test::model_parameters<Smooth>(r));
    simulation::Loading<Smooth> loading;
    loading.stages.resize(2);
    loading.stages[0].increments = 1, loading.stages[0].looseness = 20.0, loading.stages[0].ramps = {{"motion", 1.0}};
    loading.stages[1].increments = 1;
    const simulation::Report report = simulator.run(loading);
    REQUIRE(report.converged);
    REQUIRE(report.increments.size() >= 2);  // one more where the true gap is mended
    CHECK(report.increments[0].use.penetration > 1.0);
    CHECK(report.increments[0].use.penetration ==
          test::near(report.increments[0].contact.greatest_penetration / (1e-2 * r), 1e-3));
    CHECK(report.most_use.penetration == report.increments[0].use.penetration);
    CHECK(report.use.greatest() <= 1.0);
}

TEST_CASE("a loose stage that is asked for an exact end goes on at what is stated, and ends once its condition holds there") {
    for (const bool exact : {false, true}) {
        simulation::Simulator<Smooth> simulator(crossed(50, 0, 30, 16), test::model_parameters<Smooth>(r));
        simulation::Loading<Smooth> loading;
        loading.audited = false;
        loading.stages.resize(1);
        loading.stages[0].increments = 1, loading.stages[0].looseness = 20.0, loading.stages[0].ramps = {{"motion", 1.0}};
        loading.stages[0].until = [](const simulation::IncrementReport&) { return true; };
        loading.stages[0].exact_end = exact;
        const simulation::Report report = simulator.run(loading);
        CAPTURE(exact);
        REQUIRE(report.converged);
        CHECK(report.increments.size() == (exact ? 2 : 1));
        CHECK(report.increments[0].use.penetration > 1.0);
        CHECK((report.use.greatest() <= 1.0) == exact);
    }
}

TEST_CASE("a penalty that is given as one number stays it, however deep that is, and the report says so") {
    auto parameters = test::model_parameters<Smooth>(r);
    parameters.contact.stiffness.initial_fraction = parameters.contact.stiffness.floor_fraction =
        parameters.contact.stiffness.cap_fraction = 1e-3;
    simulation::Simulator<Smooth> simulator(crossed(50, 0, 10, 16), parameters);
    const simulation::Report report = simulator.run({.increments = 4});
    REQUIRE(report.converged);
    CHECK(report.use.penetration > 2.0);
    CHECK(report.use.penetration == test::near(report.contact.greatest_penetration / (1e-2 * r), 1e-3));
}

TEST_CASE("contact that even the stiffest penalty leaves too deep is refused by its depth") {
    auto parameters = test::model_parameters<Smooth>(r);
    parameters.contact.stiffness.cap_fraction = 0.06,
    parameters.contact.stiffness.reserve = 1.0;  // a little above where it begins
    simulation::Simulator<Smooth> simulator(crossed(25, 0, 10, 8), parameters);
    const simulation::Report report = simulator.run({.increments = 4});
    CHECK_FALSE(report.converged);
    CHECK(report.reason.find("contact of fibre 0 with fibre 1 is ") != std::string::npos);
}

TEST_CASE("a fibre whose sections are inside out is told by its element") {
    scene::Assembly scene;
    scene.add(fibre(Vec3::Zero(), {40 * r, 0, 0}, 4));
    simulation::Simulator<Smooth> simulator(scene, test::model_parameters<Smooth>(r));
    CHECK_FALSE(beam::first_inside_out(simulator.mesh(), simulator.beam(), simulator.state()));
    Vector state = simulator.state();
    const Index vector = simulator.mesh().node_vector(0, 5, 1);  // the middle of element 2
    state.segment<3>(3 * vector) *= -3.0;
    const auto found = beam::first_inside_out(simulator.mesh(), simulator.beam(), state);
    REQUIRE(found);
    CHECK(found->fibre == 0);
    CHECK(found->element == 2);
    CHECK(found->ratio < 0.0);
    CHECK(beam::text(*found).find("fibre 0, element 2") != std::string::npos);
}

}  // namespace acceptance_test

// SPDX-License-Identifier: MIT
// Leaps: an equilibrium ends, and the next one is far.
#include "simulation/scenes.hpp"
#include <near.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <numbers>

using namespace fibrant;

namespace calming_test {

using test::Smooth;

/// A straight rod with a slight bow, its ends turned against each other by four turns; then they approach.
struct Twisted {
    double radius = 0.05, length = 200.0, slack = 0.2;  // mm; radii; of the length
    Index elements = 40;
    double damping = 0.0;  // of both stages, for a path of its own

    scene::Assembly assembly() const {
        scene::Assembly scene;
        scene::FibreSpecification rod;
        rod.section = scene::circular(radius), rod.material = {1e4, 0.3}, rod.elements = elements;
        rod.curve = [r = radius, l = length](double t) {
            const double pi = std::numbers::pi;
            return Vec3(r * Vec3(l * t, 0.5 * std::sin(pi * t), 0.2 * std::sin(2.0 * pi * t)));
        };
        const Index fibre = scene.add(rod);
        for (const double side : {-1.0, 1.0}) {
            const scene::Station end = side < 0.0 ? scene::first_end(fibre) : scene::last_end(fibre);
            scene.prescribe(end, -0.5 * side * slack * length * radius * Vec3::UnitX(), "slack");
            scene.hold_rotation(end, 4.0 * side * std::numbers::pi * Vec3::UnitX(), "turn");
        }
        return scene;
    }
    simulation::Loading<Smooth> loading() const {
        simulation::Loading<Smooth> loading;
        loading.calmed = true;
        loading.stages.push_back({.name = "turn", .increments = 30, .ramps = {{"turn", 1.0}}, .damping = damping});
        loading.stages.push_back({.name = "slack", .increments = 30, .ramps = {{"slack", 1.0}}, .damping = damping});
        if (damping > 0.0) {
            loading.stages.push_back(
                {.name = "rest", .increments = 1, .damping = damping, .damping_decay = 0.3, .damping_share = 1e-8});
            loading.stages.back().until = [](const simulation::IncrementReport&) { return true; };
        }
        return loading;
    }
    simulation::ModelParameters<Smooth> parameters() const {
        simulation::ModelParameters<Smooth> parameters;
        parameters.normal.regularisation_depth = 1e-3 * radius, parameters.contact.stiffness.allowed_penetration = 1e-2 * radius;
        return parameters;
    }
};

TEST_CASE("a twisted rod that leaps is followed to the equilibrium that a rod damped all the way comes to") {
    const Twisted rod;
    Twisted damped = rod;
    damped.damping = 1e-4;
    simulation::Simulator<Smooth> simulator(rod.assembly(), rod.parameters()), other(damped.assembly(), damped.parameters());
    simulation::Loading<Smooth> stopped = rod.loading();
    stopped.calmed = false;
    const simulation::Report report = simulator.run(rod.loading()), slow = other.run(damped.loading());
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    REQUIRE(slow.converged);
    const double force = simulator.reaction(scene::last_end(0)).x(), expected = other.reaction(scene::last_end(0)).x();
    std::printf("four turns: force %.9f and %.9f, energy %.9f and %.9f, damped %.3e and %.3e, missing %.2e and %.2e\n", force,
                expected, report.energy.elastic, slow.energy.elastic, report.energy.damped, slow.energy.damped,
                report.energy.error(), slow.energy.error());
    // Residuals are at most 1e-4 of the reactions.
    CHECK(force == test::near(expected, 1e-3));
    CHECK(report.energy.elastic == test::near(slow.energy.elastic, 1e-4));
    CHECK(report.energy.damped > 0.0);
    CHECK(report.increments.back().damping == 0.0);
    // What is missing is the work of the turning ends, booked by the mean of two moments: a leap at ends that stand adds nothing
    // to it.
    CHECK(std::abs(report.energy.error() - slow.energy.error()) < 0.2 * std::abs(slow.energy.error()));

    simulation::Simulator<Smooth> alone(rod.assembly(), rod.parameters());
    const simulation::Report cut = alone.run(stopped);
    CHECK(!cut.converged);
    CHECK(cut.reason.find("stage slack") != std::string::npos);
}

TEST_CASE("a run that is stopped in the middle of a leap goes on to the same bits") {
    const Twisted rod;
    const std::string file = (std::filesystem::temp_directory_path() / "calming_test_checkpoint.bin").string();
    std::filesystem::remove(file);
    simulation::Simulator<Smooth> whole(rod.assembly(), rod.parameters());
    const simulation::Report report = whole.run(rod.loading());
    REQUIRE(report.converged);
    Index leap = 0;  // an increment within the first leap
    for (const simulation::IncrementReport& increment : report.increments)
        if (leap == 0 && increment.damping > 0.0) leap = increment.number + 3;
    REQUIRE(leap > 0);
    simulation::Loading<Smooth> loading = rod.loading();
    loading.checkpoint = file;
    Index increments = 0;
    loading.stop = [&] { return ++increments == leap; };
    {
        simulation::Simulator<Smooth> first(rod.assembly(), rod.parameters());
        const simulation::Report stopped = first.run(loading);
        REQUIRE(!stopped.converged);
        REQUIRE(stopped.increments.back().damping > 0.0);
    }
    loading.resume = true, loading.stop = {};
    simulation::Simulator<Smooth> second(rod.assembly(), rod.parameters());
    const simulation::Report rest = second.run(loading);
    std::filesystem::remove(file);
    REQUIRE(rest.converged);
    CHECK((second.state() - whole.state()).isZero(0.0));
    CHECK(rest.energy.damped == report.energy.damped);
    CHECK(rest.counts.newton == report.counts.newton);
}

}  // namespace calming_test

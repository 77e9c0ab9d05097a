// SPDX-License-Identifier: MIT
// Laws of sections in whole runs: what a fibre does with them, what it remembers, and that its energy is all there.
#include "simulation/lawful.hpp"
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/with_law.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/material/wire.hpp>
#include <fibrant/simulation/refined_state.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>

using namespace fibrant;

namespace flowing_fibres_test {

using test::Lawful;
using test::lawful_parameters;
using test::missing;
using test::refusal;
using test::Rod;

TEST_CASE("a wire that is bent beyond yield springs back to what its section keeps, also from a checkpoint and on a finer mesh") {
    using M = Lawful<material::Wire>;
    Rod rod;
    rod.elements = 8;
    const double sy = 7.3, first = sy / (rod.young * rod.radius), kappa = 3.0 * first;
    scene::Assembly turned = rod.clamped();
    turned.hold_rotation(scene::last_end(0), Vec3(0, kappa * rod.length, 0), "turn");
    const auto parameters = lawful_parameters<M>(rod.radius, {{.yield_stress = sy}});
    simulation::Simulator<M> simulator(turned, parameters);
    simulation::Loading<M> loading;
    loading.stages.push_back({.name = "bend", .increments = 5, .ramps = {{"turn", 1.0}}});
    const auto file = (std::filesystem::temp_directory_path() / "fibrant_section_laws_test.checkpoint").string();
    std::filesystem::remove(file);
    loading.checkpoint = file;
    simulation::Report report = simulator.run(loading);
    REQUIRE_MESSAGE(report.converged, report.reason);
    CHECK(report.energy.lost > 0.0);
    std::printf("bent wire: missing energy %.1e of the work\n", missing(report));
    CHECK(missing(report) < 1e-2);  // closest point, five increments
    // Let go: what is left of the angle is what the section keeps of the curvature.
    const auto left = [&](const scene::Assembly& free, auto&& begin) {
        simulation::Simulator<M> released(free, parameters);
        begin(released);
        const simulation::Report run = released.run({.increments = 1});
        REQUIRE_MESSAGE(run.converged, run.reason);
        const Vec3 g1 = released.value(scene::last_end(0), scene::NodeVector::director_1);
        return std::atan2(-g1.z(), g1.x()) / (kappa * rod.length);
    };
    const double own = left(rod.clamped(), [&](auto& released) { released.start_from(file); });
    CHECK(own == test::near(0.465023, 0.02));
    Rod fine_rod = rod;
    fine_rod.elements = 16;
    simulation::Simulator<M> coarse(rod.clamped(), parameters);
    simulation::Simulator<M> fine(fine_rod.clamped(), parameters);
    const auto refined = simulation::refined(simulation::read_state<M>(file, coarse.mesh()), coarse.mesh(), fine.mesh(), 2);
    simulation::write_state<M>(file, fine.mesh(), refined);
    CHECK(left(fine_rod.clamped(), [&](auto& released) { released.start_from(file); }) ==
          test::near(own, 0.04));  // it sees what the coarse mesh rounds off: (h kappa)^2 of stretch within an element
    std::filesystem::remove(file);
}

TEST_CASE("a fibre that is held relaxes as its material does, and a law with a rate asks for durations") {
    using M = Lawful<material::Viscoelastic<2>>;
    Rod rod;
    rod.elements = 4;
    scene::Assembly assembly = rod.clamped();
    assembly.prescribe(scene::last_end(0), Vec3(0.2 * rod.length, 0, -0.05 * rod.length), "pull");
    simulation::Simulator<M> simulator(assembly, lawful_parameters<M>(rod.radius, {{.share = {0.3, 0.2}, .time = {1.0, 10.0}}}));
    simulation::Loading<M> loading;
    loading.stages.push_back({.name = "pull", .increments = 4, .ramps = {{"pull", 1.0}}});
    CHECK(refusal([&] { simulator.run(loading); }).find("Stage.duration of stage pull = 0") != std::string::npos);
    loading.stages[0].duration = 1e-9;
    simulation::Report report = simulator.run(loading);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double before = simulator.reaction(scene::last_end(0)).norm();
    const double missing_before = report.energy.error();  // trapezia along the pull
    loading.stages = {{.name = "hold", .increments = 2, .duration = 10.0}};
    report = simulator.run(loading);
    REQUIRE_MESSAGE(report.converged, report.reason);
    CHECK(report.increments.size() == 2);
    CHECK(simulator.reaction(scene::last_end(0)).norm() / before == test::near(0.573590, 1e-6));
    CHECK(std::abs(report.energy.error() - missing_before) < 1e-9 * report.energy.lost);
    CHECK(report.energy.lost > 0.0);
}

}  // namespace flowing_fibres_test

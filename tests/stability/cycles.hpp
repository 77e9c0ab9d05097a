// SPDX-License-Identifier: MIT
#pragma once
/// @file A fibre that is dragged to and fro below another one, with friction.

#include <near.hpp>

#include <stability/small_scenes.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

namespace fibrant::test {

inline constexpr double cycle_radius = 0.0201;

/// A fibre pressed down across another one, then the lower one dragged to and fro.
struct Cycle {
    double work = 0.0, dissipated = 0.0;  ///< of the second cycle [force * length]
    double error = 0.0;                   ///< of its energy balance, over the work
    double loop = 0.0;                    ///< by how much its last force is not that of the first cycle, over the force
};
/// @param allowed     penetration [radius]
/// @param increments  a stroke
/// @param beginning   more of them for the first quarter of each stroke, in which fibres stick, bend and begin to slide
inline Cycle second_cycle(double allowed, Index increments, Index beginning) {
    SmallScene scene = dragged_three();
    scene.tight = true, scene.allowed = allowed;
    scene::Assembly assembly;
    for (const bool upper : {false, true}) {
        const Index fibre = assembly.add({.from = scene.fibres[upper].from,
                                          .to = scene.fibres[upper].to,
                                          .section = scene::circular(cycle_radius),
                                          .material = {7300.0, 0.3},
                                          .elements = 8});
        for (const double end : {0.0, 1.0})
            assembly.clamp({fibre, end}, upper ? Vec3(0, 0, -cycle_radius) : Vec3(0.6 * cycle_radius, 0, 0), Vec3::Zero(),
                           Vec3::Zero(), upper ? "press" : "drag");
    }
    simulation::Simulator<StableModel> simulator(assembly, parameters_of<StableModel>(scene));
    simulation::Report report;
    const auto go = [&](const char* channel, double to, Index steps) {
        simulation::Stage<StableModel> stage;
        stage.ramps = {{channel, to, false}}, stage.increments = steps, stage.most_increments = 2 * steps + 10;
        simulation::Loading<StableModel> loading;
        loading.stages = {stage};
        report = simulator.run(loading);
        REQUIRE(report.converged);
        for (std::size_t k = 1; k < report.increments.size(); ++k)
            CHECK(report.increments[k].energy.dissipated >= report.increments[k - 1].energy.dissipated);
    };
    go("press", 1.0, 8), go("drag", 1.0, increments / 2);
    Cycle cycle;
    Vec3 before = Vec3::Zero();
    for (const bool second : {false, true}) {
        const simulation::EnergyBalance first = report.energy;
        for (const double to : {-1.0, 1.0}) {
            if (beginning > 0) go("drag", -0.5 * to, beginning);
            go("drag", to, increments);
        }
        const Vec3 force = simulator.reaction(scene::first_end(0)) + simulator.reaction(scene::last_end(0));
        cycle.work = report.energy.external - first.external, cycle.dissipated = report.energy.dissipated - first.dissipated;
        cycle.error = (report.energy.error() - first.error()) / cycle.work;
        cycle.loop = (force - before).norm() / force.norm();
        if (!second) before = force;
    }
    std::printf(
        "penetration %.0e r, %ld increments a stroke and %ld at its beginning: work of a cycle %.6e, dissipated %.6e, balance "
        "off by %.2e of it, loop by %.1e\n",
        allowed, static_cast<long>(increments), static_cast<long>(beginning), cycle.work, cycle.dissipated, cycle.error,
        cycle.loop);
    return cycle;
}

/// The bend of the force where sliding begins is resolved: friction has no lever, however far particles sink into each other.
/// @param allowed  penetration [radius]
/// @param missing  at most, of the balance of energy over the work
inline void check_resolved_cycle(double allowed, double missing) {
    const Cycle fine = second_cycle(allowed, 160, 400);
    CHECK(std::abs(fine.error) < missing);
    CHECK(fine.loop < 1e-8);
    CHECK(fine.dissipated == near(fine.work, 3e-5));  // the rest went with renewed contact elements
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Two rods wound around each other from straight ones, against Kirchhoff's rods on helices.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/two_ply/two_ply.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace two_ply_test {

using namespace fibrant;

namespace two_ply = compositions::two_ply;

struct Frictionless {
    using Beam = beam::DirectorBeam<3, beam::DirectorBeamOptions{.twist = beam::TwistStrain::turn}>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
inline const double r = 0.0201, pi = std::numbers::pi;

inline two_ply::TwoPlyParameters rods(double force, double length, Index elements) {
    return {.radius = r, .length = length, .material = {7300.0, 0.3}, .elements = elements, .force = force};
}

/// Two rods, wound by these numbers of turns one after the other, resist with the torque of Kirchhoff's helices.
inline void check_wound(const std::vector<double>& all_turns) {
    const two_ply::TwoPlyParameters parameters = rods(0.02, 2.0, 60);
    simulation::ModelParameters<Frictionless> model;
    model.normal = {.law = {.regularisation_depth = 1e-3 * r}, .largest_penetration = 1e-4 * r};
    model.contact.stiffness.allowed_penetration = 1e-2 * r;
    model.iteration.contact_tolerance = 1e-3;
    simulation::Simulator<Frictionless> simulator(two_ply::straight_rods(parameters), model);
    const auto run = [&](simulation::Ramp ramp, Index increments) {
        simulation::Stage<Frictionless> stage;
        stage.ramps = {ramp}, stage.increments = increments;
        simulation::Loading<Frictionless> loading;
        loading.stages = {stage};
        const simulation::Report report = simulator.run(loading);
        REQUIRE_MESSAGE(report.converged, report.reason);
        return report;
    };
    run({two_ply::pull, 1.0}, 2);
    double reached = 0.0;
    for (const double turns : all_turns) {
        const simulation::Report report = run({two_ply::turn, turns}, static_cast<Index>(std::lround((turns - reached) * 12.0)));
        reached = turns;
        const two_ply::TwoPlyState state = two_ply::measure(simulator, parameters);
        const two_ply::HelixTheory theory(parameters, state.helix_angle, state.radius, state.twist);
        const two_ply::HelixTheory hard(parameters, state.helix_angle, r, state.twist);
        std::printf(
            "%.2f turns: angle %.4f degrees, radius %.5f r, twist %.4f of the helix's; torque %.6e %+.2e (%+.2e at r), line load "
            "%.5f %+.2e; penetration %.1e r, %td solves, %.1f s\n",
            turns, state.helix_angle * 180.0 / pi, state.radius / r,
            state.twist * state.radius / (std::sin(state.helix_angle) * std::cos(state.helix_angle)), state.torque,
            state.torque / theory.torque - 1.0, state.torque / hard.torque - 1.0, state.line_load,
            state.line_load / theory.line_load - 1.0, report.contact.greatest_penetration / r, report.counts.linear_solves,
            report.wall_seconds);
        CHECK(std::abs(state.radius / r - 1.0) < 5e-3);  // sections flatten
        CHECK(std::abs(state.torque / theory.torque - 1.0) < 2e-3);
        CHECK(std::abs(state.line_load / theory.line_load - 1.0) < 0.03);
        CHECK(report.contact.greatest_penetration < 1e-4 * r);
        // The same without what is measured: nothing turns a smooth round rod about its line, so its twist is the same
        // all along, and what the carriers turn it by less its writhe, 1 - cos(angle) a turn of a helix (Fuller 1971).
        // Near its ends the angle is less, over a tenth of the length: a tenth of a writhe that is 1.4e-2 at most.
        const double twist = 2.0 * pi * turns * std::cos(state.helix_angle) / parameters.length;
        CHECK(state.twist == test::near(twist, 1.5e-3));
        CHECK(state.torque == test::near(two_ply::HelixTheory(parameters, state.helix_angle, r, twist).torque, 1.5e-3));
        // Rods go around each other everywhere but where their clamps bend them, over less than the bending length
        // under their pull.
        const double bent = std::sqrt(parameters.bending_stiffness() / (0.5 * parameters.force)), around = 2.0 * pi * turns * r;
        CHECK(std::sin(state.helix_angle) > around / parameters.length);
        CHECK(std::sin(state.helix_angle) < around / (parameters.length - bent));
    }
}

}  // namespace two_ply_test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres that are drawn against friction whose force is known: around a cylinder, and to and fro between two others.

#include "../../tests/verification/capstan_reference.hpp"
#include "../../tests/verification/capstan_scene.hpp"
#include "sweep.hpp"

#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/smooth_coulomb.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fibrant::benchmarks {

template <beam::BeamElement B, law::FrictionLaw Law = law::RegularisedCoulomb>
struct Drawn : Policy<B, Law> {
    using Tools = contact::RigidTools;
};
template <simulation::Model M>
simulation::Loading<M> stage(std::vector<simulation::Ramp> ramps, Index increments) {
    simulation::Loading<M> loading;
    loading.stages.emplace_back();
    loading.stages.back().ramps = std::move(ramps), loading.stages.back().increments = increments;
    return loading;
}

/// Wound on a rigid cylinder of 25 radii without friction, then drawn with mu = 0.15 until all of it slides (capstan.json, for
/// the forces as they are).
/// @param points      of contact, for each half turn
/// @param increments  in which it is drawn
template <simulation::Model M>
Sample capstan(Index points, Index increments = 24) {
    const test::CapstanScene given{.fibre = r};
    const double rho = given.cylinder + given.fibre, mu = 0.15, allowed = 1e-2 * r;
    constexpr Index intervals = M::Beam::nodes - 1;
    const Index elements =
        2 / intervals * static_cast<Index>(std::ceil(given.half * static_cast<double>(points) / (std::numbers::pi * rho)));
    const scene::Assembly assembly = given.assembly(along_z(1.0, elements), intervals * elements);
    simulation::ModelParameters<M> all;
    all.normal.regularisation_depth = 0.1 * allowed;
    all.contact.stiffness.allowed_penetration = allowed;
    all.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};
    all.iteration.contact_tolerance = 2e-3;
    all.iteration.margin = 2.0, all.iteration.largest_margin = 20.0;
    Sample sample;
    const double start = processor_time();
    simulation::Simulator<M> simulator(assembly, all);
    sample.report = simulator.run(stage<M>({{"ends", 1.0}}, 30));
    if (!sample.report.converged) return sample;
    simulation::Loading<M> draw = stage<M>({{"ends", 2.0}}, increments);
    draw.stages[0].friction.emplace(typename M::Friction::Parameters{mu, 0.02 * r});
    // One point comes on or goes off the guide at a time: the error of a single state is by chance, so the root of the mean
    // square over the last quarter is taken.
    double squares = 0.0;
    int states = 0;
    struct Watch {
        const simulation::Simulator<M>* simulator;
        double *squares, rho;
        int* states;
        void reported(const simulation::IncrementReport& increment) {
            if (increment.progress < 0.75) return;
            const Vec3 slack = simulator->reaction(scene::first_end(0)), taut = simulator->reaction(scene::last_end(0));
            const double expected =
                test::capstan_ratio({r, rho - r, bending, 0.15}, slack.norm(), test::turned_angle(slack, taut));
            *squares += std::pow(taut.norm() / slack.norm() / expected - 1.0, 2), ++*states;
        }
        bool due(Index) const { return false; }
        void accepted(const observe::Snapshot&) const {}
    } watch{&simulator, &squares, rho, &states};
    sample.report = simulator.run(draw, watch);
    sample.seconds = processor_time() - start;
    sample.error = std::sqrt(squares / std::max(1, states));
    return sample;
}

/// A fibre between two others that squeeze it, drawn to and fro by its end by 0.3 radii: it sticks and bends them, slips, and
/// sticks where it turns. What a closed loop takes, against that of Coulomb's law without a reversible displacement, 4 F (A - F /
/// K): F is 2 mu N, A half of the way, K what fibres give way by as beams. N is what the supports of the two others hold.
/// @param range       reversible displacement of the law [length]
/// @param increments  of a stroke
template <simulation::Model M>
Sample drawn_to_and_fro(double range, Index increments) {
    const double mu = 0.2, half = 0.3 * r, length = 1.0, span = 0.6, at = 0.03;
    scene::Assembly assembly;
    scene::FibreSpecification fibre = along_z(1.0, 11);
    fibre.from = Vec3(-0.5 * length, 0, 0), fibre.to = Vec3(0.5 * length, 0, 0), fibre.director = Vec3::UnitZ();
    assembly.add(fibre);
    assembly.clamp(scene::first_end(0), Vec3(half, 0, 0), Vec3::Zero(), Vec3::Zero(), "draw");
    for (const double side : {-1.0, 1.0}) {
        scene::FibreSpecification other = along_z(1.0, 8);
        other.from = Vec3(at, -0.5 * span, side * 2.0 * r), other.to = Vec3(at, 0.5 * span, side * 2.0 * r),
        other.director = Vec3::UnitZ();
        const Index f = assembly.add(other);
        for (const double end : {0.0, 1.0})
            assembly.clamp({f, end}, Vec3(0, 0, -side * 0.5 * r), Vec3::Zero(), Vec3::Zero(), "squeeze");
    }
    simulation::ModelParameters<M> all = parameters<M>();
    all.contact.stiffness.allowed_penetration = 1e-3 * r, all.normal.regularisation_depth = 1e-4 * r;
    all.friction = {.friction_coefficient = mu, .reversible_displacement = range};
    Sample sample;
    const double start = processor_time();
    simulation::Simulator<M> simulator(assembly, all);
    sample.report = simulator.run(stage<M>({{"squeeze", 1.0}}, 8));
    double before = 0.0;
    Index newton = 0, rejected = 0;
    for (const double to : {1.0, -1.0, 1.0}) {
        if (!sample.report.converged) return sample;
        if (to < 0.0) before = sample.report.energy.dissipated;
        sample.report = simulator.run(stage<M>({{"draw", to}}, increments));
        newton += sample.report.counts.newton, rejected += sample.report.rejected_increments;
    }
    sample.report.counts.newton = newton, sample.report.rejected_increments = rejected;
    sample.seconds = processor_time() - start;
    const double normal = std::abs((simulator.reaction({1, 0.0}) + simulator.reaction({1, 1.0})).z()), force = 2.0 * mu * normal;
    const double sideways =
        192.0 * bending / std::pow(span, 3) / (1.0 + 24.0 * 1.3 * std::pow(r / span, 2));  // of each of the two others
    const double give = (0.5 * length + at) / (young * area) + 0.5 / sideways;
    sample.error = std::abs((sample.report.energy.dissipated - before) / (4.0 * force * (half - force * give)) - 1.0);
    return sample;
}

}  // namespace fibrant::benchmarks

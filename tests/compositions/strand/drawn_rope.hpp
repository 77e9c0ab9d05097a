// SPDX-License-Identifier: MIT
#pragma once
/// @file Ropes that are drawn in tests: what they carry beside what their wires can.

#include <compositions/bundle_model.hpp>
#include <fibrant/compositions/strand/rope.hpp>

#include <doctest/doctest.h>

#include <cstdio>

namespace fibrant::test {

namespace strand = compositions::strand;

/// Three strands of 1 + 6 wires around a thin one.
inline strand::RopeParameters three_strands(double wire_lay, double rope_lay, double length, Index elements) {
    strand::RopeParameters rope;
    rope.core.core_radius = 0.3;
    rope.layers = {{.strands = 3, .strand = strand::regular_strand(7, 1.0, wire_lay, false), .lay_angle_deg = rope_lay}};
    rope.material = {200000.0, 0.0};
    rope.length = length, rope.elements = elements;
    strand::lay_up(rope);
    return rope;
}

/// What a rope carries more when it is drawn from one strain to another, over what wires carry that keep their distance from the
/// axis.
struct Drawn {
    double force = 0.0, torque = 0.0, bound_torque = 0.0, unbalance = 0.0;
};
inline Drawn draw(const strand::RopeParameters& rope, double mu) {
    auto model = direct_parameters<Bundle>(bundle_solver);
    model.normal.regularisation_depth = 5e-4;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02};
    model.contact.stiffness.allowed_penetration = 1e-3;
    model.iteration.newton_limit = 30;
    model.iteration.step_tolerance = model.iteration.residual_tolerance = 1e-5;
    simulation::Simulator<Bundle> simulator(strand::straight_rope(rope), model);
    strand::StrandState state[2];
    simulation::Report report;
    for (int k = 0; k < 2; ++k) {
        simulation::Loading<Bundle> loading;
        loading.stages.emplace_back();
        loading.stages.back().ramps = {{strand::stretch, 0.003 * (k + 1)}, {strand::twist, 0.0}};
        loading.stages.back().increments = k == 0 ? 2 : 1;
        report = simulator.run(loading);
        REQUIRE_MESSAGE(report.converged, report.reason);
        state[k] = strand::measure(simulator, rope);
    }
    const strand::RopeStiffness bound = strand::stiffness_bound(rope, mu > 0.0);
    Drawn drawn;
    drawn.force = (state[1].force - state[0].force) / (0.003 * bound.force_by_strain),
    drawn.torque = (state[1].torque - state[0].torque) / 0.003;
    drawn.bound_torque = bound.torque_by_strain, drawn.unbalance = report.energy.error() / report.energy.external;
    std::printf(
        "%td elements, mu %.1f: at 0.006 %.4f of the bound's force, %.4f of its torque; from 0.003 on %.4f and %.4f; torque "
        "%.4g; %td iterations, %.1f s, %.1e deep, balance %.1e\n",
        rope.elements, mu, state[1].force / (0.006 * bound.force_by_strain), state[1].torque / (0.006 * bound.torque_by_strain),
        drawn.force, drawn.torque / bound.torque_by_strain, drawn.torque, report.counts.newton, report.wall_seconds,
        report.contact.greatest_penetration, drawn.unbalance);
    return drawn;
}

}  // namespace fibrant::test

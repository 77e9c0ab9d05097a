// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles a fabric: tows pulled, parted, handed over to ordinary contact, released, at rest.

#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>

namespace fibrant::compositions::weave {

/// Smallest radius of a fabric's fibres [length].
inline double smallest_radius(const FabricParameters& fabric) {
    return std::min(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
}

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const FabricParameters& fabric, const SettleParameters& settle) {
    settle.validate();
    const double r = smallest_radius(fabric), allowed = settle.allowed_penetration_over_radius * r;
    simulation::ModelParameters<M> parameters;
    parameters.normal.law.regularisation_depth = 0.1 * allowed;
    parameters.normal.limit = settle.gap_limit_over_radius * r;
    parameters.contact.stiffness.allowed_penetration = allowed;
    if constexpr (core::Active<typename M::Friction>) {
        parameters.friction.friction_coefficient = 0.0;  // until the handover: else the path would be remembered
        parameters.friction.reversible_displacement = std::max(0.02 * r, settle.friction_coefficient * allowed);
    }
    return parameters;
}

/// The stages of settling (Durville, sections 15.3.5 and 15.4.1; durations and tensions are ours).
template <simulation::Model M>
simulation::Loading<M> settling(const FabricParameters& fabric, const SettleParameters& settle) {
    const double r = smallest_radius(fabric), allowed = settle.allowed_penetration_over_radius * r;
    simulation::Loading<M> loading;
    simulation::Stage<M> tension;
    tension.name = "tension";
    tension.increments = settle.tension_increments;
    tension.ramps = {{tension_channel, 1.0, false}};
    tension.forced_orders = true;
    tension.gap_limit = 1e-3 * r;  // the tows hardly push while fibres are slack
    simulation::Stage<M> separation;
    separation.name = "separation";
    separation.increments = 1;
    separation.forced_orders = true;
    separation.gap_limit = settle.gap_limit_over_radius * r;
    separation.until = simulation::until_separated(5.0 * allowed);
    separation.most_increments = settle.separation_increments;
    simulation::Stage<M> handover;
    handover.name = "handover";
    handover.increments = 1;
    handover.until = simulation::until_settled(0.1 * r, 5.0 * allowed);  // friction meets fibres that are nearly at rest
    handover.most_increments = settle.separation_increments;
    simulation::Stage<M> release;
    release.name = "release";
    release.increments = settle.release_increments;
    if constexpr (core::Active<typename M::Friction>)
        release.friction.emplace(typename M::Friction::Parameters{
            settle.friction_coefficient, std::max(0.02 * r, settle.friction_coefficient * allowed)});
    release.ramps = {{tension_channel, settle.final_tension_factor, true}};
    simulation::Stage<M> rest;
    rest.name = "rest";
    rest.increments = 1;
    rest.until = simulation::until_settled(settle.rest_motion_over_radius * r, allowed);
    rest.most_increments = std::max<Index>(1, settle.rest_increments);
    // Paths are only a means, and what one increment leaves over moves in the next: the last stage tells when it is all.
    tension.looseness = 5.0;
    separation.looseness = 50.0;
    handover.looseness = release.looseness = 20.0;
    rest.looseness = 5.0;
    // A tenth of what the tension of a fibre makes of an element's length: slack fibres creep into their places instead of
    // leaping, and at rest nothing of it is left.
    const auto node_stiffness = [&](Family family) {
        const TowParameters& tow = fabric.tow(family);
        const double pull = settle.tension_strain * tow.material.young_modulus * tow.section().area();
        return 4.0 * pull * static_cast<double>(fabric.elements) / fabric.fibre_length(family);
    };
    const double damping = 0.1 * std::min(node_stiffness(Family::warp), node_stiffness(Family::weft));
    for (simulation::Stage<M>* stage : {&separation, &handover, &release, &rest}) stage->damping = damping;
    loading.stages = {tension, separation, handover, release, rest};
    return loading;
}

}  // namespace fibrant::compositions::weave

// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles a fabric: tows pulled, parted, handed over to ordinary contact, released, at rest.

#include <fibrant/compositions/weave/fabric.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/simulation/parting_parameters.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::compositions::weave {

/// Smallest radius of a fabric's fibres [length].
inline double smallest_radius(const FabricParameters& fabric) {
    return std::min(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
}

/// Stiffness that the tension of a fibre gives each of its nodes against moving aside alone; the lesser of the two families'
/// [force / length].
inline double node_stiffness(const FabricParameters& fabric, double tension_strain) {
    const auto of = [&](Family family) {
        const TowParameters& tow = fabric.tow(family);
        const double pull = tension_strain * tow.material.young_modulus * tow.section().area();
        return 4.0 * pull * static_cast<double>(fabric.elements_of(family)) / fabric.fibre_length(family);
    };
    return std::min(of(Family::warp), of(Family::weft));
}

/// Part of the tension that was asked for at which tows part, in (0, 1]: at most that under which a fibre turns within a third of an element.
///
/// Under a pull T a fibre turns over a length sqrt(E I / T). Where that is a small part of an element, elements kink at every crossing, contact points
/// stand for corners that are none, and Newton's method goes to and fro between them. What is asked for at the end is not touched.
inline double parting_tension(const FabricParameters& fabric, double tension_strain) {
    const double least_turn = 0.3;  // of an element
    double part = 1.0;
    for (const Family family : {Family::warp, Family::weft}) {
        const scene::CrossSection section = fabric.tow(family).section();
        const double turn = least_turn * fabric.fibre_length(family) / static_cast<double>(fabric.elements_of(family));
        part = std::min(part, section.second_moment_1() / (tension_strain * section.area() * turn * turn));
    }
    return part;
}

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const FabricParameters& fabric, const SettleParameters& settle) {
    settle.validate();
    const double r = smallest_radius(fabric);
    return simulation::parting_parameters<M>(r, settle.allowed_penetration_over_radius * r, settle.gap_limit_over_radius * r,
                                             settle.friction_coefficient);
}

/// The stages of settling (Durville, sections 15.3.5 and 15.4.1; durations and tensions are ours).
template <simulation::Model M>
simulation::Loading<M> settling(const FabricParameters& fabric, const SettleParameters& settle) {
    const double r = smallest_radius(fabric), allowed = settle.allowed_penetration_over_radius * r;
    // No softer than what parts the tows: a fifth of the gap that contact is shown. Softer contact is as deep as that, and pushes nothing apart.
    const double soft = std::max(allowed, std::min(settle.softness * allowed, 0.2 * settle.gap_limit_over_radius * r)), motion = 0.08 * settle.gap_limit_over_radius * r;
    const double share_at_rest = settle.rest_share, share_on_the_way = std::max(1e-3, share_at_rest);
    const double parting = parting_tension(fabric, settle.tension_strain);
    simulation::Loading<M> loading;
    simulation::Stage<M> tension;
    tension.name = "tension";
    tension.increments = settle.tension_increments;
    tension.ramps = {{tension_channel, parting, false}};
    tension.forced_orders = true;
    tension.gap_limit = 1e-3 * r;  // the tows hardly push while fibres are slack
    simulation::Stage<M> separation;
    separation.name = "separation";
    separation.increments = 1;
    separation.forced_orders = true;
    separation.gap_limit = settle.gap_limit_over_radius * r;
    separation.until = simulation::until_separated(5.0 * soft);
    separation.most_increments = settle.separation_increments;
    // Friction meets fibres that have just parted. Without it a tow would spread for ever more slowly, and how far it had
    // come would depend on the increments.
    simulation::Stage<M> handover;
    handover.name = "handover";
    handover.increments = 1;
    if constexpr (core::Active<typename M::Friction>)
        handover.friction.emplace(typename M::Friction::Parameters{
            settle.friction_coefficient, simulation::reversible_displacement(r, settle.friction_coefficient, allowed)});
    handover.until = simulation::until_settled(motion, 5.0 * soft, share_on_the_way);
    handover.most_increments = settle.rest_increments;
    simulation::Stage<M> release;
    release.name = "release";
    release.increments = settle.release_increments;
    release.ramps = {{tension_channel, settle.final_tension_factor, true}};
    simulation::Stage<M> relaxation;
    relaxation.name = "relaxation";
    relaxation.increments = 1;
    relaxation.until = simulation::until_settled(motion, 5.0 * soft, share_on_the_way);
    relaxation.most_increments = settle.rest_increments;
    // On the way contact is softer: contacts that change their status one by one are what Newton's method and the linear
    // solver spend their iterations on. Rest has the stiffness that was asked for.
    for (simulation::Stage<M>* stage : {&tension, &separation, &handover, &release, &relaxation}) stage->allowed_penetration = soft;
    simulation::Stage<M> stiffening = relaxation;
    stiffening.name = "stiffening";
    stiffening.allowed_penetration.reset();
    // How deep contact points are says little where fibres bend sharply around each other: what ends is judged by the true gap, at rest.
    stiffening.until = simulation::until_settled(motion, 5.0 * soft, share_at_rest);
    simulation::Stage<M> rest;
    rest.name = "rest";
    rest.increments = 1;
    rest.until = simulation::until_settled(settle.rest_motion_over_radius * r, 5.0 * soft, share_at_rest);
    rest.deepest = allowed;
    rest.most_increments = settle.rest_increments;
    // Paths are only a means: an increment keeps its normals, what it leaves over moves in the next, and the last stage tells
    // when that is all.
    tension.looseness = rest.looseness = 5.0;
    separation.looseness = handover.looseness = release.looseness = relaxation.looseness = stiffening.looseness = settle.looseness;
    // Slack fibres creep into their places instead of leaping. At the gap limit of one radius, a tenth of what the tension
    // makes of an element's length; an increment is a time, and half the time is twice the spring, so that the path is the
    // same when increments are halved. After the tension it falls, at first until it holds a thousandth of the forces, then,
    // contact being stiff, a ten-thousandth, which is what the balance of forces is solved to: rest is an equilibrium.
    const double damping = 0.1 / settle.gap_limit_over_radius * node_stiffness(fabric, parting * settle.tension_strain);
    separation.damping = handover.damping = release.damping = relaxation.damping = damping;
    stiffening.damping = 4.0 * damping;
    rest.damping = stiffening.damping;
    rest.damping_goes_on = true;
    handover.damping_decay = relaxation.damping_decay = stiffening.damping_decay = rest.damping_decay = 0.5;
    handover.damping_calm = relaxation.damping_calm = stiffening.damping_calm = rest.damping_calm =
        0.6 * settle.gap_limit_over_radius * r;
    handover.damping_share = relaxation.damping_share = share_on_the_way;
    stiffening.damping_share = rest.damping_share = share_at_rest;
    stiffening.damping_waits = rest.damping_waits = true;
    // What Newton's method cannot solve at once is softened: what is deep then parts as it did in the separation.
    for (simulation::Stage<M>* stage : {&handover, &release, &relaxation, &stiffening, &rest})
        stage->gap_limit = separation.gap_limit, stage->gap_limit_when_cut = true;
    for (simulation::Stage<M>* stage : {&separation, &handover, &release, &relaxation, &stiffening, &rest})
        stage->largest_displacement = 4.0 * settle.gap_limit_over_radius * r;
    loading.stages = {tension, separation, handover, release, relaxation, stiffening, rest};
    return loading;
}

}  // namespace fibrant::compositions::weave

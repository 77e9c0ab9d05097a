// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles any assembly: fibres pulled, parted, handed over to ordinary contact, released, at rest.

#include <fibrant/simulation/parting_parameters.hpp>
#include <fibrant/simulation/settle_parameters.hpp>
#include <fibrant/simulation/settling_scales.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <limits>

namespace fibrant::simulation {

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <Model M>
ModelParameters<M> settling_parameters(double radius, const SettleParameters& settle) {
    settle.validate();
    return parting_parameters<M>(radius, settle.allowed_penetration_over_radius * radius, settle.gap_limit_over_radius * radius,
                                 settle.friction_coefficient);
}

/// Spring from every centre to its last place [force / length] at which an increment that shows contact a gap limit g moves what
/// is softest by some of g: k = 0.1 (r / g) k_node. It is the inverse of a time step: half the limit is half the time and twice
/// the spring, so that the path stays the same. With less, slack fibres leap over their neighbours; with more, increments move
/// nothing.
inline double settling_damping(const SettleParameters& settle, double node_stiffness) noexcept {
    const double tenth = 0.1;  // by trial, at a gap limit of one radius
    return tenth * settle.damping / settle.gap_limit_over_radius * node_stiffness;
}

/// The stages of settling (Durville, sections 15.3.5 and 15.4.1; durations and tensions are ours). A scene that gives nothing but
/// itself gets a run that ends: each stage ends by what forces and true gaps say, or after so many increments.
template <Model M>
Loading<M> settling(const SettlingScales& scales, const SettleParameters& settle, const Pull& pull = {}) {
    settle.validate(), scales.validate();
    const double r = scales.radius, allowed = settle.allowed_penetration_over_radius * r,
                 limit = settle.gap_limit_over_radius * r;
    // No softer than what parts fibres: a fifth of the gap that contact is shown. Softer contact is as deep as that, and pushes
    // nothing apart.
    const double soft = std::max(allowed, std::min(settle.softness * allowed, 0.2 * limit)), motion = 0.08 * limit,
                 parted = 5.0 * soft;
    const double share_at_rest = settle.rest_share, share_on_the_way = std::max(1e-3, share_at_rest);
    const bool pulled = !pull.channel.empty(),
               released = pulled && settle.final_tension_factor != (pull.first ? scales.parting : 1.0);
    const double taut = settling_damping(settle, scales.taut),
                 slack = pulled && pull.first ? taut : settling_damping(settle, scales.slack);
    const auto ramped = [](Stage<M>& stage, Index increments) {
        stage.increments = increments, stage.most_increments = std::max<Index>(100, 40 * increments);
    };
    // Slack fibres creep into their places instead of leaping: `settling_damping`. What Newton's method cannot solve at once is
    // softened: what is deep then parts as it did in the separation.
    Stage<M> common;
    common.increments = 1, common.gap_limit = limit, common.gap_limit_when_cut = true, common.largest_displacement = 4.0 * limit;
    // Fibres that part at a small part of the pull that is asked for hardly resist bending: Newton's method converges slowly, and
    // damping that waited for it to be quick would not fall.
    const double hardly = 0.1;  // of the pull, by trial
    common.patience = pulled && scales.parting < hardly ? 2.0 : 1.0;
    common.follows_briefly = pull.drawn;
    // On the way contact is softer: contacts that change their status one by one are what Newton's method and the linear solver
    // spend their iterations on. Paths are only a means: an increment keeps its normals, and what it leaves over moves in the
    // next.
    common.allowed_penetration = soft, common.looseness = settle.looseness, common.damping = taut;
    // What begins drawn goes far in each increment: half of Newton's iterations went into a residual below 5 % of the forces.
    const double looser = 2.5;  // by trial on 608 fibres
    if (pull.drawn) common.looseness *= looser;
    Stage<M> separation = common;
    separation.name = "separation";
    separation.forced_orders = scales.ordered, separation.gap_limit_when_cut = false, separation.damping = slack;
    separation.until = until_separated(parted);
    // By pair: thin fibres that lie in thick ones are parted as far as fibres of their mean radius are, and what orders part
    // under a pull, be it many radii deep, by one radius: beyond it searches see too little of what comes.
    const double whole_radius = pulled && pull.first && scales.ordered ? std::max(1.0, r / limit) : 1.0,
                 mean_radius = scales.thickest > r ? 0.5 * (1.0 + scales.thickest / r) : 1.0;
    separation.largest_fraction = std::min(most_fraction, std::max(whole_radius, mean_radius));
    separation.most_increments = settle.separation_increments;
    // Slack ones would straighten before they are pulled.
    if (pull.drawn) separation.ramps = {{.channel = pull.channel, .to = scales.parting, .at_once = true}};
    // Orders part crossings and see nothing beside them: fibres of two yarns that lie along each other cross in plan to and fro,
    // and those that do not cross there meet no contact. Where that does not get on, ordinary contact does from there.
    constexpr Index still = 30;  // increments; parting by a quarter of a radius in each, they would be free long ago
    Stage<M> parting = separation;
    parting.name = "parting";
    parting.forced_orders = false, parting.if_needed = true;
    // Of what is deeper than a radius the centres do not tell the side.
    if (scales.ordered) separation.goes_on_below = r;
    separation.stalled_increments = parting.stalled_increments = still;
    Stage<M> tension = common;
    tension.name = "tension";
    ramped(tension, settle.tension_increments);
    tension.ramps = {{pull.channel, pull.first ? scales.parting : 1.0, false}};
    if (pull.first) {  // crossing fibres hardly push while they are slack, and nothing leaps
        tension.forced_orders = scales.ordered, tension.gap_limit = 1e-3 * r, tension.gap_limit_when_cut = false;
        tension.damping = 0.0, tension.looseness = 5.0, tension.largest_displacement = std::numeric_limits<double>::infinity();
    } else {
        tension.gap_limit_when_cut = false;
    }
    // Friction meets fibres that have just parted. Without it a bundle would spread for ever more slowly, and crossings slide to
    // and fro; how far they had come would depend on the increments.
    Stage<M> handover = common;
    handover.name = "handover";
    if constexpr (core::Active<typename M::Friction>)
        handover.friction.emplace(law::friction_parameters<typename M::Friction>(
            settle.friction_coefficient, reversible_displacement(r, settle.friction_coefficient, allowed),
            settle.friction_shape));
    handover.until = until_settled(motion, parted, share_on_the_way);
    handover.most_increments = settle.rest_increments;
    handover.enough_increments = std::max<Index>(1, settle.rest_increments / 2);  // what creeps for ever does so no longer
    // After the pull damping falls, at first until it holds a thousandth of the forces, then, contact being stiff, a
    // ten-thousandth, which is what the balance of forces is solved to: rest is an equilibrium.
    // What begins drawn has not spread yet, and goes twice as far an increment: larger steps cost less there.
    const double calm = pull.drawn ? 1.2 : 0.6;
    handover.damping_decay = 0.5, handover.damping_calm = calm * limit, handover.damping_share = share_on_the_way;
    Stage<M> release = common;
    release.name = "release";
    ramped(release, settle.release_increments);
    release.ramps = {{pull.channel, settle.final_tension_factor, true}};
    Stage<M> relaxation = handover;
    relaxation.name = "relaxation";
    // What is released moves on all the same: how far it crept before tells little of where it comes to rest. By trial on
    // 608 fibres: the same crimp before rest, a fourth of the increments less.
    if (pull.drawn && released) {
        const double sooner = 4.0, further = 1.7;  // over relaxation's
        handover.damping_share *= sooner, handover.damping_calm *= further;
        handover.until = until_settled(motion, parted, handover.damping_share);
    }
    relaxation.friction.reset();
    // There damping is steered: halved blindly, slack fibres leap by more than a radius after increments that moved half of one,
    // and energy is lost in leaps. By trial on 608 fibres: at a pace of twice the limit a twill takes a tenth fewer iterations,
    // and misses 5.9e-3 of its work for 4.5e-3.
    const double pace = 1.5 * limit;
    if (pull.drawn) {
        handover.damping_pace = pace, relaxation.damping_pace = limit;
        // While contact is soft, creeping nearly to rest takes a fourth of the iterations: the rest is what stiff contact moves.
        const double nearly = 2.0;  // over the share at rest, by trial on 608 fibres
        relaxation.damping_share = std::min(share_on_the_way, nearly * share_at_rest);
        relaxation.until = until_settled(motion, parted, relaxation.damping_share);
    }
    // What parts before it is pulled spreads by tens of radii there, and crept: by a quarter of a radius in an increment, in
    // three iterations each, while damping waited for less. By trial on 16 textiles of all kinds. Without friction nothing but
    // springs slows what slides in a valley, which came to rest four times as late by it.
    if (!pull.first && settle.friction_coefficient > 0.0) handover.damping_pace = pace;
    Stage<M> stiffening = relaxation;
    stiffening.name = "stiffening";
    stiffening.allowed_penetration.reset(), stiffening.looseness = settle.looseness;
    // How deep contact points are says little where fibres bend sharply around each other: what ends is judged by the true gap,
    // at rest.
    stiffening.damping_share = share_at_rest;
    if (pull.drawn) stiffening.deepest = allowed;  // a loose increment after a mend costs less than an exact one
    stiffening.until = until_settled(motion, parted, stiffening.damping_share);
    stiffening.damping = 4.0 * taut, stiffening.damping_waits = true;
    stiffening.damping_still = motion, stiffening.damping_pace = 0.0;
    Stage<M> rest = stiffening;
    rest.name = "rest";
    rest.until = until_settled(settle.rest_motion_over_radius * r, parted, share_at_rest);
    rest.enough_increments = std::numeric_limits<Index>::max();
    rest.deepest = allowed, rest.looseness = 1.0, rest.exact_end = true, rest.damping_goes_on = true;
    // With hardly any damping left an equilibrium may turn out to be unstable: a tube of crossing helices necks, and goes radii
    // to the next one.
    rest.looseness_on_the_way = settle.looseness;
    // Fibres that nothing holds, at rest as they begin, push on each other less and less while they part: no force is left that
    // damping could be small against, and rest is that they move no more.
    if (!scales.driven)
        for (Stage<M>* stage : {&handover, &stiffening, &rest}) {
            stage->damping = slack, stage->damping_decay = 1.0, stage->damping_share = stage->damping_pace = 0.0;
            stage->damping_waits = stage->damping_goes_on = false;
        }
    Loading<M> loading;
    loading.damping_of_fibres = scales.over_softest;
    if (pulled && pull.first && !pull.drawn) loading.stages.push_back(tension);
    loading.stages.push_back(separation);
    if (scales.ordered) loading.stages.push_back(parting);
    if (pulled && !pull.first) loading.stages.push_back(tension);
    loading.stages.push_back(handover);
    if (released) loading.stages.push_back(release), loading.stages.push_back(relaxation);
    loading.stages.push_back(stiffening), loading.stages.push_back(rest);
    return loading;
}

/// Of any assembly: what it goes by is measured on the scene.
/// @throws std::invalid_argument for an assembly without fibres, or a wrong parameter
template <Model M>
Loading<M> settling(const scene::Assembly& assembly, const SettleParameters& settle = {}, const Pull& pull = {}) {
    return settling<M>(scales_of(assembly, pull, typename M::Proximity()), settle, pull);
}

}  // namespace fibrant::simulation

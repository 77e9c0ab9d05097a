// SPDX-License-Identifier: MIT
#pragma once
/// @file The programme that settles any textile: yarns part, are pulled, rub on each other, and come to rest.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/simulation/parting_parameters.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fibrant::compositions::textile {

/// How a textile is settled.
struct SettleParameters {
    double friction_coefficient = 0.15;             ///< once yarns have parted [1], >= 0
    double allowed_penetration_over_radius = 1e-2;  ///< at rest [1], in (0, 0.5]
    double gap_limit_over_radius =
        0.25;                       ///< deepest penetration that a law is shown, about the motion of an increment [1], in (0, 1]
    Index tension_increments = 10;  ///< in which the tension is raised, >= 1
    Index separation_increments = 250;      ///< at most, >= 1
    Index rest_increments = 200;            ///< at most, >= 1
    double softness = 5.0;                  ///< penetration allowed on the way over that at rest [1], in [1, 20]
    double looseness = 1000.0;              ///< on the tolerances of passes before rest [1], in [1, 1000]
    double rest_motion_over_radius = 1e-2;  ///< of an increment at rest [1], > 0, unless
    double rest_share = 3e-4;               ///< damping holds no more than this part of the forces [1], in (0, 0.01]
    double damping = 1.0;                   ///< over what follows from tension, bending and spacing [1], > 0

    void validate() const {
        const std::string name = "SettleParameters.";
        core::require_not_negative(name + "friction_coefficient", friction_coefficient);
        core::require(allowed_penetration_over_radius > 0.0 && allowed_penetration_over_radius <= 0.5,
                      name + "allowed_penetration_over_radius", allowed_penetration_over_radius, "> 0 and <= 0.5");
        core::require(gap_limit_over_radius > 0.0 && gap_limit_over_radius <= 1.0, name + "gap_limit_over_radius",
                      gap_limit_over_radius, "> 0 and <= 1");
        core::require_at_least(name + "tension_increments", tension_increments, 1);
        core::require_at_least(name + "separation_increments", separation_increments, 1);
        core::require_at_least(name + "rest_increments", rest_increments, 1);
        core::require_between(name + "softness", softness, 1.0, 20.0);
        core::require_between(name + "looseness", looseness, 1.0, 1000.0);
        core::require_positive(name + "rest_motion_over_radius", rest_motion_over_radius);
        core::require(rest_share > 0.0 && rest_share <= 0.01, name + "rest_share", rest_share, "> 0 and <= 0.01");
        core::require_positive(name + "damping", damping);
    }
};

/// Parameters of a model whose normal law is a limited, regularised penalty.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const Textile& textile, const SettleParameters& settle) {
    settle.validate();
    const double r = textile.smallest_radius();
    auto parameters = simulation::parting_parameters<M>(r, settle.allowed_penetration_over_radius * r, settle.gap_limit_over_radius * r,
                                                        settle.friction_coefficient);
    parameters.iteration.overshoot = 0.5;
    return parameters;
}

/// Stiffness of a node of the softest yarn against moving aside: what its tension makes of an element's length, and its bending
/// between crossings, a beam clamped at both ends under a force in its middle being 192 E I / L^3, of which a quarter is taken
/// for ends that turn [force / length].
inline double node_stiffness(const Textile& textile, const Assembled& assembled, bool pulled) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t f = 0; f < assembled.path_of.size(); ++f) {
        const Index p = assembled.path_of[f];
        const Path& path = textile.paths[core::at(p)];
        const scene::FibreSpecification& fibre = assembled.assembly.fibres()[f];
        const double bending = fibre.material.young_modulus * fibre.section.second_moment_1();
        const double tension =
            pulled && path.ends == Ends::pulled ? path.tension_strain * fibre.material.young_modulus * fibre.section.area() : 0.0;
        const double element = scene::length_of(path.curve, 64) / static_cast<double>(fibre.elements);
        least = std::min(least, 4.0 * tension / element + 48.0 * bending / std::pow(assembled.longest_spacing, 3));
    }
    return least;
}

/// The stages of settling. Drawn paths part first, without tension, and are pulled then: pulled first they may go straight
/// through each other.
/// @param assembled  of the textile
template <simulation::Model M>
simulation::Loading<M> settling(const Textile& textile, const Assembled& assembled, const SettleParameters& settle) {
    settle.validate();
    const double r = textile.smallest_radius(), allowed = settle.allowed_penetration_over_radius * r,
                 g = settle.gap_limit_over_radius;
    const double soft = settle.softness * allowed, motion = 0.08 * g * r;
    const double share_on_the_way = std::max(1e-3, settle.rest_share);
    const bool pulled = std::any_of(textile.paths.begin(), textile.paths.end(),
                                    [](const Path& path) { return path.kind == PathKind::open && path.ends == Ends::pulled; });
    // At a limit of one radius, a tenth of what holds a node; an increment is a time, so half of the limit is twice the spring.
    const double slack = 0.1 * settle.damping / g * node_stiffness(textile, assembled, false);
    const double taut = 0.1 * settle.damping / g * node_stiffness(textile, assembled, pulled);
    simulation::Loading<M> loading;
    simulation::Stage<M> separation;
    separation.name = "separation";
    separation.increments = 1;
    separation.forced_orders = !assembled.assembly.orders().empty();
    separation.gap_limit = g * r;
    separation.until = simulation::until_separated(5.0 * soft);
    separation.most_increments = settle.separation_increments;
    separation.damping = slack;
    separation.allowed_penetration = soft, separation.looseness = settle.looseness;
    separation.largest_displacement = 4.0 * g * r;
    simulation::Stage<M> pull = separation;
    pull.name = "pull";
    pull.until = {};
    pull.forced_orders = false;
    pull.increments = settle.tension_increments;
    pull.most_increments = 40 * settle.tension_increments;
    pull.ramps = {{tension_channel, 1.0, false}};
    pull.damping = taut;
    simulation::Stage<M> handover;
    handover.name = "handover";
    handover.increments = 1;
    // Without friction places along the yarns would be neutral: crossings slide to and fro.
    if constexpr (core::Active<typename M::Friction>)
        handover.friction.emplace(typename M::Friction::Parameters{
            settle.friction_coefficient, simulation::reversible_displacement(r, settle.friction_coefficient, allowed)});
    handover.until = simulation::until_settled(motion, 5.0 * soft, share_on_the_way);
    handover.most_increments = settle.rest_increments,
    handover.enough_increments = std::max<Index>(1, settle.rest_increments / 2);
    handover.allowed_penetration = soft, handover.looseness = settle.looseness;
    handover.largest_displacement = 4.0 * g * r;
    handover.damping = taut, handover.damping_decay = 0.5, handover.damping_calm = 0.6 * g * r,
    handover.damping_share = share_on_the_way;
    simulation::Stage<M> stiffening = handover;
    stiffening.name = "stiffening";
    stiffening.friction.reset();
    stiffening.allowed_penetration.reset();
    stiffening.until = simulation::until_settled(motion, allowed, settle.rest_share);
    stiffening.damping = 4.0 * taut, stiffening.damping_share = settle.rest_share, stiffening.damping_waits = true;
    simulation::Stage<M> rest = stiffening;
    rest.name = "rest";
    rest.until = simulation::until_settled(settle.rest_motion_over_radius * r, 0.75 * allowed, settle.rest_share);
    rest.enough_increments = std::numeric_limits<Index>::max();
    rest.looseness = 5.0, rest.damping_goes_on = true;
    // Fibres that nothing holds, at rest as they are drawn, push on each other less and less while they part: no force is left
    // that damping could be small against, and rest is that they move no more.
    const bool loose = std::all_of(textile.paths.begin(), textile.paths.end(), [](const Path& path) {
        return path.kind == PathKind::open && path.ends == Ends::free && path.guides.empty() && !path.straight;
    });
    if (loose)
        for (simulation::Stage<M>* stage : {&handover, &stiffening, &rest}) {
            stage->damping = slack, stage->damping_decay = 1.0, stage->damping_share = 0.0;
            stage->damping_waits = stage->damping_goes_on = false;
        }
    loading.stages = {separation};
    if (pulled) loading.stages.push_back(pull);
    loading.stages.push_back(handover), loading.stages.push_back(stiffening), loading.stages.push_back(rest);
    return loading;
}

}  // namespace fibrant::compositions::textile

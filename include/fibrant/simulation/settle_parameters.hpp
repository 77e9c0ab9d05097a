// SPDX-License-Identifier: MIT
#pragma once
/// @file What a settling may be told; nothing has to be.

#include <fibrant/core/parameters.hpp>
#include <fibrant/law/shaped_friction.hpp>

#include <string>

namespace fibrant::simulation {

/// How fibres that lie in each other become a textile at rest. Radii are those of the thinnest fibre.
struct SettleParameters {
    double friction_coefficient = 0.15;             ///< once fibres have parted [1], >= 0
    law::FrictionShape friction_shape{};            ///< what it is over Coulomb's, of a model whose law has a shape
    double allowed_penetration_over_radius = 1e-2;  ///< at rest [1], in (0, 0.5]
    double gap_limit_over_radius = 0.25;  ///< deepest penetration that a law is shown, about the motion of an increment [1], > 0
    double final_tension_factor = 1.0;    ///< tension at the end over that at which fibres part [1], in (0, 1]
    Index tension_increments = 1;         ///< in which the tension is raised, >= 1
    Index separation_increments = 250;    ///< at most, until no fibres overlap, >= 1
    Index release_increments = 12;        ///< in which the tension is lowered, >= 1
    Index rest_increments = 200;          ///< at most, of each stage that ends at rest, >= 1
    double softness = 5.0;                ///< penetration allowed on the way over that at rest [1], in [1, 20]
    double looseness = 1000.0;            ///< on the tolerances of passes before rest: a path is only a means [1], in [1, 1000]
    double rest_motion_over_radius = 1e-2;  ///< greatest nodal motion of an increment at rest [1], > 0, unless
    double rest_share = 1e-4;               ///< damping holds no more than this part of the forces there [1], in (0, 0.01]
    double damping = 1.0;                   ///< over what follows from tension, bending and spans [1], > 0

    void validate() const {
        const std::string name = "SettleParameters.";
        core::require_not_negative(name + "friction_coefficient", friction_coefficient);
        friction_shape.validate();
        core::require(allowed_penetration_over_radius > 0.0 && allowed_penetration_over_radius <= 0.5,
                      name + "allowed_penetration_over_radius", allowed_penetration_over_radius, "> 0 and <= 0.5");
        core::require_positive(name + "gap_limit_over_radius", gap_limit_over_radius);
        core::require(final_tension_factor > 0.0 && final_tension_factor <= 1.0, name + "final_tension_factor",
                      final_tension_factor, "> 0 and <= 1");
        core::require_at_least(name + "tension_increments", tension_increments, 1);
        core::require_at_least(name + "separation_increments", separation_increments, 1);
        core::require_at_least(name + "release_increments", release_increments, 1);
        core::require_at_least(name + "rest_increments", rest_increments, 1);
        core::require_between(name + "softness", softness, 1.0, 20.0);
        core::require_between(name + "looseness", looseness, 1.0, 1000.0);
        core::require_positive(name + "rest_motion_over_radius", rest_motion_over_radius);
        core::require(rest_share > 0.0 && rest_share <= 0.01, name + "rest_share", rest_share, "> 0 and <= 0.01");
        core::require_positive(name + "damping", damping);
    }
};

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file Parameters of a model that parts fibres which overlap at first.

#include <fibrant/simulation/model.hpp>

#include <algorithm>

namespace fibrant::simulation {

/// How far a contact sticks: a fiftieth of the radius, or what the allowed penetration is to the bound of friction [length].
inline double reversible_displacement(double radius, double friction_coefficient, double allowed) {
    return std::max(0.02 * radius, friction_coefficient * allowed);
}

/// Of a model whose normal law is a limited, regularised penalty.
/// @param radius   of the thinnest fibre [length]
/// @param allowed  penetration [length]
/// @param limit    of the gap that the contact law is shown [length]
/// @param friction_coefficient  that a later stage sets [1]
template <Model M>
ModelParameters<M> parting_parameters(double radius, double allowed, double limit, double friction_coefficient) {
    ModelParameters<M> parameters;
    parameters.normal.law.regularisation_depth = allowed;
    parameters.normal.limit = limit;
    parameters.contact.stiffness.allowed_penetration = allowed;
    parameters.iteration.overshoot = 0.5;  // contacts that close and let go in turns send Newton's method to and fro
    if constexpr (core::Active<typename M::Friction>) {
        parameters.friction.friction_coefficient = 0.0;  // until fibres have parted: else the way would be remembered
        parameters.friction.reversible_displacement = reversible_displacement(radius, friction_coefficient, allowed);
    }
    return parameters;
}

}  // namespace fibrant::simulation

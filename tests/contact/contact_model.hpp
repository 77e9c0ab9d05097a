// SPDX-License-Identifier: MIT
#pragma once
/// @file Models of two or more touching fibres, with tolerances that leave the physics as the only error.

#include "fibres.hpp"

#include <support/models.hpp>

#include <string>
#include <utility>
#include <vector>

namespace fibrant::test {

/// @param allowed  penetration [length]
template <simulation::Model M>
simulation::ModelParameters<M> pressed_parameters(double allowed) {
    simulation::ModelParameters<M> parameters = direct_parameters<M>();
    parameters.normal.regularisation_depth = 0.1 * allowed;
    parameters.contact.stiffness.allowed_penetration = allowed;
    parameters.iteration.step_tolerance = 1e-7;
    parameters.iteration.residual_tolerance = 1e-8;
    parameters.iteration.normal_tolerance = 1e-5;
    parameters.iteration.normal_step_tolerance = 1e-5;
    parameters.iteration.contact_tolerance = 1e-4;
    parameters.iteration.inexact = 0.05;
    parameters.iteration.newton_limit = 40;
    parameters.iteration.normal_limit = 20;
    parameters.iteration.contact_limit = 20;
    parameters.iteration.linear_tolerance = 1e-10;
    return parameters;
}

/// A loading of one stage.
template <simulation::Model M>
simulation::Loading<M> stage(std::vector<simulation::Ramp> ramps, Index increments) {
    simulation::Stage<M> only;
    only.ramps = std::move(ramps);
    only.increments = increments;
    simulation::Loading<M> loading;
    loading.stages = {only};
    return loading;
}

}  // namespace fibrant::test

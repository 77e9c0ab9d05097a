// SPDX-License-Identifier: MIT
#pragma once
/// @file Strands of a core and six wires, and the reference of them that tests compare with.

#include <support/models.hpp>

#include <fibrant/compositions/strand/strand.hpp>

namespace strand_test {

using namespace fibrant;

namespace strand = compositions::strand;

using Frictionless = test::Multiplied;  // with a coefficient of 0

/// strand_1_6.json, results.director.
struct Case {
    double lay_angle_deg, core_radius, gap, pitch;
    double k11, k12, k22;
    double force, torque;  ///< at a strain of 0.002 without rotation
};
inline const Case cases[] = {
    {5, 0.0215, 0.0012808799, 2.98759288626, 65.30866018, 0.1993268143, 0.006043605099, 0.13100943348, 0.00039856740643},
    {10, 0.0215, 0.00091974097, 1.48236252744, 62.70465544, 0.3838470411, 0.008310736385, 0.12578578517, 0.00076749851545},
    {15, 0.022, 0.00079252128, 0.98720992227, 59.03860839, 0.5461006516, 0.01206550296, 0.11843163927, 0.0010918674471},
    {20, 0.0225, 0.00037451152, 0.735399955509, 54.09721363, 0.6704171521, 0.01689073587, 0.10851900842, 0.0013403574948}};

inline strand::StrandParameters strand_of(const Case& c) {
    strand::StrandParameters parameters;
    parameters.core_radius = c.core_radius;
    parameters.layers = {{.wires = 6, .radius = 0.0201, .lay_angle_deg = c.lay_angle_deg}};
    parameters.material = {7300.0, 0.3};
    return parameters;
}

inline simulation::ModelParameters<Frictionless> model(double r) {
    simulation::ModelParameters<Frictionless> parameters;
    parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};
    parameters.normal = {.law = {.regularisation_depth = 1e-4 * r}, .largest_penetration = 1e-6 * r};
    parameters.contact.stiffness.allowed_penetration = 1e-3 * r;
    parameters.contact.stiffness.initial_fraction = 0.2;
    parameters.iteration.step_tolerance = 1e-6;
    parameters.iteration.residual_tolerance = 1e-6;
    parameters.iteration.normal_tolerance = 1e-5;
    parameters.iteration.normal_step_tolerance = 1e-5;
    parameters.iteration.contact_tolerance = 1e-4;
    return parameters;
}

inline simulation::Loading<Frictionless> to(double strain, double rotation, Index increments) {
    simulation::Stage<Frictionless> stage;
    stage.ramps = {{strand::stretch, strain}, {strand::twist, rotation}};
    stage.increments = increments;
    simulation::Loading<Frictionless> loading;
    loading.stages = {stage};
    return loading;
}

}  // namespace strand_test

// SPDX-License-Identifier: MIT
#pragma once
/// @file A random mat between two rigid plates and the four walls of its box: the scene, and what is measured as it is compacted.

#include <fibrant/compositions/mat/random_mat.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::mat {

/// Way that two fibres of a mat slide before friction is all there [radius].
inline constexpr double reversible_over_radius = 0.05;

/// Channel of the upper plate; its amplitude is the way that it has come down [length].
inline const std::string press_channel = "press";

/// Tools in the order in which they are added: the lower plate, the upper one, the walls.
inline constexpr Index lower_plate = 0, upper_plate = 1;

/// Fibres without any support but plates and walls, which are smooth.
inline scene::Assembly boxed_mat(const MatParameters& parameters, const std::vector<MatFibre>& fibres) {
    scene::Assembly assembly;
    const Index group = assembly.add_group("mat");
    for (const MatFibre& fibre : fibres) {
        scene::FibreSpecification specification{.from = fibre(0.0),
                                                .to = fibre(1.0),
                                                .section = scene::circular(parameters.radius),
                                                .material = parameters.material,
                                                .elements = parameters.elements_of(fibre.length),
                                                .group = group};
        if (fibre.turn > 1e-9) specification.curve = fibre;
        assembly.add(specification);
    }
    const auto plane = [&](const Vec3& origin, const Vec3& normal, const std::string& name) {
        scene::Tool tool;
        tool.name = name, tool.origin = origin, tool.axis = normal, tool.friction_factor = 0.0, tool.channel = press_channel;
        return tool;
    };
    assembly.add(plane(Vec3::Zero(), Vec3::UnitZ(), "lower plate"));
    scene::Tool upper = plane({0, 0, parameters.height}, -Vec3::UnitZ(), "upper plate");
    upper.displacement = -Vec3::UnitZ();
    assembly.add(upper);
    for (const int axis : {0, 1}) {
        assembly.add(plane(Vec3::Zero(), Vec3::Unit(axis), "wall"));
        assembly.add(plane(parameters.width * Vec3::Unit(axis), -Vec3::Unit(axis), "wall"));
    }
    return assembly;
}

/// A mat as it is.
struct MatState {
    double height = 0.0;           ///< between the plates [length]
    double volume_fraction = 0.0;  ///< [1]
    double pressure = 0.0;         ///< on the upper plate [force / length^2]
    double lower_pressure = 0.0;   ///< on the lower plate [force / length^2]
    Index contacts = 0;            ///< places where two fibres press on each other
    double contacts_per_fibre = 0.0;
    double sine =
        0.0;  ///< mean |sin| of the angle of two fibres, end to end: pi / 4 if all directions are alike, 2 / pi in a plane
    /// Contacts per fibre if fibres, as they lie, passed through each other: 8 / pi phi L / d sine (Komori and Makishima, Toll).
    double contacts_without_bulk = 0.0;
    double elastic_energy = 0.0;  ///< of the fibres [force * length]
};

/// Mean |sin| of the angle between each fibre and the 64 after it, which stand for all others: they were drawn one by one.
template <simulation::Model M>
double mean_sine(const simulation::Simulator<M>& simulator) {
    const Index n = simulator.mesh().fibre_count(), others = std::min<Index>(64, n - 1);
    std::vector<Vec3> along;
    for (Index f = 0; f < n; ++f)
        along.push_back((simulator.value(scene::last_end(f), scene::NodeVector::position) -
                         simulator.value(scene::first_end(f), scene::NodeVector::position))
                            .normalized());
    double sum = 0.0;
    for (Index f = 0; f < n; ++f)
        for (Index k = 1; k <= others; ++k) sum += along[core::at(f)].cross(along[core::at((f + k) % n)]).norm();
    return others > 0 ? sum / static_cast<double>(n * others) : 0.0;
}

/// Height, volume fraction, pressure and contacts of a mat in the present state of a run.
template <simulation::Model M>
MatState measure(const simulation::Simulator<M>& simulator, const MatParameters& parameters) {
    MatState state;
    state.height = parameters.height - simulator.amplitude(press_channel);
    state.volume_fraction = parameters.volume_fraction(state.height);
    const auto& tools = simulator.contacts().tools();
    const double area = parameters.width * parameters.width;
    state.pressure = tools.reaction(upper_plate).force.z() / area;
    state.lower_pressure = -tools.reaction(lower_plate).force.z() / area;
    const auto& responses = simulator.contacts().responses();
    for (const contact::Zone& zone : simulator.contacts().zones()) {
        bool touching = false;
        for (Index k = zone.first; k < zone.last; ++k) touching = touching || responses[core::at(k)].reaction > 0.0;
        state.contacts += touching;
    }
    state.contacts_per_fibre = 2.0 * static_cast<double>(state.contacts) / static_cast<double>(parameters.fibres);
    state.sine = mean_sine(simulator);
    state.contacts_without_bulk =
        8.0 / std::numbers::pi * state.volume_fraction * parameters.length / parameters.diameter() * state.sine;
    state.elastic_energy = simulator.equilibrium().elastic_energy(simulator.state());
    return state;
}

/// What bends a fibre between supports that are a tenth of its length apart, or a diameter where that is more: springs that are
/// measured by it are not stiffer than the sections of short fibres [force / length].
inline double bending_stiffness(const MatParameters& parameters) {
    const double span = std::max(0.1 * parameters.length, parameters.diameter());
    return 192.0 * parameters.material.young_modulus * scene::circular(parameters.radius).second_moment_1() / std::pow(span, 3);
}

/// How a mat is pressed.
struct PressParameters {
    double height = core::unset;        ///< between the plates at the end [length], > 0 and below the mat's
    Index increments = 60;              ///< >= 1
    double friction_coefficient = 0.2;  ///< of fibres on each other [1], >= 0
    double allowed_penetration = 2e-2;  ///< [radius], > 0
    /// Spring from every centre to its last place, without which fibres that nothing holds yet have no place: over
    /// `bending_stiffness` [1], > 0.
    double damping = 1e-5;
    double looseness = 20.0;  ///< on the tolerances of contact and normal passes [1], in [1, 1000]
    double overshoot = 0.5;   ///< `IterationParameters::overshoot` [1]
    void validate(const MatParameters& mat) const {
        core::require(height > 0.0 && height < mat.height, "PressParameters.height", height,
                      "> 0 and below the mat's own, " + core::text(mat.height));
        core::require_at_least("PressParameters.increments", increments, 1);
        core::require_not_negative("PressParameters.friction_coefficient", friction_coefficient);
        core::require_positive("PressParameters.allowed_penetration", allowed_penetration);
        core::require_positive("PressParameters.damping", damping);
        core::require_between("PressParameters.looseness", looseness, 1.0, 1000.0);
        core::require(overshoot > 0.0, "PressParameters.overshoot", overshoot, "> 0");
    }
};

/// Parameters of a model that presses a mat: laws, stiffness of contact and iteration.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(const MatParameters& parameters, const PressParameters& press) {
    parameters.validate(), press.validate(parameters);
    const double r = parameters.radius;
    simulation::ModelParameters<M> model;
    model.normal.regularisation_depth = 0.25 * press.allowed_penetration * r;
    if constexpr (core::Active<typename M::Friction>)
        model.friction = {.friction_coefficient = press.friction_coefficient,
                          .reversible_displacement = reversible_over_radius * r};
    model.contact.stiffness.allowed_penetration = press.allowed_penetration * r;
    // Fibres bend long before their sections give way.
    model.contact.stiffness.initial_fraction = 1e-3, model.contact.stiffness.floor_fraction = 1e-6;
    model.iteration.newton_limit = 30, model.iteration.overshoot = press.overshoot;
    return model;
}

/// The upper plate comes down. What the damping takes is in the pressure: the slower fibres are moved, or the less they are
/// damped, the less a mat that is not yet jammed carries.
template <simulation::Model M>
simulation::Loading<M> pressing(const MatParameters& parameters, const PressParameters& press) {
    parameters.validate(), press.validate(parameters);
    simulation::Loading<M> loading;
    loading.stages.resize(1);
    simulation::Stage<M>& down = loading.stages[0];
    down.name = "press", down.ramps = {{mat::press_channel, parameters.height - press.height}};
    down.increments = press.increments, down.most_increments = 40 * press.increments;
    down.damping = press.damping * bending_stiffness(parameters), down.looseness = press.looseness;
    return loading;
}

}  // namespace fibrant::compositions::mat

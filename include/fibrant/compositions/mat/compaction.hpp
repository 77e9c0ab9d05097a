// SPDX-License-Identifier: MIT
#pragma once
/// @file A random mat between two rigid plates and the four walls of its box: the scene, and what is measured as it is compacted.

#include <fibrant/compositions/mat/random_mat.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/simulator.hpp>

#include <string>

namespace fibrant::compositions::mat {

/// Channel of the upper plate; its amplitude is the way that it has come down [length].
inline const std::string press = "press";

/// Tools in the order in which they are added: the lower plate, the upper one, the walls.
inline constexpr Index lower_plate = 0, upper_plate = 1;

/// Fibres without any support but plates and walls, which are smooth.
inline scene::Assembly boxed_mat(const MatParameters& parameters, const std::vector<MatFibre>& fibres) {
    scene::Assembly assembly;
    const Index group = assembly.add_group("mat");
    for (const MatFibre& fibre : fibres) {
        scene::FibreSpecification specification{.from = fibre(0.0), .to = fibre(1.0), .section = scene::circular(parameters.radius), .material = parameters.material,
                                                .elements = parameters.elements, .group = group};
        if (fibre.turn > 1e-9) specification.curve = fibre;
        assembly.add(specification);
    }
    const auto plane = [&](const Vec3& origin, const Vec3& normal, const std::string& name) {
        scene::Tool tool;
        tool.name = name, tool.origin = origin, tool.axis = normal, tool.friction_factor = 0.0, tool.channel = press;
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
    /// Of fibres of any direction that pass through each other: 2 phi L / d (Komori and Makishima, Toll).
    double contacts_without_bulk = 0.0;
    double elastic_energy = 0.0;   ///< of the fibres [force * length]
};

template <simulation::Model M>
MatState measure(const simulation::Simulator<M>& simulator, const MatParameters& parameters) {
    MatState state;
    state.height = parameters.height - simulator.amplitude(press);
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
    state.contacts_without_bulk = 2.0 * state.volume_fraction * parameters.length / parameters.diameter();
    state.elastic_energy = simulator.equilibrium().elastic_energy(simulator.state());
    return state;
}

/// Spring from every centre to its last place while the mat is compacted, without which fibres that nothing holds yet have no
/// place: `fraction` of what bends a fibre between supports that are a tenth of its length apart, by node [force / length].
inline double slack_damping(const MatParameters& parameters, double fraction = 1e-6) {
    const double bending = 0.25 * parameters.material.young_modulus * std::numbers::pi * std::pow(parameters.radius, 4);
    return fraction * 192.0 * bending / std::pow(0.1 * parameters.length, 3);
}

/// Slope of log(pressure) by log(volume fraction) between two states [1].
inline double exponent(const MatState& a, const MatState& b) { return std::log(b.pressure / a.pressure) / std::log(b.volume_fraction / a.volume_fraction); }

}  // namespace fibrant::compositions::mat

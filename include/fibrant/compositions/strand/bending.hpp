// SPDX-License-Identifier: MIT
#pragma once
/// @file A strand bent to an arc between two plates.

#include <fibrant/compositions/strand/strand.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::compositions::strand {

/// Channel of the bending; its amplitude is the angle between the two plates [radian].
inline const std::string bend = "bend";

/// Place of the far plate's centre when the core is an arc of its own length, the near one at the origin [length].
inline Vec3 far_centre(double length, double angle) {
    if (std::abs(angle) < 1e-4) return length * Vec3(0.5 * angle, 0.0, 1.0 - angle * angle / 6.0);
    return length / angle * Vec3(1.0 - std::cos(angle), 0.0, std::sin(angle));
}

/// Wires are held in the planes of both plates, and their sections turn with them; along the strand all of them at the near plate, and the
/// core alone at the far one: the others may slide through it. The far plate turns about y, and its centre goes where the end of
/// an arc does whose length is that of the strand.
inline scene::Assembly bent_strand(const StrandParameters& parameters) {
    scene::Assembly assembly = wires_of(parameters);
    const double length = parameters.length;
    const auto turned = [](double angle) { return Mat3(Eigen::AngleAxisd(angle, Vec3::UnitY())); };
    for (Index fibre = 0; fibre < parameters.wires(); ++fibre)
        for (const double end : {0.0, 1.0}) {
            scene::Hold hold;
            hold.at = {fibre, end}, hold.channel = bend;
            if (end > 0.0) {
                hold.rotation = turned;
                hold.pivot = Vec3(0, 0, length);
                hold.path = [=](double angle) { return Vec3(far_centre(length, angle) - Vec3(0, 0, length)); };
                if (fibre > 0) hold.directions = Vec3(1, 1, 0).asDiagonal();
            }
            assembly.hold(hold);
            hold.path = {};
            // A director has no place: it only turns. Its own stretch is free, as in Assembly::clamp.
            hold.axes = scene::Axes::section;
            hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 1).asDiagonal();
            assembly.hold(hold);
            hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 1).asDiagonal();
            assembly.hold(hold);
        }
    return assembly;
}

/// What bending takes.
struct BendingState {
    double angle = 0.0;     ///< between the plates [radian]
    double moment = 0.0;    ///< about y, at the far plate's centre [force * length]
    double tension = 0.0;   ///< of the core and all wires along the far plate's normal [force]
};

template <simulation::Model M>
BendingState measure_bending(const simulation::Simulator<M>& simulator, const StrandParameters& parameters) {
    BendingState state;
    state.angle = simulator.amplitude(bend);
    std::vector<scene::Station> ends;
    for (Index fibre = 0; fibre < parameters.wires(); ++fibre) ends.push_back(scene::last_end(fibre));
    const simulation::Wrench wrench = simulation::support_wrench(simulator, ends, far_centre(parameters.length, state.angle));
    state.moment = wrench.moment.y();
    state.tension = wrench.force.dot(Vec3(std::sin(state.angle), 0.0, std::cos(state.angle)));
    return state;
}

/// Sum of E I of all wires: a strand whose wires slide freely is about as stiff [force * length^2].
inline double loose_stiffness(const StrandParameters& parameters) {
    double sum = std::pow(parameters.core_radius, 4);
    for (const Layer& layer : parameters.layers) sum += static_cast<double>(layer.wires) * std::pow(layer.radius, 4);
    return 0.25 * std::numbers::pi * parameters.material.young_modulus * sum;
}

/// E I of a strand whose sections stay plane: none is stiffer [force * length^2].
inline double solid_stiffness(const StrandParameters& parameters) {
    double sum = loose_stiffness(parameters);
    for (std::size_t k = 0; k < parameters.layers.size(); ++k) {
        const double radius = parameters.layers[k].radius, a = parameters.helix_radius(k);
        sum += 0.5 * static_cast<double>(parameters.layers[k].wires) * parameters.material.young_modulus * std::numbers::pi * radius * radius * a * a;
    }
    return sum;
}

}  // namespace fibrant::compositions::strand

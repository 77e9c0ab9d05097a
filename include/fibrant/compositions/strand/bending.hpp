// SPDX-License-Identifier: MIT
#pragma once
/// @file A strand bent to an arc between two plates.

#include <fibrant/compositions/strand/strand.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::compositions::strand {

/// Channel of the bending; its amplitude is the angle between the two plates [radian].
inline const std::string bend = "bend";

/// Place of a point of an arc, from where its middle is, at a part of its length in [-1/2, 1/2]; straight it lies along z
/// [length].
inline Vec3 arc_point(double length, double angle, double part) {
    const double turn = part * angle, small = turn * turn;
    if (std::abs(turn) < 1e-4) return part * length * Vec3(0.5 * turn, 0.0, 1.0 - small / 6.0);
    return part * length / turn * Vec3(1.0 - std::cos(turn), 0.0, std::sin(turn));
}

/// Its derivative by the angle [length].
inline Vec3 arc_velocity(double length, double angle, double part) {
    const double turn = part * angle;
    if (std::abs(turn) < 1e-4) return part * part * length * Vec3(0.5, 0.0, -turn / 3.0);
    const double sine = std::sin(turn), cosine = std::cos(turn);
    return part * part * length / turn * Vec3(sine - (1.0 - cosine) / turn, 0.0, cosine - sine / turn);
}

/// Where the wires of the layers are held along the strand; elsewhere they may slide through the plates. The core is held at
/// both.
enum class Anchor {
    near_plate,   ///< all sliding is at the far plate
    both_plates,  ///< none: ends of a socketed strand
};

/// How a strand is held and drawn while it is bent.
struct Bending {
    Anchor anchor = Anchor::both_plates;  ///< where wires are held along the strand
    double strain = 0.0;                  ///< the arc between the plates is longer than the strand by this [1], > -1
    /// Angle up to which the strain grows in proportion; 0: it is there from the first increment on [radian], >= 0. A wire on a
    /// helix of angle b that nothing presses goes inwards by strain / tan(b)^2 of its distance: so a large strain takes
    /// increments.
    double drawn_at = 0.0;
    /// The core is led along the arc, across it and at the ends of its elements. So the curvature is even, where tension would
    /// draw the strand straight between its plates; a sheave or a neighbouring length does this.
    bool guided = false;

    void validate() const {
        core::require(strain > -1.0, "Bending.strain", strain, "> -1");
        core::require_not_negative("Bending.drawn_at", drawn_at);
    }
    /// Length of the arc between the plates of a strand at an angle [length].
    double arc(double length, double angle) const noexcept {
        const double part = std::abs(angle) < drawn_at ? std::abs(angle) / drawn_at : 1.0;
        return (1.0 + part * strain) * length;
    }
};

/// Wires are held in the planes of both plates, and their sections turn with them: one by half of the angle about y, the other
/// back, and their centres go where the ends of an arc do whose middle stays. So nothing moves far, which keeps the contact
/// search short.
inline scene::Assembly bent_strand(const StrandParameters& parameters, const Bending& bending = {}) {
    scene::Assembly assembly = wires_of(parameters);
    bending.validate();
    const double length = parameters.length;
    const auto path = [length, bending](double part) {
        return [=](double angle) { return Vec3(arc_point(bending.arc(length, angle), angle, part) - Vec3(0, 0, part * length)); };
    };
    for (Index fibre = 0; fibre < parameters.wires(); ++fibre) {
        for (const double end : {0.0, 1.0}) {
            const bool slides = fibre > 0 && bending.anchor == Anchor::near_plate && end > 0.0;
            const double part = end - 0.5;
            scene::Hold hold;
            hold.at = {fibre, end}, hold.channel = bend;
            hold.rotation = [=](double angle) { return Mat3(Eigen::AngleAxisd(part * angle, Vec3::UnitY())); };
            hold.pivot = Vec3(0, 0, end * length);
            hold.path = path(part);
            if (slides) hold.directions = Vec3(1, 1, 0).asDiagonal();
            assembly.hold(hold);
            hold.path = {};
            // A director has no place: it only turns. Its own stretch is free, as in Assembly::clamp.
            hold.axes = scene::Axes::section;
            hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 1).asDiagonal();
            assembly.hold(hold);
            hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 1).asDiagonal();
            assembly.hold(hold);
        }
    }
    for (Index n = 1; bending.guided && n < parameters.elements; ++n) {
        scene::Hold guide;
        const double at = static_cast<double>(n) / static_cast<double>(parameters.elements);
        guide.at = {0, at}, guide.channel = bend, guide.directions = Vec3(1, 1, 0).asDiagonal();
        guide.path = path(at - 0.5);
        assembly.hold(guide);
    }
    return assembly;
}

/// What bending takes.
struct BendingState {
    double angle = 0.0;     ///< between the plates [radian]
    double moment = 0.0;    ///< work for each radian: half of what both plates exert about y, and what the forces on them, and on
                            ///< a core that is guided, do as their places move once the strand is
                            ///< drawn [force * length]
    double at_plate = 0.0;  ///< about y, at the far plate's centre alone [force * length]
    double tension = 0.0;   ///< of the core and all wires along the far plate's normal [force]
};

/// Angle, moment and tension of a bent strand in the present state of a run.
template <simulation::Model M>
BendingState measure_bending(const simulation::Simulator<M>& simulator, const StrandParameters& parameters,
                             const Bending& bending = {}) {
    const Vec3 middle(0.0, 0.0, 0.5 * parameters.length);
    BendingState state;
    state.angle = simulator.amplitude(bend);
    const double arc = bending.arc(parameters.length, state.angle);
    for (const double end : {0.0, 1.0}) {
        std::vector<scene::Station> sections;
        for (Index fibre = 0; fibre < parameters.wires(); ++fibre) sections.push_back({fibre, end});
        const double part = end - 0.5;
        const simulation::Wrench wrench =
            simulation::support_wrench(simulator, sections, middle + arc_point(arc, state.angle, part));
        state.moment += part * wrench.moment.y() + wrench.force.dot(arc_velocity(arc, state.angle, part));
        state.at_plate = wrench.moment.y();
        state.tension = wrench.force.dot(Vec3(std::sin(part * state.angle), 0.0, std::cos(part * state.angle)));
    }
    for (Index n = 1; bending.guided && n < parameters.elements; ++n) {
        const double at = static_cast<double>(n) / static_cast<double>(parameters.elements);
        state.moment += simulator.reaction({0, at}).dot(arc_velocity(arc, state.angle, at - 0.5));
    }
    return state;
}

/// How far a wire has gone outwards from the layer it belongs to, at most: its distance from the core's line, which goes straight
/// on beyond the plates, over the radius of its helix [length].
template <simulation::Model M>
double furthest_from_layer(const simulation::Simulator<M>& simulator, const StrandParameters& parameters) {
    const auto& mesh = simulator.mesh();
    const auto place = [&](Index fibre, Index node) {
        return simulator.value({fibre, static_cast<double>(node) / static_cast<double>(mesh.node_count(fibre) - 1)});
    };
    const Index nodes = mesh.node_count(0);
    double most = 0.0;
    Index fibre = 1;
    for (std::size_t k = 0; k < parameters.layers.size(); ++k)
        for (Index wire = 0; wire < parameters.layers[k].wires; ++wire, ++fibre)
            for (Index n = 0; n < mesh.node_count(fibre); ++n) {
                const Vec3 at = place(fibre, n);
                double least = std::numeric_limits<double>::infinity();
                for (Index m = 0; m + 1 < nodes; ++m) {
                    const Vec3 from = place(0, m), along = place(0, m + 1) - from;
                    double t = (at - from).dot(along) / along.squaredNorm();
                    if (m > 0) t = std::max(t, 0.0);
                    if (m + 2 < nodes) t = std::min(t, 1.0);
                    least = std::min(least, (at - from - t * along).norm());
                }
                most = std::max(most, least - parameters.helix_radius(k));
            }
    return most;
}

/// Of wires that bend each by itself, as helical springs: over a turn, sin^2 / 2 of the moment twists a wire and the rest bends
/// it, and there is 1 / cos of wire on a length of axis. So E I cos / (1 + nu sin^2 / 2) of the lay angle (Costello) [force *
/// length^2].
inline double loose_stiffness(const StrandParameters& parameters) {
    double sum = parameters.material.young_modulus * std::pow(parameters.core_radius, 4);
    for (const Layer& layer : parameters.layers) {
        const scene::ElasticMaterial& own = parameters.material_of(layer);
        const double lay = layer.lay_angle_deg * std::numbers::pi / 180.0, twisting = 0.5 * std::pow(std::sin(lay), 2);
        sum += own.young_modulus * static_cast<double>(layer.wires) * std::pow(layer.radius, 4) * std::cos(lay) /
               (1.0 + own.poisson_ratio * twisting);
    }
    return 0.25 * std::numbers::pi * sum;
}

/// E I of a strand whose sections stay plane: none is stiffer [force * length^2].
inline double solid_stiffness(const StrandParameters& parameters) {
    double sum = parameters.material.young_modulus * std::pow(parameters.core_radius, 4);
    for (std::size_t k = 0; k < parameters.layers.size(); ++k) {
        const Layer& layer = parameters.layers[k];
        const double radius = layer.radius, a = parameters.helix_radius(k);
        sum += parameters.material_of(layer).young_modulus * static_cast<double>(layer.wires) *
               (std::pow(radius, 4) + 2.0 * radius * radius * a * a);
    }
    return 0.25 * std::numbers::pi * sum;
}

}  // namespace fibrant::compositions::strand

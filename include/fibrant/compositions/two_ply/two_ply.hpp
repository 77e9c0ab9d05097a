// SPDX-License-Identifier: MIT
#pragma once
/// @file Two straight rods side by side, wound around each other by carriers that turn: scene, measures and the theory.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/support_wrench.hpp>

#include <Eigen/SVD>

#include <array>
#include <cmath>
#include <numbers>
#include <string>

namespace fibrant::compositions::two_ply {

/// Channels: the pull goes to its full size as `pull` goes to 1; the amplitude of `turn` is the turns of the far carrier
/// against the near one.
inline const std::string pull = "pull", turn = "turn";

/// Two equal rods along z, touching, at rest.
struct TwoPlyParameters {
    double radius = core::unset;  ///< of a rod [length], > 0
    double length = core::unset;  ///< [length], > 0
    scene::ElasticMaterial material;
    Index elements = 40;         ///< along each rod
    double force = core::unset;  ///< that pulls both together, shared equally [force], >= 0
    /// Places along the ply where the middle between the rods is kept on the axis, for models that have a part `Connections`; >=
    /// 0. Without, a ply of length L buckles like any rod once its torque M has M^2 > 4 B F + (9 B / L)^2, B = 2 E I (Greenhill's
    /// limit).
    Index guides = 0;
    double bending_stiffness() const noexcept {
        return 0.25 * material.young_modulus * std::numbers::pi * radius * radius * radius * radius;
    }
    double torsion_stiffness() const noexcept { return bending_stiffness() / (1.0 + material.poisson_ratio); }
    void validate() const {
        core::require_positive("TwoPlyParameters.radius", radius);
        core::require_positive("TwoPlyParameters.length", length);
        core::require_not_negative("TwoPlyParameters.force", force);
        core::require_at_least("TwoPlyParameters.elements", elements, 2);
        core::require_at_least("TwoPlyParameters.guides", guides, 0);
        material.validate();
    }
};

namespace detail {

/// The rods on helices of an angle, 0: straight.
inline scene::Assembly rods(const TwoPlyParameters& parameters, double angle) {
    parameters.validate();
    scene::Assembly assembly;
    for (const double side : {1.0, -1.0}) {
        const Vec3 foot(side * parameters.radius, 0.0, 0.0);
        scene::FibreSpecification rod{.from = foot,
                                      .to = foot + Vec3(0, 0, parameters.length),
                                      .section = scene::circular(parameters.radius),
                                      .material = parameters.material,
                                      .elements = parameters.elements,
                                      .director = Vec3::UnitX()};
        if (angle > 0.0) {
            const double r = parameters.radius, length = parameters.length, turn = length * std::sin(angle) / r;
            rod.start = [=](double t) -> Vec3 {
                return {side * r * std::cos(turn * t), side * r * std::sin(turn * t), length * std::cos(angle) * t};
            };
            rod.twist = turn * std::cos(angle);
        }
        const Index fibre = assembly.add(rod);
        for (const double end : {0.0, 1.0}) {
            scene::Hold hold;
            hold.at = {fibre, end}, hold.channel = turn;
            hold.rotation = [end](double turns) {
                return Mat3(Eigen::AngleAxisd(2.0 * std::numbers::pi * (end - 0.5) * turns, Vec3::UnitZ()));
            };
            if (end > 0.0) hold.directions = Vec3(1, 1, 0).asDiagonal();
            assembly.hold(hold);
            hold.axes = scene::Axes::section;
            hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 1).asDiagonal();
            assembly.hold(hold);
            hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 1).asDiagonal();
            assembly.hold(hold);
        }
        assembly.apply(
            scene::DeadForce{scene::last_end(fibre), scene::NodeVector::position, Vec3(0, 0, 0.5 * parameters.force), pull});
    }
    if (parameters.guides > 0) {
        const Index axis = assembly.add(scene::RigidBody{.name = "axis"});
        for (Index k = 1; k <= parameters.guides; ++k) {
            const double at = static_cast<double>(k) / static_cast<double>(parameters.guides + 1);
            assembly.connect({.ends = {{0, at}, {1, at}}, .body = axis, .tied = {true, true, false}});
        }
    }
    return assembly;
}

}  // namespace detail

/// Ends are held to the direction of the axis and turn with the carriers, half of the way each; the far ones slide along the
/// axis under the pull.
inline scene::Assembly straight_rods(const TwoPlyParameters& parameters) { return detail::rods(parameters, 0.0); }

/// The same rods, straight at rest as well, that begin wound on helices of an angle, their sections turned with the carriers.
/// Nothing balances their bending yet: a stage with damping brings them to where they press on each other. Ends are held to the
/// directions of the helices, and turn with the carriers from there.
/// @param angle  of the rods to the axis [radian], > 0 and at most 45 degrees: steeper rods of this radius would overlap
inline scene::Assembly wound_rods(const TwoPlyParameters& parameters, double angle) {
    const double steepest = 0.25 * std::numbers::pi;
    core::require(angle > 0.0 && angle <= steepest, "two_ply.wound_rods: angle", angle, "> 0 and <= pi / 4");
    return detail::rods(parameters, angle);
}

/// The ply at mid-length, and what its ends carry.
struct TwoPlyState {
    double torque = 0.0;       ///< of the pair about the axis [force * length]
    double helix_angle = 0.0;  ///< of the rods to the axis [radian]
    double radius = 0.0;       ///< of the helix [length]
    double twist =
        0.0;  ///< that sections turn by about their line, torsion of the line included, a length at rest [radian / length]
    double line_load = 0.0;  ///< between the rods over the middle fifth, a length at rest [force / length]
};

/// Turn of a section, whatever its strain. @param mesh  of any beam
template <class Mesh>
Mat3 section_turn(const Mesh& mesh, const Vector& state, Index fibre, double u) {
    const auto [g_1, g_2] = mesh.directors(state, fibre, u);
    Mat3 section;
    section << g_1, g_2, g_1.cross(g_2).normalized();
    const Eigen::JacobiSVD<Mat3> polar(section, Eigen::ComputeFullU | Eigen::ComputeFullV);
    return polar.matrixU() * polar.matrixV().transpose();
}

/// Torque, helix, twist and line load of two plies in the present state of a run.
template <simulation::Model M>
TwoPlyState measure(const simulation::Simulator<M>& simulator, const TwoPlyParameters& parameters) {
    TwoPlyState state;
    state.torque = simulation::support_wrench(simulator, std::array{scene::last_end(0), scene::last_end(1)}).moment.z();
    const auto& mesh = simulator.mesh();
    const Vector& now = simulator.state();
    for (const Index fibre : {Index{0}, Index{1}}) {
        const double n = static_cast<double>(parameters.elements);
        double samples = 0.0;  // means over the middle tenth
        TwoPlyState sum;
        for (Index e = static_cast<Index>(0.45 * n); static_cast<double>(e) < 0.55 * n; ++e, samples += 1.0) {
            const double u = static_cast<double>(e) + 0.5;
            const Vec3 tangent = mesh.derivative(now, fibre, u).normalized(), centre = mesh.position(now, fibre, u);
            sum.helix_angle += std::acos(tangent.z());
            sum.radius += centre.head<2>().norm();
            // From end to end of the element, exact on a helix: its sections turn about one axis, at one angle to the line.
            const Mat3 before = section_turn(mesh, now, fibre, u - 0.5), after = section_turn(mesh, now, fibre, u + 0.5);
            sum.twist += core::rotation_vector(after * before.transpose()).dot(tangent) / mesh.fibre(fibre).element_length;
        }
        state.helix_angle += 0.5 * sum.helix_angle / samples;
        state.radius += 0.5 * sum.radius / samples;
        state.twist += 0.5 * sum.twist / samples;
    }
    for (std::size_t k = 0; k < simulator.contacts().elements().size(); ++k) {
        const double u = simulator.contacts().elements()[k].u_i / static_cast<double>(parameters.elements);
        if (u >= 0.4 && u < 0.6) state.line_load += simulator.contacts().responses()[k].reaction / (0.2 * parameters.length);
    }
    return state;
}

/// Torque and line load of two inextensible rods on helices, from Kirchhoff's equations.
/// @param a      radius of the helices [length]
/// @param twist  of the material; tan(angle) cos^2(angle) / a where the rods turn with their carriers [radian / length]
struct HelixTheory {
    double torque, line_load;
    HelixTheory(const TwoPlyParameters& parameters, double angle, double a, double twist) {
        const double bending = parameters.bending_stiffness(), torsion = parameters.torsion_stiffness();
        const double s = std::sin(angle), c = std::cos(angle), curvature = s * s / a, tau = s * c / a;
        const double shear = torsion * twist * curvature - bending * curvature * tau;
        const double tension = (0.5 * parameters.force - shear * s) / c;
        line_load = tension * curvature - tau * shear;
        torque = 2.0 * (bending * curvature * s + torsion * twist * c + a * (tension * s - shear * c));
    }
};

}  // namespace fibrant::compositions::two_ply

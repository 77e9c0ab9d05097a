// SPDX-License-Identifier: MIT
#pragma once
/// @file Two half rings that hang in each other and are pulled apart by their ends.

#include <contact/contact_model.hpp>

#include <fibrant/simulation/audit.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fibrant::test {

struct Hooks {
    Index elements = 40, increments = 10;
    double friction = 0.0;
    double pull = 0.5;                              ///< of the ends from each other, over the radius of the rings
    double slant = 0.0;                             ///< the same across it, along the plane of the first ring
    double angle_deg = 90.0;                        ///< between the planes of both
    double radius = 0.05, ring_over_radius = 20.0;  // mm
    double lower_radius = 1.0;                      ///< of the second ring's fibre, over that of the first
    contact::Places places = contact::Places::as_needed;
    bool free_stretch = false;  ///< of the sections that are held
    bool directed = true;       ///< directors of ends whose stretches are free are given
    double tolerance = 1.0;     ///< of all loops, over the default [1]
};

/// How a pair of hooks came out of its run.
struct Hooked {
    simulation::Report report;
    double force = 0.0;  ///< that pulls them apart [force]
    double crossing =
        0.0;  ///< by how much the lower one's lowest point lies below the upper one's highest [radius], > 0: still hooked
    double closest = 0.0;          ///< least distance of the centrelines, by brute force [radius]
    double asymmetry = 0.0;        ///< of both halves of each, unless they are pulled at a slant [radius]
    double most_asymmetric = 0.0;  ///< the same after any increment [radius]
    double bend = 0.0;             ///< radius over the radius of curvature at the tip [1]
    double deepest = 0.0;          ///< true depth of any accepted increment, over what is stated [1]
};

/// By how much both halves of each ring differ [radius]: through the plane across its own, or by half a turn about the pull where
/// the planes are not at a right angle.
template <class Simulator>
double halves_differ(const Simulator& simulator, const Hooks& hooks) {
    const double angle = hooks.angle_deg * std::numbers::pi / 180.0;
    double most = 0.0;
    for (const Index fibre : {Index{0}, Index{1}}) {
        const Vec3 plane = fibre == 0 ? Vec3(Vec3::UnitX()) : Vec3(std::cos(angle), std::sin(angle), 0.0);
        const Index last = 20 * hooks.elements;
        const auto point = [&](Index k) {
            return simulator.mesh().position(simulator.state(), fibre, static_cast<double>(k) / 20.0);
        };
        for (Index k = 0; k <= last; ++k) {
            const Vec3 b = point(last - k);
            const Vec3 mirrored = b - 2.0 * b.dot(plane) * plane, turned(-b.x(), -b.y(), b.z());
            most = std::max(most, (point(k) - (hooks.angle_deg == 90.0 ? mirrored : turned)).norm() / hooks.radius);
        }
    }
    return most;
}

/// Measures the true gap, and the symmetry, after each increment.
template <simulation::Model M>
struct DepthMeter {
    const simulation::Simulator<M>* simulator;
    const Hooks* hooks;
    double deepest = 0.0, most_asymmetric = 0.0;
    void reported(const simulation::IncrementReport&) {
        const simulation::Audit audit = simulation::audit(*simulator);
        deepest = std::max(deepest, -audit.least_gap.gap / audit.allowed);
        if (hooks->slant == 0.0) most_asymmetric = std::max(most_asymmetric, halves_differ(*simulator, *hooks));
    }
};

/// The first ring opens upwards and is pulled up; the second hangs in it and is pulled down. Their middles are free.
template <simulation::Model M>
Hooked pull_hooks(const Hooks& hooks) {
    const double r = hooks.radius, R = hooks.ring_over_radius * r, pi = std::numbers::pi;
    const Vec3 along(std::cos(hooks.angle_deg * pi / 180.0), std::sin(hooks.angle_deg * pi / 180.0), 0.0);
    scene::Assembly assembly;
    scene::FibreSpecification ring;
    ring.section = scene::circular(r), ring.material = {1e4, 0.3}, ring.elements = hooks.elements;
    ring.curve = [=](double t) { return Vec3(-R * std::cos(pi * t), 0.0, R - R * std::sin(pi * t)); };
    // A clamp that leaves stretches free holds the angle of its directors: across the plane of a ring it holds both halves alike.
    if (hooks.free_stretch && hooks.directed) ring.director = Vec3::UnitY();
    const Index upper = assembly.add(ring);
    const double r_2 = hooks.lower_radius * r;
    ring.section = scene::circular(r_2);
    ring.curve = [=](double t) {
        return Vec3(R * std::cos(pi * t) * along + (r + r_2 - R + R * std::sin(pi * t)) * Vec3::UnitZ());
    };
    if (hooks.free_stretch && hooks.directed) ring.director = Vec3::UnitZ().cross(along);
    const Index lower = assembly.add(ring);
    for (const Index fibre : {upper, lower})
        for (const scene::Station& end : {scene::first_end(fibre), scene::last_end(fibre)}) {
            const Vec3 way = (fibre == upper ? 0.5 : -0.5) * R * Vec3(hooks.slant, 0.0, hooks.pull);
            hooks.free_stretch ? assembly.clamp(end, way) : assembly.clamp_section(end, way);
        }
    simulation::ModelParameters<M> parameters;
    const double thin = std::min(r, r_2);
    parameters.normal.regularisation_depth = 1e-3 * thin;
    if constexpr (core::Active<typename M::Friction>)
        parameters.friction = {.friction_coefficient = hooks.friction, .reversible_displacement = 0.02 * thin};
    parameters.contact.stiffness.allowed_penetration = 1e-2 * thin;
    parameters.contact.places = hooks.places;
    for (double* tolerance :
         {&parameters.iteration.step_tolerance, &parameters.iteration.residual_tolerance, &parameters.iteration.normal_tolerance,
          &parameters.iteration.normal_step_tolerance, &parameters.iteration.contact_tolerance})
        *tolerance *= hooks.tolerance;
    if (hooks.tolerance < 1.0) parameters.iteration.normal_limit *= 3, parameters.iteration.contact_limit *= 3;
    simulation::Simulator<M> simulator(assembly, parameters);
    Hooked out;
    DepthMeter<M> meter{&simulator, &hooks};
    out.report = simulator.run({.increments = hooks.increments}, meter);
    out.deepest = meter.deepest, out.most_asymmetric = meter.most_asymmetric;
    if (hooks.slant == 0.0) out.asymmetry = halves_differ(simulator, hooks);
    const auto& mesh = simulator.mesh();
    const Vector& state = simulator.state();
    std::vector<Vec3> points[2];
    for (const Index fibre : {upper, lower})
        for (Index k = 0; k <= 20 * hooks.elements; ++k)
            points[fibre].push_back(mesh.position(state, fibre, static_cast<double>(k) / 20.0));
    out.closest = std::numeric_limits<double>::infinity();
    double lowest = out.closest, highest = -out.closest;
    for (const Vec3& a : points[0]) {
        lowest = std::min(lowest, a.z());
        for (const Vec3& b : points[1])
            out.closest = std::min(out.closest, (b - a).norm() / r), highest = std::max(highest, b.z());
    }
    out.crossing = (highest - lowest) / r;
    out.force = (simulator.reaction(scene::first_end(upper)) + simulator.reaction(scene::last_end(upper))).z();
    const double middle = 0.5 * static_cast<double>(hooks.elements);
    const Vec3 before = mesh.derivative(state, upper, middle - 0.5), after = mesh.derivative(state, upper, middle + 0.5);
    out.bend = r / mesh.fibre(upper).element_length * std::atan2(before.cross(after).norm(), before.dot(after));
    return out;
}

}  // namespace fibrant::test

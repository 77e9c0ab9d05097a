// SPDX-License-Identifier: MIT
#pragma once
/// @file Scenes of the tests of whole runs, and observers that keep what a run did.

#include <support/models.hpp>

#include <cmath>
#include <cstring>
#include <numbers>
#include <vector>

namespace fibrant::test {

/// The fibre of the reference solutions: along z, g_1 = x, clamped at s = 0. Lengths times `unit`, forces times `force`.
struct Rod {
    double radius = 0.0201, length = 2.01, young = 7300.0, poisson = 0.3;
    Index elements = 16;

    double bending_stiffness() const { return young * std::numbers::pi * std::pow(radius, 4) / 4.0; }
    /// Of the tip, clamped at the other end [force / length].
    double tip_stiffness() const { return 3.0 * bending_stiffness() / std::pow(length, 3); }
    scene::FibreSpecification specification() const {
        return {.from = Vec3::Zero(),
                .to = Vec3(0, 0, length),
                .section = scene::circular(radius),
                .material = {young, poisson},
                .elements = elements,
                .director = Vec3::UnitX()};
    }
    scene::Assembly clamped() const {
        scene::Assembly assembly;
        assembly.clamp(scene::first_end(assembly.add(specification())));
        return assembly;
    }
    /// With a dead force P along x at the other end, P L^2 / EI = `load`.
    scene::Assembly pushed(double load) const {
        scene::Assembly assembly = clamped();
        const double force = load * bending_stiffness() / (length * length);
        assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(force, 0, 0), "load"});
        return assembly;
    }
    /// Eleven of them side by side, each pushed by P L^2 / EI = `load`, and if asked for a twelfth that is `softness` times as
    /// soft.
    scene::Assembly row(double load, double softness = 0.0) const {
        scene::Assembly assembly;
        const double force = load * bending_stiffness() / (length * length);
        for (int k = 0; k < (softness > 0.0 ? 12 : 11); ++k) {
            scene::FibreSpecification fibre = specification();
            fibre.from.y() = fibre.to.y() = 4.0 * k * length;
            if (k == 11) fibre.material.young_modulus /= softness;
            const Index of = assembly.add(fibre);
            assembly.clamp(scene::first_end(of));
            assembly.apply(scene::DeadForce{scene::last_end(of), scene::NodeVector::position, Vec3(force, 0, 0), "load"});
        }
        return assembly;
    }
};

/// Two crossing fibres, clamped at their ends; the ends of the upper one (fibre 1) move down by `approach` and aside by
/// `drag`, on the channels of these names.
struct Crossing {
    double radius = 0.0201, length = 1.005, young = 7300.0, approach = 0.01, drag = 0.0;
    Index elements = 8;
    bool swapped = false;  ///< number the fibres the other way round

    Index lower() const { return swapped ? 1 : 0; }
    Index upper() const { return swapped ? 0 : 1; }
    scene::Assembly assembly() const {
        const scene::CrossSection section = scene::circular(radius);
        const scene::ElasticMaterial material{young, 0.3};
        const double half = 0.5 * length, height = 2.0 * radius;
        const scene::FibreSpecification below{
            .from = {0, -half, 0}, .to = {0, half, 0}, .section = section, .material = material, .elements = elements};
        const scene::FibreSpecification above{
            .from = {-half, 0, height}, .to = {half, 0, height}, .section = section, .material = material, .elements = elements};
        scene::Assembly scene;
        scene.add(swapped ? above : below);
        scene.add(swapped ? below : above);
        for (const double end : {0.0, 1.0}) {
            scene.clamp({lower(), end}, Vec3(drag, 0, 0), Vec3::Zero(), Vec3::Zero(), "drag");
            scene.clamp({upper(), end}, Vec3(0, 0, -approach), Vec3::Zero(), Vec3::Zero(), "approach");
        }
        return scene;
    }
};

/// Parameters that the models above need; lengths in multiples of `radius`.
template <simulation::Model M>
simulation::ModelParameters<M> model_parameters(double radius) {
    simulation::ModelParameters<M> parameters = direct_parameters<M>();
    parameters.normal.regularisation_depth = 1e-3 * radius;
    parameters.contact.stiffness.allowed_penetration = 1e-2 * radius;
    if constexpr (core::Active<typename M::Friction>)
        parameters.friction = {.friction_coefficient = 0.15, .reversible_displacement = 0.02 * radius};
    return parameters;
}

/// Tolerances so small that what is left is the discretisation.
template <simulation::Model M>
simulation::ModelParameters<M> tight_parameters(double radius) {
    simulation::ModelParameters<M> parameters = model_parameters<M>(radius);
    parameters.iteration.step_tolerance = 1e-8;
    parameters.iteration.residual_tolerance = 1e-9;
    parameters.iteration.linear_tolerance = 1e-10;
    return parameters;
}

/// Same bits?
inline bool same_bits(const Vector& a, const Vector& b) {
    return a.size() == b.size() && std::memcmp(a.data(), b.data(), core::at(a.size()) * sizeof(double)) == 0;
}

/// Keeps the state, the reports and chosen amplitudes of every accepted increment.
template <simulation::Model M>
struct Record {
    explicit Record(const simulation::Simulator<M>& simulator) : simulator_{&simulator} {}
    std::vector<Vector> states;
    std::vector<simulation::IncrementReport> increments;
    void reported(const simulation::IncrementReport& increment) {
        increments.push_back(increment);
        states.push_back(simulator_->state());
    }

private:
    const simulation::Simulator<M>* simulator_;
};

}  // namespace fibrant::test

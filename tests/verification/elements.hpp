// SPDX-License-Identifier: MIT
#pragma once
/// @file Reference problems of one rod, run through the simulator with any beam element.

#include <support/models.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace fibrant::test {

template <simulation::Model M>
simulation::ModelParameters<M> exact_parameters() {
    simulation::ModelParameters<M> parameters = direct_parameters<M>();
    parameters.normal.regularisation_depth = 1e-5;
    parameters.contact.stiffness.allowed_penetration = 1e-4;
    parameters.iteration.step_tolerance = 1e-9;
    parameters.iteration.residual_tolerance = 1e-8;
    parameters.iteration.linear_tolerance = 1e-10;
    parameters.iteration.newton_limit = 60;
    parameters.iteration.normal_tolerance = 1e-5;
    parameters.iteration.normal_step_tolerance = 1e-5;
    parameters.iteration.contact_tolerance = 1e-4;
    parameters.iteration.inexact = 0.05;
    parameters.iteration.normal_limit = parameters.iteration.contact_limit = 20;
    if constexpr (core::Active<typename M::Friction>)
        parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = 4e-4};
    return parameters;
}

/// The fibre of the reference solutions: along z, g_1 = x, r = 0.0201, E = 7300, nu = 0.3.
struct ReferenceRod {
    double length = 2.01;
    Index elements = 16;
    static constexpr double radius = 0.0201, young = 7300.0;

    static double area() { return std::numbers::pi * radius * radius; }
    static double bending() { return 0.25 * young * area() * radius * radius; }
    scene::FibreSpecification specification() const {
        return {.from = Vec3::Zero(),
                .to = Vec3(0, 0, length),
                .section = scene::circular(radius),
                .material = {young, 0.3},
                .elements = elements,
                .director = Vec3::UnitX()};
    }
};

template <simulation::Model M>
struct Solved {
    explicit Solved(const scene::Assembly& assembly, const simulation::ModelParameters<M>& parameters = exact_parameters<M>())
        : simulator(assembly, parameters) {}
    bool run(std::vector<simulation::Ramp> ramps, Index increments) {
        simulation::Stage<M> stage;
        stage.ramps = std::move(ramps), stage.increments = increments;
        simulation::Loading<M> loading;
        loading.stages = {stage};
        report = simulator.run(loading);
        if (!report.converged) std::printf("not converged: %s\n", report.reason.c_str());
        return report.converged;
    }
    simulation::Simulator<M> simulator;
    simulation::Report report;
};

/// Tip of a cantilever under a dead force P along x, P L^2 / EI = load, as (x, z); NaN if not converged.
template <simulation::Model M>
Eigen::Vector2d pushed_tip(double slenderness, double load, Index elements) {
    const ReferenceRod rod{slenderness * ReferenceRod::radius, elements};
    scene::Assembly assembly;
    const Index fibre = assembly.add(rod.specification());
    assembly.clamp(scene::first_end(fibre));
    assembly.apply(scene::DeadForce{scene::last_end(fibre), scene::NodeVector::position,
                                    Vec3(load * rod.bending() / (rod.length * rod.length), 0, 0), "load"});
    Solved<M> solved(assembly);
    if (!solved.run({{"load", 1.0}}, 4)) return Eigen::Vector2d::Constant(core::unset);
    const Vec3 tip = solved.simulator.value(scene::last_end(fibre));
    return {tip.x(), tip.z()};
}

/// Tip of a cantilever rolled up by a moment about y of 2 pi turns EI / L.
template <simulation::Model M>
Eigen::Vector2d rolled_tip(double turns, Index elements, Index increments) {
    const ReferenceRod rod{2.01, elements};
    scene::Assembly assembly;
    const Index fibre = assembly.add(rod.specification());
    assembly.clamp(scene::first_end(fibre));
    assembly.apply(scene::Moment{scene::last_end(fibre), scene::NodeVector::director_1,
                                 Vec3(0, 2.0 * std::numbers::pi * turns * rod.bending() / rod.length, 0), "load"});
    Solved<M> solved(assembly);
    if (!solved.run({{"load", 1.0}}, increments)) return Eigen::Vector2d::Constant(core::unset);
    const Vec3 tip = solved.simulator.value(scene::last_end(fibre));
    return {tip.x(), tip.z()};
}

/// Force at mid-span of a rod that is stretched by `strain` between clamps and pushed sideways there by `depth` radii.
template <simulation::Model M>
double sideways_force(double slenderness, double strain, double depth, Index elements) {
    const ReferenceRod rod{slenderness * ReferenceRod::radius, elements};
    scene::Assembly assembly;
    const Index fibre = assembly.add(rod.specification());
    assembly.clamp(scene::first_end(fibre));
    assembly.clamp(scene::last_end(fibre), Vec3(0, 0, strain * rod.length), Vec3::Zero(), Vec3::Zero(), "stretch");
    scene::Hold push;
    push.at = {fibre, 0.5};
    push.directions = Vec3(1, 0, 0).asDiagonal();
    push.displacement = Vec3(depth * ReferenceRod::radius, 0, 0);
    push.channel = "push";
    assembly.hold(push);
    Solved<M> solved(assembly);
    if (!solved.run({{"stretch", 1.0}}, 1) || !solved.run({{"push", 1.0}}, 4)) return core::unset;
    return solved.simulator.reaction({fibre, 0.5}).x();
}

/// The 45-degree bend of Bathe and Bolourchi: radius 100 in x-y, from the origin along x, square section of side 1 or less (by
/// its area and second moments), E = 1e7, nu = 0, dead force along z.
template <simulation::Model M>
Vec3 bend_tip(double side, double force, Index elements) {
    const double quarter = 0.25 * std::numbers::pi;
    scene::FibreSpecification fibre;
    fibre.curve = [=](double t) { return Vec3(100.0 * std::sin(t * quarter), 100.0 * (1.0 - std::cos(t * quarter)), 0.0); };
    fibre.section = scene::circular(side / std::sqrt(std::numbers::pi));
    fibre.section.inertia_factor = std::numbers::pi / 3.0;  // side^4 / 12
    fibre.material = {1e7, 0.0};
    fibre.elements = elements;
    fibre.director = Vec3::UnitY();
    scene::Assembly assembly;
    assembly.add(fibre);
    assembly.clamp(scene::first_end(0));
    assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(0, 0, force), "load"});
    Solved<M> solved(assembly);
    if (!solved.run({{"load", 1.0}}, 4)) return Vec3::Constant(core::unset);
    return solved.simulator.value(scene::last_end(0));
}

/// A column of 200 radii between clamps, pressed together by `shortening`, with a push at mid-span that is let go.
/// @returns thrust, deflection of the middle
template <simulation::Model M>
Eigen::Vector2d buckled_column(double shortening, Index elements) {
    const ReferenceRod rod{4.02, elements};
    scene::Assembly assembly;
    assembly.add(rod.specification());
    assembly.clamp(scene::first_end(0));
    assembly.clamp(scene::last_end(0), Vec3(0, 0, -shortening), Vec3::Zero(), Vec3::Zero(), "press");
    assembly.apply(scene::DeadForce{{0, 0.5}, scene::NodeVector::position, Vec3(1e-3, 0, 0), "push"});
    Solved<M> solved(assembly);
    if (!solved.run({{"push", 1.0}}, 2) || !solved.run({{"press", 1.0}}, 8) || !solved.run({{"push", 0.0}}, 2))
        return Eigen::Vector2d::Constant(core::unset);
    return {solved.simulator.reaction(scene::first_end(0)).z(), solved.simulator.value({0, 0.5}).x()};
}

struct Pressed {
    double force = core::unset, unbalance = 0.0, lost = 0.0;
    Index active = 0;
};
/// Two crossed fibres clamped at their ends, stretched, and pressed together until their centre lines have approached each
/// other by u, beside what contact takes.
template <simulation::Model M>
Pressed pressed_fibres(double length, double strain, double u, double angle_deg, Index elements) {
    const double r = ReferenceRod::radius, angle = angle_deg * std::numbers::pi / 180.0;
    scene::Assembly assembly;
    for (const bool upper : {false, true}) {
        const Vec3 along = upper ? Vec3(std::cos(angle), std::sin(angle), 0.0) : Vec3::UnitX(),
                   centre = upper ? Vec3(0.0, 0.0, 2.0 * r) : Vec3(Vec3::Zero());
        scene::FibreSpecification fibre = ReferenceRod{length, elements}.specification();
        fibre.from = centre - 0.5 * length * along, fibre.to = centre + 0.5 * length * along, fibre.director = Vec3::UnitZ();
        const Index f = assembly.add(fibre);
        for (const double end : {0.0, 1.0}) {
            scene::Hold axial;
            axial.at = {f, end}, axial.directions = along * along.transpose(), axial.channel = "stretch";
            axial.displacement = (end - 0.5) * strain * length * along;
            assembly.hold(axial);
            axial.directions = Mat3::Identity() - axial.directions, axial.channel = "motion";
            axial.displacement = upper ? Vec3(0, 0, -u) : Vec3(Vec3::Zero());
            assembly.hold(axial);
            assembly.hold_rotation({f, end});
        }
    }
    Solved<M> solved(assembly);
    if (!solved.run({{"stretch", 1.0}}, 2)) return {};
    const auto z = [&](Index f, double s) { return solved.simulator.value({f, s}).z(); };
    double amplitude = 1.0;
    Pressed result;
    for (int n = 0; n < 8; ++n) {
        if (!solved.run({{"motion", amplitude}}, n == 0 ? 4 : 1)) return {};
        const double reached = z(0, 0.0) - z(0, 0.5) + z(1, 0.5) - z(1, 0.0);
        result.lost = amplitude * u - reached;
        if (std::abs(u - reached) < 1e-6 * u) break;
        amplitude += (u - reached) / u;
    }
    const auto support = [&](Index f) { return Vec3(solved.simulator.reaction({f, 0.0}) + solved.simulator.reaction({f, 1.0})); };
    result.force = support(0).z();
    result.unbalance = (support(0) + support(1)).norm() / result.force;
    result.active = solved.report.contact.active;
    return result;
}

/// Order of convergence of errors at meshes that are refined by 2.
inline double order(double coarse, double fine) { return std::log2(coarse / fine); }

}  // namespace fibrant::test

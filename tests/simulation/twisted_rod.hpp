// SPDX-License-Identifier: MIT
#pragma once
/// @file A straight rod whose ends are turned against each other and then approach: it leaps into a loop, and a loop into a
/// plectoneme.

#include <simulation/scenes.hpp>

#include <algorithm>
#include <numbers>

namespace fibrant::test {

/// A straight rod with a slight bow, its ends turned against each other by four turns; then they approach.
struct Twisted {
    double radius = 0.05, length = 200.0, slack = 0.2;  // mm; radii; of the length
    Index elements = 40, increments = 30;               // of the approach
    double damping = 0.0;                               // of both stages, for a path of its own

    scene::Assembly assembly() const {
        scene::Assembly scene;
        scene::FibreSpecification rod;
        rod.section = scene::circular(radius), rod.material = {1e4, 0.3}, rod.elements = elements;
        rod.curve = [r = radius, l = length](double t) {
            const double pi = std::numbers::pi;
            return Vec3(r * Vec3(l * t, 0.5 * std::sin(pi * t), 0.2 * std::sin(2.0 * pi * t)));
        };
        const Index fibre = scene.add(rod);
        for (const double side : {-1.0, 1.0}) {
            const scene::Station end = side < 0.0 ? scene::first_end(fibre) : scene::last_end(fibre);
            scene.prescribe(end, -0.5 * side * slack * length * radius * Vec3::UnitX(), "slack");
            scene.hold_rotation(end, 4.0 * side * std::numbers::pi * Vec3::UnitX(), "turn");
        }
        return scene;
    }
    template <simulation::Model M = Smooth>
    simulation::Loading<M> loading() const {
        simulation::Loading<M> loading;
        loading.calmed = true;
        loading.stages.push_back({.name = "turn", .increments = 30, .ramps = {{"turn", 1.0}}, .damping = damping});
        loading.stages.push_back({.name = "slack", .increments = increments, .ramps = {{"slack", 1.0}}, .damping = damping});
        loading.stages.back().most_increments = std::max<Index>(20 * increments, 1000);
        if (damping > 0.0) {
            loading.stages.push_back(
                {.name = "rest", .increments = 1, .damping = damping, .damping_decay = 0.3, .damping_share = 1e-8});
            loading.stages.back().until = [](const simulation::IncrementReport&) { return true; };
        }
        return loading;
    }
    template <simulation::Model M = Smooth>
    simulation::ModelParameters<M> parameters() const {
        simulation::ModelParameters<M> parameters;
        parameters.normal.regularisation_depth = 1e-3 * radius, parameters.contact.stiffness.allowed_penetration = 1e-2 * radius;
        return parameters;
    }
};

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Small scenes with one number that goes over decades, and what their results are held to: for tests, and for the
/// benchmark that draws them.

#include "small_scenes.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace fibrant::test {

inline constexpr std::array slendernesses{10.0, 30.0, 100.0, 1e3, 1e4, 1e5};
inline constexpr std::array stiffness_ratios{1.0, 1e2, 1e4, 1e6};
inline constexpr std::array allowed_penetrations{1e-5, 1e-4, 1e-3, 1e-2, 5e-2};
inline constexpr std::array penalties{1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0, 10.0};  ///< over the stiffness of a section

/// Two fibres of a length that cross in the middle, clamped at their ends; the upper one comes down by `approach`.
inline SmallScene crossed(double length, double approach) {
    const double r = 0.0201;
    SmallScene scene;
    SmallFibre lower{Vec3(0, -0.5 * length, 0), Vec3(0, 0.5 * length, 0)},
        upper{Vec3(-0.5 * length, 0, 2.0 * r), Vec3(0.5 * length, 0, 2.0 * r)};
    upper.move_from = upper.move_to = Vec3(0, 0, -approach);
    scene.fibres = {lower, upper};
    for (SmallFibre& f : scene.fibres) f.elements = 16;
    return scene;
}
/// Force on the middle over its deflection by beam theory with shear: F L^3 / (192 E I) (1 + 24 (1 + nu) (r/L)^2).
inline double stiffness_of(const SmallFibre& f) {
    const double length = (f.to - f.from).norm(), inertia = 0.25 * std::numbers::pi * std::pow(f.radius, 4);
    return 192.0 * f.young * inertia / std::pow(length, 3) / (1.0 + 24.0 * 1.3 * std::pow(f.radius / length, 2));
}
/// Force of crossed fibres whose middles give way by `approach` in all.
inline double theory_force(const SmallScene& scene, double approach) {
    return approach / (1.0 / stiffness_of(scene.fibres[0]) + 1.0 / stiffness_of(scene.fibres[1]));
}

/// An approach so small that tension, (u / r)^2 / 8, stays below 1e-4.
inline const double small_approach = 0.02 * 0.0201;

/// Pressed by a fiftieth of a radius, to tolerances that leave rounding only.
inline SmallScene pressed(double slenderness, double stiffness_ratio = 1.0) {
    SmallScene scene = crossed(slenderness * 0.0201, small_approach);
    scene.fibres[0].young *= stiffness_ratio;
    scene.allowed = 1e-4, scene.tight = true;
    return scene;
}
/// The force over that of beam theory, less what the fibres are in each other.
inline double force_over_theory(const SmallScene& scene, const SmallResult& result) {
    return result.support[0].z() / theory_force(scene, small_approach - result.report.contact.greatest_penetration);
}
/// Pressed by a radius; the stiffness adapts after each increment, so three stages at rest follow.
inline SmallScene sinking(double allowed) {
    SmallScene scene = crossed(100.0 * 0.0201, 0.0201);
    scene.allowed = allowed, scene.cycle.assign(4, 1.0), scene.increments = 6;
    return scene;
}

/// A penalty that stays as it is.
/// @param penalty  over the stiffness of a section
inline SmallScene held_at(double penalty) {
    SmallScene scene = pressed(100.0);
    scene.penalty = penalty, scene.allowed = 1e-6;
    return scene;
}
/// Its stiffness [force / length].
inline double penalty_stiffness(const SmallScene& scene) {
    const SmallFibre& f = scene.fibres[0];
    return scene.penalty *
           contact::section_stiffness({f.young, 0.3}, 0.5 * (f.to - f.from).norm() / static_cast<double>(f.elements));
}
/// Force of the two fibres and the penalty, three springs in a row; the law's smooth start takes half of its depth.
inline double theory_force_on_penalty(const SmallScene& scene) {
    const double start = 0.05 * scene.allowed * scene.radius();
    return (small_approach - start) / (small_approach / theory_force(scene, small_approach) + 1.0 / penalty_stiffness(scene));
}

}  // namespace fibrant::test

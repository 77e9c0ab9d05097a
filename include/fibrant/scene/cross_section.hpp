// SPDX-License-Identifier: MIT
#pragma once
/// @file Elliptical cross-sections at rest, hollow ones, and the macro-fibre that stands for several fibres.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fibrant::scene {

/// Section of a fibre at rest: an ellipse with semi-axes along the directors g_1 and g_2. A round one may have a round hole along
/// its axis, in which other fibres may be (scene::Tube).
struct CrossSection {
    double semi_axis_1 = core::unset;  ///< along g_1 [length], > 0
    double semi_axis_2 = core::unset;  ///< along g_2 [length], > 0
    double inertia_factor = 1.0;       ///< multiplies the second moments in bending and torsion [1], > 0
    double bore = 0.0;                 ///< radius of the hole [length], in [0, semi_axis_1); 0: none

    void validate() const {
        core::require_positive("CrossSection.semi_axis_1", semi_axis_1);
        core::require_positive("CrossSection.semi_axis_2", semi_axis_2);
        core::require_positive("CrossSection.inertia_factor", inertia_factor);
        core::require_not_negative("CrossSection.bore", bore);
        if (bore == 0.0) return;
        core::require(bore < semi_axis_1, "CrossSection.bore", bore, "< semi_axis_1 = " + core::text(semi_axis_1));
        core::require(semi_axis_1 == semi_axis_2, "CrossSection.bore", bore, "0, of a section that is not round");
    }
    /// Of what is solid [length^2].
    double area() const noexcept { return outer_area() - std::numbers::pi * bore * bore; }
    /// Integral of xi_1^2 [length^4]: bending that turns g_1.
    double second_moment_1() const noexcept {
        return inertia_factor * 0.25 * outer_area() * semi_axis_1 * semi_axis_1 - hole_moment();
    }
    /// Integral of xi_2^2 [length^4].
    double second_moment_2() const noexcept {
        return inertia_factor * 0.25 * outer_area() * semi_axis_2 * semi_axis_2 - hole_moment();
    }
    /// Circumscribed radius [length]: what a search has to reach.
    double radius() const noexcept { return std::max(semi_axis_1, semi_axis_2); }
    /// Half extent along a unit direction of the section that the directors deform [length].
    double extent(const Vec3& g_1, const Vec3& g_2, const Vec3& direction) const noexcept {
        const double p = semi_axis_1 * g_1.dot(direction), q = semi_axis_2 * g_2.dot(direction);
        return std::sqrt(p * p + q * q);
    }
    /// Greatest half extent, in any direction, of the section that the directors deform [length].
    double greatest_extent(const Vec3& g_1, const Vec3& g_2) const noexcept {
        const double pp = semi_axis_1 * semi_axis_1 * g_1.squaredNorm(), qq = semi_axis_2 * semi_axis_2 * g_2.squaredNorm();
        const double mixed = semi_axis_1 * semi_axis_2 * g_1.dot(g_2), half = 0.5 * (pp - qq);
        return std::sqrt(0.5 * (pp + qq) +
                         std::sqrt(half * half + mixed * mixed));  // greatest singular value of the two half axes
    }
    /// True over kinematic torsion constant of the ellipse, 4 a^2 b^2 / (a^2 + b^2)^2 [1]; 1 for a circle.
    double torsion_factor() const noexcept {
        const double p = semi_axis_1 * semi_axis_1, q = semi_axis_2 * semi_axis_2;
        return 4.0 * p * q / ((p + q) * (p + q));
    }

private:
    double outer_area() const noexcept { return std::numbers::pi * semi_axis_1 * semi_axis_2; }
    double hole_moment() const noexcept { return inertia_factor * 0.25 * std::numbers::pi * bore * bore * bore * bore; }
};

/// A round section.
/// @param radius  [length], > 0
inline CrossSection circular(double radius, double inertia_factor = 1.0) {
    core::require_positive("circular.radius", radius);
    return {radius, radius, inertia_factor};
}

/// A round section with a round hole along its axis.
/// @param radius  [length], > 0
/// @param bore    radius of the hole [length], in (0, radius)
inline CrossSection hollow(double radius, double bore, double inertia_factor = 1.0) {
    core::require_positive("hollow.bore", bore);
    const CrossSection section{radius, radius, inertia_factor, bore};
    section.validate();
    return section;
}

/// An elliptical section.
/// @param semi_axis_1, semi_axis_2  [length], > 0
inline CrossSection elliptical(double semi_axis_1, double semi_axis_2, double inertia_factor = 1.0) {
    const CrossSection section{semi_axis_1, semi_axis_2, inertia_factor};
    section.validate();
    return section;
}

/// Section of each of `macro_fibres` that stand for `fibres` real ones: the total area is kept and the second moments
/// are those of the real fibres (Durville, eq. 3 and 4).
///
/// @param fibres        real fibres in the bundle, >= macro_fibres
/// @param diameter      of a real fibre [length], > 0
/// @param macro_fibres  that represent them, >= 1
inline CrossSection macro_fibre(double fibres, double diameter, double macro_fibres) {
    core::require_positive("macro_fibre.diameter", diameter);
    core::require(std::isfinite(macro_fibres) && macro_fibres >= 1.0, "macro_fibre.macro_fibres", macro_fibres, ">= 1");
    core::require(std::isfinite(fibres) && fibres >= macro_fibres, "macro_fibre.fibres", fibres,
                  ">= macro_fibres = " + core::text(macro_fibres));
    return circular(0.5 * diameter * std::sqrt(fibres / macro_fibres), macro_fibres / fibres);
}

}  // namespace fibrant::scene

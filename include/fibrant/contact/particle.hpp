// SPDX-License-Identifier: MIT
#pragma once
/// @file Material particle on the deformed contour of a section that lies furthest along a direction.

#include <fibrant/core/types.hpp>
#include <fibrant/scene/cross_section.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::contact {

/// Material coordinates of a particle of the contour; a cap stands for a fibre's end.
struct Particle {
    double xi_1 = 0.0, xi_2 = 0.0;  ///< in the section [length]
    double cap = 0.0;               ///< radius of a spherical end about the centre, where the section gives none [length]
};

/// Support point of an elliptical section: with c_a = g_a . direction, xi = (a^2 c_1, b^2 c_2) / sqrt(a^2 c_1^2 + b^2 c_2^2).
///
/// Durville takes the direction between the two centres; the extreme point along the normal is the same for round
/// sections, and to first order its motion does not change the gap.
/// @param g_1, g_2   directors at the station
/// @param direction  unit
/// @param at_end     the contact is with the rounded end of the fibre
inline Particle support_particle(const scene::CrossSection& section, const Vec3& g_1, const Vec3& g_2, const Vec3& direction,
                                 bool at_end) noexcept {
    const double p = section.semi_axis_1 * g_1.dot(direction), q = section.semi_axis_2 * g_2.dot(direction);
    const double reach = std::sqrt(p * p + q * q);
    if (at_end || reach < 0.1 * std::min(section.semi_axis_1, section.semi_axis_2))  // seen along the fibre
        return {0.0, 0.0, section.radius()};
    return {section.semi_axis_1 * p / reach, section.semi_axis_2 * q / reach, 0.0};
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file Direction of the contact normal between two fibres, by the angle between them, with a remembered orientation.

#include <fibrant/contact/section_gap.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace fibrant::contact {

/// Angles at which the rule for the normal changes.
struct NormalRule {
    double parallel_angle_deg = 10.0;  ///< below: direction between the centres [degree]
    double crossing_angle_deg = 30.0;  ///< above: cross product of the tangents [degree]
    /// Part of the distance at which sections touch, within which fibres side by side keep their last normal, and fade over to
    /// the direction between the centres beyond half of it, >= 0: for fibres that start deep in each other and part by one side.
    double kept_within = 0.0;
    void validate() const {
        core::require_between("NormalRule.parallel_angle_deg", parallel_angle_deg, 0.0, 90.0);
        core::require_between("NormalRule.crossing_angle_deg", crossing_angle_deg, parallel_angle_deg, 90.0);
        core::require_not_negative("NormalRule.kept_within", kept_within);
    }
};

/// Sine of the acute angle between two unit vectors.
inline double sine_between(const Vec3& a, const Vec3& b) noexcept { return std::min(1.0, a.cross(b).norm()); }

/// Acute angle between two unit vectors [degree].
inline double angle_between_deg(const Vec3& a, const Vec3& b) noexcept {
    return std::atan2(a.cross(b).norm(), std::abs(a.dot(b))) * 180.0 / std::numbers::pi;
}

/// Angle between two vectors [radian]; 0 where one vanishes.
inline double turn_between(const Vec3& a, const Vec3& b) noexcept { return std::atan2(a.cross(b).norm(), a.dot(b)); }

/// Unit vector along `direction`, or `otherwise` where it vanishes.
inline Vec3 unit_or(const Vec3& direction, const Vec3& otherwise) noexcept {
    const double size = direction.norm();
    return size > 0.0 ? Vec3(direction / size) : otherwise;
}

/// A vector turned by the least rotation that takes the unit vector `before` to the unit vector `after`.
inline Vec3 turned(const Vec3& vector, const Vec3& before, const Vec3& after) noexcept {
    const Vec3 axis = before.cross(after);  // Rodrigues' formula, by sine and cosine; opposite: half a turn, about any axis
    const double cosine = before.dot(after);
    if (1.0 + cosine < 1e-14) {
        const Vec3 across = before.unitOrthogonal();
        return 2.0 * across.dot(vector) * across - vector;
    }
    return cosine * vector + axis.cross(vector) + axis.dot(vector) / (1.0 + cosine) * axis;
}

/// The same of a vector in the plane of the unit normal `before`, which comes to lie in that of `after`.
inline Vec3 turned_with_plane(const Vec3& vector, const Vec3& before, const Vec3& after) noexcept {
    const Vec3 sum = turned(vector, before, after);
    return sum - sum.dot(after) * after;
}

/// Mean direction of two tangents, the second turned so that the angle is acute.
inline Vec3 mean_tangent(const Vec3& t_i, const Vec3& t_j) noexcept {
    const Vec3 sum = t_i.dot(t_j) < 0.0 ? Vec3(t_i - t_j) : Vec3(t_i + t_j);
    return sum.normalized();
}

/// Sections that are round, or taken to be: what the normal of two fibres has to know of them.
struct RoundSections {
    double touching = std::numeric_limits<double>::infinity();  ///< sum of the radii [length]
    double size = 0.0;  ///< of the pair: centres that are a 1e-9th of it apart coincide [length]

    double touching_along(const Vec3&) const noexcept { return touching; }
    /// Direction across `tangent` in which the two are furthest apart: between the centres.
    /// @param across  from centre to centre, across the tangent, not zero [length]
    Vec3 furthest(const Vec3& across, const Vec3&, const Vec3&) const noexcept { return across.normalized(); }
};

/// Sections that are not round: ellipses in space, in any strain.
struct FlatSections {
    SectionAxes i, j;
    bool anywhere = false;  ///< the pair is the closest one of a crossing
    double size = 0.0;      ///< of the pair: centres that are a 1e-9th of it apart coincide [length]

    /// Sum of their half extents along a direction [length].
    double touching_along(const Vec3& direction) const noexcept {
        return anywhere ? std::numeric_limits<double>::infinity() : i.extent(direction) + j.extent(direction);
    }
    /// Direction across `tangent` in which the two are furthest apart, on the side of `side`.
    Vec3 furthest(const Vec3& across, const Vec3& tangent, const Vec3& side) const noexcept {
        const Vec3 flat = side - side.dot(tangent) * tangent;
        return furthest_direction(across, i, j, tangent, unit_or(flat, across.normalized()));
    }
};

/// Normal from fibre i to fibre j.
///
/// The chapter says only that the rule depends on the angle and must be oriented so that fibres do not pass through each
/// other; the cross product for crossing fibres, the direction in which the sections are furthest apart for parallel ones, that
/// of the centres if both are round, and the smooth blend between them are ours. The sign is that of `remembered`: taken from the
/// last normal of this contact while it lives, never from present positions, which is how fibres would get through.
/// @param centres     x_j - x_i [length]
/// @param t_i, t_j    unit tangents
/// @param remembered  last normal, or zero for a contact that is new: then the side is taken from `centres`
/// @param sections    touch at a sum of half extents aside, for a pair that need not be the closest one of a crossing: the cross
///                    product fades out where the centres are 1/4 to 1/2 of it apart across itself. Fibres that part in
///                    one plane would otherwise be in contact along its normal, with the greatest penetration there is.
template <class Sections>
Vec3 normal_direction(const NormalRule& rule, const Vec3& centres, const Vec3& t_i, const Vec3& t_j, const Vec3& remembered,
                      const Sections& sections) noexcept {
    const auto smooth_step = [](double t) { return t <= 0.0 ? 0.0 : t >= 1.0 ? 1.0 : t * t * (3.0 - 2.0 * t); };
    const Vec3 side = remembered.isZero() ? centres : remembered;
    const double angle = angle_between_deg(t_i, t_j);
    const Vec3 tangent = mean_tangent(t_i, t_j);
    const Vec3 across = centres - centres.dot(tangent) * tangent;
    Vec3 crossing = Vec3::Zero();
    double weight = 0.0;  // of the cross product
    if (angle > rule.parallel_angle_deg) {
        crossing = t_i.cross(t_j).normalized();
        if (crossing.dot(side) < 0.0) crossing = -crossing;
        weight = angle >= rule.crossing_angle_deg
                     ? 1.0
                     : smooth_step((angle - rule.parallel_angle_deg) / (rule.crossing_angle_deg - rule.parallel_angle_deg));
        const Vec3 beside = across - across.dot(crossing) * crossing;
        const double aside = beside.norm();
        weight *= 1.0 - smooth_step(4.0 * aside / sections.touching_along(aside > 0.0 ? Vec3(beside / aside) : crossing) - 1.0);
        if (weight == 1.0) return crossing;
    }
    Vec3 parallel = across.norm() > 1e-9 * std::max(sections.size, centres.norm())
                        ? sections.furthest(across, tangent, side)
                        : unit_or(side - side.dot(tangent) * tangent, Vec3::Zero());
    if (parallel.isZero()) {  // coincident centrelines without a memory: any side will do, but the same one each time
        Index axis = 0;
        tangent.cwiseAbs().minCoeff(&axis);
        parallel = tangent.cross(Vec3(Vec3::Unit(axis))).normalized();
    }
    if (rule.kept_within > 0.0 && !remembered.isZero() && parallel.dot(side) > 0.0) {
        const double touching = sections.touching_along(unit_or(across, parallel));
        const double keep = 1.0 - smooth_step(2.0 * across.norm() / (rule.kept_within * touching) - 1.0);
        if (keep > 0.0)
            parallel = unit_or(keep * unit_or(side - side.dot(tangent) * tangent, parallel) + (1.0 - keep) * parallel, parallel);
    }
    if (parallel.dot(side) < 0.0)  // the centres have passed each other: push them back the way they came
        parallel = unit_or(side - side.dot(tangent) * tangent, -parallel);
    return weight > 0.0 ? unit_or(weight * crossing + (1.0 - weight) * parallel, parallel) : parallel;
}

/// The same of round sections.
/// @param touching  sum of the radii [length]; infinite for the closest pair of a crossing
inline Vec3 normal_direction(const NormalRule& rule, const Vec3& centres, const Vec3& t_i, const Vec3& t_j,
                             const Vec3& remembered, double touching = std::numeric_limits<double>::infinity()) noexcept {
    return normal_direction(rule, centres, t_i, t_j, remembered, RoundSections{touching});
}

}  // namespace fibrant::contact

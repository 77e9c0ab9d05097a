// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres of a yarn's section, and how thick it lies.

#include <fibrant/compositions/textile/textile.hpp>
#include <fibrant/compositions/weave/packing.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Centres of the fibres of a yarn: across it, and along its thickness [length]. Three and four fibres of a round yarn lie in the
/// least circle that holds them, a triangle and a square; a compact packing about one fibre would have three in a row. Five lie
/// in a ring, and six, eight and nine in a ring about one: a compact packing of them is a slanted row, far broader than thick.
inline std::vector<Eigen::Vector2d> section_of(const YarnType& type) {
    const double half_pitch = type.radius * (1.0 + type.packing_gap);
    if (type.aspect == 1.0 && type.fibres == 3) {
        const double height = std::sqrt(3.0) * half_pitch;
        return {{-half_pitch, -height / 3.0}, {half_pitch, -height / 3.0}, {0.0, 2.0 * height / 3.0}};
    }
    if (type.aspect == 1.0 && type.fibres == 4)
        return {{-half_pitch, -half_pitch}, {half_pitch, -half_pitch}, {-half_pitch, half_pitch}, {half_pitch, half_pitch}};
    if (const Index n = type.fibres; type.aspect == 1.0 && (n == 5 || n == 6 || n == 8 || n == 9)) {
        const Index inside = n == 5 ? 0 : 1, around = n - inside;
        const double step = 2.0 * std::numbers::pi / static_cast<double>(around),
                     ring = half_pitch * std::max(inside > 0 ? 2.0 : 0.0, 1.0 / std::sin(0.5 * step));
        std::vector<Eigen::Vector2d> centres(core::at(inside), Eigen::Vector2d::Zero());
        for (Index k = 0; k < around; ++k) {
            const double angle = step * (static_cast<double>(k) + 0.5) - 0.5 * std::numbers::pi;
            centres.emplace_back(ring * std::cos(angle), ring * std::sin(angle));
        }
        return centres;
    }
    return weave::compact_packing(type.fibres, type.radius, type.aspect, type.packing_gap).centres;
}

/// Distance of the outermost point of a yarn's section from its path [length].
inline double outermost(const YarnType& type) {
    double furthest = 0.0;
    for (const Eigen::Vector2d& centre : section_of(type)) furthest = std::max(furthest, centre.norm());
    return type.radius + furthest;
}

/// Half of a yarn's extent along one direction of its section as that lies; of one that is twisted, its outermost point's
/// distance [length].
/// @param direction  0: across the yarn, 1: along its thickness
inline double half_extent(const YarnType& type, int direction) {
    if (type.twist != 0.0) return outermost(type);
    double low = 0.0, high = 0.0;
    for (const Eigen::Vector2d& centre : section_of(type))
        low = std::min(low, centre[direction]), high = std::max(high, centre[direction]);
    return type.radius + 0.5 * (high - low);
}
inline double half_breadth(const YarnType& type) { return half_extent(type, 0); }
inline double half_thickness(const YarnType& type) { return half_extent(type, 1); }

/// Height over half a yarn's thickness at which yarns that cross do not touch: what is drawn where nothing else is said [1].
inline constexpr double apart_height = 1.05;
/// That which is given, or it where none is.
inline double height_or_apart(double given) noexcept { return std::isnan(given) ? apart_height : given; }

/// Refuses a height of yarns at crossings that would not keep their sides: a single fibre does however low it is drawn; fibres of
/// yarns that start in each other lie between each other, some on the wrong side.
/// @param over_half_thickness  of a crossing out of the middle [1]
/// @param field                that says so
inline void require_height(const std::string& field, double over_half_thickness, const YarnType& type) {
    if (type.fibres > 1)
        core::require(over_half_thickness >= apart_height, field, over_half_thickness,
                      ">= " + core::text(apart_height) + " of yarns of " + std::to_string(type.fibres) +
                          " fibres: lower ones start in each other, and fibres lie on the wrong side");
}

/// Half of the room that yarns side by side take, as they lie or, if that is more, packed as densely as circles can be [length].
inline double half_room(const YarnType& type) { return std::max(half_width(type), half_breadth(type)); }

/// The same of yarns that lie on each other, from the path to the higher side: a triangle does not reach as far down as up
/// [length].
inline double half_height(const YarnType& type) {
    if (type.fibres == 1) return type.radius;
    if (type.twist != 0.0) return outermost(type);
    double furthest = 0.0;
    for (const Eigen::Vector2d& centre : section_of(type)) furthest = std::max(furthest, std::abs(centre.y()));
    return std::max(half_width(type) / type.aspect, type.radius + furthest);
}

}  // namespace fibrant::compositions::textile

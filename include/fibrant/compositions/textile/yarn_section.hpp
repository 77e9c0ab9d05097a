// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres of a yarn's section, and how thick it lies.

#include <fibrant/compositions/textile/textile.hpp>
#include <fibrant/compositions/weave/packing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Centres of the fibres of a yarn: across it, and along its thickness [length]. Three and four fibres of a round yarn lie in the
/// least circle that holds them, a triangle and a square; a compact packing about one fibre would have three in a row.
inline std::vector<Eigen::Vector2d> section_of(const YarnType& type) {
    const double half_pitch = type.radius * (1.0 + type.packing_gap);
    if (type.aspect == 1.0 && type.fibres == 3) {
        const double height = std::sqrt(3.0) * half_pitch;
        return {{-half_pitch, -height / 3.0}, {half_pitch, -height / 3.0}, {0.0, 2.0 * height / 3.0}};
    }
    if (type.aspect == 1.0 && type.fibres == 4)
        return {{-half_pitch, -half_pitch}, {half_pitch, -half_pitch}, {-half_pitch, half_pitch}, {half_pitch, half_pitch}};
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

/// Height of a yarn at a crossing out of the middle [length]: a single fibre keeps its side however low it is drawn; fibres of
/// yarns that start in each other lie between each other, some on the wrong side, so that yarns of several are drawn apart.
/// @param over_half_thickness  that is asked for [1], > 0
inline double crossing_height(const YarnType& type, double over_half_thickness) {
    constexpr double apart = 1.05;
    return (type.fibres > 1 ? std::max(over_half_thickness, apart) : over_half_thickness) * half_thickness(type);
}

}  // namespace fibrant::compositions::textile

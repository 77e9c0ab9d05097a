// SPDX-License-Identifier: MIT
#pragma once
/// @file A fabric drawn, not computed: tows on cosine paths, with the order of a pattern.

#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

namespace fibrant::compositions::weave {

inline FabricParameters small_fabric(Index tows = 4, Index fibres = 7, const Pattern& pattern = Pattern{}) {
    FabricParameters fabric;
    fabric.pattern = pattern;
    fabric.warp_tows = fabric.weft_tows = tows;
    fabric.warp = {fibres, 0.04, 0.05, {7300.0, 0.3}};
    fabric.weft = fabric.warp;
    fabric.warp_spacing = fabric.weft_spacing = fabric.overhang = 0.88;
    fabric.elements = 32;
    return fabric;
}

/// Height of a tow over the middle plane [1]: +1 or -1 at crossings, half a cosine between them, level at the ends.
inline double path_height(const FabricParameters& fabric, Family family, Index tow, double along) {
    const bool warp = family == Family::warp;
    const Index last = (warp ? fabric.weft_tows : fabric.warp_tows) - 1;
    const Family crossed = warp ? Family::weft : Family::warp;
    const double spacing = warp ? fabric.weft_spacing : fabric.warp_spacing;
    const double place = (along - fabric.tow_position(crossed, 0)) / spacing;
    const auto side = [&](Index k) {
        const bool over = warp ? fabric.pattern.over(tow, k) : !fabric.pattern.over(k, tow);
        return over ? 1.0 : -1.0;
    };
    if (place <= 0.0) return side(0);
    if (place >= static_cast<double>(last)) return side(last);
    const auto k = static_cast<Index>(std::floor(place));
    const double share = 0.5 * (1.0 - std::cos(std::numbers::pi * (place - static_cast<double>(k))));
    return side(k) + share * (side(k + 1) - side(k));
}

/// @param amplitude  of the paths of both families [length]
inline observe::Snapshot woven_snapshot(const FabricParameters& fabric, double amplitude) {
    observe::Snapshot snapshot;
    snapshot.increment = 3;
    snapshot.stage = "drawn";
    snapshot.progress = 1.0;
    for (Index number = 0; number < fabric.fibres(); ++number) {
        const FibrePlace place = fabric.place(number);
        const bool warp = place.family == Family::warp;
        const Packing packing = fabric.tow(place.family).packing();
        const Eigen::Vector2d offset = packing.centres[static_cast<std::size_t>(place.fibre)];
        const double across = fabric.tow_position(place.family, place.tow) + offset.x();
        const double length = fabric.fibre_length(place.family);
        observe::FibreSnapshot fibre;
        fibre.section = fabric.tow(place.family).section();
        fibre.group = warp ? place.tow : fabric.warp_tows + place.tow;
        for (Index node = 0; node < fabric.nodes_per_fibre(); ++node) {
            const double along = length * (static_cast<double>(node) / static_cast<double>(fabric.nodes_per_fibre() - 1) - 0.5);
            const double step = 1e-6 * length;
            const double z = amplitude * path_height(fabric, place.family, place.tow, along);
            const double slope = amplitude *
                                 (path_height(fabric, place.family, place.tow, along + step) -
                                  path_height(fabric, place.family, place.tow, along - step)) /
                                 (2.0 * step);
            const Vec3 ahead = warp ? Vec3{1.0, 0.0, slope}.normalized() : Vec3{0.0, 1.0, slope}.normalized();
            const Vec3 beside = warp ? Vec3{0.0, 1.0, 0.0} : Vec3{-1.0, 0.0, 0.0};
            const Vec3 up = ahead.cross(beside);
            const Vec3 centre = warp ? Vec3{along, across, z} : Vec3{across, along, z};
            fibre.position.push_back(centre + offset.y() * up);
            fibre.displacement.emplace_back(0.0, 0.0, z);
            fibre.director_1.push_back(beside);
            fibre.director_2.push_back(up);
            fibre.curvature.push_back(0.0);
        }
        snapshot.fibres.push_back(std::move(fibre));
    }
    return snapshot;
}

}  // namespace fibrant::compositions::weave

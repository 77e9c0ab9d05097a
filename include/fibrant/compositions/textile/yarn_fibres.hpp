// SPDX-License-Identifier: MIT
#pragma once
/// @file Lines of the fibres of each yarn, and whether they cross as their yarns do where they are drawn.

#include <fibrant/compositions/textile/crossings.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile::detail {

/// Frames of a yarn whose section lies level: its thickness, the first director, along the axis of the view, or outwards from its
/// line. A section that is carried along the path rolls as the path bends, and rows of two yarns come to stand upright and lie
/// between each other. @returns nothing where the path goes along that axis
inline std::vector<scene::NodeFrame> level_frames(const scene::Curve& path, Index samples, const View& view) {
    std::vector<scene::NodeFrame> frames = scene::reference_frames(path, samples + 1);
    const Vec3 axis = view.axis.normalized();
    for (scene::NodeFrame& frame : frames) {
        Vec3 up = axis;
        if (view.radial) up = frame.position - view.centre, up -= up.dot(axis) * axis;
        const double whole = up.norm();
        up -= up.dot(frame.tangent) * frame.tangent;
        constexpr double steepest = 0.3;  // sine of the angle between path and axis: beyond it sections would roll at once
        if (!(up.norm() > steepest * whole)) return {};
        frame.director_1 = up.normalized(), frame.director_2 = frame.tangent.cross(frame.director_1);
    }
    return frames;
}

/// Lines of the fibres of a yarn. Rows of its packing lie across `upward`, along the second director.
inline std::vector<scene::Curve> fibre_curves(const Textile& textile, Index p) {
    const Path& path = textile.paths[core::at(p)];
    const YarnType& type = textile.type_of(p);
    if (type.fibres == 1) return {path.curve};
    const double length = scene::length_of(path.curve), turns = type.twist * length;
    const auto samples = std::max<Index>(64, static_cast<Index>(length / type.radius));
    const bool repeats = path.kind != PathKind::open;
    if (repeats)
        core::require(std::abs(turns - std::round(turns)) < 1e-9, textile.label(p) + ": turns of its twist over its length",
                      turns, "whole, of a path that repeats");
    const auto ends = repeats ? scene::SplineEnds::repeating : scene::SplineEnds::parabolic;
    std::vector<scene::NodeFrame> level;
    if (!textile.crossings.empty() && path.upward.isZero() && type.twist == 0.0)
        level = level_frames(path.curve, samples, textile.view);
    std::vector<scene::Curve> curves;
    for (const Eigen::Vector2d& centre : section_of(type))
        // g_1 is the direction of the thickness: across it lies -g_2.
        curves.push_back(level.empty() ? scene::beside(path.curve, centre.y(), -centre.x(), turns, samples, path.upward, ends)
                                       : scene::beside(level, centre.y(), -centre.x(), ends));
    return curves;
}

/// Pairs of yarns, the lower number first, whose fibres cross where they are drawn as the yarns do, and no more often.
/// @param pairs    that are looked at, sorted
/// @param fibres   lines of each yarn
inline std::vector<std::pair<Index, Index>> crossing_as_drawn(const Textile& textile,
                                                              const std::vector<std::pair<Index, Index>>& pairs,
                                                              const std::vector<std::vector<scene::Curve>>& fibres) {
    using Pair = std::pair<Index, Index>;
    std::vector<Line> lines;
    std::vector<Index> yarn, first;
    for (Index p = 0; p < core::count(fibres); ++p) {
        first.push_back(core::count(lines));
        const double length = scene::length_of(textile.paths[core::at(p)].curve, 128);
        const auto pieces = std::max<Index>(64, static_cast<Index>(2.0 * length / textile.type_of(p).radius));
        for (const scene::Curve& curve : fibres[core::at(p)]) {
            std::vector<Vec3> points;
            for (Index k = 0; k <= pieces; ++k) points.push_back(curve(static_cast<double>(k) / static_cast<double>(pieces)));
            lines.push_back(line_of(std::move(points))), yarn.push_back(p);
        }
    }
    first.push_back(core::count(lines));
    const auto of = [](Index a, Index b) { return Pair{std::min(a, b), std::max(a, b)}; };
    std::vector<std::pair<Pair, Crossing>> asked, found;
    for (const Crossing& crossing : textile.crossings)
        for (Index i = first[core::at(crossing.above)]; i < first[core::at(crossing.above + 1)]; ++i)
            for (Index j = first[core::at(crossing.below)]; j < first[core::at(crossing.below + 1)]; ++j)
                asked.push_back(
                    {of(crossing.above, crossing.below), {i, j, crossing.at_above, crossing.at_below, crossing.axis}});
    for (const Crossing& crossing : crossings_of(lines, textile.view))
        found.push_back({of(yarn[core::at(crossing.above)], yarn[core::at(crossing.below)]), crossing});
    const auto by_pair = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(asked.begin(), asked.end(), by_pair), std::stable_sort(found.begin(), found.end(), by_pair);
    const auto part = [&](const std::vector<std::pair<Pair, Crossing>>& all, const Pair& pair) {
        const auto [from, to] = std::equal_range(all.begin(), all.end(), std::pair{pair, Crossing{}}, by_pair);
        std::vector<Crossing> own;
        for (auto at = from; at != to; ++at) own.push_back(at->second);
        return own;
    };
    std::vector<Pair> right;
    for (const Pair& pair : pairs)
        if (audit_crossings(part(asked, pair), part(found, pair)).clean()) right.push_back(pair);
    return right;
}

/// Whether all fibres of different yarns cross where they are drawn as their yarns do.
inline bool fibres_cross_rightly(const Textile& textile) {
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<std::vector<scene::Curve>> fibres;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        for (Index q = p + 1; q < core::count(textile.paths); ++q) pairs.emplace_back(p, q);
        fibres.push_back(fibre_curves(textile, p));
    }
    return crossing_as_drawn(textile, pairs, fibres).size() == pairs.size();
}

}  // namespace fibrant::compositions::textile::detail

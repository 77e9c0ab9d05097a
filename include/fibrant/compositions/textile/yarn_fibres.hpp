// SPDX-License-Identifier: MIT
#pragma once
/// @file Lines of the fibres of each yarn, and whether they cross as their yarns do where they are drawn.

#include <fibrant/compositions/textile/crossings.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
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
    if (repeats && !(std::abs(turns - std::round(turns)) < 1e-9))
        core::refuse("YarnType.twist", core::text(type.twist),
                     core::text(std::round(turns) / length) + " or another one that makes whole turns over the length of " +
                         textile.label(p) + ", " + core::text(length) + ", which repeats");
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

/// Crossings of fibres of different yarns where they are drawn, as their yarns ask for them and as they are; sorted by yarns, the
/// lower number first.
struct FibreCrossings {
    using Pair = std::pair<Index, Index>;
    std::vector<std::pair<Pair, Crossing>> asked, found;

    /// @param fibres  lines of each yarn
    FibreCrossings(const Textile& textile, const std::vector<std::vector<scene::Curve>>& fibres) {
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
        for (const Crossing& yarns : textile.crossings)
            for (Index i = first[core::at(yarns.above)]; i < first[core::at(yarns.above + 1)]; ++i)
                for (Index j = first[core::at(yarns.below)]; j < first[core::at(yarns.below + 1)]; ++j)
                    add(asked, yarns.above, yarns.below, {i, j, yarns.at_above, yarns.at_below, yarns.axis});
        for (const Crossing& crossing : crossings_of(lines, textile.view))
            add(found, yarn[core::at(crossing.above)], yarn[core::at(crossing.below)], crossing);
        std::stable_sort(asked.begin(), asked.end(), by_pair), std::stable_sort(found.begin(), found.end(), by_pair);
    }
    bool right() const { return audit_crossings(plain(asked.begin(), asked.end()), plain(found.begin(), found.end())).clean(); }
    bool right(const Pair& pair) const {
        const auto part = [&](const auto& all) {
            const auto [from, to] = std::equal_range(all.begin(), all.end(), std::pair{pair, Crossing{}}, by_pair);
            return plain(from, to);
        };
        return audit_crossings(part(asked), part(found)).clean();
    }

private:
    static bool by_pair(const std::pair<Pair, Crossing>& a, const std::pair<Pair, Crossing>& b) { return a.first < b.first; }
    static void add(std::vector<std::pair<Pair, Crossing>>& list, Index a, Index b, const Crossing& crossing) {
        if (a != b) list.push_back({{std::min(a, b), std::max(a, b)}, crossing});
    }
    template <class Iterator>
    static std::vector<Crossing> plain(Iterator from, Iterator to) {
        std::vector<Crossing> crossings;
        for (; from != to; ++from) crossings.push_back(from->second);
        return crossings;
    }
};

/// Whether all fibres of different yarns cross where they are drawn as their yarns do, and no more often.
inline bool fibres_cross_rightly(const Textile& textile) {
    std::vector<std::vector<scene::Curve>> fibres;
    for (Index p = 0; p < core::count(textile.paths); ++p) fibres.push_back(fibre_curves(textile, p));
    return FibreCrossings(textile, fibres).right();
}

/// How deep fibres of different yarns lie in each other where they are drawn, at most, over the radius of the thinner one [1]; 0
/// where none do. Images of what repeats are not looked at.
inline double deepest_start(const Textile& textile) {
    std::vector<std::vector<Vec3>> points;
    std::vector<proximity::Centreline> lines;
    std::vector<std::size_t> line_of_piece, first;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const double radius = textile.type_of(p).radius, length = scene::length_of(textile.paths[core::at(p)].curve, 128);
        const auto pieces = std::max<Index>(64, static_cast<Index>(length / radius));
        for (const scene::Curve& curve : fibre_curves(textile, p)) {
            first.push_back(line_of_piece.size());
            line_of_piece.insert(line_of_piece.end(), core::at(pieces), points.size());
            points.emplace_back();
            for (Index k = 0; k <= pieces; ++k)
                points.back().push_back(curve(static_cast<double>(k) / static_cast<double>(pieces)));
            lines.push_back({.points = {}, .radius = radius, .family = p});
        }
    }
    for (std::size_t f = 0; f < lines.size(); ++f) lines[f].points = points[f];
    double deepest = 0.0;
    for (const proximity::SegmentPair& pair : proximity::GridSearch{}.pairs(lines, 0.0)) {
        const auto piece = [&](std::int32_t number) {
            const std::size_t f = line_of_piece[core::at(number)], k = core::at(number) - first[f];
            return std::array{points[f][k], Vec3(points[f][k + 1] - points[f][k])};
        };
        const auto [a, along_a] = piece(pair.i);
        const auto [b, along_b] = piece(pair.j);
        const double one = lines[line_of_piece[core::at(pair.i)]].radius, other = lines[line_of_piece[core::at(pair.j)]].radius,
                     distance = std::sqrt(proximity::segment_distance(a, along_a, b, along_b).squared);
        deepest = std::max(deepest, (one + other - distance) / std::min(one, other));
    }
    return deepest;
}

}  // namespace fibrant::compositions::textile::detail

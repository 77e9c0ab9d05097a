// SPDX-License-Identifier: MIT
#pragma once
/// @file Audit of a settled textile's topology, which owes nothing to contact, and what is measured of its yarns.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/compositions/textile/crossings.hpp>
#include <fibrant/observe/linking.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// What can be told of which yarn goes where.
struct TopologyAudit {
    CrossingAudit crossings;  ///< of all fibres of different yarns, against the textile's own
    Index linked = 0;         ///< pairs of closed yarns that are linked
    Index links_changed = 0;  ///< pairs of closed yarns whose linking number is not what it was
    /// Greatest change of a linking integral of two open yarns [1]. A passing changes it by one where it happens; yarns that part
    /// sideways or slide beyond an end by up to a half.
    double greatest_linking_change = 0.0;
    bool told_by_crossings = false;           ///< the textile says its crossings; else linking integrals decide
    Index first_yarn = -1, second_yarn = -1;  ///< of the first pair that is wrong

    bool clean() const noexcept {
        return links_changed == 0 && (told_by_crossings ? crossings.clean() : greatest_linking_change < 0.5);
    }
};

/// Lines of the fibres of a state, at their nodes.
inline std::vector<Line> lines_of(const observe::Snapshot& snapshot) {
    std::vector<Line> lines;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres) lines.push_back(line_of(fibre.position));
    return lines;
}

namespace detail {
/// Unit chord of a line at an arc from its start.
inline Vec3 direction_at(const Line& line, double arc) {
    const auto after = std::upper_bound(line.arc.begin() + 1, line.arc.end() - 1, arc);
    const auto k = static_cast<std::size_t>(after - line.arc.begin());
    return (line.points[k] - line.points[k - 1]).normalized();
}
/// 1 where a path lies above another one all along, as seen, no further beside it than both are broad, as wefts of one column do;
/// -1 where it lies below it so, else 0.
inline int lies_along(const Textile& textile, Index path, Index other) {
    constexpr Index chords = 64;
    std::vector<Line> lines;
    for (const Index p : {path, other}) {
        std::vector<Vec3> points;
        for (Index k = 0; k <= chords; ++k)
            points.push_back(textile.paths[core::at(p)].curve(static_cast<double>(k) / static_cast<double>(chords)));
        lines.push_back(line_of(std::move(points)));
    }
    const Plan plan(lines, textile.view);
    const double broad = half_width(textile.type_of(path)) + half_width(textile.type_of(other));
    int side = 0;
    for (const PlanPoint& at : plan.lines[0]) {
        double nearest = std::numeric_limits<double>::infinity(), height = 0.0;
        for (std::size_t k = 1; k < plan.lines[1].size(); ++k) {
            const PlanPoint &a = plan.lines[1][k - 1], &b = plan.lines[1][k];
            const double around = plan.period > 0.0 ? plan.period * std::round((at.u - a.u) / plan.period) : 0.0;
            const double u = b.u - a.u, v = b.v - a.v, du = at.u - around - a.u, dv = at.v - a.v, squared = u * u + v * v,
                         part = squared > 0.0 ? std::clamp((du * u + dv * v) / squared, 0.0, 1.0) : 0.0,
                         distance = std::hypot(du - part * u, dv - part * v);
            if (distance < nearest) nearest = distance, height = at.height - a.height - part * (b.height - a.height);
        }
        const int here = nearest >= broad || height == 0.0 ? 0 : height > 0.0 ? 1 : -1;
        if (here == 0 || here == -side) return 0;
        side = here;
    }
    return side;
}
/// Pairs of lines whose boxes meet, in order: sorted along x and swept.
inline std::vector<std::pair<Index, Index>> near_pairs(std::span<const Line> lines, double reach) {
    struct Bounds {
        Vec3 low, high;
        Index line;
    };
    std::vector<Bounds> boxes;
    for (Index k = 0; k < core::count(lines); ++k) {
        Bounds box{lines[core::at(k)].points.front(), lines[core::at(k)].points.front(), k};
        for (const Vec3& point : lines[core::at(k)].points)
            box.low = box.low.cwiseMin(point), box.high = box.high.cwiseMax(point);
        box.low.array() -= reach, box.high.array() += reach;
        boxes.push_back(box);
    }
    std::sort(boxes.begin(), boxes.end(),
              [](const Bounds& a, const Bounds& b) { return a.low.x() != b.low.x() ? a.low.x() < b.low.x() : a.line < b.line; });
    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t a = 0; a < boxes.size(); ++a)
        for (std::size_t b = a + 1; b < boxes.size() && boxes[b].low.x() <= boxes[a].high.x(); ++b)
            if ((boxes[a].low.array() <= boxes[b].high.array()).all() && (boxes[b].low.array() <= boxes[a].high.array()).all())
                pairs.emplace_back(std::min(boxes[a].line, boxes[b].line), std::max(boxes[a].line, boxes[b].line));
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}
}  // namespace detail

/// Compares lines of the fibres of a textile with its crossings, and their links with those of other lines, as they were drawn.
/// @param drawn, settled  a line a fibre, in the order of the scene; closed ones end with their first point
inline TopologyAudit audit_topology(const Textile& textile, const Assembled& assembled, std::span<const Line> drawn,
                                    std::span<const Line> settled) {
    TopologyAudit audit;
    audit.told_by_crossings = !textile.crossings.empty();
    if (audit.told_by_crossings) {
        std::vector<Crossing> asked, found;
        for (const Crossing& crossing : textile.crossings)
            for (Index i = assembled.first_fibre[core::at(crossing.above)];
                 i < assembled.first_fibre[core::at(crossing.above + 1)]; ++i)
                for (Index j = assembled.first_fibre[core::at(crossing.below)];
                     j < assembled.first_fibre[core::at(crossing.below + 1)]; ++j)
                    asked.push_back({i, j, crossing.at_above, crossing.at_below, crossing.axis});
        const auto own = [&](Index i, Index j) {
            return i != j && assembled.path_of[core::at(i)] == assembled.path_of[core::at(j)];
        };
        std::vector<std::pair<Index, Index>> pairs;
        for (const Crossing& crossing : asked)
            pairs.emplace_back(std::min(crossing.above, crossing.below), std::max(crossing.above, crossing.below));
        std::sort(pairs.begin(), pairs.end());
        // Yarns that lie on each other, as those of a column of wefts, cross as seen from above wherever they like: where nothing
        // passes between them they roll beside each other, and where they lean by more the upper one still is above.
        constexpr double along_each_other = 0.5;  // sine of 30 degrees
        for (const Crossing& crossing : crossings_of(settled, textile.view)) {
            if (own(crossing.above, crossing.below)) continue;
            const Vec3 one = detail::direction_at(settled[core::at(crossing.above)], crossing.at_above),
                       two = detail::direction_at(settled[core::at(crossing.below)], crossing.at_below);
            const std::pair pair{std::min(crossing.above, crossing.below), std::max(crossing.above, crossing.below)};
            const bool asked_for = std::binary_search(pairs.begin(), pairs.end(), pair);
            if (asked_for || (one.cross(two).norm() >= along_each_other &&
                              detail::lies_along(textile, assembled.path_of[core::at(crossing.above)],
                                                 assembled.path_of[core::at(crossing.below)]) != 1))
                found.push_back(crossing);
        }
        std::erase_if(asked, [&](const Crossing& crossing) { return own(crossing.above, crossing.below); });
        audit.crossings = audit_crossings(std::move(asked), std::move(found));
        if (!audit.crossings.clean()) {
            audit.first_yarn = assembled.path_of[core::at(audit.crossings.first_path)];
            audit.second_yarn = assembled.path_of[core::at(audit.crossings.second_path)];
        }
    }
    // What was near as drawn may have parted, if it was not linked.
    const auto before_pairs = detail::near_pairs(drawn, textile.smallest_radius()),
               after_pairs = detail::near_pairs(settled, textile.smallest_radius());
    std::vector<std::pair<Index, Index>> near;
    std::set_union(before_pairs.begin(), before_pairs.end(), after_pairs.begin(), after_pairs.end(), std::back_inserter(near));
    for (const auto& [i, j] : near) {
        const Index p = assembled.path_of[core::at(i)], q = assembled.path_of[core::at(j)];
        if (p == q) continue;
        const auto closed = [&](Index path) { return textile.paths[core::at(path)].kind == PathKind::closed; };
        bool wrong = false;
        if (closed(p) && closed(q)) {
            const Index before = observe::linking_number(drawn[core::at(i)].points, drawn[core::at(j)].points);
            const Index after = observe::linking_number(settled[core::at(i)].points, settled[core::at(j)].points);
            audit.linked += after != 0 ? 1 : 0, audit.links_changed += after != before ? 1 : 0;
            wrong = after != before;
        } else if (i == assembled.first_fibre[core::at(p)] && j == assembled.first_fibre[core::at(q)]) {
            const double change = std::abs(observe::linking_integral(settled[core::at(i)].points, settled[core::at(j)].points) -
                                           observe::linking_integral(drawn[core::at(i)].points, drawn[core::at(j)].points));
            audit.greatest_linking_change = std::max(audit.greatest_linking_change, change);
            wrong = !audit.told_by_crossings && change >= 0.5;
        }
        if (wrong && audit.first_yarn < 0) audit.first_yarn = p, audit.second_yarn = q;
    }
    return audit;
}

/// What is measured of a yarn: of its fibres, the mean or the greatest.
struct YarnFigures {
    double length = 0.0;              ///< mean of its fibres' [length]
    double crimp = 0.0;               ///< that over the distance of its ends, less one; 0 of a closed one [1]
    double strain = 0.0;              ///< mean stretch of its fibres since rest [1]
    double greatest_curvature = 0.0;  ///< [1 / length]
    double mean_angle = 0.0;  ///< mean angle of its fibres to its chord, or to its plane's mean for closed ones: 0 [radian]
};

/// Length, crimp, strain, curvature and angle of each yarn of a textile, from a snapshot of its fibres.
inline std::vector<YarnFigures> yarn_figures(const Textile& textile, const Assembled& assembled,
                                             const observe::Snapshot& snapshot) {
    std::vector<YarnFigures> all;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        YarnFigures yarn;
        const Index first = assembled.first_fibre[core::at(p)], last = assembled.first_fibre[core::at(p + 1)];
        const double share = 1.0 / static_cast<double>(last - first);
        for (Index f = first; f < last; ++f) {
            const observe::FibreSnapshot& fibre = snapshot.fibres[core::at(f)];
            const observe::NodalCurve curve(fibre.position);
            const double length = curve.length(0.0, curve.end());
            const Vec3 chord = fibre.position.back() - fibre.position.front();
            const scene::FibreSpecification& given = assembled.assembly.fibres()[core::at(f)];
            const double rest = given.curve    ? scene::length_of(given.curve)
                                : given.closed ? scene::length_of(given.start)
                                               : (given.to - given.from).norm();
            yarn.length += share * length, yarn.strain += share * (length / rest - 1.0);
            for (const double curvature : fibre.curvature) yarn.greatest_curvature = std::max(yarn.greatest_curvature, curvature);
            if (fibre.closed) continue;
            yarn.crimp += share * (length / chord.norm() - 1.0);
            double angle = 0.0;
            curve.integrate(0.0, curve.end(), [&](double t, double weight) {
                angle += weight * std::atan2(curve.tangent(t).cross(chord).norm(), curve.tangent(t).dot(chord));
            });
            yarn.mean_angle += share * angle / length;
        }
        all.push_back(yarn);
    }
    return all;
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file Paths in one surface, a plane or a cylinder, given heights at their crossings by a rule of who is above.

#include <fibrant/compositions/textile/crossings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// A crossing of two paths in the surface, as a rule sees it.
struct PlanCrossing {
    Index first = -1, second = -1;
    double at_first = 0.0, at_second = 0.0;                        ///< parameters of the two curves, in [0, 1]
    Vec3 place = Vec3::Zero();                                     ///< [length]
    Vec3 along_first = Vec3::Zero(), along_second = Vec3::Zero();  ///< chords of the two paths there [length]
};

/// Heights of the first and of the second path at a crossing, in units that `interlaced` is told; never the same.
using HeightRule = std::function<std::array<double, 2>(const PlanCrossing&)>;

/// The usual rule: the one is as much above as the other is below.
inline std::array<double, 2> one_above(bool first) noexcept { return first ? std::array{1.0, -1.0} : std::array{-1.0, 1.0}; }

namespace detail {

/// Heights over a parameter, joined by arcs of the third degree that are level where they meet.
class HeightLine {
public:
    HeightLine(std::vector<std::pair<double, double>> knots, bool repeating) : repeating_{repeating} {
        std::sort(knots.begin(), knots.end());
        constexpr double same = 1e-4;  // of a path: crossings of three at one point
        for (const auto& knot : knots) {
            if (!knots_.empty() && knot.first - knots_.back().first < same) {
                if (std::abs(knot.second) > std::abs(knots_.back().second)) knots_.back().second = knot.second;
                continue;
            }
            knots_.push_back(knot);
        }
        if (repeating_ && !knots_.empty()) {
            const auto first = knots_.front(), last = knots_.back();
            knots_.insert(knots_.begin(), {last.first - 1.0, last.second});
            knots_.emplace_back(first.first + 1.0, first.second);
        }
    }
    double operator()(double t) const {
        if (knots_.empty()) return 0.0;
        if (t <= knots_.front().first) return knots_.front().second;
        if (t >= knots_.back().first) return knots_.back().second;
        const auto after =
            std::upper_bound(knots_.begin(), knots_.end(), t, [](double x, const auto& knot) { return x < knot.first; });
        const auto& [a, low] = *(after - 1);
        const auto& [b, high] = *after;
        const double s = (t - a) / (b - a);
        return low + (high - low) * s * s * (3.0 - 2.0 * s);
    }

private:
    std::vector<std::pair<double, double>> knots_;
    bool repeating_;
};

/// A path with its heights out of the surface.
inline scene::Curve raised(scene::Curve plan, std::vector<std::pair<double, double>> knots, bool repeating, const View& view) {
    const auto heights = std::make_shared<const HeightLine>(std::move(knots), repeating);
    const Vec3 axis = view.axis.normalized();
    return [plan = std::move(plan), heights, view, axis](double t) -> Vec3 {
        const Vec3 place = plan(t);
        if (!view.radial) return place + (*heights)(t)*axis;
        Vec3 out = place - view.centre;
        out -= out.dot(axis) * axis;
        return place + (*heights)(t)*out.normalized();
    };
}

}  // namespace detail

/// Makes a path go on as its image.
inline void repeat(Path& path, const Vec3& image) { path.kind = PathKind::periodic, path.image = image; }
inline void require_whole(const std::string& field, double count) {
    core::require(count >= 1.0 && std::abs(count - std::round(count)) <= 1e-12 * count, field, count, "whole, and >= 1");
}

/// Gives the paths of a textile, all in one surface as yet, their heights at crossings, and finds the crossings.
/// @param rule    of who is above
/// @param height  unit of its heights [length], > 0
/// @throws std::invalid_argument where the crossings of the raised paths are not those of the rule
inline void interlace(Textile& textile, const HeightRule& rule, double height) {
    core::require_positive("interlace.height", height);
    const std::vector<Line> lines = lines_of(textile);
    const detail::Plan plan(lines, textile.view);
    std::vector<std::vector<std::pair<double, double>>> knots(textile.paths.size());
    std::vector<Crossing> asked;
    for (const detail::Meeting& m : detail::meetings(plan)) {
        const Line &a = lines[core::at(m.line_a)], &b = lines[core::at(m.line_b)];
        const std::size_t i = core::at(m.piece_a), j = core::at(m.piece_b);
        const detail::MeetingPlace place = detail::place_of(m, lines, plan, textile.view);
        PlanCrossing crossing{m.line_a,
                              m.line_b,
                              0.0,
                              0.0,
                              (1.0 - m.part_a) * a.points[i] + m.part_a * a.points[i + 1],
                              a.points[i + 1] - a.points[i],
                              b.points[j + 1] - b.points[j]};
        crossing.at_first = (static_cast<double>(i) + m.part_a) / static_cast<double>(a.points.size() - 1);
        crossing.at_second = (static_cast<double>(j) + m.part_b) / static_cast<double>(b.points.size() - 1);
        const std::array<double, 2> heights = rule(crossing);
        knots[core::at(m.line_a)].emplace_back(crossing.at_first, height * heights[0]);
        knots[core::at(m.line_b)].emplace_back(crossing.at_second, height * heights[1]);
        asked.push_back(heights[0] > heights[1] ? Crossing{m.line_a, m.line_b, place.at_a, place.at_b, place.axis}
                                                : Crossing{m.line_b, m.line_a, place.at_b, place.at_a, place.axis});
    }
    for (std::size_t p = 0; p < textile.paths.size(); ++p) {
        Path& path = textile.paths[p];
        path.curve = detail::raised(path.curve, std::move(knots[p]), path.kind != PathKind::open, textile.view);
    }
    textile.crossings = crossings_of(textile);
    const CrossingAudit audit = audit_crossings(asked, textile.crossings);
    if (!audit.clean())
        core::refuse(
            textile.name + ": crossings of " + textile.label(audit.first_path) + " and " + textile.label(audit.second_path),
            std::to_string(audit.wrong) + " wrong, " + std::to_string(audit.missing) + " missing and " +
                std::to_string(audit.extra) + " more",
            "as the rule says");
}

}  // namespace fibrant::compositions::textile

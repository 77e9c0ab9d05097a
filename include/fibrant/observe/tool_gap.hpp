// SPDX-License-Identifier: MIT
#pragma once
/// @file True least distance between the surfaces of fibres and of rigid tools, by looking at many points of their contours.

#include <fibrant/core/parallel.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/scene/tool.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace fibrant::observe {

/// A fibre and a tool.
struct ToolGap {
    double gap = std::numeric_limits<double>::infinity();  ///< < 0 in penetration [length]
    Index fibre = -1, tool = -1;
    Vec3 position = Vec3::Zero();  ///< of the fibre's point [length]
};

/// Least distance of one fibre from one tool, at four stations a node interval.
///
/// A station's contour is looked at in 32 points and its lowest place is put between them by a parabola: within 1e-4 of the
/// sections' size for sections up to ten times as wide as thick. The first and the last section are discs whose edge contact
/// rounds off where they face the tool: there the centre counts, less the lesser half axis.
/// @param tool  with a unit axis
/// @param pose  where it stands
inline ToolGap tool_gap(const FibreSnapshot& fibre, const scene::Tool& tool, const scene::ToolPose& pose) {
    const NodalCurve curve(fibre);
    const int stations = 4, points = 32;
    const double stretched = 1.5;    // half extent over that at rest: sections stretch by less than a half
    const double rounded_off = 0.3;  // sine of the fibre's angle to the tool beyond which an end is: 17 degrees
    const double widest = fibre.section.radius(), narrowest = std::min(fibre.section.semi_axis_1, fibre.section.semi_axis_2);
    const Index last = stations * (core::count(fibre.position) - 1);
    const bool surface = !fibre.director_1.empty() && !fibre.director_1.front().isZero(0.0);  // cables have but a radius
    ToolGap least;
    const auto take = [&](double gap, const Vec3& where) {
        if (gap < least.gap) least.gap = gap, least.position = where;
    };
    for (Index k = 0; k <= last; ++k) {
        const double t = static_cast<double>(k) / stations;
        const Vec3 centre = curve.position(t);
        const scene::ToolDistance middle = scene::tool_distance(tool, pose.material(centre));
        if (middle.distance - stretched * widest > least.gap) continue;
        if (!surface) {
            take(middle.distance - widest, centre);
            continue;
        }
        const Vec3 across_1 = fibre.section.semi_axis_1 * curve.interpolate(std::span<const Vec3>{fibre.director_1}, t);
        const Vec3 across_2 = fibre.section.semi_axis_2 * curve.interpolate(std::span<const Vec3>{fibre.director_2}, t);
        const Vec3 axis = across_1.cross(across_2).normalized();
        const bool end = !fibre.closed && (k == 0 || k == last);
        if (end && std::abs(axis.dot(pose.turn * middle.normal)) > rounded_off) {
            take(middle.distance - narrowest, centre);
            continue;
        }
        double value[points];
        const auto place = [&](double angle) { return Vec3(centre + std::cos(angle) * across_1 + std::sin(angle) * across_2); };
        const double step = 2.0 * std::numbers::pi / points;
        for (int p = 0; p < points; ++p) value[p] = scene::tool_distance(tool, pose.material(place(p * step))).distance;
        const int low = static_cast<int>(std::min_element(value, value + points) - value);
        const double before = value[(low + points - 1) % points], after = value[(low + 1) % points];
        const double bend = before - 2.0 * value[low] + after, shift = bend > 0.0 ? 0.5 * (before - after) / bend : 0.0;
        const Vec3 lowest = place((low + shift) * step);
        take(std::min(value[low], scene::tool_distance(tool, pose.material(lowest)).distance), lowest);
    }
    return least;
}

/// The fibre that is nearest to a tool, or deepest in one.
/// @param tools  set of tools as contact has it: tools(), pose(tool)
template <class Tools>
ToolGap least_tool_gap(const Snapshot& shot, const Tools& tools) {
    std::vector<ToolGap> least(shot.fibres.size());
    core::parallel_for(
        core::count(shot.fibres),
        [&](Index f) {
            for (Index t = 0; t < core::count(tools.tools()); ++t) {
                if constexpr (requires { tools.carries(f, t); })
                    if (tools.carries(f, t)) continue;
                const ToolGap here = tool_gap(shot.fibres[core::at(f)], tools.tools()[core::at(t)], tools.pose(t));
                if (here.gap < least[core::at(f)].gap) least[core::at(f)] = {here.gap, f, t, here.position};
            }
        },
        1);
    ToolGap all;
    for (const ToolGap& here : least)
        if (here.gap < all.gap) all = here;
    return all;
}

}  // namespace fibrant::observe

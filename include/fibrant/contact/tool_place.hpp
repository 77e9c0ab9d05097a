// SPDX-License-Identifier: MIT
#pragma once
/// @file Where a section that is not round is nearest to a tool that is not flat.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/section_gap.hpp>
#include <fibrant/scene/tool.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fibrant::contact {

/// Normal of a tool at the particle of a section that is nearest to it, in the tool's own axes.
///
/// The distance from the tool along the contour, f(t) = d(centre + cos t a + sin t b), is least where f' = n . x' is 0. Its
/// first guess is the particle that lies furthest against the normal at the centre, which is the nearest one of a round section
/// and of any section on a plane. From there the way leads downhill to the least distance of that side, so that a section
/// which is nearly as wide as the tool does not leap to its far side.
/// @param tool    with a unit axis
/// @param centre  of the section [length]
/// @returns the normal at the centre where no such place is less than a right angle away
inline Vec3 normal_at_section(const scene::Tool& tool, const Vec3& centre, const SectionAxes& section) {
    const Vec3 middle = scene::tool_distance(tool, centre).normal;
    if (tool.shape == scene::ToolShape::plane) return middle;
    const double size = section.first.norm() + section.second.norm();
    const double settled = 1e-10 * size;  // of the slope [length per radian]: rounding of a distance some sizes long
    Vec3 normal = middle;
    const auto slope = [&](double t) {
        const double c = std::cos(t), s = std::sin(t);
        normal = scene::tool_distance(tool, centre + c * section.first + s * section.second).normal;
        return normal.dot(c * section.second - s * section.first);
    };
    double low = std::atan2(-middle.dot(section.second), -middle.dot(section.first)), low_slope = slope(low);
    if (std::abs(low_slope) <= settled) return normal;
    const double stride =
        low_slope > 0.0 ? -0.1 : 0.1;  // [radian]; narrower than the valleys of sections ten times as wide as thick
    double high = low, high_slope = low_slope;
    for (double way = 0.0; high_slope * low_slope > 0.0; way += std::abs(stride)) {
        if (way > 0.5 * std::numbers::pi) return middle;
        low = high, low_slope = high_slope;
        high += stride, high_slope = slope(high);
    }
    // The rule of false position; the end that stays has its slope halved (Dowell and Jarratt 1971).
    for (int iteration = 0; iteration < 60; ++iteration) {
        const double t = high - high_slope * (high - low) / (high_slope - low_slope), here = slope(t);
        if (std::abs(here) <= settled) break;
        if (here * high_slope < 0.0)
            low = high, low_slope = high_slope;
        else
            low_slope *= 0.5;
        high = t, high_slope = here;
    }
    return normal;
}

/// The same of a fibre's section at an abscissa, in a state. Beams that are touched on their centreline have it there.
/// @param first  first unknown of the element that holds u
template <class B>
Vec3 normal_at_fibre(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, [[maybe_unused]] Index first,
                     const scene::Tool& tool, const scene::ToolPose& pose) {
    const Vec3 centre = pose.material(mesh.position(state, fibre, u));
    if constexpr (beam::CentrelineOnly<B> || beam::TouchedOnCentreline<B>) {
        return scene::tool_distance(tool, centre).normal;
    } else {
        const auto [g_1, g_2] = beam::Mesh<B>::element_directors(state, first, mesh.locate(fibre, u).second);
        const scene::CrossSection& section = mesh.fibre(fibre).section;
        const Mat3 back = pose.turn.transpose();
        return normal_at_section(tool, centre, {section.semi_axis_1 * (back * g_1), section.semi_axis_2 * (back * g_2)});
    }
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file Cross-section of a tow where a plane across its centre line cuts it.

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/observe/yarn_section.hpp>

#include <Eigen/Geometry>

#include <vector>

namespace fibrant::compositions::weave {

using observe::convex_hull;
using observe::section_of;
using observe::SectionEllipse;
/// Section of a tow at a place.
using TowSection = observe::YarnSection;
/// A point of a section [length].
using Vec2 = observe::Vec2;

/// Section of a tow in the plane orthogonal to its centre line at parameter t, in [0, nodes - 1]. Fibres' sections are
/// projected on the plane; fibres that do not reach the plane are left out.
inline TowSection tow_section(const observe::Snapshot& snapshot, const FabricParameters& fabric, Family family, Index tow,
                              double t) {
    require_snapshot_of(snapshot, fabric);
    const std::vector<Vec3> centre = tow_centreline(snapshot, fabric, family, tow);
    const observe::NodalCurve line{centre};
    const Vec3 origin = line.position(t), normal = line.tangent(t).normalized();
    const Vec3 across = Vec3::UnitZ().cross(normal).normalized(), up = normal.cross(across);
    const auto flat = [&](const Vec3& v) { return Vec2{across.dot(v), up.dot(v)}; };
    std::vector<SectionEllipse> ellipses;
    for (Index k = 0; k < fabric.tow(family).fibres; ++k) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[core::at(fabric.fibre(family, tow, k))];
        const observe::NodalCurve curve{fibre.position};
        const auto at = curve.meets(normal, normal.dot(origin));
        if (!at) continue;
        ellipses.push_back({flat(curve.position(*at) - origin),
                            flat(fibre.section.semi_axis_1 * curve.interpolate(std::span<const Vec3>{fibre.director_1}, *at)),
                            flat(fibre.section.semi_axis_2 * curve.interpolate(std::span<const Vec3>{fibre.director_2}, *at))});
    }
    return section_of(std::move(ellipses));
}

}  // namespace fibrant::compositions::weave

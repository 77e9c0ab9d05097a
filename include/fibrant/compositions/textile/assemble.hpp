// SPDX-License-Identifier: MIT
#pragma once
/// @file A textile as a scene: fibres along paths, what holds their ends, orders of yarns of several fibres, and the cell.

#include <fibrant/compositions/textile/textile.hpp>
#include <fibrant/compositions/weave/packing.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Channel that scales the tension of all yarns.
inline constexpr const char* tension_channel = "tension";

/// How fibres are cut.
struct Fineness {
    double element_over_radius = 3.0;  ///< greatest length of an element over the radius of its fibre [1], > 0
    Index least_elements = 8;          ///< of a fibre, >= 3
    void validate() const {
        core::require_positive("Fineness.element_over_radius", element_over_radius);
        core::require_at_least("Fineness.least_elements", least_elements, 3);
    }
};

/// A scene and whose its fibres are.
struct Assembled {
    scene::Assembly assembly;
    std::vector<Index> path_of;      ///< of each fibre
    std::vector<Index> first_fibre;  ///< of each path, and the count of all at the end
    double longest_spacing =
        0.0;  ///< mean arc from crossing to crossing of the paths; a quarter of the shortest path where there are none [length]
};

namespace detail {
/// Lines of the fibres of a yarn. Rows of its packing lie across `upward`, along the second director.
inline std::vector<scene::Curve> fibre_curves(const Textile& textile, Index p) {
    const Path& path = textile.paths[core::at(p)];
    const YarnType& type = textile.type_of(p);
    if (type.fibres == 1) return {path.curve};
    const weave::Packing packing = weave::compact_packing(type.fibres, type.radius, type.aspect, type.packing_gap);
    const double length = scene::length_of(path.curve), turns = type.twist * length;
    const auto samples = std::max<Index>(64, static_cast<Index>(length / type.radius));
    const bool repeats = path.kind != PathKind::open;
    if (repeats)
        core::require(std::abs(turns - std::round(turns)) < 1e-9, textile.label(p) + ": turns of its twist over its length",
                      turns, "whole, of a path that repeats");
    std::vector<scene::Curve> curves;
    for (const Eigen::Vector2d& centre : packing.centres)
        // g_1 is the direction of the thickness: across it lies -g_2.
        curves.push_back(scene::beside(path.curve, centre.y(), -centre.x(), turns, samples, path.upward,
                                       repeats ? scene::SplineEnds::repeating : scene::SplineEnds::parabolic));
    return curves;
}

/// Mean arc between neighbouring crossings of a path.
inline double crossing_spacing(const Textile& textile) {
    std::vector<Index> crossings(textile.paths.size(), 0);
    for (const Crossing& crossing : textile.crossings)
        ++crossings[core::at(crossing.above)], ++crossings[core::at(crossing.below)];
    double length = 0.0, shortest = std::numeric_limits<double>::infinity();
    Index count = 0;
    for (std::size_t p = 0; p < textile.paths.size(); ++p) {
        const double own = scene::length_of(textile.paths[p].curve, 128);
        shortest = std::min(shortest, own), length += own, count += crossings[p];
    }
    return count > 0 ? std::min(length / static_cast<double>(count), shortest) : 0.25 * shortest;
}
}  // namespace detail

/// Adds what a textile is to a scene of its own. Fibres start as drawn; those of paths that are straight at rest are so, of the
/// same length.
///
/// Pairs of yarns that have several fibres are given the order of their crossing, where they cross with one order only: a forced
/// order belongs to two groups. Yarns of one fibre keep the side on which they are drawn.
/// @throws std::invalid_argument naming yarn, field and bound
inline Assembled assemble(const Textile& textile, const Fineness& fineness) {
    validate(textile);
    fineness.validate();
    Assembled answer;
    scene::Assembly& assembly = answer.assembly;
    Index cell = -1;
    const auto cell_of = [&] {
        if (cell >= 0) return cell;
        scene::PeriodicCell periodic;
        periodic.name = "cell";
        for (std::size_t k = 0; k < 9; ++k)
            if (textile.free_gradient[k]) periodic.gradient[k] = scene::Coordinate::loose();
        return cell = assembly.add(periodic);
    };
    std::vector<Index> group;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        const YarnType& type = textile.type_of(p);
        group.push_back(assembly.add_group(path.name.empty() ? "yarn " + std::to_string(p) : path.name));
        answer.first_fibre.push_back(core::count(answer.path_of));
        const std::vector<scene::Curve> curves = detail::fibre_curves(textile, p);
        const double path_length = scene::length_of(path.curve, 128);
        const Index elements = std::max(
            fineness.least_elements, static_cast<Index>(std::ceil(path_length / (fineness.element_over_radius * type.radius))));
        for (const scene::Curve& curve : curves) {
            scene::FibreSpecification fibre;
            fibre.section = scene::circular(type.radius, type.inertia_factor), fibre.material = type.material;
            fibre.elements = elements, fibre.group = group.back(), fibre.director = path.upward;
            fibre.closed = path.kind == PathKind::closed;
            if (!path.straight) {
                fibre.curve = curve;
            } else {
                fibre.start = curve;
                if (!fibre.closed) {
                    const double length = scene::reference_shape(curve, 2 * elements + 1).length;
                    const Vec3 chord = curve(1.0) - curve(0.0),
                               along = chord.norm() > 0.0 ? Vec3(chord.normalized()) : Vec3(Vec3::UnitX());
                    fibre.from = curve(0.0), fibre.to = curve(0.0) + length * along;
                }
            }
            const Index f = assembly.add(fibre);
            answer.path_of.push_back(p);
            const scene::Station first = scene::first_end(f), last = scene::last_end(f);
            if (path.kind == PathKind::periodic) {
                assembly.connect(scene::PeriodicPair{first, last, path.image, cell_of()});
                assembly.hold_axial_rotation({f, 0.5});
            } else if (path.kind == PathKind::closed) {
                assembly.hold_axial_rotation(first);  // a ring that turns inside out of itself is the same ring
            } else if (path.ends != Ends::free) {
                assembly.hold_axial_rotation(first);
                assembly.hold_position(first);
                if (path.ends == Ends::held) {
                    assembly.hold_position(last);
                } else {
                    const double step = 0.25 / static_cast<double>(2 * elements);
                    const Vec3 along = scene::detail::curve_derivative(curve, 1.0, step).normalized();
                    assembly.hold_position(last, Mat3::Identity() - along * along.transpose());
                    const double pull = path.tension_strain * type.material.young_modulus * fibre.section.area();
                    assembly.apply(scene::DeadForce{last, scene::NodeVector::position, pull * along, tension_channel});
                }
            }
            for (const Guide& guide : path.guides) assembly.hold_position({f, guide.at}, guide.directions);
        }
    }
    answer.first_fibre.push_back(core::count(answer.path_of));
    answer.longest_spacing = detail::crossing_spacing(textile);

    // One order a pair; pairs that cross both ways have none.
    std::vector<std::pair<Index, Index>> orders;
    for (const Crossing& crossing : textile.crossings)
        if (crossing.above != crossing.below &&
            (textile.type_of(crossing.above).fibres > 1 || textile.type_of(crossing.below).fibres > 1))
            orders.emplace_back(crossing.above, crossing.below);
    std::sort(orders.begin(), orders.end());
    orders.erase(std::unique(orders.begin(), orders.end()), orders.end());
    if (textile.view.radial) orders.clear();
    for (const auto& [above, below] : orders)
        if (!std::binary_search(orders.begin(), orders.end(), std::pair{below, above}))
            assembly.force_order({group[core::at(above)], group[core::at(below)], textile.view.axis.normalized()});
    return answer;
}

}  // namespace fibrant::compositions::textile

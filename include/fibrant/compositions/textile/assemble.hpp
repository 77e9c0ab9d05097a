// SPDX-License-Identifier: MIT
#pragma once
/// @file A textile as a scene: fibres along paths, what holds their ends, orders of yarns of several fibres, and the cell.

#include <fibrant/compositions/textile/yarn_fibres.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
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
    double turn = 0.5;                 ///< greatest turn of a path along an element, in the mean of the path [radian], > 0
    void validate() const {
        core::require_positive("Fineness.element_over_radius", element_over_radius);
        core::require_at_least("Fineness.least_elements", least_elements, 3);
        core::require_positive("Fineness.turn", turn);
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
/// Angle by which a curve turns in all, by chords [radian].
inline double turning(const scene::Curve& curve, Index chords) {
    double sum = 0.0;
    Vec3 last = curve(0.0), along = Vec3::Zero();
    for (Index k = 1; k <= chords; ++k) {
        const Vec3 next = curve(static_cast<double>(k) / static_cast<double>(chords)), chord = next - last;
        if (k > 1) sum += std::atan2(along.cross(chord).norm(), along.dot(chord));
        last = next, along = chord;
    }
    return sum;
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

/// How the cell of a textile that repeats is driven.
struct CellDrive {
    bool strained = false;       ///< its six strains are held, by cell_channels(); else free ones are under the yarns' tension
    std::vector<Vec3> images{};  ///< from the start of each path to its end, as they stand now; empty: as drawn
    /// Fibres that repeat keep their places along their paths. Without friction nothing resists that they slide through their own
    /// waves, and no force is needed to hold them.
    bool kept_along = false;
    /// Fibres that repeat keep their spin in their middles. Friction holds it as well, and lets it go with the fabric.
    bool kept_spin = true;
};

/// Channels of the strains of a cell in the plane of x and y: of its lengths, and of the right angle between them, [1]; and the
/// curvatures w,xx, w,yy and w,xy of scene::PeriodicCell.
inline const std::array<std::string, 6>& cell_channels() {
    static const std::array<std::string, 6> names{"strain_x", "strain_y", "shear", "bend_x", "bend_y", "twist"};
    return names;
}

namespace detail {
inline scene::PeriodicCell cell_of(const Textile& textile, const CellDrive& drive) {
    scene::PeriodicCell cell;
    cell.name = "cell";
    if (drive.strained) {
        const auto& names = cell_channels();
        for (int k = 0; k < 2; ++k) cell.component(k, k) = scene::Coordinate::held_at(1.0, names[core::at(k)]);
        cell.component(0, 1) = cell.component(1, 0) = scene::Coordinate::held_at(0.5, names[2]);
        for (int k = 0; k < 3; ++k) cell.curvature[core::at(k)] = scene::Coordinate::held_at(1.0, names[core::at(3 + k)]);
        return cell;
    }
    Mat3 pull = Mat3::Zero();  // work of the yarns' tension for each component
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        const YarnType& type = textile.type_of(p);
        if (path.kind == PathKind::periodic)
            pull += static_cast<double>(type.fibres) * path.tension_strain * type.material.young_modulus *
                    scene::circular(type.radius, type.inertia_factor).area() * path.image.normalized() * path.image.transpose();
    }
    for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i)
            if (textile.free_gradient[core::at(i + 3 * j)])
                cell.component(i, j) = scene::Coordinate::under(pull(i, j), tension_channel);
    return cell;
}

/// Images of the fibres beside a cell that come near any of its own, of opposite ones one, so that contact acts across seams.
/// @param carrier  of each period of the lattice a pair that repeats by it
inline void add_images(scene::Assembly& assembly, const Textile& textile, const std::vector<Index>& path_of,
                       const std::vector<Index>& carrier) {
    constexpr double near = 8.0;  // radii, that yarns come nearer by while a cell settles
    constexpr Index chords = 64;  // of a path, for its box
    constexpr int furthest = 2;   // cells, that a path leads out of its own
    if (carrier.empty()) return;
    using Box = Eigen::AlignedBox3d;
    std::vector<Box> boxes;
    Box whole;
    for (const Path& path : textile.paths) {
        Box box;
        for (Index k = 0; k <= chords; ++k) box.extend(path.curve(static_cast<double>(k) / static_cast<double>(chords)));
        boxes.push_back(box), whole.extend(box);
    }
    const auto reach = [&](Index p) {
        const YarnType& type = textile.type_of(p);
        return type.radius * (near + 2.0 * std::sqrt(static_cast<double>(type.fibres)));
    };
    const bool two = carrier.size() > 1;
    for (int b = 0; b <= (two ? furthest : 0); ++b)
        for (int a = b == 0 ? 1 : -furthest; a <= furthest; ++a) {
            Vec3 shift = static_cast<double>(a) * textile.lattice[0];
            if (two) shift += static_cast<double>(b) * textile.lattice[1];
            std::vector<char> meets(textile.paths.size(), 0);
            for (Index p = 0; p < core::count(boxes); ++p) {
                const Vec3 grown = Vec3::Constant(2.0 * reach(p));
                const Box box(boxes[core::at(p)].min() + shift - grown, boxes[core::at(p)].max() + shift + grown);
                if (!box.intersects(whole)) continue;
                const bool near_one =
                    std::any_of(boxes.begin(), boxes.end(), [&](const Box& other) { return box.intersects(other); });
                meets[core::at(p)] = near_one ? 1 : 0;
            }
            scene::FibreImage image;
            if (a != 0) image.shifts.push_back({carrier[0], static_cast<double>(a)});
            if (b != 0) image.shifts.push_back({carrier[1], static_cast<double>(b)});
            for (Index f = 0; f < core::count(path_of); ++f)
                if (meets[core::at(path_of[core::at(f)])] != 0) image.fibre = f, assembly.add(image);
        }
}
}  // namespace detail

/// Adds what a textile is to a scene of its own. Fibres start as drawn; those of paths that are straight at rest are so, of the
/// same length.
///
/// Pairs of yarns that have several fibres are given the order of their crossing, and where they cross both ways that of each
/// crossing. Yarns of one fibre keep the side on which they are drawn.
/// What repeats keeps its mean place, which carries no force.
/// @throws std::invalid_argument naming yarn, field and bound
inline Assembled assemble(const Textile& textile, const Fineness& fineness, const CellDrive& drive = {}) {
    validate(textile);
    fineness.validate();
    Assembled answer;
    scene::Assembly& assembly = answer.assembly;
    Index cell = -1;
    const auto cell_of = [&] { return cell >= 0 ? cell : cell = assembly.add(detail::cell_of(textile, drive)); };
    scene::AverageConnection middle;
    std::vector<Index> carrier(textile.lattice.size(), -1);
    std::vector<Index> group;
    std::vector<std::vector<scene::Curve>> lines;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        const YarnType& type = textile.type_of(p);
        group.push_back(assembly.add_group(path.name.empty() ? "yarn " + std::to_string(p) : path.name));
        answer.first_fibre.push_back(core::count(answer.path_of));
        lines.push_back(detail::fibre_curves(textile, p));
        const std::vector<scene::Curve>& curves = lines.back();
        const double path_length = scene::length_of(path.curve, 128);
        // Steep helices turn by more than elements of a given length can follow: their fibres would go through each other.
        const auto by_length = static_cast<Index>(std::ceil(path_length / (fineness.element_over_radius * type.radius)));
        Index elements = std::max(fineness.least_elements, by_length);
        for (const scene::Curve& curve : curves)  // a packing that is twisted turns more than its path
            elements =
                std::max(elements, static_cast<Index>(std::ceil(detail::turning(curve, 8 * by_length + 64) / fineness.turn)));
        for (const scene::Curve& curve : curves) {
            scene::FibreSpecification fibre;
            fibre.section = scene::circular(type.radius, type.inertia_factor), fibre.material = type.material;
            fibre.elements = elements, fibre.group = group.back(), fibre.director = path.upward;
            fibre.closed = path.kind == PathKind::closed, fibre.repeats = path.kind == PathKind::periodic;
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
                for (std::size_t k = 0; k < carrier.size(); ++k)
                    if (carrier[k] < 0 && path.image.isApprox(textile.lattice[k], 1e-9))
                        carrier[k] = core::count(assembly.pairs());
                assembly.connect(
                    scene::PeriodicPair{first, last, drive.images.empty() ? path.image : drive.images[core::at(p)], cell_of()});
                if (drive.kept_spin) assembly.hold_axial_rotation({f, 0.5});
                middle.ends.push_back({f, 0.5});
                if (drive.kept_along) {
                    const Vec3 along = path.image.normalized();
                    assembly.hold_position({f, 0.25}, along * along.transpose());  // no node is held twice
                }
            } else if (path.kind == PathKind::closed) {
                assembly.hold_axial_rotation(first);  // a ring that turns inside out of itself is the same ring
            } else if (path.ends != Ends::free) {
                assembly.hold_axial_rotation(first);
                assembly.hold_position(first);
                const double step = 0.25 / static_cast<double>(2 * elements);
                const auto along = [&](double end) -> Vec3 {
                    return (path.pull.isZero() ? scene::detail::curve_derivative(curve, end, step) : path.pull).normalized();
                };
                const auto across = [](const Vec3& axis) -> Mat3 { return Mat3::Identity() - axis * axis.transpose(); };
                if (path.grip > 0.0) {
                    assembly.hold_position({f, path.grip}, across(along(0.0)));
                    assembly.hold_position({f, 1.0 - path.grip}, across(along(1.0)));
                }
                if (path.ends == Ends::held) {
                    assembly.hold_position(last);
                } else {
                    assembly.hold_position(last, across(along(1.0)));
                    const double pull = path.tension_strain * type.material.young_modulus * fibre.section.area();
                    assembly.apply(scene::DeadForce{last, scene::NodeVector::position, pull * along(1.0), tension_channel});
                }
            }
            for (const Guide& guide : path.guides) assembly.hold_position({f, guide.at}, guide.directions);
        }
    }
    if (!middle.ends.empty()) {
        middle.body = assembly.add(scene::RigidBody{});
        assembly.connect(middle);
    }
    if (std::find(carrier.begin(), carrier.end(), -1) == carrier.end())
        detail::add_images(assembly, textile, answer.path_of, carrier);
    answer.first_fibre.push_back(core::count(answer.path_of));
    answer.longest_spacing = detail::crossing_spacing(textile);

    // One order a pair; pairs that cross both ways have one a crossing, with its places. Pairs that cross more than once and
    // whose fibres do so rightly as they are drawn have none: they keep their sides, and touch beside crossings as well.
    std::vector<Crossing> orders;
    for (const Crossing& crossing : textile.crossings)
        if (!textile.view.radial && crossing.above != crossing.below &&
            (textile.type_of(crossing.above).fibres > 1 || textile.type_of(crossing.below).fibres > 1))
            orders.push_back(crossing);
    using Pair = std::pair<Index, Index>;
    const auto pair_of = [](const Crossing& crossing) { return Pair{crossing.above, crossing.below}; };
    std::stable_sort(orders.begin(), orders.end(), [&](const Crossing& a, const Crossing& b) { return pair_of(a) < pair_of(b); });
    const auto crosses = [&](const Pair& pair) {
        const auto at = std::lower_bound(orders.begin(), orders.end(), pair,
                                         [&](const Crossing& a, const auto& wanted) { return pair_of(a) < wanted; });
        return at != orders.end() && pair_of(*at) == pair;
    };
    std::vector<Pair> all, again;  // pairs of each crossing, and those that cross more than once
    for (const Crossing& crossing : orders)
        all.emplace_back(std::min(crossing.above, crossing.below), std::max(crossing.above, crossing.below));
    std::sort(all.begin(), all.end());
    for (std::size_t k = 1; k < all.size(); ++k)
        if (all[k] == all[k - 1] && (again.empty() || again.back() != all[k])) again.push_back(all[k]);
    std::vector<Pair> right;
    if (!again.empty()) {
        const detail::FibreCrossings drawn(textile, lines);
        std::copy_if(again.begin(), again.end(), std::back_inserter(right), [&](const Pair& pair) { return drawn.right(pair); });
    }
    for (std::size_t k = 0; k < orders.size(); ++k) {
        const auto [above, below] = pair_of(orders[k]);
        const Pair pair{std::min(above, below), std::max(above, below)};
        const bool both_ways = crosses({below, above});
        if (!both_ways && k > 0 && pair_of(orders[k - 1]) == pair_of(orders[k])) continue;
        if (std::binary_search(right.begin(), right.end(), pair)) continue;
        scene::ForcedOrder order{group[core::at(above)], group[core::at(below)], textile.view.axis.normalized()};
        if (both_ways) {
            const auto part = [&](double at, Index path) {
                return std::clamp(at / scene::length_of(textile.paths[core::at(path)].curve), 0.0, 1.0);
            };
            order.at_above = part(orders[k].at_above, above), order.at_below = part(orders[k].at_below, below);
        }
        assembly.force_order(order);
    }
    return answer;
}

/// Refuses ends of yarns that lie in each other and keep their places: nothing can part them.
/// @param allowed  how deep fibres may be in each other at the end [length], >= 0
/// @throws std::invalid_argument naming the length that they are apart by, the value that would do, and the two yarns
inline void require_ends_apart(const Textile& textile, const Assembled& assembled, double allowed) {
    std::vector<std::array<Vec3, 2>> ends;  // and a point a little inwards
    std::vector<Index> yarn;
    for (std::size_t f = 0; f < assembled.path_of.size(); ++f) {
        const Index p = assembled.path_of[f];
        const Path& path = textile.paths[core::at(p)];
        const scene::FibreSpecification& fibre = assembled.assembly.fibres()[f];
        const scene::Curve& curve = fibre.start ? fibre.start : fibre.curve;
        if (path.kind != PathKind::open || path.ends == Ends::free || !curve) continue;
        constexpr double inwards = 1e-3;  // of the curve
        ends.push_back({curve(0.0), curve(inwards)}), ends.push_back({curve(1.0), curve(1.0 - inwards)});
        yarn.insert(yarn.end(), 2, p);
    }
    std::vector<proximity::Centreline> lines;
    for (std::size_t k = 0; k < ends.size(); ++k) lines.push_back({.points = ends[k], .radius = textile.type_of(yarn[k]).radius});
    for (const proximity::SegmentPair& pair : proximity::GridSearch{}.pairs(lines, 0.0)) {
        const Index a = yarn[core::at(pair.i)], b = yarn[core::at(pair.j)];
        const double apart = (ends[core::at(pair.j)][0] - ends[core::at(pair.i)][0]).norm(),
                     least = textile.type_of(a).radius + textile.type_of(b).radius - allowed;
        if ((a == b && pair.i % 2 == pair.j % 2) || apart >= least)
            continue;  // fibres of one yarn at one end, as they are packed
        // Fibres of a yarn stay beside its path as they are where paths go apart.
        const auto end = [&](Index k) { return textile.paths[core::at(yarn[core::at(k)])].curve(k % 2 == 0 ? 0.0 : 1.0); };
        const Vec3 between = end(pair.j) - end(pair.i);
        const double whole = between.norm() + least - apart;  // that is needed
        const std::string why = "distance of ends of fibres of " + textile.label(a) + " and " + textile.label(b) + ", which " +
                                "keep their places, is " + core::text(apart) + " where " + core::text(least) + " is needed";
        Index axis = 0;
        const double along = between.cwiseAbs().maxCoeff(&axis);
        const ApartBy& by = textile.apart_by[core::at(axis)];
        const double radius = textile.type_of(a).radius;
        if (by.field.empty() || a == b || !(along > 0.0))
            core::refuse("YarnType.radius", core::text(radius),
                         (along > 0.0 ? "<= " + core::text(radius * between.norm() / whole) : std::string("less")) + ": " + why);
        const double factor = std::sqrt(whole * whole - between.squaredNorm() + along * along) / along;  // along that axis alone
        core::refuse(by.field, core::text(by.given),
                     ">= " + core::text(by.given + by.whole * (factor - 1.0)) + " with fibres of radius " + core::text(radius) +
                         ": " + why);
    }
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file Figures of a settled fabric: crimp of fibres and tows, curvature, thickness.

#include <fibrant/compositions/weave/tow_geometry.hpp>
#include <fibrant/observe/least_gap.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace fibrant::compositions::weave {

/// Arc length over projected length, less 1, of the part of a curve between two planes across an axis [1].
/// @param axis      0 for x, 1 for y, 2 for z
/// @param from, to  where the part begins and ends on that axis, from < to [length]; NaN is returned unless the curve
///                  reaches both
inline double crimp(const observe::NodalCurve& curve, Index axis, double from, double to) {
    const Vec3 normal = Vec3::Unit(axis);
    const auto a = curve.meets(normal, from), b = curve.meets(normal, to);
    if (!a || !b || !(to > from)) return std::numeric_limits<double>::quiet_NaN();
    return curve.length(std::min(*a, *b), std::max(*a, *b)) / (to - from) - 1.0;
}

/// Crimp between the outermost crossings.
struct CrimpMeasures {
    std::vector<double> fibres;                ///< of each fibre of the fabric [1]
    std::vector<double> warp_tows, weft_tows;  ///< of each tow's centre line [1]
    double warp = 0, weft = 0;                 ///< mean over the fibres of the family [1]
};

/// Part of a fabric between the middles of its outermost tows [length].
struct Outline {
    double x_from = 0, x_to = 0, y_from = 0, y_to = 0;
};

/// Parameters on a tow's centre line of its crossings in plan with the tows of the other family, in their order; NaN
/// where they do not cross.
inline std::vector<double> crossing_parameters(const observe::Snapshot& snapshot, const FabricParameters& fabric, Family family,
                                               Index tow) {
    const std::vector<Vec3> own = tow_centreline(snapshot, fabric, family, tow);
    std::vector<double> answer;
    for (Index k = 0; k < fabric.tows(other(family)); ++k) {
        const std::vector<Vec3> nodes = tow_centreline(snapshot, fabric, other(family), k);
        const bool is_warp = family == Family::warp;
        double place = std::numeric_limits<double>::quiet_NaN();
        for_each_plan_crossing(observe::NodalCurve{is_warp ? own : nodes}, observe::NodalCurve{is_warp ? nodes : own},
                               [&](const PlanCrossing& crossing) { place = is_warp ? crossing.warp : crossing.weft; });
        answer.push_back(place);
    }
    return answer;
}

/// Crimp of every fibre and tow; a fibre that does not reach its outermost crossings has NaN and makes the mean NaN.
inline CrimpMeasures crimp_measures(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    require_snapshot_of(snapshot, fabric);
    CrimpMeasures answer;
    answer.fibres.resize(core::at(fabric.fibres()));
    for (const Family family : {Family::warp, Family::weft}) {
        const Index axis = axis_of(family), fibres = fabric.tow(family).fibres;
        double sum = 0.0;
        for (Index tow = 0; tow < fabric.tows(family); ++tow) {
            const std::vector<double> crossings = crossing_parameters(snapshot, fabric, family, tow);
            const std::vector<Vec3> centre = tow_centreline(snapshot, fabric, family, tow);
            const observe::NodalCurve line{centre};
            const double from = line.position(crossings.front())[axis], to = line.position(crossings.back())[axis];
            (family == Family::warp ? answer.warp_tows : answer.weft_tows).push_back(crimp(line, axis, from, to));
            for (Index k = 0; k < fibres; ++k) {
                const std::size_t fibre = core::at(fabric.fibre(family, tow, k));
                answer.fibres[fibre] = crimp(observe::NodalCurve{snapshot.fibres[fibre].position}, axis, from, to);
                sum += answer.fibres[fibre];
            }
        }
        (family == Family::warp ? answer.warp : answer.weft) = sum / static_cast<double>(fabric.tows(family) * fibres);
    }
    return answer;
}

/// Heights of the lowest and of the highest surface of all fibres at their nodes, free ends included [length].
inline std::array<double, 2> heights(const observe::Snapshot& snapshot) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres)
        for (const Vec3& node : fibre.position)
            low = std::min(low, node.z() - fibre.section.radius()), high = std::max(high, node.z() + fibre.section.radius());
    return {low, high};
}

/// Outline of the woven part: what is measured does not depend on the free ends.
inline Outline outline(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    require_snapshot_of(snapshot, fabric);
    const auto middle = [&](Family family, Index tow) {
        const std::vector<Vec3> nodes = tow_centreline(snapshot, fabric, family, tow);
        double sum = 0.0;
        for (const Vec3& node : nodes) sum += node[axis_of(other(family))];
        return sum / static_cast<double>(nodes.size());
    };
    return {middle(Family::weft, 0), middle(Family::weft, fabric.weft_tows - 1), middle(Family::warp, 0),
            middle(Family::warp, fabric.warp_tows - 1)};
}

/// Height between the lowest and the highest surface of the fibres within the outline [length].
inline double thickness(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    const Outline part = outline(snapshot, fabric);
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const observe::FibreSnapshot& fibre : snapshot.fibres) {
        const Index steps = 4 * (core::count(fibre.position) - 1);  // a quarter of a node interval
        const observe::NodalCurve curve{fibre.position};
        for (Index k = 0; k <= steps; ++k) {
            const double t = 0.25 * static_cast<double>(k);
            const Vec3 x = curve.position(t);
            if (x.x() < part.x_from || x.x() > part.x_to || x.y() < part.y_from || x.y() > part.y_to) continue;
            const double extent = section_extent(fibre, curve, t, Vec3::UnitZ());
            low = std::min(low, x.z() - extent);
            high = std::max(high, x.z() + extent);
        }
    }
    return high - low;
}

/// Curvature along fibres, weighted by arc length [1 / length].
struct CurvatureStatistics {
    double mean = 0, root_mean_square = 0, greatest = 0;
};

/// Curvature of some fibres of a snapshot.
/// @param fibres  numbers in the snapshot
inline CurvatureStatistics curvature_statistics(const observe::Snapshot& snapshot, std::span<const Index> fibres) {
    CurvatureStatistics answer;
    double length = 0.0;
    for (const Index fibre : fibres) {
        const observe::NodalCurve curve{snapshot.fibres[core::at(fibre)].position};
        curve.integrate(0.0, curve.end(), [&](double t, double weight) {
            const double kappa = curve.curvature(t);
            length += weight;
            answer.mean += weight * kappa;
            answer.root_mean_square += weight * kappa * kappa;
            answer.greatest = std::max(answer.greatest, kappa);
        });
    }
    answer.mean /= length;
    answer.root_mean_square = std::sqrt(answer.root_mean_square / length);
    return answer;
}

/// Of all fibres of a tow.
inline CurvatureStatistics curvature_statistics(const observe::Snapshot& snapshot, const FabricParameters& fabric, Family family,
                                                Index tow) {
    std::vector<Index> fibres(core::at(fabric.tow(family).fibres));
    std::iota(fibres.begin(), fibres.end(), fabric.fibre(family, tow, 0));
    return curvature_statistics(snapshot, fibres);
}

}  // namespace fibrant::compositions::weave

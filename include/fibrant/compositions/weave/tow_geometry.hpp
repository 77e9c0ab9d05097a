// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres and tows of a settled fabric: centre lines, and where they cross in plan.

#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// Throws unless the snapshot has the fibres and nodes of that fabric, in its order.
inline void require_snapshot_of(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    if (core::count(snapshot.fibres) != fabric.fibres())
        core::refuse("Snapshot.fibres", std::to_string(snapshot.fibres.size()),
                     "those of the fabric, " + std::to_string(fabric.fibres()));
    for (std::size_t k = 0; k < snapshot.fibres.size(); ++k)
        if (const Index nodes = fabric.nodes_per_fibre(fabric.place(static_cast<Index>(k)).family);
            core::count(snapshot.fibres[k].position) != nodes)
            core::refuse("Snapshot.fibres[" + std::to_string(k) + "].position",
                         std::to_string(snapshot.fibres[k].position.size()) + " nodes", "of " + std::to_string(nodes) + " nodes");
}

/// Coordinate along the fibres of a family: 0 for warp, 1 for weft.
constexpr Index axis_of(Family family) noexcept { return family == Family::warp ? 0 : 1; }

/// Warp for weft, and weft for warp.
constexpr Family other(Family family) noexcept { return family == Family::warp ? Family::weft : Family::warp; }

/// Nodes of a tow's centre line: the mean of its fibres, node by node [length].
inline std::vector<Vec3> tow_centreline(const observe::Snapshot& snapshot, const FabricParameters& fabric, Family family,
                                        Index tow) {
    const Index fibres = fabric.tow(family).fibres;
    std::vector<Vec3> mean(core::at(fabric.nodes_per_fibre(family)), Vec3::Zero());
    for (Index k = 0; k < fibres; ++k) {
        const auto& fibre = snapshot.fibres[core::at(fabric.fibre(family, tow, k))];
        for (std::size_t node = 0; node < mean.size(); ++node) mean[node] += fibre.position[node];
    }
    for (Vec3& point : mean) point /= static_cast<double>(fibres);
    return mean;
}

/// Parameters of two curves at which their projections on the plane z = 0 meet.
struct PlanCrossing {
    double warp = 0, weft = 0;
};

namespace detail {

/// A curve whose y grows along it, as a function of y.
class CurveOverY {
public:
    explicit CurveOverY(const observe::NodalCurve& curve) : curve_{&curve} {}

    /// Parameter at which y is reached, at the nearest end if it is not. Quick where y is near that of the last call.
    double parameter(double y) noexcept {
        const auto nodes = curve_->nodes();
        while (first_ + 3 < nodes.size() && y > nodes[first_ + 2].y()) first_ += 2;
        while (first_ > 0 && y < nodes[first_].y()) first_ -= 2;
        const double from = nodes[first_].y(), middle = nodes[first_ + 1].y(), to = nodes[first_ + 2].y();
        // y = middle + p s + q s^2 in the element, s in [-1, 1]; the root that is right for p > 0 also where q is tiny.
        const double p = 0.5 * (to - from), q = 0.5 * (from + to) - middle, c = middle - y;
        const double s = -2.0 * c / (p + std::sqrt(std::max(0.0, p * p - 4.0 * q * c)));
        return static_cast<double>(first_) + 1.0 + (s >= -1.0 ? std::min(s, 1.0) : -1.0);
    }

private:
    const observe::NodalCurve* curve_;
    std::size_t first_ = 0;
};

}  // namespace detail

/// Calls visit(const PlanCrossing&) at every crossing in plan of a warp curve with a weft curve along which y grows.
///
/// At the y of a point of the warp, the weft lies before or behind it in x: where that changes between two nodes,
/// regula falsi (Illinois) finds the crossing. Time linear in the nodes.
/// @return number of crossings found; 0 for two fibres of a fabric tells that one slipped out of it
template <class Visit>
Index for_each_plan_crossing(const observe::NodalCurve& warp, const observe::NodalCurve& weft, const Visit& visit) {
    detail::CurveOverY over_y(weft);
    double u = 0.0;
    const auto beside = [&](double t) {
        const Vec3 x = warp.position(t);
        u = over_y.parameter(x.y());
        return x.x() - weft.position(u).x();
    };
    Index found = 0;
    double before = beside(0.0);
    for (Index node = 1; node < core::count(warp.nodes()); ++node) {
        const double now = beside(static_cast<double>(node));
        if ((before < 0.0) != (now < 0.0)) {
            double low = static_cast<double>(node - 1), high = static_cast<double>(node), at_low = before, at_high = now;
            double t = high, value = now;
            int kept = 0;  // the end that the last step kept
            for (int iteration = 0; iteration < 100 && high - low > 1e-13 && value != 0.0; ++iteration) {
                t = (low * at_high - high * at_low) / (at_high - at_low);
                value = beside(t);
                if ((value < 0.0) == (at_low < 0.0)) {
                    low = t, at_low = value;
                    if (kept == 1) at_high *= 0.5;
                    kept = 1;
                } else {
                    high = t, at_high = value;
                    if (kept == -1) at_low *= 0.5;
                    kept = -1;
                }
                if (std::abs(value) <= 1e-14 * warp.tangent(t).norm()) break;
            }
            beside(t);
            // An end of the weft that was passed changes side too, but is not met.
            const Vec3 apart = warp.position(t) - weft.position(u);
            if (std::hypot(apart.x(), apart.y()) <= 1e-9 * warp.tangent(t).norm()) {
                visit(PlanCrossing{t, u});
                ++found;
            }
        }
        before = now;
    }
    return found;
}

}  // namespace fibrant::compositions::weave

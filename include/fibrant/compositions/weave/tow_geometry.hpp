// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres and tows of a settled fabric: centre lines, and where they cross in plan.

#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/compositions/weave/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <optional>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// Throws unless the snapshot has the fibres and nodes of that fabric, in its order.
inline void require_snapshot_of(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    if (core::count(snapshot.fibres) != fabric.fibres())
        core::refuse("Snapshot.fibres", std::to_string(snapshot.fibres.size()),
                     "those of the fabric, " + std::to_string(fabric.fibres()));
    for (std::size_t k = 0; k < snapshot.fibres.size(); ++k)
        if (core::count(snapshot.fibres[k].position) != fabric.nodes_per_fibre())
            core::refuse("Snapshot.fibres[" + std::to_string(k) + "].position",
                         std::to_string(snapshot.fibres[k].position.size()) + " nodes",
                         "of " + std::to_string(fabric.nodes_per_fibre()) + " nodes");
}

/// Coordinate along the fibres of a family: 0 for warp, 1 for weft.
constexpr Index axis_of(Family family) noexcept { return family == Family::warp ? 0 : 1; }

constexpr Family other(Family family) noexcept { return family == Family::warp ? Family::weft : Family::warp; }

/// Nodes of a tow's centre line: the mean of its fibres, node by node [length].
inline std::vector<Vec3> tow_centreline(const observe::Snapshot& snapshot, const FabricParameters& fabric,
                                        Family family, Index tow) {
    const Index fibres = fabric.tow(family).fibres;
    std::vector<Vec3> mean(core::at(fabric.nodes_per_fibre()), Vec3::Zero());
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

/// Newton's method from a first guess; nothing if it leaves the curves or does not converge.
inline std::optional<PlanCrossing> refined_crossing(const NodalCurve& warp, const NodalCurve& weft,
                                                    PlanCrossing guess) {
    const double size = warp.tangent(guess.warp).norm() + weft.tangent(guess.weft).norm();
    for (int iteration = 0; iteration < 30; ++iteration) {
        const Vec3 d = warp.position(guess.warp) - weft.position(guess.weft);
        const Vec3 a = warp.tangent(guess.warp), b = weft.tangent(guess.weft);
        const double determinant = -a.x() * b.y() + b.x() * a.y();
        if (std::hypot(d.x(), d.y()) <= 1e-12 * size) return guess;
        if (determinant == 0.0) return std::nullopt;
        const double step_a = (d.x() * b.y() - b.x() * d.y()) / determinant;
        const double step_b = (-a.x() * d.y() + a.y() * d.x()) / determinant;
        // A step over more than an element is cut: the curve there is another parabola.
        const double cut = std::min(1.0, 2.0 / std::max({std::abs(step_a), std::abs(step_b), 1e-300}));
        const double t = std::clamp(guess.warp + cut * step_a, 0.0, warp.end());
        const double u = std::clamp(guess.weft + cut * step_b, 0.0, weft.end());
        if (t == guess.warp && u == guess.weft) break;
        guess = {t, u};
    }
    const Vec3 d = warp.position(guess.warp) - weft.position(guess.weft);
    if (std::hypot(d.x(), d.y()) <= 1e-9 * size) return guess;
    return std::nullopt;
}

}  // namespace detail

/// Calls visit(const PlanCrossing&) at every crossing in plan of a warp curve with a weft curve that nowhere turns back
/// in y. Time linear in the nodes.
/// @return number of crossings found; 0 for two fibres of a fabric tells that one slipped out of it
template <class Visit>
Index for_each_plan_crossing(const NodalCurve& warp, const NodalCurve& weft, const Visit& visit) {
    const auto a = warp.nodes(), b = weft.nodes();
    const auto last = core::count(b) - 2;
    Index piece = 0;
    // Distance in x from the chords of the weft, at the y of a warp node.
    const auto beside = [&](std::size_t node, double& u) {
        const double y = a[node].y();
        while (piece < last && y > b[core::at(piece + 1)].y()) ++piece;
        while (piece > 0 && y < b[core::at(piece)].y()) --piece;
        const Vec3 &from = b[core::at(piece)], &to = b[core::at(piece + 1)];
        const double share = std::clamp((y - from.y()) / (to.y() - from.y()), 0.0, 1.0);
        u = static_cast<double>(piece) + share;
        return a[node].x() - (1.0 - share) * from.x() - share * to.x();
    };
    Index found = 0;
    double u_before = 0.0, u = 0.0;
    double before = beside(0, u_before);
    for (std::size_t node = 1; node < a.size(); ++node) {
        const double now = beside(node, u);
        if ((before < 0.0) != (now < 0.0)) {
            const double share = before / (before - now);
            const auto crossing = detail::refined_crossing(
                warp, weft, {static_cast<double>(node - 1) + share, u_before + share * (u - u_before)});
            if (crossing) {
                visit(*crossing);
                ++found;
            }
        }
        before = now;
        u_before = u;
    }
    return found;
}

}  // namespace fibrant::compositions::weave

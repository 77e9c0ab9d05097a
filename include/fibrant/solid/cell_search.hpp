// SPDX-License-Identifier: MIT
#pragma once
/// @file Which cell of a solid holds a point.

#include <fibrant/core/parameters.hpp>
#include <fibrant/scene/solid.hpp>
#include <fibrant/solid/hexahedron_map.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fibrant::solid {

/// Places of a cell's nodes.
inline CellNodes cell_nodes(const scene::Solid& solid, Index cell) {
    CellNodes nodes;
    for (int k = 0; k < 8; ++k) nodes.row(k) = solid.nodes[core::at(solid.cells[core::at(cell)][core::at(k)])].transpose();
    return nodes;
}

/// Throws std::invalid_argument naming the first cell whose Jacobian is not positive at its middle and corners.
inline void require_valid_cells(const scene::Solid& solid) {
    for (Index c = 0; c < core::count(solid.cells); ++c) {
        const double least = least_jacobian(cell_nodes(solid, c));
        core::require(least > 1e-9, "Solid.cells[" + std::to_string(c) + "].jacobian", least,
                      "> 1e-9 of its box at the middle and at every corner: the cell is inside out, or flat");
    }
}

/// Boxes of the cells in a grid of buckets of about a cell's size. Memory and time are linear in the cells while they are of
/// similar sizes. A view: the solid must outlive it.
class CellSearch {
public:
    explicit CellSearch(const scene::Solid& solid) : solid_{&solid} {
        const Index n = core::count(solid.cells);
        low_.resize(core::at(n)), high_.resize(core::at(n));
        Vec3 sum = Vec3::Zero();
        for (Index c = 0; c < n; ++c) {
            const CellNodes nodes = cell_nodes(solid, c);
            Vec3 low = nodes.colwise().minCoeff(), high = nodes.colwise().maxCoeff();
            const Vec3 margin = Vec3::Constant(4.0 * map_tolerance * (high - low).maxCoeff());
            low_[core::at(c)] = low - margin, high_[core::at(c)] = high + margin;
            sum += high - low;
            if (c == 0) origin_ = low_[0], end_ = high_[0];
            origin_ = origin_.cwiseMin(low_[core::at(c)]), end_ = end_.cwiseMax(high_[core::at(c)]);
        }
        for (int axis = 0; axis < 3; ++axis) {
            const double extent = end_[axis] - origin_[axis], mean = n > 0 ? sum[axis] / static_cast<double>(n) : 1.0;
            size_[axis] = std::max(mean, extent / 1024.0);
            if (!(size_[axis] > 0.0)) size_[axis] = 1.0;
            count_[core::at(axis)] = std::max<Index>(1, static_cast<Index>(std::ceil(extent / size_[axis])));
        }
        start_.assign(core::at(count_[0] * count_[1] * count_[2] + 1), 0);
        for (Index c = 0; c < n; ++c) each_bucket(c, [&](Index b) { ++start_[core::at(b + 1)]; });
        for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
        cells_.resize(core::at(start_.back()));
        std::vector<Index> next(start_.begin(), start_.end() - 1);
        for (Index c = 0; c < n; ++c) each_bucket(c, [&](Index b) { cells_[core::at(next[core::at(b)]++)] = c; });
    }

    struct Found {
        Index cell = -1;  ///< the lowest that holds the point; -1: none
        Vec3 xi = Vec3::Zero();
        bool degenerate = false;  ///< a cell near it could not be inverted
    };
    Found find(const Vec3& x) const {
        Found found;
        for (int axis = 0; axis < 3; ++axis)
            if (!(x[axis] >= origin_[axis] && x[axis] <= end_[axis])) return found;
        const Index b = bucket(place(x, 0), place(x, 1), place(x, 2));
        for (Index k = start_[core::at(b)]; k < start_[core::at(b + 1)]; ++k) {  // rising
            const Index c = cells_[core::at(k)];
            if ((x.array() < low_[core::at(c)].array()).any() || (x.array() > high_[core::at(c)].array()).any()) continue;
            const MapResult map = inverse_map(cell_nodes(*solid_, c), x);
            found.degenerate = found.degenerate || map.status == MapStatus::degenerate;
            if (map.status != MapStatus::inside) continue;
            found.cell = c, found.xi = map.xi;
            return found;
        }
        return found;
    }

private:
    Index place(const Vec3& x, int axis) const noexcept {
        return std::clamp<Index>(static_cast<Index>((x[axis] - origin_[axis]) / size_[axis]), 0, count_[core::at(axis)] - 1);
    }
    Index bucket(Index i, Index j, Index k) const noexcept { return (k * count_[1] + j) * count_[0] + i; }
    template <class Body>
    void each_bucket(Index c, const Body& body) const {
        const Vec3 &low = low_[core::at(c)], &high = high_[core::at(c)];
        for (Index k = place(low, 2); k <= place(high, 2); ++k)
            for (Index j = place(low, 1); j <= place(high, 1); ++j)
                for (Index i = place(low, 0); i <= place(high, 0); ++i) body(bucket(i, j, k));
    }

    const scene::Solid* solid_;
    std::vector<Vec3> low_, high_;
    Vec3 origin_ = Vec3::Zero(), end_ = Vec3::Zero(), size_ = Vec3::Ones();
    std::array<Index, 3> count_{1, 1, 1};
    std::vector<Index> start_, cells_;
};

}  // namespace fibrant::solid

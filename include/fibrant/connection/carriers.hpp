// SPDX-License-Identifier: MIT
#pragma once
/// @file How fibres move when they go with the solid around them: what coarse spaces of composites are made of.

#include <fibrant/connection/bonding.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fibrant::connection {

/// A nodal vector as a weighted sum of the nodes of one cell; cell -1: it is carried by none.
struct Carrier {
    Index cell = -1;  ///< numbered through all solids
    solid::CellWeights weights = solid::CellWeights::Zero();
};

namespace detail {

/// The nearest of some points, by a grid of buckets searched in growing shells. Ties go to the lowest.
class NearestPoint {
public:
    explicit NearestPoint(std::vector<Vec3> points) : points_{std::move(points)} {
        if (points_.empty()) return;
        Vec3 high = points_.front();
        low_ = high;
        for (const Vec3& p : points_) low_ = low_.cwiseMin(p), high = high.cwiseMax(p);
        const Vec3 extent = (high - low_).cwiseMax(1e-6 * (high - low_).maxCoeff() + 1e-300);
        size_ = std::cbrt(extent.prod() / static_cast<double>(points_.size()));
        size_ = std::max(size_, extent.maxCoeff() / 256.0);
        for (int axis = 0; axis < 3; ++axis) count_[core::at(axis)] = static_cast<Index>(extent[axis] / size_) + 1;
        start_.assign(core::at(count_[0] * count_[1] * count_[2] + 1), 0);
        for (const Vec3& p : points_) ++start_[core::at(bucket(cell(p)) + 1)];
        for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
        list_.resize(points_.size());
        std::vector<Index> next(start_.begin(), start_.end() - 1);
        for (Index k = 0; k < core::count(points_); ++k)
            list_[core::at(next[core::at(bucket(cell(points_[core::at(k)])))]++)] = k;
    }
    /// -1 if there are none.
    Index find(const Vec3& x) const {
        if (points_.empty()) return -1;
        const std::array<Index, 3> at = cell(x);
        Index best = -1;
        double least = std::numeric_limits<double>::infinity();
        const Index most = std::max({count_[0], count_[1], count_[2]});
        for (Index shell = 0; shell <= most; ++shell) {
            // A point outside the grid is further from all shells by its distance to the bucket it was put in: no harm.
            if (best >= 0 && least <= std::pow(static_cast<double>(shell - 1) * size_, 2)) break;
            for (Index k = at[2] - shell; k <= at[2] + shell; ++k)
                for (Index j = at[1] - shell; j <= at[1] + shell; ++j) {
                    const bool face = std::max(std::abs(k - at[2]), std::abs(j - at[1])) == shell;
                    for (Index i = at[0] - shell; i <= at[0] + shell; i += face || shell == 0 ? 1 : 2 * shell) {
                        if (i < 0 || j < 0 || k < 0 || i >= count_[0] || j >= count_[1] || k >= count_[2]) continue;
                        const Index b = bucket({i, j, k});
                        for (Index n = start_[core::at(b)]; n < start_[core::at(b + 1)]; ++n) {
                            const Index p = list_[core::at(n)];
                            const double square = (points_[core::at(p)] - x).squaredNorm();
                            if (square < least || (square == least && p < best)) least = square, best = p;
                        }
                    }
                }
        }
        return best;
    }

private:
    std::array<Index, 3> cell(const Vec3& x) const noexcept {
        std::array<Index, 3> at{};
        for (int axis = 0; axis < 3; ++axis)
            at[core::at(axis)] =
                std::clamp<Index>(static_cast<Index>(std::floor((x[axis] - low_[axis]) / size_)), 0, count_[core::at(axis)] - 1);
        return at;
    }
    Index bucket(const std::array<Index, 3>& at) const noexcept { return (at[2] * count_[1] + at[1]) * count_[0] + at[0]; }

    std::vector<Vec3> points_;
    Vec3 low_ = Vec3::Zero();
    double size_ = 1.0;
    std::array<Index, 3> count_{1, 1, 1};
    std::vector<Index> start_, list_;
};

}  // namespace detail

/// Carriers of all nodal vectors of the fibres at `state`: a node moves with the material of the bonded node that is nearest to
/// it (itself, if it is bonded), as the gradient of the cell's displacement says for its distance; directions turn and
/// stretch with that gradient. A uniform displacement gradient of the solids is so met by all fibres exactly.
template <beam::BeamElement B>
std::vector<Carrier> find_carriers(const beam::Mesh<B>& mesh, const std::vector<scene::Solid>& solids,
                                   const std::vector<Bond>& bonds, const Vector& state) {
    std::vector<Index> first{0};
    for (const scene::Solid& solid : solids) first.push_back(first.back() + core::count(solid.cells));
    std::vector<Vec3> places;
    std::vector<Index> own(core::at(mesh.layout().vectors()), -1);
    std::vector<const Bond*> of_place;
    for (const Bond& bond : bonds) {
        if (bond.section) continue;
        own[core::at(bond.vector)] = core::count(places);
        places.push_back(state.segment<3>(3 * bond.vector)), of_place.push_back(&bond);
    }
    const detail::NearestPoint nearest(places);
    std::vector<Carrier> carriers(core::at(mesh.layout().vectors()));
    core::parallel_for(mesh.fibre_count(), [&](Index f) {
        for (Index a = 0; a < mesh.own_nodes(f); ++a) {
            const Index position = mesh.node_vector(f, a);
            const Vec3 place = state.segment<3>(3 * position);
            const Index b = own[core::at(position)] >= 0 ? own[core::at(position)] : nearest.find(place);
            if (b < 0) continue;
            const Bond& bond = *of_place[core::at(b)];
            const solid::CellNodes nodes = solid::cell_nodes(solids[core::at(bond.solid)], bond.cell);
            const solid::ShapeGradient gradient =
                solid::shape_derivatives(bond.point) * solid::jacobian(nodes, bond.point).inverse();
            for (Index v = 0; v < B::vectors_per_node; ++v) {
                const Index vector = position + v;
                const scene::VectorKind kind = mesh.layout().kind[core::at(vector)];
                if (kind == scene::VectorKind::rotation) continue;
                Carrier& carrier = carriers[core::at(vector)];
                carrier.cell = first[core::at(bond.solid)] + bond.cell;
                if (kind == scene::VectorKind::position)
                    carrier.weights = bond.weights + gradient * (place - places[core::at(b)]);
                else
                    carrier.weights = gradient * state.segment<3>(3 * vector);
            }
        }
    });
    return carriers;
}

}  // namespace fibrant::connection

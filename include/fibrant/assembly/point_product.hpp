// SPDX-License-Identifier: MIT
#pragma once
/// @file Products with the point terms between elements of chains, element by element.

#include <fibrant/core/parallel.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// Sum of (w w^T) (x) K over pairs of particles of two elements each.
///
/// Both sides of every pair are kept, sorted by element: the motion of its particles is found while an element's vectors
/// are at hand, and so are the forces that they pass on. Every element has its own sums, in a fixed order.
///
/// @tparam Vectors  of an element
/// @tparam Weights  scalars, of all vectors or of each `stride`-th of them, or a particle whose section turns: then (J^T K J)
/// with the
///                  derivatives J of its place
template <int Vectors, class Weights = std::array<double, core::at(Vectors)>>
class PointProduct {
public:
    /// @param elements  number of places that a side may start at, `place` being below it
    /// @param place     place(point, side), side 0 or 1: rises along a chain and from chain to chain
    template <class Point, class Place>
    void pack(const std::vector<Point>& points, Index elements, const Place& place) {
        const Index n = core::count(points);
        std::vector<std::int32_t> next(core::at(elements) + 1, 0);
        for (const Point& point : points) ++next[core::at(place(point, 0)) + 1], ++next[core::at(place(point, 1)) + 1];
        for (std::size_t k = 1; k < next.size(); ++k) next[k] += next[k - 1];
        core::resize_anew(slot_, core::at(2 * n));
        core::resize_anew(sides_, core::at(2 * n));
        core::resize_anew(weights_, core::at(2 * n));
        core::resize_anew(motion_, core::at(2 * n));
        for (Index k = 0; k < n; ++k)
            for (int side = 0; side < 2; ++side)
                slot_[core::at(2 * k + side)] = next[core::at(place(points[core::at(k)], side))]++;
        first_ = std::move(next);
        core::parallel_for((n + 1023) / 1024, [&](Index part) {
            for (Index k = 1024 * part; k < std::min(n, 1024 * (part + 1)); ++k) {
                const Point& point = points[core::at(k)];
                for (int side = 0; side < 2; ++side) {
                    const std::size_t slot = core::at(slot_[core::at(2 * k + side)]);
                    Side& own = sides_[slot];
                    own.first = side == 0 ? point.first_i : point.first_j;
                    own.partner = slot_[core::at(2 * k + 1 - side)];
                    const Mat3& stiffness = point.stiffness;
                    std::copy_n(stiffness.data(), 9, own.stiffness.data());
                    weights_[slot] = side == 0 ? point.weights_i : point.weights_j;
                }
            }
        });
    }

    /// Sides whose place lies in [first, last).
    std::pair<Index, Index> sides(Index first, Index last) const noexcept {
        return {first == 0 ? 0 : first_[core::at(first - 1)], last == 0 ? 0 : first_[core::at(last - 1)]};
    }

    /// Motions of the particles of sides [first, last) in x. To be called for all sides before `add_forces`.
    void find_motions(std::pair<Index, Index> range, const Vector& x) const {
        std::array<Padded, weighted> values;
        for (Index s = range.first; s < range.second;) {
            const std::int32_t start = sides_[core::at(s)].first;
            for (std::size_t a = 0; a < values.size(); ++a) {
                const double* of = x.data() + start + 3 * stride * static_cast<Index>(a);
                values[a] = Padded(of[0], of[1], of[2], 0.0);
            }
            for (; s < range.second && sides_[core::at(s)].first == start; ++s) {
                const Weights& weights = weights_[core::at(s)];
                if constexpr (turning) {
                    Vec3 motion = Vec3::Zero();
                    for (std::size_t a = 0; a < values.size(); ++a)
                        motion += weights.slope(static_cast<Index>(a)) * values[a].template head<3>().matrix();
                    motion_[core::at(s)] = Padded(motion[0], motion[1], motion[2], 0.0);
                } else {
                    Padded even = Padded::Zero(), odd = Padded::Zero();  // two sums, neither of which waits for the other
                    for (std::size_t a = 0; a + 1 < values.size(); a += 2) {
                        even += weights[a] * values[a];
                        odd += weights[a + 1] * values[a + 1];
                    }
                    if constexpr (weighted % 2 == 1) even += weights.back() * values.back();
                    motion_[core::at(s)] = even + odd;
                }
            }
        }
    }

    /// Adds to y the forces on sides [first, last).
    void add_forces(std::pair<Index, Index> range, Vector& y) const {
        std::array<Padded, weighted> forces;
        for (Index s = range.first; s < range.second;) {
            const std::int32_t start = sides_[core::at(s)].first;
            forces.fill(Padded::Zero());
            for (; s < range.second && sides_[core::at(s)].first == start; ++s) {
                const Side& side = sides_[core::at(s)];
                // The other side of a pair may be anywhere.
                core::prefetch(&motion_[core::at(sides_[core::at(std::min(s + 12, range.second - 1))].partner)]);
                const Padded apart = motion_[core::at(s)] - motion_[core::at(side.partner)];
                const double* k = side.stiffness.data();  // columns of three; what the fourth lane holds is not used
                const Padded force = Unaligned(k) * apart[0] + Unaligned(k + 3) * apart[1] + Unaligned(k + 6) * apart[2];
                const Weights& weights = weights_[core::at(s)];
                if constexpr (turning) {
                    const Vec3 plain = force.template head<3>().matrix();
                    for (std::size_t a = 0; a < forces.size(); ++a)
                        forces[a].template head<3>() += (weights.slope(static_cast<Index>(a)).transpose() * plain).array();
                } else {
                    for (std::size_t a = 0; a < forces.size(); ++a) forces[a] += weights[a] * force;
                }
            }
            for (std::size_t a = 0; a < forces.size(); ++a)
                y.segment<3>(start + 3 * stride * static_cast<Index>(a)) += forces[a].template head<3>().matrix();
        }
    }

    /// see(first unknown, weights, stiffness) of each of a range of sides: what its particle has to itself.
    template <class See>
    void add_own(std::pair<Index, Index> range, const See& see) const {
        for (Index s = range.first; s < range.second; ++s) {
            const Mat3 stiffness = Eigen::Map<const Mat3>(sides_[core::at(s)].stiffness.data());
            see(sides_[core::at(s)].first, weights_[core::at(s)], stiffness);
        }
    }

private:
    using Padded = Eigen::Array<double, 4, 1>;
    using Unaligned = Eigen::Map<const Padded>;
    static constexpr bool turning = requires(const Weights& weights) { weights.slope(Index{}); };
    static constexpr Index stride = [] {
        if constexpr (requires { Weights::stride; })
            return Weights::stride;
        else
            return 1;
    }();
    static constexpr std::size_t weighted = core::at(Vectors / stride);  // vectors that count
    struct Side {
        std::int32_t first;                  // unknown of the element
        std::int32_t partner;                // slot of the other side
        std::array<double, 10> stiffness{};  // columns, and a zero to be read with the last
    };
    std::vector<std::int32_t> slot_, first_;  // first_ of a place: the end of its sides
    std::vector<Side> sides_;
    std::vector<Weights> weights_;
    mutable std::vector<Padded> motion_;  // scratch of a product: one system serves one thread at a time
};

}  // namespace fibrant::assembly

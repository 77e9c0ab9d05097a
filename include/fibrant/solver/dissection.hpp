// SPDX-License-Identifier: MIT
#pragma once
/// @file Order of elimination by dissection of a graph whose vertices stand in space.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// Nested dissection: a set of vertices is cut by a plane where the fewest touch the other side, in one of nine
/// directions and within the middle third; both halves come first, those that touch last.
///
/// About (edges) x (logarithm of vertices) x 9 operations.
class Dissection {
public:
    /// @param graph   symmetric pattern
    /// @param places  of the vertices
    Dissection(const SparseMatrix& graph, std::span<const Vec3> places)
        : graph_{&graph}, places_{places}, part_(places.size(), 0), rank_(places.size(), 0) {
        std::vector<int> all(places.size());
        std::iota(all.begin(), all.end(), 0);
        order_.reserve(all.size());
        dissect(all);
    }
    /// Vertices in the order of elimination.
    const std::vector<int>& order() const noexcept { return order_; }

private:
    static constexpr std::size_t smallest = 6;  // sets that are not worth a cut
    struct Cut {
        std::size_t position = 0, touching = 0;
        int direction = -1;
        bool left = true;  // whether those that touch are taken from the left half
    };

    void dissect(std::vector<int>& set) {
        if (set.size() <= smallest) {
            order_.insert(order_.end(), set.begin(), set.end());
            return;
        }
        const int own = ++parts_;
        for (const int v : set) part_[core::at(v)] = own;
        Cut best;
        for (int direction = 0; direction < 9; ++direction) {
            sort_along(direction, set);
            const Cut cut = best_cut(set, own, direction);
            if (best.direction < 0 || cut.touching < best.touching) best = cut;
        }
        sort_along(best.direction, set);
        for (std::size_t k = 0; k < set.size(); ++k) rank_[core::at(set[k])] = static_cast<int>(k);
        std::array<std::vector<int>, 3> parts;  // left, right, separator
        const int cut = static_cast<int>(best.position);
        for (const int v : set) {
            const bool left = rank_[core::at(v)] < cut;
            bool touches = false;
            if (left == best.left) {
                for (SparseMatrix::InnerIterator it(*graph_, v); it && !touches; ++it) {
                    touches = part_[core::at(it.row())] == own && (rank_[core::at(it.row())] < cut) != left;
                }
            }
            parts[touches ? 2 : left ? 0 : 1].push_back(v);
        }
        set = {};
        if (parts[0].empty() || parts[1].empty()) {  // all touch all
            for (const auto& part : parts) order_.insert(order_.end(), part.begin(), part.end());
            return;
        }
        dissect(parts[0]);
        dissect(parts[1]);
        order_.insert(order_.end(), parts[2].begin(), parts[2].end());
    }

    void sort_along(int direction, std::vector<int>& set) {
        static const std::array<Vec3, 9> directions{Vec3(1, 0, 0), Vec3(0, 1, 0),  Vec3(0, 0, 1), Vec3(1, 1, 0), Vec3(1, -1, 0),
                                                    Vec3(1, 0, 1), Vec3(1, 0, -1), Vec3(0, 1, 1), Vec3(0, 1, -1)};
        along_.clear();
        for (const int v : set) along_.emplace_back(directions[core::at(direction)].dot(places_[core::at(v)]), v);
        std::sort(along_.begin(), along_.end());
        for (std::size_t k = 0; k < set.size(); ++k) set[k] = along_[k].second;
    }

    /// Where the fewest of the vertices before a cut have a neighbour after it, or the fewest after it one before.
    Cut best_cut(const std::vector<int>& set, int own, int direction) {
        const std::size_t n = set.size();
        for (std::size_t k = 0; k < n; ++k) rank_[core::at(set[k])] = static_cast<int>(k);
        std::array<std::vector<int>, 2> change{std::vector<int>(n + 1, 0), std::vector<int>(n + 1, 0)};
        for (std::size_t k = 0; k < n; ++k) {
            int first = static_cast<int>(k), last = first;
            for (SparseMatrix::InnerIterator it(*graph_, set[k]); it; ++it) {
                if (part_[core::at(it.row())] != own) continue;
                first = std::min(first, rank_[core::at(it.row())]), last = std::max(last, rank_[core::at(it.row())]);
            }
            ++change[0][k + 1], --change[0][core::at(last) + 1];   // cuts in (k, last]
            ++change[1][core::at(first) + 1], --change[1][k + 1];  // cuts in (first, k]
        }
        Cut best{n / 2, n, direction, true};
        std::array<int, 2> touching{};
        for (std::size_t cut = 0; cut <= n; ++cut) {
            for (std::size_t side = 0; side < 2; ++side) {
                touching[side] += change[side][cut];
                if (3 * cut < n || 3 * cut > 2 * n || cut == 0 || cut == n) continue;
                if (core::at(touching[side]) < best.touching) best = {cut, core::at(touching[side]), direction, side == 0};
            }
        }
        return best;
    }

    const SparseMatrix* graph_;
    std::span<const Vec3> places_;
    std::vector<int> part_, rank_, order_;
    std::vector<std::pair<double, int>> along_;
    int parts_ = 0;
};

}  // namespace fibrant::solver

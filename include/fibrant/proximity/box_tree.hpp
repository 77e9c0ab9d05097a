// SPDX-License-Identifier: MIT
#pragma once
/// @file Boxes under a tree of sixteen children a node, without a pointer in it.

#include <fibrant/proximity/box_columns.hpp>

#include <vector>

namespace fibrant::proximity::detail {

/// The children of node p of a level are boxes 16 p to 16 p + 15 of the level below; level 0 has the given boxes, the leaves.
/// A node keeps the group of its leaves if they have one only, so that a query skips what cannot pair with it.
class BoxTree {
public:
    static constexpr std::int32_t width = BoxColumns::width;
    static constexpr std::int32_t mixed = 2147483647;  ///< group of a box over several groups, no fibre's

    /// Buffers of one thread.
    struct Scratch {
        std::vector<Candidate> nodes, below, leaves;
        std::vector<std::int32_t> number;
        BoxColumns near;
    };

    /// @param leaves  at least one, in an order in which neighbours are close
    void build(const std::vector<Box>& leaves) {
        level_.resize(1);
        fill(level_[0], leaves);
        std::vector<Box> upper = leaves;
        do {
            const std::size_t nodes = (upper.size() + width - 1) / width;
            for (std::size_t p = 0; p < nodes; ++p) {
                Box all = upper[p * width];
                for (std::size_t k = p * width + 1; k < std::min(upper.size(), (p + 1) * width); ++k) add(all, upper[k]);
                upper[p] = all;
            }
            upper.resize(nodes);
            fill(level_.emplace_back(), upper);
        } while (upper.size() > width);
    }

    std::int32_t nodes() const noexcept { return level_[1].size(); }  ///< of the lowest level

    /// Calls visit(k, candidates {k, l}) for each leaf k of a lowest node: the leaves l > k that overlap it, in order.
    template <class Visit>
    void visit_overlaps(std::int32_t node, Scratch& scratch, const Visit& visit) const {
        find_nodes(node, scratch);
        const BoxColumns& leaves = level_[0];
        const std::int32_t near = scratch.near.size();
        for (std::int32_t k = node * width; k < std::min(leaves.size(), (node + 1) * width); ++k) {
            const Box box = query(leaves[k]);
            scratch.nodes.resize(core::at(near + width));
            const Candidate* end = scratch.near.overlaps(box, 0, near, k, scratch.nodes.data());
            scratch.leaves.resize(core::at(width * static_cast<std::int32_t>(end - scratch.nodes.data()) + width));
            Candidate* out = scratch.leaves.data();
            for (const Candidate* hit = scratch.nodes.data(); hit != end; ++hit) {
                const std::int32_t first = scratch.number[core::at(hit->b)] * width;
                out = leaves.overlaps(box, std::max(first, k + 1), std::min(leaves.size(), first + width), k, out);
            }
            visit(k, std::span<const Candidate>(scratch.leaves.data(), out));
        }
    }

    std::size_t bytes() const noexcept {
        std::size_t sum = 0;
        for (const BoxColumns& level : level_) sum += level.bytes();
        return sum;
    }

    static void add(Box& box, const Box& other) noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            box.low[axis] = std::min(box.low[axis], other.low[axis]);
            box.high[axis] = std::max(box.high[axis], other.high[axis]);
        }
        if (box.group != other.group) box.group = mixed;
    }

private:
    /// The lowest nodes from `node` on which overlap it, level by level from the top, which is in order.
    void find_nodes(std::int32_t node, Scratch& scratch) const {
        const Box box = query(level_[1][node]);
        std::size_t level = level_.size() - 1;
        const auto ancestor = [&] { return node >> (4 * (static_cast<int>(level) - 1)); };
        scratch.nodes.resize(core::at(level_[level].size() + width));
        Candidate* end = level_[level].overlaps(box, ancestor(), level_[level].size(), 0, scratch.nodes.data());
        scratch.nodes.resize(core::at(end - scratch.nodes.data()));
        while (level > 1) {
            --level;
            scratch.below.resize(scratch.nodes.size() * width + width);
            end = scratch.below.data();
            for (const Candidate& hit : scratch.nodes)
                end = level_[level].overlaps(box, std::max(hit.b * width, ancestor()),
                                             std::min(level_[level].size(), (hit.b + 1) * width), 0, end);
            scratch.below.resize(core::at(end - scratch.below.data()));
            scratch.nodes.swap(scratch.below);
        }
        scratch.near.resize(static_cast<std::int32_t>(scratch.nodes.size()));
        scratch.number.clear();
        for (const Candidate& hit : scratch.nodes) {
            scratch.near.set(static_cast<std::int32_t>(scratch.number.size()), level_[1][hit.b]);
            scratch.number.push_back(hit.b);
        }
    }

    /// A box that asks: one over several groups pairs with all, itself among them.
    static Box query(Box box) noexcept {
        if (box.group == mixed) box.group = -2147483647 - 1;
        return box;
    }
    static void fill(BoxColumns& columns, const std::vector<Box>& boxes) {
        columns.resize(static_cast<std::int32_t>(boxes.size()));
        for (std::size_t k = 0; k < boxes.size(); ++k) columns.set(static_cast<std::int32_t>(k), boxes[k]);
    }

    std::vector<BoxColumns> level_;
};

}  // namespace fibrant::proximity::detail

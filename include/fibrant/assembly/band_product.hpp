// SPDX-License-Identifier: MIT
#pragma once
/// @file Products with the block bands of many equally long chains at once, one chain a SIMD lane.

#include <fibrant/core/parallel.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// Symmetric block bands of chains of elements, kept once: lower triangles of the diagonal blocks, and the blocks left of
/// them within an element. Chains of equal length share packs, whose entries lie side by side, so that a product is a
/// single pass of whole vectors.
///
/// @tparam Block  unknowns of a node
/// @tparam Reach  nodes of an element less one: node a couples with those before it in the element that it ends or is in
template <int Block, int Reach>
class BandProduct {
public:
    static constexpr int lanes = 8;

    using Row = Eigen::Matrix<double, Block, (Reach + 1) * Block>;  ///< blocks A(a, a - Reach) ... A(a, a)

    /// All zero.
    void arrange(const scene::DofLayout& layout) {
        packs_.clear(), place_.clear();
        for (Index c = 0; c < core::count(layout.chains);) {
            const Index nodes = layout.chains[core::at(c)].nodes;
            Index same = 1;
            while (same < lanes && c + same < core::count(layout.chains) && layout.chains[core::at(c + same)].nodes == nodes)
                ++same;
            const bool wide = same > 2;  // fewer leave most lanes idle
            Pack pack{c, wide ? same : 1, nodes, {}, wide, {}};
            for (Index k = 0; k < lanes; ++k)
                pack.first[core::at(k)] = 3 * layout.chains[core::at(k < pack.chains ? c + k : c)].first_vector;
            const Index entries = start(nodes);
            pack.values.assign(core::at(wide ? entries : (entries + lanes - 1) / lanes), Wide<lanes>::Zero());
            for (Index k = 0; k < pack.chains; ++k) place_.emplace_back(core::count(packs_), k);
            packs_.push_back(std::move(pack));
            c += packs_.back().chains;
        }
    }

    // Of different chains from several threads at once:

    /// Takes over a chain's band. @param rows  of its nodes
    void set(Index chain, const std::vector<Row>& rows) {
        const auto [pack, lane] = place_[core::at(chain)];
        if (packs_[core::at(pack)].wide) {
            copy<lanes>(packs_[core::at(pack)], lane, rows);
        } else {
            copy<1>(packs_[core::at(pack)], lane, rows);
        }
    }
    /// Adds to an entry of a node's row; above the diagonal, or to the left of its element, nothing.
    void add(Index chain, Index a, Index i, Index column, double value) {
        const Index d = Reach - column / Block, j = column % Block;
        if (d > before(a) || (d == 0 && j > i)) return;
        const auto [pack, lane] = place_[core::at(chain)];
        Pack& of = packs_[core::at(pack)];
        const Index entry = start(a) + (d == 0 ? i * (i + 1) / 2 + j : triangle + ((d - 1) * Block + j) * Block + i);
        of.values.front().data()[lane + of.stride() * entry] += value;
    }
    /// Calls see(i, j, d, value) with the entries (i, j) of A(a, a - d), in an order for blocks of columns; of d = 0 both halves.
    template <class See>
    void each(Index chain, Index a, const See& see) const {
        const auto [pack, lane] = place_[core::at(chain)];
        const Pack& of = packs_[core::at(pack)];
        const Index stride = of.stride();
        const double* from = of.values.front().data() + lane + stride * start(a);
        for (Index i = 0; i < Block; ++i)
            for (Index j = 0; j <= i; ++j, from += stride) {
                see(i, j, Index{0}, *from);
                if (j < i) see(j, i, Index{0}, *from);
            }
        for (Index d = 1; d <= before(a); ++d)
            for (Index j = 0; j < Block; ++j)
                for (Index i = 0; i < Block; ++i, from += stride) see(i, j, d, *from);
    }
    Index nodes(Index chain) const noexcept { return packs_[core::at(place_[core::at(chain)].first)].nodes; }

    Index packs() const noexcept { return core::count(packs_); }
    /// Chains of a pack: [first, last).
    std::pair<Index, Index> chains(Index p) const noexcept {
        return {packs_[core::at(p)].first_chain, packs_[core::at(p)].first_chain + packs_[core::at(p)].chains};
    }

    /// y = A x on the chains of pack p.
    void apply(Index p, const Vector& x, Vector& y) const {
        const Pack& pack = packs_[core::at(p)];
        if (pack.wide) {
            multiply<lanes>(pack, x, y);
        } else {
            multiply<1>(pack, x, y);
        }
    }

private:
    template <int Lanes>
    using Wide = Eigen::Array<double, Lanes, 1>;
    struct Pack {
        Index first_chain, chains, nodes;
        std::array<Index, core::at(lanes)> first;  // unknown of each chain; those that are not there repeat the first
        bool wide;
        std::vector<Wide<lanes>> values;  // node by node; a pack that is not wide keeps plain numbers in them
        Index stride() const noexcept { return wide ? lanes : 1; }
    };

    static constexpr Index before(Index a) noexcept { return a == 0 ? 0 : (a - 1) % Reach + 1; }
    static constexpr Index triangle = Block * (Block + 1) / 2;

    /// Entries of all nodes before node a.
    static constexpr Index start(Index a) noexcept {
        const Index elements = a < 1 ? 0 : (a - 1) / Reach, rest = a < 1 ? 0 : (a - 1) % Reach;
        return triangle * a + Block * Block * (elements * (Reach * (Reach + 1) / 2) + rest * (rest + 1) / 2);
    }
    template <int Lanes>
    static void copy(Pack& pack, Index lane, const std::vector<Row>& rows) {
        double* to = pack.values.front().data() + lane;
        for (Index a = 0; a < pack.nodes; ++a) {
            const Row& r = rows[core::at(a)];
            for (Index i = 0; i < Block; ++i)
                for (Index j = 0; j <= i; ++j, to += Lanes) *to = r(i, Reach * Block + j);
            for (Index d = 1; d <= before(a); ++d)
                for (Index j = 0; j < Block; ++j)
                    for (Index i = 0; i < Block; ++i, to += Lanes) *to = r(i, (Reach - d) * Block + j);
        }
    }

    template <int Lanes>
    static void multiply(const Pack& pack, const Vector& x, Vector& y) {
        const Index size = pack.nodes * Block;
        std::vector<Wide<Lanes>> both(core::at(2 * size));
        Wide<Lanes>* in = both.data();
        Wide<Lanes>* out = in + size;
        for (int lane = 0; lane < Lanes; ++lane) {
            const double* from = x.data() + pack.first[core::at(lane)];
            for (Index k = 0; k < size; ++k) in[k][lane] = from[k];
        }
        const Wide<Lanes>* value = reinterpret_cast<const Wide<Lanes>*>(pack.values.data());
        for (Index a = 0; a < pack.nodes; ++a) {
            std::array<Wide<Lanes>, core::at(Block)> own, sum;
            for (std::size_t i = 0; i < core::at(Block); ++i) own[i] = in[a * Block + static_cast<Index>(i)];
            for (std::size_t i = 0; i < core::at(Block); ++i) {
                Wide<Lanes> total = Wide<Lanes>::Zero();
                for (std::size_t j = 0; j < i; ++j, ++value) {
                    total += *value * own[j];
                    sum[j] += *value * own[i];
                }
                sum[i] = total + *value++ * own[i];
            }
            for (Index d = 1; d <= before(a); ++d) {
                const Wide<Lanes>* there = in + (a - d) * Block;
                Wide<Lanes>* back = out + (a - d) * Block;
                for (Index j = 0; j < Block; ++j, value += Block) {
                    const Wide<Lanes> column = there[j];
                    Wide<Lanes> total = back[j];
                    for (std::size_t i = 0; i < core::at(Block); ++i) {
                        sum[i] += value[i] * column;
                        total += value[i] * own[i];
                    }
                    back[j] = total;
                }
            }
            for (std::size_t i = 0; i < core::at(Block); ++i) out[a * Block + static_cast<Index>(i)] = sum[i];
        }
        for (int lane = 0; lane < static_cast<int>(pack.chains); ++lane) {
            double* to = y.data() + pack.first[core::at(lane)];
            for (Index k = 0; k < size; ++k) to[k] = out[k][lane];
        }
    }

    std::vector<Pack> packs_;
    std::vector<std::pair<Index, Index>> place_;  // of each chain: pack and lane
};

}  // namespace fibrant::assembly

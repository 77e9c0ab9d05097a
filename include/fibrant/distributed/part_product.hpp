// SPDX-License-Identifier: MIT
#pragma once
/// @file Rows of A that the parts of a rank own, from the bands of chains and the terms between them.

#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <fibrant/core/parallel.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// y = A x in the rows of own parts, of an x that lies within the free directions of held vectors and is known wherever these
/// rows ask for it. A term that parts share is computed by each of them: nothing is to be added up between ranks.
class PartProduct {
public:
    /// Consecutive nodes that a part owns.
    struct Run {
        Index chain, first_node, last_node;
    };

    PartProduct() = default;
    PartProduct(const scene::DofLayout& layout, const Subdomains& cut, Index first_part, Index last_part)
        : first_part_{first_part}, runs_(core::at(last_part - first_part)) {
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            const auto owner = [&](Index node) {
                return cut.owner()[core::at(chain.first_vector + node * chain.vectors_per_node)];
            };
            for (Index a = 0; a < chain.nodes;) {
                Index last = a;
                while (last + 1 < chain.nodes && owner(last + 1) == owner(a)) ++last;
                if (owner(a) >= first_part && owner(a) < last_part)
                    runs_[core::at(owner(a) - first_part)].push_back({c, a, last});
                a = last + 1;
            }
        }
    }
    Index parts() const noexcept { return core::count(runs_); }
    /// Of the values taken last.
    const scene::DofLayout& layout() const noexcept { return *layout_; }
    const std::vector<Run>& runs(Index part) const noexcept { return runs_[core::at(part)]; }

    /// @param bands  of the chains that own parts have nodes of
    /// @param terms  those that have a vector that an own part owns, at least
    void take(const scene::DofLayout& layout, const Subdomains& cut, const std::vector<Matrix>& bands, const PairTerms& terms) {
        layout_ = &layout, bands_ = &bands, terms_ = &terms, owner_ = &cut.owner();
        sides_.assign(runs_.size(), {});
        for (Index k = 0; k < terms.size(); ++k)
            for (std::size_t side = 0; side < 2; ++side) {
                int before = -1;
                for (const std::int32_t v : terms[k].side(side)) {
                    const int part = cut.owner()[core::at(v)];
                    if (part == before) continue;
                    before = part;
                    if (part >= first_part_ && part < first_part_ + parts()) {
                        auto& own = sides_[core::at(part - first_part_)];
                        if (own.empty() || own.back() != std::pair(k, side)) own.emplace_back(k, side);
                    }
                }
            }
        wholes_.assign(runs_.size(), {});
        for (Index k = 0; k < core::count(terms.wholes()); ++k)
            for (const Index v : terms.wholes()[core::at(k)].vectors) {
                const Index part = cut.owner()[core::at(v)] - first_part_;
                if (part >= 0 && part < parts() && (wholes_[core::at(part)].empty() || wholes_[core::at(part)].back() != k))
                    wholes_[core::at(part)].push_back(k);
            }
        supports_.assign(runs_.size(), {});
        for (const scene::Tie& tie : layout.ties)
            for (const Index v : tie.vectors) {
                const double length = layout.length[core::at(v)];
                const Index part = cut.owner()[core::at(v)] - first_part_;
                if (part >= 0 && part < parts()) supports_[core::at(part)].emplace_back(v, tie.support * length * length);
            }
        held_.assign(runs_.size(), {});
        for (Index h = 0; h < core::count(layout.held); ++h) {
            const Index part = cut.owner()[core::at(layout.held[core::at(h)].vector)] - first_part_;
            if (part >= 0 && part < parts()) held_[core::at(part)].push_back(h);
        }
    }
    void apply(const Vector& x, Vector& y) const {
        core::parallel_for<core::Share::turns>(parts(), [&](Index part) {
            for (const Run& run : runs(part)) {
                if (layout_->chains[core::at(run.chain)].vectors_per_node == 3)
                    add_band<9>(run, x, y);
                else
                    add_band<Eigen::Dynamic>(run, x, y);
            }
            const int own = static_cast<int>(first_part_ + part);
            for (const auto& [k, side] : sides_[core::at(part)]) {
                const PairTerms::Term term = (*terms_)[k];
                const auto other = term.side(1 - side), mine = term.side(side);
                const auto weights = term.weights_of(1 - side), own_weights = term.weights_of(side);
                Vec3 sum = Vec3::Zero();
                for (std::size_t i = 0; i < other.size(); ++i) sum += weights[i] * x.segment<3>(3 * Index{other[i]});
                const Vec3 force = term.stiffness * sum;
                for (std::size_t i = 0; i < mine.size(); ++i)
                    if ((*owner_)[core::at(mine[i])] == own) y.segment<3>(3 * Index{mine[i]}) += own_weights[i] * force;
            }
            for (const Index k : wholes_[core::at(part)]) add_whole(terms_->wholes()[core::at(k)], own, x, y);
            // What bands have in the place of ties is no part of A.
            for (const auto& [v, support] : supports_[core::at(part)]) y.segment<3>(3 * v) -= support * x.segment<3>(3 * v);
            for (const Index h : held_[core::at(part)]) {
                const scene::HeldVector& held = layout_->held[core::at(h)];
                y.segment<3>(3 * held.vector) = (held.free * y.segment<3>(3 * held.vector)).eval();
            }
        });
    }

private:
    void add_whole(const PairTerms::Whole& term, int own, const Vector& x, Vector& y) const {
        const Index count = core::count(term.vectors);
        for (Index i = 0; i < count; ++i) {
            const Index v = term.vectors[core::at(i)];
            if ((*owner_)[core::at(v)] != own) continue;
            Vec3 force = Vec3::Zero();
            for (Index j = 0; j < count; ++j)
                force += term.stiffness.block<3, 3>(3 * i, 3 * j) * x.segment<3>(3 * term.vectors[core::at(j)]);
            y.segment<3>(3 * v) += force;
        }
    }
    /// @tparam Block  m if known when compiled (a director beam), or Eigen::Dynamic
    template <int Block>
    void add_band(const Run& run, const Vector& x, Vector& y) const {
        using Part = Eigen::Matrix<double, Block, Block>;
        using Values = Eigen::Matrix<double, Block, 1>;
        const scene::Chain& chain = layout_->chains[core::at(run.chain)];
        const Matrix& band = (*bands_)[core::at(run.chain)];
        const Index m = 3 * chain.vectors_per_node;
        const auto part = [&](Index a, Index d) {
            return Eigen::Map<const Part, 0, Eigen::OuterStride<>>(band.data() + a * m + d * m * band.rows(), m, m,
                                                                   Eigen::OuterStride<>(band.rows()));
        };
        const auto values = [&](Index a) { return Eigen::Map<const Values>(x.data() + 3 * chain.first_vector + a * m, m); };
        for (Index a = run.first_node; a <= run.last_node; ++a) {
            Values sum = part(a, 0).lazyProduct(values(a));
            for (Index d = 1; d <= chain.reach; ++d) {
                if (a >= d) sum += part(a, d).lazyProduct(values(a - d));
                if (a + d < chain.nodes) sum += part(a + d, d).transpose().lazyProduct(values(a + d));
            }
            y.segment(3 * chain.first_vector + a * m, m) = sum;
        }
    }

    Index first_part_ = 0;
    std::vector<std::vector<Run>> runs_;                             // of each own part
    std::vector<std::vector<std::pair<Index, std::size_t>>> sides_;  // of each own part: term, side
    std::vector<std::vector<Index>> wholes_, held_;                  // of each own part: numbers in the terms, in the layout
    std::vector<std::vector<std::pair<Index, double>>> supports_;  // of each own part: tied vectors, and what bands hold them by
    const scene::DofLayout* layout_ = nullptr;
    const std::vector<Matrix>* bands_ = nullptr;
    const PairTerms* terms_ = nullptr;
    const std::vector<int>* owner_ = nullptr;
};

}  // namespace fibrant::distributed

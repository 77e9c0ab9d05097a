// SPDX-License-Identifier: MIT
#pragma once
/// @file Ties in a preconditioner of chains: the projector that makes chains meet their ties exactly, linear in the tied vectors.

#include <fibrant/scene/tied_vectors.hpp>
#include <fibrant/solver/chain_clusters.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <Eigen/Cholesky>

#include <algorithm>
#include <numeric>
#include <vector>

namespace fibrant::solver {

/// Pi = I - B^-1 C^T (C B^-1 C^T)^-1 C for the block diagonal B of chains and the rows C of what ties block.
///
/// Pi B^-1 is the inverse of B among the vectors that meet the ties, and Pi M Pi^T passes any other M through them: the chains
/// follow where a tie stops a motion, instead of being cut off at their ends. A chain keeps its answer to each of its tied
/// scalars; scalars of chains that no tie joins are eliminated apart, and the motions of bodies join them by few columns.
class TiedChains {
public:
    bool empty() const noexcept { return groups_.empty(); }

    /// @param inverse  inverse(r, z): z = B^-1 r
    template <class Inverse>
    void prepare(const scene::DofLayout& layout, const Inverse& inverse) {
        groups_.clear();
        if (layout.ties.empty()) return;
        find_scalars(layout);
        find_answers(layout, inverse);
        find_groups();
        for (Group& group : groups_) {
            const Index n = core::count(group.scalars);
            Matrix yield = Matrix::Zero(n, n);
            for (const Index chain : group.chains) add_yield(layout, chain, yield);
            group.factor.compute(0.5 * (yield + yield.transpose()));
            if (group.factor.info() != Eigen::Success || !yield.allFinite()) return groups_.clear();  // as if chains had no ties
        }
        Index columns = 0;
        for (const scene::TiedMotion& motion : layout.motions) columns += motion.modes.cols();
        modes_.setZero(scalars_, columns);
        columns = 0;
        for (const scene::TiedMotion& motion : layout.motions)
            for (Index m = 0; m < motion.modes.cols(); ++m, ++columns)
                for (Index k = 0; k < motion.modes.rows(); ++k) modes_(motion.scalars[core::at(k)], columns) = motion.modes(k, m);
        if (modes_.cols() == 0) return;
        moved_ = modes_;
        for (Index m = 0; m < columns; ++m) solve_groups(moved_.col(m));
        together_.compute(modes_.transpose() * moved_);
        if (together_.info() != Eigen::Success) groups_.clear();
    }

    /// z <- Pi z
    void project(const scene::DofLayout& layout, Vector& z) const {
        Vector scalars = scene::tied_part(layout, z);
        solve(scalars);
        core::parallel_for(
            core::count(chains_),
            [&](Index c) {
                const Chain& chain = chains_[core::at(c)];
                for (std::size_t k = 0; k < chain.scalars.size(); ++k)
                    z.segment(chain.first, chain.answer.rows()) -=
                        scalars[chain.scalars[k]] * chain.answer.col(static_cast<Index>(k));
            },
            grain(layout, core::count(chains_)));
    }
    /// r <- Pi^T r
    void project_forces(const scene::DofLayout& layout, Vector& r) {
        core::parallel_for(
            core::count(chains_),
            [&](Index c) {
                Chain& chain = chains_[core::at(c)];
                chain.share.noalias() = chain.answer.transpose() * r.segment(chain.first, chain.answer.rows());
            },
            grain(layout, core::count(chains_)));
        Vector scalars = Vector::Zero(scalars_);
        for (const Chain& chain : chains_)
            for (std::size_t k = 0; k < chain.scalars.size(); ++k)
                scalars[chain.scalars[k]] += chain.share[static_cast<Index>(k)];
        solve(scalars);
        scene::add_tied(layout, Vector(-scalars), r);
    }

private:
    /// A chain that has tied vectors.
    struct Chain {
        Index first = 0, unknowns = 0;
        std::vector<Index> ties, scalars;  // rising
        Matrix answer;                     // B^-1 C^T, a column a scalar
        Vector share;
    };
    /// Chains that ties join.
    struct Group {
        std::vector<Index> chains, scalars;
        Eigen::LLT<Matrix> factor;
    };

    void find_scalars(const scene::DofLayout& layout) {
        scalars_ = scene::tied_scalars(layout);
        chains_.clear();
        std::vector<Index> chain_of(core::at(layout.vectors()), -1);
        for (const scene::Chain& chain : layout.chains) {
            std::fill_n(chain_of.begin() + chain.first_vector, chain.nodes * chain.vectors_per_node, core::count(chains_));
            chains_.push_back({3 * chain.first_vector, 3 * chain.nodes * chain.vectors_per_node, {}, {}, {}, {}});
        }
        tied_chains_.resize(layout.ties.size());
        for (std::size_t t = 0; t < layout.ties.size(); ++t) {
            std::vector<Index>& tied = tied_chains_[t];
            tied.clear();
            for (const Index vector : layout.ties[t].vectors) tied.push_back(chain_of[core::at(vector)]);
            std::sort(tied.begin(), tied.end());
            tied.erase(std::unique(tied.begin(), tied.end()), tied.end());
            for (const Index c : tied) {
                chains_[core::at(c)].ties.push_back(static_cast<Index>(t));
                for (Index a = 0; a < layout.ties[t].count; ++a) chains_[core::at(c)].scalars.push_back(layout.ties[t].first + a);
            }
        }
        for (Chain& chain : chains_) chain.answer.resize(chain.unknowns, core::count(chain.scalars));
    }

    /// Scalars of one colour share no chain: one solve of all chains answers them all.
    template <class Inverse>
    void find_answers(const scene::DofLayout& layout, const Inverse& inverse) {
        std::vector<std::vector<Index>> free_from(chains_.size());  // colours of each chain that are taken
        std::vector<std::vector<std::pair<Index, Index>>> colours;  // ties and axes
        for (std::size_t t = 0; t < layout.ties.size(); ++t)
            for (Index a = 0; a < layout.ties[t].count; ++a) {
                Index colour = 0;
                const auto taken = [&](Index c) {
                    return std::ranges::find(free_from[core::at(c)], colour) != free_from[core::at(c)].end();
                };
                while (std::ranges::any_of(tied_chains_[t], taken)) ++colour;
                if (colour == core::count(colours)) colours.emplace_back();
                colours[core::at(colour)].emplace_back(static_cast<Index>(t), a);
                for (const Index c : tied_chains_[t]) free_from[core::at(c)].push_back(colour);
            }
        Vector right, answer(layout.unknowns());
        for (const auto& colour : colours) {
            right.setZero(layout.unknowns());
            for (const auto& [t, a] : colour) {
                const scene::Tie& tie = layout.ties[core::at(t)];
                for (std::size_t k = 0; k < tie.vectors.size(); ++k)
                    right.segment<3>(3 * tie.vectors[k]) += tie.weights[k] * tie.axes.col(a);
            }
            inverse(right, answer);
            for (const auto& [t, a] : colour)
                for (const Index c : tied_chains_[core::at(t)]) {
                    Chain& chain = chains_[core::at(c)];
                    const auto place =
                        std::lower_bound(chain.scalars.begin(), chain.scalars.end(), layout.ties[core::at(t)].first + a);
                    chain.answer.col(place - chain.scalars.begin()) = answer.segment(chain.first, chain.unknowns);
                }
        }
    }

    void find_groups() {
        std::vector<Index> parent(chains_.size());
        std::iota(parent.begin(), parent.end(), Index{0});
        const auto root = [&](Index c) { return detail::representative(parent, c); };
        for (const std::vector<Index>& tied : tied_chains_)
            for (const Index c : tied) {
                const Index a = root(tied.front()), b = root(c);
                parent[core::at(std::max(a, b))] = std::min(a, b);
            }
        std::vector<Index> number(chains_.size(), -1);
        place_.assign(core::at(scalars_), -1);
        for (Index c = 0; c < core::count(chains_); ++c) {
            if (chains_[core::at(c)].scalars.empty()) continue;
            Index& group = number[core::at(root(c))];
            if (group < 0) group = core::count(groups_), groups_.emplace_back();
            Group& own = groups_[core::at(group)];
            own.chains.push_back(c);
            for (const Index s : chains_[core::at(c)].scalars)
                if (place_[core::at(s)] < 0) place_[core::at(s)] = core::count(own.scalars), own.scalars.push_back(s);
        }
    }

    /// Adds what the answers of a chain move its own tied vectors by.
    void add_yield(const scene::DofLayout& layout, Index c, Matrix& yield) const {
        const Chain& chain = chains_[core::at(c)];
        const Index last = chain.first + chain.unknowns;
        std::size_t row = 0;
        for (const Index t : chain.ties) {
            const scene::Tie& tie = layout.ties[core::at(t)];
            for (Index a = 0; a < tie.count; ++a, ++row)
                for (std::size_t k = 0; k < tie.vectors.size(); ++k) {
                    const Index at = 3 * tie.vectors[k];
                    if (at < chain.first || at >= last) continue;
                    for (std::size_t column = 0; column < chain.scalars.size(); ++column)
                        yield(place_[core::at(chain.scalars[row])], place_[core::at(chain.scalars[column])]) +=
                            tie.weights[k] *
                            tie.axes.col(a).dot(chain.answer.block<3, 1>(at - chain.first, static_cast<Index>(column)));
                }
        }
    }

    template <class Values>
    void solve_groups(Values&& values) const {
        Vector own;
        for (const Group& group : groups_) {
            own.resize(core::count(group.scalars));
            for (Index k = 0; k < own.size(); ++k) own[k] = values[group.scalars[core::at(k)]];
            group.factor.solveInPlace(own);
            for (Index k = 0; k < own.size(); ++k) values[group.scalars[core::at(k)]] = own[k];
        }
    }
    /// Forces of the ties that bring displacements of the tied scalars to nothing, but for what bodies are free to do.
    void solve(Vector& scalars) const {
        solve_groups(scalars);
        if (modes_.cols() == 0) return;
        const Vector along = together_.solve(modes_.transpose() * scalars);
        scalars.noalias() -= moved_ * along;
    }

    std::vector<Chain> chains_;
    std::vector<Group> groups_;
    std::vector<std::vector<Index>> tied_chains_;  // of each tie
    std::vector<Index> place_;                     // of each scalar in its group
    Matrix modes_, moved_;                         // U, and what the groups make of it
    Eigen::LLT<Matrix> together_;
    Index scalars_ = 0;
};

}  // namespace fibrant::solver

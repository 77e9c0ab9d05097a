// SPDX-License-Identifier: MIT
#pragma once
/// @file Averages of vectors that ranks own: all ranks get what is tied, and do the same with it.

#include <fibrant/distributed/exchange.hpp>
#include <fibrant/distributed/routes.hpp>
#include <fibrant/distributed/subdomains.hpp>
#include <fibrant/scene/tied_vectors.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <vector>

namespace fibrant::distributed {

/// Ties are few vectors, the ends of fibres. Each rank is told the values of all, and takes their means in the order of the ties:
/// the bits do not depend on who owns them.
class SharedTies {
public:
    void analyse(const scene::DofLayout& layout, const Subdomains& cut, const BlockRuns& runs, int ranks) {
        vectors_.assign(core::at(ranks), {});
        for (const scene::Tie& tie : layout.ties)
            for (const Index v : tie.vectors) vectors_[core::at(runs.rank_of(cut.owner()[core::at(v)]))].push_back(v);
        for (std::vector<Index>& own : vectors_) std::sort(own.begin(), own.end());
    }

    /// x <- F x for the projector F of what ties leave free. @param x  known in own vectors, and then in all that are tied
    template <Exchange E>
    void project(const E& exchange, const scene::DofLayout& layout, Vector& x, Traffic& traffic) {
        if (layout.ties.empty()) return;
        tell(exchange, std::array{&x}, traffic);
        scene::project_ties(layout, x);
    }
    /// y <- F (y + S x), S the stiffness of what moves together. @param x  within the free directions, known in own vectors
    template <Exchange E>
    void complete(const E& exchange, const scene::DofLayout& layout, const Vector& x, Vector& y, Traffic& traffic) {
        if (layout.ties.empty()) return;
        if (moved_.size() != x.size()) moved_.setZero(x.size());
        for (const Index v : vectors_[core::at(exchange.rank())]) moved_.segment<3>(3 * v) = x.segment<3>(3 * v);
        tell(exchange, std::array{&moved_, &y}, traffic);
        scene::add_motion_stiffness(layout, moved_, y);
        scene::project_ties(layout, y);
    }

private:
    /// Makes tied vectors known to all ranks.
    template <Exchange E, std::size_t N>
    void tell(const E& exchange, const std::array<Vector*, N>& values, Traffic& traffic) {
        if (exchange.ranks() == 1) return;
        std::vector<Index> counts;
        Index whole = 0;
        for (const std::vector<Index>& own : vectors_) {
            counts.push_back(static_cast<Index>(3 * N) * core::count(own));
            whole += counts.back();
        }
        own_.clear(), all_.resize(core::at(whole));
        for (const Index v : vectors_[core::at(exchange.rank())])
            for (const Vector* of : values) own_.insert(own_.end(), of->data() + 3 * v, of->data() + 3 * v + 3);
        traffic.gatherings += 1, traffic.gathered_bytes += 8 * core::count(own_);
        exchange.gather(own_, counts, all_);
        const double* from = all_.data();
        for (const std::vector<Index>& of_rank : vectors_)
            for (const Index v : of_rank)
                for (Vector* to : values) std::copy_n(from, 3, to->data() + 3 * v), from += 3;
    }

    std::vector<std::vector<Index>> vectors_;  // of each rank, rising
    std::vector<double> own_, all_;
    Vector moved_;  // of x, tied vectors alone
};

}  // namespace fibrant::distributed

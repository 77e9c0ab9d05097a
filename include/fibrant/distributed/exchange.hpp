// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of an exchange between the ranks that share a run, its null model, and sums whose bits no number of ranks
/// changes.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <concepts>
#include <span>
#include <type_traits>
#include <vector>

namespace fibrant::distributed {

/// Who sends how many numbers to whom: partners in rising order, the same in both directions.
struct Partners {
    std::vector<int> ranks;             ///< rising, without the own one
    std::vector<Index> first_sent;      ///< of each partner, and their number
    std::vector<Index> first_received;  ///< of each partner, and their number
    Index sent() const noexcept { return first_sent.empty() ? 0 : first_sent.back(); }
    Index received() const noexcept { return first_received.empty() ? 0 : first_received.back(); }
};

/// Ranks that work on one run, each with a process or a thread of its own. All of them call the same functions in the same order.
///
/// - rank(), ranks(): the own number, in [0, ranks()).
/// - gather(own, counts, all): all = what each rank has, one behind the other; counts of each rank, known to all; own may be the
///   own part of all.
/// - swap(partners, out, in): sends to each partner its part of out, and receives its part of in.
/// What is received has the bits that were sent. Checked by tests/distributed/exchange_contract.hpp.
template <class E>
concept Exchange = core::Policy<E> && std::default_initializable<E> &&
    requires(const E exchange, std::span<const double> own, std::span<const Index> counts, std::span<double> all,
             const Partners& partners) {
    { exchange.rank() } -> std::same_as<int>;
    { exchange.ranks() } -> std::same_as<int>;
    exchange.gather(own, counts, all);
    exchange.swap(partners, own, all);
};

/// The null model: one rank, which has nobody to exchange with.
struct OneRank : core::Inactive {
    using Parameters = core::NoParameters;
    OneRank() = default;
    explicit OneRank(const Parameters&) {}
    static constexpr int rank() noexcept { return 0; }
    static constexpr int ranks() noexcept { return 1; }
    void gather(std::span<const double> own, std::span<const Index>, std::span<double> all) const {
        if (own.data() != all.data()) std::copy(own.begin(), own.end(), all.begin());
    }
    void swap(const Partners&, std::span<const double>, std::span<double>) const noexcept {}
};
static_assert(Exchange<OneRank> && std::is_empty_v<OneRank>);

/// One number of each rank, known to all.
template <Exchange E>
std::vector<double> gather_one(const E& exchange, double own) {
    std::vector<double> all(core::at(exchange.ranks()));
    exchange.gather(std::span(&own, 1), std::vector<Index>(all.size(), 1), all);
    return all;
}

/// Blocks of a sum, dealt to ranks in runs: block k of n is of the rank whose run has it.
class BlockRuns {
public:
    BlockRuns() = default;
    /// @param blocks  >= 0, as nearly as many for each rank as may be
    BlockRuns(Index blocks, int ranks) {
        for (int r = 0; r <= ranks; ++r) first_.push_back(blocks * r / ranks);
        for (int r = 0; r < ranks; ++r) counts_.push_back(first_[core::at(r + 1)] - first_[core::at(r)]);
    }
    Index blocks() const noexcept { return first_.empty() ? 0 : first_.back(); }
    /// First block of a rank; of `ranks` their number.
    Index first(int rank) const noexcept { return first_[core::at(rank)]; }
    const std::vector<Index>& counts() const noexcept { return counts_; }
    int rank_of(Index block) const noexcept {
        return static_cast<int>(std::upper_bound(first_.begin(), first_.end(), block) - first_.begin()) - 1;
    }

private:
    std::vector<Index> first_, counts_;
};

/// Sum of the values of all blocks, gathered and added in the order of the blocks: the same bits on any number of ranks.
/// @param own  of the own blocks
template <Exchange E>
double ordered_sum(const E& exchange, const BlockRuns& runs, std::span<const double> own) {
    std::vector<double> all(core::at(runs.blocks()));
    exchange.gather(own, runs.counts(), all);
    double sum = 0.0;
    for (const double value : all) sum += value;
    return sum;
}

}  // namespace fibrant::distributed

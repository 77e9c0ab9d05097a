// SPDX-License-Identifier: MIT
#pragma once
/// @file What every exchange owes, as a function that all of its ranks call.

#include <fibrant/distributed/exchange.hpp>
#include <fibrant/distributed/routes.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace fibrant::test {

/// A number of a rank that no other rank has, and no two places.
inline double told_by(int rank, Index place) { return 1000.0 * rank + static_cast<double>(place) + 0.1; }

template <distributed::Exchange E>
void check_exchange(const E& exchange) {
    const int rank = exchange.rank(), ranks = exchange.ranks();
    REQUIRE(rank >= 0);
    REQUIRE(rank < ranks);

    // Ranks have 0, 1, 2, ... numbers.
    std::vector<Index> counts;
    std::vector<double> own, expected;
    for (int r = 0; r < ranks; ++r) {
        counts.push_back(r);
        for (Index k = 0; k < r; ++k) expected.push_back(told_by(r, k));
    }
    for (Index k = 0; k < rank; ++k) own.push_back(told_by(rank, k));
    std::vector<double> all(expected.size());
    exchange.gather(own, counts, all);
    CHECK(all == expected);

    // Each sends r + 1 numbers to rank r, the next one twice as many, and keeps what is its own.
    std::vector<distributed::Route> routes;
    std::vector<Index> out(core::at(ranks), 0), in(core::at(ranks), 0);
    for (int turn = 0; turn < 2; ++turn)
        for (int from = 0; from < ranks; ++from)
            for (int to = 0; to < ranks; ++to) {
                if (turn == 1 && to != (from + 1) % ranks) continue;
                const Index count = to + 1;
                routes.push_back({from, to, out[core::at(from)], in[core::at(to)], count});
                out[core::at(from)] += count, in[core::at(to)] += count;
            }
    std::vector<double> mine, got(core::at(in[core::at(rank)]), 0.0);
    for (Index k = 0; k < out[core::at(rank)]; ++k) mine.push_back(told_by(rank, k));
    distributed::Traffic traffic;
    distributed::Routes(rank, routes).move(exchange, mine, got, traffic);
    for (const distributed::Route& route : routes)
        for (Index k = 0; k < route.count && route.to == rank; ++k)
            CHECK(got[core::at(route.in + k)] == told_by(route.from, route.out + k));

    // Sums whose terms cancel: another order would have other bits.
    const distributed::BlockRuns runs(11, ranks);
    const auto term = [](Index block) { return (block % 2 == 0 ? 1e16 : -1e16) + static_cast<double>(block) / 3.0; };
    double in_order = 0.0;
    for (Index block = 0; block < 11; ++block) in_order += term(block);
    std::vector<double> blocks;
    for (Index block = runs.first(rank); block < runs.first(rank + 1); ++block) {
        CHECK(runs.rank_of(block) == rank);
        blocks.push_back(term(block));
    }
    CHECK(distributed::ordered_sum(exchange, runs, blocks) == in_order);
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file A search of one's own: segments sorted along x are compared with those that begin before they end (sweep and prune).

#include <fibrant/proximity/zones.hpp>

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

/// For fibres that follow each other along x. The exact test of a pair and the zones are those of all searches.
class SweepSearch {
public:
    using Parameters = fibrant::core::NoParameters;
    explicit SweepSearch(const Parameters& = {}) {}

    std::vector<fibrant::proximity::SegmentPair> pairs(std::span<const fibrant::proximity::Centreline> fibres,
                                                       double reach) const {
        namespace detail = fibrant::proximity::detail;
        const detail::SegmentTable table(fibres, reach);
        const std::vector<detail::SegmentRecord> records = table.records();
        // Half of the reach on each side: two that are close overlap.
        const auto first = [&](const detail::SegmentRecord& one) {
            return std::min(one.start.x, one.start.x + one.chord.x) - one.half - 0.5 * reach;
        };
        const auto last = [&](const detail::SegmentRecord& one) {
            return std::max(one.start.x, one.start.x + one.chord.x) + one.half + 0.5 * reach;
        };
        std::vector<std::int32_t> order(records.size());
        std::iota(order.begin(), order.end(), 0);
        std::ranges::sort(order, {}, [&](std::int32_t k) { return std::pair{first(records[fibrant::core::at(k)]), k}; });
        std::vector<detail::Candidate> candidates;
        for (std::size_t a = 0; a < order.size(); ++a) {
            const double end = last(records[fibrant::core::at(order[a])]);
            for (std::size_t b = a + 1; b < order.size() && first(records[fibrant::core::at(order[b])]) <= end; ++b)
                candidates.push_back({order[a], order[b]});
        }
        std::vector<fibrant::proximity::SegmentPair> close;
        detail::keep_close(table, records.data(), candidates, close);
        std::ranges::sort(close);
        return close;
    }
    std::vector<fibrant::proximity::ProximityZone> find(std::span<const fibrant::proximity::Centreline> fibres,
                                                        double reach) const {
        return fibrant::proximity::zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }
};
static_assert(fibrant::proximity::ProximitySearch<SweepSearch>);

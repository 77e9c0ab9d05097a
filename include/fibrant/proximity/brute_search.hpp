// SPDX-License-Identifier: MIT
#pragma once
/// @file Every pair of segments, tried: the oracle of the other searches.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {

/// Tries every pair: quadratic in the number of segments, without an idea in it that could be wrong.
class BruteSearch {
public:
    using Parameters = core::NoParameters;
    explicit BruteSearch(const Parameters& = {}) {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) const {
        const detail::SegmentTable table(fibres, reach);
        const std::vector<detail::SegmentRecord> records = table.records();
        std::vector<std::vector<SegmentPair>> close(core::at(table.size()));
        core::parallel_for(table.size(), [&](Index i) {
            const auto a = static_cast<std::int32_t>(i);
            std::vector<detail::Candidate> candidates;
            candidates.reserve(core::at(table.size() - a));
            for (std::int32_t b = a + 1; b < table.size(); ++b) candidates.push_back({a, b});
            detail::keep_close(table, records.data(), candidates, close[core::at(a)]);
        });
        std::vector<SegmentPair> all;
        core::join(close, all);
        return all;
    }

    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) const {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }
};
static_assert(ProximitySearch<BruteSearch>);

}  // namespace fibrant::proximity

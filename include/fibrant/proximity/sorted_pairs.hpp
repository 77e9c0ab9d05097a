// SPDX-License-Identifier: MIT
#pragma once
/// @file Puts the pairs that a search found block by block into their one order.

#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <numeric>

namespace fibrant::proximity::detail {

/// Sorts pairs that were found in blocks, and drops repeats: linear, by counting over i.
/// @param segments  i and j are below it
inline std::vector<SegmentPair> sorted_pairs(const std::vector<std::vector<SegmentPair>>& blocks, std::int32_t segments,
                                             bool repeats) {
    std::vector<std::size_t> place(core::at(segments) + 1, 0);
    for (const auto& block : blocks)
        for (const SegmentPair& pair : block) ++place[core::at(pair.i) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<SegmentPair> sorted(place.back());
    for (const auto& block : blocks)
        for (const SegmentPair& pair : block) sorted[place[core::at(pair.i)]++] = pair;
    std::size_t first = 0;
    for (std::int32_t i = 0; i < segments; ++i) {  // place[i] is now the end of i
        const std::size_t last = place[core::at(i)];
        if (last - first > 32) {
            std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first), sorted.begin() + static_cast<std::ptrdiff_t>(last));
        } else {
            for (std::size_t k = first + 1; k < last; ++k) {
                const SegmentPair pair = sorted[k];
                std::size_t at = k;
                for (; at > first && pair.j < sorted[at - 1].j; --at) sorted[at] = sorted[at - 1];
                sorted[at] = pair;
            }
        }
        first = last;
    }
    if (repeats) sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    return sorted;
}

}  // namespace fibrant::proximity::detail

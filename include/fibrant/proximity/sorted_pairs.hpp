// SPDX-License-Identifier: MIT
#pragma once
/// @file Puts the pairs that a search found block by block into their one order.

#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <utility>

namespace fibrant::proximity::detail {

/// Sorts pairs that were found in blocks, and drops repeats: linear, by counting over i and, where an i has many, over j.
class PairSorter {
public:
    /// @param segments  i and j are below it
    std::vector<SegmentPair> sorted(const std::vector<std::vector<SegmentPair>>& blocks, std::int32_t segments, bool repeats) {
        std::size_t total = 0;
        for (const auto& block : blocks) total += block.size();
        std::vector<SegmentPair> pairs(total);
        count(by_i_, segments);
        for (const auto& block : blocks)
            for (const SegmentPair& pair : block) ++by_i_[core::at(pair.i)];
        if (total > 3 * core::at(segments)) {
            by_both(blocks, segments, pairs);
        } else {
            sum_up(by_i_);
            for (const auto& block : blocks)
                for (const SegmentPair& pair : block) pairs[by_i_[core::at(pair.i)]++] = pair;
            sort_each(pairs);
        }
        if (repeats) pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        return pairs;
    }

    std::size_t bytes() const noexcept { return (by_i_.capacity() + by_j_.capacity()) * sizeof(std::size_t); }

private:
    static void count(std::vector<std::size_t>& places, std::int32_t segments) { places.assign(core::at(segments), 0); }
    static void sum_up(std::vector<std::size_t>& places) {
        std::size_t sum = 0;
        for (std::size_t& place : places) sum += std::exchange(place, sum);
    }

    void by_both(const std::vector<std::vector<SegmentPair>>& blocks, std::int32_t segments, std::vector<SegmentPair>& pairs) {
        count(by_j_, segments);
        for (const auto& block : blocks)
            for (const SegmentPair& pair : block) ++by_j_[core::at(pair.j)];
        sum_up(by_i_);
        sum_up(by_j_);
        spare_.resize(pairs.size());
        for (const auto& block : blocks)
            for (const SegmentPair& pair : block) spare_[by_j_[core::at(pair.j)]++] = pair;
        for (const SegmentPair& pair : spare_) pairs[by_i_[core::at(pair.i)]++] = pair;
    }

    /// Where by_i_ has the end of each i.
    void sort_each(std::vector<SegmentPair>& pairs) const {
        std::size_t first = 0;
        for (const std::size_t last : by_i_) {
            if (last - first > 32) {
                std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.begin() + static_cast<std::ptrdiff_t>(last));
            } else {
                for (std::size_t k = first + 1; k < last; ++k) {
                    const SegmentPair pair = pairs[k];
                    std::size_t at = k;
                    for (; at > first && pair.j < pairs[at - 1].j; --at) pairs[at] = pairs[at - 1];
                    pairs[at] = pair;
                }
            }
            first = last;
        }
    }

    std::vector<std::size_t> by_i_, by_j_;
    std::vector<SegmentPair> spare_;
};

}  // namespace fibrant::proximity::detail

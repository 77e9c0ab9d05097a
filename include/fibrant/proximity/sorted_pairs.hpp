// SPDX-License-Identifier: MIT
#pragma once
/// @file Puts the pairs that a search found block by block into their one order.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <span>
#include <utility>

namespace fibrant::proximity::detail {

/// Sorts pairs that were found in blocks, and drops repeats: linear, by pages of segments that fit into a cache, each of which
/// one thread sorts.
class PairSorter {
public:
    /// @param segments  i and j are below it
    std::vector<SegmentPair> sorted(const std::vector<std::vector<SegmentPair>>& blocks, std::int32_t segments, bool repeats) {
        std::size_t total = 0;
        for (const auto& block : blocks) total += block.size();
        std::vector<SegmentPair> pairs(total);
        if (total == 0) return pairs;
        // Pages are a power of two of segments, so that the page of one is a shift.
        const std::size_t wanted = std::clamp<std::size_t>(total / page_pairs, 1, most_pages);
        shift_ = static_cast<int>(std::bit_width((core::at(segments) - 1) / wanted));
        const std::size_t pages = (core::at(segments - 1) >> shift_) + 1;
        distribute(blocks, pages, pairs);
        core::parallel_for<core::Share::turns>(static_cast<Index>(pages), [&](Index p) {
            Scratch scratch;
            const std::span<SegmentPair> page(pairs.data() + first_[core::at(p)], first_[core::at(p) + 1] - first_[core::at(p)]);
            sort_page(page, static_cast<std::int32_t>(p << shift_), segments, scratch);
        });
        if (repeats) pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        return pairs;
    }

    std::size_t bytes() const noexcept { return (first_.capacity() + place_.capacity()) * sizeof(std::size_t); }

private:
    static constexpr std::size_t page_pairs = 2048, most_pages = 4096;  // 16 kB of pairs, half of the smallest cache there is
    static constexpr std::size_t few = 4;                               // pairs a segment up to which insertion beats counting
    static constexpr int digit = 10;                                    // bits of j counted at once

    struct Scratch {
        std::vector<SegmentPair> pairs;
        std::vector<std::uint32_t> place;
    };

    /// Pairs to their pages, as many runs of blocks at once as there are threads; what comes out is sorted whatever their number.
    void distribute(const std::vector<std::vector<SegmentPair>>& blocks, std::size_t pages, std::vector<SegmentPair>& pairs) {
        const std::size_t runs = std::min(blocks.size(), core::at(core::threads()));
        const auto run = [&](Index r, const auto& body) {
            for (std::size_t b = core::at(r) * blocks.size() / runs; b < (core::at(r) + 1) * blocks.size() / runs; ++b)
                for (const SegmentPair& pair : blocks[b]) body(pair);
        };
        place_.assign(runs * pages, 0);
        core::parallel_for(static_cast<Index>(runs), [&](Index r) {
            std::size_t* own = place_.data() + core::at(r) * pages;
            run(r, [&](const SegmentPair& pair) { ++own[pair.i >> shift_]; });
        });
        first_.resize(pages + 1);
        std::size_t sum = 0;
        for (std::size_t p = 0; p < pages; ++p) {
            first_[p] = sum;
            for (std::size_t r = 0; r < runs; ++r) sum += std::exchange(place_[r * pages + p], sum);
        }
        first_[pages] = sum;
        core::parallel_for(static_cast<Index>(runs), [&](Index r) {
            std::size_t* own = place_.data() + core::at(r) * pages;
            run(r, [&](const SegmentPair& pair) { pairs[own[pair.i >> shift_]++] = pair; });
        });
    }

    void sort_page(std::span<SegmentPair> page, std::int32_t first, std::int32_t segments, Scratch& scratch) const {
        if (page.size() < 2) return;
        scratch.pairs.resize(page.size());
        std::span<SegmentPair> from = page, to = scratch.pairs;
        const auto counted = [&](std::size_t keys, const auto& key) {
            scratch.place.assign(keys, 0);
            for (const SegmentPair& pair : from) ++scratch.place[core::at(key(pair))];
            std::uint32_t sum = 0;
            for (std::uint32_t& place : scratch.place) sum += std::exchange(place, sum);
            for (const SegmentPair& pair : from) to[scratch.place[core::at(key(pair))]++] = pair;
            std::swap(from, to);
        };
        const std::size_t own = std::min(std::size_t{1} << shift_, core::at(segments - first));
        const bool crowded = page.size() > few * own;
        if (crowded)  // by j, digit by digit
            for (int low = 0; low < 31 && (segments - 1) >> low != 0; low += digit)
                counted(std::size_t{1} << digit, [low](const SegmentPair& pair) { return pair.j >> low & ((1 << digit) - 1); });
        counted(own, [first](const SegmentPair& pair) { return pair.i - first; });
        if (!crowded)
            for (std::size_t begin = 0, place = 0; place < own; begin = scratch.place[place++])
                sort_some(from.subspan(begin, scratch.place[place] - begin));
        if (from.data() != page.data()) std::copy(from.begin(), from.end(), page.begin());
    }

    /// Pairs of one i by j.
    static void sort_some(std::span<SegmentPair> pairs) {
        if (pairs.size() > 32) return std::sort(pairs.begin(), pairs.end());
        for (std::size_t k = 1; k < pairs.size(); ++k) {
            const SegmentPair pair = pairs[k];
            std::size_t at = k;
            for (; at > 0 && pair.j < pairs[at - 1].j; --at) pairs[at] = pairs[at - 1];
            pairs[at] = pair;
        }
    }

    int shift_ = 0;
    std::vector<std::size_t> first_, place_;  // of the pages, and of each run in them
};

}  // namespace fibrant::proximity::detail

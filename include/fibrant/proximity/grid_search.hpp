// SPDX-License-Identifier: MIT
#pragma once
/// @file The default search: boxes of segments in a uniform grid, and the exact filter on those that overlap.

#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {
namespace detail {

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
        std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(first), sorted.begin() + static_cast<std::ptrdiff_t>(last));
        first = last;
    }
    if (repeats) sorted.erase(std::unique(sorted.begin(), sorted.end()), sorted.end());
    return sorted;
}

}  // namespace detail

/// Sort-based uniform grid, linear in segments and close pairs for any mixture of lengths and radii.
///
/// The box of a segment is widened by half its threshold. Segments much longer than the others, or than their thickness,
/// are cut into pieces; boxes much larger than the others (thick fibres) stand in coarser grids. All that is taken from the data
/// at each call. Result and order do not depend on the number of threads.
class GridSearch {
public:
    using Parameters = core::NoParameters;
    explicit GridSearch(const Parameters& = {}) {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) {
        const detail::SegmentTable table(fibres, reach);
        if (table.size() == 0) return {};
        make_boxes(table);
        sort_into_levels();
        const std::size_t found = search(table);
        for (std::size_t b = found; b < close_.size(); ++b) close_[b].clear();
        return detail::sorted_pairs(close_, table.size(), cut_);
    }

    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }

private:
    static constexpr Index block = 4096;

    /// Cuts segments into pieces and makes the boxes of these.
    void make_boxes(const detail::SegmentTable& table) {
        const detail::BoxFrame frame(table);
        const std::int32_t n = table.size();
        // Mean length and thickness decide how long a piece may be.
        const Vec3 sums = core::ordered_sum(Index{n}, Vec3(Vec3::Zero()), [&](Index first, Index last) {
            Vec3 sum = Vec3::Zero();
            for (Index k = first; k < last; ++k) {
                const detail::SegmentRecord record = table.record(static_cast<std::int32_t>(k));
                sum += Vec3(std::sqrt(detail::dot(record.chord, record.chord)), 2.0 * record.half + table.reach(), 0.0);
            }
            return sum;
        });
        const double mean = sums[0] / n, thickness = sums[1] / n;
        const double piece = mean > pieces_from * thickness ? piece_length * thickness : 4.0 * std::max(mean, thickness);
        first_.resize(core::at(n) + 1);
        first_[0] = 0;
        cut_ = false;
        for (std::int32_t k = 0; k < n; ++k) {
            const detail::SegmentRecord record = table.record(k);
            const double pieces = std::ceil(std::sqrt(detail::dot(record.chord, record.chord)) / piece);
            first_[core::at(k) + 1] = first_[core::at(k)] + std::max(1, static_cast<std::int32_t>(pieces));
            cut_ = cut_ || pieces > 1.0;
        }
        boxes_.resize(core::at(first_.back()));
        owner_.resize(cut_ ? boxes_.size() : 0);
        core::parallel_for((n + block - 1) / block, [&](Index b) {
            for (auto k = static_cast<std::int32_t>(b * block); k < std::min<Index>(n, (b + 1) * block); ++k) {
                const detail::SegmentRecord record = table.record(k);
                const std::int32_t begin = first_[core::at(k)], end = first_[core::at(k) + 1];
                const double margin = record.half + 0.5 * table.reach();
                for (std::int32_t p = begin; p < end; ++p) {
                    const double per = 1.0 / (end - begin);
                    boxes_[core::at(p)] = frame.box(record, (p - begin) * per, (p - begin + 1) * per, margin);
                    if (cut_) owner_[core::at(p)] = k;
                }
            }
        });
    }

    /// One grid for boxes within a factor of about 4 in size.
    void sort_into_levels() {
        std::array<std::int32_t, 256> bin{};  // by the binary exponent of the largest side
        const auto size_of = [](const detail::Box& box) {
            const float side = std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
            int exponent = 0;
            static_cast<void>(std::frexp(side, &exponent));
            return core::at(std::clamp(exponent + 128, 0, 255));
        };
        for (const detail::Box& box : boxes_) ++bin[size_of(box)];
        std::array<int, 256> level{};
        int levels = 0;
        for (std::size_t e = 0; e < 256;) {
            if (bin[e] == 0) {
                ++e;
                continue;
            }
            std::int32_t here = 0, above = 0;
            const std::size_t end = std::min<std::size_t>(256, e + 3);
            for (std::size_t k = e; k < 256; ++k) (k < end ? here : above) += bin[k];
            if (above > 0 && here < above / 64) {  // few small ones do no harm in larger cells
                std::size_t next = end;
                while (bin[next] == 0) ++next;
                for (std::size_t k = e; k < next; ++k) level[k] = levels;
                bin[next] += here;
                e = next;
                continue;
            }
            for (std::size_t k = e; k < end; ++k) level[k] = levels;
            ++levels;
            e = end;
        }
        std::vector<std::vector<std::int32_t>> members(core::at(levels));
        for (std::size_t k = 0; k < boxes_.size(); ++k)
            members[core::at(level[size_of(boxes_[k])])].push_back(static_cast<std::int32_t>(k));
        levels_.resize(core::at(levels));
        for (std::size_t k = 0; k < levels_.size(); ++k) levels_[k].build(boxes_, members[k]);
    }

    /// Fills the first blocks of `close_`, in an order that the data alone gives; returns how many.
    std::size_t search(const detail::SegmentTable& table) {
        std::size_t done = 0;
        for (const detail::CellGrid& grid : levels_) {
            // Records in the order of the cells, unless several boxes share a segment.
            records_.resize(core::at(cut_ ? table.size() : grid.size()));
            for (std::size_t k = 0; k < records_.size(); ++k)
                records_[k] = table.record(cut_ ? static_cast<std::int32_t>(k) : grid.box(static_cast<std::int32_t>(k)));
            const Index blocks = (grid.cells() + cells_together - 1) / cells_together;
            if (close_.size() < done + core::at(blocks)) close_.resize(done + core::at(blocks));
            core::parallel_for(blocks, [&](Index b) {
                auto& close = close_[done + core::at(b)];
                close.clear();
                std::vector<detail::Candidate> candidates;
                candidates.reserve(batch);
                const auto first = static_cast<std::int32_t>(b * cells_together);
                const std::int32_t last = std::min(grid.cells(), first + static_cast<std::int32_t>(cells_together));
                grid.overlaps_inside(first, last, [&](std::int32_t k, std::int32_t l) {
                    if (cut_) {
                        k = owner_[core::at(grid.box(k))];
                        l = owner_[core::at(grid.box(l))];
                        if (k == l) return;
                    }
                    if (candidates.size() == batch) {
                        detail::keep_close(table, records_.data(), candidates, close);
                        candidates.clear();
                    }
                    candidates.push_back({k, l});
                });
                detail::keep_close(table, records_.data(), candidates, close);
            });
            done += core::at(blocks);
        }
        for (std::size_t upper = 1; upper < levels_.size(); ++upper) done = search_below(table, upper, done);
        return done;
    }

    /// Boxes of a level against those of all finer ones.
    std::size_t search_below(const detail::SegmentTable& table, std::size_t upper, std::size_t done) {
        constexpr Index together = 256;
        const detail::CellGrid& grid = levels_[upper];
        const Index blocks = (grid.size() + together - 1) / together;
        if (close_.size() < done + core::at(blocks)) close_.resize(done + core::at(blocks));
        records_ = table.records();
        core::parallel_for(blocks, [&](Index b) {
            auto& close = close_[done + core::at(b)];
            close.clear();
            std::vector<detail::Candidate> candidates;
            for (auto k = static_cast<std::int32_t>(b * together); k < std::min<Index>(grid.size(), (b + 1) * together); ++k) {
                const std::int32_t large = grid.box(k);
                const std::int32_t i = cut_ ? owner_[core::at(large)] : large;
                for (std::size_t lower = 0; lower < upper; ++lower)
                    levels_[lower].overlaps_with(boxes_[core::at(large)], [&](std::int32_t l) {
                        const std::int32_t small = levels_[lower].box(l);
                        const std::int32_t j = cut_ ? owner_[core::at(small)] : small;
                        if (i != j) candidates.push_back({i, j});
                    });
                detail::keep_close(table, records_.data(), candidates, close);
                candidates.clear();
            }
        });
        return done + core::at(blocks);
    }

    static constexpr Index cells_together = 256;
    static constexpr std::size_t batch = 4096;
    static constexpr double pieces_from = 32.0, piece_length = 16.0;

    bool cut_ = false;                  // some segment has several boxes
    std::vector<std::int32_t> first_;   // first box of each segment
    std::vector<std::int32_t> owner_;   // segment of each box, where cut
    std::vector<detail::Box> boxes_;
    std::vector<detail::CellGrid> levels_;
    std::vector<detail::SegmentRecord> records_;
    std::vector<std::vector<SegmentPair>> close_;
};
static_assert(ProximitySearch<GridSearch>);

}  // namespace fibrant::proximity

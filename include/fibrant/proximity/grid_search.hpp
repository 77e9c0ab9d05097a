// SPDX-License-Identifier: MIT
#pragma once
/// @file The default search: boxes of segments in a uniform grid, and the exact filter on those that overlap.

#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/sorted_pairs.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {
namespace detail {

/// Collects candidates and filters them by the thousand.
class CandidateSink {
public:
    /// @param records       of segments
    /// @param map_a, map_b  places of the first and second of a candidate to places of records; null where they are these
    CandidateSink(const SegmentTable& table, const SegmentRecord* records, const std::int32_t* map_a,
                  const std::int32_t* map_b, std::vector<SegmentPair>& close)
        : table_(table), records_(records), map_a_(map_a), map_b_(map_b), close_(close), batch_(least) {}

    Candidate* room(std::int32_t n) {
        if (filled_ + core::at(n) > batch_.size()) {
            flush();
            if (core::at(n) > batch_.size()) batch_.resize(core::at(n));
        }
        return batch_.data() + filled_;
    }
    void take(const Candidate* end) noexcept { filled_ = core::at(end - batch_.data()); }
    void flush() {
        if (map_a_ != nullptr) {
            std::size_t kept = 0;
            for (std::size_t k = 0; k < filled_; ++k) {
                const Candidate mapped{map_a_[batch_[k].a], map_b_[batch_[k].b]};
                batch_[kept] = mapped;
                kept += mapped.a != mapped.b ? 1 : 0;
            }
            filled_ = kept;
        }
        keep_close(table_, records_, {batch_.data(), filled_}, close_);
        filled_ = 0;
    }

private:
    static constexpr std::size_t least = 4096;
    const SegmentTable& table_;
    const SegmentRecord* records_;
    const std::int32_t *map_a_, *map_b_;
    std::vector<SegmentPair>& close_;
    std::vector<Candidate> batch_;
    std::size_t filled_ = 0;
};

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
        for (auto& some : close_) some.clear();
        make_boxes(table);
        sort_into_levels();
        search(table);
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
        const double mean = frame.mean_length, thickness = frame.mean_thickness;
        const double piece = mean > pieces_from * thickness ? piece_length * thickness : 2.0 * std::max(mean, thickness);
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
        in_blocks(n, block, [&](Index, std::int32_t k) {
            const detail::SegmentRecord record = table.record(k);
            const std::int32_t begin = first_[core::at(k)], end = first_[core::at(k) + 1];
            const double margin = record.half + 0.5 * table.reach(), per = 1.0 / (end - begin);
            for (std::int32_t p = begin; p < end; ++p) {
                boxes_[core::at(p)] = frame.box(record, (p - begin) * per, (p - begin + 1) * per, margin);
                if (cut_) owner_[core::at(p)] = k;
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
        // One level of whole segments: records in the order of the cells. Else records by segment, and places mapped to them.
        const bool mapped = cut_ || levels_.size() > 1;
        records_.resize(core::at(table.size()));
        if (mapped) place_owner_.resize(levels_.size());
        for (std::size_t level = 0; level < levels_.size() && mapped; ++level) {
            place_owner_[level].resize(core::at(levels_[level].size()));
            for (std::int32_t k = 0; k < levels_[level].size(); ++k) {
                const std::int32_t box = levels_[level].box(k);
                place_owner_[level][core::at(k)] = cut_ ? owner_[core::at(box)] : box;
            }
        }
        in_blocks(table.size(), block, [&](Index, std::int32_t k) {
            records_[core::at(k)] = table.record(mapped ? k : levels_[0].box(k));
        });
        std::size_t done = 0;
        for (std::size_t level = 0; level < levels_.size(); ++level) {
            const detail::CellGrid& grid = levels_[level];
            const std::int32_t* map = mapped ? place_owner_[level].data() : nullptr;
            const Index blocks = (grid.cells() + cells_together - 1) / cells_together;
            reserve_blocks(done + core::at(blocks));
            core::parallel_for(blocks, [&](Index b) {
                detail::CandidateSink sink(table, records_.data(), map, map, close_[done + core::at(b)]);
                const auto first = static_cast<std::int32_t>(b * cells_together);
                grid.overlaps_inside(first, std::min(grid.cells(), first + cells_together), sink);
                sink.flush();
            });
            done += core::at(blocks);
            for (std::size_t lower = 0; lower < level; ++lower) done = search_between(table, level, lower, done);
        }
        return done;
    }

    /// Boxes of a level against those of a finer one.
    std::size_t search_between(const detail::SegmentTable& table, std::size_t upper, std::size_t lower, std::size_t done) {
        constexpr Index together = 256;
        const detail::CellGrid& grid = levels_[upper];
        const Index blocks = (grid.size() + together - 1) / together;
        reserve_blocks(done + core::at(blocks));
        core::parallel_for(blocks, [&](Index b) {
            detail::CandidateSink sink(table, records_.data(), place_owner_[upper].data(), place_owner_[lower].data(),
                                       close_[done + core::at(b)]);
            for (auto k = static_cast<std::int32_t>(b * together); k < std::min<Index>(grid.size(), (b + 1) * together); ++k)
                levels_[lower].overlaps_with(boxes_[core::at(grid.box(k))], k, sink);
            sink.flush();
        });
        return done + core::at(blocks);
    }

    void reserve_blocks(std::size_t n) {
        if (close_.size() < n) close_.resize(n);
    }
    template <class Body>
    static void in_blocks(std::int32_t n, Index length, const Body& body) {
        core::parallel_for((n + length - 1) / length, [&](Index b) {
            for (auto k = static_cast<std::int32_t>(b * length); k < std::min<Index>(n, (b + 1) * length); ++k) body(b, k);
        });
    }

    static constexpr std::int32_t cells_together = 256;
    static constexpr double pieces_from = 32.0, piece_length = 24.0;

    bool cut_ = false;                  // some segment has several boxes
    std::vector<std::int32_t> first_;   // first box of each segment
    std::vector<std::int32_t> owner_;   // segment of each box, where cut
    std::vector<detail::Box> boxes_;
    std::vector<detail::CellGrid> levels_;
    std::vector<std::vector<std::int32_t>> place_owner_;  // of each level: segment at each place
    std::vector<detail::SegmentRecord> records_;
    std::vector<std::vector<SegmentPair>> close_;
};
static_assert(ProximitySearch<GridSearch>);

}  // namespace fibrant::proximity

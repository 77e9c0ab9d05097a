// SPDX-License-Identifier: MIT
#pragma once
/// @file The default search: boxes of segments in a uniform grid, and the exact filter on those that overlap.

#include <fibrant/proximity/candidate_sink.hpp>
#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/sorted_pairs.hpp>
#include <fibrant/proximity/zones.hpp>

#include <bit>

namespace fibrant::proximity {

/// Sort-based uniform grid, linear in segments and close pairs for any mixture of lengths and radii.
///
/// The box of a segment is widened by half its threshold. Segments much longer than the others, or than their thickness,
/// are cut into pieces; boxes much larger than the others (thick fibres) stand in coarser grids. All that is taken from the data
/// at each call. Result and order do not depend on the number of threads.
class GridSearch : public detail::InTwoHalves<GridSearch> {
public:
    using Parameters = core::NoParameters;
    explicit GridSearch(const Parameters& = {}) {}

    /// @name The two halves of `pairs`, to be timed apart. The table must be the same.
    /// @{
    void build(const detail::SegmentTable& table) {
        if (table.size() == 0) return;
        make_boxes(table);
        sort_into_levels();
        order_records(table);
    }
    std::vector<SegmentPair> search(const detail::SegmentTable& table) {
        for (auto& some : close_) some.clear();
        if (table.size() > 0) overlaps(table);
        return sorter_.sorted(close_, table.size(), cut_);
    }
    /// @}

    /// Gives its memory back, which the next call takes anew.
    void release() { *this = GridSearch(); }
    /// Memory that is kept, without the pairs [byte].
    std::size_t bytes() const noexcept {
        std::size_t sum = (first_.capacity() + owner_.capacity()) * sizeof(std::int32_t) +
                          boxes_.capacity() * sizeof(detail::Box) + bin_.capacity() +
                          records_.capacity() * sizeof(detail::SegmentRecord);
        for (const detail::CellGrid& grid : levels_) sum += grid.bytes();
        for (const auto& places : place_owner_) sum += places.capacity() * sizeof(std::int32_t);
        return sum;
    }

private:
    static constexpr Index block = 4096;

    /// Cuts segments into pieces and makes the boxes of these.
    void make_boxes(const detail::SegmentTable& table) {
        const detail::BoxFrame frame(table);
        const std::int32_t n = table.size();
        per_size_ = static_cast<float>(1.0 / (1.5 * (frame.mean_length + frame.mean_thickness)));
        cut_ = count_pieces(table, frame);
        if (!cut_) {
            boxes_.resize(core::at(n));
            in_blocks(n, block,
                      [&](Index, std::int32_t k) { boxes_[core::at(k)] = frame.whole_box(table.record(k), table.reach()); });
            return;
        }
        boxes_.resize(core::at(first_.back()));
        owner_.resize(boxes_.size());
        in_blocks(n, block, [&](Index, std::int32_t k) {
            const detail::SegmentRecord record = table.record(k);
            const std::int32_t begin = first_[core::at(k)], end = first_[core::at(k) + 1];
            const double margin = record.half + 0.5 * table.reach(), per = 1.0 / (end - begin);
            for (std::int32_t p = begin; p < end; ++p) {
                boxes_[core::at(p)] = frame.box(record, (p - begin) * per, (p - begin + 1) * per, margin);
                owner_[core::at(p)] = k;
            }
        });
    }

    /// Fills `first_` unless no segment is cut. @return whether some are
    bool count_pieces(const detail::SegmentTable& table, const detail::BoxFrame& frame) {
        const double mean = frame.mean_length, thickness = frame.mean_thickness;
        const bool slender = mean > pieces_from * thickness;
        const double piece = slender ? std::max(piece_length * thickness, mean / most_pieces) : 2.0 * std::max(mean, thickness);
        if (frame.longest <= piece || (slender && !pays(table, frame, mean / piece))) return false;
        first_.resize(core::at(table.size()) + 1);
        first_[0] = 0;
        double all = 0.0;
        for (std::int32_t k = 0; k < table.size(); ++k) {
            const detail::SegmentRecord record = table.record(k);
            const double own = 2.0 * (2.0 * record.half + table.reach());  // shorter pieces have boxes hardly smaller
            all += std::max(1.0, std::ceil(std::sqrt(detail::dot(record.chord, record.chord)) / std::max(piece, own)));
            if (all >= detail::SegmentTable::at_most) core::refuse("pieces of all segments", core::text(all), "below 2^31 - 64");
            first_[core::at(k) + 1] = static_cast<std::int32_t>(all);
        }
        return first_.back() > table.size();
    }

    /// Whether slender segments should be cut. Where they run along the axes their boxes are slender too, and smaller cells may
    /// save less than more boxes cost: so it is in straight bundles, and in layers of them.
    static bool pays(const detail::SegmentTable& table, const detail::BoxFrame& frame, double pieces) {
        double across = 0.0;  // second largest sides
        Vec3 longest = Vec3::Zero(), low = Vec3::Constant(1.0e300), high = -low;
        for (std::int32_t k = 0; k < table.size(); ++k) {
            const detail::SegmentRecord record = table.record(k);
            const Vec3 chord{record.chord.x, record.chord.y, record.chord.z}, side = (frame.axes * chord).cwiseAbs();
            const Vec3 start = frame.axes * Vec3(record.start.x, record.start.y, record.start.z);
            across += side.sum() - side.maxCoeff() - side.minCoeff();
            longest = longest.cwiseMax(side), low = low.cwiseMin(start), high = high.cwiseMax(start);
        }
        if (across > aside * frame.mean_length * table.size()) return true;
        double part = pieces * pieces;  // comparisons of boxes with pieces over those without
        for (Index axis = 0; axis < 3; ++axis) {
            const auto share = [&](double side) {  // of the scene, in three cells
                return std::min(1.0, 3.0 * (side + frame.mean_thickness) / (high[axis] - low[axis] + frame.mean_thickness));
            };
            part *= share(longest[axis] / pieces) / share(longest[axis]);
        }
        return part < 1.0;
    }

    /// One grid for boxes within a factor of about 4 in size.
    void sort_into_levels() {
        std::array<std::int32_t, 256> bin{};  // by the binary exponent of the largest side over that of a common segment
        std::array<float, 256> largest{};
        bin_.resize(boxes_.size());
        for (std::size_t k = 0; k < boxes_.size(); ++k) {
            const detail::Box& box = boxes_[k];
            const float side = std::max({box.high[0] - box.low[0], box.high[1] - box.low[1], box.high[2] - box.low[2]});
            bin_[k] = static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(side * per_size_) >> 23);
            ++bin[bin_[k]];
            largest[bin_[k]] = std::max(largest[bin_[k]], side);
        }
        std::array<int, 256> level{};
        int levels = 0;
        for (std::size_t e = 0; e < 256;) {
            if (bin[e] == 0) {
                ++e;
                continue;
            }
            std::int32_t here = 0, above = 0;
            const std::size_t end = end_of_level(bin, largest, e);
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
        for (std::size_t k = 0; k < boxes_.size(); ++k) members[core::at(level[bin_[k]])].push_back(static_cast<std::int32_t>(k));
        levels_.resize(core::at(levels));
        for (std::size_t k = 0; k < levels_.size(); ++k) levels_[k].build(boxes_, members[k]);
        if (levels > 1)
            for (detail::CellGrid& grid : levels_) grid.index(2 * boxes_.size() + 64);
    }
    /// Three bins from this one on, or fewer if the last have few boxes that would make the cells of the others much larger.
    static std::size_t end_of_level(const std::array<std::int32_t, 256>& bin, const std::array<float, 256>& largest,
                                    std::size_t first) {
        const std::size_t end = std::min<std::size_t>(256, first + 3);
        for (std::size_t cut = first + 1; cut < end; ++cut) {
            std::int32_t below = 0, above = 0;
            float small = 0.0F, large = 0.0F;
            for (std::size_t k = first; k < cut; ++k) below += bin[k], small = std::max(small, largest[k]);
            for (std::size_t k = cut; k < end; ++k) above += bin[k], large = std::max(large, largest[k]);
            if (above > 0 && above < below / few_large && large > much_larger * small) return cut;
        }
        return end;
    }

    /// Records as the filter reads them. One level of whole segments: in the order of the cells. Else in that of the segments,
    /// with places mapped to them.
    void order_records(const detail::SegmentTable& table) {
        const bool mapped = cut_ || levels_.size() > 1;
        records_.resize(core::at(table.size()));
        place_owner_.resize(mapped ? levels_.size() : 0);
        for (std::size_t level = 0; level < place_owner_.size(); ++level) {
            place_owner_[level].resize(core::at(levels_[level].size()));
            for (std::int32_t k = 0; k < levels_[level].size(); ++k) {
                const std::int32_t box = levels_[level].box(k);
                place_owner_[level][core::at(k)] = cut_ ? owner_[core::at(box)] : box;
            }
        }
        in_blocks(table.size(), block,
                  [&](Index, std::int32_t k) { records_[core::at(k)] = table.record(mapped ? k : levels_[0].box(k)); });
    }

    /// Fills the first blocks of `close_`, in an order that the data alone gives.
    void overlaps(const detail::SegmentTable& table) {
        std::size_t done = 0;
        for (std::size_t level = 0; level < levels_.size(); ++level) {
            const detail::CellGrid& grid = levels_[level];
            const std::int32_t* map = place_owner_.empty() ? nullptr : place_owner_[level].data();
            const Index blocks = (grid.cells() + cells_together - 1) / cells_together;
            reserve_blocks(done + core::at(blocks));
            core::parallel_for<core::Share::turns>(blocks, [&](Index b) {
                detail::CandidateSink sink(table, records_.data(), map, map, close_[done + core::at(b)]);
                const auto first = static_cast<std::int32_t>(b * cells_together);
                grid.overlaps_inside(first, std::min(grid.cells(), first + cells_together), sink);
                sink.flush();
            });
            done += core::at(blocks);
            for (std::size_t lower = 0; lower < level; ++lower) done = search_between(table, level, lower, done);
        }
    }

    /// Boxes of a level against those of a finer one: each of these asks, or all in a cell of those together, whichever costs
    /// less.
    std::size_t search_between(const detail::SegmentTable& table, std::size_t upper, std::size_t lower, std::size_t done) {
        const detail::CellGrid &large = levels_[upper], &small = levels_[lower];
        const bool large_ask = large.cost_of_boxes(small) <= small.cost_of_cells(large);
        const std::int32_t asking = large_ask ? large.size() : small.cells();
        const Index blocks = (asking + cells_together - 1) / cells_together;
        reserve_blocks(done + core::at(blocks));
        core::parallel_for<core::Share::turns>(blocks, [&](Index b) {
            detail::CandidateSink sink(table, records_.data(), place_owner_[upper].data(), place_owner_[lower].data(),
                                       close_[done + core::at(b)]);
            const auto first = static_cast<std::int32_t>(b * cells_together), last = std::min(asking, first + cells_together);
            detail::CandidateList found;
            if (large_ask)
                for (std::int32_t k = first; k < last; ++k) small.overlaps_with(boxes_[core::at(large.box(k))], k, sink);
            else
                small.overlaps_across(first, last, large, found, sink);
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
    static constexpr double pieces_from = 32.0, piece_length = 24.0;  // thicknesses: fastest on oblique mats of slender fibres
    static constexpr double aside = 0.1;  // of the length: boxes of segments that lean less are slender
    static constexpr std::int32_t few_large = 4;
    static constexpr float much_larger = 2.5F;
    static constexpr double most_pieces = 8.0;  // of a segment of mean length: long straight fibres would else take all memory

    bool cut_ = false;                 // some segment has several boxes
    std::vector<std::int32_t> first_;  // first box of each segment
    std::vector<std::int32_t> owner_;  // segment of each box, where cut
    std::vector<detail::Box> boxes_;
    std::vector<std::uint8_t> bin_;  // of each box, by its size
    float per_size_ = 1.0F;          // bins do not depend on units
    std::vector<detail::CellGrid> levels_;
    std::vector<std::vector<std::int32_t>> place_owner_;  // of each level: segment at each place
    std::vector<detail::SegmentRecord> records_;
    std::vector<std::vector<SegmentPair>> close_;
    detail::PairSorter sorter_;
};
static_assert(ProximitySearch<GridSearch>);

}  // namespace fibrant::proximity

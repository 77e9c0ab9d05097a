// SPDX-License-Identifier: MIT
#pragma once
/// @file A search by a wide tree of boxes over runs of consecutive segments: for very uneven densities, lengths or radii.

#include <fibrant/proximity/box_tree.hpp>
#include <fibrant/proximity/candidate_sink.hpp>
#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/sorted_pairs.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {

/// Tree of sixteen children a node over runs of four consecutive segments, or over single ones where these are so long that
/// the box of a run would be mostly empty. Leaves stand in the order of a space-filling curve.
///
/// Nothing in it depends on a size of cells, so it serves sets of fibres that no grid suits. Result and order do not depend on
/// the number of threads.
class BvhSearch : public detail::InTwoHalves<BvhSearch> {
public:
    using Parameters = core::NoParameters;
    explicit BvhSearch(const Parameters& = {}) {}

    /// @name The two halves of `pairs`, to be timed apart. The table must be the same.
    /// @{
    void build(const detail::SegmentTable& table) {
        if (table.size() == 0) return;
        const detail::BoxFrame frame(table);
        const std::int32_t most = frame.mean_length > single_from * frame.mean_thickness ? 1 : 4;
        const std::vector<detail::Box> runs = boxes_of_runs(table, frame, most);
        sort_along_curve(runs);
        const std::int32_t n = table.size();
        segments_.resize(n);
        records_.resize(core::at(n));
        first_.assign(1, 0);
        std::vector<detail::Box> leaves;
        leaves.reserve(runs.size());
        for (const detail::CellEntry& entry : entries_) {
            leaves.push_back(runs[core::at(entry.box)]);
            std::int32_t place = first_.back();
            for (std::int32_t k = run_first_[core::at(entry.box)]; k < run_first_[core::at(entry.box) + 1]; ++k, ++place) {
                records_[core::at(place)] = table.record(k);
                segments_.set(place, frame.whole_box(records_[core::at(place)], table.reach()));
            }
            first_.push_back(place);
        }
        tree_.build(leaves);
    }

    std::vector<SegmentPair> search(const detail::SegmentTable& table) {
        for (auto& some : close_) some.clear();
        if (table.size() > 0) {
            constexpr Index together = 32;  // lowest nodes
            const Index blocks = (tree_.nodes() + together - 1) / together;
            if (close_.size() < core::at(blocks)) close_.resize(core::at(blocks));
            core::parallel_for(blocks, [&](Index b) {
                detail::CandidateSink sink(table, records_.data(), nullptr, nullptr, close_[core::at(b)]);
                detail::BoxTree::Scratch scratch;
                const auto take = [&](std::int32_t run, std::span<const detail::Candidate> hits) {
                    pair_runs(run, hits, table.selfish(), sink);
                };
                for (auto node = static_cast<std::int32_t>(b * together);
                     node < std::min<Index>(tree_.nodes(), (b + 1) * together); ++node)
                    tree_.visit_overlaps(node, scratch, take);
                sink.flush();
            });
        }
        return sorter_.sorted(close_, table.size(), false);
    }
    /// @}

    /// Gives its memory back, which the next call takes anew.
    void release() { *this = BvhSearch(); }
    /// Memory that is kept, without the pairs [byte].
    std::size_t bytes() const noexcept {
        return tree_.bytes() + segments_.bytes() + records_.capacity() * sizeof(detail::SegmentRecord) +
               (entries_.capacity() + spare_.capacity()) * sizeof(detail::CellEntry) +
               (first_.capacity() + run_first_.capacity()) * sizeof(std::int32_t);
    }

private:
    /// Fills run_first_.
    std::vector<detail::Box> boxes_of_runs(const detail::SegmentTable& table, const detail::BoxFrame& frame, std::int32_t most) {
        run_first_.clear();
        for (std::int32_t f = 0; f < table.fibres(); ++f) {
            const std::int32_t end = table.first(f) + static_cast<std::int32_t>(table.centreline(f).points.size()) - 1;
            for (std::int32_t k = table.first(f); k < end; k += most) run_first_.push_back(k);
        }
        run_first_.push_back(table.size());
        std::vector<detail::Box> runs(run_first_.size() - 1);
        core::parallel_for(core::count(runs), [&](Index r) {
            const std::int32_t first = run_first_[core::at(r)];
            detail::Box all = frame.whole_box(table.record(first), table.reach());
            for (std::int32_t k = first + 1; k < run_first_[core::at(r) + 1]; ++k)
                detail::BoxTree::add(all, frame.whole_box(table.record(k), table.reach()));
            runs[core::at(r)] = all;
        });
        return runs;
    }

    /// Runs by the Morton code of their middles, 21 bits an axis, which is as fine as single precision. Fills entries_.
    void sort_along_curve(const std::vector<detail::Box>& runs) {
        const auto middle = [](const detail::Box& box, int axis) {
            return 0.5 * (static_cast<double>(box.low[axis]) + static_cast<double>(box.high[axis]));
        };
        double low[3] = {1e300, 1e300, 1e300}, size = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            double high = -1e300;
            for (const detail::Box& box : runs)
                low[axis] = std::min(low[axis], middle(box, axis)), high = std::max(high, middle(box, axis));
            size = std::max(size, high - low[axis]);
        }
        const double scale = size > 0.0 ? 2097151.0 / size : 0.0;
        const auto spread = [](std::uint64_t x) {  // bit b to bit 3 b
            x = (x | x << 32) & 0x001f00000000ffffU;
            x = (x | x << 16) & 0x001f0000ff0000ffU;
            x = (x | x << 8) & 0x100f00f00f00f00fU;
            x = (x | x << 4) & 0x10c30c30c30c30c3U;
            return (x | x << 2) & 0x1249249249249249U;
        };
        entries_.resize(runs.size());
        for (std::size_t r = 0; r < runs.size(); ++r) {
            std::uint64_t key = 0;
            for (int axis = 0; axis < 3; ++axis)
                key |= spread(static_cast<std::uint64_t>((middle(runs[r], axis) - low[axis]) * scale)) << axis;
            entries_[r] = {key, static_cast<std::int32_t>(r)};
        }
        detail::sort_by_key(entries_, spare_, std::uint64_t{1} << 63);
    }

    /// Segments of a run against those of the runs that it overlaps.
    void pair_runs(std::int32_t run, std::span<const detail::Candidate> hits, bool selfish, detail::CandidateSink& sink) const {
        const std::int32_t end = first_[core::at(run) + 1];
        for (std::int32_t k = first_[core::at(run)]; k < end; ++k) {
            const detail::Box box = segments_[k];
            detail::Candidate* out = sink.room(4 * static_cast<std::int32_t>(hits.size()) + 2 * detail::BoxColumns::width);
            if (selfish) out = segments_.overlaps(box, k + 1, end, k, out);
            for (const detail::Candidate& hit : hits)
                out = segments_.overlaps(box, first_[core::at(hit.b)], first_[core::at(hit.b) + 1], k, out);
            sink.take(out);
        }
    }

    static constexpr double single_from = 16.0;

    std::vector<std::int32_t> run_first_;             // first segment of each run, in the order of the fibres
    std::vector<detail::CellEntry> entries_, spare_;  // runs in the order of the curve
    std::vector<std::int32_t> first_;                 // place of the first segment of each run, in that order
    detail::BoxColumns segments_;                     // boxes by place
    std::vector<detail::SegmentRecord> records_;      // by place
    detail::BoxTree tree_;
    std::vector<std::vector<SegmentPair>> close_;
    detail::PairSorter sorter_;
};
static_assert(ProximitySearch<BvhSearch>);

}  // namespace fibrant::proximity

// SPDX-License-Identifier: MIT
#pragma once
/// @file Boxes sorted by the cells of a uniform grid: neither a hash table nor a dense array of cells.

#include <fibrant/proximity/box_columns.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <utility>

namespace fibrant::proximity::detail {

/// Key of a cell and the box in it.
struct CellEntry {
    std::uint64_t key;
    std::int32_t box;
};

/// Sorts by key, which is below `keys`, and keeps the order of equal ones: counting sort by digits of 11 bits.
inline void sort_by_key(std::vector<CellEntry>& entries, std::vector<CellEntry>& spare, std::uint64_t keys) {
    spare.resize(entries.size());
    constexpr int digit = 11;
    for (int shift = 0; shift < 64 && ((keys - 1) >> shift) != 0; shift += digit) {
        std::array<std::size_t, std::size_t{1} << digit> place{};
        for (const CellEntry& entry : entries) ++place[(entry.key >> shift) & (place.size() - 1)];
        std::size_t sum = 0;
        for (std::size_t& p : place) sum += std::exchange(p, sum);
        for (const CellEntry& entry : entries) spare[place[(entry.key >> shift) & (place.size() - 1)]++] = entry;
        entries.swap(spare);
    }
}

/// Candidates that are used at once.
class CandidateList {
public:
    Candidate* room(std::int32_t n) {
        if (filled_ + core::at(n) > list_.size()) list_.resize(2 * (filled_ + core::at(n)));
        return list_.data() + filled_;
    }
    void take(const Candidate* end) noexcept { filled_ = core::at(end - list_.data()); }
    void clear() noexcept { filled_ = 0; }
    std::span<const Candidate> all() const noexcept { return {list_.data(), filled_}; }

private:
    std::vector<Candidate> list_;
    std::size_t filled_ = 0;
};

/// Uniform grid over the middles of boxes. A cell is as wide as the largest box along each axis or wider, so that boxes which
/// overlap stand in the same cell or in neighbours. Where boxes are scattered, cells are wider: to go through a cell costs as
/// much as to compare its box with dozens of others.
class CellGrid {
public:
    /// @param boxes    of all levels   @param members  numbers of the boxes that this grid takes, in order
    void build(const std::vector<Box>& boxes, std::span<const std::int32_t> members) {
        const std::array<double, 3> extent = measure(boxes, members);
        const auto n = static_cast<std::int32_t>(members.size());
        entries_.resize(members.size());
        double cells = 1.0;
        for (std::size_t axis = 0; axis < 3; ++axis) cells *= std::max(1.0, extent[axis] / (2.0 * half_[axis]));
        double wider = std::min(std::cbrt(roomy * cells / n), widest);
        for (;;) {
            if (!(wider > worth)) wider = 1.0;
            set_cells(extent, wider);
            if (wider == 1.0) {
                for (std::size_t k = 0; k < members.size(); ++k) entries_[k] = {key(boxes[core::at(members[k])]), members[k]};
                break;
            }
            const double crowd = number_and_count(boxes, members);
            if (crowd <= crowded) break;
            wider *= std::min(0.7, std::sqrt(0.5 * crowded / crowd));  // not scattered as it seemed: in clusters
        }
        sort_by_key(entries_, spare_, cells_[0] * cells_[1] * cells_[2]);
        columns_.resize(n);
        cell_key_.clear();
        cell_first_.clear();
        cell_group_.clear();
        const bool lonely = wider > mostly_alone;
        for (std::int32_t k = 0; k < n; ++k) {
            const CellEntry& entry = entries_[core::at(k)];
            const Box& box = boxes[core::at(entry.box)];
            columns_.set(k, box);
            if (k == 0 || entry.key != cell_key_.back()) {
                cell_key_.push_back(entry.key);
                cell_first_.push_back(k);
                if (lonely) cell_group_.push_back(box.group);
            } else if (lonely && cell_group_.back() != box.group) {
                cell_group_.back() = many;
            }
        }
        cell_first_.push_back(n);
        place_.clear();
    }
    /// Hands over {l, k} for the places l in a grid of larger boxes and k in cells [first, last) of boxes that overlap.
    /// @param found  scratch
    template <class Sink>
    void overlaps_across(std::int32_t first, std::int32_t last, const CellGrid& larger, CandidateList& found, Sink& sink) const {
        for (std::int32_t c = first; c < last; ++c) {
            const std::int32_t begin = cell_first_[core::at(c)], end = cell_first_[core::at(c + 1)];
            Box all = columns_.around(begin, end);
            all.group = many;
            found.clear();
            larger.overlaps_with(all, 0, found);
            for (const Candidate& other : found.all())
                sink.take(
                    columns_.overlaps(larger.columns_[other.b], begin, end, other.b, sink.room(end - begin + BoxColumns::width)));
        }
    }
    /// Makes `overlaps_with` look places up instead of searching for them, if there are no more cells than this, empty ones too.
    void index(std::size_t most) {
        const std::uint64_t cells = cells_[0] * cells_[1] * cells_[2];
        if (cells > most) return;
        place_.resize(cells);
        std::uint64_t key = 0;
        for (std::size_t c = 0; c < cell_key_.size(); ++c)
            for (; key <= cell_key_[c]; ++key) place_[key] = cell_first_[c];
        for (; key < cells; ++key) place_[key] = size();
    }

    std::int32_t size() const noexcept { return static_cast<std::int32_t>(entries_.size()); }
    std::size_t bytes() const noexcept {
        return (entries_.capacity() + spare_.capacity()) * sizeof(CellEntry) + cell_key_.capacity() * sizeof(std::uint64_t) +
               (cell_first_.capacity() + cell_group_.capacity() + place_.capacity()) * sizeof(std::int32_t) + columns_.bytes();
    }
    std::int32_t cells() const noexcept { return static_cast<std::int32_t>(cell_key_.size()); }
    /// Number of the box at place k of the grid's order.
    std::int32_t box(std::int32_t k) const noexcept { return entries_[core::at(k)].box; }

    /// Hands over the places {k, l} of overlapping boxes, each two once, of which k is in cells [first, last): the rest of
    /// the own cell and half of the neighbours, which are five runs of places that only move forward.
    /// @param sink  sink.room(n) is where n candidates may be written, sink.take(end) hands over those before `end`
    template <class Sink>
    void overlaps_inside(std::int32_t first, std::int32_t last, Sink& sink) const {
        const bool lonely = !cell_group_.empty();
        const std::uint64_t row = cells_[2], layer = cells_[1] * cells_[2];
        const std::uint64_t ahead[4] = {row, layer - row, layer, layer + row};
        std::int32_t from[4], to[4];
        for (int r = 0; r < 4; ++r) from[r] = to[r] = cell_at_least(cell_key_[core::at(first)] + ahead[r] - 1);
        for (std::int32_t c = first; c < last; ++c) {
            const std::uint64_t key = cell_key_[core::at(c)];
            const std::int32_t next = c + 1 < cells() && cell_key_[core::at(c + 1)] == key + 1 ? c + 2 : c + 1;
            const std::int32_t group = lonely ? group_of(c, next) : many;
            std::int32_t run[6][2],
                across = 0;  // the own one, and those of the neighbours; where groups are known, those that pair
            int runs = 1;
            run[0][1] = cell_first_[core::at(next)];
            for (int r = 0; r < 4; ++r) {
                const std::uint64_t middle = key + ahead[r];
                while (from[r] < cells() && cell_key_[core::at(from[r])] < middle - 1) ++from[r];
                to[r] = std::max(to[r], from[r]);
                while (to[r] < cells() && cell_key_[core::at(to[r])] <= middle + 1) ++to[r];
                run[runs][0] = cell_first_[core::at(from[r])];
                run[runs][1] = cell_first_[core::at(to[r])];
                if (!lonely || (from[r] < to[r] && (group == many || group_of(from[r], to[r]) != group)))
                    across += run[runs][1] - run[runs][0], ++runs;
            }
            if (runs == 1 && group != many) continue;
            const auto compare = [&](auto number) {
                for (std::int32_t k = cell_first_[core::at(c)]; k < cell_first_[core::at(c + 1)]; ++k) {
                    const Box box = columns_[k];
                    run[0][0] = k + 1;
                    Candidate* out = sink.room(run[0][1] - run[0][0] + across + BoxColumns::width);
                    for (int r = 0; r < number; ++r) out = columns_.overlaps(box, run[r][0], run[r][1], k, out);
                    sink.take(out);
                }
            };
            lonely ? compare(runs) : compare(std::integral_constant<int, 5>{});
        }
    }

    /// @name What it costs to compare with another grid, more or less, in comparisons of whole vectors.
    /// @{
    double cost_of_boxes(const CellGrid& asked_for) const noexcept {
        return size() * asked_for.cost_of_asking(mean_[0], mean_[1], mean_area_);
    }
    double cost_of_cells(const CellGrid& asked_for) const noexcept {
        const double x = mean_[0] + 0.5 * width_[0], y = mean_[1] + 0.5 * width_[1];
        return cells() * asked_for.cost_of_asking(x, y, x * y);
    }
    /// @}
    /// Hands over {of, l} for the places l of boxes that overlap `box`, which may be of any size.
    template <class Sink>
    void overlaps_with(const Box& box, std::int32_t of, Sink& sink) const {
        const CellRange range = around(box);
        const auto& [low, high] = range;
        if (static_cast<double>(range.rows()) * row() > static_cast<double>(size()) / BoxColumns::width) {
            sink.take(columns_.overlaps(box, 0, size(), of, sink.room(size() + BoxColumns::width)));
            return;
        }
        std::int32_t at = 0;
        for (std::uint64_t x = low[0]; x <= high[0]; ++x)
            for (std::uint64_t y = low[1]; y <= high[1]; ++y) {
                const std::uint64_t start = (x * cells_[1] + y) * cells_[2];
                const std::int32_t from = place_at_least(start + low[2], at), to = place_at_least(start + high[2] + 1, at);
                if (from < to) sink.take(columns_.overlaps(box, from, to, of, sink.room(to - from + BoxColumns::width)));
            }
    }

private:
    /// The group of all boxes in up to three cells, if it is one.
    std::int32_t group_of(std::int32_t first, std::int32_t last) const noexcept {
        const std::int32_t group = cell_group_[core::at(first)];
        return cell_group_[core::at((first + last) / 2)] == group && cell_group_[core::at(last - 1)] == group ? group : many;
    }
    /// For a box, from the means of its first two sides and of their product.
    double cost_of_asking(double x, double y, double area) const noexcept {
        const auto rows = [&](std::size_t axis) { return 2.0 * half_[axis] / width_[axis] + 1.0; };  // of a box without size
        const double mean = (area / width_[0] + x * rows(1)) / width_[1] + rows(0) * (y / width_[1] + rows(1));
        return asked + std::min(mean * row(), static_cast<double>(size()) / BoxColumns::width + 1.0);
    }
    struct CellRange {
        std::array<std::uint64_t, 3> low, high;
        std::uint64_t rows() const noexcept { return (high[0] - low[0] + 1) * (high[1] - low[1] + 1); }
    };
    /// Cells whose boxes may overlap a box.
    CellRange around(const Box& box) const noexcept {
        CellRange range{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            range.low[axis] = cell(box.low[axis] - half_[axis], axis);
            range.high[axis] = cell(box.high[axis] + half_[axis], axis);
        }
        return range;
    }
    /// Sizes of boxes and where they are. @return the extent of all
    std::array<double, 3> measure(const std::vector<Box>& boxes, std::span<const std::int32_t> members) {
        std::array<float, 3> low, high, largest{};
        std::array<double, 3> sum{}, extent;
        low.fill(std::numeric_limits<float>::max()), high.fill(-low[0]);
        double area = 0.0;
        for (const std::int32_t member : members) {
            const Box& box = boxes[core::at(member)];
            float side[3];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                side[axis] = box.high[axis] - box.low[axis];
                sum[axis] += side[axis];
                largest[axis] = std::max(largest[axis], side[axis]);
                low[axis] = std::min(low[axis], box.low[axis]);
                high[axis] = std::max(high[axis], box.high[axis]);
            }
            area += side[0] * side[1];
        }
        const auto n = static_cast<double>(members.size());
        mean_area_ = area / n;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            mean_[axis] = sum[axis] / n;
            half_[axis] = 0.5 * largest[axis] * (1.0 + 1.0e-5);  // rounding of sides and of cells is less
            origin_[axis] = low[axis];
            extent[axis] = static_cast<double>(high[axis]) - low[axis];
        }
        return extent;
    }
    void set_cells(const std::array<double, 3>& extent, double wider) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            // An empty cell all around keeps runs over neighbours from reaching into the next row; 20 bits an axis.
            width_[axis] = std::max(2.0 * half_[axis] * wider, extent[axis] / 1.0e6);
            per_width_[axis] = 1.0 / width_[axis];
            cells_[axis] = static_cast<std::uint64_t>(extent[axis] * per_width_[axis]) + 3;
        }
    }
    /// Fills `entries_`, not yet sorted. @return how many boxes there are in the cell of a box, in the mean
    double number_and_count(const std::vector<Box>& boxes, std::span<const std::int32_t> members) {
        const auto bits = static_cast<int>(std::bit_width(members.size()));
        place_.assign(std::size_t{1} << bits, 0);
        std::uint64_t others = 0;
        for (std::size_t k = 0; k < members.size(); ++k) {
            const std::uint64_t own = key(boxes[core::at(members[k])]);
            entries_[k] = {own, members[k]};
            others += core::at(place_[(own * 0x9E3779B97F4A7C15U) >> (64 - bits)]++);
        }
        // Cells that share a counter by chance are not taken away: one box at most.
        return 1.0 + 2.0 * static_cast<double>(others) / static_cast<double>(members.size());
    }
    std::uint64_t cell(double x, std::size_t axis) const noexcept {
        const double c = (x - origin_[axis]) * per_width_[axis] + 1.0;  // rounding is in the 1e-5 that a cell is wider
        return c > 0.0 ? std::min(static_cast<std::uint64_t>(c), cells_[axis] - 1) : 0;
    }
    std::uint64_t key(const Box& box) const noexcept {
        std::uint64_t c[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            c[axis] = cell(0.5 * (static_cast<double>(box.low[axis]) + static_cast<double>(box.high[axis])), axis);
        return (c[0] * cells_[1] + c[1]) * cells_[2] + c[2];
    }
    std::int32_t cell_at_least(std::uint64_t key) const noexcept {
        return static_cast<std::int32_t>(std::lower_bound(cell_key_.begin(), cell_key_.end(), key) - cell_key_.begin());
    }

    /// @param at  a cell not beyond the one that is asked for, and then this one: rows that follow each other are near
    std::int32_t place_at_least(std::uint64_t key, std::int32_t& at) const noexcept {
        if (!place_.empty()) return key < place_.size() ? place_[key] : size();
        const auto first = cell_key_.begin() + at;
        std::int32_t step = 1;
        while (at + step < cells() && first[step - 1] < key) step *= 2;
        at = static_cast<std::int32_t>(std::lower_bound(first + step / 2, first + std::min(step, cells() - at), key) -
                                       cell_key_.begin());
        return cell_first_[core::at(at)];
    }

    /// What a row of cells costs to be looked up or searched for, in comparisons of whole vectors.
    double row() const noexcept { return place_.empty() ? 12.0 : 4.0; }

    static constexpr std::int32_t many = -2147483647 - 1;  // no group: a cell has boxes of several

    static constexpr double roomy = 1.3;         // boxes a cell, had it all space alike
    static constexpr double widest = 5.0;        // over the largest box
    static constexpr double worth = 1.25;        // less is not
    static constexpr double mostly_alone = 2.0;  // wider cells have but one fibre, as often as not
    static constexpr double crowded = 10.0;      // boxes in the cell of a box
    static constexpr double asked = 6.0;         // cost of a box that asks, in comparisons of whole vectors

    double origin_[3], half_[3], width_[3], per_width_[3];  // half: of the largest box
    double mean_[3], mean_area_;                            // sides of boxes, and product of the first two
    std::uint64_t cells_[3];
    std::vector<CellEntry> entries_, spare_;
    std::vector<std::uint64_t> cell_key_;
    std::vector<std::int32_t> cell_first_, cell_group_;
    std::vector<std::int32_t> place_;  // first place of each cell or after it, where indexed
    BoxColumns columns_;
};

}  // namespace fibrant::proximity::detail

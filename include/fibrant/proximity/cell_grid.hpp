// SPDX-License-Identifier: MIT
#pragma once
/// @file Boxes sorted by the cells of a uniform grid: neither a hash table nor a dense array of cells.

#include <fibrant/proximity/box_columns.hpp>

#include <array>
#include <cmath>
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

/// Uniform grid over the middles of boxes. A cell is as wide as the largest box along each axis, so that boxes which
/// overlap stand in the same cell or in neighbours.
class CellGrid {
public:
    /// @param boxes    of all levels   @param members  numbers of the boxes that this grid takes, in order
    void build(const std::vector<Box>& boxes, std::span<const std::int32_t> members) {
        measure(boxes, members);
        entries_.resize(members.size());
        for (std::size_t k = 0; k < members.size(); ++k) entries_[k] = {key(boxes[core::at(members[k])]), members[k]};
        sort_by_key(entries_, spare_, cells_[0] * cells_[1] * cells_[2]);
        const auto n = static_cast<std::int32_t>(members.size());
        columns_.resize(n);
        cell_key_.clear();
        cell_first_.clear();
        for (std::int32_t k = 0; k < n; ++k) {
            const CellEntry& entry = entries_[core::at(k)];
            columns_.set(k, boxes[core::at(entry.box)]);
            if (k == 0 || entry.key != cell_key_.back()) {
                cell_key_.push_back(entry.key);
                cell_first_.push_back(k);
            }
        }
        cell_first_.push_back(n);
        place_.clear();
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
               (cell_first_.capacity() + place_.capacity()) * sizeof(std::int32_t) + columns_.bytes();
    }
    std::int32_t cells() const noexcept { return static_cast<std::int32_t>(cell_key_.size()); }
    /// Number of the box at place k of the grid's order.
    std::int32_t box(std::int32_t k) const noexcept { return entries_[core::at(k)].box; }

    /// Hands over the places {k, l} of overlapping boxes, each two once, of which k is in cells [first, last): the rest of
    /// the own cell and half of the neighbours, which are five runs of places that only move forward.
    /// @param sink  sink.room(n) is where n candidates may be written, sink.take(end) hands over those before `end`
    template <class Sink>
    void overlaps_inside(std::int32_t first, std::int32_t last, Sink& sink) const {
        const std::uint64_t row = cells_[2], layer = cells_[1] * cells_[2];
        const std::uint64_t ahead[4] = {row, layer - row, layer, layer + row};
        std::int32_t from[4], to[4];
        for (int r = 0; r < 4; ++r) from[r] = to[r] = cell_at_least(cell_key_[core::at(first)] + ahead[r] - 1);
        for (std::int32_t c = first; c < last; ++c) {
            const std::uint64_t key = cell_key_[core::at(c)];
            std::int32_t run[5][2], across = 0;
            run[0][1] = cell_first_[core::at(c + 1 < cells() && cell_key_[core::at(c + 1)] == key + 1 ? c + 2 : c + 1)];
            for (int r = 0; r < 4; ++r) {
                const std::uint64_t middle = key + ahead[r];
                while (from[r] < cells() && cell_key_[core::at(from[r])] < middle - 1) ++from[r];
                to[r] = std::max(to[r], from[r]);
                while (to[r] < cells() && cell_key_[core::at(to[r])] <= middle + 1) ++to[r];
                run[r + 1][0] = cell_first_[core::at(from[r])];
                run[r + 1][1] = cell_first_[core::at(to[r])];
                across += run[r + 1][1] - run[r + 1][0];
            }
            for (std::int32_t k = cell_first_[core::at(c)]; k < cell_first_[core::at(c + 1)]; ++k) {
                const Box box = columns_[k];
                run[0][0] = k + 1;
                Candidate* out = sink.room(run[0][1] - run[0][0] + across + BoxColumns::width);
                for (const auto& places : run) out = columns_.overlaps(box, places[0], places[1], k, out);
                sink.take(out);
            }
        }
    }

    /// What `overlaps_with` costs for a box with these sides along the first two axes, more or less: rows of cells to look up.
    double rows_of(const std::array<double, 2>& sides) const noexcept {
        if (size() <= few) return 1.0;
        const double rows = (sides[0] / width_[0] + 2.0) * (sides[1] / width_[1] + 2.0);
        return std::min(rows, static_cast<double>(cells())) * (place_.empty() ? searched : 1.0);
    }
    /// Hands over {of, l} for the places l of boxes that overlap `box`, which may be of any size.
    template <class Sink>
    void overlaps_with(const Box& box, std::int32_t of, Sink& sink) const {
        const CellRange range = around(box);
        const auto& [low, high] = range;
        if (size() <= few || range.rows() > core::at(cells())) {
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
    struct CellRange {
        std::array<std::uint64_t, 3> low, high;
        std::uint64_t rows() const noexcept { return (high[0] - low[0] + 1) * (high[1] - low[1] + 1); }
    };
    /// Cells whose boxes may overlap a box.
    CellRange around(const Box& box) const noexcept {
        CellRange range{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            range.low[axis] = cell(box.low[axis] - 0.5 * width_[axis], axis);
            range.high[axis] = cell(box.high[axis] + 0.5 * width_[axis], axis);
        }
        return range;
    }
    void measure(const std::vector<Box>& boxes, std::span<const std::int32_t> members) {
        double high[3];
        for (std::size_t axis = 0; axis < 3; ++axis) {
            origin_[axis] = 1.0e300;
            high[axis] = -1.0e300;
            width_[axis] = 0.0;
        }
        for (const std::int32_t member : members) {
            const Box& box = boxes[core::at(member)];
            for (std::size_t axis = 0; axis < 3; ++axis) {
                const double a = box.low[axis], b = box.high[axis];
                width_[axis] = std::max(width_[axis], b - a);
                origin_[axis] = std::min(origin_[axis], 0.5 * (a + b));
                high[axis] = std::max(high[axis], 0.5 * (a + b));
            }
        }
        for (std::size_t axis = 0; axis < 3; ++axis) {
            width_[axis] *= 1.0 + 1.0e-5;
            // An empty cell all around keeps runs over neighbours from reaching into the next row; 20 bits an axis.
            width_[axis] = std::max(width_[axis], (high[axis] - origin_[axis]) / 1.0e6);
            per_width_[axis] = 1.0 / width_[axis];
            cells_[axis] = static_cast<std::uint64_t>((high[axis] - origin_[axis]) * per_width_[axis]) + 3;
        }
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

    static constexpr std::int32_t few = 4 * BoxColumns::width;  // boxes that are compared sooner than looked up
    static constexpr double searched = 3.0;                     // cost of a row that is searched for, over one that is looked up

    double origin_[3], width_[3], per_width_[3];
    std::uint64_t cells_[3];
    std::vector<CellEntry> entries_, spare_;
    std::vector<std::uint64_t> cell_key_;
    std::vector<std::int32_t> cell_first_;
    std::vector<std::int32_t> place_;  // first place of each cell or after it, where indexed
    BoxColumns columns_;
};

}  // namespace fibrant::proximity::detail

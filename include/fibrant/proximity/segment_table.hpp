// SPDX-License-Identifier: MIT
#pragma once
/// @file Segments of all fibres under one numbering, and which of them may pair.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace fibrant::proximity::detail {

/// What the filter reads of a segment, in one cache line.
struct alignas(64) SegmentRecord {
    Plain3 start, chord;
    double half;           ///< radius + inflation
    std::int32_t segment;  ///< global number
    std::int32_t group;    ///< its family, or -1 - fibre: segments of one group do not pair, but by self_skip
};
static_assert(sizeof(SegmentRecord) == 64);

/// Validated view of the fibres, segment by segment. It reads the vertices of the centrelines and does not copy them.
class SegmentTable {
public:
    SegmentTable(std::span<const Centreline> fibres, double reach) : fibres_(fibres), reach_(reach) {
        core::require_not_negative("reach", reach);
        first_.resize(fibres.size() + 1);
        std::size_t total = 0;
        for (std::size_t f = 0; f < fibres.size(); ++f) {
            check(f);
            first_[f] = static_cast<std::int32_t>(total);
            total += fibres[f].points.size() - 1;
            if (total >= at_most) core::refuse("segments of all fibres", std::to_string(total), "below 2^31 - 64");
            selfish_ = selfish_ || std::isfinite(fibres[f].self_skip);
        }
        first_.back() = static_cast<std::int32_t>(total);
        fibre_.resize(total);
        for (std::size_t f = 0; f < fibres.size(); ++f)
            std::fill(fibre_.begin() + first_[f], fibre_.begin() + first_[f + 1], static_cast<std::int32_t>(f));
        if (selfish_) measure_arcs();
    }

    std::int32_t size() const noexcept { return static_cast<std::int32_t>(fibre_.size()); }
    std::int32_t fibres() const noexcept { return static_cast<std::int32_t>(fibres_.size()); }
    double reach() const noexcept { return reach_; }
    bool selfish() const noexcept { return selfish_; }  ///< some fibre may pair with itself
    const Centreline& centreline(std::int32_t f) const noexcept { return fibres_[core::at(f)]; }
    std::int32_t first(std::int32_t f) const noexcept { return first_[core::at(f)]; }  ///< segment of fibre f
    std::int32_t fibre(std::int32_t segment) const noexcept { return fibre_[core::at(segment)]; }

    SegmentRecord record(std::int32_t segment) const noexcept {
        const std::int32_t f = fibre(segment);
        const Centreline& line = centreline(f);
        const std::size_t k = core::at(segment - first(f));
        const Plain3 start = plain(line.points[k]), end = plain(line.points[k + 1]);
        return {start, end - start, line.radius + (line.inflation.empty() ? 0.0 : line.inflation[k]), segment,
                line.family >= 0 ? static_cast<std::int32_t>(line.family) : -1 - f};
    }

    /// Records of all segments in order.
    std::vector<SegmentRecord> records() const {
        std::vector<SegmentRecord> all(core::at(size()));
        core::parallel_for(
            size(), [&](Index k) { all[core::at(k)] = record(static_cast<std::int32_t>(k)); }, 16 * core::light_items);
        return all;
    }

    /// Whether segments i < j of one group may pair: only on one fibre, far enough along it.
    bool may_pair_in_group(std::int32_t i, std::int32_t j) const noexcept {
        if (!selfish_ || fibre(i) != fibre(j) || j - i < 2) return false;
        if (const Centreline& line = centreline(fibre(i)); line.closed) {  // the other way around
            const std::size_t end = core::at(first(fibre(i) + 1)) - 1;
            const double whole = arc_[end] + length_[end], between = arc_[core::at(j)] + length_[core::at(j)] - arc_[core::at(i)];
            if (!(whole - between > line.self_skip)) return false;
        }
        return arc_[core::at(j)] - arc_[core::at(i)] - length_[core::at(i)] > centreline(fibre(i)).self_skip;
    }

    static constexpr std::size_t at_most = 2147483647u - 64u;  ///< segments

private:
    /// Names are made only once something is wrong: this runs over all vertices at every search.
    void check(std::size_t f) const {
        const Centreline& line = fibres_[f];
        const auto name = [f](const char* part) { return ("fibre " + std::to_string(f)).append(part); };
        if (line.points.size() < 2) core::require_at_least(name(": vertices"), core::count(line.points), 2);
        if (!(line.radius > 0.0) || !std::isfinite(line.radius)) core::require_positive(name(": radius"), line.radius);
        if (!(line.self_skip >= 0.0)) core::refuse(name(": self_skip"), core::text(line.self_skip), ">= 0 (infinite: never)");
        if (line.family >= 2147483647) core::refuse(name(": family"), std::to_string(line.family), "below 2^31 - 1");
        for (std::size_t k = 0; k < line.points.size(); ++k)
            if (!line.points[k].allFinite()) {
                std::string where;
                for (const double x : line.points[k]) where.append(where.empty() ? "" : " ").append(core::text(x));
                core::refuse(name(", vertex ").append(std::to_string(k)), where, "finite");
            }
        if (line.inflation.empty()) return;
        if (line.inflation.size() + 1 != line.points.size())
            core::refuse(name(": inflations"), std::to_string(line.inflation.size()),
                         "none or one a segment, " + std::to_string(line.points.size() - 1));
        for (std::size_t k = 0; k < line.inflation.size(); ++k)
            if (!(line.inflation[k] >= 0.0) || !std::isfinite(line.inflation[k]))
                core::require_not_negative(name(", segment ").append(std::to_string(k)).append(": inflation"), line.inflation[k]);
    }

    void measure_arcs() {
        arc_.resize(fibre_.size());
        length_.resize(fibre_.size());
        for (std::size_t f = 0; f < fibres_.size(); ++f) {
            double arc = 0.0;
            for (std::size_t k = 0; k + 1 < fibres_[f].points.size(); ++k) {
                const std::size_t segment = core::at(first_[f]) + k;
                arc_[segment] = arc;
                length_[segment] = (fibres_[f].points[k + 1] - fibres_[f].points[k]).norm();
                arc += length_[segment];
            }
        }
    }

    std::span<const Centreline> fibres_;
    double reach_;
    bool selfish_ = false;
    std::vector<std::int32_t> first_, fibre_;
    std::vector<double> arc_, length_;  // of each segment, only where a fibre may pair with itself
};

}  // namespace fibrant::proximity::detail

// SPDX-License-Identifier: MIT
#pragma once
/// @file Joins close pairs of segments into proximity zones; the same function for every search.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/closed_zones.hpp>
#include <fibrant/proximity/exact_filter.hpp>
#include <fibrant/proximity/near_part.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace fibrant::proximity {
namespace detail {

/// Makes the zones of two fibres at a time; keeps its buffers from one to the next. Zones are whole once all are finished: where
/// they end is solved for eight ends at once.
class ZoneMaker {
public:
    /// @param records  of all segments in order   @param zones  to append to
    ZoneMaker(const SegmentTable& table, const SegmentRecord* records, std::vector<ProximityZone>& zones)
        : table_(table), records_(records), zones_(zones) {}

    /// Appends the zones of two fibres.
    /// @param pairs   all of these two, sorted by segment
    /// @param places  of these
    void append(std::span<const SegmentPair> pairs, const PairPlace* places) {
        pairs_ = pairs, place_ = places;
        fibre_i_ = table_.fibre(pairs.front().i), fibre_j_ = table_.fibre(pairs.front().j);
        first_i_ = table_.first(fibre_i_), first_j_ = table_.first(fibre_j_);
        if (table_.centreline(fibre_i_).closed || table_.centreline(fibre_j_).closed)
            return closed_.append(pairs, places, zones_);
        const std::size_t n = pairs_.size(), before = zones_.size();
        const auto [low, high] = range_of_senses();
        const bool turns = low <= -clearly && high >= clearly;
        if (!turns && in_one_piece()) {
            Extent extent;
            ProximityZone zone;
            for (std::size_t k = 0; k < n; ++k) extent.add(pairs_[k], place_[k].sense), take(k, zone);
            zones_.push_back(zone);
            for (std::size_t k = 0; k < n; ++k) ask_for_ends(k, extent, before);
            if (extent.sense < 0.0) against_.push_back(before);
            return;
        }
        root_.resize(n);
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        join([](std::size_t, std::size_t) { return true; });
        if (turns && separate_turns()) join([this](std::size_t a, std::size_t b) { return same_way(a, b); });
        zone_.assign(n, none);
        extent_.clear();
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t top = root(k);
            if (zone_[top] == none) {
                zone_[top] = extent_.size();
                extent_.push_back({});
            }
            zone_[k] = zone_[top];
            extent_[zone_[k]].add(pairs_[k], place_[k].sense);
        }
        zones_.resize(before + extent_.size());
        for (std::size_t k = 0; k < n; ++k) take(k, zones_[before + zone_[k]]);
        for (std::size_t k = 0; k < n; ++k) ask_for_ends(k, extent_[zone_[k]], before + zone_[k]);
        for (std::size_t z = 0; z < extent_.size(); ++z)
            if (extent_[z].sense < 0.0) against_.push_back(before + z);
        if (extent_.size() > 1) several_.push_back({before, extent_.size()});
    }

    /// Ends all zones that were appended since the last time.
    void finish() {
        solve_ends();
        for (const std::size_t z : against_) std::swap(zones_[z].a_j, zones_[z].b_j);
        for (const auto& [first, number] : several_) sort_along(std::span(zones_).subspan(first, number));
        against_.clear(), several_.clear();
    }

private:
    static constexpr std::size_t none = static_cast<std::size_t>(-1);
    static constexpr double clearly = 0.5;  // cosine from which two tangents run clearly the same or the opposite way

    struct Extent {
        SegmentPair least{2147483647, 2147483647}, most{-1, -1};
        double sense = 0.0;
        void add(const SegmentPair& pair, double cosine) {
            least = {std::min(least.i, pair.i), std::min(least.j, pair.j)};
            most = {std::max(most.i, pair.i), std::max(most.j, pair.j)};
            sense += cosine;
        }
    };

    std::size_t root(std::size_t k) {
        while (root_[k] != k) k = root_[k] = root_[root_[k]];
        return k;
    }

    /// Joins pairs that touch in the plane of their segment numbers (8 neighbours, of which 4 come before).
    template <class Rule>
    void join(const Rule& rule) {
        const auto link = [&](std::size_t a, std::size_t b) {
            if (!rule(a, b)) return;
            const std::size_t x = root(a), y = root(b);
            root_[std::max(x, y)] = std::min(x, y);
        };
        std::size_t before = 0;  // first pair of the row before that may touch
        for (std::size_t k = 1; k < pairs_.size(); ++k) {
            const auto [i, j] = pairs_[k];
            if (pairs_[k - 1] == SegmentPair{i, j - 1}) link(k - 1, k);
            while (pairs_[before] < SegmentPair{i - 1, j - 1}) ++before;
            for (std::size_t b = before; pairs_[b].i == i - 1 && pairs_[b].j <= j + 1; ++b) link(b, k);
        }
    }

    bool same_way(std::size_t a, std::size_t b) const {
        return mixed_[a] == 0 || (place_[a].sense < 0.0) == (place_[b].sense < 0.0);
    }

    std::pair<double, double> range_of_senses() const {
        double low = 1.0, high = -1.0;
        for (std::size_t k = 0; k < pairs_.size(); ++k)
            low = std::min(low, place_[k].sense), high = std::max(high, place_[k].sense);
        return {low, high};
    }
    /// Whether all pairs touch each other in the simplest way: those of a row are without gaps, and so are the rows, of which
    /// each touches the one before. What has gaps may yet be one zone, as `join` tells.
    bool in_one_piece() const {
        std::int32_t begin = pairs_.front().j, least = begin;  // of the row, and where it must reach to touch the one before
        for (std::size_t k = 1; k < pairs_.size(); ++k) {
            const auto [i, j] = pairs_[k];
            const auto [before_i, before_j] = pairs_[k - 1];
            if (i == before_i) {
                if (j != before_j + 1) return false;
                continue;
            }
            if (i != before_i + 1 || j > before_j + 1 || before_j < least) return false;
            least = begin - 1, begin = j;
        }
        return pairs_.back().j >= least;
    }

    /// Undoes the components that run clearly both ways, as where a fibre turns back along another, to be joined again
    /// by sense. A crossing near 90 degrees, whose sense is noise, stays whole. Returns whether there are any.
    bool separate_turns() {
        const std::size_t n = pairs_.size();
        std::vector<char> along(n, 0), against(n, 0);
        for (std::size_t k = 0; k < n; ++k) {
            if (place_[k].sense >= clearly) along[root(k)] = 1;
            if (place_[k].sense <= -clearly) against[root(k)] = 1;
        }
        mixed_.resize(n);
        for (std::size_t k = 0; k < n; ++k) mixed_[k] = along[root(k)] != 0 && against[root(k)] != 0 ? 1 : 0;
        bool any = false;
        for (std::size_t k = 0; k < n; ++k)
            if (mixed_[k] != 0) {
                root_[k] = k;
                any = true;
            }
        return any;
    }

    /// Takes a pair into its zone by its closest points.
    void take(std::size_t k, ProximityZone& zone) const {
        const PairPlace& closest = place_[k];
        const double s = (pairs_[k].i - first_i_) + closest.s, t = (pairs_[k].j - first_j_) + closest.t;
        if (zone.fibre_i < 0) zone = {fibre_i_, fibre_j_, s, s, t, t, s, t, std::sqrt(closest.squared)};
        if (closest.squared < zone.distance * zone.distance) {
            zone.closest_i = s;
            zone.closest_j = t;
            zone.distance = std::sqrt(closest.squared);
        }
        zone.a_i = std::min(zone.a_i, s);
        zone.b_i = std::max(zone.b_i, s);
        zone.a_j = std::min(zone.a_j, t);
        zone.b_j = std::max(zone.b_j, t);
    }

    /// Where a pair is at an end of its zone, the zone reaches as far as the two segments are near each other.
    void ask_for_ends(std::size_t k, const Extent& extent, std::size_t zone) {
        const auto [i, j] = pairs_[k];
        if (i == extent.least.i || i == extent.most.i) ask({records_ + i, records_ + j, zone, i - first_i_, true});
        if (j == extent.least.j || j == extent.most.j) ask({records_ + j, records_ + i, zone, j - first_j_, false});
    }

    struct End {
        const SegmentRecord *of, *other;
        std::size_t zone;
        std::int32_t number;  // of the segment on its fibre
        bool on_i;
    };
    void ask(const End& end) {
        end_[asked_++] = end;
        if (asked_ == FilterLanes::size) solve_ends();
    }
    void solve_ends() {
        if (asked_ == 0) return;
        const SegmentRecord *of[FilterLanes::size], *other[FilterLanes::size];
        for (int l = 0; l < FilterLanes::size; ++l) {
            const End& end = end_[l < asked_ ? l : 0];
            of[l] = end.of, other[l] = end.other;
        }
        lanes_.load(of, other, table_.reach());
        near_parts(lanes_);
        for (int l = 0; l < asked_; ++l) {
            ProximityZone& zone = zones_[end_[l].zone];
            const Part part{lanes_.s[l], lanes_.t[l]};
            end_[l].on_i ? part.add_to(end_[l].number, zone.a_i, zone.b_i) : part.add_to(end_[l].number, zone.a_j, zone.b_j);
        }
        asked_ = 0;
    }

    const SegmentTable& table_;
    const SegmentRecord* records_;
    std::vector<ProximityZone>& zones_;
    ClosedZoneMaker closed_{table_};
    std::span<const SegmentPair> pairs_;
    const PairPlace* place_ = nullptr;
    std::int32_t fibre_i_ = 0, fibre_j_ = 0, first_i_ = 0, first_j_ = 0;  // and their first segments
    std::vector<std::size_t> root_, zone_;
    std::vector<char> mixed_;
    std::vector<Extent> extent_;
    std::vector<std::size_t> against_;                          // zones along which the fibres run against each other
    std::vector<std::pair<std::size_t, std::size_t>> several_;  // first zone and number, of two fibres with several
    FilterLanes lanes_;
    End end_[FilterLanes::size];
    int asked_ = 0;
};

/// The close pairs of one fibre with those after it and itself, put in order by the other fibre and then by segment.
class PairsByFibre {
public:
    /// @param pairs  of the fibre, sorted
    std::span<const SegmentPair> sorted(const SegmentTable& table, std::span<const SegmentPair> pairs) {
        std::int32_t least = table.fibres(), most = 0;
        fibre_.resize(pairs.size());
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            fibre_[k] = table.fibre(pairs[k].j);
            least = std::min(least, fibre_[k]), most = std::max(most, fibre_[k]);
        }
        if (least == most) return pairs;
        sorted_.resize(pairs.size());
        const std::size_t range = core::at(most - least) + 1;
        if (range <= 8 * pairs.size()) {  // counted, if that is no more work than the pairs are
            place_.assign(range, 0);
            for (const std::int32_t f : fibre_) ++place_[core::at(f - least)];
            std::size_t sum = 0;
            for (std::size_t& place : place_) sum += std::exchange(place, sum);
            for (std::size_t k = 0; k < pairs.size(); ++k) sorted_[place_[core::at(fibre_[k] - least)]++] = pairs[k];
        } else {
            place_.resize(pairs.size());
            for (std::size_t k = 0; k < pairs.size(); ++k) place_[k] = core::at(fibre_[k]) << 32 | k;
            std::sort(place_.begin(), place_.end());
            for (std::size_t k = 0; k < pairs.size(); ++k) sorted_[k] = pairs[place_[k] & 0xffffffffU];
        }
        return sorted_;
    }

private:
    std::vector<std::int32_t> fibre_;
    std::vector<std::size_t> place_;
    std::vector<SegmentPair> sorted_;
};

/// Zones of the pairs of a table.
inline std::vector<ProximityZone> zones_of(const SegmentTable& table, std::span<const SegmentPair> pairs) {
    if (pairs.empty()) return {};
    const std::vector<SegmentRecord> records = table.records();
    constexpr Index together = 4;  // fibres of a block of the loop: fixed, so that nothing depends on the threads
    const Index fibres = table.fibres(), blocks = (fibres + together - 1) / together;
    std::vector<std::vector<ProximityZone>> part(core::at(blocks));
    const auto first_of = [&](Index fibre) {
        const std::int32_t segment = fibre < fibres ? table.first(static_cast<std::int32_t>(fibre)) : table.size();
        return std::lower_bound(pairs.begin(), pairs.end(), SegmentPair{segment, -1});
    };
    core::parallel_for<core::Share::turns>(blocks, [&](Index b) {
        ZoneMaker maker(table, records.data(), part[core::at(b)]);
        PairsByFibre by_fibre;
        std::vector<PairPlace> places;
        auto end = first_of(b * together);
        for (Index f = b * together; f < std::min(fibres, (b + 1) * together); ++f) {
            const auto begin = std::exchange(end, first_of(f + 1));
            const std::span<const SegmentPair> own = by_fibre.sorted(table, {begin, end});
            places.resize(own.size());
            locate(records.data(), own, table.reach(), places.data());
            for (std::size_t k = 0, last = 0; k < own.size(); k = last) {
                const std::int32_t end_of_fibre = table.first(table.fibre(own[k].j) + 1);
                for (last = k + 1; last < own.size() && own[last].j < end_of_fibre;) ++last;
                maker.append(own.subspan(k, last - k), places.data() + k);
            }
        }
        maker.finish();
    });
    std::vector<ProximityZone> zones;
    core::join(part, zones);
    return zones;
}

}  // namespace detail

/// Proximity zones of close pairs of segments: for two fibres, the pairs that touch each other (8 neighbours in the plane
/// of the two segment numbers) make one zone, split where the fibres turn from clearly along to clearly against each other
/// (60 degrees). Its intervals end where the axes part by the pair's threshold. Linear in the number of pairs.
/// @param pairs  sorted, without repeats, as `pairs` of a search returns them
/// @return sorted by fibre_i, fibre_j, a_i, a_j
inline std::vector<ProximityZone> zones_from_pairs(std::span<const Centreline> fibres, double reach,
                                                   const std::vector<SegmentPair>& pairs) {
    return detail::zones_of(detail::SegmentTable(fibres, reach), pairs);
}

namespace detail {

/// What a search in two halves owes beside them: own.build(table), then own.search(table).
template <class Own>
class InTwoHalves {
public:
    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) {
        const SegmentTable table(fibres, reach);
        return pairs_of(table);
    }
    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) {
        const SegmentTable table(fibres, reach);
        return zones_of(table, pairs_of(table));
    }

private:
    std::vector<SegmentPair> pairs_of(const SegmentTable& table) {
        Own& own = static_cast<Own&>(*this);
        own.build(table);
        return own.search(table);
    }
};

}  // namespace detail

}  // namespace fibrant::proximity

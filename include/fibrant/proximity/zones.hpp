// SPDX-License-Identifier: MIT
#pragma once
/// @file Joins close pairs of segments into proximity zones; the same function for every search.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/closed_zones.hpp>
#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
#include <numeric>
#include <utility>

namespace fibrant::proximity {
namespace detail {

/// Makes the zones of two fibres at a time; keeps its buffers from one to the next.
class ZoneMaker {
public:
    /// @param records  of all segments in order
    ZoneMaker(const SegmentTable& table, const SegmentRecord* records) : table_(table), records_(records) {}

    /// Appends the zones of two fibres.
    /// @param pairs   all of these two, sorted by segment
    /// @param places  of these
    void append(std::span<const SegmentPair> pairs, const PairPlace* places, std::vector<ProximityZone>& zones) {
        pairs_ = pairs, place_ = places;
        if (table_.centreline(table_.fibre(pairs.front().i)).closed || table_.centreline(table_.fibre(pairs.front().j)).closed)
            return closed_.append(pairs, places, zones);
        const std::size_t n = pairs_.size(), before = zones.size();
        if (n == 1) {
            Extent extent;
            extent.add(pairs_[0], place_[0].sense);
            measure(0, extent, zones.emplace_back());
            if (extent.sense < 0.0) std::swap(zones.back().a_j, zones.back().b_j);
            return;
        }
        root_.resize(n);
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        join([](std::size_t, std::size_t) { return true; });
        if (separate_turns()) join([this](std::size_t a, std::size_t b) { return same_way(a, b); });
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
        zones.resize(before + extent_.size());
        for (std::size_t k = 0; k < n; ++k) measure(k, extent_[zone_[k]], zones[before + zone_[k]]);
        for (std::size_t z = 0; z < extent_.size(); ++z)
            if (extent_[z].sense < 0.0) std::swap(zones[before + z].a_j, zones[before + z].b_j);
        sort_along(zones, before);
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

    /// Undoes the components that run clearly both ways, as where a fibre turns back along another, to be joined again
    /// by sense. A crossing near 90 degrees, whose sense is noise, stays whole. Returns whether there are any.
    bool separate_turns() {
        const std::size_t n = pairs_.size();
        double low = 1.0, high = -1.0;
        for (std::size_t k = 0; k < n; ++k) low = std::min(low, place_[k].sense), high = std::max(high, place_[k].sense);
        if (low > -clearly || high < clearly) return false;
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

    /// Takes a pair into its zone: the closest points, and the ends where the pair is at one.
    void measure(std::size_t k, const Extent& extent, ProximityZone& zone) const {
        const SegmentPair pair = pairs_[k];
        const PairPlace& closest = place_[k];
        const std::int32_t fibre_i = table_.fibre(pair.i), fibre_j = table_.fibre(pair.j);
        const double p = pair.i - table_.first(fibre_i), q = pair.j - table_.first(fibre_j);
        const double s = p + closest.s, t = q + closest.t;
        if (zone.fibre_i < 0) zone = {fibre_i, fibre_j, s, s, t, t, s, t, std::sqrt(closest.squared)};
        if (closest.squared < zone.distance * zone.distance) {
            zone.closest_i = s;
            zone.closest_j = t;
            zone.distance = std::sqrt(closest.squared);
        }
        zone.a_i = std::min(zone.a_i, s);
        zone.b_i = std::max(zone.b_i, s);
        zone.a_j = std::min(zone.a_j, t);
        zone.b_j = std::max(zone.b_j, t);
        const bool ends_i = pair.i == extent.least.i || pair.i == extent.most.i,
                   ends_j = pair.j == extent.least.j || pair.j == extent.most.j;
        if (!ends_i && !ends_j) return;
        const SegmentRecord &i = records_[pair.i], &j = records_[pair.j];
        const double threshold = i.half + j.half + table_.reach();
        if (ends_i) near_part(i, j, threshold).add_to(p, zone.a_i, zone.b_i);
        if (ends_j) near_part(j, i, threshold).add_to(q, zone.a_j, zone.b_j);
    }

    const SegmentTable& table_;
    const SegmentRecord* records_;
    ClosedZoneMaker closed_{table_};
    std::span<const SegmentPair> pairs_;
    const PairPlace* place_ = nullptr;
    std::vector<std::size_t> root_, zone_;
    std::vector<char> mixed_;
    std::vector<Extent> extent_;
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
        ZoneMaker maker(table, records.data());
        PairsByFibre by_fibre;
        std::vector<PairPlace> places;
        std::vector<ProximityZone>& zones = part[core::at(b)];
        auto end = first_of(b * together);
        for (Index f = b * together; f < std::min(fibres, (b + 1) * together); ++f) {
            const auto begin = std::exchange(end, first_of(f + 1));
            const std::span<const SegmentPair> own = by_fibre.sorted(table, {begin, end});
            places.resize(own.size());
            locate(records.data(), own, table.reach(), places.data());
            for (std::size_t k = 0, last = 0; k < own.size(); k = last) {
                for (last = k + 1; last < own.size() && table.fibre(own[last].j) == table.fibre(own[k].j);) ++last;
                maker.append(own.subspan(k, last - k), places.data() + k, zones);
            }
        }
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

// SPDX-License-Identifier: MIT
#pragma once
/// @file Joins close pairs of segments into proximity zones; the same function for every search.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/closed_zones.hpp>
#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace fibrant::proximity {
namespace detail {

/// Stable counting sort of pairs by key(pair) in [0, keys).
template <class Key>
std::vector<SegmentPair> counted_by(const std::vector<SegmentPair>& pairs, std::int32_t keys, const Key& key) {
    std::vector<std::size_t> place(core::at(keys) + 1, 0);
    for (const SegmentPair& pair : pairs) ++place[core::at(key(pair)) + 1];
    std::partial_sum(place.begin(), place.end(), place.begin());
    std::vector<SegmentPair> sorted(pairs.size());
    for (const SegmentPair& pair : pairs) sorted[place[core::at(key(pair))]++] = pair;
    return sorted;
}

/// Makes the zones of two fibres at a time; keeps its buffers from one to the next.
class ZoneMaker {
public:
    explicit ZoneMaker(const SegmentTable& table) : table_(table) {}

    /// Appends the zones of two fibres.
    /// @param pairs  all of these two, sorted by segment
    void append(std::span<const SegmentPair> pairs, std::vector<ProximityZone>& zones) {
        pairs_ = pairs;
        if (table_.centreline(table_.fibre(pairs.front().i)).closed || table_.centreline(table_.fibre(pairs.front().j)).closed)
            return closed_.append(pairs, zones);
        const std::size_t n = pairs_.size();
        closest_.resize(n);
        sense_.resize(n);
        root_.resize(n);
        SegmentRecord i{};
        for (std::size_t k = 0; k < n; ++k) {
            if (k == 0 || pairs_[k].i != pairs_[k - 1].i) i = table_.record(pairs_[k].i);
            const SegmentRecord j = table_.record(pairs_[k].j);
            closest_[k] = segment_distance(i.start - j.start, i.chord, j.chord);
            const double lengths = std::sqrt(dot(i.chord, i.chord) * dot(j.chord, j.chord));
            sense_[k] = lengths > 0.0 ? dot(i.chord, j.chord) / lengths : 0.0;
        }
        std::iota(root_.begin(), root_.end(), std::size_t{0});
        join([](std::size_t, std::size_t) { return true; });
        if (separate_turns()) join([this](std::size_t a, std::size_t b) { return same_way(a, b); });
        const std::size_t before = zones.size();
        zone_.assign(n, none);
        extent_.clear();
        for (std::size_t k = 0; k < n; ++k) {
            const std::size_t top = root(k);
            if (zone_[top] == none) {
                zone_[top] = extent_.size();
                extent_.push_back({});
            }
            zone_[k] = zone_[top];
            extent_[zone_[k]].add(pairs_[k], sense_[k]);
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

    bool same_way(std::size_t a, std::size_t b) const { return mixed_[a] == 0 || (sense_[a] < 0.0) == (sense_[b] < 0.0); }

    /// Undoes the components that run clearly both ways, as where a fibre turns back along another, to be joined again
    /// by sense. A crossing near 90 degrees, whose sense is noise, stays whole. Returns whether there are any.
    bool separate_turns() {
        const std::size_t n = pairs_.size();
        const auto [low, high] = std::minmax_element(sense_.begin(), sense_.end());
        if (*low > -clearly || *high < clearly) return false;
        std::vector<char> along(n, 0), against(n, 0);
        for (std::size_t k = 0; k < n; ++k) {
            if (sense_[k] >= clearly) along[root(k)] = 1;
            if (sense_[k] <= -clearly) against[root(k)] = 1;
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
        const SegmentDistance& closest = closest_[k];
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
        if (pair.i != extent.least.i && pair.i != extent.most.i && pair.j != extent.least.j && pair.j != extent.most.j) return;
        const SegmentRecord i = table_.record(pair.i), j = table_.record(pair.j);
        const double threshold = i.half + j.half + table_.reach();
        if (pair.i == extent.least.i) zone.a_i = p + extended(zone.a_i - p, 0.0, i, j, threshold);
        if (pair.i == extent.most.i) zone.b_i = p + extended(zone.b_i - p, 1.0, i, j, threshold);
        if (pair.j == extent.least.j) zone.a_j = q + extended(zone.a_j - q, 0.0, j, i, threshold);
        if (pair.j == extent.most.j) zone.b_j = q + extended(zone.b_j - q, 1.0, j, i, threshold);
    }

    const SegmentTable& table_;
    ClosedZoneMaker closed_{table_};
    std::span<const SegmentPair> pairs_;
    std::vector<SegmentDistance> closest_;
    std::vector<double> sense_;  // cosine of the two chords
    std::vector<std::size_t> root_, zone_;
    std::vector<char> mixed_;
    std::vector<Extent> extent_;
};

}  // namespace detail

/// Proximity zones of close pairs of segments: for two fibres, the pairs that touch each other (8 neighbours in the plane
/// of the two segment numbers) make one zone, split where the fibres turn from clearly along to clearly against each other
/// (60 degrees). Its intervals end where the axes part by the pair's threshold, found from outside to some 1/1024 segment.
/// Linear in the number of pairs.
/// @param pairs  sorted, without repeats, as `pairs` of a search returns them
/// @return sorted by fibre_i, fibre_j, a_i, a_j
inline std::vector<ProximityZone> zones_from_pairs(std::span<const Centreline> fibres, double reach,
                                                   const std::vector<SegmentPair>& pairs) {
    const detail::SegmentTable table(fibres, reach);
    // Stable sorts keep the order by segment inside each two fibres.
    std::vector<SegmentPair> sorted =
        detail::counted_by(pairs, table.fibres(), [&](const SegmentPair& pair) { return table.fibre(pair.j); });
    sorted = detail::counted_by(sorted, table.fibres(), [&](const SegmentPair& pair) { return table.fibre(pair.i); });
    std::vector<std::size_t> first{0};  // of the pairs of two fibres
    for (std::size_t k = 1; k < sorted.size(); ++k)
        if (table.fibre(sorted[k].i) != table.fibre(sorted[k - 1].i) || table.fibre(sorted[k].j) != table.fibre(sorted[k - 1].j))
            first.push_back(k);
    if (sorted.empty()) return {};
    first.push_back(sorted.size());
    constexpr std::size_t together = 64;  // a block of the loop: fixed, so that nothing depends on the threads
    const std::size_t twos = first.size() - 1, blocks = (twos + together - 1) / together;
    std::vector<std::vector<ProximityZone>> part(blocks);
    core::parallel_for<core::Share::turns>(static_cast<Index>(blocks), [&](Index b) {
        detail::ZoneMaker maker(table);
        for (std::size_t k = core::at(b) * together; k < std::min(twos, (core::at(b) + 1) * together); ++k)
            maker.append({sorted.data() + first[k], first[k + 1] - first[k]}, part[core::at(b)]);
    });
    std::vector<ProximityZone> zones;
    core::join(part, zones);
    return zones;
}

namespace detail {

/// What a search in two halves owes beside them: own.build(table), then own.search(table).
template <class Own>
class InTwoHalves {
public:
    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) {
        const SegmentTable table(fibres, reach);
        own().build(table);
        return own().search(table);
    }
    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }

private:
    Own& own() noexcept { return static_cast<Own&>(*this); }
};

}  // namespace detail

}  // namespace fibrant::proximity

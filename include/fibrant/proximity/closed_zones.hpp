// SPDX-License-Identifier: MIT
#pragma once
/// @file Proximity zones of closed fibres, in segment numbers that go on around them.

#include <fibrant/proximity/exact_filter.hpp>
#include <fibrant/proximity/near_part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::proximity::detail {

/// Makes the zones of two fibres of which one is closed, or of a closed one with itself.
///
/// The plane of the two segment numbers is wound up there: pairs that touch are followed from the first one on, and numbers go on
/// with them, so that a zone does not end where its fibre does. On one fibre (i, j) and (j, i) are the same pair. A zone that
/// comes back to its own start ends half-way around from where it began, with every pair in it once.
class ClosedZoneMaker {
public:
    explicit ClosedZoneMaker(const SegmentTable& table) : table_(table) {}

    /// Appends the zones of two fibres, by which of their pairs they begin with.
    /// @param pairs   all of these two, sorted by segment
    /// @param places  of these
    void append(std::span<const SegmentPair> pairs, const PairPlace* places, std::vector<ProximityZone>& zones) {
        pairs_ = pairs;
        const std::int32_t i = table_.fibre(pairs.front().i), j = table_.fibre(pairs.front().j);
        first_ = {table_.first(i), table_.first(j)};
        const auto period = [&](std::int32_t f) {
            return table_.centreline(f).closed ? table_.first(f + 1) - table_.first(f) : 0;
        };
        period_ = {period(i), period(j)};
        self_ = i == j;
        const std::size_t n = pairs.size();
        sense_.resize(n), mixed_.assign(n, 0);
        for (std::size_t k = 0; k < n; ++k) sense_[k] = places[k].sense;
        follow();
        if (separate_turns()) follow();
        std::vector<ProximityZone> own(core::at(zones_));
        extent_.assign(core::at(zones_), {});
        for (std::size_t k = 0; k < n; ++k) extent_[core::at(zone_[k])].add(place_[k], sense_[k]);
        for (std::size_t k = 0; k < n; ++k) measure(k, extent_[core::at(zone_[k])], own[core::at(zone_[k])]);
        for (std::size_t z = 0; z < own.size(); ++z) {
            own[z].fibre_i = i, own[z].fibre_j = j;
            if (extent_[z].sense < 0.0) std::swap(own[z].a_j, own[z].b_j);
            const double by_i = period_[0] > 0 ? -period_[0] * std::floor(own[z].a_i / period_[0]) : 0.0;
            const double by_j = period_[1] > 0 ? -period_[1] * std::floor(std::min(own[z].a_j, own[z].b_j) / period_[1]) : 0.0;
            own[z].a_i += by_i, own[z].b_i += by_i, own[z].closest_i += by_i;
            own[z].a_j += by_j, own[z].b_j += by_j, own[z].closest_j += by_j;
        }
        sort_along(own);
        for (const ProximityZone& zone : own) zones.push_back(zone);
    }

private:
    static constexpr double clearly = 0.5;  // as of ZoneMaker
    struct Place {
        std::int32_t i = 0, j = 0;
    };  // numbers on both fibres, from their first segments on and around
    struct Extent {
        Place least{2147483647, 2147483647}, most{-2147483647, -2147483647};
        double sense = 0.0;
        void add(const Place& place, double cosine) {
            least = {std::min(least.i, place.i), std::min(least.j, place.j)};
            most = {std::max(most.i, place.i), std::max(most.j, place.j)};
            sense += cosine;
        }
    };

    static std::int32_t wrapped(std::int32_t k, std::int32_t period) noexcept {
        if (period == 0) return k;
        const std::int32_t rest = k % period;
        return rest < 0 ? rest + period : rest;
    }
    /// The pair at a place, and whether it has the two segments the other way around.
    std::pair<std::size_t, bool> at(const Place& place) const {
        SegmentPair pair{first_[0] + wrapped(place.i, period_[0]), first_[1] + wrapped(place.j, period_[1])};
        const bool turned = self_ && pair.i > pair.j;
        if (turned) std::swap(pair.i, pair.j);
        const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        return {found != pairs_.end() && *found == pair ? static_cast<std::size_t>(found - pairs_.begin()) : pairs_.size(),
                turned};
    }

    /// Numbers the zones, and gives each pair its place.
    void follow() {
        const std::size_t n = pairs_.size();
        zone_.assign(n, -1), place_.resize(n), turned_.assign(n, 0);
        zones_ = 0;
        for (std::size_t start = 0; start < n; ++start) {
            if (zone_[start] >= 0) continue;
            queue_.assign(1, start);
            zone_[start] = zones_;
            place_[start] = {pairs_[start].i - first_[0], pairs_[start].j - first_[1]};
            for (std::size_t next = 0; next < queue_.size(); ++next) {
                const std::size_t k = queue_[next];
                for (std::int32_t di = -1; di <= 1; ++di)
                    for (std::int32_t dj = -1; dj <= 1; ++dj) {
                        const Place place{place_[k].i + di, place_[k].j + dj};
                        const auto [other, turned] = at(place);
                        if (other == n || zone_[other] >= 0 || !same_way(k, other)) continue;
                        zone_[other] = zones_, place_[other] = place, turned_[other] = turned ? 1 : 0;
                        queue_.push_back(other);
                    }
            }
            ++zones_;
        }
    }
    bool same_way(std::size_t a, std::size_t b) const { return mixed_[a] == 0 || (sense_[a] < 0.0) == (sense_[b] < 0.0); }

    /// Marks the zones that run clearly both ways; whether there are any.
    bool separate_turns() {
        std::vector<char> along(core::at(zones_), 0), against(core::at(zones_), 0);
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            if (sense_[k] >= clearly) along[core::at(zone_[k])] = 1;
            if (sense_[k] <= -clearly) against[core::at(zone_[k])] = 1;
        }
        bool any = false;
        for (std::size_t k = 0; k < pairs_.size(); ++k) {
            mixed_[k] = along[core::at(zone_[k])] != 0 && against[core::at(zone_[k])] != 0 ? 1 : 0;
            any = any || mixed_[k] != 0;
        }
        return any;
    }

    /// Takes a pair into its zone: the closest points, and the ends where the pair is at one.
    void measure(std::size_t k, const Extent& extent, ProximityZone& zone) const {
        const bool turned = turned_[k] != 0;
        const SegmentRecord i = table_.record(turned ? pairs_[k].j : pairs_[k].i),
                            j = table_.record(turned ? pairs_[k].i : pairs_[k].j);
        const SegmentDistance closest = segment_distance(i.start - j.start, i.chord, j.chord);
        const Place& place = place_[k];
        const double p = place.i, q = place.j, s = p + closest.s, t = q + closest.t;
        if (zone.fibre_i < 0) zone = {0, 0, s, s, t, t, s, t, std::sqrt(closest.squared)};
        if (closest.squared < zone.distance * zone.distance)
            zone.closest_i = s, zone.closest_j = t, zone.distance = std::sqrt(closest.squared);
        zone.a_i = std::min(zone.a_i, s), zone.b_i = std::max(zone.b_i, s);
        zone.a_j = std::min(zone.a_j, t), zone.b_j = std::max(zone.b_j, t);
        const double threshold = i.half + j.half + table_.reach();
        if (place.i == extent.least.i || place.i == extent.most.i) near_part(i, j, threshold).add_to(p, zone.a_i, zone.b_i);
        if (place.j == extent.least.j || place.j == extent.most.j) near_part(j, i, threshold).add_to(q, zone.a_j, zone.b_j);
    }

    const SegmentTable& table_;
    std::span<const SegmentPair> pairs_;
    std::array<std::int32_t, 2> first_{}, period_{};
    bool self_ = false;
    std::vector<double> sense_;  // cosine of the two chords
    std::vector<char> mixed_, turned_;
    std::vector<Place> place_;
    std::vector<std::int32_t> zone_;
    std::vector<std::size_t> queue_;
    std::vector<Extent> extent_;
    std::int32_t zones_ = 0;
};

}  // namespace fibrant::proximity::detail

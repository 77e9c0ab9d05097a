// SPDX-License-Identifier: MIT
#pragma once
/// @file What a search for close fibres is given and returns: centrelines, pairs of segments, proximity zones.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <compare>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace fibrant::proximity {

/// One fibre as a polyline with a round section. It does not own what it points to.
struct Centreline {
    std::span<const Vec3> points;  ///< vertices in order, at least 2 [length]
    double radius = core::unset;   ///< > 0 [length]
    /// Of each segment: bound of the curve's deviation from the chord, >= 0 [length]; empty means 0 everywhere. With
    /// x'' = x0 - 2 x1 + x2 constant over a quadratic element, a piece 1/n of it deviates by at most |x''| / (2 n^2).
    std::span<const double> inflation{};
    Index family = -1;  ///< fibres of the same family >= 0 never pair
    /// Segments of the fibre itself pair only if the arc between their closest ends exceeds this [length].
    double self_skip = std::numeric_limits<double>::infinity();
    bool closed = false;  ///< its last vertex is its first one: arcs and zones go on around it
};

/// Two close segments i < j, numbered from 0 over the fibres in order (the last vertex of a fibre starts none).
struct SegmentPair {
    std::int32_t i = 0, j = 0;
    friend auto operator<=>(const SegmentPair&, const SegmentPair&) = default;
};

/// Part of two fibres along which they are close: an interval of each, in vertex units of its polyline
/// (2.25 is a quarter of the way from vertex 2 to vertex 3). Around a closed fibre it may reach beyond the last vertex, or begin
/// before the first; a zone of a closed fibre with itself has either part first.
struct ProximityZone {
    Index fibre_i = -1, fibre_j = -1;     ///< fibre_i <= fibre_j
    double a_i = 0, b_i = 0;              ///< a_i <= b_i
    double a_j = 0, b_j = 0;              ///< a_j faces a_i and b_j faces b_i: b_j < a_j where the fibres run antiparallel
    double closest_i = 0, closest_j = 0;  ///< the closest two points of the zone
    double distance = 0;                  ///< there, between the axes [length]
    friend bool operator==(const ProximityZone&, const ProximityZone&) = default;
};

/// Sorts zones of one pair of fibres along both.
inline void sort_along(std::span<ProximityZone> zones) {
    std::sort(zones.begin(), zones.end(), [](const ProximityZone& a, const ProximityZone& b) {
        return std::tie(a.a_i, a.a_j, a.b_i, a.b_j) < std::tie(b.a_i, b.a_j, b.b_i, b.b_j);
    });
}

/// Finds every pair of segments whose axes are closer than
///     r_i + r_j + inflation_i + inflation_j + reach,
/// on different fibres (not of one family) or on one fibre by its `self_skip`, joined into zones.
///
/// Owed beyond the syntax, and checked by tests/proximity/search_contract.hpp: none is missed and none is added, the
/// zones are sorted by fibre_i, fibre_j, a_i, a_j, and neither depends on the policy or on the number of threads. Bad input
/// (a fibre of one vertex, a coordinate that is not finite) throws std::invalid_argument with fibre and vertex.
/// `find` may reuse buffers of the search: one search object serves one thread at a time.
template <class S>
concept ProximitySearch = core::Policy<S> && requires(S search, std::span<const Centreline> fibres, double reach) {
    { search.find(fibres, reach) } -> std::same_as<std::vector<ProximityZone>>;
    { search.pairs(fibres, reach) } -> std::same_as<std::vector<SegmentPair>>;  // sorted, without repeats
};

}  // namespace fibrant::proximity

// SPDX-License-Identifier: MIT
#pragma once
/// @file What every proximity search owes, as one function.

#include "scenes.hpp"

#include <fibrant/proximity/brute_search.hpp>

#include <doctest/doctest.h>

#include <tuple>

namespace fibrant::test {

/// Checks what a search owes: the pairs and zones of brute force, in order.
/// @param expected  pairs by brute force
template <proximity::ProximitySearch Search>
void check_search(Search& search, const FibreSet& set, const std::vector<proximity::SegmentPair>& expected) {
    CAPTURE(set.name);
    const std::vector<proximity::Centreline> lines = set.centrelines();
    const auto found = search.pairs(lines, set.reach);
    CHECK(found.size() == expected.size());
    CHECK(found == expected);
    const auto zones = search.find(lines, set.reach);
    CHECK(zones == proximity::zones_from_pairs(lines, set.reach, expected));
    CHECK(std::ranges::is_sorted(zones, [](const auto& a, const auto& b) {
        return std::tie(a.fibre_i, a.fibre_j, a.a_i, a.a_j) < std::tie(b.fibre_i, b.fibre_j, b.a_i, b.a_j);
    }));
    for (const auto& zone : zones) {
        CHECK(zone.fibre_i <= zone.fibre_j);
        CHECK(zone.a_i <= zone.closest_i);
        CHECK(zone.closest_i <= zone.b_i);
        CHECK(std::min(zone.a_j, zone.b_j) <= zone.closest_j);
        CHECK(zone.closest_j <= std::max(zone.a_j, zone.b_j));
    }
}

}  // namespace fibrant::test

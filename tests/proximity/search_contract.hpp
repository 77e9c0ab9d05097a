// SPDX-License-Identifier: MIT
#pragma once
/// @file What every proximity search owes, as one function.

#include "scenes.hpp"

#include <fibrant/proximity/brute_search.hpp>

#include <doctest/doctest.h>

namespace fibrant::test {

/// Global number of a fibre's first segment.
inline Index first_segment(const FibreSet& set, Index fibre) {
    Index first = 0;
    for (Index f = 0; f < fibre; ++f) first += core::count(set.points[core::at(f)]) - 1;
    return first;
}

/// Pairs and zones equal those of brute force; every close pair has its closest points in a zone of its fibres.
template <proximity::ProximitySearch Search>
void check_search(Search& search, const FibreSet& set) {
    CAPTURE(set.name);
    const std::vector<proximity::Centreline> lines = set.centrelines();
    proximity::BruteSearch brute;
    const auto expected = brute.pairs(lines, set.reach);
    const auto found = search.pairs(lines, set.reach);
    CHECK(found.size() == expected.size());
    CHECK(found == expected);
    const auto zones = search.find(lines, set.reach);
    CHECK(zones == brute.find(lines, set.reach));
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

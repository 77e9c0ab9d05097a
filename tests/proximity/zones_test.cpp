// SPDX-License-Identifier: MIT
#include "scenes.hpp"

#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace zones_test {

using namespace fibrant::proximity;
using fibrant::test::FibreSet;

std::vector<Vec3> straight(const Vec3& from, const Vec3& to, int segments) {
    std::vector<Vec3> line;
    for (int k = 0; k <= segments; ++k) line.push_back(from + (to - from) * (static_cast<double>(k) / segments));
    return line;
}

std::vector<ProximityZone> zones_of(const FibreSet& set) { return BruteSearch{}.find(set.centrelines(), set.reach); }

TEST_CASE("two fibres that cross make one zone, which ends where their axes part by the threshold") {
    for (const int segments : {1, 2, 7, 40, 101}) {
        CAPTURE(segments);
        FibreSet set{.name = "crossing", .reach = 0.1};
        set.add(straight({-1, 0, 0}, {1, 0, 0}, segments), 0.1);
        set.add(straight({0.3, -1, 0.2}, {0.3, 1, 0.2}, 5), 0.1);
        const auto zones = zones_of(set);
        REQUIRE(zones.size() == 1);
        const ProximityZone& zone = zones[0];
        CHECK(zone.distance == test::near(0.2, 1e-12));
        CHECK(2.0 * zone.closest_i / segments - 1.0 == test::near(0.3, 1e-12));
        CHECK(std::abs(2.0 * zone.closest_j / 5 - 1.0) < 1e-15);
        // Points of the first axis within 0.3 of the second, which is 0.2 above: known from outside, to 1/1024 segment.
        const double half = std::sqrt(0.3 * 0.3 - 0.2 * 0.2), known = 2.0 / segments / 1024.0;
        const double a = 2.0 * zone.a_i / segments - 1.0, b = 2.0 * zone.b_i / segments - 1.0;
        CHECK(a <= 0.3 - half + 1e-12);
        CHECK(a >= 0.3 - half - known);
        CHECK(b >= 0.3 + half - 1e-12);
        CHECK(b <= 0.3 + half + known);
    }
}

TEST_CASE("a fibre that ends before it crosses another one is near from its end on, whichever end that is") {
    for (const int segments : {1, 7})
        for (const bool last : {true, false}) {
            CAPTURE(segments);
            CAPTURE(last);
            FibreSet set{.name = "tee", .reach = 0.1};
            set.add(straight({-1, 0, 0}, {1, 0, 0}, segments), 0.1);
            const Vec3 far(0.3, -1, 0.2), end(0.3, -0.1, 0.2);
            set.add(straight(last ? far : end, last ? end : far, 5), 0.1);
            const auto zones = zones_of(set);
            REQUIRE(zones.size() == 1);
            // Within 0.3 of that end, which is 0.1 beside the axis and 0.2 above it.
            const double half = std::sqrt(0.3 * 0.3 - 0.2 * 0.2 - 0.1 * 0.1), known = 2.0 / segments / 1024.0;
            const double a = 2.0 * zones[0].a_i / segments - 1.0, b = 2.0 * zones[0].b_i / segments - 1.0;
            CHECK(a <= 0.3 - half + 1e-12);
            CHECK(a >= 0.3 - half - known);
            CHECK(b >= 0.3 + half - 1e-12);
            CHECK(b <= 0.3 + half + known);
        }
}

TEST_CASE("fibres side by side make one zone whose ends face each other, whichever way they run") {
    FibreSet set{.name = "parallel", .reach = 0.01};
    set.add(straight({0, 0, 0}, {2, 0, 0}, 20), 0.1);
    set.add(straight({1, 0.2, 0}, {4, 0.2, 0}, 30), 0.1);
    const auto along = zones_of(set);
    REQUIRE(along.size() == 1);
    // The second begins over the middle of the first: faced from 1 - sqrt(0.21^2 - 0.2^2) on.
    CHECK(along[0].a_i == test::near(10.0 - 0.640312 / 1.0, 0.001));
    CHECK(along[0].b_i == 20.0);
    CHECK(along[0].a_j == 0.0);
    CHECK(along[0].b_j == test::near(10.0 + 0.640312, 0.001));
    std::ranges::reverse(set.points[1]);
    const auto against = zones_of(set);
    REQUIRE(against.size() == 1);
    CHECK(against[0].a_i == along[0].a_i);
    CHECK(against[0].b_i == along[0].b_i);
    CHECK(against[0].a_j == 30.0);
    CHECK(against[0].b_j == test::near(30.0 - along[0].b_j, 1e-3));
    CHECK(against[0].b_j < against[0].a_j);
}

TEST_CASE("a fibre that turns back along another makes one zone for each way") {
    FibreSet set{.name = "hairpin over a straight fibre", .reach = 0.05};
    set.add(straight({0, 0, 0}, {3, 0, 0}, 30), 0.1);
    std::vector<Vec3> hairpin = straight({0, 0.05, 0.2}, {2, 0.05, 0.2}, 20);
    const auto back = straight({2, -0.05, 0.2}, {0, -0.05, 0.2}, 20);
    hairpin.insert(hairpin.end(), back.begin(), back.end());
    set.add(hairpin, 0.1);
    const auto zones = zones_of(set);
    REQUIRE(zones.size() == 2);
    // One of each sense, each over the whole limb, and the zones share no pair: the turn stands between them.
    CHECK((zones[0].a_j < zones[0].b_j) != (zones[1].a_j < zones[1].b_j));
    for (const auto& zone : zones) {
        CHECK(zone.a_i == 0.0);
        CHECK(zone.b_i == test::near(20.0, 0.1));
        CHECK(std::min(zone.a_j, zone.b_j) == test::near(zone.a_j < zone.b_j ? 0.0 : 20.5, 0.05));
    }
}

TEST_CASE("a right crossing stays one zone although the sense of its fibres is noise") {
    std::mt19937 random(3);
    for (int trial = 0; trial < 50; ++trial) {
        FibreSet set{.name = "wavy crossing", .reach = 0.2};
        std::vector<Vec3> a = straight({-1, 0, 0}, {1, 0, 0}, 60), b = straight({0, -1, 0.2}, {0, 1, 0.2}, 60);
        for (Vec3& x : a) x += 0.004 * test::uniform_vector(random);
        for (Vec3& x : b) x += 0.004 * test::uniform_vector(random);
        set.add(a, 0.1);
        set.add(b, 0.1);
        CHECK(zones_of(set).size() == 1);
    }
}

TEST_CASE("fibres that meet twice make two zones") {
    FibreSet set{.name = "a wave over a straight fibre", .reach = 0.02};
    std::vector<Vec3> wave;
    for (int k = 0; k <= 80; ++k) wave.push_back({0.05 * k, 0.0, 0.6 - 0.4 * std::cos(2.0 * std::numbers::pi * (k - 20) / 40.0)});
    set.add(straight({0, 0, 0}, {4, 0, 0}, 80), 0.1);
    set.add(wave, 0.1);
    const auto zones = zones_of(set);
    REQUIRE(zones.size() == 2);
    CHECK(zones[0].closest_j == test::near(20.0, 1e-12));
    CHECK(zones[1].closest_j == test::near(60.0, 1e-12));
    CHECK(zones[0].distance == test::near(0.2, 1e-12));
    CHECK(zones[0].b_i < zones[1].a_i);
}

TEST_CASE("pairs that touch by a corner alone in the plane of their segment numbers are one zone, whichever way fibres run") {
    // Two zigzags, one over the other, that cross in the middles of their segments: where one has its node the other's is too
    // far.
    std::vector<Vec3> below, above;
    for (int k = 0; k <= 12; ++k) {
        const double aside = k % 2 == 0 ? 0.1 : -0.1;
        below.push_back({1.0 * k, aside, 0.0}), above.push_back({1.0 * k, -aside, 0.2});
    }
    for (const bool against : {false, true}) {
        FibreSet set{.name = "zigzag", .reach = 0.02};
        set.add(below, 0.1), set.add(above, 0.1);
        CHECK(BruteSearch{}.pairs(set.centrelines(), set.reach).size() == 12);
        CHECK(zones_of(set).size() == 1);
        if (!against) std::ranges::reverse(above);
    }
}

TEST_CASE("pairs are one zone if they touch in the plane of their segment numbers, be there gaps or not") {
    FibreSet set{.name = "side by side", .reach = 0.1};
    set.add(straight({0, 0, 0}, {9, 0, 0}, 9), 0.1);
    set.add(straight({0, 0.2, 0}, {9, 0.2, 0}, 9), 0.1);
    const auto zones = [&](const std::vector<SegmentPair>& pairs) {
        return zones_from_pairs(set.centrelines(), set.reach, pairs).size();
    };
    CHECK(zones({{0, 14}, {0, 15}, {1, 13}}) == 1);
    CHECK(zones({{0, 14}, {0, 15}, {1, 12}}) == 2);  // the second row ends before the first one
    CHECK(zones({{0, 14}, {0, 15}, {1, 12}, {2, 12}}) == 2);
    CHECK(zones({{0, 14}, {0, 15}, {1, 11}, {1, 12}, {1, 13}}) == 1);  // and here reaches it
    CHECK(zones({{0, 14}, {0, 15}, {1, 16}}) == 1);
    CHECK(zones({{0, 14}, {0, 15}, {1, 17}}) == 2);
    CHECK(zones({{0, 14}, {0, 16}}) == 2);
    CHECK(zones({{0, 14}, {0, 16}, {1, 15}}) == 1);  // joined by the row after
    CHECK(zones({{0, 14}, {2, 14}}) == 2);
    CHECK(zones({{0, 14}, {1, 15}, {2, 13}}) == 2);
}

TEST_CASE("every close pair has its closest points in a zone of its two fibres, and every zone has a pair") {
    for (const FibreSet& set : test::search_cases()) {
        CAPTURE(set.name);
        const auto lines = set.centrelines();
        GridSearch search;
        const auto pairs = search.pairs(lines, set.reach);
        const auto zones = search.find(lines, set.reach);
        const detail::SegmentTable table(lines, set.reach);
        std::vector<int> pairs_of(zones.size(), 0);
        int outside = 0;
        for (const SegmentPair& pair : pairs) {
            const auto i = table.record(pair.i), j = table.record(pair.j);
            const SegmentDistance closest = detail::segment_distance(i.start - j.start, i.chord, j.chord);
            const double p = pair.i - table.first(table.fibre(pair.i)) + closest.s;
            const double q = pair.j - table.first(table.fibre(pair.j)) + closest.t;
            bool inside = false;
            for (std::size_t z = 0; z < zones.size(); ++z) {
                const ProximityZone& zone = zones[z];
                if (zone.fibre_i != table.fibre(pair.i) || zone.fibre_j != table.fibre(pair.j)) continue;
                if (p < zone.a_i || p > zone.b_i || q < std::min(zone.a_j, zone.b_j) || q > std::max(zone.a_j, zone.b_j))
                    continue;
                inside = true;
                ++pairs_of[z];
            }
            outside += inside ? 0 : 1;
        }
        CHECK(outside == 0);
        CHECK(std::ranges::count(pairs_of, 0) == 0);
    }
}

}  // namespace zones_test

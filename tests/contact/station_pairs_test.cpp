// SPDX-License-Identifier: MIT
#include "two_fibres.hpp"

#include <fibrant/contact/station_pairs.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace station_pairs_test {

using contact::ContactSpacing;
using contact::StationPair;
using test::curved_fibre;
using test::distance;
using test::Mesh;
using test::mesh_of;
using test::straight_fibre;
using test::zone_of;

const double r = 0.02;
const ContactSpacing spacing;

std::vector<StationPair> pairs_of(const Mesh& mesh, const proximity::ProximityZone& z, bool crossing) {
    std::vector<StationPair> pairs;
    contact::station_pairs(mesh, mesh.rest_state(), z, crossing, spacing, pairs);
    return pairs;
}

TEST_CASE("near-parallel fibres are paired across their mean line, at equal distances that do not move with the zone's ends") {
    // 3 degrees apart, with as many elements that do not face each other
    const double angle = 3.0 * std::numbers::pi / 180.0;
    const Vec3 other(std::cos(angle), std::sin(angle), 0.0);
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10),
                               straight_fibre(Vec3(0.03, 0, 0.04) - other, Vec3(0.03, 0, 0.04) + other, r, 10)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(2, 8, 2, 8), false);
    REQUIRE(pairs.size() == 13);  // two an element, and one where the last begins
    const Vec3 mean = (Vec3::UnitX() + other).normalized();
    double last = 0.0, length = 0.0;
    for (const StationPair& pair : pairs) {
        CHECK_FALSE(pair.crossing);
        CHECK_FALSE(pair.end_i);
        CHECK_FALSE(pair.end_j);
        const Vec3 x_i = mesh.position(mesh.rest_state(), 0, pair.u_i), x_j = mesh.position(mesh.rest_state(), 1, pair.u_j);
        CHECK(std::abs((x_j - x_i).dot(mean)) < 1e-12);
        if (last != 0.0) CHECK(pair.u_i - last == test::near(0.5, 1e-9));
        last = pair.u_i, length += pair.length;
    }
    CHECK(length == test::near(6.5 * 0.2, 1e-12));
    const std::vector<StationPair> shorter = pairs_of(mesh, zone_of(2.3, 7.6, 2.3, 7.6), false);
    REQUIRE(shorter.size() == 11);
    for (std::size_t k = 0; k < shorter.size(); ++k) CHECK(std::abs(shorter[k].u_i - pairs[k + 1].u_i) < 1e-9);
}

TEST_CASE("fibres that slant have more pairs, so that none of their depth is missed") {
    // Closest half way between two stations, where half an element's spacing misses 0.002, 0.008, 0.04 and 0.3 radii.
    const auto missed = [](double degrees, const ContactSpacing& used) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const Vec3 along(std::cos(angle), std::sin(angle), 0.0), middle(0.05, 0.0, 0.039);
        const Mesh mesh = mesh_of(
            {straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre(middle - 1.05 * along, middle + 0.95 * along, r, 10)});
        std::vector<StationPair> pairs;
        contact::station_pairs(mesh, mesh.rest_state(), zone_of(4.3, 6.2, 4.3, 6.2), false, used, pairs);
        double least = 1e300;
        for (const StationPair& pair : pairs) least = std::min(least, distance(mesh, pair.u_i, pair.u_j));
        return std::pair((least - 0.039) / r, pairs.size());
    };
    ContactSpacing even = spacing;
    even.largest_unseen = 1e3;
    const double bound = spacing.largest_unseen * 1.1;  // a depth of x^2 / (2 * 0.039) is missed
    for (const double degrees : {2.0, 4.0, 9.0, 25.0}) {
        CAPTURE(degrees);
        const auto [depth, count] = missed(degrees, spacing);
        CHECK(depth <= bound);
        CHECK(count == (degrees < 3.0 ? 4u : degrees < 5.0 ? 7u : degrees < 10.0 ? 15u : 31u));
        if (degrees > 5.0) CHECK(missed(degrees, even).first > 2.0 * bound);
    }
}

TEST_CASE("fibres that bend towards each other have more pairs where they do, and those that bend together have not") {
    // Relative curvature k over half an element, 0.1: a depth of k 0.1^2 / 8 goes unseen, 0.0016 and 0.012 radii.
    for (const double curvature : {0.025, 0.2}) {
        CAPTURE(curvature);
        const auto count = [&](double below, double above) {
            const Mesh mesh = mesh_of(
                {curved_fibre([&](double t) { return Vec3(2.0 * t, 0.0, 0.5 * below * (2.0 * t - 1.0) * (2.0 * t - 1.0)); }, r,
                              10),
                 curved_fibre(
                     [&](double t) { return Vec3(2.0 * t, 0.0, 2.0 * r + 0.5 * above * (2.0 * t - 1.0) * (2.0 * t - 1.0)); }, r,
                     10)});
            return pairs_of(mesh, zone_of(4, 6, 4, 6), false).size();
        };
        const std::size_t halved = curvature < 0.1 ? 5 : 9;
        CHECK(count(0.0, curvature) == halved);
        CHECK(count(-0.5 * curvature, 0.5 * curvature) == halved);
        CHECK(count(curvature, curvature) == 5);
        CHECK(count(curvature, 0.0) == 5);  // away from each other: closest at the stations
    }
}

TEST_CASE("a spacing that was halved stays so, between the same stations, when the fibres have straightened") {
    const auto pair_of = [](double curvature) {
        return mesh_of({curved_fibre([](double t) { return Vec3(2.0 * t, 0.0, 0.0); }, r, 10),
                        curved_fibre(
                            [&](double t) {
                                return Vec3(2.0 * t, 0.0, 2.0 * r + curvature * (t > 0.5 ? 2.0 * (t - 0.5) * (t - 0.5) : 0.0));
                            },
                            r, 10)});
    };
    const Mesh bent = pair_of(0.2), straight = pair_of(0.0);
    const std::vector<StationPair> halved = pairs_of(bent, zone_of(4, 6, 4, 6), false);
    REQUIRE(halved.size() == 7);  // two more than for straight fibres, both beyond the middle
    std::vector<StationPair> again;
    contact::station_pairs(straight, straight.rest_state(), zone_of(4, 6, 4, 6), false, spacing, again, [&](const auto& see) {
        for (const StationPair& pair : halved) see(pair.u_i, pair.u_j);
    });
    REQUIRE(again.size() == halved.size());
    for (std::size_t k = 0; k < again.size(); ++k)
        CHECK(std::abs(again[k].u_i - halved[k].u_i) < 0.02);  // the bent fibre has longer elements
    CHECK(pairs_of(straight, zone_of(4, 6, 4, 6), false).size() == 5);
}

TEST_CASE("a fibre that runs the other way is paired at the same places") {
    const auto one = curved_fibre([](double t) { return Vec3(t, 0.0, 0.1 * t * t); }, r, 8);
    const auto along = curved_fibre([](double t) { return Vec3(t, 0.041, 0.1 * t * t); }, r, 8);
    const auto against = curved_fibre([](double t) { return Vec3(1.0 - t, 0.041, 0.1 * (1.0 - t) * (1.0 - t)); }, r, 8);
    const Mesh same = mesh_of({one, along}), opposite = mesh_of({one, against});
    const auto p = pairs_of(same, zone_of(1, 6, 1, 6), false), q = pairs_of(opposite, zone_of(1, 6, 7, 2), false);
    REQUIRE(p.size() == q.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
        // nodes at equal arc length of both, by quadrature to 1e-9
        CHECK(std::abs(p[k].u_i - q[k].u_i) < 1e-7);
        CHECK(std::abs(p[k].u_j - (8.0 - q[k].u_j)) < 1e-7);
    }
}

TEST_CASE("a short zone has one pair, and a crossing exactly one at the closest points") {
    const Mesh parallel =
        mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-1, 0, 0.04}, {1, 0, 0.04}, r, 10)});
    CHECK(pairs_of(parallel, zone_of(4.0, 4.1, 4.0, 4.1), false).size() == 1);
    const Mesh crossing =
        mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({0.1, -1, 0.04}, {0.1, 1, 0.04}, r, 10)});
    const std::vector<StationPair> pairs = pairs_of(crossing, zone_of(4, 7, 3, 6), true);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].crossing);
    CHECK(pairs[0].u_i == test::near(5.5, 1e-12));
    CHECK(pairs[0].u_j == test::near(5.0, 1e-12));
    CHECK_FALSE(pairs[0].end_i);
    CHECK_FALSE(pairs[0].end_j);
}

TEST_CASE("a zone that reaches beyond a fibre's end has one pair in its last section, and no cap beside another's side") {
    // The second fibre begins half way along the first.
    const Mesh mesh =
        mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({0.05, 0, 0.04}, {1.05, 0, 0.04}, r, 5)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(3, 9, 0, 4), false);
    int ends = 0;
    for (const StationPair& pair : pairs) {
        CHECK_FALSE(pair.end_j);
        CHECK_FALSE(pair.end_i);
        if (pair.u_j > 0.0) continue;
        ++ends;
        CHECK(pair.u_i == test::near(5.25, 1e-12));
    }
    CHECK(ends == 1);
}

TEST_CASE("splayed fibres have a pair in their last section, where they are closest") {
    // 3 degrees apart and closest where they begin; the second of the other direction in the second case
    const double angle = 3.0 * std::numbers::pi / 180.0;
    const Vec3 far_end(2.0 * std::cos(angle), 0.0, 0.04 + 2.0 * std::sin(angle));
    for (const bool against : {false, true}) {
        const Vec3 near_end(0, 0, 0.04);
        const Mesh mesh =
            mesh_of({straight_fibre({0, 0, 0}, {2, 0, 0}, r, 10),
                     against ? straight_fibre(far_end, near_end, r, 10) : straight_fibre(near_end, far_end, r, 10)});
        const double start = against ? 10.0 : 0.0;
        const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(0, 4, start, against ? 6 : 4), false);
        REQUIRE(pairs.size() == 9);  // two an element, and one where the zone ends
        // in the last section of both, but for the angle times the distance
        CHECK(pairs[0].u_i < 0.01);
        CHECK(std::abs(pairs[0].u_j - start) < 0.01);
        CHECK_FALSE(pairs[0].end_i);
        CHECK_FALSE(pairs[0].end_j);
        for (std::size_t k = 1; k < pairs.size(); ++k)
            CHECK(distance(mesh, pairs[k].u_i, pairs[k].u_j) > distance(mesh, pairs[k - 1].u_i, pairs[k - 1].u_j));
    }
}

TEST_CASE("a kink between two elements that is turned to the other fibre is seen wherever it lies between the stations") {
    // Straight elements that meet at 0.02 rad, which touch the other fibre with that node alone, somewhere along a spacing.
    const double angle = 0.02;
    for (int shift = 0; shift < 20; ++shift) {
        const double along = 0.2 * 0.5 * shift / 20.0;
        const auto roof = [=](double t) { return Vec3(-1.0 + along + 2.0 * t, 0.0, 2.0 * r + angle * std::abs(t - 0.5)); };
        const Mesh mesh = mesh_of({straight_fibre({-1.5, 0, 0}, {1.5, 0, 0}, r, 15), curved_fibre(roof, r, 10)});
        for (const double ahead : {0.0, 5.0 * along}) {  // of the zone's ends on the first fibre, in elements
            double least = 1e300;
            for (const StationPair& pair : pairs_of(mesh, zone_of(2.5 + ahead, 12.5 + ahead, 0.0, 10.0), false))
                least = std::min(least, distance(mesh, pair.u_i, pair.u_j));
            CHECK(least < (2.0 + spacing.largest_unseen) * r);
        }
    }
}

TEST_CASE("all kinks between two stations are seen where stations are further apart than nodes") {
    // As above with 2.5 elements a station: the roof's own node and one or two more lie between two of them. Three halvings leave
    // 0.31 elements.
    const double angle = 0.02, spacing_length = 2.5 * 0.2, left = 0.25 * angle * spacing_length / 8.0;
    ContactSpacing wide = spacing;
    wide.points_per_element = 0.4;
    for (int shift = 0; shift < 20; ++shift) {
        const double along = 0.2 * shift / 20.0;
        const auto roof = [=](double t) { return Vec3(-1.0 + along + 2.0 * t, 0.0, 2.0 * r + angle * std::abs(t - 0.5)); };
        const Mesh mesh = mesh_of({straight_fibre({-1.5, 0, 0}, {1.5, 0, 0}, r, 15), curved_fibre(roof, r, 10)});
        std::vector<StationPair> pairs;
        contact::station_pairs(mesh, mesh.rest_state(), zone_of(2.5 + 5.0 * along, 12.5 + 5.0 * along, 0.0, 10.0), false, wide,
                               pairs);
        double least = 1e300;
        for (const StationPair& pair : pairs) least = std::min(least, distance(mesh, pair.u_i, pair.u_j));
        CHECK(least < 2.0 * r + left);
    }
}

TEST_CASE("a section that is thicker than those beside it is seen wherever it lies between the stations") {
    // Straight fibres side by side, one of them 3 % thicker towards the other at one node: at the middle of an element and where
    // two meet. Half an element's spacing misses up to 0.0075 and 0.023 radii of it.
    const double swell = 0.03;
    int most = 0, least = 1000;
    for (const bool of_first : {true, false})
        for (const Index node : {13, 14})
            for (int shift = 0; shift < 20; ++shift) {
                CAPTURE(of_first);
                CAPTURE(node);
                CAPTURE(shift);
                const double along = 0.2 * 0.5 * shift / 20.0;
                const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10),
                                           straight_fibre({-1.2 + along, 0, 2.0 * r}, {1.2 + along, 0, 2.0 * r}, r, 12)});
                Vector state = mesh.rest_state();
                for (const Index vector : {1, 2}) {
                    Vec3 director = state.segment<3>(3 * (mesh.fibre(of_first ? 0 : 1).first_vector + 3 * node + vector));
                    director.z() *= 1.0 + swell;
                    state.segment<3>(3 * (mesh.fibre(of_first ? 0 : 1).first_vector + 3 * node + vector)) = director;
                }
                const auto extent = [&](Index fibre, double u) {
                    const auto [g_1, g_2] = mesh.directors(state, fibre, u);
                    return mesh.fibre(fibre).section.extent(g_1, g_2, Vec3::UnitZ());
                };
                std::vector<StationPair> pairs;
                contact::station_pairs(mesh, state, zone_of(1.0, 9.0, 2.0 - 5.0 * along, 10.0 - 5.0 * along), false, spacing,
                                       pairs);
                double seen = 0.0, there = 0.0;
                for (const StationPair& pair : pairs) seen = std::max(seen, extent(0, pair.u_i) + extent(1, pair.u_j) - 2.0 * r);
                for (int k = 0; k <= 8000; ++k)
                    there = std::max(there, extent(0, 1.0 + 0.001 * k) + extent(1, 2.0 - 5.0 * along + 0.001 * k) - 2.0 * r);
                CHECK(there == test::near(swell * r, 1e-3));  // a sample is at most 0.0005 elements from the swelling
                CHECK(seen > there - spacing.largest_unseen * r);
                most = std::max(most, static_cast<int>(pairs.size())), least = std::min(least, static_cast<int>(pairs.size()));
            }
    CHECK(least >= 16);  // two an element, ...
    CHECK(most <=
          17 + 2 * 7);  // ... one where the last ends, and the rest where sections change: at most two spacings in eight parts
}

TEST_CASE("where a fibre ends, its last section has no deeper contact than its pairs know of, wherever its stations stand") {
    // 15 degrees towards the first fibre, and touching it where it ends; it begins a little later each time, over a whole
    // spacing.
    const double angle = 15.0 * std::numbers::pi / 180.0, length = 1.0;
    for (int shift = 0; shift < 40; ++shift) {
        const Vec3 end(0.7 + 0.2 * 0.5 * shift / 40.0, 0.0, 2.0 * r);
        const Vec3 start = end + length * Vec3(-std::cos(angle), 0.0, std::sin(angle));
        const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre(start, end, r, 5)});
        const double last = (end.x() + 1.0) / 0.2;
        double least = 1e300;
        for (const StationPair& pair : pairs_of(mesh, zone_of(last - 2.0, last + 0.1, 3.0, 5.0), false))
            least = std::min(least,
                             std::cos(0.5 * angle) * distance(mesh, pair.u_i, pair.u_j));  // in the plane across their mean line
        CHECK(least <= (2.0 + spacing.largest_unseen) * r);
    }
}

TEST_CASE("where one fibre ends before the other, the pair is in the last section of that one") {
    // The second begins 0.06 and ends 0.05 inside the first: 0.3 and 0.25 elements of it.
    const Mesh mesh =
        mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-0.94, 0, 0.04}, {0.95, 0, 0.04}, r, 9)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(0.2, 9.8, 0, 9), false);
    for (const bool last : {false, true}) {
        const StationPair& pair = last ? pairs.back() : pairs.front();
        CHECK(pair.u_j == (last ? 9.0 : 0.0));
        CHECK(pair.u_i == test::near(last ? 9.75 : 0.3, 1e-12));
        CHECK_FALSE(pair.end_j);
    }
    CHECK(std::count_if(pairs.begin(), pairs.end(), [](const StationPair& pair) { return pair.length == 0.0; }) == 2);
}

TEST_CASE("a zone that ends inside both fibres has no pair in a last section, and a short one at an end has one of them") {
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-1, 0, 0.04}, {1, 0, 0.04}, r, 10)});
    for (const StationPair& pair : pairs_of(mesh, zone_of(0.3, 9.7, 0.3, 9.7), false)) CHECK(pair.length > 0.0);
    const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(9.9, 10, 9.9, 10), false);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].u_i == 10.0);
    CHECK(pairs[0].u_j == 10.0);
}

TEST_CASE("fibres that meet end to end are paired by their two caps") {
    const Mesh mesh =
        mesh_of({straight_fibre({-1, 0, 0}, {0, 0, 0}, r, 5), straight_fibre({0.03, 0, 0.01}, {1.03, 0, 0.01}, r, 5)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone_of(4.8, 5, 0, 0.1), false);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].end_i);
    CHECK(pairs[0].end_j);
    CHECK(pairs[0].u_i == 5.0);
    CHECK(pairs[0].u_j == 0.0);
}

TEST_CASE("a crossing at a fibre's end is with its cap, unless the closest point happens to be the end") {
    const auto first = straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10);
    const Mesh short_of = mesh_of({first, straight_fibre({0, 1, 0.02}, {0, 0.03, 0.02}, r, 5)});
    const std::vector<StationPair> cap = pairs_of(short_of, zone_of(4, 6, 3, 5), true);
    CHECK(cap.at(0).end_j);
    CHECK_FALSE(cap.at(0).end_i);
    const Mesh level = mesh_of({first, straight_fibre({0, 1, 0.04}, {0, 0, 0.04}, r, 5)});
    CHECK_FALSE(pairs_of(level, zone_of(4, 6, 3, 5), true).at(0).end_j);
}

}  // namespace station_pairs_test

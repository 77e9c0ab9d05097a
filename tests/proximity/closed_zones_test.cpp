// SPDX-License-Identifier: MIT
// Zones of closed fibres: no seam, nothing twice, whatever vertex is the first.
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace closed_zones_test {

using proximity::Centreline;
using proximity::ProximityZone;
constexpr double pi = std::numbers::pi;

using Loop = std::function<Vec3(double)>;

/// Vertices of a closed curve; the first is at the share `first` of it.
std::vector<Vec3> around(const Loop& loop, int segments, int first) {
    std::vector<Vec3> points;
    for (int k = 0; k <= segments; ++k) points.push_back(loop(static_cast<double>((k + first) % segments) / segments));
    return points;
}
Vec3 ring(double t) { return {std::cos(2 * pi * t), std::sin(2 * pi * t), 0.0}; }
Vec3 linked(double t) { return {1.95 + std::cos(2 * pi * t), 0.0, std::sin(2 * pi * t)}; }
Vec3 beside(double t) { return {std::cos(2 * pi * t), std::sin(2 * pi * t), 0.11}; }
Vec3 trefoil(double t) {
    const double a = 2 * pi * t, rho = 1.0 + 0.07 * std::cos(3 * a);  // drawn to a circle that is run through twice
    return {rho * std::cos(2 * a), rho * std::sin(2 * a), 0.07 * std::sin(3 * a)};
}

/// Length of both intervals, to be compared between numberings.
double extent(const ProximityZone& zone) { return zone.b_i - zone.a_i + std::abs(zone.b_j - zone.a_j); }

TEST_CASE("linked rings have one zone at their crossing, around either seam") {
    const auto find = [](int first_a, int first_b) {
        const std::vector<Vec3> a = around(ring, 60, first_a), b = around(linked, 60, first_b);
        const std::vector<Centreline> lines{{.points = a, .radius = 0.05, .closed = true},
                                            {.points = b, .radius = 0.05, .closed = true}};
        return proximity::GridSearch().find(lines, 0.02);
    };
    const std::vector<ProximityZone> away = find(17, 11);
    REQUIRE(away.size() == 1);
    for (const auto& [first_a, first_b] :
         {std::pair{0, 0}, std::pair{0, 30}, std::pair{59, 30}, std::pair{1, 29}, std::pair{30, 31}}) {
        const std::vector<ProximityZone> zones = find(first_a, first_b);
        REQUIRE(zones.size() == 1);
        const ProximityZone& zone = zones.front();
        CHECK(std::abs(extent(zone) - extent(away.front())) < 1e-2);  // ends are found to 1/1024 of a segment
        CHECK(std::abs(zone.distance - away.front().distance) < 1e-14);
        // Where two vertices face each other chords are as close all along one of them.
        CHECK(std::abs(std::remainder(zone.closest_i + first_a - away.front().closest_i - 17, 60.0)) < 0.5);
        CHECK(std::abs(std::remainder(zone.closest_j + first_b - away.front().closest_j - 11, 60.0)) < 0.5);
        CHECK(zone.a_i <= zone.closest_i);
        CHECK(zone.closest_i <= zone.b_i);
        CHECK(zone.a_i >= 0.0);
        CHECK(zone.a_i < 60.0);
    }
}

TEST_CASE("a zone that goes all around covers a closed fibre once") {
    for (const int first : {0, 23}) {
        const std::vector<Vec3> a = around(ring, 60, 0), b = around(beside, 60, first);
        const std::vector<Centreline> lines{{.points = a, .radius = 0.05, .closed = true},
                                            {.points = b, .radius = 0.05, .closed = true}};
        const std::vector<ProximityZone> zones = proximity::GridSearch().find(lines, 0.02);
        REQUIRE(zones.size() == 1);
        CHECK(zones.front().b_i - zones.front().a_i >= 60.0);
        CHECK(zones.front().b_i - zones.front().a_i < 64.0);
    }
}

TEST_CASE("a closed fibre does not meet its neighbours across the seam, and itself wherever it does") {
    const auto find = [](const Loop& loop, int segments, int first, double skip) {
        const std::vector<Vec3> a = around(loop, segments, first);
        const std::vector<Centreline> lines{{.points = a, .radius = 0.05, .self_skip = skip, .closed = true}};
        const std::vector<proximity::SegmentPair> pairs = proximity::GridSearch().pairs(lines, 0.06);
        CHECK(pairs == proximity::BruteSearch().pairs(lines, 0.06));
        double covered = 0.0;
        for (const ProximityZone& zone : proximity::GridSearch().find(lines, 0.06)) covered += extent(zone);
        return std::pair{pairs.size(), covered};
    };
    CHECK(find(ring, 60, 0, 0.3).first == 0);
    const auto [pairs, covered] = find(trefoil, 120, 0, 0.3);
    CHECK(covered >= 120.0);  // all of it lies beside itself
    CHECK(covered < 130.0);
    for (const int first : {1, 33, 60, 119}) {
        CHECK(find(trefoil, 120, first, 0.3).first == pairs);
        CHECK(std::abs(find(trefoil, 120, first, 0.3).second - covered) <
              6.0);  // how far its ends overlap depends on where they are
    }
}

}  // namespace closed_zones_test

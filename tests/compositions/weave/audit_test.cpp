// SPDX-License-Identifier: MIT
#include "compositions/weave/woven_snapshot.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace fibrant;

namespace audit_test {

using namespace fibrant::compositions::weave;

observe::FibreSnapshot curve(const std::vector<Vec3>& nodes, double radius) {
    observe::FibreSnapshot fibre;
    fibre.position = nodes;
    fibre.section = scene::circular(radius);
    // Sections as round as the search takes them, whatever the direction: the gap is that of the axes.
    fibre.director_1.assign(nodes.size(), Vec3::UnitX());
    fibre.director_2.assign(nodes.size(), Vec3::UnitZ());
    return fibre;
}

TEST_CASE("a fabric drawn by its pattern passes, every pair of a warp and a weft fibre once") {
    for (const char* name : {"plain", "twill22", "twill31"}) {
        const FabricParameters fabric = small_fabric(4, 7, Pattern::named(name));
        const double amplitude = 0.6 * fabric.warp.packing().thickness;
        const Audit result = audit(woven_snapshot(fabric, amplitude), fabric, proximity::GridSearch{});
        CHECK(result.crossings == 28 * 28);
        CHECK(result.wrong_crossings == 0);
        CHECK(result.missing_crossings == 0);
        // At the middle of a crossing: two amplitudes less the offsets of the outermost fibres, one diameter at least.
        CHECK(result.least_height > 0.08);
        CHECK(result.worst.size() == 8);
        CHECK(result.clean(0.0) == (result.least_gap.gap >= 0.0));
    }
}

TEST_CASE("one crossing of two tows drawn the other way is caught, fibre by fibre") {
    const FabricParameters fabric = small_fabric(4, 7);
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.6 * fabric.warp.packing().thickness);
    FabricParameters asked = fabric;
    asked.pattern = Pattern::from_rows({"0101", "1010", "0111", "1010"});  // the plain weave but for warp 2, weft 2
    const Audit result = audit_crossings(snapshot, asked);
    CHECK(result.crossings == 28 * 28);
    CHECK(result.wrong_crossings == 49);
    CHECK_FALSE(result.clean(1.0));
    REQUIRE_FALSE(result.worst.empty());
    CHECK(result.worst.front().height == result.least_height);
    CHECK(result.least_height < 0.0);
    for (const AuditedCrossing& crossing : result.worst) {
        CHECK(crossing.warp_tow == 2);
        CHECK(crossing.weft_tow == 2);
        CHECK(std::abs(crossing.position.x() - 0.44) < 0.2);
        CHECK(std::abs(crossing.position.y() - 0.44) < 0.2);
    }
}

TEST_CASE("a single fibre that passed through its neighbours is caught") {
    const FabricParameters fabric = small_fabric(4, 7);
    observe::Snapshot snapshot = woven_snapshot(fabric, 0.6 * fabric.warp.packing().thickness);
    for (Vec3& node : snapshot.fibres[10].position) node.z() *= -2.0;  // in the middle of warp tow 1
    const Audit result = audit_crossings(snapshot, fabric);
    CHECK(result.wrong_crossings == 28);
    for (const AuditedCrossing& crossing : result.worst) CHECK(crossing.warp_fibre == 10);
}

TEST_CASE("a fibre that slipped out of the fabric misses its crossings") {
    const FabricParameters fabric = small_fabric(4, 7);
    observe::Snapshot snapshot = woven_snapshot(fabric, 0.14);
    for (Vec3& node : snapshot.fibres[30].position) node.x() += 10.0;  // one of weft tow 0
    const Audit result = audit_crossings(snapshot, fabric);
    CHECK(result.missing_crossings == 28);
    CHECK(result.crossings == 28 * 27);
    CHECK_FALSE(result.clean(1.0));
}

TEST_CASE("crossings are found on wavy fibres where a dense sampling finds them") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> wave(-0.04, 0.04);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<Vec3> a, b;
        for (int k = 0; k <= 32; ++k) {
            const double s = k / 16.0 - 1.0;
            a.emplace_back(s, wave(random), wave(random));
            b.emplace_back(wave(random), s, wave(random));
        }
        const observe::NodalCurve warp{a}, weft{b};
        Index found = 0;
        double t = 0.0;
        const Index crossings = for_each_plan_crossing(warp, weft, [&](const PlanCrossing& crossing) {
            ++found;
            t = crossing.warp;
            const Vec3 apart = warp.position(crossing.warp) - weft.position(crossing.weft);
            CHECK(std::hypot(apart.x(), apart.y()) < 1e-9);
        });
        CHECK(found == crossings);
        CHECK(crossings >= 1);
        // The nearest approach in plan over a fine grid, near the crossing that was found last.
        double nearest = 1.0;
        for (int i = -50; i <= 50; ++i)
            for (int j = 0; j <= 640; ++j) {
                const Vec3 apart = warp.position(std::clamp(t + 0.001 * i, 0.0, 32.0)) - weft.position(0.05 * j);
                nearest = std::min(nearest, std::hypot(apart.x(), apart.y()));
            }
        CHECK(nearest < 0.01);
    }
}

TEST_CASE("two crossed fibres are apart by the distance of their axes less both radii") {
    observe::Snapshot snapshot;
    snapshot.fibres = {curve({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 0.1),
                       curve({{0.3, -1, 0.25}, {0.3, 0.2, 0.25}, {0.3, 1, 0.25}}, 0.2)};
    const observe::LeastGap least = least_gap(snapshot, proximity::BruteSearch{});
    CHECK(least.gap == test::near(-0.05, 1e-12));
    CHECK(least.gap_over_radius == test::near(-0.5, 1e-12));
    CHECK((least.position - Vec3{0.3, 0, 0.125}).norm() < 1e-6);
    snapshot.fibres[1].position = {{0.3, -1, 9.0}, {0.3, 0.2, 9.0}, {0.3, 1, 9.0}};  // far beyond any first reach
    CHECK(least_gap(snapshot, proximity::GridSearch{}).gap == test::near(8.7, 1e-12));
    snapshot.fibres.resize(1);
    CHECK(std::isinf(least_gap(snapshot, proximity::GridSearch{}).gap));
}

TEST_CASE("the least gap is that of the curves, not of the chords between their nodes") {
    // A parabola z = 0.1 + x^2 over a straight fibre along y: the lowest point lies within a node interval.
    observe::Snapshot snapshot;
    const auto height = [](double x) { return 0.1 + x * x; };
    snapshot.fibres = {curve({{-0.6, 0, height(-0.6)}, {0.2, 0, height(0.2)}, {1.0, 0, height(1.0)}}, 0.02),
                       curve({{0, -1, 0}, {0, 0.1, 0}, {0, 1, 0}}, 0.02)};
    const observe::LeastGap least = least_gap(snapshot, proximity::BruteSearch{});
    CHECK(least.gap == test::near(0.06, 1e-9));
    CHECK(std::abs(least.position.x()) < 1e-6);  // of a curve 1.6 long
}

TEST_CASE("a pair whose chords are apart but whose curves touch deepest is not passed over") {
    // First pair: straight, 0.001 deep. Second pair: the nearest chord is 0.001 clear, but the parabola hangs below it.
    observe::Snapshot snapshot;
    snapshot.fibres = {
        curve({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 0.1), curve({{0.5, -1, 0.199}, {0.5, 0, 0.199}, {0.5, 1, 0.199}}, 0.1),
        curve({{-1, 9, 0}, {0, 9, 0}, {1, 9, 0}}, 0.1), curve({{0.1, 8.5, 0.201}, {0.1, 9.5, 0.201}, {0.1, 10.5, 1.0}}, 0.1)};
    const observe::NodalCurve bulge{snapshot.fibres[3].position};
    const observe::LeastGap least = least_gap(snapshot, proximity::BruteSearch{});
    CHECK(least.fibre_i == 2);
    CHECK(least.fibre_j == 3);
    CHECK(least.gap == least_gap(snapshot, proximity::GridSearch{}).gap);
    double lowest = 1.0;
    for (int k = 0; k <= 200000; ++k) {
        const Vec3 x = bulge.position(1e-5 * k);
        lowest = std::min(lowest, std::hypot(x.z(), x.y() - 9.0));
    }
    CHECK(least.gap == test::near(lowest - 0.2, 1e-6));
}

TEST_CASE("flattened sections touch later than round ones") {
    observe::Snapshot snapshot;
    snapshot.fibres = {curve({{-1, 0, 0}, {0, 0, 0}, {1, 0, 0}}, 0.1), curve({{0, -1, 0.19}, {0, 0, 0.19}, {0, 1, 0.19}}, 0.1)};
    CHECK(least_gap(snapshot, proximity::BruteSearch{}).gap == test::near(-0.01, 1e-12));
    for (auto& fibre : snapshot.fibres)
        for (Vec3& director : fibre.director_2) director *= 0.9;
    CHECK(least_gap(snapshot, proximity::BruteSearch{}).gap == test::near(0.01, 1e-12));
}

TEST_CASE("the least gap of a fabric is that of a dense sampling of all pairs, with any search") {
    const FabricParameters fabric = small_fabric(2, 5);
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.55 * fabric.warp.packing().thickness);
    // Sampled every 1/8 of a node interval, 0.005; distances there err by less than 0.0025^2 / 0.08 = 8e-5.
    double sampled = 1.0;
    for (std::size_t i = 0; i < snapshot.fibres.size(); ++i)
        for (std::size_t j = i + 1; j < snapshot.fibres.size(); ++j) {
            const observe::NodalCurve a{snapshot.fibres[i].position}, b{snapshot.fibres[j].position};
            for (int p = 0; p <= 512; ++p)
                for (int q = 0; q <= 512; ++q)
                    sampled = std::min(sampled, (a.position(p / 8.0) - b.position(q / 8.0)).norm() - 0.08);
        }
    const observe::LeastGap brute = least_gap(snapshot, proximity::BruteSearch{});
    const observe::LeastGap grid = least_gap(snapshot, proximity::GridSearch{});
    CHECK(brute.gap <= sampled + 1e-6);
    CHECK(brute.gap >= sampled - 2e-4);
    CHECK(grid.gap == brute.gap);
    CHECK(grid.fibre_i == brute.fibre_i);
    CHECK(grid.fibre_j == brute.fibre_j);
}

}  // namespace audit_test

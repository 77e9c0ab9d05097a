// SPDX-License-Identifier: MIT
#include "fibres.hpp"

#include <fibrant/contact/intermediate_geometry.hpp>

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

using namespace fibrant;

namespace intermediate_geometry_test {

using contact::ContactSpacing;
using contact::StationPair;
using test::curved_fibre;
using test::Mesh;
using test::straight_fibre;

const double r = 0.02;
const ContactSpacing spacing;

Mesh mesh_of(const std::vector<scene::FibreSpecification>& fibres) {
    scene::Assembly assembly;
    for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
    return Mesh(assembly, test::Beam{});
}

proximity::ProximityZone zone(double a_i, double b_i, double a_j, double b_j) {
    proximity::ProximityZone z;
    z.fibre_i = 0, z.fibre_j = 1;
    z.a_i = a_i, z.b_i = b_i, z.a_j = a_j, z.b_j = b_j;
    z.closest_i = 0.5 * (a_i + b_i), z.closest_j = 0.5 * (a_j + b_j);
    return z;
}

std::vector<StationPair> pairs_of(const Mesh& mesh, const proximity::ProximityZone& z, bool crossing) {
    std::vector<StationPair> pairs;
    contact::station_pairs(mesh, mesh.rest_state(), z, crossing, spacing, pairs);
    return pairs;
}

double distance(const Mesh& mesh, double u, double v) {
    return (mesh.position(mesh.rest_state(), 1, v) - mesh.position(mesh.rest_state(), 0, u)).norm();
}

/// Least distance between the curves by samples on ever finer grids.
double sampled_distance(const Mesh& mesh) {
    double u = 0.0, v = 0.0, least = 1e300, width_u = static_cast<double>(mesh.fibre(0).elements), width_v = static_cast<double>(mesh.fibre(1).elements);
    const double end_u = width_u, end_v = width_v;
    double centre_u = 0.5 * end_u, centre_v = 0.5 * end_v;
    for (int level = 0; level < 12; ++level) {
        const int n = level == 0 ? 600 : 20;
        for (int a = -n; a <= n; ++a)
            for (int b = -n; b <= n; ++b) {
                const double p = std::clamp(centre_u + 0.5 * width_u * a / n, 0.0, end_u), q = std::clamp(centre_v + 0.5 * width_v * b / n, 0.0, end_v);
                const double d = distance(mesh, p, q);
                if (d < least) least = d, u = p, v = q;
            }
        centre_u = u, centre_v = v;
        width_u *= level == 0 ? 0.02 : 0.25, width_v *= level == 0 ? 0.02 : 0.25;
    }
    return least;
}

/// A fibre that waves about a line through `centre` along `along`.
scene::FibreSpecification wave(const Vec3& centre, const Vec3& along, const Vec3& across, double phase, Index elements) {
    return curved_fibre([=](double t) { return Vec3(centre + (t - 0.5) * along + 0.05 * std::sin(5.0 * t + phase) * across); }, r, elements);
}

TEST_CASE("the closest points of crossing curves are those that dense sampling finds") {
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> value(-0.1, 0.1), turn(0.6, 2.5);
    for (int n = 0; n < 12; ++n) {
        const double angle = turn(generator), x = value(generator), y = value(generator);
        const Vec3 other(std::cos(angle), std::sin(angle), 0.0);
        const Mesh mesh = mesh_of({wave({0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ(), n, 8), wave({x, y, 0.15}, other, Vec3(-0.3, 0.2, 1.0), 2.0 * n, 10)});
        const StationPair pair = contact::closest_points(mesh, mesh.rest_state(), 0, 1, 4.0, 5.0);
        // but for the evened kinks, of some 1e-3 radian here, whose effect on the distance is of second order
        CHECK(distance(mesh, pair.u_i, pair.u_j) <= sampled_distance(mesh) * (1.0 + 1e-5));
        const Vec3 centres = mesh.position(mesh.rest_state(), 1, pair.u_j) - mesh.position(mesh.rest_state(), 0, pair.u_i);
        CHECK(std::abs(centres.dot(contact::contact_tangent(mesh, mesh.rest_state(), 0, pair.u_i))) < 1e-11);
        CHECK(std::abs(centres.dot(contact::contact_tangent(mesh, mesh.rest_state(), 1, pair.u_j))) < 1e-11);
    }
}

TEST_CASE("the closest points of lines that pass through each other are where they meet") {
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 8), straight_fibre({-0.1, -1, 0}, {0.4, 1, 0}, r, 8)});
    const StationPair pair = contact::closest_points(mesh, mesh.rest_state(), 0, 1, 2.0, 6.0);
    CHECK(pair.u_i == doctest::Approx(4.6).epsilon(1e-12));  // x = 0.15
    CHECK(pair.u_j == doctest::Approx(4.0).epsilon(1e-12));
}

TEST_CASE("tangents of contact are continuous, and those of the centreline where that has no kink") {
    const Mesh arc = mesh_of({wave({0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ(), 0.4, 8)});
    const Mesh parabola = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 8)});
    Vector bent = parabola.rest_state();  // x unchanged, z = x^2: a parabola over the whole fibre
    for (Index node = 0; node < parabola.node_count(0); ++node) {
        const Index v = 3 * parabola.node_vector(0, node);
        bent[v + 2] = bent[v] * bent[v];
    }
    const double step = 1e-9;
    for (int node = 1; node < 8; ++node) {
        const Vec3 before = contact::contact_tangent(arc, arc.rest_state(), 0, node - step);
        CHECK((contact::contact_tangent(arc, arc.rest_state(), 0, node + step) - before).norm() < 10 * step);
        CHECK((arc.derivative(arc.rest_state(), 0, node + step) - arc.derivative(arc.rest_state(), 0, node - step)).norm() > 1e-6);
    }
    for (double u = 0.0; u <= 8.0; u += 0.37)
        CHECK((contact::contact_tangent(parabola, bent, 0, u) - parabola.derivative(bent, 0, u)).norm() < 1e-14);
}

TEST_CASE("fibres that press a kink into each other have one pair of closest points, which moves continuously") {
    // Two straight arms each, bent by 0.02 towards each other in the node where they cross: sampling finds the closest
    // points on one side of the node or the other, 0.02 diameters away.
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 8), straight_fibre({0, -1, 2 * r}, {0, 1, 2 * r}, r, 8)});
    Vector state = mesh.rest_state();
    for (Index node = 0; node < mesh.node_count(0); ++node) {
        const Index lower = 3 * mesh.node_vector(0, node), upper = 3 * mesh.node_vector(1, node);
        state[lower + 2] += 0.02 * std::abs(state[lower]);
        state[upper + 2] -= 0.02 * std::abs(state[upper + 1]);
    }
    StationPair last;
    for (int k = -50; k <= 50; ++k) {
        Vector moved = state;
        for (Index node = 0; node < mesh.node_count(1); ++node) moved[3 * mesh.node_vector(1, node)] += 1e-4 * k;
        const StationPair pair = contact::closest_points(mesh, moved, 0, 1, 4.0, 4.0);
        const StationPair other = contact::closest_points(mesh, moved, 0, 1, 3.7, 4.4);  // from wherever it starts
        CHECK(std::abs(pair.u_i - other.u_i) < 1e-9);
        CHECK(std::abs(pair.u_j - other.u_j) < 1e-9);
        if (k == 0) CHECK(std::abs(pair.u_i - 4.0) < 1e-9);
        if (k > -50) CHECK(std::abs(pair.u_i - last.u_i) < 2e-4 / 0.25);
        last = pair;
    }
}

TEST_CASE("closest points stay on the fibres") {
    // The second fibre ends before it reaches the plane of the first: its end is the closest point.
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 8), straight_fibre({0.3, 1, 0.03}, {0.3, 0.01, 0.03}, r, 6)});
    const StationPair pair = contact::closest_points(mesh, mesh.rest_state(), 0, 1, 4.0, 3.0);
    CHECK(pair.u_i == doctest::Approx(5.2).epsilon(1e-12));
    CHECK(pair.u_j == 6.0);
}

TEST_CASE("a plane cuts a curved fibre where dense sampling changes sides") {
    const Mesh mesh = mesh_of({wave({0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ(), 0.4, 8)});
    const Vec3 normal = Vec3(1.0, 0.2, 0.3).normalized();
    for (const double x : {-0.4, -0.13, 0.0, 0.31}) {
        const Vec3 origin(x, 0.02, 0.01);
        const double u = contact::plane_section(mesh, mesh.rest_state(), 0, 8.0 * (x + 0.5) + 0.4, origin, normal);
        CHECK(std::abs((mesh.position(mesh.rest_state(), 0, u) - origin).dot(normal)) < 1e-13);
        int changes = 0;
        for (int k = 0; k < 4000; ++k) {
            const double low = 8.0 * k / 4000, high = 8.0 * (k + 1) / 4000;
            if ((mesh.position(mesh.rest_state(), 0, low) - origin).dot(normal) > 0.0) continue;
            if ((mesh.position(mesh.rest_state(), 0, high) - origin).dot(normal) <= 0.0) continue;
            ++changes;
            CHECK(u >= low);
            CHECK(u <= high);
        }
        CHECK(changes == 1);
    }
    // beyond the fibre: its end
    CHECK(contact::plane_section(mesh, mesh.rest_state(), 0, 7.0, {3, 0, 0}, Vec3::UnitX()) == 8.0);
}

TEST_CASE("near-parallel fibres are paired across their mean line, at equal distances that do not move with the zone's ends") {
    // 3 degrees apart, with as many elements that do not face each other
    const double angle = 3.0 * std::numbers::pi / 180.0;
    const Vec3 other(std::cos(angle), std::sin(angle), 0.0);
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre(Vec3(0.03, 0, 0.04) - other, Vec3(0.03, 0, 0.04) + other, r, 10)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone(2, 8, 2, 8), false);
    REQUIRE(pairs.size() == 13);  // two an element, and one where the last begins
    const Vec3 mean = (Vec3::UnitX() + other).normalized();
    double last = 0.0, length = 0.0;
    for (const StationPair& pair : pairs) {
        CHECK_FALSE(pair.crossing);
        CHECK_FALSE(pair.end_i);
        CHECK_FALSE(pair.end_j);
        const Vec3 x_i = mesh.position(mesh.rest_state(), 0, pair.u_i), x_j = mesh.position(mesh.rest_state(), 1, pair.u_j);
        CHECK(std::abs((x_j - x_i).dot(mean)) < 1e-12);
        if (last != 0.0) CHECK(pair.u_i - last == doctest::Approx(0.5).epsilon(1e-9));
        last = pair.u_i, length += pair.length;
    }
    CHECK(length == doctest::Approx(6.5 * 0.2).epsilon(1e-12));
    const std::vector<StationPair> shorter = pairs_of(mesh, zone(2.3, 7.6, 2.3, 7.6), false);
    REQUIRE(shorter.size() == 11);
    for (std::size_t k = 0; k < shorter.size(); ++k) CHECK(std::abs(shorter[k].u_i - pairs[k + 1].u_i) < 1e-9);
}

TEST_CASE("fibres that slant have more pairs, so that none of their depth is missed") {
    // Closest half way between two stations, where half an element's spacing misses 0.002, 0.008, 0.04 and 0.3 radii.
    const auto missed = [](double degrees, const ContactSpacing& used) {
        const double angle = degrees * std::numbers::pi / 180.0;
        const Vec3 along(std::cos(angle), std::sin(angle), 0.0), middle(0.05, 0.0, 0.039);
        const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre(middle - 1.05 * along, middle + 0.95 * along, r, 10)});
        std::vector<StationPair> pairs;
        contact::station_pairs(mesh, mesh.rest_state(), zone(4.3, 6.2, 4.3, 6.2), false, used, pairs);
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
            const Mesh mesh = mesh_of({curved_fibre([&](double t) { return Vec3(2.0 * t, 0.0, 0.5 * below * (2.0 * t - 1.0) * (2.0 * t - 1.0)); }, r, 10),
                                       curved_fibre([&](double t) { return Vec3(2.0 * t, 0.0, 2.0 * r + 0.5 * above * (2.0 * t - 1.0) * (2.0 * t - 1.0)); }, r, 10)});
            return pairs_of(mesh, zone(4, 6, 4, 6), false).size();
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
                        curved_fibre([&](double t) { return Vec3(2.0 * t, 0.0, 2.0 * r + curvature * (t > 0.5 ? 2.0 * (t - 0.5) * (t - 0.5) : 0.0)); }, r, 10)});
    };
    const Mesh bent = pair_of(0.2), straight = pair_of(0.0);
    const std::vector<StationPair> halved = pairs_of(bent, zone(4, 6, 4, 6), false);
    REQUIRE(halved.size() == 7);  // two more than for straight fibres, both beyond the middle
    std::vector<StationPair> again;
    contact::station_pairs(straight, straight.rest_state(), zone(4, 6, 4, 6), false, spacing, again,
                           [&](const auto& see) { for (const StationPair& pair : halved) see(pair.u_i, pair.u_j); });
    REQUIRE(again.size() == halved.size());
    for (std::size_t k = 0; k < again.size(); ++k) CHECK(std::abs(again[k].u_i - halved[k].u_i) < 0.02);  // the bent fibre has longer elements
    CHECK(pairs_of(straight, zone(4, 6, 4, 6), false).size() == 5);
}

TEST_CASE("a fibre that runs the other way is paired at the same places") {
    const auto one = curved_fibre([](double t) { return Vec3(t, 0.0, 0.1 * t * t); }, r, 8);
    const auto along = curved_fibre([](double t) { return Vec3(t, 0.041, 0.1 * t * t); }, r, 8);
    const auto against = curved_fibre([](double t) { return Vec3(1.0 - t, 0.041, 0.1 * (1.0 - t) * (1.0 - t)); }, r, 8);
    const Mesh same = mesh_of({one, along}), opposite = mesh_of({one, against});
    const auto p = pairs_of(same, zone(1, 6, 1, 6), false), q = pairs_of(opposite, zone(1, 6, 7, 2), false);
    REQUIRE(p.size() == q.size());
    for (std::size_t k = 0; k < p.size(); ++k) {
        // nodes at equal arc length of both, by quadrature to 1e-9
        CHECK(std::abs(p[k].u_i - q[k].u_i) < 1e-7);
        CHECK(std::abs(p[k].u_j - (8.0 - q[k].u_j)) < 1e-7);
    }
}

TEST_CASE("a short zone has one pair, and a crossing exactly one at the closest points") {
    const Mesh parallel = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-1, 0, 0.04}, {1, 0, 0.04}, r, 10)});
    CHECK(pairs_of(parallel, zone(4.0, 4.1, 4.0, 4.1), false).size() == 1);
    const Mesh crossing = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({0.1, -1, 0.04}, {0.1, 1, 0.04}, r, 10)});
    const std::vector<StationPair> pairs = pairs_of(crossing, zone(4, 7, 3, 6), true);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].crossing);
    CHECK(pairs[0].u_i == doctest::Approx(5.5).epsilon(1e-12));
    CHECK(pairs[0].u_j == doctest::Approx(5.0).epsilon(1e-12));
    CHECK_FALSE(pairs[0].end_i);
    CHECK_FALSE(pairs[0].end_j);
}

TEST_CASE("a zone that reaches beyond a fibre's end has one pair in its last section, and no cap beside another's side") {
    // The second fibre begins half way along the first.
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({0.05, 0, 0.04}, {1.05, 0, 0.04}, r, 5)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone(3, 9, 0, 4), false);
    int ends = 0;
    for (const StationPair& pair : pairs) {
        CHECK_FALSE(pair.end_j);
        CHECK_FALSE(pair.end_i);
        if (pair.u_j > 0.0) continue;
        ++ends;
        CHECK(pair.u_i == doctest::Approx(5.25).epsilon(1e-12));
    }
    CHECK(ends == 1);
}

TEST_CASE("splayed fibres have a pair in their last section, where they are closest") {
    // 3 degrees apart and closest where they begin; the second of the other direction in the second case
    const double angle = 3.0 * std::numbers::pi / 180.0;
    const Vec3 far_end(2.0 * std::cos(angle), 0.0, 0.04 + 2.0 * std::sin(angle));
    for (const bool against : {false, true}) {
        const Vec3 near_end(0, 0, 0.04);
        const Mesh mesh = mesh_of({straight_fibre({0, 0, 0}, {2, 0, 0}, r, 10), against ? straight_fibre(far_end, near_end, r, 10) : straight_fibre(near_end, far_end, r, 10)});
        const double start = against ? 10.0 : 0.0;
        const std::vector<StationPair> pairs = pairs_of(mesh, zone(0, 4, start, against ? 6 : 4), false);
        REQUIRE(pairs.size() == 9);  // two an element, and one where the zone ends
        // in the last section of both, but for the angle times the distance
        CHECK(pairs[0].u_i < 0.01);
        CHECK(std::abs(pairs[0].u_j - start) < 0.01);
        CHECK_FALSE(pairs[0].end_i);
        CHECK_FALSE(pairs[0].end_j);
        for (std::size_t k = 1; k < pairs.size(); ++k) CHECK(distance(mesh, pairs[k].u_i, pairs[k].u_j) > distance(mesh, pairs[k - 1].u_i, pairs[k - 1].u_j));
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
            for (const StationPair& pair : pairs_of(mesh, zone(2.5 + ahead, 12.5 + ahead, 0.0, 10.0), false))
                least = std::min(least, distance(mesh, pair.u_i, pair.u_j));
            CHECK(least < (2.0 + spacing.largest_unseen) * r);
        }
    }
}

TEST_CASE("where a fibre ends, its last section has no deeper contact than its pairs know of, wherever its stations stand") {
    // 15 degrees towards the first fibre, and touching it where it ends; it begins a little later each time, over a whole spacing.
    const double angle = 15.0 * std::numbers::pi / 180.0, length = 1.0;
    for (int shift = 0; shift < 40; ++shift) {
        const Vec3 end(0.7 + 0.2 * 0.5 * shift / 40.0, 0.0, 2.0 * r);
        const Vec3 start = end + length * Vec3(-std::cos(angle), 0.0, std::sin(angle));
        const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre(start, end, r, 5)});
        const double last = (end.x() + 1.0) / 0.2;
        double least = 1e300;
        for (const StationPair& pair : pairs_of(mesh, zone(last - 2.0, last + 0.1, 3.0, 5.0), false))
            least = std::min(least, std::cos(0.5 * angle) * distance(mesh, pair.u_i, pair.u_j));  // in the plane across their mean line
        CHECK(least <= (2.0 + spacing.largest_unseen) * r);
    }
}

TEST_CASE("where one fibre ends before the other, the pair is in the last section of that one") {
    // The second begins 0.06 and ends 0.05 inside the first: 0.3 and 0.25 elements of it.
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-0.94, 0, 0.04}, {0.95, 0, 0.04}, r, 9)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone(0.2, 9.8, 0, 9), false);
    for (const bool last : {false, true}) {
        const StationPair& pair = last ? pairs.back() : pairs.front();
        CHECK(pair.u_j == (last ? 9.0 : 0.0));
        CHECK(pair.u_i == doctest::Approx(last ? 9.75 : 0.3).epsilon(1e-12));
        CHECK_FALSE(pair.end_j);
    }
    CHECK(std::count_if(pairs.begin(), pairs.end(), [](const StationPair& pair) { return pair.length == 0.0; }) == 2);
}

TEST_CASE("a zone that ends inside both fibres has no pair in a last section, and a short one at an end has one of them") {
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10), straight_fibre({-1, 0, 0.04}, {1, 0, 0.04}, r, 10)});
    for (const StationPair& pair : pairs_of(mesh, zone(0.3, 9.7, 0.3, 9.7), false)) CHECK(pair.length > 0.0);
    const std::vector<StationPair> pairs = pairs_of(mesh, zone(9.9, 10, 9.9, 10), false);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].u_i == 10.0);
    CHECK(pairs[0].u_j == 10.0);
}

TEST_CASE("fibres that meet end to end are paired by their two caps") {
    const Mesh mesh = mesh_of({straight_fibre({-1, 0, 0}, {0, 0, 0}, r, 5), straight_fibre({0.03, 0, 0.01}, {1.03, 0, 0.01}, r, 5)});
    const std::vector<StationPair> pairs = pairs_of(mesh, zone(4.8, 5, 0, 0.1), false);
    REQUIRE(pairs.size() == 1);
    CHECK(pairs[0].end_i);
    CHECK(pairs[0].end_j);
    CHECK(pairs[0].u_i == 5.0);
    CHECK(pairs[0].u_j == 0.0);
}

TEST_CASE("a crossing at a fibre's end is with its cap, unless the closest point happens to be the end") {
    const auto first = straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 10);
    const Mesh short_of = mesh_of({first, straight_fibre({0, 1, 0.02}, {0, 0.03, 0.02}, r, 5)});
    const std::vector<StationPair> cap = pairs_of(short_of, zone(4, 6, 3, 5), true);
    CHECK(cap.at(0).end_j);
    CHECK_FALSE(cap.at(0).end_i);
    const Mesh level = mesh_of({first, straight_fibre({0, 1, 0.04}, {0, 0, 0.04}, r, 5)});
    CHECK_FALSE(pairs_of(level, zone(4, 6, 3, 5), true).at(0).end_j);
}

TEST_CASE("a spacing without points is refused by name") {
    CHECK(test::refusal([] { core::validated(ContactSpacing{0.0, 30.0, 5.0}); }).find("ContactSpacing.points_per_element") != std::string::npos);
    CHECK(test::refusal([] { core::validated(ContactSpacing{2.0, 91.0, 5.0}); }).find("ContactSpacing.crossing_angle_deg") != std::string::npos);
}

TEST_CASE("fibres that bend towards each other cross only from the angle at which their centres have one closest place") {
    const double kappa = 1.0 / (12.0 * r);  // of each; a second place comes up at sin^2 a = 4 r kappa - (2 r kappa)^2, a = 33.56 degrees
    const auto bent = [&](double angle_deg, double curvature_i, double curvature_j) {
        const double half = 0.5 * angle_deg * std::numbers::pi / 180.0;
        const auto line = [=](double side, double curvature) {
            return [=](double t) {
                const double s = 6.0 * r * (2.0 * t - 1.0);
                return Vec3(s * std::cos(half), side * s * std::sin(half), -side * (r - 0.5 * curvature * s * s));
            };
        };
        return mesh_of({curved_fibre(line(1.0, curvature_i), r, 20), curved_fibre(line(-1.0, curvature_j), r, 20)});
    };
    const proximity::ProximityZone whole = zone(0, 20, 0, 20);
    const auto angle = [&](const Mesh& mesh) { return contact::crossing_angle_deg(mesh, mesh.rest_state(), whole); };
    const double critical = std::asin(std::sqrt(4.0 / 12.0 - 4.0 / 144.0)) * 180.0 / std::numbers::pi;
    for (const double off : {-6.0, -3.0, 3.0, 6.0}) {
        const Mesh mesh = bent(critical + off, kappa, kappa);
        // By samples: does the distance fall beside the middle, or is it least there?
        double beside = 1e300;
        for (const double e : {-0.3, -0.2, 0.2, 0.3}) beside = std::min(beside, distance(mesh, 10.0 + e, 10.0 + e));
        CHECK((beside > distance(mesh, 10.0, 10.0)) == (off > 0.0));
        CHECK((angle(mesh) > 0.0) == (off > 0.0));
        CHECK(angle(mesh) < critical + off);
    }
    // Straight ones, one that is bent away as much as the other follows it, and both bent away: the angle between the tangents.
    CHECK(angle(bent(40.0, 0.0, 0.0)) == doctest::Approx(40.0).epsilon(1e-9));
    CHECK(angle(bent(40.0, -kappa, -kappa)) == doctest::Approx(40.0).epsilon(1e-6));  // the tangents are those of elements
    CHECK(angle(bent(90.0, kappa, kappa)) == doctest::Approx(std::asin(std::sqrt(1.0 - std::pow(std::sin(critical * std::numbers::pi / 180.0), 2))) * 180.0 / std::numbers::pi).epsilon(1e-3));
}

TEST_CASE("fibres that run side by side and splay where they end do not cross, however great the angle there is") {
    // One is straight; the other runs beside and above it, and in its last four radii turns by 45 degrees, until its end is right above the first one's.
    const double aside = 1.5 * r, angle = 0.25 * std::numbers::pi, turn = aside / (1.0 - std::cos(angle)), along = 96.0 * r, all = along + turn * angle;
    const auto splayed = [=](double t) {
        const double arc = std::max(0.0, (t * all - along) / turn);
        return Vec3(std::min(t * all, along) + turn * std::sin(arc), turn * (1.0 - std::cos(arc)) - aside, 2.0 * r);
    };
    const Mesh mesh = mesh_of({straight_fibre({0, 0, 0}, {splayed(1.0).x(), 0, 0}, r, 80), curved_fibre(splayed, r, 80)});
    const auto angle_of = [&](double from) {
        proximity::ProximityZone ending = zone(from, 80, from, 80);
        ending.closest_i = ending.closest_j = 80;
        return contact::crossing_angle_deg(mesh, mesh.rest_state(), ending);
    };
    CHECK(angle_of(79.0) == doctest::Approx(45.0).epsilon(0.02));  // of the ends alone; an element is 1.25 radii long
    CHECK(angle_of(0.0) == doctest::Approx(std::asin(1.5 / 99.6) * 180.0 / std::numbers::pi).epsilon(1e-2));  // 1.5 radii apart over 99.6
}

TEST_CASE("a straight crossing is one from its angle, however long its zone, and an arc around another fibre from that of its second variation") {
    for (const double angle : {20.0, 31.0, 45.0, 90.0})
        for (const double length : {3.0, 30.0}) {
            const Vec3 half = 0.5 * length * r * Vec3(std::cos(angle * std::numbers::pi / 180.0), std::sin(angle * std::numbers::pi / 180.0), 0);
            const Mesh mesh = mesh_of({straight_fibre({-0.5 * length * r, 0, 0}, {0.5 * length * r, 0, 0}, r, 10),
                                       straight_fibre(Vec3(0, 0, 2.0 * r) - half, Vec3(0, 0, 2.0 * r) + half, r, 10)});
            CHECK(contact::crossing_angle_deg(mesh, mesh.rest_state(), zone(0, 10, 0, 10)) == doctest::Approx(angle).epsilon(1e-6));
        }
    // A quarter of a circle of 4 radii, whose middle is 2 radii above the other one: the distance grows with half of the second variation
    // of straight lines, and over the whole arc as fast.
    const auto arc = [](double t) { return Vec3(0, 4.0 * r * std::sin((t - 0.5) * std::numbers::pi), 4.0 * r * std::cos((t - 0.5) * std::numbers::pi)); };
    const Mesh mesh = mesh_of({straight_fibre({-r, 0, 2.0 * r}, {r, 0, 2.0 * r}, r, 10), curved_fibre(arc, r, 40)});
    CHECK(contact::crossing_angle_deg(mesh, mesh.rest_state(), zone(0, 10, 0, 40)) == doctest::Approx(45.0).epsilon(0.01));
}

}  // namespace intermediate_geometry_test

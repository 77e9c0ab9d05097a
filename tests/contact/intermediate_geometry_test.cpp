// SPDX-License-Identifier: MIT
#include "two_fibres.hpp"

#include <fibrant/contact/intermediate_geometry.hpp>

#include <near.hpp>
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
using test::distance;
using test::Mesh;
using test::mesh_of;
using test::straight_fibre;
using test::zone_of;

const double r = 0.02;

/// Least distance between the curves by samples on ever finer grids.
double sampled_distance(const Mesh& mesh) {
    double u = 0.0, v = 0.0, least = 1e300, width_u = static_cast<double>(mesh.fibre(0).elements),
           width_v = static_cast<double>(mesh.fibre(1).elements);
    const double end_u = width_u, end_v = width_v;
    double centre_u = 0.5 * end_u, centre_v = 0.5 * end_v;
    for (int level = 0; level < 12; ++level) {
        const int n = level == 0 ? 600 : 20;
        for (int a = -n; a <= n; ++a)
            for (int b = -n; b <= n; ++b) {
                const double p = std::clamp(centre_u + 0.5 * width_u * a / n, 0.0, end_u),
                             q = std::clamp(centre_v + 0.5 * width_v * b / n, 0.0, end_v);
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
    return curved_fibre([=](double t) { return Vec3(centre + (t - 0.5) * along + 0.05 * std::sin(5.0 * t + phase) * across); }, r,
                        elements);
}

TEST_CASE("the closest points of crossing curves are those that dense sampling finds") {
    std::mt19937 generator(4);
    std::uniform_real_distribution<double> value(-0.1, 0.1), turn(0.6, 2.5);
    for (int n = 0; n < 12; ++n) {
        const double angle = turn(generator), x = value(generator), y = value(generator);
        const Vec3 other(std::cos(angle), std::sin(angle), 0.0);
        const Mesh mesh = mesh_of(
            {wave({0, 0, 0}, Vec3::UnitX(), Vec3::UnitZ(), n, 8), wave({x, y, 0.15}, other, Vec3(-0.3, 0.2, 1.0), 2.0 * n, 10)});
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
    CHECK(pair.u_i == test::near(4.6, 1e-12));  // x = 0.15
    CHECK(pair.u_j == test::near(4.0, 1e-12));
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
        CHECK((arc.derivative(arc.rest_state(), 0, node + step) - arc.derivative(arc.rest_state(), 0, node - step)).norm() >
              1e-6);
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
    const Mesh mesh =
        mesh_of({straight_fibre({-1, 0, 0}, {1, 0, 0}, r, 8), straight_fibre({0.3, 1, 0.03}, {0.3, 0.01, 0.03}, r, 6)});
    const StationPair pair = contact::closest_points(mesh, mesh.rest_state(), 0, 1, 4.0, 3.0);
    CHECK(pair.u_i == test::near(5.2, 1e-12));
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

TEST_CASE("a spacing without points is refused by name") {
    CHECK(test::refusal([] {
              core::validated(ContactSpacing{0.0, 30.0, 5.0});
          }).find("ContactSpacing.points_per_element") != std::string::npos);
    CHECK(test::refusal([] {
              core::validated(ContactSpacing{2.0, 91.0, 5.0});
          }).find("ContactSpacing.crossing_angle_deg") != std::string::npos);
}

TEST_CASE("fibres that bend towards each other cross only from the angle at which their centres have one closest place") {
    const double kappa =
        1.0 / (12.0 * r);  // of each; a second place comes up at sin^2 a = 4 r kappa - (2 r kappa)^2, a = 33.56 degrees
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
    const proximity::ProximityZone whole = zone_of(0, 20, 0, 20);
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
    CHECK(angle(bent(40.0, 0.0, 0.0)) == test::near(40.0, 1e-9));
    CHECK(angle(bent(40.0, -kappa, -kappa)) == test::near(40.0, 1e-6));  // the tangents are those of elements
    CHECK(angle(bent(90.0, kappa, kappa)) ==
          test::near(
              std::asin(std::sqrt(1.0 - std::pow(std::sin(critical * std::numbers::pi / 180.0), 2))) * 180.0 / std::numbers::pi,
              1e-3));
}

TEST_CASE("fibres that run side by side and splay where they end do not cross, however great the angle there is") {
    // One is straight; the other runs beside and above it, and in its last four radii turns by 45 degrees, until its end is right
    // above the first one's.
    const double aside = 1.5 * r, angle = 0.25 * std::numbers::pi, turn = aside / (1.0 - std::cos(angle)), along = 96.0 * r,
                 all = along + turn * angle;
    const auto splayed = [=](double t) {
        const double arc = std::max(0.0, (t * all - along) / turn);
        return Vec3(std::min(t * all, along) + turn * std::sin(arc), turn * (1.0 - std::cos(arc)) - aside, 2.0 * r);
    };
    const Mesh mesh = mesh_of({straight_fibre({0, 0, 0}, {splayed(1.0).x(), 0, 0}, r, 80), curved_fibre(splayed, r, 80)});
    const auto angle_of = [&](double from) {
        proximity::ProximityZone ending = zone_of(from, 80, from, 80);
        ending.closest_i = ending.closest_j = 80;
        return contact::crossing_angle_deg(mesh, mesh.rest_state(), ending);
    };
    CHECK(angle_of(79.0) == test::near(45.0, 0.02));  // of the ends alone; an element is 1.25 radii long
    CHECK(angle_of(0.0) == test::near(std::asin(1.5 / 99.6) * 180.0 / std::numbers::pi, 1e-2));  // 1.5 radii apart over 99.6
}

TEST_CASE(
    "a straight crossing is one from its angle, however long its zone, and an arc around another fibre from that of its second "
    "variation") {
    for (const double angle : {20.0, 31.0, 45.0, 90.0})
        for (const double length : {3.0, 30.0}) {
            const Vec3 half = 0.5 * length * r *
                              Vec3(std::cos(angle * std::numbers::pi / 180.0), std::sin(angle * std::numbers::pi / 180.0), 0);
            const Mesh mesh = mesh_of({straight_fibre({-0.5 * length * r, 0, 0}, {0.5 * length * r, 0, 0}, r, 10),
                                       straight_fibre(Vec3(0, 0, 2.0 * r) - half, Vec3(0, 0, 2.0 * r) + half, r, 10)});
            CHECK(contact::crossing_angle_deg(mesh, mesh.rest_state(), zone_of(0, 10, 0, 10)) == test::near(angle, 1e-6));
        }
    // A quarter of a circle of 4 radii, whose middle is 2 radii above the other one: the distance grows with half of the second
    // variation of straight lines, and over the whole arc as fast.
    const auto arc = [](double t) {
        return Vec3(0, 4.0 * r * std::sin((t - 0.5) * std::numbers::pi), 4.0 * r * std::cos((t - 0.5) * std::numbers::pi));
    };
    const Mesh mesh = mesh_of({straight_fibre({-r, 0, 2.0 * r}, {r, 0, 2.0 * r}, r, 10), curved_fibre(arc, r, 40)});
    CHECK(contact::crossing_angle_deg(mesh, mesh.rest_state(), zone_of(0, 10, 0, 40)) == test::near(45.0, 0.01));
}

}  // namespace intermediate_geometry_test

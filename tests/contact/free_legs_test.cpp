// SPDX-License-Identifier: MIT
// How easily a fibre that hangs in another one swings aside: loops do, fibres of a cloth do not, nor a loop that others hold.
#include "two_fibres.hpp"

#include <fibrant/contact/followed_places.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace free_legs_test {

const double r = 0.05, R = 20.0 * r, pi = std::numbers::pi;

/// Half rings that hang in each other at a right angle; the middle of each lies at half of its elements.
std::vector<scene::FibreSpecification> hooks(Index elements) {
    return {test::curved_fibre([](double t) { return Vec3(-R * std::cos(pi * t), 0.0, R - R * std::sin(pi * t)); }, r, elements),
            test::curved_fibre([](double t) { return Vec3(0.0, R * std::cos(pi * t), 2.0 * r - R + R * std::sin(pi * t)); }, r,
                               elements)};
}

/// Of two fibres, where they are closest at half of the elements.
double swing(const test::Mesh& mesh, std::vector<contact::Zone> others = {}) {
    const double middle = 0.5 * static_cast<double>(mesh.fibre(0).elements);
    proximity::ProximityZone zone = test::zone_of(middle - 0.5, middle + 0.5, middle - 0.5, middle + 0.5);
    zone.distance = 2.0 * r;
    others.emplace_back().span = zone;
    const contact::PairGeometry pair = contact::pair_geometry(mesh, mesh.rest_state(), 0, 1, middle, middle);
    return contact::swing_of(mesh, mesh.rest_state(), zone, pair, contact::ZonesOfFibres(others));
}

TEST_CASE("half rings swing aside by curvature x leg x sine of its turn, whatever their elements") {
    // Legs of a quarter of a circle turn by a right angle: (1 / R) (pi R / 2) 1. A patch of a radius to either side and chords
    // along the leg take off less than a hundredth.
    for (const Index elements : {20, 41, 80}) CHECK(swing(test::mesh_of(hooks(elements))) == test::near(0.5 * pi, 1e-2));
}

TEST_CASE("waves of a cloth hold each other, but where it is as good as jammed") {
    // Sine waves of amplitude r: legs end where they bend back, at a quarter of a wave of 10 to 20 radii, and turn by 32 to 17
    // degrees.
    for (const double wave : {10.0, 14.0, 20.0}) {
        const auto wavy = [&](bool along_y) {
            return test::curved_fibre(
                [=](double t) {
                    const double s = (2.0 * t - 1.0) * 20.0 * r, z = r * std::cos(2.0 * pi * s / (wave * r));
                    return along_y ? Vec3(0.0, s, -z) : Vec3(s, 0.0, z);
                },
                r, 60);
        };
        CHECK(swing(test::mesh_of({wavy(false), wavy(true)})) == 0.0);
    }
}

TEST_CASE("rings that wind around each other lie along each other, and do not hang") {
    const auto ring = [](double away) {  // from the axis, at this angle
        return test::curved_fibre(
            [=](double t) {
                const double a = 2.0 * pi * t;
                return Vec3((R + r * std::cos(a + away)) * std::cos(a), (R + r * std::cos(a + away)) * std::sin(a),
                            r * std::sin(a + away));
            },
            r, 40);
    };
    CHECK(swing(test::mesh_of({ring(0.0), ring(pi)})) == 0.0);
}

TEST_CASE("a leg ends where another fibre lies on it") {
    const test::Mesh mesh = test::mesh_of(hooks(40));
    contact::Zone other;
    other.span.fibre_i = 0, other.span.fibre_j = 1, other.span.closest_i = 24.0, other.span.closest_j = 2.0;
    other.span.distance = 2.0 * r;
    const double beside = swing(mesh, {other, other});
    CHECK(beside > 1.0);  // the other ring is free
    other.span.closest_i = 10.0, other.span.closest_j = 16.0;
    contact::Zone third = other;
    third.span.closest_i = 24.0, third.span.closest_j = 24.0;
    CHECK(swing(mesh, {other, third}) < 0.5 * beside);
    other.span.distance = third.span.distance = 3.0 * r;  // which it does not touch
    CHECK(swing(mesh, {other, third}) == test::near(0.5 * pi, 1e-2));
}

}  // namespace free_legs_test

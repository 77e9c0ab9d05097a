// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"

#include <fibrant/observe/least_gap.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <near.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace fibrant;

namespace least_gap_test {

constexpr double pi = std::numbers::pi;

Vec3 heading(double degrees) { return {std::cos(degrees * pi / 180.0), std::sin(degrees * pi / 180.0), 0.0}; }

/// A fibre along a curve, its first director `tilt` from the horizontal, turned by `twist` per length.
template <class Curve>
observe::FibreSnapshot fibre(double a, double b, const Curve& curve, double from, double to, int elements, double tilt,
                             double twist = 0.0) {
    observe::FibreSnapshot made;
    made.section = {a, b};
    for (int k = 0; k <= 2 * elements; ++k) {
        const double s = from + (to - from) * k / (2 * elements);
        const Vec3 t = ((curve(s + 1e-5) - curve(s - 1e-5)) / 2e-5).normalized();
        const Vec3 side = Vec3::UnitZ().cross(t).normalized(), up = t.cross(side);
        const double angle = tilt + twist * s;
        made.position.push_back(curve(s));
        made.director_1.push_back(std::cos(angle) * side + std::sin(angle) * up);
        made.director_2.push_back(-std::sin(angle) * side + std::cos(angle) * up);
    }
    return made;
}
observe::FibreSnapshot straight(double a, double b, const Vec3& middle, const Vec3& along, double half, double tilt) {
    return fibre(
        a, b, [&](double s) { return Vec3(middle + s * along); }, -half, half, 12, tilt);
}

/// Distance of two surfaces, point against point: a grid over both, refined about its best places. It knows of no normal and no
/// extent.
double sampled_distance(const observe::FibreSnapshot& one, const observe::FibreSnapshot& other, int along = 40, int around = 20) {
    struct Surface {
        const observe::FibreSnapshot* fibre;
        observe::NodalCurve curve;
        Vec3 at(double place, double angle) const {  // beyond either end: on the flat end, towards its middle
            const double t = std::clamp(place, 0.0, curve.end()), out = 1.0 - std::abs(place - t);
            const Vec3 g_1 = curve.interpolate(std::span<const Vec3>{fibre->director_1}, t),
                       g_2 = curve.interpolate(std::span<const Vec3>{fibre->director_2}, t);
            return curve.position(t) + out * (fibre->section.semi_axis_1 * std::cos(angle) * g_1 +
                                              fibre->section.semi_axis_2 * std::sin(angle) * g_2);
        }
    };
    const Surface i{&one, observe::NodalCurve{one.position}}, j{&other, observe::NodalCurve{other.position}};
    std::vector<Vec3> on_j;
    for (int m = 0; m <= along; ++m)
        for (int n = 0; n < around; ++n) on_j.push_back(j.at(j.curve.end() * m / along, 2.0 * pi * n / around));
    struct Place {
        double square;
        std::array<double, 4> x;
    };
    std::vector<Place> places;  // the closest of each place on i
    for (int m = 0; m <= along; ++m)
        for (int n = 0; n < around; ++n) {
            const double t = i.curve.end() * m / along, angle = 2.0 * pi * n / around;
            const Vec3 x = i.at(t, angle);
            Place best{std::numeric_limits<double>::infinity(), {}};
            for (std::size_t k = 0; k < on_j.size(); ++k) {
                const double square = (on_j[k] - x).squaredNorm();
                if (square < best.square)
                    best = {square,
                            {t, angle, j.curve.end() * static_cast<double>(static_cast<int>(k) / around) / along,
                             2.0 * pi * static_cast<double>(static_cast<int>(k) % around) / around}};
            }
            places.push_back(best);
        }
    std::sort(places.begin(), places.end(), [](const Place& a, const Place& b) { return a.square < b.square; });
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t p = 0; p < std::min<std::size_t>(6, places.size()); ++p) {
        Place place = places[p];
        std::array<double, 4> width{i.curve.end() / along, 2.0 * pi / around, j.curve.end() / along, 2.0 * pi / around};
        for (int pass = 0; pass < 400 && width[0] > 1e-9; ++pass) {  // the best of the neighbours, moved to or drawn closer about
            const Place about = place;
            for (int k = 0; k < 81; ++k) {
                std::array<double, 4> x = about.x;
                for (int c = 0, rest = k; c < 4; ++c, rest /= 3) x[core::at(c)] += width[core::at(c)] * (rest % 3 - 1);
                x[0] = std::clamp(x[0], -1.0, i.curve.end() + 1.0), x[2] = std::clamp(x[2], -1.0, j.curve.end() + 1.0);
                const double square = (j.at(x[2], x[3]) - i.at(x[0], x[1])).squaredNorm();
                if (square < place.square) place = {square, x};
            }
            if (place.square == about.square)
                for (double& w : width) w *= 0.6;
        }
        least = std::min(least, std::sqrt(place.square));
    }
    return least;
}

double found(const std::vector<observe::FibreSnapshot>& fibres, observe::OwnTurns own = observe::OwnTurns::left_out) {
    observe::Snapshot snapshot;
    snapshot.fibres = fibres;
    return observe::least_gap(snapshot, proximity::GridSearch{}, own).gap;
}

TEST_CASE("two parallel ellipses that are askew are apart, not deep in each other") {
    const auto one = straight(2.0, 1.0, Vec3::Zero(), heading(0), 40.0, 0.0),
               other = straight(2.0, 1.0, {0.0, 2.0, 1.8}, heading(0), 40.0, 0.0);
    CHECK(std::abs(found({one, other}) - 0.0653) < 1e-4);
    CHECK(std::abs(found({one, other}) - sampled_distance(one, other)) < 1e-6);
}

TEST_CASE(
    "flat fibres that cross at any angle, flat, tilted, on edge, are as far apart as their surfaces, and as deep in each other "
    "as they were moved") {
    for (const double ratio : {2.0, 5.0, 10.0})
        for (const double degrees : {5.0, 10.0, 20.0, 45.0, 90.0})
            for (int kind = 0; kind < 6; ++kind) {
                const std::array<double, 6> tilt_i{0.0, 0.0, 0.5 * pi, 0.4, 0.3, 0.0},
                    tilt_j{0.0, 0.5 * pi, 0.5 * pi, -0.4, 1.1, 0.0};
                const std::array<double, 6> a_i{ratio, ratio, ratio, ratio, ratio, 1.0};
                const std::size_t k = core::at(kind);
                const auto height = [](double a, double tilt) { return std::hypot(a * std::sin(tilt), std::cos(tilt)); };
                const double touching = height(a_i[k], tilt_i[k]) + height(ratio, tilt_j[k]), half = 30.0 * ratio;
                for (const double gap : {0.1, -0.02}) {
                    const auto one = straight(a_i[k], 1.0, Vec3::Zero(), heading(-0.5 * degrees), half, tilt_i[k]);
                    const auto other = straight(ratio, 1.0, {0.0, 0.0, touching + gap}, heading(0.5 * degrees), half, tilt_j[k]);
                    CAPTURE(ratio);
                    CAPTURE(degrees);
                    CAPTURE(kind);
                    CHECK(std::abs(found({one, other}) - gap) < 1e-9);
                }
            }
}

TEST_CASE("bent, twisted and tapered fibres are as far apart as points of their surfaces") {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    int tried = 0;
    for (int n = 0; n < 60; ++n) {
        const double degrees = 90.0 * std::abs(unit(generator)), bend = 0.01 * unit(generator),
                     other_bend = 0.01 * unit(generator);
        const double twist = 0.03 * unit(generator), tilt = 3.0 * unit(generator), ratio = 1.0 + 2.0 * std::abs(unit(generator));
        const Vec3 u = heading(0), v = heading(degrees),
                   apart(unit(generator), unit(generator), 3.5 + 2.0 * std::abs(unit(generator)));
        auto one = fibre(
            ratio, 1.0, [&](double s) { return Vec3(s * u + bend * s * s * Vec3::UnitZ()); }, -20.0, 20.0, 10, tilt, twist);
        const auto other = fibre(
            2.0, 0.7, [&](double s) { return Vec3(apart + s * v + other_bend * s * s * Vec3(0.2, 0.3, 1.0)); }, -15.0, 18.0, 9,
            -0.7 * tilt, -twist);
        if (n % 3 == 0)  // pressed flat in its middle
            for (std::size_t k = 0; k < one.position.size(); ++k) {
                const double part = 0.4 * std::exp(-0.01 * one.position[k].squaredNorm());
                one.director_1[k] *= 1.0 + part, one.director_2[k] *= 1.0 - part;
            }
        const double expected = sampled_distance(one, other), gap = found({one, other});
        if (expected < 0.05) continue;  // in each other
        ++tried;
        CAPTURE(n);
        CAPTURE(gap);
        CAPTURE(expected);
        CHECK(std::abs(gap - expected) < 1e-5);
    }
    CHECK(tried > 20);
}

TEST_CASE("a round fibre that is pressed flat is further from another beside it, and nearer to one that it was pressed towards") {
    const auto round = straight(1.0, 1.0, Vec3::Zero(), heading(0), 20.0, 0.0);
    auto pressed = straight(1.0, 1.0, Vec3(0, 1.9, 1.4), heading(0), 20.0, 0.0);
    for (std::size_t k = 0; k < pressed.position.size(); ++k) pressed.director_1[k] *= 1.25, pressed.director_2[k] *= 0.8;
    CHECK(std::abs(found({round, straight(1.0, 1.0, Vec3(0, 1.9, 1.4), heading(0), 20.0, 0.0)}) - (std::hypot(1.9, 1.4) - 2.0)) <
          1e-12);
    CHECK(std::abs(found({round, pressed}) - sampled_distance(round, pressed)) < 1e-6);
}

TEST_CASE("the end of a flat fibre that faces the side of another counts as it is") {
    const auto side = straight(3.0, 1.0, Vec3::Zero(), heading(0), 20.0, 0.0);
    for (const double tilt : {0.0, 0.6, 0.5 * pi})
        for (const double degrees : {90.0, 60.0}) {
            const Vec3 along = heading(degrees);
            const auto end = straight(3.0, 1.0, Vec3(0.3, 5.0, 0.5) + 15.2 * along, along, 15.0, tilt);
            CHECK(std::abs(found({side, end}) - sampled_distance(side, end, 120)) < 1e-5);
        }
}

TEST_CASE("the turns of one fibre are held against each other where that is asked for") {
    // A hairpin of a flat fibre, legs 5 apart over each other: flat on flat, and a straight one, which is nowhere close to
    // itself.
    const double leg = 30.0, radius = 2.5;
    const auto hairpin = [&](double s) {
        if (s < leg) return Vec3(s, 0.0, 0.0);
        const double angle = (s - leg) / radius;
        if (angle < pi) return Vec3(leg + radius * std::sin(angle), 0.0, radius - radius * std::cos(angle));
        return Vec3(leg - (s - leg - pi * radius), 0.0, 2.0 * radius);
    };
    observe::FibreSnapshot flat = fibre(2.0, 0.9, hairpin, 0.0, 2.0 * leg + pi * radius, 60, 0.0);
    for (std::size_t k = 0; k < flat.position.size(); ++k) {  // across the plane of the bend
        flat.director_1[k] = Vec3::UnitY();
        flat.director_2[k] = Vec3::UnitY()
                                 .cross(k + 1 < flat.position.size() ? Vec3(flat.position[k + 1] - flat.position[k])
                                                                     : Vec3(flat.position[k] - flat.position[k - 1]))
                                 .normalized();
    }
    CHECK(std::isinf(found({flat})));
    CHECK(std::abs(found({flat}, observe::OwnTurns::counted) - (2.0 * radius - 1.8)) < 2e-3);  // the bend in elements
    CHECK(std::isinf(found({straight(2.0, 1.0, Vec3::Zero(), heading(0), 40.0, 0.0)}, observe::OwnTurns::counted)));
}

TEST_CASE("of fibres side by side that are wound around each other what is deepest is found whatever is passed over") {
    // Seven about one axis: bent towards each other, their sections strained by different parts.
    const double length = 40.0, turned = 1.2, apart = 1.993;
    std::mt19937 generator(11);
    observe::Snapshot snapshot;
    for (int k = 0; k < 7; ++k) {
        const double out = k == 0 ? 0.0 : apart, at = pi / 3.0 * k;
        const auto helix = [&](double s) {
            const double angle = at + turned * s / length;
            return Vec3(s, out * std::cos(angle), out * std::sin(angle));
        };
        observe::FibreSnapshot wound = fibre(1.0, 1.0, helix, 0.0, length, 10, 0.0);
        for (std::size_t node = 0; node < wound.position.size(); ++node) {
            wound.position[node] += 5e-4 * test::normal_vector(generator);
            const double strain = 2e-3 * std::sin(0.3 * static_cast<double>(node) + k);
            wound.director_1[node] *= 1.0 + strain, wound.director_2[node] *= 1.0 - strain;
        }
        snapshot.fibres.push_back(wound);
    }
    const observe::LeastGap deepest = observe::least_gap(snapshot, proximity::GridSearch{}, observe::OwnTurns::left_out, 0.0);
    double pairs = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 7; ++i)
        for (std::size_t j = i + 1; j < 7; ++j) pairs = std::min(pairs, found({snapshot.fibres[i], snapshot.fibres[j]}));
    CHECK(deepest.gap < -0.007);
    CHECK(deepest.gap == pairs);
    const auto places = observe::deep_places(snapshot, proximity::GridSearch{}, 0.007);
    REQUIRE(!places.empty());
    CHECK(places.front().gap == deepest.gap);
    // Node intervals alone, each with each, and nothing passed over.
    double sampled = std::numeric_limits<double>::infinity();
    const observe::FibreSurface one(snapshot.fibres[core::at(deepest.fibre_i)]),
        other(snapshot.fibres[core::at(deepest.fibre_j)]);
    for (double t = 0.0; t < one.curve().end(); t += 1.0)
        for (double u = std::max(0.0, t - 1.0); u < std::min(t + 2.0, other.curve().end()); u += 1.0)
            sampled = std::min(sampled, observe::PairedPieces(one, other, t, u).closest(t + 0.5, u + 0.5).gap);
    CHECK(deepest.gap == test::near(sampled, 1e-9));
}

TEST_CASE("every search finds the same gap, and neither order nor place of the fibres matters") {
    const auto one = straight(5.0, 1.0, Vec3::Zero(), heading(-5), 60.0, 0.2),
               other = straight(3.0, 1.0, {1.0, 2.0, 2.3}, heading(9), 60.0, -0.1);
    observe::Snapshot snapshot;
    snapshot.fibres = {one, other};
    const double gap = observe::least_gap(snapshot, proximity::BruteSearch{}).gap;
    CHECK(gap == found({one, other}));
    CHECK(std::abs(found({other, one}) - gap) < 1e-10);
}

}  // namespace least_gap_test

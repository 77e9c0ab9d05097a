// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"

#include <fibrant/contact/section_gap.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace fibrant;

namespace section_gap_test {

using contact::furthest_direction;
using contact::SectionAxes;

constexpr double pi = std::numbers::pi;
const Vec3 along = Vec3::UnitX();

SectionAxes ellipse(double a, double b, double angle) {
    return {a * Vec3(0, std::cos(angle), std::sin(angle)), b * Vec3(0, -std::sin(angle), std::cos(angle))};
}
double gap_along(const Vec3& n, const Vec3& d, const SectionAxes& i, const SectionAxes& j) {
    return d.dot(n) - i.extent(n) - j.extent(n);
}
double true_gap(const Vec3& d, const SectionAxes& i, const SectionAxes& j, const Vec3& side) {
    return gap_along(furthest_direction(d, i, j, along, side), d, i, j);
}

/// Distance between two contours that are apart, point against point, the finest spacing refined about the best; it knows nothing
/// of directions.
double sampled_distance(const Vec3& d, const SectionAxes& i, const SectionAxes& j) {
    double s = 0.0, t = 0.0, width = pi, least = std::numeric_limits<double>::infinity();
    for (int pass = 0; pass < 14; ++pass, width *= 0.2) {
        const double about_s = s, about_t = t;
        for (int m = -60; m <= 60; ++m)
            for (int n = -60; n <= 60; ++n) {
                const double p = about_s + width * m / 60.0, q = about_t + width * n / 60.0;
                const Vec3 apart =
                    d + std::cos(q) * j.first + std::sin(q) * j.second - std::cos(p) * i.first - std::sin(p) * i.second;
                if (apart.norm() < least) least = apart.norm(), s = p, t = q;
            }
    }
    return least;
}
/// Least way that parts two that are in each other, over fine directions.
double sampled_depth(const Vec3& d, const SectionAxes& i, const SectionAxes& j) {
    double most = -std::numeric_limits<double>::infinity();
    for (int k = 0; k < 200000; ++k) {
        const double angle = 2.0 * pi * k / 200000;
        most = std::max(most, gap_along({0, std::cos(angle), std::sin(angle)}, d, i, j));
    }
    return most;
}

TEST_CASE("two parallel ellipses side by side and askew are as far apart as their contours") {
    const SectionAxes one = ellipse(2.0, 1.0, 0.0);
    const Vec3 d(0.0, 2.0, 1.8);
    CHECK(std::abs(true_gap(d, one, one, d.normalized()) - sampled_distance(d, one, one)) < 1e-9);
    CHECK(std::abs(true_gap(d, one, one, d.normalized()) - 0.065) < 5e-4);
    // what the line of the centres says of them: deep in each other
    CHECK(gap_along(d.normalized(), d, one, one) < -0.56);
}

TEST_CASE(
    "the gap of ellipses of any shape, turn and strain is the distance of their contours, or less the least way that parts "
    "them") {
    std::mt19937 generator(1);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int apart = 0, within = 0;
    for (int n = 0; n < 60; ++n) {
        SectionAxes one = ellipse(1.0 + 9.0 * unit(generator), 1.0, pi * unit(generator)),
                    other = ellipse(1.0 + 4.0 * unit(generator), 0.5, pi * unit(generator));
        if (n % 3 == 0)
            for (Vec3* axis : {&one.first, &one.second, &other.first, &other.second})
                *axis += 0.2 * test::normal_vector(generator).cwiseProduct(Vec3(0, 1, 1));
        const double angle = 2.0 * pi * unit(generator), size = 1.0 + 10.0 * unit(generator);
        const Vec3 d = size * Vec3(0, std::cos(angle), std::sin(angle));
        const double found = true_gap(d, one, other, d.normalized());
        if (found > 0.0) {
            ++apart;
            CHECK(std::abs(found - sampled_distance(d, one, other)) < 1e-7);
        } else {
            ++within;
            CHECK(std::abs(found - sampled_depth(d, one, other)) < 1e-7 * std::abs(found) + 1e-8);
        }
    }
    CHECK(apart > 15);
    CHECK(within > 15);
}

TEST_CASE("apart, the direction does not depend on the side that is remembered, as long as it is that side") {
    std::mt19937 generator(2);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    int tried = 0;
    for (int n = 0; n < 200; ++n) {
        const SectionAxes one = ellipse(1.0 + 9.0 * unit(generator), 1.0, pi * unit(generator)),
                          other = ellipse(1.0 + 9.0 * unit(generator), 1.0, pi * unit(generator));
        const double angle = 2.0 * pi * unit(generator);
        const Vec3 d = 20.0 * unit(generator) * Vec3(0, std::cos(angle), std::sin(angle));
        const Vec3 best = furthest_direction(d, one, other, along, d.normalized());
        if (gap_along(best, d, one, other) < 1e-6) continue;
        for (int k = 0; k < 12; ++k) {
            const Vec3 side(0.0, std::cos(pi * k / 6.0 + 0.01), std::sin(pi * k / 6.0 + 0.01));
            if (side.dot(best) < 1e-3) continue;
            ++tried;
            CHECK((furthest_direction(d, one, other, along, side) - best).norm() < 1e-6);
        }
    }
    CHECK(tried > 300);
}

TEST_CASE("flat sections that have passed each other are pushed back the way they came") {
    for (const double ratio : {1.5, 2.0, 5.0, 10.0})
        for (const double turn : {0.0, 0.2, 1.0, 0.5 * pi}) {
            const SectionAxes one = ellipse(ratio, 1.0, turn), other = ellipse(ratio, 1.0, -0.5 * turn);
            Vec3 remembered = Vec3::UnitZ();
            for (int k = 60; k >= -60; --k) {
                const Vec3 next = furthest_direction({0.0, 0.0, 0.05 * k}, one, other, along, remembered);
                CHECK(std::abs(next.norm() - 1.0) < 1e-14);
                CHECK(next.dot(remembered) > -1e-12);
                if (turn == 0.0) CHECK(next.z() > 1.0 - 1e-12);
                remembered = next;
            }
        }
}

TEST_CASE(
    "the derivatives of the gap are its direction and the particles that touch, and of second order is how the direction turns") {
    const SectionAxes one = ellipse(3.0, 1.0, 0.3), other = ellipse(2.0, 1.0, -0.4);
    for (const double size : {4.2, 3.0}) {  // apart, and in each other
        const Vec3 d = size * Vec3(0.0, 0.8, 0.6), side = d.normalized();
        const Vec3 n = furthest_direction(d, one, other, along, side);
        const contact::NormalTurn turn = contact::normal_turn(d, one, other, along, n);
        CHECK(turn.length > 0.0);
        CHECK(std::abs(turn.across.dot(n)) < 1e-14);
        const double step = 1e-5;
        for (const Vec3& way : {Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
            const double slope =
                (true_gap(d + step * way, one, other, side) - true_gap(d - step * way, one, other, side)) / (2.0 * step);
            CHECK(std::abs(slope - n.dot(way)) < 1e-9);
            const Vec3 turned = (furthest_direction(d + step * way, one, other, along, side) -
                                 furthest_direction(d - step * way, one, other, along, side)) /
                                (2.0 * step);
            CHECK((turned - turn.across.dot(way) / turn.length * turn.across).norm() < 1e-6);
            for (int axis = 0; axis < 2; ++axis) {
                const auto with = [&](double by) {
                    SectionAxes moved = one;
                    (axis == 0 ? moved.first : moved.second) += by * way;
                    return true_gap(d, moved, other, side);
                };
                const double weight =
                    (axis == 0 ? one.first : one.second).dot(n) / one.extent(n);  // of the particle furthest along n
                CHECK(std::abs((with(step) - with(-step)) / (2.0 * step) + weight * n.dot(way)) < 1e-9);
            }
        }
    }
}

TEST_CASE("round sections are furthest apart along the line of their centres, and turn by the distance of the centres") {
    std::mt19937 generator(4);
    for (int n = 0; n < 100; ++n) {
        const Vec3 d = test::normal_vector(generator).cwiseProduct(Vec3(0, 1, 1)),
                   side = (d.normalized() + Vec3(0, 0.3, -0.2)).normalized();
        if (d.dot(side) < 0.05 * d.norm()) continue;
        const SectionAxes one = ellipse(0.7, 0.7, 0.1 * n), other = ellipse(0.4, 0.4, 0.3 * n);
        const Vec3 found = furthest_direction(d, one, other, along, side);
        CHECK((found - d.normalized()).norm() < 1e-12);
        CHECK(std::abs(contact::normal_turn(d, one, other, along, found).length / d.norm() - 1.0) < 1e-12);
    }
}

TEST_CASE("two mirror images of a pair have mirror images of a direction") {
    const Mat3 mirror = Vec3(1, -1, 1).asDiagonal();
    std::mt19937 generator(5);
    for (int n = 0; n < 100; ++n) {
        const SectionAxes one = ellipse(4.0, 1.0, 0.05 * n), other = ellipse(2.0, 1.0, -0.11 * n);
        const Vec3 d = 4.0 * test::normal_vector(generator).cwiseProduct(Vec3(0, 1, 1));
        const Vec3 found = furthest_direction(d, one, other, along, d.normalized());
        const auto image = [&](const SectionAxes& axes) { return SectionAxes{mirror * axes.first, mirror * axes.second}; };
        CHECK((furthest_direction(mirror * d, image(one), image(other), along, mirror * d.normalized()) - mirror * found).norm() <
              1e-9);
        CHECK((furthest_direction(-d, other, one, along, -d.normalized()) + found).norm() <
              1e-9);  // and which comes first does not matter
    }
}

}  // namespace section_gap_test

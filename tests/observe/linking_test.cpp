// SPDX-License-Identifier: MIT
// Linking integrals of known links, of pieces in closed form, and of far runs against all pairs.
#include "../refusal.hpp"
#include <near.hpp>

#include <fibrant/observe/linking.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace linking_test {

using namespace fibrant;
using namespace fibrant::observe;
constexpr double pi = std::numbers::pi;

template <class Curve>
std::vector<Vec3> closed(const Curve& curve, Index n) {
    std::vector<Vec3> points;
    for (Index k = 0; k < n; ++k) points.push_back(curve(2.0 * pi * static_cast<double>(k) / static_cast<double>(n)));
    points.push_back(points.front());
    return points;
}

TEST_CASE("two linked rings have a linking number of one, whatever their chords, places and hand; rings apart none") {
    const auto flat = [](double a) { return Vec3(std::cos(a), std::sin(a), 0.0); };
    const auto upright = [](double a) { return Vec3(1.0 + std::cos(a), 0.0, std::sin(a)); };
    for (const Index n : {8, 16, 301}) {
        const std::vector<Vec3> a = closed(flat, n), b = closed(upright, n + 3);
        CHECK(std::abs(std::abs(linking_integral(a, b, true)) - 1.0) < 1e-12);
        std::vector<Vec3> back(b.rbegin(), b.rend());
        CHECK(linking_number(a, b) == -linking_number(a, back));
        CHECK(linking_number(a, b) == linking_number(b, a));
        std::vector<Vec3> away = b;
        for (Vec3& x : away) x += Vec3(2.5, 0.3, 0.0);
        CHECK(linking_number(a, away) == 0);
        const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
        std::vector<Vec3> a2, b2;
        for (const Vec3& x : a) a2.push_back(turn * x + Vec3(5, -3, 2));
        for (const Vec3& x : b) b2.push_back(turn * x + Vec3(5, -3, 2));
        CHECK(std::abs(linking_integral(a2, b2, true) - linking_integral(a, b, true)) < 1e-12);
    }
    CHECK(test::refusal([&] {
              linking_number(std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}, closed(flat, 8));
          }).find("open curve") != std::string::npos);
}

TEST_CASE("a torus link of 2 and 2 k strands has the linking number k") {
    for (const int k : {1, 2, 5}) {
        const auto strand = [&](double start) {
            return closed(
                [&, start](double a) {
                    const double f = k * a + start;
                    return Vec3((3.0 + std::cos(f)) * std::cos(a), (3.0 + std::cos(f)) * std::sin(a), std::sin(f));
                },
                200 * k);
        };
        CHECK(std::abs(linking_number(strand(0.0), strand(pi))) == k);
        CHECK(std::abs(std::abs(linking_integral(strand(0.0), strand(pi), true)) - k) < 1e-12);
    }
}

TEST_CASE("two pieces across each other link by what their distance says") {
    // Half lengths L at a distance D: arctan(L^2 / (D sqrt(2 L^2 + D^2))) / pi.
    for (const double half : {2.0, 6.0, 12.0}) {
        const double d = 2.0;
        const double found = segment_linking(Vec3(-half, 0, 0), Vec3(half, 0, 0), Vec3(0, -half, d), Vec3(0, half, d));
        CHECK(std::abs(found) == test::near(std::atan(half * half / (d * std::sqrt(2.0 * half * half + d * d))) / pi, 1e-12));
    }
}

TEST_CASE("two runs that are far from each other are told by two terms, to the square of what they reach over their distance") {
    std::vector<Vec3> a, b;
    for (Index k = 0; k <= 6; ++k) {
        const double t = 0.1 * static_cast<double>(k);
        a.emplace_back(t, t * t, 0.2 * std::sin(3.0 * t)), b.emplace_back(0.3 * std::cos(2.0 * t), t, t * t);
    }
    const Vec3 way = Vec3(1, 2, -1).normalized();
    double before = 0.0;
    for (const double distance : {10.0, 20.0, 40.0}) {
        std::vector<Vec3> away = b;
        for (Vec3& x : away) x += distance * way;
        const double exact = linking_integral(a, away, true);
        const double two = detail::far_linking(detail::LinkingTree(a).nodes()[0], detail::LinkingTree(away).nodes()[0]);
        const double error = std::abs(two / exact - 1.0);
        CHECK(error < 0.01);
        if (before > 0.0) CHECK(error < 0.35 * before);  // a fourth, but for what comes after
        before = error;
    }
}

TEST_CASE("far runs taken together change the integral by a part of what is far") {
    std::vector<Vec3> a, b;
    for (Index k = 0; k <= 4000; ++k) {
        const double t = 0.05 * static_cast<double>(k);
        a.emplace_back(t, std::sin(t), 0.3 * std::cos(2.0 * t)), b.emplace_back(t, std::cos(1.1 * t), 1.0 + 0.2 * std::sin(t));
    }
    CHECK(std::abs(linking_integral(a, b) - linking_integral(a, b, true)) <
          1e-6);  // (0.01)^2 of the ten-thousandth that far runs add up to, and room
}

}  // namespace linking_test

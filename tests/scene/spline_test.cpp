// SPDX-License-Identifier: MIT
// Curves through points and beside paths: order of their error, continuity, closure, lengths in closed form.
#include "../refusal.hpp"
#include <near.hpp>

#include <fibrant/scene/spline.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

namespace spline_test {

using namespace fibrant;
using namespace fibrant::scene;
constexpr double pi = std::numbers::pi;

std::vector<Vec3> on_circle(Index n) {
    std::vector<Vec3> points;
    for (Index k = 0; k <= n; ++k) {
        const double a = 2.0 * pi * static_cast<double>(k % n) / static_cast<double>(n);
        points.emplace_back(std::cos(a), std::sin(a), 0.0);
    }
    return points;
}

TEST_CASE(
    "a closed spline through points of a circle is off by the fourth power of their distance, and closes in slope and "
    "curvature") {
    double before = 0.0;
    for (const Index n : {8, 16, 32}) {
        const Spline spline(on_circle(n), SplineEnds::repeating);
        double off = 0.0;
        for (Index k = 0; k < 500; ++k) off = std::max(off, std::abs(spline(static_cast<double>(k) / 500.0).norm() - 1.0));
        if (before > 0.0) CHECK(before / off == test::near(16.0, 0.2));
        before = off;
        CHECK((spline.derivative(0.0) - spline.derivative(1.0)).norm() < 1e-12);
        CHECK((spline.second(0.0) - spline.second(1.0)).norm() < 1e-10);
    }
}

TEST_CASE("a spline goes through its points, with continuous curvature, whatever its ends and however uneven the points are") {
    const std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(1, 0.3, 0), Vec3(1.2, 0.8, 0.4), Vec3(3, 0.5, -0.2), Vec3(3.5, 1, 0)};
    for (const SplineEnds ends : {SplineEnds::parabolic, SplineEnds::natural}) {
        const Spline spline(points, ends);
        for (Index k = 0; k < 5; ++k) CHECK((spline(spline.parameter(k)) - points[core::at(k)]).norm() < 1e-14);
        for (Index k = 1; k < 4; ++k) {
            const double t = spline.parameter(k), h = 1e-9;
            CHECK((spline.second(t - h) - spline.second(t + h)).norm() < 1e-6 * spline.second(t).norm());
            const double step = 1e-6;
            const Vec3 slope = (spline(t + step) - spline(t - step)) / (2.0 * step);
            CHECK((slope - spline.derivative(t)).norm() < 1e-7 * slope.norm());
        }
        if (ends == SplineEnds::natural) CHECK(spline.second(0.0).norm() < 1e-12 * spline.second(0.5).norm());
    }
    // A parabola is given back by parabolic ends.
    std::vector<Vec3> parabola;
    for (Index k = 0; k <= 6; ++k) parabola.emplace_back(static_cast<double>(k), static_cast<double>(k * k), 0.0);
    const Spline same(parabola, SplineEnds::parabolic, SplineSteps::even);
    CHECK((same(0.3) - Vec3(1.8, 3.24, 0.0)).norm() < 1e-12);
    CHECK(test::refusal([] {
              Spline({Vec3(0, 0, 0), Vec3(0, 0, 0)}, SplineEnds::natural, SplineSteps::even, "path");
          }).find("path.points[1] = (0, 0, 0), but it must be another point") == 0);
}

TEST_CASE("a spline that repeats with a shift goes on as it began") {
    std::vector<Vec3> points;
    for (Index k = 0; k <= 12; ++k) points.emplace_back(static_cast<double>(k), std::sin(pi * static_cast<double>(k) / 6.0), 0.0);
    const Spline spline(points, SplineEnds::repeating);
    CHECK((spline.derivative(0.0) - spline.derivative(1.0)).norm() < 1e-12);
    CHECK((spline(1.0) - spline(0.0) - Vec3(12, 0, 0)).norm() < 1e-12);
}

TEST_CASE("the length of a circle is 2 pi R, and of a helix beside a line sqrt(1 + (2 pi a / H)^2) of its own") {
    const Curve circle = [](double t) { return Vec3(std::cos(2.0 * pi * t), std::sin(2.0 * pi * t), 0.0); };
    CHECK(length_of(circle) == test::near(2.0 * pi, 1e-10));
    const Curve line = [](double t) { return Vec3(0.0, 0.0, 6.0 * t); };
    for (const double a : {0.1, 0.3}) {
        const Curve helix = beside(line, a, 0.0, 3.0, 200, Vec3::UnitX());
        CHECK(length_of(helix) == test::near(6.0 * std::hypot(1.0, 2.0 * pi * a * 3.0 / 6.0), 1e-5));
        CHECK((helix(0.0) - Vec3(a, 0, 0)).norm() < 1e-12);
    }
    // Sections that do not twist: beside a circle at a distance in its plane lies a circle.
    const Curve outside = beside(circle, 0.2, 0.0, 0.0, 200, Vec3::UnitX(), SplineEnds::repeating);
    CHECK(length_of(outside) == test::near(2.0 * pi * 1.2, 1e-6));
    CHECK((outside(0.0) - outside(1.0)).norm() < 1e-12);
}

}  // namespace spline_test

// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"

#include <fibrant/proximity/segment_distance.hpp>

#include <near.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

using namespace fibrant;

namespace segment_distance_test {

using fibrant::proximity::segment_distance;
using fibrant::proximity::SegmentDistance;

using Long = Eigen::Matrix<long double, 3, 1>;

/// Distance by another way, in long double: the distance of a point that moves along one segment to the other segment is
/// convex, so thirds are cut off until nothing is left.
long double true_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
    const Long a_l = a.cast<long double>(), c_l = c.cast<long double>();
    const Long u = b.cast<long double>() - a_l, v = d.cast<long double>() - c_l;
    const long double vv = v.squaredNorm();
    const auto from = [&](long double s) -> long double {
        const Long x = a_l + s * u - c_l;
        const long double t = vv > 0 ? std::clamp<long double>(x.dot(v) / vv, 0, 1) : 0;
        return (x - t * v).norm();
    };
    long double low = 0, high = 1;
    for (int k = 0; k < 120; ++k) {  // (2/3)^120 = 7e-22
        const long double left = low + (high - low) / 3, right = high - (high - low) / 3;
        (from(left) < from(right) ? high : low) = from(left) < from(right) ? right : left;
    }
    return std::min({from(0), from(1), from(0.5L * (low + high))});
}

TEST_CASE("crossing segments are closest inside, parallel ones all along, and distant ones at their ends") {
    const SegmentDistance crossing = segment_distance({-1, 0, 0}, {4, 0, 0}, {0, -1, 0.5}, {0, 2, 0});
    CHECK(crossing.squared == test::near(0.25, 1e-12));
    CHECK(crossing.s == test::near(0.25, 1e-12));
    CHECK(crossing.t == test::near(0.5, 1e-12));
    CHECK(segment_distance({0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {-4, 0, 0}).squared == test::near(1.0, 1e-12));
    const SegmentDistance ends = segment_distance({0, 0, 0}, {1, 0, 0}, {3, 0, 1}, {1, 2, 5});
    CHECK(ends.squared == test::near(5.0, 1e-12));
    CHECK(ends.s == 1.0);
    CHECK(ends.t == 0.0);
}

TEST_CASE("segments without length are points") {
    CHECK(segment_distance({0, 0, 2}, {0, 0, 0}, {-1, 0, 0}, {2, 0, 0}).squared == test::near(4.0, 1e-12));
    CHECK(segment_distance({-1, 0, 0}, {2, 0, 0}, {0, 0, 2}, {0, 0, 0}).squared == test::near(4.0, 1e-12));
    CHECK(segment_distance({1, 2, 3}, {0, 0, 0}, {1, 2, 5}, {0, 0, 0}).squared == test::near(4.0, 1e-12));
    CHECK(segment_distance({1, 2, 3}, {0, 0, 0}, {1, 2, 3}, {0, 0, 0}).squared == 0.0);
}

TEST_CASE("the distance is right to 2e-12 at any angle, near-parallel first of all") {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    double worst = 0.0, worst_point = 0.0;
    for (int trial = 0; trial < 60000; ++trial) {
        // Angles 1 to 1e-12 and 0, lengths 1 to 200, distance about 1, the pair anywhere up to 1e6 from the origin.
        const double angle = trial % 13 == 12 ? 0.0 : std::pow(10.0, -(trial % 13));
        const double length = std::pow(200.0, uniform(random)), other_length = std::pow(200.0, uniform(random));
        const double offset = trial % 5 == 0 ? 0.0 : std::pow(10.0, 6.0 * uniform(random));
        const Vec3 along = test::uniform_vector(random).normalized();
        const Vec3 aside = along.cross(test::uniform_vector(random)).normalized();
        const Vec3 turned = (along + angle * (aside + 0.3 * along.cross(aside))) * (trial % 2 == 0 ? 1.0 : -1.0);
        const Vec3 a = offset * test::uniform_vector(random);
        const Vec3 b = a + length * along;
        const Vec3 c = a + aside * (0.2 + uniform(random)) + along * length * (2.0 * uniform(random) - 0.5);
        const Vec3 d = c + other_length * turned.normalized();
        const long double truth = true_distance(a, b, c, d);
        const SegmentDistance found = segment_distance(a, b - a, c, d - c);
        worst =
            std::max(worst, std::abs(static_cast<double>((std::sqrt(static_cast<long double>(found.squared)) - truth) / truth)));
        // The distance belongs to the parameters.
        const Vec3 between = (a - c) + found.s * (b - a) - found.t * (d - c);
        worst_point = std::max(worst_point, std::abs(between.norm() / std::sqrt(found.squared) - 1.0));
    }
    CHECK(worst < 2e-12);
    CHECK(worst_point < 1e-12);
    MESSAGE("largest relative error ", worst);
}

TEST_CASE("the branch-free form for whole vectors gives the same distance") {
    std::mt19937 random(2);
    for (int trial = 0; trial < 1000; ++trial) {
        const Vec3 a = test::uniform_vector(random), u = test::uniform_vector(random), b = test::uniform_vector(random),
                   v = test::uniform_vector(random);
        using proximity::detail::plain;
        const double least = proximity::detail::least_squared(plain(a) - plain(b), plain(u), plain(v));
        CHECK(least == test::near(segment_distance(a, u, b, v).squared, 1e-13));  // but for fused operations
    }
}

}  // namespace segment_distance_test

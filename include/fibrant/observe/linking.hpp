// SPDX-License-Identifier: MIT
#pragma once
/// @file Gauss's linking integral of two curves of chords: an integer for closed ones, however they are deformed without passing
/// through each other.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// Linking integral of the segments from p0 to p1 and from q0 to q1, in closed form (Klenin and Langowski 2000): the solid angle
/// of their difference, over 4 pi [1]. 0 where they lie in a plane.
inline double segment_linking(const Vec3& p0, const Vec3& p1, const Vec3& q0, const Vec3& q1) {
    const Vec3 a = q0 - p0, b = q0 - p1, c = q1 - p1, d = q1 - p0;
    // Solid angle of a triangle (van Oosterom and Strackee 1983), twice.
    const auto angle = [](const Vec3& x, const Vec3& y, const Vec3& z) {
        const double nx = x.norm(), ny = y.norm(), nz = z.norm();
        return 2.0 * std::atan2(x.dot(y.cross(z)), nx * ny * nz + x.dot(y) * nz + y.dot(z) * nx + z.dot(x) * ny);
    };
    return (angle(a, b, c) + angle(c, d, a)) / (4.0 * std::numbers::pi);
}

namespace detail {

/// Segments of one curve under a binary tree of runs: each knows its middle, its reach, the sum of its chords and their first
/// moments.
class LinkingTree {
public:
    explicit LinkingTree(std::span<const Vec3> points) : points_{points} { build(0, core::count(points) - 1); }

    struct Node {
        Index first, last;  ///< segments [first, last)
        Index right = -1;   ///< child; the left one follows its parent
        Vec3 middle, sum;
        Mat3 moment;   ///< sum of chord (x) (its middle - middle)
        double reach;  ///< of points from the middle
    };
    const std::vector<Node>& nodes() const noexcept { return nodes_; }
    std::span<const Vec3> points() const noexcept { return points_; }

private:
    static constexpr Index leaf = 8;
    Index build(Index first, Index last) {
        const Index own = core::count(nodes_);
        Node node{first, last, -1, Vec3::Zero(), points_[core::at(last)] - points_[core::at(first)], Mat3::Zero(), 0.0};
        for (Index k = first; k <= last; ++k) node.middle += points_[core::at(k)] / static_cast<double>(last - first + 1);
        for (Index k = first; k <= last; ++k) node.reach = std::max(node.reach, (points_[core::at(k)] - node.middle).norm());
        for (Index k = first; k < last; ++k) {
            const Vec3 &p = points_[core::at(k)], &q = points_[core::at(k + 1)];
            node.moment += (q - p) * (0.5 * (p + q) - node.middle).transpose();
        }
        nodes_.push_back(node);
        if (last - first > leaf) {
            const Index half = first + (last - first) / 2;
            build(first, half);
            const Index right = build(half, last);
            nodes_[core::at(own)].right = right;
        }
        return own;
    }
    std::span<const Vec3> points_;
    std::vector<Node> nodes_;
};

/// Integral over two runs that are far from each other, by the first terms of Taylor's series of the kernel about their middles.
inline double far_linking(const LinkingTree::Node& a, const LinkingTree::Node& b) {
    const Vec3 r = a.middle - b.middle;
    const double d = r.norm(), d3 = d * d * d;
    const Vec3 kernel = r / d3;
    const Mat3 slope = Mat3::Identity() / d3 - 3.0 * r * r.transpose() / (d3 * d * d);
    double sum = a.sum.cross(b.sum).dot(kernel);
    for (int j = 0; j < 3; ++j) {  // the places of a move the kernel forwards, those of b backwards
        const Vec3 ma = a.moment.col(j), mb = b.moment.col(j), s = slope.col(j);
        sum += ma.cross(b.sum).dot(s) - a.sum.cross(mb).dot(s);
    }
    return sum / (4.0 * std::numbers::pi);
}

}  // namespace detail

/// Linking integral of two curves of chords. Runs of chords that are farther from each other than a hundred times what they reach
/// are taken together, by two terms of a series: an error of (0.01)^2 of what is far, which is little; all else is exact but for
/// rounding.
/// @param first, second  points, at least two each; a closed curve ends with its first point
/// @param exact          take nothing together: time with the product of the counts
inline double linking_integral(std::span<const Vec3> first, std::span<const Vec3> second, bool exact = false) {
    for (const auto& points : {first, second}) core::require_at_least("linking_integral.points", core::count(points), 2);
    const detail::LinkingTree one(first), two(second);
    constexpr double far = 0.01;
    double sum = 0.0;
    std::vector<std::pair<Index, Index>> open{{0, 0}};
    while (!open.empty()) {
        const auto [i, j] = open.back();
        open.pop_back();
        const auto &a = one.nodes()[core::at(i)], &b = two.nodes()[core::at(j)];
        const double distance = (a.middle - b.middle).norm(), reach = a.reach + b.reach;
        if (!exact && reach < far * distance) {
            sum += detail::far_linking(a, b);
        } else if (a.right < 0 && b.right < 0) {
            for (Index k = a.first; k < a.last; ++k)
                for (Index l = b.first; l < b.last; ++l)
                    sum +=
                        segment_linking(first[core::at(k)], first[core::at(k + 1)], second[core::at(l)], second[core::at(l + 1)]);
        } else if (b.right < 0 || (a.right >= 0 && a.reach >= b.reach)) {
            open.emplace_back(i + 1, j), open.emplace_back(a.right, j);
        } else {
            open.emplace_back(i, j + 1), open.emplace_back(i, b.right);
        }
    }
    return sum;
}

/// Linking number of two closed curves, the integral rounded.
/// @throws std::invalid_argument where a curve does not end with its first point, or the integral is not a whole number: chords
/// that touch
inline Index linking_number(std::span<const Vec3> first, std::span<const Vec3> second) {
    for (const auto& points : {first, second})
        if (points.size() < 4 || points.front() != points.back())
            core::refuse("linking_number.points", "an open curve", "one that ends with its first point");
    double value = linking_integral(first, second);
    constexpr double whole = 1e-6;
    if (std::abs(value - std::round(value)) > whole) value = linking_integral(first, second, true);
    core::require(std::abs(value - std::round(value)) <= whole, "linking_number: integral", value,
                  "a whole number: the curves touch");
    return static_cast<Index>(std::llround(value));
}

}  // namespace fibrant::observe

// SPDX-License-Identifier: MIT
// Segments on the move: the first time at which two are close, against times looked at one by one, and the tree, against all
// pairs.
#include <fibrant/proximity/moving_segments.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

using namespace fibrant;

namespace moving_segments_test {

using proximity::MovingSegment;

/// Uniform numbers of a counter (splitmix64).
struct Uniform {
    std::uint64_t state;
    double operator()(double low, double high) {
        state += 0x9E3779B97F4A7C15ull;
        std::uint64_t z = state;
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull, z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return low + (high - low) * static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
    }
    Vec3 vector(double size) {
        const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
        return {x, y, z};
    }
};

MovingSegment random_segment(Uniform& uniform, double length, double motion) {
    const Vec3 start = uniform.vector(1.0), shift = uniform.vector(motion);
    return {start, start + uniform.vector(length), shift, shift + uniform.vector(0.3 * motion)};
}

/// Least distance over n + 1 times.
double least_of(const MovingSegment& a, const MovingSegment& b, int n, double until = 1.0) {
    double least = 1e300;
    for (int k = 0; k <= n; ++k) least = std::min(least, proximity::segment_distance(a, b, until * k / n).squared);
    return std::sqrt(least);
}

TEST_CASE(
    "two moving segments are close at the first time at which their distance is what was asked for, and never if it never is") {
    Uniform uniform{7};
    const auto never = [](double, double) { return false; };
    int close = 0;
    for (int trial = 0; trial < 1000; ++trial) {
        CAPTURE(trial);
        MovingSegment a = random_segment(uniform, 0.8, 1.5), b = random_segment(uniform, 0.8, 1.5);
        if (trial % 4 == 1)
            for (Vec3* x : {&a.start, &a.end, &a.start_motion, &a.end_motion, &b.start, &b.end, &b.start_motion, &b.end_motion})
                x->z() = 0.0;  // in one plane
        if (trial % 4 == 2)
            b.end = b.start + (a.end - a.start), a.end_motion = a.start_motion,
            b.end_motion = b.start_motion;  // parallel, and stay so
        const double near = 0.1, least = least_of(a, b, 4000), motion = proximity::relative_motion(a, b);
        const proximity::Approach at = proximity::first_approach(a, b, near, near, never);
        if (least < 0.1) CHECK(at.close);
        if (least > 0.102 + motion / 8000.0)
            CHECK_FALSE(at.close);  // times looked at are so far apart; a fiftieth is as good as nothing
        if (!at.close) continue;
        ++close;
        CHECK(at.distance < 0.1021);
        CHECK(std::sqrt(proximity::segment_distance(a, b, at.time).squared) == at.distance);
        if (at.time > 0.0) CHECK(least_of(a, b, 1000, at.time) > 0.1 - 1e-9);
    }
    CHECK(close > 60);
    CHECK(close < 900);
}

TEST_CASE("where a place is excused, segments come as close as the least distance that is asked for") {
    // One sinks straight onto the end of the other, where it may, and on through it.
    const MovingSegment lying{{-1, 0, 0}, {0, 0, 0}, Vec3::Zero(), Vec3::Zero()};
    MovingSegment sinking{{0, -1, 1}, {0, 1, 1}, {0, 0, -2}, {0, 0, -2}};
    const auto at_end = [](double s, double) { return s > 0.9; };
    const proximity::Approach met = proximity::first_approach(lying, sinking, 0.5, 0.01, at_end);
    CHECK(met.close);
    CHECK(met.distance < 0.0103);
    sinking.start.x() = sinking.end.x() = 0.1;  // past the end
    CHECK_FALSE(proximity::first_approach(lying, sinking, 0.5, 0.01, at_end).close);
    sinking.start.x() = sinking.end.x() = -0.3;
    const proximity::Approach before = proximity::first_approach(lying, sinking, 0.5, 0.01, at_end);
    CHECK(before.close);
    CHECK(std::abs(before.distance - 0.5) < 0.011);
}

TEST_CASE("the tree finds every pair that comes closer than its margins, each once, however far all move together") {
    Uniform uniform{11};
    for (const double together : {0.0, 3.0, 1000.0}) {
        std::vector<MovingSegment> segments;
        std::vector<double> margins;
        const Vec3 way = together * Vec3(0.6, -0.5, 0.7);
        for (int k = 0; k < 300; ++k) {
            MovingSegment segment = random_segment(uniform, 0.2, 0.2);
            segment.start_motion += way, segment.end_motion += way;
            segments.push_back(segment), margins.push_back(uniform(0.005, 0.06));
        }
        proximity::MovingTree tree(segments, margins);
        std::vector<std::vector<std::pair<Index, Index>>> parts(core::at(tree.make_tasks()));
        tree.visit_pairs([&](Index task, Index k, Index l) { parts[core::at(task)].emplace_back(k, l); });
        std::set<std::pair<Index, Index>> found;
        std::size_t visits = 0;
        for (const auto& part : parts) visits += part.size(), found.insert(part.begin(), part.end());
        CHECK(found.size() == visits);
        CHECK(visits < 300 * 299 / 2 / 8);  // and not all of them
        std::size_t close = 0;
        for (Index k = 0; k < 300; ++k)
            for (Index l = k + 1; l < 300; ++l) {
                const double near = margins[core::at(k)] + margins[core::at(l)];
                if (least_of(segments[core::at(k)], segments[core::at(l)], 50) >= near) continue;
                ++close;
                CHECK(found.contains({k, l}));
            }
        CHECK(close > 100);
    }
}

}  // namespace moving_segments_test

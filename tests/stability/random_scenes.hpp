// SPDX-License-Identifier: MIT
#pragma once
/// @file Random small scenes: seeded, the same on every machine.

#include <stability/small_scenes.hpp>

#include <fibrant/observe/least_gap.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>

namespace fibrant::test {

/// Uniform numbers of a counter (splitmix64), so that no library decides what a seed means.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed)
        : state_{mixed(seed ^ 0x5DEECE66Dull)} {}  // mixed, or the next seed would be a shift of this one
    double operator()(double low, double high) {
        state_ += 0x9E3779B97F4A7C15ull;
        return low + (high - low) * static_cast<double>(mixed(state_) >> 11) * 0x1p-53;
    }
    Vec3 vector(double size) {
        const double x = (*this)(-size, size), y = (*this)(-size, size), z = (*this)(-size, size);
        return {x, y, z};
    }

private:
    static std::uint64_t mixed(std::uint64_t z) {
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull, z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    std::uint64_t state_;
};

/// Greatest depth of two fibres in each other over the smaller radius, with their sections as they are: a soft fibre is pressed
/// flat by a hard one, to half of its width in some of these scenes. Less a radius at either end: ends are flat, and have no cap.
inline double deepest_between_ends(const SmallScene& scene, const SmallResult& result) {
    double deepest = -1e300;
    const auto within = [&](std::size_t f, std::size_t k) {
        const auto& line = result.centreline[f];
        return (line[k] - line.front()).norm() >= scene.fibres[f].radius &&
               (line[k] - line.back()).norm() >= scene.fibres[f].radius;
    };
    const auto width = [&](std::size_t f, std::size_t k, double share, const Vec3& direction) {  // half of it
        const auto& [one, two] = result.directors[f][k - 1];
        const auto& [next_one, next_two] = result.directors[f][k];
        return scene.fibres[f].radius *
               std::hypot((one + share * (next_one - one)).dot(direction), (two + share * (next_two - two)).dot(direction));
    };
    for (std::size_t i = 0; i < scene.fibres.size(); ++i)
        for (std::size_t j = i + 1; j < scene.fibres.size(); ++j)
            for (std::size_t a = 1; a < result.centreline[i].size(); ++a)
                for (std::size_t b = 1; b < result.centreline[j].size(); ++b) {
                    if (!within(i, a - 1) || !within(i, a) || !within(j, b - 1) || !within(j, b)) continue;
                    const Vec3 &from = result.centreline[i][a - 1], &to = result.centreline[i][a],
                               &start = result.centreline[j][b - 1], &end = result.centreline[j][b];
                    const ClosestPoints close = closest_points(from, to, start, end);
                    const Vec3 between = start + close.t * (end - start) - from - close.s * (to - from),
                               direction = between / std::max(close.distance, 1e-300);
                    const double depth = width(i, a, close.s, direction) + width(j, b, close.t, direction) - close.distance;
                    deepest = std::max(deepest, depth / std::min(scene.fibres[i].radius, scene.fibres[j].radius));
                }
    return deepest;
}

/// Two to five fibres of any direction in a small box, apart at the start; ends held in any way and moved by a few radii.
inline SmallScene random_scene(std::uint64_t seed) {
    Uniform uniform(seed);
    SmallScene scene;
    scene.friction = uniform(0.0, 1.0) < 0.3 ? 0.0 : uniform(0.05, 0.6);
    scene.allowed = std::pow(10.0, uniform(-3.0, -1.5));
    scene.spacing = uniform(1.0, 4.0);
    const int wanted = 2 + static_cast<int>(uniform(0.0, 3.999));
    std::vector<std::vector<Vec3>> lines;
    std::vector<double> radius;
    for (int tries = 0; tries < 200 && static_cast<int>(scene.fibres.size()) < wanted; ++tries) {
        SmallFibre f;
        f.radius = 0.02 * uniform(0.5, 2.0), f.young = 7300.0 * std::pow(10.0, uniform(-2.0, 2.0));
        const Vec3 middle = uniform.vector(0.1), along = uniform.vector(1.0).normalized();
        const double length = uniform(0.2, 1.5);
        f.from = middle - 0.5 * length * along, f.to = middle + 0.5 * length * along;
        f.elements = 2 + static_cast<Index>(uniform(0.0, 9.999));
        f.held_to = uniform(0.0, 1.0) < 0.2 ? Held::free : uniform(0.0, 1.0) < 0.3 ? Held::pinned : Held::clamped;
        const Vec3 whole = uniform.vector(0.06);
        f.move_from = whole, f.move_to = whole + uniform(-0.0002, 0.004) * length * along;  // a few buckle
        lines.push_back({f.from, f.to}), radius.push_back(f.radius);
        if (deepest(lines, radius) > -0.05 && lines.size() > 1) {  // in another one, or all but
            lines.pop_back(), radius.pop_back();
            continue;
        }
        scene.fibres.push_back(f);
    }
    scene.increments = 6;
    return scene;
}

/// Runs the scenes of seeds first, first + 1, ...: no exception, no number that is none, a reason where one stops, and where it
/// converges, balance, no fibre in another one beyond what sections give way, and none that the least gap does not tell.
inline void check_random_scenes(std::uint64_t first, std::uint64_t count) {
    std::uint64_t converged = 0, touching = 0;
    double worst = -1e300;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        CAPTURE(seed);
        const SmallScene scene = random_scene(seed);
        if (scene.fibres.size() < 2) continue;
        SmallResult result;
        CHECK_NOTHROW(result = run(scene));
        CHECK(result.finite());
        if (!result.report.converged) {
            CHECK(!result.report.reason.empty());
            std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), result.report.reason.c_str());
            continue;
        }
        ++converged, touching += result.report.contact.active > 0;
        const double depth = deepest_between_ends(scene, result);
        worst = std::max(worst, depth);
        // What the run itself says, and a fifth of a radius: where fibres cross there is one contact element, and beside it a
        // hard fibre lies a little in a soft one that it crushes to half its width. Three of the first thousand are deeper than a
        // tenth.
        CHECK(depth < result.report.contact.greatest_penetration / scene.radius() + 0.2);
        // Brute force along eighths of elements is off by their sag, and looks everywhere; least_gap looks where axes are
        // closest, a hundredth beside the deepest place where a section changes along the fibre, and takes the ends as well.
        if (depth > 0.0) CHECK(-observe::least_gap(result.snapshot, proximity::GridSearch{}).gap / scene.radius() > depth - 0.02);
        Vec3 sum = Vec3::Zero();
        double size = 0.0;
        for (const Vec3& support : result.support) sum += support, size += support.norm();
        // Fibres that are pulled have reactions far above what they exert on each other: the residual is a ten-thousandth of
        // those.
        CHECK(sum.norm() <= 1e-2 * size + 1e-4 * result.reactions + 1e-12);
    }
    std::printf("%llu of %llu converged, %llu with contact; deepest %.3f of a radius\n",
                static_cast<unsigned long long>(converged), static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(touching), worst);
    CHECK(2 * converged > count);  // others buckle, or lose their hold: they stop with a reason
    CHECK(touching > count / 10);
}

}  // namespace fibrant::test

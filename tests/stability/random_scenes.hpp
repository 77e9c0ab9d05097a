// SPDX-License-Identifier: MIT
#pragma once
/// @file Random small scenes: seeded, the same on every machine.

#include <stability/small_scenes.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>

namespace fibrant::test {

/// Uniform numbers of a counter (splitmix64), so that no library decides what a seed means.
class Uniform {
public:
    explicit Uniform(std::uint64_t seed) : state_{mixed(seed ^ 0x5DEECE66Dull)} {}  // mixed, or the next seed would be a shift of this one
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

/// The centrelines less a radius at either end: ends are flat, and have no cap that could be in another fibre.
inline double deepest_between_ends(const SmallScene& scene, const SmallResult& result) {
    std::vector<std::vector<Vec3>> lines = result.centreline;
    std::vector<double> radius;
    for (std::size_t f = 0; f < lines.size(); ++f) {
        radius.push_back(scene.fibres[f].radius);
        const Vec3 first = lines[f].front(), last = lines[f].back();
        std::erase_if(lines[f], [&](const Vec3& x) { return (x - first).norm() < radius[f] || (x - last).norm() < radius[f]; });
    }
    return deepest(lines, radius);
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
/// converges, balance and no fibre in another one beyond what sections give way.
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
        CHECK(depth < 0.1);
        Vec3 sum = Vec3::Zero();
        double size = 0.0;
        for (const Vec3& support : result.support) sum += support, size += support.norm();
        CHECK(sum.norm() <= 1e-2 * size + 1e-12);
    }
    std::printf("%llu of %llu converged, %llu with contact; deepest %.3f of a radius\n", static_cast<unsigned long long>(converged), static_cast<unsigned long long>(count),
                static_cast<unsigned long long>(touching), worst);
    CHECK(2 * converged > count);  // others buckle, or lose their hold: they stop with a reason
    CHECK(touching > count / 10);
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Random scenes whose fibres are driven far in few increments, and a look at every accepted one that shares no code with
/// contact.

#include <stability/random_scenes.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <cstdio>

namespace fibrant::test {

/// Two to four fibres of unequal radii that stand apart and are driven through where the others are, by up to fifty radii in one
/// to four increments: crossing, side by side, both at once, some held at one end only.
inline SmallScene far_scene(std::uint64_t seed) {
    Uniform uniform(seed);
    SmallScene scene;
    scene.friction = uniform(0.0, 1.0) < 0.5 ? 0.0 : uniform(0.05, 0.5);
    scene.increments = 1 + static_cast<Index>(uniform(0.0, 3.999));
    const int wanted = 2 + static_cast<int>(uniform(0.0, 2.999));
    const double thickest = std::pow(10.0, uniform(0.0, 1.0));
    const bool aligned = uniform(0.0, 1.0) < 0.3;
    std::vector<std::vector<Vec3>> lines;
    std::vector<double> radius;
    for (int tries = 0; tries < 200 && static_cast<int>(scene.fibres.size()) < wanted; ++tries) {
        SmallFibre f;
        f.radius = 0.02 * (scene.fibres.empty() ? 1.0 : std::pow(thickest, uniform(0.0, 1.0)));
        f.young = 7300.0 * std::pow(10.0, uniform(-1.0, 1.0));
        const Vec3 along = aligned ? Vec3(Vec3::UnitX() + uniform.vector(0.03)).normalized() : uniform.vector(1.0).normalized();
        const double length = f.radius * uniform(30.0, 100.0);
        const Vec3 middle = uniform.vector(0.3);
        f.from = middle - 0.5 * length * along, f.to = middle + 0.5 * length * along;
        f.elements = 6 + static_cast<Index>(uniform(0.0, 8.999));
        if (uniform(0.0, 1.0) < 0.15) f.held_to = Held::free;
        // Towards where others are, and beyond.
        const Vec3 aim = -middle * uniform(0.5, 3.0) + uniform.vector(0.1);
        f.move_from = f.move_to = std::min(1.0, 50.0 * f.radius / std::max(aim.norm(), 1e-9)) * aim;
        lines.push_back({f.from, f.to}), radius.push_back(f.radius);
        if (lines.size() > 1 && deepest(lines, radius) > -0.2) {
            lines.pop_back(), radius.pop_back();
            continue;
        }
        scene.fibres.push_back(f);
    }
    return scene;
}

/// Centrelines of all accepted states, at quarters of the elements.
template <simulation::Model M>
struct Ways {
    const simulation::Simulator<M>* simulator;
    std::vector<std::vector<std::vector<Vec3>>> lines{};
    void see() {
        lines.emplace_back();
        for (Index f = 0; f < simulator->mesh().fibre_count(); ++f) {
            lines.back().emplace_back();
            for (Index k = 0; k <= 4 * simulator->mesh().fibre(f).elements; ++k)
                lines.back().back().push_back(simulator->mesh().position(simulator->state(), f, 0.25 * static_cast<double>(k)));
        }
    }
    void reported(const simulation::IncrementReport&) { see(); }
};

/// Least distance of two polylines over the touching one on the straight way from one state to the next, at times so close that
/// no two points move by a twentieth of it between two of them; away from ends by a touching distance, where a fibre may slip off
/// another.
inline double closest_on_the_way(const std::vector<Vec3>& a, const std::vector<Vec3>& to_a, const std::vector<Vec3>& b,
                                 const std::vector<Vec3>& to_b, double touching) {
    double least = 1e300, motion = 0.0;
    for (std::size_t k = 0; k < a.size(); ++k)
        for (std::size_t l : {std::size_t{0}, b.size() / 2, b.size() - 1})
            motion = std::max(motion, (to_a[k] - a[k] - to_b[l] + b[l]).norm());
    const auto far_from_ends = [&](const std::vector<Vec3>& line, std::size_t k) {
        return (line[k] - line.front()).norm() > touching && (line[k] - line.back()).norm() > touching;
    };
    const int times = std::min(400, 1 + static_cast<int>(motion / (0.05 * touching)));
    for (std::size_t k = 1; k < a.size(); ++k) {
        if (!far_from_ends(a, k - 1) || !far_from_ends(a, k)) continue;
        for (std::size_t l = 1; l < b.size(); ++l) {
            if (!far_from_ends(b, l - 1) || !far_from_ends(b, l)) continue;
            const double now = closest_points(a[k - 1], a[k], b[l - 1], b[l]).distance;
            if (now - 2.0 * motion > touching) continue;
            for (int n = 0; n <= times; ++n) {
                const double t = static_cast<double>(n) / times;
                const auto at = [t](const std::vector<Vec3>& from, const std::vector<Vec3>& to, std::size_t p) {
                    return Vec3(from[p] + t * (to[p] - from[p]));
                };
                least = std::min(least,
                                 closest_points(at(a, to_a, k - 1), at(a, to_a, k), at(b, to_b, l - 1), at(b, to_b, l)).distance);
            }
        }
    }
    return least / touching;
}

/// Runs far scenes of seeds first, first + 1, ...: no accepted increment takes a fibre through another one, whatever the run
/// comes to, and what stops says why. Prints how many converged, and how close the straight way of any increment came.
inline void check_passages(std::uint64_t first, std::uint64_t count, bool calmed = false) {
    std::uint64_t converged = 0, touching = 0, scenes = 0, passages = 0;
    double closest = 1e300;
    for (std::uint64_t seed = first; seed < first + count; ++seed) {
        CAPTURE(seed);
        const SmallScene scene = far_scene(seed);
        if (scene.fibres.size() < 2) continue;
        ++scenes;
        simulation::Simulator<StableModel> simulator(assembly_of(scene), parameters_of<StableModel>(scene));
        simulation::Loading<StableModel> loading;
        loading.increments = scene.increments, loading.most_rejected = 40, loading.calmed = calmed;
        Ways<StableModel> ways{&simulator};
        ways.see();
        const simulation::Report report = simulator.run(loading, ways);
        if (!report.converged) CHECK_FALSE(report.reason.empty());
        converged += report.converged, touching += report.contact.active > 0;
        double least = 1e300;
        for (std::size_t n = 1; n < ways.lines.size(); ++n)
            for (std::size_t i = 0; i < scene.fibres.size(); ++i)
                for (std::size_t j = i + 1; j < scene.fibres.size(); ++j)
                    least =
                        std::min(least, closest_on_the_way(ways.lines[n - 1][i], ways.lines[n][i], ways.lines[n - 1][j],
                                                           ways.lines[n][j], scene.fibres[i].radius + scene.fibres[j].radius));
        // What passes comes to zero. Half is where it is refused; an eighth that segments cut off curves, and times between.
        if (least < 0.4) ++passages, std::printf("seed %llu: %.3f\n", static_cast<unsigned long long>(seed), least);
        CHECK(least > 0.4);
        closest = std::min(closest, least);
    }
    std::printf("%llu of %llu converged, %llu in contact at the end, %llu passed; closest on the way %.3f of touching\n",
                static_cast<unsigned long long>(converged), static_cast<unsigned long long>(scenes),
                static_cast<unsigned long long>(touching), static_cast<unsigned long long>(passages), closest);
    CHECK(touching > scenes / 10);
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Searches of fibres that move a little at each call.

#include "peers.hpp"
#include "scene_file.hpp"

#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/proximity/verlet_search.hpp>

#include <cstdio>

namespace fibrant::benchmarks {

/// Moves fibres to where they are at a call, from 1.
using Motion = std::function<void(Scene& scene, int call)>;

/// Each vertex goes its own way, straight on, by `step` a call.
/// @param step  [smallest radius]
inline Motion straight_on(const Scene& scene, double step) {
    const double r = *std::min_element(scene.radius.begin(), scene.radius.end());
    std::mt19937_64 random(2);
    std::normal_distribution<double> normal;
    std::vector<std::vector<Vec3>> way;
    for (const auto& line : scene.points) {
        way.emplace_back();
        for (std::size_t k = 0; k < line.size(); ++k) {
            const double x = normal(random), y = normal(random), z = normal(random);
            way.back().push_back(step * r * Vec3(x, y, z).normalized());
        }
    }
    return [way](Scene& moved, int) {
        for (std::size_t f = 0; f < moved.points.size(); ++f)
            for (std::size_t k = 0; k < moved.points[f].size(); ++k) moved.points[f][k] += way[f][k];
    };
}

inline void print_motion_head() {
    std::printf(
        "scene,strategy,threads,step_over_r,calls,builds,wrong,milliseconds,worst_ms,ratio_to_nanoflann,ratio_to_rebuilt,"
        "ratio_to_floor\n");
}

/// Searches that reuse their last list and searches that do not. Prints CSV: mean time of a call, first one left out, the worst
/// one, and the step: the largest displacement of a vertex between two calls, mean.
/// @param calls  >= 1, behind the first one
/// @return time [ms] against calls
inline std::vector<observe::PlotLine> measure_motion(Scene scene, int calls, bool self, const Motion& motion) {
    const double r = *std::min_element(scene.radius.begin(), scene.radius.end());
    struct Strategy {
        std::string name;
        std::function<Pairs(std::span<const proximity::Centreline>)> pairs;
        std::function<Index()> builds;
        double seconds = 0.0, worst = 0.0;
        std::size_t wrong = 0;
        std::vector<std::pair<double, double>> times{};
    };
    std::vector<Strategy> strategies;
    const double reach = scene.margin;
    proximity::GridSearch grid;
    proximity::BvhSearch tree;
    using Verlet = proximity::VerletSearch<proximity::GridSearch>;
    std::vector<Verlet> verlet;
    for (const double skin : {0.25, 0.5, 1.0, 2.0, 0.0}) verlet.emplace_back(Verlet::Parameters{.base = {}, .skin = skin * r});
    strategies.push_back({"nanoflann rebuilt", [&](auto lines) { return nanoflann_pairs(lines, reach).pairs; }, {}});
    strategies.push_back({"GridSearch rebuilt", [&](auto lines) { return grid.pairs(lines, reach); }, {}});
    strategies.push_back({"BvhSearch rebuilt", [&](auto lines) { return tree.pairs(lines, reach); }, {}});
    for (std::size_t k = 0; k < verlet.size(); ++k)
        strategies.push_back(
            {k < 4 ? "VerletSearch skin " + core::text(0.25 * std::pow(2.0, static_cast<double>(k))) + " r" : "VerletSearch",
             [&verlet, k, reach](auto lines) { return verlet[k].pairs(lines, reach); },
             [&verlet, k] { return verlet[k].builds(); }});
    double least = 0.0, step = 0.0;
    for (int call = 0; call <= calls; ++call) {
        if (call > 0) {
            const auto before = scene.points;
            motion(scene, call);
            double largest = 0.0;
            for (std::size_t f = 0; f < before.size(); ++f)
                for (std::size_t k = 0; k < before[f].size(); ++k)
                    largest = std::max(largest, (scene.points[f][k] - before[f][k]).norm());
            step += largest / (r * calls);
        }
        const auto lines = scene.centrelines(self);
        Pairs expected;
        for (Strategy& strategy : strategies) {
            const double start = time_now();
            Pairs pairs = strategy.pairs(lines);
            const double seconds = time_now() - start;
            if (call > 0) {
                strategy.seconds += seconds, strategy.worst = std::max(strategy.worst, seconds);
                strategy.times.emplace_back(call, 1e3 * seconds);
            }
            std::sort(pairs.begin(), pairs.end());
            if (expected.empty()) expected = pairs;
            strategy.wrong += lacking(expected, pairs) + lacking(pairs, expected);
        }
        if (call > 0) least += floor_seconds(1, lines, reach, expected);
    }
    std::vector<observe::PlotLine> curves;
    for (Strategy& s : strategies) {
        std::printf("%s,%s,%d,%.3g,%d,%ld,%zu,%.3f,%.3f,%.4f,%.3f,%.2f\n", scene.name.c_str(), s.name.c_str(), core::threads(),
                    step, calls, static_cast<long>(s.builds ? s.builds() : calls + 1), s.wrong, 1e3 * s.seconds / calls,
                    1e3 * s.worst, s.seconds / strategies[0].seconds, s.seconds / strategies[1].seconds, s.seconds / least);
        curves.push_back({s.name, std::move(s.times)});
    }
    return curves;
}

}  // namespace fibrant::benchmarks

// SPDX-License-Identifier: MIT
#pragma once
/// @file Time of searches against the number of segments, with the fitted exponent.

#include "peers.hpp"
#include "scene_file.hpp"

#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <cstdio>

namespace fibrant::benchmarks {

/// Random mats of 1e4 to 1e6 segments, all as dense. Prints CSV.
inline void measure_growth(int repeats) {
    std::printf("segments,search,pairs,milliseconds,nanoseconds_a_segment\n");
    std::vector<observe::PlotLine> curves{{"nanoflann", {}}, {"GridSearch", {}}, {"BvhSearch", {}}};
    for (const std::size_t size : {10'000u, 31'623u, 100'000u, 316'228u, 1'000'000u}) {
        const Scene scene = random_mat(size);
        const auto lines = scene.centrelines(false);
        proximity::GridSearch grid;
        proximity::BvhSearch tree;
        const std::vector<Turn> turns{{[&] { return nanoflann_pairs(lines, scene.margin); }},
                                      {[&] { return Call{.pairs = grid.pairs(lines, scene.margin)}; }},
                                      {[&] { return Call{.pairs = tree.pairs(lines, scene.margin)}; }}};
        const std::vector<Figures> all = measure_in_turn(repeats, turns);
        for (std::size_t m = 0; m < curves.size(); ++m) {
            const Figures& figures = all[m];
            const auto n = static_cast<double>(scene.segments());
            curves[m].points.emplace_back(n, 1e3 * figures.total);
            std::printf("%zu,%s,%zu,%.3f,%.1f\n", scene.segments(), curves[m].name.c_str(), figures.pairs.size(),
                        1e3 * figures.total, 1e9 * figures.total / n);
            std::fflush(stdout);
        }
    }
    for (const observe::PlotLine& curve : curves)
        std::printf("exponent,%s,,%.3f,\n", curve.name.c_str(), observe::fitted_order(curve.points));
}

}  // namespace fibrant::benchmarks

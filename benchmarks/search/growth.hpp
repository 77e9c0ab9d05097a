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

inline void print_growth_head() { std::printf("scene,segments,search,pairs,milliseconds,nanoseconds_a_segment\n"); }

/// Scenes that grow, all as dense. Prints CSV.
/// @param sizes  how many scenes
/// @param scene  of a size, asked for in turn from 0
/// @return time [ms] against segments
inline std::vector<observe::PlotLine> measure_growth(const std::string& name, int repeats, bool self, int sizes,
                                                     const std::function<const Scene&(int)>& scene) {
    std::vector<observe::PlotLine> curves{{"nanoflann", {}}, {"GridSearch", {}}, {"BvhSearch", {}}};
    for (int size = 0; size < sizes; ++size) {
        const Scene& now = scene(size);
        const auto lines = now.centrelines(self);
        proximity::GridSearch grid;
        proximity::BvhSearch tree;
        const std::vector<Turn> turns{{[&] { return nanoflann_pairs(lines, now.margin); }},
                                      {[&] { return Call{.pairs = grid.pairs(lines, now.margin)}; }},
                                      {[&] { return Call{.pairs = tree.pairs(lines, now.margin)}; }}};
        const std::vector<Figures> all = measure_in_turn(repeats, turns);
        for (std::size_t m = 0; m < curves.size(); ++m) {
            const Figures& figures = all[m];
            const auto n = static_cast<double>(now.segments());
            curves[m].points.emplace_back(n, 1e3 * figures.total);
            std::printf("%s,%zu,%s,%zu,%.3f,%.1f\n", name.c_str(), now.segments(), curves[m].name.c_str(), figures.pairs.size(),
                        1e3 * figures.total, 1e9 * figures.total / n);
            std::fflush(stdout);
        }
    }
    for (observe::PlotLine& curve : curves) {
        const double exponent = observe::fitted_order(curve.points);
        std::printf("%s,exponent,%s,,%.3f,\n", name.c_str(), curve.name.c_str(), exponent);
        curve.name += " ~ " + observe::rounded(exponent, 2);
    }
    return curves;
}

/// Random mats of 1e4 to 1e6 segments.
inline std::vector<observe::PlotLine> growth_of_mats(int repeats) {
    Scene mat;
    return measure_growth("mat", repeats, false, 5, [&](int size) -> const Scene& {
        return mat = random_mat(static_cast<std::size_t>(std::lround(1e4 * std::pow(10.0, 0.5 * size))));
    });
}
/// A scene, and 2, 4 and 8 copies of it side by side.
inline std::vector<observe::PlotLine> growth_of(Scene scene, int repeats, bool self) {
    return measure_growth(scene.name, repeats, self, 4, [&](int size) -> const Scene& {
        if (size > 0) scene.double_up();
        return scene;
    });
}

}  // namespace fibrant::benchmarks

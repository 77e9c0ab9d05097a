// SPDX-License-Identifier: MIT
#pragma once
/// @file Time of searches against the number of segments, with the fitted exponent and a plot.

#include "peers.hpp"
#include "scene_file.hpp"

#include <fibrant/observe/svg.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <cstdio>

namespace fibrant::benchmarks {

struct Curve {
    std::string name;
    std::vector<double> x{}, y{};
    /// Slope of log y over log x.
    double exponent() const {
        double sx = 0, sy = 0, sxx = 0, sxy = 0;
        for (std::size_t k = 0; k < x.size(); ++k) {
            const double a = std::log(x[k]), b = std::log(y[k]);
            sx += a, sy += b, sxx += a * a, sxy += a * b;
        }
        const auto n = static_cast<double>(x.size());
        return (n * sxy - sx * sy) / (n * sxx - sx * sx);
    }
};

/// Curves over decades of both axes, with their exponents.
inline void write_plot(const std::string& path, const std::vector<Curve>& curves, const std::string& title, const std::string& unit_y) {
    using namespace observe::detail;
    double low[2] = {1e300, 1e300}, high[2] = {0, 0};
    for (const Curve& curve : curves)
        for (std::size_t k = 0; k < curve.x.size(); ++k) {
            low[0] = std::min(low[0], curve.x[k]), high[0] = std::max(high[0], curve.x[k]);
            low[1] = std::min(low[1], curve.y[k]), high[1] = std::max(high[1], curve.y[k]);
        }
    for (int axis = 0; axis < 2; ++axis) low[axis] = std::floor(std::log10(low[axis])), high[axis] = std::ceil(std::log10(high[axis]));
    const double left = 80, top = 50, width = 480, height = 360;
    const auto place = [&](double x, double y) {
        return Eigen::Vector2d(left + width * (std::log10(x) - low[0]) / (high[0] - low[0]), top + height * (high[1] - std::log10(y)) / (high[1] - low[1]));
    };
    std::string body;
    for (double d = low[0]; d <= high[0]; ++d) {
        const Eigen::Vector2d p = place(std::pow(10, d), std::pow(10, low[1]));
        body += "<path class=\"g\" d=\"M" + point_text(p) + "v-" + core::text(height) + "\"/>\n" + svg_text(p.x(), p.y() + 20, "1e" + core::text(d));
    }
    for (double d = low[1]; d <= high[1]; ++d) {
        const Eigen::Vector2d p = place(std::pow(10, low[0]), std::pow(10, d));
        body += "<path class=\"g\" d=\"M" + point_text(p) + "h" + core::text(width) + "\"/>\n" + svg_text(p.x() - 50, p.y() + 5, "1e" + core::text(d));
    }
    body += svg_text(left + width - 80, top + height + 40, "segments") + svg_text(10, top - 5, unit_y);
    const observe::Palette palette;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const std::string colour = palette.groups[c % palette.groups.size()].text();
        std::string line = "<path fill=\"none\" stroke-width=\"2\" stroke=\"" + colour + "\" d=\"";
        for (std::size_t k = 0; k < curves[c].x.size(); ++k) line += (k == 0 ? "M" : "L") + point_text(place(curves[c].x[k], curves[c].y[k]));
        char label[100];
        std::snprintf(label, sizeof label, "%s, exponent %.3f", curves[c].name.c_str(), curves[c].exponent());
        body += line + "\"/>\n" + svg_text(left + 20, top + 24 + 22.0 * static_cast<double>(c), label, " style=\"fill:" + colour + "\"");
    }
    std::ofstream(path) << svg_page(left + width + 40, top + height + 60, ".g{stroke:#ccc;fill:none}", body, title);
}

/// Random mats of 1e4 to 1e6 segments. Prints CSV.
/// @param svg  file for a plot, or empty
inline void measure_growth(int repeats, const std::string& svg) {
    std::printf("segments,search,pairs,milliseconds,nanoseconds_a_segment\n");
    std::vector<Curve> curves{{"nanoflann"}, {"GridSearch"}, {"BvhSearch"}};
    for (const std::size_t size : {10'000u, 31'623u, 100'000u, 316'228u, 1'000'000u}) {
        const Scene scene = random_mat(size);
        const auto lines = scene.centrelines(false);
        proximity::GridSearch grid;
        proximity::BvhSearch tree;
        const Method methods[] = {[&] { return nanoflann_pairs(lines, scene.margin); },
                                  [&] { return Call{.pairs = grid.pairs(lines, scene.margin)}; },
                                  [&] { return Call{.pairs = tree.pairs(lines, scene.margin)}; }};
        for (std::size_t m = 0; m < curves.size(); ++m) {
            const Figures figures = measure(repeats, methods[m]);
            const auto n = static_cast<double>(scene.segments());
            curves[m].x.push_back(n), curves[m].y.push_back(1e3 * figures.total);
            std::printf("%zu,%s,%zu,%.3f,%.1f\n", scene.segments(), curves[m].name.c_str(), figures.pairs.size(), 1e3 * figures.total, 1e9 * figures.total / n);
            std::fflush(stdout);
        }
    }
    for (const Curve& curve : curves) std::printf("exponent,%s,,%.3f,\n", curve.name.c_str(), curve.exponent());
    if (!svg.empty()) write_plot(svg, curves, "Search of random mats", "ms");
}

}  // namespace fibrant::benchmarks

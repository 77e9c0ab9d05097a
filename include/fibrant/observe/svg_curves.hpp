// SPDX-License-Identifier: MIT
#pragma once
/// @file A plot of lines on two linear axes as an SVG file: loading curves, say.

#include <fibrant/observe/svg_plot.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace fibrant::observe {

/// What a plot of curves shows. Points that are not finite are left out.
struct CurvePlot {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
    bool marks = true;                     ///< a dot at each point
    double width = 640.0, height = 440.0;  ///< [pixel]
};

namespace detail {
/// Round step that divides a range into four to ten parts.
inline double round_step(double range) {
    const double power = std::pow(10.0, std::floor(std::log10(range / 4.0)));
    for (const double factor : {5.0, 2.0, 1.0})
        if (range / (factor * power) >= 4.0) return factor * power;
    return power;
}
inline std::string tick_text(double value, double step) {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
    return rounded(std::abs(value) < 1e-9 * step ? 0.0 : value, digits);
}
}  // namespace detail

/// The plot as a whole SVG file. Axes hold zero where that costs less than half of the range.
/// @throws std::invalid_argument if no point can be shown
inline std::string curves_svg(const CurvePlot& plot) {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    const auto shown = [](double x, double y) { return std::isfinite(x) && std::isfinite(y); };
    for (const PlotLine& line : plot.lines)
        for (const auto& [x, y] : line.points) {
            if (!shown(x, y)) continue;
            low = {std::min(low[0], x), std::min(low[1], y)}, high = {std::max(high[0], x), std::max(high[1], y)};
        }
    if (low[0] > high[0]) core::refuse("CurvePlot.lines", "no point", "a point with finite numbers");
    std::array<double, 2> step{};
    for (std::size_t a = 0; a < 2; ++a) {
        const double range = high[a] - low[a];
        if (low[a] > 0.0 && low[a] < range) low[a] = 0.0;
        if (high[a] < 0.0 && -high[a] < range) high[a] = 0.0;
        if (!(high[a] > low[a])) high[a] = low[a] + std::max(1e-12, std::abs(low[a])), low[a] -= std::max(1e-12, std::abs(low[a]));
        step[a] = detail::round_step(high[a] - low[a]);
        low[a] = step[a] * std::floor(low[a] / step[a] + 1e-9), high[a] = step[a] * std::ceil(high[a] / step[a] - 1e-9);
    }
    const double left = 84.0, right = plot.width - (plot.lines.size() > 1 ? 190.0 : 30.0), top = 46.0, bottom = plot.height - 56.0;
    const auto place = [&](double x, double y) {
        return Eigen::Vector2d(left + (x - low[0]) / (high[0] - low[0]) * (right - left), bottom - (y - low[1]) / (high[1] - low[1]) * (bottom - top));
    };
    std::string body;
    for (double k = std::round(low[0] / step[0]); k * step[0] <= high[0] + 0.01 * step[0]; k += 1.0) {
        const double x = place(k * step[0], 0.0).x();
        body += "<path class=\"g\" d=\"M" + rounded(x, 1) + " " + rounded(top, 1) + "V" + rounded(bottom, 1) + "\"/>\n" + detail::svg_text(x, bottom + 18.0, detail::tick_text(k * step[0], step[0]), " class=\"t\" text-anchor=\"middle\"");
    }
    for (double k = std::round(low[1] / step[1]); k * step[1] <= high[1] + 0.01 * step[1]; k += 1.0) {
        const double y = place(0.0, k * step[1]).y();
        body += "<path class=\"g\" d=\"M" + rounded(left, 1) + " " + rounded(y, 1) + "H" + rounded(right, 1) + "\"/>\n" + detail::svg_text(left - 6.0, y + 4.0, detail::tick_text(k * step[1], step[1]), " class=\"t\" text-anchor=\"end\"");
    }
    const Palette palette;
    for (std::size_t l = 0; l < plot.lines.size(); ++l) {
        const std::string colour = palette.of(0, static_cast<Index>(l)).text();
        std::string path, marks;
        for (const auto& [x, y] : plot.lines[l].points) {
            if (!shown(x, y)) continue;
            const Eigen::Vector2d p = place(x, y);
            path += (path.empty() ? "M" : "L") + detail::point_text(p);
            if (plot.marks) marks += "<circle cx=\"" + rounded(p.x(), 1) + "\" cy=\"" + rounded(p.y(), 1) + "\" r=\"2.5\" fill=\"" + colour + "\"/>\n";
        }
        if (path.empty()) continue;
        body += "<path class=\"l\" d=\"" + path + "\" stroke=\"" + colour + "\"/>\n" + marks;
        if (plot.lines.size() < 2) continue;
        const double y = top + 10.0 + 20.0 * static_cast<double>(l);
        body += "<path class=\"l\" d=\"M" + rounded(right + 12.0, 1) + " " + rounded(y - 5.0, 1) + "h18\" stroke=\"" + colour + "\"/>\n" + detail::svg_text(right + 36.0, y, plot.lines[l].name, " class=\"t\"");
    }
    body += detail::svg_text(0.5 * (left + right), plot.height - 14.0, plot.x_label, " class=\"t\" text-anchor=\"middle\"");
    body += detail::svg_text(18.0, 0.5 * (top + bottom), plot.y_label, " class=\"t\" text-anchor=\"middle\" transform=\"rotate(-90 18 " + rounded(0.5 * (top + bottom), 1) + ")\"");
    return detail::svg_page(plot.width, plot.height, ".t{font-size:13px}.g{stroke:#ddd}.l{fill:none;stroke-width:2}\n", body, plot.title);
}

}  // namespace fibrant::observe

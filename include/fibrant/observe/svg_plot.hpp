// SPDX-License-Identifier: MIT
#pragma once
/// @file A plot of lines on two logarithmic axes as an SVG file: error against time, say.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/svg.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// One line of a plot: points (x, y), both > 0; others are left out.
struct PlotLine {
    std::string name;
    std::vector<std::pair<double, double>> points;
};

/// What a plot on logarithmic axes shows.
struct LogLogPlot {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
    double width = 640.0, height = 440.0;  ///< [pixel]
};

/// Slope of log y against log x by least squares over the points that are > 0; NaN of fewer than two.
inline double fitted_order(const std::vector<std::pair<double, double>>& points) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [a, b] : points) {
        if (!(a > 0.0 && b > 0.0)) continue;
        const double u = std::log(a), v = std::log(b);
        n += 1, x += u, y += v, xx += u * u, xy += u * v;
    }
    const double spread = n * xx - x * x;
    return n >= 2.0 && spread > 0.0 ? (n * xy - x * y) / spread : std::numeric_limits<double>::quiet_NaN();
}

namespace detail {

/// An axis of a plot: its ends, and where it is marked with what.
struct PlotAxis {
    double low = 0.0, high = 1.0;
    std::vector<std::pair<double, std::string>> ticks;
    double share(double value) const noexcept { return (value - low) / (high - low); }
};

/// Lines between two axes that are there already; a plot of either kind is this once its numbers are those of its axes.
struct PlotFrame {
    std::string title, x_label, y_label;
    double width, height, left, right_margin;  ///< [pixel]
    PlotAxis x, y;
    std::vector<PlotLine> lines;
    double dot_radius;  ///< [pixel]; 0: no dots
    bool names;         ///< of the lines, beside the plot
};

/// An axis over logarithms to the base of ten. Within one decade its multiples are marked, otherwise each power of ten.
inline PlotAxis decade_axis(double low, double high) {
    // Within one decade its multiples are marked, from the last before the points to the first behind them.
    const double unit = std::pow(10.0, std::floor(low + 1e-9));
    const double first = std::floor(std::pow(10.0, low) / unit + 1e-9), last = std::ceil(std::pow(10.0, high) / unit - 1e-9);
    if (last > first && last <= 10.0) {
        PlotAxis axis{std::log10(first * unit), std::log10(last * unit), {}};
        const Index digits = std::max<Index>(0, static_cast<Index>(-std::floor(low + 1e-9)));
        for (double k = first; k <= last; k += 1.0)
            axis.ticks.emplace_back(std::log10(k * unit), rounded(k * unit, static_cast<int>(digits)));
        return axis;
    }
    PlotAxis axis{std::floor(low), std::max(std::ceil(high), std::floor(low) + 1.0), {}};
    for (double k = axis.low; k <= axis.high; k += 1.0) axis.ticks.emplace_back(k, "1e" + rounded(k, 0));
    return axis;
}

/// A plot as SVG, its axes, curves and legend.
inline std::string plot_svg(const PlotFrame& plot) {
    const double left = plot.left, right = plot.width - plot.right_margin, top = 46.0, bottom = plot.height - 56.0;
    const auto place_x = [&](double x) { return left + plot.x.share(x) * (right - left); };
    const auto place_y = [&](double y) { return bottom - plot.y.share(y) * (bottom - top); };
    std::string body;
    // Texts that would run into each other stand at every second mark, or every third, and so on.
    constexpr double letter = 7.5, between = 8.0;  // of a digit of 13 pixels, and what is left between two texts [pixel]
    std::size_t longest = 1;
    for (const auto& tick : plot.x.ticks) longest = std::max(longest, tick.second.size());
    const double room = (right - left) / std::max(1.0, static_cast<double>(plot.x.ticks.size()) - 1.0);
    const auto every = static_cast<std::size_t>(std::ceil((letter * static_cast<double>(longest) + between) / room));
    for (std::size_t k = 0; k < plot.x.ticks.size(); ++k) {
        const double x = place_x(plot.x.ticks[k].first);
        body += "<path class=\"g\" d=\"M" + rounded(x, 1) + " " + rounded(top, 1) + "V" + rounded(bottom, 1) + "\"/>\n";
        if (k % every == 0) body += svg_text(x, bottom + 18.0, plot.x.ticks[k].second, " class=\"t\" text-anchor=\"middle\"");
    }
    for (const auto& [value, text] : plot.y.ticks) {
        const double y = place_y(value);
        body += "<path class=\"g\" d=\"M" + rounded(left, 1) + " " + rounded(y, 1) + "H" + rounded(right, 1) + "\"/>\n" +
                svg_text(left - 6.0, y + 4.0, text, " class=\"t\" text-anchor=\"end\"");
    }
    const Palette palette;
    for (std::size_t l = 0; l < plot.lines.size(); ++l) {
        const std::string colour = palette.of(0, static_cast<Index>(l)).text();
        std::string path, marks;
        for (const auto& [x, y] : plot.lines[l].points) {
            const Eigen::Vector2d p(place_x(x), place_y(y));
            path += (path.empty() ? "M" : "L") + point_text(p);
            if (plot.dot_radius > 0.0)
                marks += "<circle cx=\"" + rounded(p.x(), 1) + "\" cy=\"" + rounded(p.y(), 1) + "\" r=\"" +
                         rounded(plot.dot_radius, 1) + "\" fill=\"" + colour + "\"/>\n";
        }
        if (path.empty()) continue;
        body += "<path class=\"l\" d=\"" + path + "\" stroke=\"" + colour + "\"/>\n" + marks;
        if (!plot.names) continue;
        const double y = top + 10.0 + 20.0 * static_cast<double>(l);
        body += "<path class=\"l\" d=\"M" + rounded(right + 12.0, 1) + " " + rounded(y - 5.0, 1) + "h18\" stroke=\"" + colour +
                "\"/>\n" + svg_text(right + 36.0, y, plot.lines[l].name, " class=\"t\"");
    }
    body += svg_text(0.5 * (left + right), plot.height - 14.0, plot.x_label, " class=\"t\" text-anchor=\"middle\"");
    body += svg_text(18.0, 0.5 * (top + bottom), plot.y_label,
                     " class=\"t\" text-anchor=\"middle\" transform=\"rotate(-90 18 " + rounded(0.5 * (top + bottom), 1) + ")\"");
    return svg_page(plot.width, plot.height, ".t{font-size:13px}.g{stroke:#ddd}.l{fill:none;stroke-width:2}\n", body, plot.title);
}

}  // namespace detail

/// The plot as a whole SVG file. Axes go by decades, or within one by its multiples, and are as wide as the points ask for.
/// @throws std::invalid_argument if no point can be shown
inline std::string log_log_svg(const LogLogPlot& plot) {
    double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
    std::vector<PlotLine> lines;
    for (const PlotLine& line : plot.lines) {
        lines.push_back({line.name, {}});
        for (const auto& [x, y] : line.points) {
            if (!(x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y))) continue;
            const double u = std::log10(x), v = std::log10(y);
            low_x = std::min(low_x, u), high_x = std::max(high_x, u);
            low_y = std::min(low_y, v), high_y = std::max(high_y, v);
            lines.back().points.emplace_back(u, v);
        }
    }
    if (low_x > high_x) core::refuse("LogLogPlot.lines", "no point", "a point with both numbers > 0");
    return detail::plot_svg({plot.title, plot.x_label, plot.y_label, plot.width, plot.height, 78.0, 170.0,
                             detail::decade_axis(low_x, high_x), detail::decade_axis(low_y, high_y), std::move(lines), 3.5,
                             true});
}

}  // namespace fibrant::observe

// SPDX-License-Identifier: MIT
#pragma once
/// @file A plot of lines on two logarithmic axes as an SVG file: error against time, say.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/svg.hpp>

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

/// What a plot shows.
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

/// The plot as a whole SVG file. Axes go by decades, and are as wide as the points ask for.
/// @throws std::invalid_argument if no point can be shown
inline std::string log_log_svg(const LogLogPlot& plot) {
    double low_x = 1e300, high_x = -1e300, low_y = 1e300, high_y = -1e300;
    for (const PlotLine& line : plot.lines)
        for (const auto& [x, y] : line.points) {
            if (!(x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y))) continue;
            low_x = std::min(low_x, std::log10(x)), high_x = std::max(high_x, std::log10(x));
            low_y = std::min(low_y, std::log10(y)), high_y = std::max(high_y, std::log10(y));
        }
    if (low_x > high_x) core::refuse("LogLogPlot.lines", "no point", "a point with both numbers > 0");
    low_x = std::floor(low_x), high_x = std::max(std::ceil(high_x), low_x + 1.0);
    low_y = std::floor(low_y), high_y = std::max(std::ceil(high_y), low_y + 1.0);
    const double left = 78.0, right = plot.width - 170.0, top = 46.0, bottom = plot.height - 56.0;
    const auto place = [&](double x, double y) {
        return Eigen::Vector2d(left + (std::log10(x) - low_x) / (high_x - low_x) * (right - left), bottom - (std::log10(y) - low_y) / (high_y - low_y) * (bottom - top));
    };
    const auto power = [](double k) { return "1e" + rounded(k, 0); };
    std::string body;
    for (double k = low_x; k <= high_x; k += 1.0) {
        const double x = place(std::pow(10.0, k), 1.0).x();
        body += "<path class=\"g\" d=\"M" + rounded(x, 1) + " " + rounded(top, 1) + "V" + rounded(bottom, 1) + "\"/>\n" + detail::svg_text(x, bottom + 18.0, power(k), " class=\"t\" text-anchor=\"middle\"");
    }
    for (double k = low_y; k <= high_y; k += 1.0) {
        const double y = place(1.0, std::pow(10.0, k)).y();
        body += "<path class=\"g\" d=\"M" + rounded(left, 1) + " " + rounded(y, 1) + "H" + rounded(right, 1) + "\"/>\n" + detail::svg_text(left - 6.0, y + 4.0, power(k), " class=\"t\" text-anchor=\"end\"");
    }
    const Palette palette;
    for (std::size_t l = 0; l < plot.lines.size(); ++l) {
        const std::string colour = palette.of(0, static_cast<Index>(l)).text();
        std::string path, marks;
        for (const auto& [x, y] : plot.lines[l].points) {
            if (!(x > 0.0 && y > 0.0 && std::isfinite(x) && std::isfinite(y))) continue;
            const Eigen::Vector2d p = place(x, y);
            path += (path.empty() ? "M" : "L") + detail::point_text(p);
            marks += "<circle cx=\"" + rounded(p.x(), 1) + "\" cy=\"" + rounded(p.y(), 1) + "\" r=\"3.5\" fill=\"" + colour + "\"/>\n";
        }
        if (path.empty()) continue;
        body += "<path class=\"l\" d=\"" + path + "\" stroke=\"" + colour + "\"/>\n" + marks;
        const double y = top + 10.0 + 20.0 * static_cast<double>(l);
        body += "<path class=\"l\" d=\"M" + rounded(right + 12.0, 1) + " " + rounded(y - 5.0, 1) + "h18\" stroke=\"" + colour + "\"/>\n" + detail::svg_text(right + 36.0, y, plot.lines[l].name, " class=\"t\"");
    }
    body += detail::svg_text(0.5 * (left + right), plot.height - 14.0, plot.x_label, " class=\"t\" text-anchor=\"middle\"");
    body += detail::svg_text(18.0, 0.5 * (top + bottom), plot.y_label, " class=\"t\" text-anchor=\"middle\" transform=\"rotate(-90 18 " + rounded(0.5 * (top + bottom), 1) + ")\"");
    return detail::svg_page(plot.width, plot.height, ".t{font-size:13px}.g{stroke:#ddd}.l{fill:none;stroke-width:2}\n", body, plot.title);
}

}  // namespace fibrant::observe

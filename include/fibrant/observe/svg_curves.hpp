// SPDX-License-Identifier: MIT
#pragma once
/// @file A plot of lines over a linear axis as an SVG file: loading curves, say.

#include <fibrant/observe/svg_plot.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// What a plot of curves shows. Points that are not finite are left out.
struct CurvePlot {
    std::string title, x_label, y_label;
    std::vector<PlotLine> lines;
    bool marks = true;                     ///< a dot at each point
    double width = 640.0, height = 440.0;  ///< [pixel]
    bool decades = false;                  ///< the axis of y is logarithmic; points with y <= 0 are left out
    bool names = true;                     ///< of several lines, beside the plot
};

namespace detail {
/// Round step that divides a range into four to ten parts.
inline double round_step(double range) {
    const double power = std::pow(10.0, std::floor(std::log10(range / 4.0)));
    for (const double factor : {5.0, 2.0, 1.0})
        if (range / (factor * power) >= 4.0) return factor * power;
    return power;
}
/// Number at a tick of an axis, with as many digits as its step asks for.
inline std::string tick_text(double value, double step) {
    const int digits = std::clamp(static_cast<int>(std::ceil(-std::log10(step) - 1e-9)), 0, 9);
    return rounded(std::abs(value) < 1e-9 * step ? 0.0 : value, digits);
}
/// An axis with round ends and steps over a range; it holds zero where that costs less than half of it.
inline PlotAxis round_axis(double low, double high) {
    const double range = high - low;
    if (low > 0.0 && low < range) low = 0.0;
    if (high < 0.0 && -high < range) high = 0.0;
    if (!(high > low)) high = low + std::max(1e-12, std::abs(low)), low -= std::max(1e-12, std::abs(low));
    const double step = round_step(high - low);
    PlotAxis axis{step * std::floor(low / step + 1e-9), step * std::ceil(high / step - 1e-9), {}};
    for (double k = std::round(axis.low / step); k * step <= axis.high + 0.01 * step; k += 1.0)
        axis.ticks.emplace_back(k * step, tick_text(k * step, step));
    return axis;
}
}  // namespace detail

/// The plot as a whole SVG file. Linear axes hold zero where that costs less than half of the range.
/// @throws std::invalid_argument if no point can be shown
inline std::string curves_svg(const CurvePlot& plot) {
    std::array<double, 2> low{1e300, 1e300}, high{-1e300, -1e300};
    std::vector<PlotLine> lines;
    for (const PlotLine& line : plot.lines) {
        lines.push_back({line.name, {}});
        for (const auto& [x, given] : line.points) {
            const double y = plot.decades ? std::log10(std::max(given, 0.0)) : given;
            if (!(std::isfinite(x) && std::isfinite(y))) continue;
            low = {std::min(low[0], x), std::min(low[1], y)}, high = {std::max(high[0], x), std::max(high[1], y)};
            lines.back().points.emplace_back(x, y);
        }
    }
    if (low[0] > high[0]) core::refuse("CurvePlot.lines", "no point", "a point with finite numbers");
    const bool names = plot.names && plot.lines.size() > 1;
    return detail::plot_svg({plot.title, plot.x_label, plot.y_label, plot.width, plot.height, 84.0, names ? 190.0 : 30.0,
                             detail::round_axis(low[0], high[0]),
                             plot.decades ? detail::decade_axis(low[1], high[1]) : detail::round_axis(low[1], high[1]),
                             std::move(lines), plot.marks ? 2.5 : 0.0, names});
}

}  // namespace fibrant::observe

// SPDX-License-Identifier: MIT
#pragma once
/// @file Curves as every file of centrelines has them: points, a radius, whether they close, and what they are called.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/places.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace fibrant::exchange {

/// One curve. A closed one does not repeat its first point.
struct FileCurve {
    std::vector<Vec3> points{};   ///< [length]
    double radius = core::unset;  ///< of a fibre or of the yarn, where the file has it [length]
    std::vector<double> radii{};  ///< at the points, where they differ; else empty [length]
    bool closed = false;
    Index group = -1;  ///< number of the yarn, where the file has it
    std::string name{};
    Vec3 period = Vec3::Zero();  ///< from start to end of a curve that repeats; zero: none [length]
};

/// Throws what is wrong with a file at a place in it: "file:place: what".
[[noreturn]] inline void refuse_file(const std::string& file, const std::string& place, const std::string& what) {
    throw std::invalid_argument(file + ":" + (place.empty() ? "" : place + ":") + " " + what);
}

/// What is taken of curves that a file has.
struct CleanParameters {
    double scale = 1.0;              ///< of all lengths, > 0
    double largest_turn_deg = 60.0;  ///< between neighbouring chords [degree], in (0, 180]
    Index least_points = 4;          ///< of a curve, >= 2
    bool find_closed = true;         ///< a curve whose last point is its first one is closed

    void validate() const {
        core::require_positive("CleanParameters.scale", scale);
        core::require(largest_turn_deg > 0.0 && largest_turn_deg <= 180.0, "CleanParameters.largest_turn_deg", largest_turn_deg,
                      "in (0, 180]");
        core::require_at_least("CleanParameters.least_points", least_points, 2);
    }
};

/// Refuses curves that turn too sharply.
/// @throws std::invalid_argument naming curve and point, where neighbouring chords turn by more than an angle [degree]
inline void require_turns(const std::vector<FileCurve>& curves, const std::string& file, double largest_deg) {
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const FileCurve& curve = curves[c];
        const std::vector<Vec3>& points = curve.points;
        const std::size_t n = points.size(), turns = curve.closed ? n : std::max<std::size_t>(n, 2) - 2;
        for (std::size_t k = 0; k < turns; ++k) {
            const Vec3 a = points[(k + 1) % n] - points[k], b = points[(k + 2) % n] - points[(k + 1) % n];
            const double turn = std::atan2(a.cross(b).norm(), a.dot(b)) * 57.29577951308232;
            if (turn > largest_deg)
                refuse_file(file,
                            "curve " + std::to_string(c) + (curve.name.empty() ? "" : " '" + curve.name + "'") + ", point " +
                                std::to_string((k + 1) % n),
                            "chords turn by " + core::text(turn) + " degrees, but it must be at most " + core::text(largest_deg) +
                                ": smooth it, or take more points");
        }
    }
}

/// Curves as they can be laid: scaled, points that repeat the one before them taken out, closure found.
/// @throws std::invalid_argument naming curve and point: not finite, too few, a turn that no smooth fibre makes
inline std::vector<FileCurve> cleaned(std::vector<FileCurve> curves, const std::string& file,
                                      const CleanParameters& parameters = {}) {
    parameters.validate();
    if (curves.empty()) refuse_file(file, "", "has no curves");
    for (std::size_t c = 0; c < curves.size(); ++c) {
        FileCurve& curve = curves[c];
        const std::string place = "curve " + std::to_string(c) + (curve.name.empty() ? "" : " '" + curve.name + "'");
        if (!curve.radii.empty() && curve.radii.size() != curve.points.size())
            refuse_file(file, place,
                        std::to_string(curve.radii.size()) + " radii of " + std::to_string(curve.points.size()) + " points");
        if (!std::isnan(curve.radius) && !(std::isfinite(curve.radius) && curve.radius > 0.0))
            refuse_file(file, place, "radius = " + core::text(curve.radius) + ", but it must be finite and > 0");
        std::vector<Vec3> points;
        std::vector<double> radii;
        double size = 0.0;
        for (const Vec3& point : curve.points) size = std::max(size, (point - curve.points.front()).norm());
        for (std::size_t k = 0; k < curve.points.size(); ++k) {
            if (!curve.points[k].allFinite())
                refuse_file(file, place + ", point " + std::to_string(k),
                            scene::text(curve.points[k]) + ", but it must be finite");
            if (!points.empty() && (curve.points[k] - points.back() / parameters.scale).norm() <= 1e-12 * size) continue;
            points.push_back(parameters.scale * curve.points[k]);
            if (curve.radii.empty()) continue;
            if (!(std::isfinite(curve.radii[k]) && curve.radii[k] > 0.0))
                refuse_file(file, place + ", point " + std::to_string(k),
                            "radius = " + core::text(curve.radii[k]) + ", but it must be finite and > 0");
            radii.push_back(parameters.scale * curve.radii[k]);
        }
        if (points.size() > 3 && (points.back() - points.front()).norm() <= 1e-9 * size * parameters.scale &&
            (parameters.find_closed || curve.closed)) {
            curve.closed = true;
            points.pop_back();
            if (!radii.empty()) radii.pop_back();
        }
        if (core::count(points) < parameters.least_points)
            refuse_file(file, place,
                        std::to_string(points.size()) + " points that differ, but it must have at least " +
                            std::to_string(parameters.least_points));
        curve.points = std::move(points), curve.radii = std::move(radii);
        if (!std::isnan(curve.radius)) curve.radius *= parameters.scale;
        curve.period *= parameters.scale;
    }
    require_turns(curves, file, parameters.largest_turn_deg);
    return curves;
}

namespace detail {

/// Words of a line, at blanks and at any of `separators`; of a run of blanks one.
inline std::vector<std::string_view> words(std::string_view line, std::string_view separators) {
    std::vector<std::string_view> found;
    std::size_t start = 0;
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    const auto add = [&](std::size_t end) {
        std::string_view word = line.substr(start, end - start);
        while (!word.empty() && blank(word.front())) word.remove_prefix(1);
        while (!word.empty() && blank(word.back())) word.remove_suffix(1);
        found.push_back(word);
    };
    for (std::size_t k = 0; k < line.size(); ++k)
        if (separators.find(line[k]) != std::string_view::npos) add(k), start = k + 1;
    add(line.size());
    if (separators.empty()) {
        found.clear();
        for (std::size_t k = 0; k < line.size();) {
            while (k < line.size() && blank(line[k])) ++k;
            const std::size_t first = k;
            while (k < line.size() && !blank(line[k])) ++k;
            if (k > first) found.push_back(line.substr(first, k - first));
        }
    }
    return found;
}

/// A whole word as a number. @throws std::invalid_argument "file:place: field = word, but it must be ..."
template <class Number>
Number number(std::string_view word, const std::string& file, const std::string& place, const std::string& field) {
    Number value{};
    const std::string_view digits = !word.empty() && word.front() == '+' ? word.substr(1) : word;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    bool sound = error == std::errc{} && end == digits.data() + digits.size();
    if constexpr (std::is_floating_point_v<Number>) sound = sound && std::isfinite(value);
    if (!sound)
        refuse_file(file, place,
                    field + " = " + std::string(word.substr(0, 60)) + ", but it must be " +
                        (std::is_floating_point_v<Number> ? "a finite number" : "a whole number"));
    return value;
}

/// Calls visit(number, line) for each line of a text, from 1.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
    Index number = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        std::string_view line = text.substr(at, end - at);
        if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
        visit(++number, line);
        at = end + 1;
    }
}

}  // namespace detail

}  // namespace fibrant::exchange

// SPDX-License-Identifier: MIT
#pragma once
/// @file A textile from curves of a file, and curves of its fibres for files.

#include <fibrant/compositions/textile/yarn_fibres.hpp>
#include <fibrant/exchange/curves.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Points drawn towards their neighbours by a Gaussian along the index; the ends of an open curve are mirrored and keep their
/// places.
/// @param width  its standard deviation in points, >= 0; 0: as they are
inline std::vector<Vec3> smoothed(const std::vector<Vec3>& points, double width, bool closed) {
    core::require_not_negative("smoothed.width", width);
    if (width == 0.0) return points;
    const Index n = core::count(points), reach = static_cast<Index>(std::ceil(3.0 * width));
    std::vector<Vec3> answer;
    for (Index k = 0; k < n; ++k) {
        Vec3 sum = Vec3::Zero();
        double all = 0.0;
        for (Index d = -reach; d <= reach; ++d) {
            const double weight = std::exp(-0.5 * static_cast<double>(d * d) / (width * width));
            Index at = k + d;
            Vec3 point;
            if (closed) {
                point = points[core::at(((at % n) + n) % n)];
            } else if (at < 0) {
                point = 2.0 * points.front() - points[core::at(std::min(-at, n - 1))];
            } else if (at >= n) {
                point = 2.0 * points.back() - points[core::at(std::max<Index>(0, 2 * (n - 1) - at))];
            } else {
                point = points[core::at(at)];
            }
            sum += weight * point, all += weight;
        }
        answer.push_back(sum / all);
    }
    return answer;
}

/// Refuses yarns of several fibres, one a curve of a file, that lie in each other by more than a radius of a fibre: a curve is as
/// far from others as what was measured is thick, and fibres would start on the wrong side of each other.
/// @throws std::invalid_argument naming a radius that would do
inline void require_room(const Textile& textile) {
    constexpr double most = 1.0, step = 0.97, thinnest = 0.02;
    const auto several = [](const YarnType& type) { return type.fibres > 1; };
    if (std::none_of(textile.types.begin(), textile.types.end(), several) || detail::deepest_start(textile) <= most) return;
    Textile thinner = textile;
    double factor = 1.0;
    do {
        factor *= step;
        for (std::size_t k = 0; k < textile.types.size(); ++k) thinner.types[k].radius = factor * textile.types[k].radius;
    } while (factor > thinnest && detail::deepest_start(thinner) > most);
    const YarnType& type = *std::find_if(textile.types.begin(), textile.types.end(), several);
    core::refuse("YarnType.radius", core::text(type.radius),
                 (factor > thinnest ? "<= " + core::text(factor * type.radius) : std::string("less")) + " for the " +
                     std::to_string(type.fibres) + " fibres of each curve of the file to lie beside those of the next one");
}

namespace detail {
/// Refuses a curve that is so far away that its digits say too little of its fibres, and one that is there twice: by which side
/// the two should part would be a guess.
/// @param textile  its yarns, one a curve
inline void require_places(const Textile& textile, const std::vector<exchange::FileCurve>& curves) {
    constexpr double farthest = 1e9, same = 1e-6;  // radii; of a radius seven digits are left at the first
    const auto label = [&](std::size_t c) { return scene::label("yarn", static_cast<Index>(c), curves[c].name); };
    const auto radius = [&](std::size_t c) { return textile.types[core::at(textile.paths[c].type)].radius; };
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const std::vector<Vec3>& points = curves[c].points;
        for (std::size_t k = 0; k < points.size(); ++k)
            if (points[k].norm() > farthest * radius(c))
                core::refuse(
                    label(c) + ", point " + std::to_string(k), scene::text(points[k]),
                    "within 1e9 radii of the origin, or its digits say too little of a fibre of radius " + core::text(radius(c)));
    }
    // Curves that are the same have the same place on any line, be they drawn to and fro.
    const Vec3 line(1.0, 0.618034, 0.414214);  // no two are in a simple ratio: curves of a pattern rarely share a place on it
    std::vector<std::pair<double, std::size_t>> places;
    for (std::size_t c = 0; c < curves.size(); ++c)
        if (const auto& points = curves[c].points; !points.empty())
            places.emplace_back(line.dot(points.front() + points.back()), c);
    std::sort(places.begin(), places.end());
    for (std::size_t p = 0; p < places.size(); ++p) {
        const std::size_t c = places[p].second;
        const std::vector<Vec3>& points = curves[c].points;
        const double reach = 2.0 * line.norm() * same * radius(c);
        const auto near = [&](const Vec3& x, const Vec3& y) { return (x - y).norm() <= same * radius(c); };
        for (std::size_t q = p + 1; q < places.size() && places[q].first - places[p].first <= reach; ++q) {
            const std::size_t b = places[q].second;
            const std::vector<Vec3>& others = curves[b].points;
            if (others.size() == points.size() && (std::equal(points.begin(), points.end(), others.begin(), near) ||
                                                   std::equal(points.begin(), points.end(), others.rbegin(), near)))
                core::refuse(label(std::max(b, c)), "where " + label(std::min(b, c)) + " lies",
                             "in a place of its own: which side is its would be a guess");
        }
    }
}
}  // namespace detail

/// A textile of yarns, one a curve, at rest as they are drawn; crossings are those that their heights say.
/// @param type    of all yarns; its radius, where it is not set, is that of the file, the mean of its points
/// @param smooth  width of the Gaussian that points are smoothed by [points], >= 0
/// @throws std::invalid_argument naming the curve whose radius nobody says, one that is there twice or too far away, or a radius
/// of fibres at which yarns have room
inline Textile textile_of(const std::vector<exchange::FileCurve>& curves, const YarnType& type, const View& view,
                          double smooth = 0.0) {
    Textile textile;
    textile.name = "imported";
    textile.view = view;
    for (std::size_t c = 0; c < curves.size(); ++c) {
        const exchange::FileCurve& curve = curves[c];
        YarnType own = type;
        if (std::isnan(own.radius))
            own.radius = curve.radii.empty() ? curve.radius
                                             : std::accumulate(curve.radii.begin(), curve.radii.end(), 0.0) /
                                                   static_cast<double>(curve.radii.size());
        if (std::isnan(own.radius)) core::refuse("radius of curve " + std::to_string(c), "not given", "in the file, or told");
        Index number = 0;
        while (number < core::count(textile.types) && textile.types[core::at(number)].radius != own.radius) ++number;
        if (number == core::count(textile.types)) textile.types.push_back(own);
        Path path;
        path.name = curve.name.empty() ? "curve " + std::to_string(c) : curve.name;
        path.type = number, path.family = std::max<Index>(curve.group, 0), path.straight = false;
        path.kind = curve.closed ? PathKind::closed : PathKind::open;
        std::vector<Vec3> points = smoothed(curve.points, smooth, curve.closed);
        if (curve.closed) points.push_back(points.front());
        path.curve =
            scene::curve_through(std::move(points), curve.closed ? scene::SplineEnds::repeating : scene::SplineEnds::natural,
                                 scene::SplineSteps::by_distance, path.name);
        textile.paths.push_back(std::move(path));
    }
    detail::require_places(textile, curves);
    textile.crossings = crossings_of(textile);
    require_room(textile);
    return textile;
}

/// The curves of a state's fibres, at their nodes.
/// @param group_of  of each fibre: its yarn
inline std::vector<exchange::FileCurve> curves_of(const observe::Snapshot& snapshot, const std::vector<Index>& group_of) {
    std::vector<exchange::FileCurve> curves;
    for (std::size_t f = 0; f < snapshot.fibres.size(); ++f) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[f];
        exchange::FileCurve curve;
        curve.points = fibre.position, curve.radius = fibre.section.radius(), curve.closed = fibre.closed,
        curve.group = group_of[f];
        if (fibre.closed) curve.points.pop_back();
        curves.push_back(std::move(curve));
    }
    return curves;
}

/// The paths of a textile as curves, so many points each.
inline std::vector<exchange::FileCurve> curves_of(const Textile& textile, Index points) {
    std::vector<exchange::FileCurve> curves;
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        exchange::FileCurve curve;
        const bool closed = path.kind == PathKind::closed;
        for (Index k = 0; k < points; ++k)
            curve.points.push_back(path.curve(static_cast<double>(k) / static_cast<double>(closed ? points : points - 1)));
        curve.radius = half_width(textile.type_of(p)), curve.closed = closed, curve.group = p, curve.name = path.name,
        curve.period = path.image;
        curves.push_back(std::move(curve));
    }
    return curves;
}

}  // namespace fibrant::compositions::textile

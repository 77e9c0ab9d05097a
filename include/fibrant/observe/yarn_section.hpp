// SPDX-License-Identifier: MIT
#pragma once
/// @file Cross-section of a yarn: hull of its fibres, area, aspect, fibre volume fraction, second moments.

#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// A point of a section [length].
using Vec2 = Eigen::Vector2d;

/// Ellipse { centre + cos a axis_1 + sin a axis_2 }.
struct SectionEllipse {
    Vec2 centre = Vec2::Zero(), axis_1 = Vec2::Zero(), axis_2 = Vec2::Zero();
    double area() const noexcept { return std::numbers::pi * std::abs(axis_1.x() * axis_2.y() - axis_1.y() * axis_2.x()); }
};

/// Convex hull of points in the plane, counter-clockwise (Andrew's monotone chain), O(n log n).
inline std::vector<Vec2> convex_hull(std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(),
              [](const Vec2& a, const Vec2& b) { return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y(); });
    const auto right_turn = [](const Vec2& a, const Vec2& b, const Vec2& c) {
        return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x()) <= 0.0;
    };
    std::vector<Vec2> hull;
    for (const bool upper : {false, true}) {
        const std::size_t start = hull.size();
        for (const Vec2& point : points) {
            while (hull.size() >= start + 2 && right_turn(hull[hull.size() - 2], hull.back(), point)) hull.pop_back();
            hull.push_back(point);
        }
        hull.pop_back();
        if (!upper) std::reverse(points.begin(), points.end());
    }
    return hull;
}

/// Shape of a yarn where a plane cuts it.
struct YarnSection {
    std::vector<SectionEllipse> fibres;                        ///< in the plane; first axis across the yarn, second upwards
    std::vector<Vec2> hull;                                    ///< convex, counter-clockwise [length]
    double area = 0;                                           ///< of the hull [length^2]
    double fibre_area = 0;                                     ///< sum over the fibres [length^2]
    double fibre_volume_fraction = 0;                          ///< fibre_area / area [1]
    Vec2 centroid = Vec2::Zero();                              ///< of the hull [length]
    Eigen::Matrix2d second_moments = Eigen::Matrix2d::Zero();  ///< of the hull about its centroid [length^4]
    double width = 0, thickness = 0;                           ///< extents along the principal axes, the wider one first [length]
    double aspect = 0;                                         ///< width / thickness [1]
};

/// Hull and moments of ellipses in a plane. The outline of each ellipse is a polygon of equal area with `sides` sides,
/// which errs by less than 2e-4 of a radius at 128.
inline YarnSection section_of(std::vector<SectionEllipse> ellipses, Index sides = 128) {
    YarnSection section;
    section.fibres = std::move(ellipses);
    const double turn = 2.0 * std::numbers::pi / static_cast<double>(sides);
    const double scale = std::sqrt(turn / std::sin(turn));
    std::vector<Vec2> points;
    points.reserve(section.fibres.size() * core::at(sides));
    for (const SectionEllipse& ellipse : section.fibres) {
        section.fibre_area += ellipse.area();
        for (Index k = 0; k < sides; ++k) {
            const double angle = turn * (static_cast<double>(k) + 0.5);
            points.push_back(ellipse.centre + scale * (std::cos(angle) * ellipse.axis_1 + std::sin(angle) * ellipse.axis_2));
        }
    }
    if (points.empty()) return section;
    section.hull = convex_hull(std::move(points));
    // Sums over triangles from the first corner, which is near: no loss of digits far from the origin.
    const Vec2 corner = section.hull.front();
    Vec2 first = Vec2::Zero();
    Eigen::Matrix2d second = Eigen::Matrix2d::Zero();
    for (std::size_t k = 0; k + 1 < section.hull.size(); ++k) {
        const Vec2 a = section.hull[k] - corner, b = section.hull[k + 1] - corner;
        const double doubled = a.x() * b.y() - a.y() * b.x();
        section.area += 0.5 * doubled;
        first += doubled / 6.0 * (a + b);
        second += doubled / 24.0 * (2.0 * a * a.transpose() + 2.0 * b * b.transpose() + a * b.transpose() + b * a.transpose());
    }
    const Vec2 middle = first / section.area;
    section.centroid = corner + middle;
    section.second_moments = second - section.area * middle * middle.transpose();
    section.fibre_volume_fraction = section.fibre_area / section.area;
    // Angle of the principal axis with the greater moment.
    const double angle =
        0.5 * std::atan2(2.0 * section.second_moments(0, 1), section.second_moments(0, 0) - section.second_moments(1, 1));
    for (const bool wide : {true, false}) {
        const Vec2 axis = wide ? Vec2{std::cos(angle), std::sin(angle)} : Vec2{-std::sin(angle), std::cos(angle)};
        double low = axis.dot(section.hull.front()), high = low;
        for (const Vec2& point : section.hull) {
            low = std::min(low, axis.dot(point));
            high = std::max(high, axis.dot(point));
        }
        (wide ? section.width : section.thickness) = high - low;
    }
    section.aspect = section.width / section.thickness;
    return section;
}

}  // namespace fibrant::observe

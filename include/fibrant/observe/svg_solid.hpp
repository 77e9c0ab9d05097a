// SPDX-License-Identifier: MIT
#pragma once
/// @file Pictures of a solid: its outer faces coloured by a value, seen from a direction, and where a plane cuts its cells.

#include <fibrant/observe/solid_writer.hpp>
#include <fibrant/observe/svg_view.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace fibrant::observe {

namespace detail {

/// Faces of a cell, outwards.
inline constexpr std::array<std::array<int, 4>, 6> cell_faces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
inline constexpr std::array<std::array<int, 2>, 12> cell_edges{
    {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

/// From blue over white to red, t in [0, 1].
inline Colour heat(double t) noexcept {
    t = std::clamp(t, 0.0, 1.0);
    return t < 0.5 ? Colour{0.25 + 1.3 * t, 0.42 + 1.0 * t, 0.72 + 0.4 * t}
                   : Colour{0.9, 0.92 - 1.4 * (t - 0.5), 0.92 - 1.6 * (t - 0.5)};
}

}  // namespace detail

/// Faces that belong to one cell only: the cell, and which of its faces.
inline std::vector<std::pair<Index, int>> outer_faces(const SolidSnapshot& solid) {
    struct Face {
        std::array<Index, 4> nodes;
        Index cell;
        int face;
    };
    std::vector<Face> faces;
    for (Index c = 0; c < core::count(solid.cells); ++c)
        for (int f = 0; f < 6; ++f) {
            Face face{{}, c, f};
            for (std::size_t k = 0; k < 4; ++k)
                face.nodes[k] = solid.cells[core::at(c)][core::at(detail::cell_faces[core::at(f)][k])];
            std::sort(face.nodes.begin(), face.nodes.end());
            faces.push_back(face);
        }
    std::stable_sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.nodes < b.nodes; });
    std::vector<std::pair<Index, int>> outer;
    for (std::size_t k = 0; k < faces.size(); ++k) {
        const bool twin =
            (k > 0 && faces[k - 1].nodes == faces[k].nodes) || (k + 1 < faces.size() && faces[k + 1].nodes == faces[k].nodes);
        if (!twin) outer.emplace_back(faces[k].cell, faces[k].face);
    }
    return outer;
}

/// The outer faces, painted from the farthest to the nearest, in colours from 0 (blue) to `most` (red) of a value a cell.
/// @param values  of the cells, as many   @param most  > 0
inline std::string svg_solid(const SolidSnapshot& solid, const std::vector<double>& values, double most,
                             const ViewParameters& parameters = {}) {
    parameters.validate();
    if (values.size() != solid.cells.size())
        core::refuse("svg_solid.values", std::to_string(values.size()),
                     "one for each of " + std::to_string(solid.cells.size()) + " cells");
    core::require_positive("svg_solid.most", most);
    constexpr double degree = std::numbers::pi / 180.0;
    const double az = parameters.azimuth * degree, el = parameters.elevation * degree;
    const Vec3 eye{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)};
    const Vec3 right{-std::sin(az), std::cos(az), 0.0}, up = eye.cross(right),
                                                        light = (-0.45 * right + 0.6 * up + 0.75 * eye).normalized();
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& x : solid.position) {
        const Eigen::Vector2d p{right.dot(x), -up.dot(x)};
        low = low.cwiseMin(p), high = high.cwiseMax(p);
    }
    constexpr double margin = 48.0;
    if (!(high.x() > low.x())) return detail::svg_page(parameters.width, 200.0, "", "", parameters.title);
    const double scale = std::min((parameters.width - 2.0 * margin) / (high.x() - low.x()),
                                  (1.5 * parameters.width - 2.0 * margin) / (high.y() - low.y()));
    const double height = scale * (high.y() - low.y()) + 2.0 * margin + 30.0,
                 left = 0.5 * (parameters.width - scale * (high.x() - low.x()));
    struct Painted {
        double depth;
        std::string path;
    };
    std::vector<Painted> faces;
    for (const auto& [cell, face] : outer_faces(solid)) {
        std::array<Vec3, 4> x;
        for (std::size_t k = 0; k < 4; ++k)
            x[k] = solid.position[core::at(solid.cells[core::at(cell)][core::at(detail::cell_faces[core::at(face)][k])])];
        const Vec3 normal = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
        if (normal.dot(eye) <= 0.0) continue;
        const Colour colour = detail::heat(values[core::at(cell)] / most).toned(0.55 + 0.5 * std::max(0.0, normal.dot(light)));
        std::string path = "<path fill=\"" + colour.text() + "\" stroke=\"" + colour.toned(0.75).text() + "\" d=\"M";
        for (std::size_t k = 0; k < 4; ++k)
            path +=
                (k == 0 ? "" : "L") +
                detail::point_text({left + scale * (right.dot(x[k]) - low.x()), margin + scale * (-up.dot(x[k]) - low.y())}, 1);
        faces.push_back({0.25 * eye.dot(x[0] + x[1] + x[2] + x[3]), path + "z\"/>\n"});
    }
    std::stable_sort(faces.begin(), faces.end(), [](const Painted& a, const Painted& b) { return a.depth < b.depth; });
    std::string body;
    for (const Painted& face : faces) body += face.path;
    for (int k = 0; k < 20; ++k)  // what the colours mean
        body += "<rect x=\"" + std::to_string(static_cast<int>(parameters.width) - 320 + 12 * k) + "\" y=\"" +
                rounded(height - 30.0, 1) + "\" width=\"12\" height=\"12\" fill=\"" + detail::heat((k + 0.5) / 20.0).text() +
                "\"/>\n";
    const int decimals = std::clamp(2 - static_cast<int>(std::floor(std::log10(most))), 0, 300);  // three digits
    body += detail::svg_text(parameters.width - 336.0, height - 19.0, "0") +
            detail::svg_text(parameters.width - 74.0, height - 19.0, rounded(most, decimals));
    body += detail::svg_scale_bar(24, height - 20, 0.2 * parameters.width, scale, parameters.unit);
    return detail::svg_page(parameters.width, height, "path{stroke-width:.4}\n", body, parameters.title);
}

/// Where the plane { x_axis = position } cuts the cells: polygons in the plane's two axes.
inline std::vector<std::vector<Eigen::Vector2d>> solid_cuts(const SolidSnapshot& solid, Index axis, double position) {
    const std::array<Index, 2> plane{axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    std::vector<std::vector<Eigen::Vector2d>> cuts;
    for (const auto& cell : solid.cells) {
        std::vector<Eigen::Vector2d> points;
        for (const auto& [a, b] : detail::cell_edges) {
            const Vec3 &p = solid.position[core::at(cell[core::at(a)])], &q = solid.position[core::at(cell[core::at(b)])];
            if ((p[axis] < position) == (q[axis] < position)) continue;
            const Vec3 x = p + (position - p[axis]) / (q[axis] - p[axis]) * (q - p);
            points.emplace_back(x[plane[0]], x[plane[1]]);
        }
        if (points.size() < 3) continue;
        Eigen::Vector2d middle = Eigen::Vector2d::Zero();
        for (const auto& p : points) middle += p / static_cast<double>(points.size());
        std::sort(points.begin(), points.end(), [&](const auto& a, const auto& b) {
            return std::atan2(a.y() - middle.y(), a.x() - middle.x()) < std::atan2(b.y() - middle.y(), b.x() - middle.x());
        });
        cuts.push_back(std::move(points));
    }
    return cuts;
}

}  // namespace fibrant::observe

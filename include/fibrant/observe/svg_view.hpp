// SPDX-License-Identifier: MIT
#pragma once
/// @file A picture in space of all fibres, as SVG.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/observe/svg.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <vector>

namespace fibrant::observe {

/// Parallel projection.
struct ViewParameters {
    double azimuth = -60.0;   ///< of the eye about z, from the x axis [degrees]
    double elevation = 35.0;  ///< of the eye above the plane z = 0, in [-90, 90] [degrees]
    double width = 1200.0;    ///< of the picture, >= 100 [pixels]; the height follows
    Index pieces = 30000;     ///< at most about so many pieces of fibres are drawn, >= 1
    std::string title;        ///< above the picture; empty: none
    std::string unit;         ///< of lengths, for the scale bar
    Palette palette;          ///< colours by fibre and group

    void validate() const {
        core::require_finite("ViewParameters.azimuth", azimuth);
        core::require_between("ViewParameters.elevation", elevation, -90.0, 90.0);
        core::require_between("ViewParameters.width", width, 100.0, 1e5);
        core::require_at_least("ViewParameters.pieces", pieces, 1);
    }
};

namespace detail {

enum class PieceKind { line, section, cut_face };

/// A piece of a fibre as a thick line, or a section of it as an ellipse, in pixels.
struct ViewPiece {
    Eigen::Vector2d from, to;  ///< ends of the line, or the middle of the ellipse twice
    double half_width, depth;  ///< depth grows towards the eye
    Vec3 tangent;              ///< along the fibre; outwards at a cut face
    Index fibre;
    PieceKind kind;
    Eigen::Vector2d axis_1{0, 0}, axis_2{0, 0};  ///< of the ellipse

    /// Is the pixel in the line, square ends a little beyond its points, or in the ellipse?
    bool holds(const Eigen::Vector2d& pixel) const noexcept {
        const Eigen::Vector2d d = pixel - from;
        if (kind != PieceKind::line) {
            const double determinant = axis_1.x() * axis_2.y() - axis_1.y() * axis_2.x();
            const double a = (d.x() * axis_2.y() - d.y() * axis_2.x()) / determinant;
            const double b = (axis_1.x() * d.y() - axis_1.y() * d.x()) / determinant;
            return a * a + b * b <= 1.0;
        }
        const Eigen::Vector2d chord = to - from;
        const double length = std::max(chord.norm(), 1e-9), along = d.dot(chord) / length;
        const double aside = (d.x() * chord.y() - d.y() * chord.x()) / length;
        return along >= -beyond() && along <= length + beyond() && std::abs(aside) <= half_width;
    }
    double beyond() const noexcept { return 0.12 * half_width; }
};

/// Which cells of the page are hidden already: pieces are tried from the nearest to the farthest.
class Coverage {
public:
    Coverage(double width, double height, double cell)
        : cell_{std::max(cell, std::sqrt(width * height / 4e6))},
          columns_{static_cast<Index>(width / cell_) + 2},
          rows_{static_cast<Index>(height / cell_) + 2},
          covered_(core::at(columns_ * rows_), 0) {}

    /// Covers the cells of a piece; false if all of them were covered before.
    bool shows(const ViewPiece& piece) {
        bool any = false;
        const auto cells = [&](double low, double high, Index count) {
            const auto clamp = [&](double v) {
                return static_cast<Index>(std::clamp(std::floor(v / cell_), 0.0, static_cast<double>(count - 1)));
            };
            const double reach = 1.3 * piece.half_width;
            return std::pair<Index, Index>{clamp(low - reach), clamp(high + reach)};
        };
        const auto xs = cells(std::min(piece.from.x(), piece.to.x()), std::max(piece.from.x(), piece.to.x()), columns_);
        const auto ys = cells(std::min(piece.from.y(), piece.to.y()), std::max(piece.from.y(), piece.to.y()), rows_);
        for (Index row = ys.first; row <= ys.second; ++row) {
            for (Index column = xs.first; column <= xs.second; ++column) {
                char& cell = covered_[core::at(row * columns_ + column)];
                if (cell != 0 ||
                    !piece.holds({(static_cast<double>(column) + 0.5) * cell_, (static_cast<double>(row) + 0.5) * cell_}))
                    continue;
                any = true;
                cell = 1;
            }
        }
        return any;
    }

private:
    double cell_;
    Index columns_, rows_;
    std::vector<char> covered_;
};

}  // namespace detail

/// The fibres as shaded tubes, seen from a direction: short pieces painted from the farthest to the nearest, each as a
/// dark outline, a body lit from the upper left and darker with distance, and a light streak. Pieces behind
/// others are left out, so a dense assembly costs little more than its surface.
inline std::string svg_view(const Snapshot& snapshot, const ViewParameters& parameters = {}) {
    parameters.validate();
    constexpr double degree = std::numbers::pi / 180.0;
    const double az = parameters.azimuth * degree, el = parameters.elevation * degree;
    const Vec3 eye{std::cos(el) * std::cos(az), std::cos(el) * std::sin(az), std::sin(el)};
    const Vec3 right{-std::sin(az), std::cos(az), 0.0}, up = eye.cross(right);
    const Vec3 light = (-0.45 * right + 0.6 * up + 0.75 * eye).normalized();

    // Extent of the picture, and the total length, from which the length of a piece follows.
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    double nearest = high.x(), farthest = low.x(), total = 0.0;
    for (const FibreSnapshot& fibre : snapshot.fibres) {
        for (std::size_t node = 0; node < fibre.position.size(); ++node) {
            const Vec3& x = fibre.position[node];
            const Eigen::Vector2d p{right.dot(x), -up.dot(x)}, r = Eigen::Vector2d::Constant(fibre.section.radius());
            low = low.cwiseMin(p - r);
            high = high.cwiseMax(p + r);
            nearest = std::max(nearest, eye.dot(x));
            farthest = std::min(farthest, eye.dot(x));
            if (node > 0) total += (x - fibre.position[node - 1]).norm();
        }
    }
    constexpr double margin = 48.0;
    if (!(high.x() > low.x())) return detail::svg_page(parameters.width, 200.0, "", "", parameters.title);
    // A view along the fibres is high and narrow: it must not become a page of any height.
    const double scale = std::min((parameters.width - 2.0 * margin) / (high.x() - low.x()),
                                  (1.5 * parameters.width - 2.0 * margin) / (high.y() - low.y()));
    const double height = scale * (high.y() - low.y()) + 2.0 * margin;
    const double left = 0.5 * (parameters.width - scale * (high.x() - low.x()));
    const auto on_page = [&](const Vec3& x) {
        return Eigen::Vector2d{left + scale * (right.dot(x) - low.x()), margin + scale * (-up.dot(x) - low.y())};
    };

    std::vector<detail::ViewPiece> pieces;
    double thinnest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < snapshot.fibres.size(); ++k) {
        const FibreSnapshot& fibre = snapshot.fibres[k];
        const std::size_t nodes = fibre.position.size();
        if (nodes < 2) continue;
        double length = 0.0;
        for (std::size_t node = 1; node < nodes; ++node) length += (fibre.position[node] - fibre.position[node - 1]).norm();
        const double step = std::max(1.5 * fibre.section.radius(), total / static_cast<double>(parameters.pieces));
        const auto count = std::max<Index>(1, static_cast<Index>(std::ceil(length / step)));
        const auto at = [&](Index piece, const std::vector<Vec3>& values) -> Vec3 {
            const double t = static_cast<double>(piece) / static_cast<double>(count) * static_cast<double>(nodes - 1);
            const std::size_t first = std::min(static_cast<std::size_t>(t), nodes - 2);
            const double share = t - static_cast<double>(first);
            return (1.0 - share) * values[first] + share * values[first + 1];
        };
        const std::size_t first_piece = pieces.size();
        for (Index piece = 0; piece < count; ++piece) {
            const Vec3 a = at(piece, fibre.position), b = at(piece + 1, fibre.position), chord = b - a;
            const Vec3 tangent = chord.norm() > 0.0 ? Vec3(chord.normalized()) : eye;
            // Half the width of the silhouette: extent of the section across the line of sight.
            Vec3 across = tangent.cross(eye);
            across = across.norm() > 1e-6 ? Vec3(across.normalized()) : right;
            const double half_width =
                scale * fibre.section.extent(at(piece, fibre.director_1), at(piece, fibre.director_2), across);
            thinnest = std::min(thinnest, half_width);
            pieces.push_back({on_page(a), on_page(b), half_width, 0.5 * eye.dot(a + b), tangent, static_cast<Index>(k),
                              detail::PieceKind::line});
        }
        // Sections between pieces, behind both: where a fibre turns away from the eye they round its outline, and
        // elsewhere they are hidden and left out. At an end that faces the eye, the cut face before the last piece.
        const std::size_t last_piece = pieces.size() - 1;
        for (Index joint = 0; joint <= count; ++joint) {
            const bool end = (joint == 0 || joint == count) && !fibre.closed;
            const detail::ViewPiece before = fibre.closed && joint == 0
                                                 ? pieces[last_piece]
                                                 : pieces[std::max(first_piece + core::at(joint), first_piece + 1) - 1];
            const detail::ViewPiece after = fibre.closed && joint == count
                                                ? pieces[first_piece]
                                                : pieces[std::min(first_piece + core::at(joint), last_piece)];
            const Vec3 centre = at(joint, fibre.position);
            const Vec3 axis_1 = fibre.section.semi_axis_1 * at(joint, fibre.director_1);
            const Vec3 axis_2 = fibre.section.semi_axis_2 * at(joint, fibre.director_2);
            const Vec3 outwards = joint == 0 ? Vec3(-after.tangent) : before.tangent;
            const bool face = end && outwards.dot(eye) > 0.0;
            const double radius = fibre.section.radius();
            detail::ViewPiece section{
                on_page(centre),
                on_page(centre),
                scale * radius,
                face ? std::max(before.depth, after.depth) + radius : std::min(before.depth, after.depth) - 0.01 * radius,
                face ? outwards : Vec3(before.tangent),
                static_cast<Index>(k),
                face ? detail::PieceKind::cut_face : detail::PieceKind::section,
                scale * Eigen::Vector2d{right.dot(axis_1), -up.dot(axis_1)},
                scale * Eigen::Vector2d{right.dot(axis_2), -up.dot(axis_2)}};
            // Seen edge-on it is a line.
            const double area = section.axis_1.x() * section.axis_2.y() - section.axis_1.y() * section.axis_2.x();
            if (std::abs(area) > 0.03 * section.half_width * section.half_width) pieces.push_back(section);
        }
    }

    std::vector<std::size_t> order(pieces.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pieces[a].depth > pieces[b].depth; });
    detail::Coverage coverage(parameters.width, height, std::max(0.25, 0.25 * thinnest));
    std::erase_if(order, [&](std::size_t k) { return !coverage.shows(pieces[k]); });

    // One class a colour and tone keeps the file small.
    constexpr int tones = 16;
    std::vector<Colour> colours;
    std::vector<std::string> colour_texts;
    std::vector<char> used;
    const auto colour_class = [&](Index fibre) {
        const Colour colour = parameters.palette.of(fibre, snapshot.fibres[core::at(fibre)].group);
        const std::string text = colour.text();
        const auto known = std::find(colour_texts.begin(), colour_texts.end(), text);
        if (known != colour_texts.end()) return static_cast<std::size_t>(known - colour_texts.begin());
        colour_texts.push_back(text);
        colours.push_back(colour);
        used.resize(colours.size() * tones, 0);
        return colours.size() - 1;
    };
    std::string body;
    const double range = std::max(nearest - farthest, 1e-300);
    for (auto k = order.rbegin(); k != order.rend(); ++k) {
        const detail::ViewPiece& piece = pieces[*k];
        const std::size_t colour = colour_class(piece.fibre);
        // Light on the face, or on the line of the tube that faces the eye, dimmed with distance.
        const bool face = piece.kind == detail::PieceKind::cut_face;
        Vec3 facing = face ? piece.tangent : Vec3(eye - piece.tangent.dot(eye) * piece.tangent);
        facing = facing.norm() > 1e-6 ? Vec3(facing.normalized()) : eye;
        const double lit = std::max(0.0, facing.dot(light));
        const double near = std::clamp((piece.depth - farthest) / range, 0.0, 1.0);
        const double tone = (0.35 + 0.65 * lit) * (0.8 + 0.2 * near);
        const int level = std::clamp(static_cast<int>(tone * tones), 0, tones - 1);
        used[colour * tones + core::at(level)] = 1;
        const std::string name = std::to_string(colour) + "_" + std::to_string(level);
        if (piece.kind != detail::PieceKind::line) {
            body += "<path class=\"" + std::string(face ? "f" : "s") + name + "\" d=\"M";
            for (int corner = 0; corner < 12; ++corner) {
                const double angle = std::numbers::pi * corner / 6.0;
                body += (corner == 0 ? "" : "L") +
                        detail::point_text(piece.from + std::cos(angle) * piece.axis_1 + std::sin(angle) * piece.axis_2);
            }
            body += "z\"/>\n";
            continue;
        }
        const Eigen::Vector2d ahead = (piece.to - piece.from) / std::max((piece.to - piece.from).norm(), 1e-9);
        const auto line = [&](const std::string& kind, double width, const Eigen::Vector2d& shift, double more) {
            body += "<path class=\"" + kind + "\" stroke-width=\"" + rounded(width, 1) + "\" d=\"M" +
                    detail::point_text(piece.from + shift - more * ahead) + "L" +
                    detail::point_text(piece.to + shift + more * ahead) + "\"/>\n";
        };
        // The outline ends square, so it never crosses the body of a neighbour; the body is a little longer, which
        // closes bends, and so is the streak, which would be broken by the next body otherwise.
        const double more = piece.beyond();
        const double rim = std::clamp(0.14 * piece.half_width, 0.3, 1.5);
        line("o" + std::to_string(colour), 2.0 * piece.half_width, Eigen::Vector2d::Zero(), 0.3);
        line("b" + name, 2.0 * (piece.half_width - rim), Eigen::Vector2d::Zero(), more);
        if (piece.half_width < 2.0) continue;
        const Vec3 towards = light - piece.tangent.dot(light) * piece.tangent;
        const Vec3 bright = towards.norm() > 1e-6 ? Vec3(towards.normalized()) : eye;
        const Vec3 side = piece.tangent.cross(eye);
        if (side.norm() < 1e-6) continue;
        const Vec3 unit_side = side.normalized();
        const Eigen::Vector2d page_side{right.dot(unit_side), -up.dot(unit_side)};
        line("h" + name, 0.5 * piece.half_width, 0.75 * piece.half_width * bright.dot(unit_side) * page_side, more);
    }

    std::string style = "path{fill:none}\n";
    for (std::size_t colour = 0; colour < colours.size(); ++colour) {
        style += ".o" + std::to_string(colour) + "{stroke:" + colours[colour].toned(0.32).text() + "}\n";
        for (std::size_t level = 0; level < tones; ++level) {
            if (used[colour * tones + level] == 0) continue;
            const std::string name = std::to_string(colour) + "_" + std::to_string(level);
            const double tone = (static_cast<double>(level) + 0.5) / tones;
            style += ".b" + name + "{stroke:" + colours[colour].toned(0.3 + 0.75 * tone).text() + "}.h" + name +
                     "{stroke:" + colours[colour].toned(0.55 + 0.85 * tone).text() + "}.s" + name +
                     "{fill:" + colours[colour].toned(0.3 + 0.75 * tone).text() +
                     ";stroke:" + colours[colour].toned(0.32).text() + "}.f" + name +
                     "{fill:" + colours[colour].toned(0.7 + 0.85 * tone).text() +
                     ";stroke:" + colours[colour].toned(0.32).text() + ";stroke-width:.6}\n";
        }
    }
    body += detail::svg_scale_bar(24, height - 20, 0.2 * parameters.width, scale, parameters.unit);
    return detail::svg_page(parameters.width, height, style, body, parameters.title);
}

}  // namespace fibrant::observe

// SPDX-License-Identifier: MIT
#pragma once
/// @file A cut through all fibres by a plane across an axis, as SVG.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/observe/svg.hpp>
#include <fibrant/observe/svg_solid.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::observe {

/// Plane, size and colours of the picture of a slice.
struct SliceParameters {
    Index axis = 0;                 ///< across which the plane lies: 0 for x, 1 for y, 2 for z
    double position = core::unset;  ///< of the plane on that axis [length]
    double width = 1200.0;          ///< of the picture, >= 100 [pixels]; the height follows
    std::string title;              ///< above the picture; empty: none
    std::string unit;               ///< of lengths, for the scale bar
    Palette palette;                ///< colours by fibre and group

    void validate() const {
        core::require(axis >= 0 && axis <= 2, "SliceParameters.axis", static_cast<double>(axis), "0, 1 or 2");
        core::require_finite("SliceParameters.position", position);
        core::require_between("SliceParameters.width", width, 100.0, 1e5);
    }
};

/// Where a plane cuts a fibre: the outline of the cut, in the plane's two axes, in order.
struct SliceShape {
    std::vector<Eigen::Vector2d> outline;  ///< closed polygon [length]
    Index fibre = -1;
    bool along = false;  ///< the fibre runs in the plane: a strip along it, not an ellipse across
};

namespace detail {

/// Strip cut out of a fibre that runs along the plane: chords of its sections with the plane, exact for round sections.
class SliceStrip {
public:
    /// @param beyond  signed distance of the centre from the plane   @param lean  sine of the angle of fibre and plane
    void add(const Eigen::Vector2d& centre, const Eigen::Vector2d& direction, double beyond, double lean, double radius) {
        const double square = radius * radius - beyond * beyond / (1.0 - lean * lean);
        if (square <= 0.0) return;
        const Eigen::Vector2d side = std::sqrt(square) * Eigen::Vector2d{-direction.y(), direction.x()};
        left_.push_back(centre + side);
        right_.push_back(centre - side);
    }
    bool empty() const noexcept { return left_.size() < 2; }
    std::vector<Eigen::Vector2d> outline() {
        left_.insert(left_.end(), right_.rbegin(), right_.rend());
        return std::move(left_);
    }

private:
    std::vector<Eigen::Vector2d> left_, right_;
};

}  // namespace detail

/// Outlines of all fibres in the plane { x_axis = position }, by fibre.
///
/// A fibre that passes through at more than 30 degrees gives the ellipse of its deformed section (semi-axes along g_1
/// and g_2) carried to the plane along the fibre, which is the true cut; one that runs along the plane gives a strip.
inline std::vector<SliceShape> slice_shapes(const Snapshot& snapshot, Index axis, double position) {
    const std::array<Index, 2> plane{axis == 0 ? 1 : 0, axis == 2 ? 1 : 2};
    const auto flat = [&](const Vec3& v) { return Eigen::Vector2d{v[plane[0]], v[plane[1]]}; };
    std::vector<SliceShape> shapes;
    for (std::size_t k = 0; k < snapshot.fibres.size(); ++k) {
        const FibreSnapshot& fibre = snapshot.fibres[k];
        const double radius = std::sqrt(fibre.section.semi_axis_1 * fibre.section.semi_axis_2);
        detail::SliceStrip strip;
        const auto close_strip = [&] {
            if (!strip.empty()) shapes.push_back({strip.outline(), static_cast<Index>(k), true});
            strip = {};
        };
        const std::size_t chords = fibre.position.size() - 1;
        // Around a closed fibre from where it passes through: no strip is cut where it begins, unless all of it lies in the
        // plane.
        std::size_t start = 0;
        const auto passes = [&](std::size_t node) {
            return std::abs((fibre.position[node + 1] - fibre.position[node]).normalized()[axis]) >= 0.5;
        };
        while (fibre.closed && start < chords && !passes(start)) ++start;
        for (std::size_t chord_number = 0; chord_number < chords; ++chord_number) {
            const std::size_t node = (start + chord_number) % chords;
            const Vec3 &a = fibre.position[node], &b = fibre.position[node + 1];
            const Vec3 chord = b - a, tangent = chord.normalized();
            const double lean = tangent[axis], from = a[axis] - position, to = b[axis] - position;
            if (std::abs(lean) < 0.5) {
                const Eigen::Vector2d direction = flat(tangent).normalized();
                constexpr int parts = 8;
                for (int part = chord_number == 0 ? 0 : 1; part <= parts; ++part) {
                    const double s = static_cast<double>(part) / parts, beyond = from + s * (to - from);
                    // Middle of the chord that the plane cuts from the section there.
                    Vec3 across = -lean * tangent;
                    across[axis] += 1.0;
                    if (beyond * beyond >= radius * radius * (1.0 - lean * lean)) close_strip();
                    strip.add(flat(a + s * chord - beyond / (1.0 - lean * lean) * across), direction, beyond, lean, radius);
                }
                continue;
            }
            close_strip();
            if ((from < 0.0) == (to < 0.0)) continue;
            const double s = from / (from - to);
            const auto carried = [&](const std::vector<Vec3>& director, double semi_axis) {
                const Vec3 v = semi_axis * ((1.0 - s) * director[node] + s * director[node + 1]);
                return flat(v - v[axis] / lean * tangent);
            };
            const Eigen::Vector2d p = carried(fibre.director_1, fibre.section.semi_axis_1),
                                  q = carried(fibre.director_2, fibre.section.semi_axis_2), centre = flat(a + s * chord);
            SliceShape shape{{}, static_cast<Index>(k), false};
            constexpr int corners = 32;
            for (int corner = 0; corner < corners; ++corner) {
                const double angle = 2.0 * std::numbers::pi * corner / corners;
                shape.outline.push_back(centre + std::cos(angle) * p + std::sin(angle) * q);
            }
            shapes.push_back(std::move(shape));
        }
        close_strip();
    }
    return shapes;
}

/// The cut as a picture: fibres that pass through in the full colour of their group, those that run along paler, with
/// axes, scale bar and title.
inline std::string svg_slice(const Snapshot& snapshot, const SliceParameters& parameters) {
    parameters.validate();
    std::vector<SliceShape> shapes = slice_shapes(snapshot, parameters.axis, parameters.position);
    // Strips first, so that they never hide a section.
    std::stable_partition(shapes.begin(), shapes.end(), [](const SliceShape& shape) { return shape.along; });
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity()), high = -low;
    for (const SliceShape& shape : shapes) {
        for (const Eigen::Vector2d& corner : shape.outline) {
            low = low.cwiseMin(corner);
            high = high.cwiseMax(corner);
        }
    }
    const std::vector<std::vector<Eigen::Vector2d>> cuts = solid_cuts(snapshot.solid, parameters.axis, parameters.position);
    for (const auto& cut : cuts)
        for (const Eigen::Vector2d& corner : cut) low = low.cwiseMin(corner), high = high.cwiseMax(corner);
    if (shapes.empty()) return detail::svg_page(parameters.width, 200.0, "", "", parameters.title + " (no fibre)");
    constexpr double margin = 60.0;
    const double scale = std::min((parameters.width - 2.0 * margin) / (high.x() - low.x()),
                                  (1.5 * parameters.width - 2.0 * margin) / (high.y() - low.y()));
    const double height = scale * (high.y() - low.y()) + 2.0 * margin + 40.0;
    const double left = 0.5 * (parameters.width - scale * (high.x() - low.x()));
    std::string body;
    for (const auto& cut : cuts) {
        body += "<path fill=\"#e9e4d4\" stroke=\"#b5ad97\" d=\"M";
        for (const Eigen::Vector2d& corner : cut)
            body += (&corner == cut.data() ? "" : "L") +
                    detail::point_text({left + scale * (corner.x() - low.x()), margin + scale * (high.y() - corner.y())}, 2);
        body += "z\"/>\n";
    }
    for (const SliceShape& shape : shapes) {
        const Colour colour =
            parameters.palette.of(shape.fibre, snapshot.fibres[core::at(shape.fibre)].group).toned(shape.along ? 1.5 : 1.0);
        body += "<path fill=\"" + colour.text() + "\" stroke=\"" + colour.toned(shape.along ? 0.75 : 0.4).text() + "\" d=\"M";
        for (const Eigen::Vector2d& corner : shape.outline)
            body += (&corner == shape.outline.data() ? "" : "L") +
                    detail::point_text({left + scale * (corner.x() - low.x()), margin + scale * (high.y() - corner.y())}, 2);
        body += "z\"/>\n";
    }
    const char* names[] = {"x", "y", "z"};
    const double x = parameters.width - 110.0, y = height - 24.0;
    body += "<path d=\"M" + rounded(x, 1) + " " + rounded(y - 40.0, 1) + "v40h40m-6-4l6 4-6 4m-38-38l4-6 4 6" +
            "\" stroke=\"#222\" stroke-width=\"1.5\" fill=\"none\"/>\n";
    body += detail::svg_text(x + 46.0, y + 5.0, names[parameters.axis == 0 ? 1 : 0]);
    body += detail::svg_text(x - 5.0, y - 46.0, names[parameters.axis == 2 ? 1 : 2]);
    body += detail::svg_scale_bar(24.0, height - 24.0, 0.2 * parameters.width, scale, parameters.unit);
    std::string title = parameters.title.empty() ? std::string{} : parameters.title + ", ";
    const int digits =
        std::max(0, 3 - static_cast<int>(std::floor(std::log10(high.x() - low.x()))));  // to a thousandth of the picture
    title += std::string(names[parameters.axis]) + " = " + rounded(parameters.position, digits);
    if (!parameters.unit.empty()) title += " " + parameters.unit;
    return detail::svg_page(parameters.width, height, "path{stroke-width:.7}\n", body, title);
}

}  // namespace fibrant::observe

// SPDX-License-Identifier: MIT
#pragma once
/// @file Yarns of several fibres as bodies: sections across their mean line, and closed surfaces around all fibres.

#include <fibrant/exchange/tubes.hpp>
#include <fibrant/observe/poly_data.hpp>
#include <fibrant/observe/yarn_section.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::exchange {

/// A plane across the mean line of a yarn, and what it cuts.
struct YarnStation {
    double along = 0.0;                                                        ///< arc of the mean line from its start [length]
    Vec3 place = Vec3::Zero();                                                 ///< of the mean line [length]
    Vec3 tangent = Vec3::Zero(), first = Vec3::Zero(), second = Vec3::Zero();  ///< of the plane, orthonormal, right-handed
    observe::YarnSection section{};  ///< along `first` and `second`, about `place`; fibres in the order of the yarn's curves

    Vec3 at(const observe::Vec2& p) const noexcept { return place + p.x() * first + p.y() * second; }
    /// The direction in which the section is widest, unit.
    Vec3 widest() const noexcept {
        const double angle =
            0.5 * std::atan2(2.0 * section.second_moments(0, 1), section.second_moments(0, 0) - section.second_moments(1, 1));
        return std::cos(angle) * first + std::sin(angle) * second;
    }
};

/// The fibres of a group, or a curve without a group.
struct FileYarn {
    Index group = -1;
    std::vector<std::size_t> curves{};
    bool closed = false;
    double length = 0.0;  ///< of the mean line, round the whole of a closed one [length]
    std::vector<YarnStation> stations{};
};

namespace detail {
inline std::vector<double> arcs_of(const FileCurve& curve) {
    const std::size_t n = curve.points.size();
    std::vector<double> arc{0.0};
    for (std::size_t k = 1; k < n + (curve.closed ? 1 : 0); ++k)
        arc.push_back(arc.back() + (curve.points[k % n] - curve.points[k - 1]).norm());
    return arc;
}

/// Segment of a line that holds an arc from its start.
inline std::size_t segment_at(const std::vector<double>& arcs, double arc) {
    return static_cast<std::size_t>(std::upper_bound(arcs.begin() + 1, arcs.end() - 1, arc) - arcs.begin()) - 1;
}

/// Where a line meets a plane, nearest along it to a segment, and its direction there. Beyond the ends of an open
/// line it goes on straight.
inline std::pair<Vec3, Vec3> crossing_of(const FileCurve& curve, Index start, const Vec3& place, const Vec3& normal) {
    const std::vector<Vec3>& p = curve.points;
    const Index n = core::count(p), segments = n - (curve.closed ? 0 : 1);
    const auto point = [&](Index k) -> const Vec3& { return p[core::at(((k % n) + n) % n)]; };
    const auto height = [&](Index k) { return (point(k) - place).dot(normal); };
    // Not far along it: a line that comes back, as that of a loop, meets the plane again.
    const Index far = std::max<Index>(4, segments / 4);
    for (Index d = 0; d < std::min(far, segments); ++d)
        for (const Index k : {start + d, start - d}) {
            if (!curve.closed && (k < 0 || k >= segments)) continue;
            const double a = height(k), b = height(k + 1), rounding = 1e-9 * (point(k + 1) - point(k)).norm();
            if (std::abs(a - b) <= rounding || std::min(a, b) > rounding || std::max(a, b) < -rounding) continue;
            return {point(k) + a / (a - b) * (point(k + 1) - point(k)), (point(k + 1) - point(k)).normalized()};
        }
    const bool at_start = std::abs(height(0)) < std::abs(height(n - 1));
    const Vec3 along = (at_start ? p[1] - p[0] : p[core::at(n - 1)] - p[core::at(n - 2)]).normalized();
    // A line that goes along the plane meets it nowhere; the end itself is nearest.
    constexpr double least_slope = 0.2;
    const double slope = along.dot(normal), from = height(at_start ? 0 : n - 1);
    const Vec3 end = at_start ? p.front() : p.back();
    return {std::abs(slope) < least_slope ? end : Vec3(end - from / slope * along), along};
}
}  // namespace detail

/// Yarns of curves: those of one group are one yarn, in the order of their numbers; a curve without a group is a yarn of its own.
/// Sections are taken across the mean of the fibres' points at equal shares of their lengths. Fibres that go the other way are
/// turned; a closed fibre of a yarn begins where it is nearest to the start of the first one.
/// @param spacing  of sections [length]; 0: twice the radius of a fibre, of a sixteenth of the length at most
/// @throws std::invalid_argument where a yarn has open and closed curves, or a radius is not known
inline std::vector<FileYarn> yarns_of(const std::vector<FileCurve>& curves, double spacing = 0.0) {
    core::require_not_negative("yarns_of.spacing", spacing);
    std::vector<std::pair<Index, std::size_t>> order;
    for (std::size_t c = 0; c < curves.size(); ++c)
        order.emplace_back(curves[c].group >= 0 ? curves[c].group : std::numeric_limits<Index>::max(), c);
    std::sort(order.begin(), order.end());
    std::vector<FileYarn> yarns;
    for (const auto& [group, c] : order) {
        if (yarns.empty() || curves[c].group < 0 || yarns.back().group != group)
            yarns.push_back({curves[c].group, {}, curves[c].closed});
        yarns.back().curves.push_back(c);
        if (curves[c].closed != yarns.back().closed)
            core::refuse("curve " + std::to_string(c), curves[c].closed ? "closed" : "open",
                         "as the other curves of yarn " + std::to_string(group));
        core::require_positive("radius of curve " + std::to_string(c),
                               curves[c].radii.empty() ? curves[c].radius : curves[c].radii.front());
    }
    constexpr Index least_stations = 16;
    for (FileYarn& yarn : yarns) {
        std::vector<FileCurve> fibres;
        for (const std::size_t c : yarn.curves) {
            FileCurve fibre = curves[c];
            const FileCurve& one = fibres.empty() ? fibre : fibres.front();
            const std::size_t a = fibre.points.size() / 8, b = one.points.size() / 8;
            if (yarn.closed) {
                const auto distance = [&](const Vec3& p) { return (p - one.points.front()).squaredNorm(); };
                const auto nearest = std::min_element(fibre.points.begin(), fibre.points.end(),
                                                      [&](const Vec3& p, const Vec3& q) { return distance(p) < distance(q); });
                std::rotate(fibre.points.begin(), nearest, fibre.points.end());
                if ((fibre.points[a] - fibre.points[0]).dot(one.points[b] - one.points[0]) < 0.0)
                    std::reverse(fibre.points.begin() + 1, fibre.points.end());
                fibre.radii.clear();  // one radius of a fibre is enough for its section
                if (!curves[c].radii.empty()) fibre.radius = *std::max_element(curves[c].radii.begin(), curves[c].radii.end());
            } else if ((fibre.points.front() - one.points.front()).squaredNorm() +
                           (fibre.points.back() - one.points.back()).squaredNorm() >
                       (fibre.points.front() - one.points.back()).squaredNorm() +
                           (fibre.points.back() - one.points.front()).squaredNorm()) {
                std::reverse(fibre.points.begin(), fibre.points.end()), std::reverse(fibre.radii.begin(), fibre.radii.end());
            }
            fibres.push_back(std::move(fibre));
        }
        std::vector<std::vector<double>> arcs;
        double mean_length = 0.0, thinnest = std::numeric_limits<double>::infinity();
        for (const FileCurve& fibre : fibres) {
            arcs.push_back(detail::arcs_of(fibre));
            mean_length += arcs.back().back() / static_cast<double>(fibres.size());
            thinnest = std::min(thinnest, fibre.radii.empty() ? fibre.radius : fibre.radii.front());
        }
        const double step = spacing > 0.0 ? spacing : 2.0 * thinnest;
        const Index pieces = std::max(least_stations, static_cast<Index>(std::ceil(mean_length / step)));
        std::vector<Vec3> middle;
        std::vector<double> share;
        for (Index m = 0; m < pieces + (yarn.closed ? 0 : 1); ++m) {
            share.push_back(static_cast<double>(m) / static_cast<double>(pieces));
            Vec3 sum = Vec3::Zero();
            for (std::size_t f = 0; f < fibres.size(); ++f) {
                const double s = share.back() * arcs[f].back();
                const std::size_t k = detail::segment_at(arcs[f], s) + 1;
                const Vec3 &p = fibres[f].points[k - 1], &q = fibres[f].points[k % fibres[f].points.size()];
                sum += p + (s - arcs[f][k - 1]) / (arcs[f][k] - arcs[f][k - 1]) * (q - p);
            }
            middle.push_back(sum / static_cast<double>(fibres.size()));
        }
        const LineFrames frames = frames_of(middle, yarn.closed);
        for (std::size_t m = 0; m < middle.size(); ++m) {
            if (m > 0) yarn.length += (middle[m] - middle[m - 1]).norm();
            YarnStation station{yarn.length, middle[m], frames.tangent[m], frames.first[m], frames.second[m]};
            std::vector<observe::SectionEllipse> ellipses;
            for (std::size_t f = 0; f < fibres.size(); ++f) {
                const FileCurve& fibre = fibres[f];
                const std::size_t near = detail::segment_at(arcs[f], share[m] * arcs[f].back());
                const auto [at, along] = detail::crossing_of(fibre, static_cast<Index>(near), station.place, station.tangent);
                const auto flat = [&](const Vec3& v) { return observe::Vec2(v.dot(station.first), v.dot(station.second)); };
                const double radius = fibre.radii.empty() ? fibre.radius : fibre.radii[near];
                // A circle across a slanted line is longer where the line leans; no fibre of a yarn goes nearly across it.
                constexpr double least_cosine = 0.2;
                const double cosine = std::max(least_cosine, std::abs(along.dot(station.tangent)));
                const observe::Vec2 lean = flat(along);
                const observe::Vec2 e =
                    lean.norm() > 1e-12 ? observe::Vec2(lean.normalized()) : observe::Vec2(observe::Vec2::UnitX());
                ellipses.push_back({flat(at - station.place), radius / cosine * e, radius * observe::Vec2(-e.y(), e.x())});
            }
            station.section = observe::section_of(std::move(ellipses), 64);
            yarn.stations.push_back(std::move(station));
        }
        if (yarn.closed) yarn.length += (middle.front() - middle.back()).norm();
    }
    return yarns;
}

/// Turns of a yarn's fibres about its mean line over its length, > 0 right-handed [1 / length]: from section to section the
/// rotation that fits all fibres best. Right where they turn by less than half a turn from one section to the next; 0 of a single
/// fibre.
inline double turns_of(const FileYarn& yarn) {
    if (yarn.curves.size() < 2) return 0.0;
    double turn = 0.0;
    const std::size_t n = yarn.stations.size();
    const auto middle = [](const observe::YarnSection& section) {
        observe::Vec2 sum = observe::Vec2::Zero();
        for (const observe::SectionEllipse& fibre : section.fibres)
            sum += fibre.centre / static_cast<double>(section.fibres.size());
        return sum;
    };
    for (std::size_t k = 0; k + (yarn.closed ? 0 : 1) < n; ++k) {
        const observe::YarnSection &one = yarn.stations[k].section, &two = yarn.stations[(k + 1) % n].section;
        const observe::Vec2 a = middle(one), b = middle(two);
        double cosine = 0.0, sine = 0.0;
        for (std::size_t f = 0; f < one.fibres.size(); ++f) {
            const observe::Vec2 p = one.fibres[f].centre - a, q = two.fibres[f].centre - b;
            cosine += p.dot(q), sine += p.x() * q.y() - p.y() * q.x();
        }
        turn += std::atan2(sine, cosine);
    }
    return turn / (2.0 * std::numbers::pi * yarn.length);
}

/// A closed outline of a section: so many points at equal steps round its hull from where `first` leaves it, and of its area.
/// @param points  >= 3
inline std::vector<observe::Vec2> outline_of(const observe::YarnSection& section, Index points) {
    core::require_at_least("outline_of.points", points, 3);
    const std::vector<observe::Vec2>& hull = section.hull;
    const std::size_t n = hull.size();
    const auto cross = [](const observe::Vec2& a, const observe::Vec2& b) { return a.x() * b.y() - a.y() * b.x(); };
    std::size_t start = 0;
    double within = 0.0;
    for (std::size_t k = 0; k < n; ++k) {
        const observe::Vec2 a = hull[k] - section.centroid, b = hull[(k + 1) % n] - section.centroid;
        if (a.y() <= 0.0 && b.y() > 0.0) start = k, within = -a.y() / (b.y() - a.y());
    }
    std::vector<observe::Vec2> line{hull[start] + within * (hull[(start + 1) % n] - hull[start])};
    for (std::size_t k = 1; k <= n; ++k) line.push_back(hull[(start + k) % n]);
    line.push_back(line.front());
    double round = 0.0;
    for (std::size_t k = 1; k < line.size(); ++k) round += (line[k] - line[k - 1]).norm();
    std::vector<observe::Vec2> outline;
    double passed = 0.0;
    std::size_t k = 1;
    for (Index m = 0; m < points; ++m) {
        const double at = round * static_cast<double>(m) / static_cast<double>(points);
        while (k + 1 < line.size() && passed + (line[k] - line[k - 1]).norm() < at) passed += (line[k] - line[k - 1]).norm(), ++k;
        const double size = (line[k] - line[k - 1]).norm();
        outline.push_back(line[k - 1] + (size > 0.0 ? (at - passed) / size : 0.0) * (line[k] - line[k - 1]));
    }
    double area = 0.0;
    for (std::size_t m = 0; m < outline.size(); ++m)
        area += 0.5 * cross(outline[m] - section.centroid, outline[(m + 1) % outline.size()] - section.centroid);
    for (observe::Vec2& point : outline) point = section.centroid + std::sqrt(section.area / area) * (point - section.centroid);
    return outline;
}

/// Adds a yarn as one closed surface, the hull of its fibres' surfaces at each of its sections. Where a section is not convex the
/// surface holds more than the yarn, and may reach into its neighbours.
inline void add_yarn(Surface& surface, const FileYarn& yarn, Index sides = 48) {
    std::vector<std::vector<Vec3>> rings;
    for (const YarnStation& station : yarn.stations) {
        rings.emplace_back();
        for (const observe::Vec2& point : outline_of(station.section, sides)) rings.back().push_back(station.at(point));
    }
    const YarnStation &from = yarn.stations.front(), &to = yarn.stations.back();
    add_loft(surface, rings, yarn.closed, {from.at(from.section.centroid), to.at(to.section.centroid)});
}

/// Yarns as STL, and as VTK's PolyData (.vtp) with the number of the yarn in each triangle.
inline std::string stl_of(const std::vector<FileYarn>& yarns) {
    Surface surface;
    for (const FileYarn& yarn : yarns) add_yarn(surface, yarn);
    return stl_of(surface);
}
inline std::string vtp_of(const std::vector<FileYarn>& yarns) {
    observe::PolyData data;
    std::vector<double> numbers;
    for (std::size_t y = 0; y < yarns.size(); ++y) {
        Surface surface;
        add_yarn(surface, yarns[y]);
        Index first = 0;
        for (std::size_t k = 0; k < surface.points.size(); ++k) {
            const Index at = data.add_point(surface.points[k]);
            if (k == 0) first = at;
        }
        for (const auto& t : surface.triangles) {
            data.add_triangle(first + t[0], first + t[1], first + t[2]);
            numbers.push_back(static_cast<double>(yarns[y].group >= 0 ? yarns[y].group : static_cast<Index>(y)));
        }
    }
    data.cell_scalars("yarn", numbers);
    return data.text();
}

/// Sections of yarns as a table.
inline std::string csv_of(const std::vector<FileYarn>& yarns) {
    std::string text = "yarn,station,along,x,y,z,area,width,thickness,tilt_deg,fibre_volume_fraction\n";
    for (std::size_t y = 0; y < yarns.size(); ++y)
        for (std::size_t k = 0; k < yarns[y].stations.size(); ++k) {
            const YarnStation& s = yarns[y].stations[k];
            const double tilt = std::asin(std::min(1.0, std::abs(s.widest().z()))) * 180.0 / std::numbers::pi;
            text += std::to_string(yarns[y].group >= 0 ? yarns[y].group : static_cast<Index>(y)) + "," + std::to_string(k);
            for (const double value : {s.along, s.place.x(), s.place.y(), s.place.z(), s.section.area, s.section.width,
                                       s.section.thickness, tilt, s.section.fibre_volume_fraction})
                text += "," + observe::shortest(value);
            text += "\n";
        }
    return text;
}

}  // namespace fibrant::exchange

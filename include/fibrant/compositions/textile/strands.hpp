// SPDX-License-Identifier: MIT
#pragma once
/// @file Plied yarns, ropes, rings of chain mail and nets.

#include <fibrant/compositions/textile/interlaced.hpp>
#include <fibrant/observe/linking.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::textile {

/// Yarns wound around each other, in one or two stages: plies of a yarn, or strands of a rope that are plied themselves.
struct Plied {
    Index plies = 3;                    ///< around each other, >= 2
    double pitch = core::unset;         ///< of the plies [length], > 0
    Index strands = 1;                  ///< of so many plies each, around each other; 1: one stage
    double strand_pitch = core::unset;  ///< of the strands, against the hand of the plies [length], > 0
    double length = core::unset;        ///< along the axis [length], > 0
    double slack = 0.05;                ///< distance of neighbours over their thickness [1], >= 0
    bool periodic = false;              ///< goes on at both ends; one stage, whole turns
    YarnType type{};                    ///< of all yarns

    void validate() const {
        core::require_at_least("Plied.plies", plies, 2);
        core::require_at_least("Plied.strands", strands, 1);
        core::require_positive("Plied.pitch", pitch);
        if (strands > 1) core::require_positive("Plied.strand_pitch", strand_pitch);
        core::require_positive("Plied.length", length);
        core::require_not_negative("Plied.slack", slack);
        if (periodic && strands > 1) core::refuse("Plied.strands", std::to_string(strands), "1, of a yarn that goes on");
        if (periodic) require_whole("Plied.length over its pitch, of a yarn that goes on", length / pitch);
        type.validate();
    }
    /// Distance of an axis from that which it goes around, of `count` cylinders of radius r that lean by their pitch: in the
    /// plane across the axis a section is an ellipse, wider around the axis by 1 / cos of the lean [length].
    double lay_radius(Index count, double r, double of_pitch) const noexcept {
        const double straight = straight_radius(count, r);
        double a = straight;
        for (int k = 0; k < 50; ++k)
            a = straight * std::hypot(1.0, 2.0 * std::numbers::pi * a / of_pitch);  // a fixed point: the lean grows with a
        return a;
    }
    /// The same of cylinders that do not lean [length].
    double straight_radius(Index count, double r) const noexcept {
        return r * (1.0 + slack) / std::sin(std::numbers::pi / static_cast<double>(count));
    }
    /// Pitch at which they lean by a tangent of 2, where the lay radius is 5^1/2 times the straight one [length].
    double least_pitch(Index count, double r) const noexcept {
        return std::numbers::pi * std::sqrt(5.0) * straight_radius(count, r);
    }
};

/// Length of a helix over that of its axis: sqrt(1 + (2 pi a / H)^2).
inline double helix_length_ratio(double radius, double pitch) noexcept {
    return std::hypot(1.0, 2.0 * std::numbers::pi * radius / pitch);
}

/// A plied yarn, or a rope of such, about the z axis.
inline Textile plied(const Plied& rope) {
    rope.validate();
    Textile textile;
    textile.name = rope.strands > 1 ? "rope" : "plied yarn";
    textile.apart_by.fill({"Plied.slack", rope.slack, 1.0});
    textile.types = {rope.type};
    const double thick = outermost(rope.type), a = rope.lay_radius(rope.plies, thick, rope.pitch);
    core::require(2.0 * std::numbers::pi * a / rope.pitch < 2.0, "Plied.pitch", rope.pitch,
                  "> " + core::text(rope.least_pitch(rope.plies, thick)) + ", or plies lie at more than 63 degrees");
    const double b = rope.strands > 1 ? rope.lay_radius(rope.strands, a + thick, rope.strand_pitch) : 0.0;
    if (rope.strands > 1)
        core::require(2.0 * std::numbers::pi * b / rope.strand_pitch < 2.0, "Plied.strand_pitch", rope.strand_pitch,
                      "> " + core::text(rope.least_pitch(rope.strands, a + thick)) + ", or strands lie at more than 63 degrees");
    constexpr double longest = 1e6;  // half widths of a yarn: more is a slip of the unit
    core::require_between("Plied.length", rope.length, 2.0 * thick, longest * thick);
    for (Index s = 0; s < rope.strands; ++s) {
        const double start = 2.0 * std::numbers::pi * static_cast<double>(s) / static_cast<double>(rope.strands);
        const scene::Curve axis = [=, length = rope.length, pitch = rope.strand_pitch](double t) {
            const double f = b > 0.0 ? -2.0 * std::numbers::pi * length * t / pitch + start : 0.0;
            return Vec3(b * std::cos(f), b * std::sin(f), length * t);
        };
        const double along = rope.length * (b > 0.0 ? helix_length_ratio(b, rope.strand_pitch) : 1.0);
        const auto samples = std::max<Index>(64, static_cast<Index>(2.0 * along / thick));
        for (Index k = 0; k < rope.plies; ++k) {
            const double angle = 2.0 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(rope.plies);
            Path path;
            path.name = "ply " + std::to_string(s) + "." + std::to_string(k), path.family = s;
            path.pull = Vec3::UnitZ();  // along its own lay an end would go round the axis, and turn the yarn
            if (rope.periodic) repeat(path, rope.length * Vec3::UnitZ());
            path.curve = scene::beside(axis, a * std::cos(angle), a * std::sin(angle), along / rope.pitch, samples, Vec3::UnitX(),
                                       rope.periodic ? scene::SplineEnds::repeating : scene::SplineEnds::parabolic);
            textile.paths.push_back(std::move(path));
        }
    }
    for (const Path& path : textile.paths)
        detail::require_bends(path, rope.type, scene::length_of(path.curve, 128), "Plied.pitch, strand_pitch: ");
    if (rope.periodic) textile.lattice = {rope.length * Vec3::UnitZ()};
    return textile;
}

/// European chain mail: rings at a quincunx, rows tilted one way and the other, each ring linked with those of the rows beside
/// it.
struct ChainMail {
    Index rows = 3, columns = 3;       ///< >= 2
    double ring_radius = core::unset;  ///< of the middle line [length]
    /// Of rings in a row [length]; unset: 2.6 ring radii. They are drawn two ring radii and a radius of the wire apart at least:
    /// they part by more in any case, and lines that touch could do so to either side.
    double pitch = core::unset;
    double row_pitch = core::unset;  ///< unset: 0.9 ring radii
    double tilt_deg = 35.0;          ///< of rings about the direction of the rows [degree], in (0, 80]
    YarnType type{};                 ///< of all yarns

    double along() const noexcept { return std::isnan(pitch) ? 2.6 * ring_radius : pitch; }
    /// Of rings in a row as they are drawn [length].
    double apart() const noexcept { return std::max(along(), 2.0 * ring_radius + type.radius); }
    double across() const noexcept { return std::isnan(row_pitch) ? 0.9 * ring_radius : row_pitch; }
    void validate() const {
        core::require_at_least("ChainMail.rows", rows, 2);
        core::require_at_least("ChainMail.columns", columns, 2);
        type.validate();
        constexpr double widest = 1e5;  // radii of the wire: more is a slip of the unit
        core::require(ring_radius > 4.0 * type.radius && ring_radius <= widest * type.radius, "ChainMail.ring_radius",
                      ring_radius, "> 4 and <= 1e5 radii of the wire, " + core::text(type.radius));
        core::require_positive("ChainMail.pitch", along());
        core::require(along() >= 2.0 * ring_radius, "ChainMail.pitch", along(),
                      ">= " + core::text(2.0 * ring_radius) +
                          ", two ring radii: rings of a row lie in one plane, and nearer ones " + "go through each other");
        core::require_positive("ChainMail.row_pitch", across());
        core::require(tilt_deg > 0.0 && tilt_deg <= 80.0, "ChainMail.tilt_deg", tilt_deg, "> 0 and <= 80");
        if (type.fibres != 1) core::refuse("YarnType.fibres", std::to_string(type.fibres), "1, of a ring of chain mail");
    }
};

namespace detail {
inline Textile drawn(const ChainMail& mail) {
    Textile textile;
    textile.name = "chain mail";
    textile.types = {mail.type};
    for (Index j = 0; j < mail.rows; ++j)
        for (Index i = 0; i < mail.columns; ++i) {
            const double tilt = (j % 2 == 0 ? 1.0 : -1.0) * mail.tilt_deg * std::numbers::pi / 180.0;
            const Vec3 centre(mail.apart() * (static_cast<double>(i) + (j % 2 == 0 ? 0.0 : 0.5)),
                              mail.across() * static_cast<double>(j), 0.0);
            const Vec3 side(0.0, std::cos(tilt), std::sin(tilt));
            Path path;
            path.name = "ring " + std::to_string(j) + "." + std::to_string(i), path.family = j % 2;
            path.kind = PathKind::closed, path.straight = false;
            path.curve = [=, a = mail.ring_radius](double t) {
                const double f = 2.0 * std::numbers::pi * t;
                return Vec3(centre + a * (std::cos(f) * Vec3::UnitX() + std::sin(f) * side));
            };
            textile.paths.push_back(std::move(path));
        }
    return textile;
}
/// Of rings that should be linked and are not, the first two; nothing where all are.
inline std::string loose_rings(const Textile& textile, const ChainMail& mail) {
    constexpr double points = 256.0;  // of a ring, to find its links
    const std::vector<Line> lines =
        lines_of(textile, std::max(0.5, 2.0 * std::numbers::pi * mail.ring_radius / (points * mail.type.radius)));
    for (Index j = 0; j + 1 < mail.rows; ++j)
        for (Index i = 0; i < mail.columns; ++i)
            for (const Index k : {i + (j % 2 == 0 ? -1 : 0), i + (j % 2 == 0 ? 0 : 1)}) {
                if (k < 0 || k >= mail.columns) continue;
                const Index one = i + mail.columns * j, two = k + mail.columns * (j + 1);
                const Index links = observe::linking_number(lines[core::at(one)].points, lines[core::at(two)].points);
                if (links * links != 1)
                    return "links of " + textile.label(one) + " with " + textile.label(two) + " = " + std::to_string(links) +
                           ", but it must be 1 or -1, or the rings come apart";
            }
    return {};
}
}  // namespace detail

/// Row j is shifted by half a pitch where j is odd, and tilted the other way: a ring inside is linked with two of each row beside
/// its own.
inline Textile chain_mail(const ChainMail& mail) {
    mail.validate();
    Textile textile = detail::drawn(mail);
    const std::string loose = detail::loose_rings(textile, mail);
    if (loose.empty()) return textile;
    ChainMail two = mail;
    two.rows = two.columns = 2;  // all are alike
    const double nearest = nearest_that_holds(mail.across(), 0.0, 2.0 * mail.ring_radius, [&](double distance) {
        two.row_pitch = distance;
        return distance > 0.0 && detail::loose_rings(detail::drawn(two), two).empty();
    });
    if (std::isnan(nearest))
        core::refuse("ChainMail.pitch", core::text(mail.along()), "less at this ring_radius, row_pitch and tilt_deg: " + loose);
    core::refuse(
        "ChainMail.row_pitch", core::text(mail.across()),
        (nearest < mail.across() ? "<= " : ">= ") + core::text(nearest) + " at this ring_radius, pitch and tilt_deg: " + loose);
}

/// A net of clasped yarns: each goes to and fro, and hooks into its neighbours at its turns, as in chain link fences and sprang.
struct Net {
    Index yarns = 4;                   ///< >= 2
    double spacing = core::unset;      ///< of yarns [length], > 0
    double period = core::unset;       ///< of a yarn [length], > 0
    double periods = 2.0;              ///< >= 0.5
    double overlap = 0.0;              ///< by which a yarn reaches beyond its neighbour's turns [length]; 0: four half widths
    YarnType type{};                   ///< of all yarns
    double height_over_radius = 1.05;  ///< of yarns at crossings out of the middle plane [1], > 0; of several fibres >= 1.05

    void validate() const {
        core::require_at_least("Net.yarns", yarns, 2);
        core::require_positive("Net.spacing", spacing);
        core::require_positive("Net.period", period);
        core::require(std::isfinite(periods) && periods >= 0.5, "Net.periods", periods, ">= 0.5, which is one turn");
        core::require_not_negative("Net.overlap", overlap);
        type.validate();
        core::require_positive("Net.height_over_radius", height_over_radius);
        require_height("Net.height_over_radius", height_over_radius, type);
        // At a turn a yarn reaches half of the overlap beyond its neighbour's line, and so does the next but two.
        const double w = half_room(type), least = yarns > 3 ? 0.5 * reach() + w : w;
        core::require(spacing >= least, "Net.spacing", spacing,
                      ">= " + core::text(least) + ", for yarns to meet none but their neighbours");
    }
    /// By which a yarn reaches beyond its neighbour's turns [length].
    double reach() const { return overlap > 0.0 ? overlap : 4.0 * half_width(type); }
};

namespace detail {
inline Textile drawn(const Net& given) {
    Textile textile;
    textile.name = "net";
    textile.apart_by.fill({"Net.spacing", given.spacing});
    textile.types = {given.type};
    const double overlap = given.reach(), length = given.period * given.periods;
    for (Index k = 0; k < given.yarns; ++k) {
        Path path;
        path.name = "yarn " + std::to_string(k), path.family = k % 2;
        path.pull = Vec3::UnitY();  // along their own slants ends of neighbours would go across each other
        const double x0 = given.spacing * static_cast<double>(k), a = 0.5 * (given.spacing + overlap);
        // Half a period beside a turn: no end stands on a crossing.
        path.curve = [=, period = given.period, phase = std::numbers::pi * static_cast<double>(k)](double t) {
            const double y = length * t;
            return Vec3(x0 + a * std::cos(2.0 * std::numbers::pi * (y / period + 0.25) + phase), y, 0.0);
        };
        textile.paths.push_back(std::move(path));
    }
    // Turning points lie at whole halves of a period less a quarter; before one the left yarn is above, behind it the right one.
    interlace(
        textile,
        [&](const PlanCrossing& crossing) {
            const double half = 0.5 * given.period,
                         turn = std::round((crossing.place.y() + 0.5 * half) / half) * half - 0.5 * half;
            const bool left_above = crossing.place.y() < turn;
            return one_above((crossing.first < crossing.second) == left_above);
        },
        given.height_over_radius * half_thickness(given.type));
    return textile;
}
}  // namespace detail

/// Yarn k lies at x = k p + (p + o) / 2 cos(2 pi y / P + pi k): neighbours cross twice at each of their turns, first the one
/// above, then the other.
/// @throws std::invalid_argument naming Net.periods where two neighbours have no turn in common
inline Textile net(const Net& given) {
    const double turn = half_width(given.type) / 0.95,
                 a = 0.5 * (given.spacing + given.reach());  // radius at a turn: P^2 / 4 pi^2 a
    Textile textile = laid(given, &Net::period, "Net.period", 2.0 * std::numbers::pi * std::sqrt(a * turn),
                           {{"spacing", given.spacing}, {"overlap", given.overlap}}, given.type,
                           [](const Net& one) { return detail::drawn(one); });
    std::vector<Index> crossings(core::at(given.yarns), 0);  // of each yarn with the next one
    for (const Crossing& crossing : textile.crossings) ++crossings[core::at(std::min(crossing.above, crossing.below))];
    for (Index k = 0; k + 1 < given.yarns; ++k)
        if (crossings[core::at(k)] < 2)
            core::refuse("Net.periods", core::text(given.periods),
                         ">= 1, for " + textile.label(k) + " and " + textile.label(k + 1) + " to hook into each other");
    return textile;
}

}  // namespace fibrant::compositions::textile

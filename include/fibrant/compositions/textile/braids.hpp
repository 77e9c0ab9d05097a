// SPDX-License-Identifier: MIT
#pragma once
/// @file Flat and tubular braids.

#include <fibrant/compositions/textile/interlaced.hpp>
#include <fibrant/compositions/textile/yarn_fibres.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

namespace fibrant::compositions::textile {

/// A flat braid: yarns that go to and fro between two edges.
struct FlatBraid {
    Index yarns = 3;                  ///< >= 3
    double half_width = core::unset;  ///< from the middle to an edge [length], > 0
    double period = core::unset;      ///< of a yarn, to and fro [length], > 0
    double periods = 2.0;             ///< in all [1], > 0
    Index over = 1;                   ///< yarns in turn that one passes above, then below: 1 or 2
    /// Of ends along the braid, beyond the outermost crossings [length]; 0: a yarn's way from crossing to crossing and two
    /// diameters, so that no crossing slides off when the braid is pulled tight.
    double overhang = 0.0;
    bool periodic = false;  ///< goes on at both ends; whole periods
    YarnType type{};        ///< of all yarns
    /// Of a yarn at a crossing out of the middle plane [1], > 0; of several fibres >= 1.05; unset: 1.05, and of several fibres
    /// that would start more than a radius in those of other yarns as much more, up to 1.65, as they need.
    double height_over_radius = core::unset;

    double height() const noexcept { return height_or_apart(height_over_radius); }
    void validate() const {
        core::require_at_least("FlatBraid.yarns", yarns, 3);
        core::require_positive("FlatBraid.half_width", half_width);
        core::require_positive("FlatBraid.period", period);
        core::require_positive("FlatBraid.periods", periods);
        core::require_not_negative("FlatBraid.overhang", overhang);
        if (periodic && overhang > 0.0) core::refuse("FlatBraid.overhang", core::text(overhang), "0, of a braid that goes on");
        if (periodic) require_whole("FlatBraid.periods, of a braid that goes on", periods);
        if (over != 1 && over != 2) core::refuse("FlatBraid.over", std::to_string(over), "1 or 2");
        type.validate();
        core::require_positive("FlatBraid.height_over_radius", height());
        require_height("FlatBraid.height_over_radius", height(), type);
        const double least = static_cast<double>(yarns) * half_room(type);
        core::require(half_width >= least, "FlatBraid.half_width", half_width,
                      ">= " + core::text(least) + ", that of the yarns side by side");
    }
};

namespace detail {
/// A triangle wave of period 1 in [-1, 1], 1 at 0, whose tips are parabolas over a part of the period on each side.
inline double rounded_wave(double x, double tip) noexcept {
    const double p = x - std::floor(x), d = std::min(p, 1.0 - p);  // from the upper tip
    const double straight = 1.0 - 4.0 * d;
    if (d < tip) return 1.0 - 2.0 * tip - 2.0 * d * d / tip;
    if (0.5 - d < tip) return -1.0 + 2.0 * tip + 2.0 * (0.5 - d) * (0.5 - d) / tip;
    return straight;
}
/// How a braid goes along its axis. One that does not go on has ends: half a row beside the outermost crossings yarns leave their
/// way, turn along the braid in arcs of a circle, and lie side by side in grips. What crosses a yarn has to pass the grips to
/// slide off it.
struct BraidLength {
    double length = 0.0;    ///< of the braid without its ends, whole rows of crossings [length]
    double slope = 0.0;     ///< of a yarn, across over along the braid [1], > 0
    double aside = 0.0;     ///< along the braid, within its length, where arcs begin [length]
    double radius = 0.0;    ///< of the arcs [length]
    double turn = 0.0;      ///< length of an arc along the braid [length]
    double overhang = 0.0;  ///< of an end beyond `length` [length]; 0: it goes on

    /// @param braid       whose fields are named
    /// @param field       of it that the length follows from
    /// @param count       of rows, rounded to whole ones: those whose crossings lie within the length asked for
    /// @param row         length of the braid from crossings to the next ones [length], > 0
    /// @param overhang    of ends [length]; 0: a yarn's way from crossing to crossing and two diameters
    BraidLength(const std::string& braid, const std::string& field, double count, double row, double slope_, bool goes_on,
                double overhang_, double half_width)
        : length{row * std::round(count)}, slope{slope_} {
        core::require(count >= 0.5, braid + "." + field + ": rows of crossings", count, ">= 0.5, which is one row");
        if (goes_on) return;
        const double over = std::hypot(1.0, slope);
        aside = 0.4 * row, radius = aside * over * (over + 1.0) / slope, turn = aside * (over + 1.0);
        overhang = overhang_ > 0.0 ? overhang_ : row * over + 4.0 * half_width;
        // In less a yarn does not come to lie along the braid over two diameters: nothing would be gripped, and crossings slide
        // off.
        const double least = turn - aside + 4.0 * half_width;
        core::require(overhang >= least, braid + ".overhang", overhang,
                      "0, or >= " + core::text(least) + ", for yarns to turn along the braid and two diameters");
    }
    /// Puts the straight parts of all ends into grips.
    void grip(Textile& textile) const {
        for (Path& path : textile.paths)
            if (path.kind == PathKind::open)
                path.grip = std::max(0.0, overhang - turn + aside) / scene::length_of(path.curve, 1024);
    }
    /// Place along the braid, and how far a yarn is on its way there [length], at a part of the whole.
    std::array<double, 2> operator()(double part) const noexcept {
        const double y = (length + 2.0 * overhang) * part - overhang;
        const auto beyond = [this](double d) {
            const double left = std::max(0.0, turn - d);           // of the arc
            const double level = radius / std::hypot(1.0, slope);  // of the arc's start, from its middle
            return (turn - left) * (turn + left) / (std::sqrt(radius * radius - left * left) + level) / slope;
        };
        if (!(overhang > 0.0) || (y >= aside && y <= length - aside)) return {y, y};
        return {y, y < aside ? aside - beyond(aside - y) : length - aside + beyond(y - length + aside)};
    }
};
}  // namespace detail

namespace detail {
/// @param level  yarns of several fibres lie level beside their crossings
inline Textile drawn(const FlatBraid& braid, bool level) {
    Textile textile;
    textile.name = "flat braid";
    textile.apart_by.fill({"FlatBraid.half_width", braid.half_width});
    textile.types = {braid.type};
    const double n = static_cast<double>(braid.yarns);
    const double tip = 0.4 / n;  // within the outermost meetings, which are half of 1 / N from a tip
    // No end stands on a crossing: meetings are at whole multiples of 1 / (2 N) of a period.
    const double shift = 0.25 / n;
    const BraidLength along("FlatBraid", "periods", 2.0 * n * braid.periods, 0.5 * braid.period / n,
                            4.0 * braid.half_width / braid.period, braid.periodic, braid.overhang, half_width(braid.type));
    for (Index k = 0; k < braid.yarns; ++k) {
        Path path;
        path.name = "strand " + std::to_string(k);
        path.family = k;
        if (braid.periodic) repeat(path, along.length * Vec3::UnitY());
        path.curve = [=, a = braid.half_width, period = braid.period, phase = static_cast<double>(k) / n](double t) {
            const auto [y, way] = along(t);
            return Vec3(a * rounded_wave(way / period + phase + shift, tip), y, 0.0);
        };
        textile.paths.push_back(std::move(path));
    }
    if (braid.periodic) textile.lattice = {along.length * Vec3::UnitY()};
    interlace(
        textile,
        [&](const PlanCrossing& crossing) {
            const auto column = static_cast<Index>(std::lround(0.5 * n * (crossing.place.x() / braid.half_width + 1.0)));
            const bool right_above = (column / braid.over) % 2 == 0;
            return one_above((crossing.along_first.x() > 0.0) == right_above);
        },
        braid.height() * half_thickness(braid.type), level);
    along.grip(textile);
    return textile;
}

/// How a braid is drawn, of a piece that is like all others.
struct BraidStart {
    double height = apart_height;                            ///< over half the thickness of a yarn [1]
    bool level = false;                                      ///< yarns lie level beside their crossings
    double depth = std::numeric_limits<double>::infinity();  ///< as of deepest_start(); infinity: it cannot be drawn
};

/// How deep fibres of different yarns may start in each other [radii of a fibre]: as long as it is less than a radius they part
/// to the sides that they are drawn on.
inline constexpr double deepest_of_braids = 1.0;

/// The height that is given, where fibres of different yarns do not start too deep in each other. Else level, and at the lowest
/// height at which they start beside each other, or that where they start least deep in each other. Not all braids are drawn so:
/// yarns are longer then, and slack, and take more increments to settle.
/// @param sample  a piece of a braid
/// @param draw    draws it, level or not
template <class Braid>
BraidStart start_of(Braid sample, Textile (*draw)(const Braid&, bool)) {
    constexpr double beside = 0.01, step = 0.15, highest = 1.66;  // radii of a fibre; half thicknesses
    const bool given = !std::isnan(sample.height_over_radius);
    const double lowest = sample.height();
    BraidStart best{lowest};
    const auto better = [&](double height, bool level) {
        sample.height_over_radius = height;
        const Textile textile = draw(sample, level);
        require_bends(textile);
        const double depth = deepest_start(textile);
        if (depth < best.depth - beside) best = {height, level, depth};
    };
    try {
        better(lowest, false);
        if (best.depth <= deepest_of_braids) return best;
        for (double height = lowest; best.depth > beside && (height == lowest || (!given && height < highest)); height += step)
            better(height, true);
    } catch (const std::invalid_argument&) {  // cannot be drawn that high; the whole says why
    }
    return best;
}

/// A braid of several fibres, as high as its fibres need.
/// @param given   of which `lay` makes the textile
/// @param sample  a piece of it
template <class Braid>
Textile braid_apart(Braid given, Braid sample, Textile (*draw)(const Braid&, bool), Textile (*lay)(const Braid&, bool)) {
    if (given.type.fibres == 1) return lay(given, false);
    sample.periodic = false, sample.overhang = 0.0;
    const BraidStart start = start_of(sample, draw);
    given.height_over_radius = start.height;
    return lay(given, start.level);
}
}  // namespace detail

/// Yarn k lies at x = A tri(y / P + k / N): meetings are at x_m = A (2 m / N - 1), m from 1 to N - 1, in a quincunx. The yarn
/// that goes to the right is above where the whole part of m over `over` is even, so that each yarn alternates, across its turns
/// as well. N (N - 1) crossings a period. Ends lie along the braid, side by side where yarns are half way between crossings.
inline Textile flat_braid(const FlatBraid& given) {
    given.validate();
    FlatBraid sample = given;
    sample.periods = std::min(given.periods, 1.0);
    return detail::braid_apart(
        given, sample, &detail::drawn, +[](const FlatBraid& braid, bool level) {
            // Across neighbours of one direction, 4 A / N over the length of a slope of 4 A / P, is a diameter; tips are as wide
            // as yarns.
            const double a = braid.half_width, n = static_cast<double>(braid.yarns), w = half_room(braid.type),
                         k = 2.0 * a / (n * w);
            const double beside = k > 1.0 ? 4.0 * a / std::sqrt(k * k - 1.0) : 0.0, tips = std::sqrt(10.0 * a * n * w / 0.95);
            return laid(braid, &FlatBraid::period, "FlatBraid.period", std::max(beside, tips),
                        {{"half_width", a}, {"overhang", braid.overhang}}, braid.type,
                        [=](const FlatBraid& one) { return detail::drawn(one, level); });
        });
}

/// A tubular braid: as many carriers one way round as the other, and straight axial yarns if wanted.
struct TubularBraid {
    Index carriers = 8;           ///< each way, >= 2
    double radius = core::unset;  ///< of the middle surface [length], > 0
    double pitch = core::unset;   ///< length of a full turn along the axis [length], > 0
    double turns = 0.5;           ///< > 0
    Index over = 1;               ///< 1: 1x1; 2: 2x2; divides the carriers
    bool axials = false;          ///< an axial yarn at every other line of meetings, with 1x1 only
    double overhang = 0.0;        ///< of ends along the tube, beyond the turns [length]; 0: as of FlatBraid
    bool periodic = false;        ///< goes on at both ends; whole turns
    YarnType type{};              ///< of all yarns
    /// Of a yarn at a crossing out of the middle of the tube [1], > 0; of several fibres >= 1.05; unset: as of FlatBraid.
    double height_over_radius = core::unset;

    double height() const noexcept { return height_or_apart(height_over_radius); }
    void validate() const {
        core::require_at_least("TubularBraid.carriers", carriers, 2);
        core::require_positive("TubularBraid.radius", radius);
        core::require_positive("TubularBraid.pitch", pitch);
        core::require_positive("TubularBraid.turns", turns);
        core::require_not_negative("TubularBraid.overhang", overhang);
        if (periodic && overhang > 0.0) core::refuse("TubularBraid.overhang", core::text(overhang), "0, of a braid that goes on");
        if (periodic) require_whole("TubularBraid.turns, of a braid that goes on", turns);
        core::require_at_least("TubularBraid.over", over, 1);
        if (carriers % over != 0)
            core::refuse("TubularBraid.over", std::to_string(over), "a divisor of the carriers, " + std::to_string(carriers));
        if (axials && over != 1) core::refuse("TubularBraid.over", std::to_string(over), "1 with axial yarns");
        type.validate();
        core::require_positive("TubularBraid.height_over_radius", height());
        require_height("TubularBraid.height_over_radius", height(), type);
        const double least = static_cast<double>(carriers) * half_room(type) / std::numbers::pi;
        core::require(radius > least, "TubularBraid.radius", radius,
                      "> " + core::text(least) + ", that of the carriers side by side around the tube");
    }
    /// Angle of the carriers to the axis: tan alpha = 2 pi R / H [radian].
    double angle() const noexcept { return std::atan(2.0 * std::numbers::pi * radius / pitch); }
    /// Distance of neighbours of one direction, across them [length].
    double spacing() const noexcept {
        return 2.0 * std::numbers::pi * radius * std::cos(angle()) / static_cast<double>(carriers);
    }
};

namespace detail {
/// @param level  as of a flat braid
inline Textile drawn(const TubularBraid& braid, bool level) {
    Textile textile;
    textile.name = "tubular braid";
    textile.apart_by.fill({"TubularBraid.radius", braid.radius});
    textile.types = {braid.type};
    textile.view = {Vec3::UnitZ(), true, Vec3::Zero()};
    const double n = static_cast<double>(braid.carriers), full = 2.0 * std::numbers::pi;
    const double first = std::numbers::pi / (2.0 * n);  // of f: no end stands on a meeting
    const BraidLength along("TubularBraid", "turns", 2.0 * n * braid.turns, 0.5 * braid.pitch / n, std::tan(braid.angle()),
                            braid.periodic, braid.overhang, half_width(braid.type));
    const auto add = [&](const std::string& name, Index family, double start, double way) {
        Path path;
        path.name = name, path.family = family, path.pull = Vec3::UnitZ();
        if (braid.periodic) repeat(path, along.length * Vec3::UnitZ());
        path.curve = [=, radius = braid.radius, pitch = braid.pitch](double t) {
            const auto [z, wound] = along(t);
            const double angle = start + way * (first + full * wound / pitch);
            return Vec3(radius * std::cos(angle), radius * std::sin(angle), z + first / full * pitch);
        };
        textile.paths.push_back(std::move(path));
    };
    for (const int way : {1, -1})
        for (Index k = 0; k < braid.carriers; ++k)
            add((way > 0 ? "right " : "left ") + std::to_string(k), way > 0 ? 0 : 1, full * static_cast<double>(k) / n, way);
    if (braid.axials)
        for (Index k = 0; k < braid.carriers; ++k)
            add("axial " + std::to_string(k), 2, std::numbers::pi * (2.0 * static_cast<double>(k) + 1.0) / n, 0.0);
    if (braid.periodic) textile.lattice = {along.length * Vec3::UnitZ()};
    const Index n2 = 2 * braid.over;
    interlace(
        textile,
        [&, n2](const PlanCrossing& crossing) -> std::array<double, 2> {
            const bool axial = crossing.second >= 2 * braid.carriers;
            const double angle = std::atan2(crossing.place.y(), crossing.place.x());
            if (axial) {  // 1x1: at these angles sums of numbers are odd, and what goes right is inside
                const bool right = crossing.first < braid.carriers;
                return {right ? -2.0 : 2.0, 0.0};
            }
            // Where three meet, the two carriers leave room for the axial one between them.
            const auto sum = static_cast<Index>(std::lround(n * angle / std::numbers::pi));
            const Index rest = ((sum % n2) + n2) % n2;
            const double high = braid.axials && rest == 1 ? 2.0 : 1.0;
            return rest < braid.over ? std::array{high, -high} : std::array{-high, high};
        },
        braid.height() * half_thickness(braid.type), level);
    along.grip(textile);
    return textile;
}
}  // namespace detail

/// With f = 2 pi z / H carriers lie at angles f + 2 pi i / n and -f + 2 pi j / n. They meet where n f = pi (j' - i), j' = j + n
/// m, at the angle pi (i + j') / n, and there the first is outside where (i + j') mod 2 p < p, in a p x p braid. 2 n^2 crossings
/// a turn. An axial yarn stands at the angles pi (2 k + 1) / n, between the two that meet there.
inline Textile tubular_braid(const TubularBraid& given) {
    given.validate();
    TubularBraid sample = given;
    sample.turns = std::min(given.turns, 2.0 * static_cast<double>(given.over) / static_cast<double>(given.carriers));
    return detail::braid_apart(
        given, sample, &detail::drawn, +[](const TubularBraid& braid, bool level) {
            // The spacing of carriers of one way is a diameter.
            const double round = 2.0 * std::numbers::pi * braid.radius,
                         k = round / (2.0 * half_room(braid.type) * static_cast<double>(braid.carriers));
            return laid(braid, &TubularBraid::pitch, "TubularBraid.pitch", k > 1.0 ? round / std::sqrt(k * k - 1.0) : 0.0,
                        {{"radius", braid.radius}, {"overhang", braid.overhang}}, braid.type,
                        [=](const TubularBraid& one) { return detail::drawn(one, level); });
        });
}

}  // namespace fibrant::compositions::textile

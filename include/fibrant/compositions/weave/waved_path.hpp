// SPDX-License-Identifier: MIT
#pragma once
/// @file Tows that begin over and under each other, as their pattern says, and as long as their fibres are.

#include <fibrant/compositions/weave/fabric_parameters.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::weave {

/// Of the overhang: where a tow has come to the height of its end. What is left is for what ends draw in.
inline constexpr double reach_of_ends = 0.75;

/// The way of a tow: half waves between crossings on different sides, level between those on the same one and beyond `reach` of
/// the outermost ones. Between these the tow is broader than at its ends, and less thick.
struct TowWave {
    std::vector<double> places, heights;  ///< along the tow, rising, and the height of its middle at each [length]
    std::array<double, 2> ends{};         ///< that before the first and behind the last one [length]
    double reach = 0.0;                   ///< in which the tow comes from its end to what it is at a crossing [length], > 0
    double broader = 1.0, thinner = 1.0;  ///< factors on what fibres are beside its middle and above it [1]

    /// Of a fibre: where it is across the tow and above the plane, and the slopes of both.
    struct Place {
        double across, height, across_slope, height_slope;
    };
    /// @param offset  of the fibre at the ends of the tow, across it and upwards [length]
    Place at(double x, const Eigen::Vector2d& offset) const {
        const auto [rise, blend] = along(x);
        return {offset.x() * (1.0 + (broader - 1.0) * blend[0]), offset.y() * (1.0 + (thinner - 1.0) * blend[0]) + rise[0],
                offset.x() * (broader - 1.0) * blend[1], offset.y() * (thinner - 1.0) * blend[1] + rise[1]};
    }

private:
    using Valued = std::array<double, 2>;  // a value and its slope
    /// Height of the middle, and what there is of the tow within its crossings: 1 there, 0 at its ends.
    std::array<Valued, 2> along(double x) const {
        const double first = places.front(), last = places.back();
        if (x <= first)
            return {half_wave(x, first - reach, first, ends[0], heights.front()), half_wave(x, first - reach, first, 0, 1)};
        if (x >= last) return {half_wave(x, last, last + reach, heights.back(), ends[1]), half_wave(x, last, last + reach, 1, 0)};
        const auto k = static_cast<std::size_t>(std::upper_bound(places.begin(), places.end(), x) - places.begin());
        return {half_wave(x, places[k - 1], places[k], heights[k - 1], heights[k]), Valued{1.0, 0.0}};
    }
    static Valued half_wave(double x, double from, double to, double low, double high) {
        const double part = std::clamp((x - from) / (to - from), 0.0, 1.0), angle = std::numbers::pi * part;
        return {low + 0.5 * (high - low) * (1.0 - std::cos(angle)),
                0.5 * (high - low) * std::numbers::pi / (to - from) * std::sin(angle)};
    }
};

/// A fibre of a waved tow by its arc length, half of which lies to either side of the tow's middle.
class WavedPath {
public:
    /// @param offset  of the fibre, as `TowWave::at` has it [length]
    /// @param length  of the fibre [length], > 0
    WavedPath(TowWave wave, const Eigen::Vector2d& offset, double length)
        : wave_{std::move(wave)}, offset_{offset}, length_{length} {
        step_ = 0.5 * length / static_cast<double>(steps);
        for (const double side : {-1.0, 1.0}) {
            std::array<double, steps / kept + 1>& way = side < 0.0 ? before_ : behind_;
            double here = way[0] = 0.0;
            for (std::size_t k = 1; k <= steps; ++k) {
                here = next(here, side);
                if (k % kept == 0) way[k / kept] = here;
            }
        }
    }
    /// Where the ends are along the tow [length].
    std::array<double, 2> ends() const { return {before_.back(), behind_.back()}; }
    /// @param part  of the length, in [0, 1]
    /// @returns the way along the tow, across it and upwards [length]
    Vec3 at(double part) const {
        const double arc = (part - 0.5) * length_;
        const double at = std::abs(arc) / step_, sign = arc < 0.0 ? -1.0 : 1.0;
        const auto k = std::min(static_cast<std::size_t>(at), steps - 1);
        double a = (arc < 0.0 ? before_ : behind_)[k / kept];
        for (std::size_t step = k / kept * kept; step < k; ++step) a = next(a, sign);
        // Cubic by both slopes (Hermite).
        const double u = at - static_cast<double>(k), b = next(a, sign), da = sign * step_ * along(a),
                     db = sign * step_ * along(b);
        const double x = a + u * (da + u * (3.0 * (b - a) - 2.0 * da - db + u * (2.0 * (a - b) + da + db)));
        const TowWave::Place place = wave_.at(x, offset_);
        return {x, place.across, place.height};
    }

private:
    double along(double x) const {
        const TowWave::Place place = wave_.at(x, offset_);
        return 1.0 / std::sqrt(1.0 + place.across_slope * place.across_slope + place.height_slope * place.height_slope);
    }
    /// Where the next step of an arc ends along the tow, summed by the rule of the middle: errors fall with the square of the
    /// step.
    double next(double x, double side) const {
        const double half = x + 0.5 * side * step_ * along(x);
        return x + side * step_ * along(half);
    }
    /// To either side, and of how many the end of one is kept: a scene has a path for each of its fibres.
    static constexpr std::size_t steps = 1024, kept = 4;
    TowWave wave_;
    Eigen::Vector2d offset_;
    double length_, step_ = 0.0;
    std::array<double, steps / kept + 1> before_, behind_;
};

/// Distance of the middles of two tows where they cross: their mean thickness [length].
inline double tows_apart(const FabricParameters& fabric) {
    return 0.5 * (fabric.warp.packing().thickness + fabric.weft.packing().thickness);
}

/// How high the ends of a tow are held: in the plane where the overhang leaves room to come back to it, the nearer to their
/// height at the last crossing, half of the mean thickness, the less it does. Ends that are all held in the plane beside a
/// crossing lie in each other whatever fibres do: at a corner, two that cross d before their ends have these sqrt(2) d apart.
/// @returns z of the first end and of the last one [length]
inline std::array<double, 2> end_heights(const FabricParameters& fabric, Family family, Index tow) {
    const double steepest = 0.5;  // at which a fibre comes down from a crossing to the plane [1], by trial
    const bool warp = family == Family::warp;
    const Family across = warp ? Family::weft : Family::warp;
    const double high = 0.5 * tows_apart(fabric);
    const double free = fabric.overhang - 0.5 * fabric.tow(across).packing().width;
    const double height = std::max(0.0, high - steepest * free);
    const auto side = [&](Index crossed) {
        const bool warp_above = warp ? fabric.pattern.over(tow, crossed) : fabric.pattern.over(crossed, tow);
        return warp_above == warp ? height : -height;
    };
    return {side(0), side(fabric.tows(across) - 1)};
}

/// What a tow is spread by where it is pressed on by others, over its width when it is flat: rows of fibres that touch each other
/// come to lie between each other by it. Tows of 76 fibres come to rest 1.2 to 1.35 times as broad, by measurement on the settled
/// weave of the examples; none comes nearer to its neighbour than a twentieth of the spacing.
inline double spread_of(const FabricParameters& fabric, Family family) {
    const double spread = 1.2, room = 0.95;
    const double spacing = family == Family::warp ? fabric.warp_spacing : fabric.weft_spacing;
    return std::clamp(room * spacing / fabric.tow(family).packing().width, 1.0, spread);
}
/// Distance of rows of a hexagonal packing in which neighbours of two rows touch, over that before it was spread: from
/// (spread r)^2 + h^2 = (2 r)^2.
inline double nested(double spread) noexcept { return std::sqrt((4.0 - spread * spread) / 3.0); }

/// The way of a tow over and under those that it crosses.
inline TowWave tow_wave(const FabricParameters& fabric, Family family, Index tow) {
    const bool warp = family == Family::warp;
    const Family across = warp ? Family::weft : Family::warp;
    // Tows that are pulled alike share the height as the pull and the spans of each resist it.
    const auto stiff = [&](Family one) {
        return fabric.tow(one).axial_stiffness() / (one == Family::warp ? fabric.weft_spacing : fabric.warp_spacing);
    };
    const auto thickness = [&](Family one) {
        const double diameter = 2.0 * fabric.tow(one).fibre_radius;
        return diameter + (fabric.tow(one).packing().thickness - diameter) * nested(spread_of(fabric, one));
    };
    const double apart = 0.5 * (thickness(family) + thickness(across));
    const double height = apart * stiff(across) / (stiff(family) + stiff(across));
    TowWave waved;
    for (Index crossed = 0; crossed < fabric.tows(across); ++crossed) {
        const bool warp_above = warp ? fabric.pattern.over(tow, crossed) : fabric.pattern.over(crossed, tow);
        waved.places.push_back(fabric.tow_position(across, crossed));
        waved.heights.push_back(warp_above == warp ? height : -height);
    }
    waved.ends = end_heights(fabric, family, tow);
    waved.reach = reach_of_ends * fabric.overhang;
    waved.broader = spread_of(fabric, family), waved.thinner = nested(waved.broader);
    return waved;
}

/// Why tows cannot begin waved; empty: they can.
inline std::string no_wave(const FabricParameters& fabric) {
    // Interpolation by quadratic elements misses a half wave of amplitude a by a (pi / (2 n))^3 / (9 sqrt(3)) in n elements:
    // 0.4 % of it with four.
    const double elements = 4.0;
    // A tow on a slope is thinner by the cosine of its angle, and its fibres lie in each other by that: 0.36 r at 0.7.
    const double steepest = 0.7;
    for (const Family family : {Family::warp, Family::weft}) {
        const double spacing = family == Family::warp ? fabric.weft_spacing : fabric.warp_spacing;
        const double element = fabric.fibre_length(family) / static_cast<double>(fabric.elements_of(family));
        const std::string name = name_of(family);
        if (spacing < elements * element)
            return name + " fibres have " + core::text(spacing / element) + " elements between crossings, for " +
                   core::text(elements);
        for (Index tow = 0; tow < fabric.tows(family); ++tow) {
            const TowWave wave = tow_wave(fabric, family, tow);
            const double slope = std::numbers::pi * std::abs(wave.heights.front()) / spacing;
            if (slope > steepest) return name + " tows would rise by " + core::text(slope) + ", for " + core::text(steepest);
            const std::array<double, 2> ends = WavedPath(wave, Eigen::Vector2d::Zero(), fabric.fibre_length(family)).ends();
            const double least = wave.places.back() + wave.reach;  // to either side
            if (ends[1] < least || -ends[0] < least)
                return name + " fibres would end " + core::text(least - std::min(ends[1], -ends[0])) +
                       " before they are as high as they are held";
        }
    }
    return {};
}

/// Whether a fabric begins waved: where asked for, or where tows can be and lie so deep in each other that to part them by a
/// radius an increment, as flat ones are, would take more increments than waved ones need.
/// @throws std::invalid_argument if it is asked for and cannot be
inline bool begins_waved(const FabricParameters& fabric, const SettleParameters& settle) {
    const double few = 8.0;  // increments in which waved tows part, by trial
    const bool asked = settle.start == Start::waved;
    if (settle.start == Start::flat || (!asked && tows_apart(fabric) <= few * smallest_radius(fabric))) return false;
    const std::string why = no_wave(fabric);
    if (asked && !why.empty()) core::refuse("SettleParameters.start", "waved", "flat: " + why);
    return why.empty();
}

}  // namespace fibrant::compositions::weave

// SPDX-License-Identifier: MIT
#pragma once
/// @file What a fabric that can be built may still fail at: closer than it can be woven, or ends that slip out.

#include <fibrant/compositions/weave/fabric_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// How far a plain weave of single fibres is from jamming: 1 where neighbours touch over every crossing, more where they are
/// closer than round fibres can lie, sqrt(1 - (p_1 / D)^2) + sqrt(1 - (p_2 / D)^2) with the two spacings p and D the sum of the
/// diameters (F. T. Peirce, The geometry of cloth structure, J. Textile Inst. 28, 1937); equal fibres jam at 1.73 diameters. 0
/// for other fabrics, whose tows give way.
inline double jamming(const FabricParameters& fabric) {
    if (fabric.warp.fibres != 1 || fabric.weft.fibres != 1) return 0.0;
    for (Index i = 0; i < fabric.warp_tows; ++i)
        for (Index j = 0; j < fabric.weft_tows; ++j)
            if ((i > 0 && fabric.pattern.over(i, j) == fabric.pattern.over(i - 1, j)) ||
                (j > 0 && fabric.pattern.over(i, j) == fabric.pattern.over(i, j - 1)))
                return 0.0;
    const double sum = 2.0 * (fabric.warp.fibre_radius + fabric.weft.fibre_radius);
    const auto part = [&](Index tows, double spacing) {
        return tows > 1 && spacing < sum ? std::sqrt(1.0 - spacing * spacing / (sum * sum)) : 0.0;
    };
    return part(fabric.warp_tows, fabric.warp_spacing) + part(fabric.weft_tows, fabric.weft_spacing);
}

/// Part of its length by which a tow gets shorter where it waves about the other family's: (pi a / 2 p)^2 of a sine of amplitude
/// a and half wave p, a a quarter of both thicknesses [1].
inline double expected_crimp(const FabricParameters& fabric, Family family) {
    const double amplitude = 0.25 * (fabric.warp.packing().thickness + fabric.weft.packing().thickness);
    const double spacing = family == Family::warp ? fabric.weft_spacing : fabric.warp_spacing;
    const double slope = 0.5 * std::numbers::pi * amplitude / spacing;
    return slope * slope;
}

/// What is to be said before a fabric is settled: each a sentence with the figure, the bound and the remedy. Empty where nothing
/// is in doubt.
inline std::vector<std::string> doubts(const FabricParameters& fabric) {
    std::vector<std::string> said;
    // By trial: stiff fibres settle at 0.85, and do not at 0.97, where they would have to bend about a radius of their own size.
    const double nearly = 0.9, settles = 0.85;
    if (const double jam = jamming(fabric); jam > nearly) {
        const double diameter = 2.0 * std::max(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
        said.push_back("single fibres so close jam (" + core::text(jam) + " by Peirce's measure, 1 where round fibres jam): " +
                       "they are pressed flat, or it does not settle; equal ones jam at a spacing of " +
                       core::text(std::sqrt(3.0) * diameter) + " and settle from " +
                       core::text(std::sqrt(4.0 - settles * settles) * diameter) + " on");
    }
    for (const Family family : {Family::warp, Family::weft}) {
        // Ends draw in by the crimp of half a fibre; a tow spreads by about a tenth while it parts from the others.
        const Family across = family == Family::warp ? Family::weft : Family::warp;
        const double needed =
            0.55 * fabric.tow(family).packing().width + 0.5 * expected_crimp(fabric, across) * fabric.fibre_length(across);
        if (fabric.overhang < needed)
            said.push_back(std::string("the outermost ") + name_of(family) +
                           " fibres may slip off the ends of those that they cross: an overhang of " +
                           core::text(fabric.overhang) + " is less than half the width of a tow and what ends draw in, about " +
                           core::text(needed));
    }
    return said;
}

/// Length over which a section's turn dies away along a fibre under the tension at the end, sqrt(E I / T), over an element [1].
inline double turn_over_element(const FabricParameters& fabric, const SettleParameters& settle, Family family) {
    const scene::CrossSection section = fabric.tow(family).section();
    const double strain = settle.tension_strain * settle.final_tension_factor;
    const double element = fabric.fibre_length(family) / static_cast<double>(fabric.elements_of(family));
    return std::sqrt(section.second_moment_1() / (strain * section.area())) / element;
}

/// Part of a turn of sections that is left an element of three nodes further, under a pull T. The turn obeys E I phi'' = T phi,
/// and is w' at both Gauss points; without the middle node nodes obey cosh(t) = 1 + 72 b / (b^2 - 12 b + 144), b = T l^2 / (E I),
/// and exp(-t) is left. It is least at b = 12: what resists bending still less turns over more elements, not over less of one.
/// @param turn  sqrt(E I / T) over an element [1], > 0
inline double turn_left(double turn) noexcept {
    const double b = 1.0 / (turn * turn);
    return std::exp(-std::acosh(1.0 + 72.0 * b / (b * b - 12.0 * b + 144.0)));
}

/// Where more than 1 / e is left an element further, at b = 144 [1]: kinks at crossings reach the ones beside them.
inline constexpr double least_turn = 0.08346;
/// Where the middle of an element turns against its ends, which is at (24 - b) / (24 + 2 b) of them [1]: 1 / sqrt(24).
inline constexpr double even_turn = 0.2041;

/// What helps fibres that turn over too little of an element, but less tension. Elements are no shorter than a diameter.
inline std::string remedy_of_turn(const FabricParameters& fabric, Family family, double turn, double least) {
    const double factor = least / turn, length = fabric.fibre_length(family);
    const double elements = std::ceil(factor * static_cast<double>(fabric.elements_of(family)));
    std::string said =
        std::string(name_of(family)) + ".inertia_factor >= " + core::text(factor * factor * fabric.tow(family).inertia_factor);
    if (elements * 2.0 * fabric.tow(family).fibre_radius <= length)
        said += ", or " + std::to_string(static_cast<Index>(elements)) + " elements";
    return said;
}

/// Refuses fibres that turn over less than `least_turn` of an element under the tension at the end.
inline void require_turns(const FabricParameters& fabric, const SettleParameters& settle) {
    for (const Family family : {Family::warp, Family::weft}) {
        const double turn = turn_over_element(fabric, settle, family), part = turn / least_turn;
        core::require(part >= 1.0, "SettleParameters.final_tension_factor", settle.final_tension_factor,
                      "<= " + core::text(part * part * settle.final_tension_factor) + ", for " + name_of(family) +
                          " fibres turn over " + core::text(turn) +
                          " of an element under the tension at the end, and elements follow no less than " +
                          core::text(least_turn) + "; or " + remedy_of_turn(fabric, family, turn, least_turn));
    }
}

/// The same of a fabric and of how it is settled: fibres that turn over a small part of an element, at crossings, under what
/// pulls them at the end.
inline std::vector<std::string> doubts(const FabricParameters& fabric, const SettleParameters& settle) {
    std::vector<std::string> said = doubts(fabric);
    for (const Family family : {Family::warp, Family::weft})
        if (const double turn = turn_over_element(fabric, settle, family); turn < even_turn)
            said.push_back(
                std::string(name_of(family)) + " fibres turn over " + core::text(turn) +
                " of an element under the tension at the end, and may kink and creep for ever where that is less than " +
                core::text(even_turn) + ": less tension, " + remedy_of_turn(fabric, family, turn, even_turn));
    return said;
}

}  // namespace fibrant::compositions::weave

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
            said.push_back(std::string("the outermost ") + (family == Family::warp ? "warp" : "weft") +
                           " fibres may slip off the ends of those that they cross: an overhang of " +
                           core::text(fabric.overhang) + " is less than half the width of a tow and what ends draw in, about " +
                           core::text(needed));
    }
    return said;
}

/// The same of a fabric and of how it is settled: fibres that turn over a small part of an element, sqrt(E I / T), kink at every
/// crossing under what pulls them at the end.
inline std::vector<std::string> doubts(const FabricParameters& fabric, const SettleParameters& settle) {
    const double least_turn = 0.08;  // of an element, by trial: 0.13 settles, 0.04 does not
    std::vector<std::string> said = doubts(fabric);
    for (const Family family : {Family::warp, Family::weft}) {
        const scene::CrossSection section = fabric.tow(family).section();
        const double turn =
            std::sqrt(section.second_moment_1() / (settle.tension_strain * settle.final_tension_factor * section.area()));
        const double element = fabric.fibre_length(family) / static_cast<double>(fabric.elements_of(family));
        if (turn < least_turn * element)
            said.push_back(
                std::string(family == Family::warp ? "warp" : "weft") + " fibres turn over " + core::text(turn / element) +
                " of an element under the tension at the end, and kink where that is less than " + core::text(least_turn) +
                ": less tension, a greater inertia factor, or " +
                std::to_string(static_cast<Index>(std::ceil(least_turn * fabric.fibre_length(family) / turn))) + " elements");
    }
    return said;
}

}  // namespace fibrant::compositions::weave

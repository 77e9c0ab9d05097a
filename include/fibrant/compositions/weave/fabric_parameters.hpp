// SPDX-License-Identifier: MIT
#pragma once
/// @file What a woven fabric is made of, and how it is settled from flat tows.

#include <fibrant/compositions/weave/packing.hpp>
#include <fibrant/compositions/weave/pattern.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/elastic_material.hpp>
#include <fibrant/simulation/settle_parameters.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace fibrant::compositions::weave {

/// The two families of tows: warp runs along x, weft along y.
enum class Family { warp, weft };
/// As keys and files have it.
inline const char* name_of(Family family) noexcept { return family == Family::warp ? "warp" : "weft"; }

/// One tow: equal fibres in a compact packing.
struct TowParameters {
    Index fibres = 0;                   ///< fibres (or macro-fibres) of the tow, >= 1
    double fibre_radius = core::unset;  ///< [length], > 0
    double inertia_factor = 1.0;        ///< on the second moments, fibres per real fibre for a macro-fibre [1], > 0
    scene::ElasticMaterial material;
    double aspect = 2.5;        ///< width over thickness of the flat tow [1], in [1, 20]
    double packing_gap = 1e-3;  ///< free distance between neighbours over their diameter [1], in [0, 1]

    void validate(const std::string& name = "TowParameters") const {
        core::require_at_least(name + ".fibres", fibres, 1);
        core::require_positive(name + ".fibre_radius", fibre_radius);
        core::require_positive(name + ".inertia_factor", inertia_factor);
        core::require_positive(name + ".material.young_modulus", material.young_modulus);
        core::require(material.poisson_ratio > -1.0 && material.poisson_ratio < 0.5, name + ".material.poisson_ratio",
                      material.poisson_ratio, "> -1 and < 0.5");
        core::require_between(name + ".aspect", aspect, 1.0, 20.0);
        core::require_between(name + ".packing_gap", packing_gap, 0.0, 1.0);
    }
    scene::CrossSection section() const { return scene::circular(fibre_radius, inertia_factor); }
    Packing packing() const { return compact_packing(fibres, fibre_radius, aspect, packing_gap); }
    /// E A of the tow [force].
    double axial_stiffness() const { return static_cast<double>(fibres) * material.young_modulus * section().area(); }
};

/// Which tow, and which of its fibres, a fibre of the fabric is.
struct FibrePlace {
    Family family = Family::warp;
    Index tow = -1;
    Index fibre = -1;  ///< in the order of the packing
};

/// A flat woven fabric, centred at the origin in the plane z = 0.
///
/// Fibres are numbered by warp tow, then weft tow, within a tow in the order of its packing.
struct FabricParameters {
    Pattern pattern;                     ///< rows are warp tows
    Index warp_tows = 0, weft_tows = 0;  ///< >= 1
    TowParameters warp, weft;
    double warp_spacing = core::unset;  ///< between the middles of neighbouring warp tows [length], > 0
    double weft_spacing = core::unset;  ///< between the middles of neighbouring weft tows [length], > 0
    double overhang = core::unset;      ///< free length of a fibre beyond its outermost crossings [length], > 0
    Index elements = 32;                ///< 3-node elements of a fibre, >= 1
    Index weft_elements = 0;            ///< of a weft fibre; 0: as many as of a warp fibre

    const TowParameters& tow(Family family) const noexcept { return family == Family::warp ? warp : weft; }
    Index tows(Family family) const noexcept { return family == Family::warp ? warp_tows : weft_tows; }
    Index fibres() const noexcept { return warp_tows * warp.fibres + weft_tows * weft.fibres; }
    Index elements_of(Family family) const noexcept {
        return family == Family::weft && weft_elements > 0 ? weft_elements : elements;
    }
    Index nodes_per_fibre(Family family = Family::warp) const noexcept { return 2 * elements_of(family) + 1; }
    Index nodes() const noexcept {
        return warp_tows * warp.fibres * nodes_per_fibre(Family::warp) + weft_tows * weft.fibres * nodes_per_fibre(Family::weft);
    }

    /// Number of a fibre in the fabric.
    Index fibre(Family family, Index tow, Index fibre) const noexcept {
        return family == Family::warp ? tow * warp.fibres + fibre : warp_tows * warp.fibres + tow * weft.fibres + fibre;
    }
    /// @param fibre  in [0, fibres())
    FibrePlace place(Index fibre) const noexcept {
        const Index warps = warp_tows * warp.fibres;
        if (fibre < warps) return {Family::warp, fibre / warp.fibres, fibre % warp.fibres};
        return {Family::weft, (fibre - warps) / weft.fibres, (fibre - warps) % weft.fibres};
    }
    /// Where the middle of a tow lies across its direction, before settling: y of a warp tow, x of a weft tow [length].
    double tow_position(Family family, Index tow) const noexcept {
        const double spacing = family == Family::warp ? warp_spacing : weft_spacing;
        return spacing * (static_cast<double>(tow) - 0.5 * static_cast<double>(tows(family) - 1));
    }
    /// Length of a straight fibre [length].
    double fibre_length(Family family) const noexcept {
        return family == Family::warp ? static_cast<double>(weft_tows - 1) * weft_spacing + 2.0 * overhang
                                      : static_cast<double>(warp_tows - 1) * warp_spacing + 2.0 * overhang;
    }

    /// Throws std::invalid_argument that names the field, unless the fabric can be built and holds together.
    void validate() const {
        core::require_at_least("FabricParameters.warp_tows", warp_tows, 1);
        core::require_at_least("FabricParameters.weft_tows", weft_tows, 1);
        warp.validate("FabricParameters.warp");
        weft.validate("FabricParameters.weft");
        core::require_positive("FabricParameters.warp_spacing", warp_spacing);
        core::require_positive("FabricParameters.weft_spacing", weft_spacing);
        core::require_positive("FabricParameters.overhang", overhang);
        core::require_at_least("FabricParameters.elements", elements, 1);
        core::require_at_least("FabricParameters.weft_elements", weft_elements, 0);
        pattern.require_holding(warp_tows, weft_tows);
        for (const Family family : {Family::warp, Family::weft}) {
            const std::string name = name_of(family);
            const Packing packing = tow(family).packing();
            const double spacing = family == Family::warp ? warp_spacing : weft_spacing;
            if (tows(family) > 1)
                core::require(packing.width <= spacing, "FabricParameters." + name + "_spacing", spacing,
                              ">= width of a " + name + " tow = " + core::text(packing.width) + ", or neighbouring tows overlap");
            // The fibres of the other family must reach beyond the outermost tow of this one.
            core::require(overhang > 0.5 * packing.width, "FabricParameters.overhang", overhang,
                          "> half the width of a " + name + " tow = " + core::text(0.5 * packing.width));
            const double element = fibre_length(family) / static_cast<double>(elements_of(family));
            const double diameter = 2.0 * tow(family).fibre_radius;
            core::require(
                element >= diameter,
                family == Family::weft && weft_elements > 0 ? "FabricParameters.weft_elements" : "FabricParameters.elements",
                static_cast<double>(elements_of(family)),
                "<= " + core::text(std::floor(fibre_length(family) / diameter)) + ", for an element of a " + name + " fibre (" +
                    core::text(element) + ") is shorter than a diameter (" + core::text(diameter) + ")");
        }
    }
};

/// Smallest radius of a fabric's fibres [length].
inline double smallest_radius(const FabricParameters& fabric) {
    return std::min(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
}

/// Where tows are when a settling begins: straight in the plane, waved about as they come to lie, or by whether that pays.
enum class Start { automatic, flat, waved };

/// How flat interpenetrating tows become a fabric (Durville, section 15.3.5): pulled while they part, and let go to a hundredth.
struct SettleParameters : simulation::SettleParameters {
    SettleParameters() { final_tension_factor = 1e-2; }
    double tension_strain = 2e-3;    ///< tension of a tow over its E A while tows part [1], > 0
    Start start = Start::automatic;  ///< flat or waved; automatic: waved where tows are thick and can be (`begins_waved`)

    void validate() const {
        core::require_positive("SettleParameters.tension_strain", tension_strain);
        simulation::SettleParameters::validate();
    }
};

}  // namespace fibrant::compositions::weave

// SPDX-License-Identifier: MIT
#pragma once
/// @file A woven fabric as a scene: flat, interpenetrating tows and the order that its pattern asks of them.

#include <fibrant/compositions/weave/waved_path.hpp>
#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// Channel that scales the tension of all tows.
inline constexpr const char* tension_channel = "tension";

/// Adds all fibres, straight in the plane z = 0, in groups by tow. @returns the groups of the warp and of the weft tows
/// @param lifted  they begin turned, so that their ends lie as high as they are to be held
/// @param waved   they begin over and under each other, as high as that at their ends (`WavedPath`)
inline std::array<std::vector<Index>, 2> add_flat_fibres(scene::Assembly& assembly, const FabricParameters& fabric,
                                                         bool lifted = false, bool waved = false) {
    const Index cloth = assembly.add_group("fabric");
    std::array<std::vector<Index>, 2> groups;
    for (const Family family : {Family::warp, Family::weft}) {
        const bool warp = family == Family::warp;
        const TowParameters& tow = fabric.tow(family);
        const Packing packing = tow.packing();
        const Vec3 along = warp ? Vec3::UnitX() : Vec3::UnitY();
        const Vec3 across = warp ? Vec3::UnitY() : Vec3::UnitX();
        const double half = 0.5 * fabric.fibre_length(family);
        for (Index t = 0; t < fabric.tows(family); ++t) {
            const Index group = assembly.add_group((warp ? "warp " : "weft ") + std::to_string(t), cloth);
            groups[warp ? 0 : 1].push_back(group);
            const auto [first, last] = end_heights(fabric, family, t);
            const double turned = 0.5 * (last - first) / half, flat = std::sqrt(1.0 - turned * turned);
            const TowWave wave = waved ? tow_wave(fabric, family, t) : TowWave{};
            for (Index k = 0; k < tow.fibres; ++k) {
                const auto& offset = packing.centres[core::at(k)];
                const Vec3 centre = (fabric.tow_position(family, t) + offset.x()) * across + offset.y() * Vec3::UnitZ();
                scene::FibreSpecification fibre;
                fibre.from = centre - half * along, fibre.to = centre + half * along;
                if (waved) {
                    const Vec3 middle = fabric.tow_position(family, t) * across;
                    const auto path = std::make_shared<const WavedPath>(wave, offset, 2.0 * half);
                    fibre.start = [middle, along, across, path](double part) {
                        const Vec3 at = path->at(part);
                        return Vec3(middle + at.x() * along + at.y() * across + at.z() * Vec3::UnitZ());
                    };
                } else if (lifted && (first != 0.0 || last != 0.0)) {
                    const Vec3 middle = centre + 0.5 * (first + last) * Vec3::UnitZ();
                    const Vec3 way = half * (flat * along + turned * Vec3::UnitZ());
                    fibre.start = [middle, way](double s) { return Vec3(middle + (2.0 * s - 1.0) * way); };
                }
                fibre.section = tow.section(), fibre.material = tow.material;
                fibre.elements = fabric.elements_of(family);
                fibre.director = Vec3::UnitZ();
                fibre.group = group;
                assembly.add(fibre);
            }
        }
    }
    return groups;
}

/// The order that the pattern asks of crossing tows.
inline void force_pattern(scene::Assembly& assembly, const FabricParameters& fabric,
                          const std::array<std::vector<Index>, 2>& groups) {
    for (Index i = 0; i < fabric.warp_tows; ++i)
        for (Index j = 0; j < fabric.weft_tows; ++j) {
            const Index warp = groups[0][core::at(i)], weft = groups[1][core::at(j)];
            const bool over = fabric.pattern.over(i, j);
            assembly.force_order({over ? warp : weft, over ? weft : warp, Vec3::UnitZ()});
        }
}

namespace detail {
inline scene::Assembly unsettled(const FabricParameters& fabric, double tension_strain, bool waved) {
    fabric.validate();
    core::require_positive("flat_fabric.tension_strain", tension_strain);
    scene::Assembly assembly;
    const std::array<std::vector<Index>, 2> groups = add_flat_fibres(assembly, fabric, true, waved);
    for (Index f = 0; f < fabric.fibres(); ++f) {
        const Family family = fabric.place(f).family;
        const TowParameters& tow = fabric.tow(family);
        const Vec3 along = family == Family::warp ? Vec3::UnitX() : Vec3::UnitY();
        const double pull = tension_strain * tow.material.young_modulus * tow.section().area();
        const Mat3 axial = along * along.transpose();
        for (const scene::Station& end : {scene::first_end(f), scene::last_end(f)}) {
            assembly.hold_position(end, Mat3::Identity() - axial);
            assembly.apply(
                scene::DeadForce{end, scene::NodeVector::position, (end.fraction > 0.5 ? pull : -pull) * along, tension_channel});
        }
        assembly.hold_axial_rotation(scene::first_end(f));
        assembly.hold_position({f, 0.5}, axial);
    }
    force_pattern(assembly, fabric, groups);
    return assembly;
}
}  // namespace detail

/// Scene of a fabric before it is settled (Durville, section 15.3.5): all tows straight in the plane z = 0, but for those whose
/// ends have no room to come back to it (`end_heights`).
///
/// The ends of a fibre keep their place across the fibre and are pulled along it by a dead force; its middle keeps its
/// place along it. Ends are free to turn and to draw in, so nothing but the tension holds a fibre's length.
/// @param tension_strain  pull of a fibre over its E A at amplitude 1 of the tension channel [1], > 0
inline scene::Assembly flat_fabric(const FabricParameters& fabric, double tension_strain) {
    return detail::unsettled(fabric, tension_strain, false);
}

/// The same, where its settling begins: flat, or with tows that pass over and under each other (`begins_waved`).
/// @throws std::invalid_argument if tows are to be waved, and cannot be
inline scene::Assembly unsettled_fabric(const FabricParameters& fabric, const SettleParameters& settle) {
    return detail::unsettled(fabric, settle.tension_strain, begins_waved(fabric, settle));
}

}  // namespace fibrant::compositions::weave

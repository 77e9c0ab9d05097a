// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres inside a hollow one: what a scene says of them.

#include <fibrant/core/parameters.hpp>
#include <fibrant/scene/places.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace fibrant::scene {

/// A hollow fibre, whose section has a bore, and the fibres that it keeps inside: its wall pushes them inwards, with the laws of
/// contact between fibres. The tube and these fibres do not touch each other in any other way. What of a fibre is beyond an end
/// of the tube is free. Fibres in one tube touch each other as all do. A fibre in a tube in a tube is listed with both.
struct Tube {
    Index fibre = -1;           ///< the hollow one
    std::vector<Index> rods{};  ///< what is in it, round and thinner than its bore
};

/// Throws std::invalid_argument naming the fibre and the value that is wrong.
/// @param fibres  of the scene, FibreSpecification
template <class Fibres>
void require_tube(const Tube& tube, const Fibres& fibres) {
    const auto named = [&](Index fibre) -> std::string {
        if (fibre < 0 || fibre >= core::count(fibres))
            core::refuse("Tube: fibre", std::to_string(fibre), "a fibre of this assembly");
        return label("fibre", fibre, fibres[core::at(fibre)].name);
    };
    const auto open = [](const auto& fibre) {
        if (fibre.closed || fibre.repeats)
            core::refuse("fibre.closed or fibre.repeats", "true", "false, for a tube and what is in it");
    };
    const std::string name = named(tube.fibre);
    const auto& outer = fibres[core::at(tube.fibre)];
    core::with_place([&] { return name; },
                     [&] {
                         core::require(outer.section.bore > 0.0, "Tube.fibre: CrossSection.bore", outer.section.bore, "> 0");
                         open(outer);
                         if (tube.rods.empty()) core::refuse("Tube.rods", "none", "one fibre at least");
                     });
    for (auto rod = tube.rods.begin(); rod != tube.rods.end(); ++rod) {
        const std::string own = named(*rod);
        core::with_place([&] { return own + " in " + name; },
                         [&] {
                             if (*rod == tube.fibre)
                                 core::refuse("Tube.rods", std::to_string(*rod), "another fibre than the tube");
                             if (std::find(tube.rods.begin(), rod, *rod) != rod)
                                 core::refuse("Tube.rods", std::to_string(*rod), "listed once");
                             const auto& inner = fibres[core::at(*rod)];
                             open(inner);
                             core::require(inner.section.semi_axis_1 == inner.section.semi_axis_2, "CrossSection.semi_axis_2",
                                           inner.section.semi_axis_2, "semi_axis_1: what is in a tube is round");
                             core::require(inner.section.radius() <= outer.section.bore, "CrossSection.semi_axis_1",
                                           inner.section.radius(),
                                           "<= " + core::text(outer.section.bore) + ", the bore that it is in");
                         });
    }
}

}  // namespace fibrant::scene

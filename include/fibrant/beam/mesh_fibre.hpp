// SPDX-License-Identifier: MIT
#pragma once
/// @file A fibre as a mesh sees it, and the units that fibres give a scene.

#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <string>
#include <vector>

namespace fibrant::beam {

/// A fibre of a mesh. Its unknowns are consecutive, node after node.
struct MeshFibre {
    Index first_vector;
    Index elements;
    double element_length;  ///< at rest [length]
    scene::CrossSection section;
    scene::ElasticMaterial material;
    Index group;
    bool closed = false;          ///< its last node is the image of its first one, and abscissae count modulo `elements`
    std::string name{};           ///< what messages call it beside its number; may be empty
    bool goes_on = false;         ///< an image of it goes on where it ends: contact there is with that
    Index image_of = -1;          ///< the fibre that it is an image of, beside its cell
    int joins = 0;                ///< an image: 1 if it begins where that fibre ends, -1 if it ends where that one begins
    std::vector<Index> inside{};  ///< tubes that it is in

    double length() const noexcept { return element_length * static_cast<double>(elements); }
};

/// Whether a fibre is in a tube.
inline bool is_inside(const MeshFibre& fibre, Index tube) noexcept {
    return std::find(fibre.inside.begin(), fibre.inside.end(), tube) != fibre.inside.end();
}

/// Says of each fibre what it is in. Throws std::invalid_argument where a fibre has an image beside its cell: that one is in
/// none.
inline void set_tubes(std::vector<MeshFibre>& fibres, const scene::Assembly& assembly) {
    for (const scene::Tube& tube : assembly.tubes()) {
        std::vector<Index> all = tube.rods;
        all.push_back(tube.fibre);
        for (const Index fibre : all)
            for (const scene::FibreImage& image : assembly.images())
                if (image.fibre == fibre)
                    core::refuse("Tube: fibre", std::to_string(fibre), "one without an image beside its cell");
        for (const Index rod : tube.rods)
            if (!is_inside(fibres[core::at(rod)], tube.fibre)) fibres[core::at(rod)].inside.push_back(tube.fibre);
    }
}

/// The units of a scene: its smallest radius, and E r, the stiffness of a fibre over a length of its radius.
inline void set_units(scene::DofLayout& layout, const std::vector<MeshFibre>& fibres) {
    if (fibres.empty()) return;
    double radius = fibres.front().section.radius(), stiffness = 0.0;
    for (const MeshFibre& fibre : fibres) {
        radius = std::min(radius, fibre.section.radius());
        stiffness = std::max(stiffness, fibre.material.young_modulus * fibre.section.radius());
    }
    layout.unit_length = scene::power_of_two(radius), layout.unit_stiffness = scene::power_of_two(stiffness);
}

}  // namespace fibrant::beam

// SPDX-License-Identifier: MIT
#pragma once
/// @file Keys and bounds that several programs have alike.

#include "scene_reader.hpp"

#include <fibrant/scene/elastic_material.hpp>

#include <string>

namespace example {

/// Young's modulus and Poisson's ratio; both must be given.
inline void read_material(SceneReader& file, const std::string& section, fibrant::scene::ElasticMaterial& material) {
    file.require(section, "young_modulus", material.young_modulus, positive(), "force/length^2", "Young's modulus of the fibres");
    file.require(section, "poisson_ratio", material.poisson_ratio, poisson_ratio(), "1", "Poisson's ratio of the fibres");
}

/// What fibres are across, by `[section.law]` kind = "transversely_isotropic"; young_modulus and poisson_ratio are those along them then. To
/// be checked by `check_transverse` once all keys are known.
inline void read_transverse(SceneReader& file, const std::string& section, std::string& kind, fibrant::scene::TransverseConstants& across) {
    const std::string law = section + ".law";
    file.read(law, "kind", kind, {"isotropic", "transversely_isotropic"}, "how the material of the fibres behaves across them");
    file.read(law, "transverse_modulus", across.young_modulus, positive(), "force/length^2", "Young's modulus across the fibres");
    file.read(law, "transverse_poisson_ratio", across.poisson_ratio, inside(-1.0, 1.0), "1", "Poisson's ratio in the plane of the section");
    file.read(law, "shear_modulus", across.shear_modulus, positive(), "force/length^2", "shear modulus between the fibre axis and its section");
}
inline void check_transverse(const SceneReader& file, const std::string& section, const std::string& kind) {
    const std::string law = section + ".law";
    for (const char* key : {"transverse_modulus", "transverse_poisson_ratio", "shear_modulus"})
        file.check(file.given(law, key) == (kind != "isotropic"), law, key, kind == "isotropic" ? "left out, for kind = \"isotropic\"" : "given, for kind = \"transversely_isotropic\"");
}

/// Wires of a strand of full layers.
inline Bound wires() { return {.low = 7, .high = 91, .said = "7, 19, 37, 61 or 91", .values = {7, 19, 37, 61, 91}}; }

}  // namespace example

// SPDX-License-Identifier: MIT
#pragma once
/// @file Keys and bounds that several programs have alike.

#include "scene_reader.hpp"

#include <fibrant/scene/elastic_material.hpp>

#include <string>

namespace example {

/// Young's modulus and Poisson's ratio; both must be given.
inline void read_material(SceneReader& file, const std::string& section, fibrant::scene::ElasticMaterial& material) {
    file.require(section, "young_modulus", material.young_modulus, positive(), "force/length^2", "of the material");
    file.require(section, "poisson_ratio", material.poisson_ratio, poisson_ratio(), "1", "of the material");
}

/// Wires of a strand of full layers.
inline Bound wires() { return {.low = 7, .high = 91, .said = "7, 19, 37, 61 or 91", .values = {7, 19, 37, 61, 91}}; }

}  // namespace example

// SPDX-License-Identifier: MIT
#pragma once
/// @file A solid of a scene: hexahedra, their material, and what is imposed on their nodes.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace fibrant::scene {

/// Elastic body of 8-node hexahedra, for models that have a part `Solid`. It is at rest where its nodes are.
struct Solid {
    std::vector<Vec3> nodes;                  ///< [length]
    std::vector<std::array<Index, 8>> cells;  ///< nodes of each cell: round one face, then the opposite one in the same order
    ElasticMaterial material{};

    /// Jacobians are checked by the part that meshes the solid.
    void validate() const {
        core::require_positive("Solid.material.young_modulus", material.young_modulus);
        material.require_isotropic("Solid");
        core::require(material.poisson_ratio > -1.0 && material.poisson_ratio < 0.5, "Solid.material.poisson_ratio",
                      material.poisson_ratio, "> -1 and < 0.5");
        core::require_at_least("Solid.cells", core::count(cells), 1);
        for (std::size_t n = 0; n < nodes.size(); ++n)
            if (!nodes[n].allFinite()) core::refuse("Solid.nodes[" + std::to_string(n) + "]", text(nodes[n]), "finite");
        for (const std::array<Index, 8>& cell : cells)
            for (const Index node : cell)
                if (node < 0 || node >= core::count(nodes))
                    core::refuse("Solid.cells", std::to_string(node), "a node of the solid");
    }
};

/// Components of nodes of a solid that follow a prescribed path, as `Hold` says it of a fibre's node.
struct SolidHold {
    Index solid = 0;                         ///< number of the solid in the assembly
    std::vector<Index> nodes;                ///< that are held
    Mat3 directions = Mat3::Identity();      ///< symmetric projector on what is held; it turns with `rotation`
    std::string channel = "motion";          ///< whose amplitude drives it
    Vec3 displacement = Vec3::Zero();        ///< at amplitude 1 [length]
    std::function<Vec3(double)> path{};      ///< displacement at amplitude a, where it is not proportional
    std::function<Mat3(double)> rotation{};  ///< at amplitude a; none: identity
    Vec3 pivot = Vec3::Zero();               ///< of the rotation [length]

    void validate() const {
        require_projector("SolidHold.directions", directions);
        require_finite("SolidHold.displacement", displacement);
        require_finite("SolidHold.pivot", pivot);
        require_at("SolidHold", 0.0, path, rotation);
    }
    /// Where a node that is at `rest` goes.
    Vec3 goal(const Vec3& rest, double amplitude) const {
        const Mat3 turn = rotation ? rotation(amplitude) : Mat3(Mat3::Identity());
        const Vec3 shift = path ? path(amplitude) : Vec3(amplitude * displacement);
        return pivot + turn * (rest - pivot) + shift;
    }
};

}  // namespace fibrant::scene

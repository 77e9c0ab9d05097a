// SPDX-License-Identifier: MIT
#pragma once
/// @file Nodes of solids among the nodal vectors of a scene, for what ties them.

#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <vector>

namespace fibrant::connection {

/// Where the nodes of solids are among all nodal vectors: after those of the fibres.
struct SolidPlaces {
    SolidPlaces(const scene::Assembly& assembly, const Vector& fibres) {
        Index nodes = 0;
        for (const scene::Solid& solid : assembly.solids())
            first.push_back(fibres.size() / 3 + nodes), nodes += core::count(solid.nodes);
        state.resize(fibres.size() + 3 * nodes);
        state.head(fibres.size()) = fibres;
        for (std::size_t s = 0; s < first.size(); ++s)
            for (Index n = 0; n < core::count(assembly.solids()[s].nodes); ++n)
                state.segment<3>(3 * (first[s] + n)) = assembly.solids()[s].nodes[core::at(n)];
    }
    Index vector(const scene::SolidNode& at) const noexcept { return first[core::at(at.solid)] + at.node; }
    /// E times the size of a cell next to the node: what a cell gives it [force / length].
    static double support(const scene::Assembly& assembly, const scene::SolidNode& at) {
        const scene::Solid& solid = assembly.solids()[core::at(at.solid)];
        for (const auto& cell : solid.cells)
            if (std::find(cell.begin(), cell.end(), at.node) != cell.end())
                return solid.material.young_modulus * (solid.nodes[core::at(cell[6])] - solid.nodes[core::at(cell[0])]).norm();
        return 0.0;
    }
    std::vector<Index> first;  ///< nodal vector of each solid's first node
    Vector state;              ///< of the fibres, then places of the nodes at the start [length]
};

}  // namespace fibrant::connection

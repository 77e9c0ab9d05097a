// SPDX-License-Identifier: MIT
#pragma once
/// @file Fabrics of the tows in Durville's tables 15.1 to 15.3, of any size, and the model that settles them.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <cmath>
#include <string>

namespace fibrant::benchmarks {

template <class LinearSolver>
struct SettledWeave {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = LinearSolver;
};

/// `tows` + `tows` tows: 380 real fibres of 18 um each, `fibres` macro-fibres in their place. Lengths in mm, forces in N.
inline compositions::weave::FabricParameters chapter_fabric(const std::string& pattern, Index tows, Index fibres) {
    namespace cloth = compositions::weave;
    cloth::FabricParameters fabric;
    fabric.pattern = cloth::Pattern::named(pattern);
    fabric.warp_tows = fabric.weft_tows = tows;
    fabric.warp.fibres = fibres;
    fabric.warp.fibre_radius = 0.009 * std::sqrt(380.0 / static_cast<double>(fibres));
    fabric.warp.inertia_factor = static_cast<double>(fibres) / 380.0;
    fabric.warp.material = {7300.0, 0.3};
    fabric.weft = fabric.warp;
    fabric.warp_spacing = fabric.weft_spacing = fabric.overhang = 0.88;
    const double elements = 32.0 / 4.4 * fabric.fibre_length(cloth::Family::warp);  // of the length of the chapter's
    fabric.elements = static_cast<Index>(std::lround(elements));
    return fabric;
}

}  // namespace fibrant::benchmarks

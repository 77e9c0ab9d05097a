// SPDX-License-Identifier: MIT
#pragma once
/// @file The repeating cell of plain weave that tests of periodic fabrics settle, and what it is made of.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

namespace fibrant::compositions::weave {

struct Cell {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::TwoLevelPcg;
    using Connections = connection::RigidBodies;
};

inline FabricParameters cell_fabric() {
    FabricParameters fabric;
    const scene::CrossSection macro = scene::macro_fibre(380.0, 0.018, 7.0);
    fabric.warp_tows = fabric.weft_tows = 2;
    fabric.warp = {7, macro.semi_axis_1, macro.inertia_factor, {7300.0, 0.3}};
    fabric.weft = fabric.warp;
    fabric.warp_spacing = fabric.weft_spacing = 0.88;
    fabric.overhang = 0.44;
    fabric.elements = 8;
    return fabric;
}

}  // namespace fibrant::compositions::weave

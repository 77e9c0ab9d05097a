// SPDX-License-Identifier: MIT
#pragma once
/// @file Two tows of five fibres each way: the smallest weave in which everything of a weave happens, and the model that settles
/// it.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

namespace fibrant::test {

struct SmallWeave {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::TwoLevelPcg;
};

inline compositions::weave::FabricParameters small_fabric() {
    compositions::weave::FabricParameters fabric;
    fabric.pattern = compositions::weave::Pattern{};
    fabric.warp_tows = fabric.weft_tows = 2;
    fabric.warp = {5, 0.04, 0.05, {7300.0, 0.3}};
    fabric.weft = fabric.warp;
    fabric.warp_spacing = fabric.weft_spacing = fabric.overhang = 0.88;
    fabric.elements = 12;
    return fabric;
}

}  // namespace fibrant::test

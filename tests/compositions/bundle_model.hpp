// SPDX-License-Identifier: MIT
#pragma once
/// @file The model of bundles in tests of compositions, strands, ropes and mats: one, which is compiled once.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

namespace fibrant::test {

/// Friction, and plates where there are some, solved directly.
struct Bundle {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

}  // namespace fibrant::test

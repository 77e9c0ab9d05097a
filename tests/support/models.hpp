// SPDX-License-Identifier: MIT
#pragma once
/// @file Models that tests of several folders share: compiled once in models.cpp where a build has it and says so
/// by FIBRANT_TEST_MODELS, not once in every file that runs one.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#ifdef FIBRANT_TEST_MODELS
#include <fibrant/compiled/rough_fibres.hpp>
#endif

namespace fibrant::test {

#ifdef FIBRANT_TEST_MODELS
using Rough = compiled::RoughFibres;
#else
struct Rough {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};
#endif
struct Smooth : Rough {
    using Friction = law::Frictionless;
};
struct Pressing : Smooth {
    using Tools = contact::RigidTools;
};
struct RoughPressing : Rough {
    using Tools = contact::RigidTools;
};
static_assert(simulation::Model<RoughPressing> && simulation::Model<Smooth> && simulation::Model<Rough> && simulation::Model<Pressing>);

}  // namespace fibrant::test

#ifdef FIBRANT_TEST_MODELS
namespace fibrant::simulation {
extern template class Simulator<test::Smooth>;
extern template class Simulator<test::Pressing>;
extern template class Simulator<test::RoughPressing>;
}  // namespace fibrant::simulation
#endif

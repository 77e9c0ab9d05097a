// SPDX-License-Identifier: MIT
// A part that may be left out, under a name that is nearly its own, is not left out in silence.
// expect: static assertion failed|static_assert failed
// expect: SpellsTools
// expect: WithTool
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct WithTool {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
    using Tool = core::NoParameters;
};
static_assert(simulation::Model<WithTool>);

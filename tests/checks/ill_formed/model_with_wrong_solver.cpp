// SPDX-License-Identifier: MIT
// A search solves no system.
// expect: static assertion failed|static_assert failed
// expect: HasSolver
// expect: LinearSolver
// expect: GridSearch
// expect: analyse
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Solverless {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = proximity::GridSearch;
};
static_assert(simulation::Model<Solverless>);

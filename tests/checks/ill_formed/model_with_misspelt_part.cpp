// SPDX-License-Identifier: MIT
// A misspelt part is a missing part.
// expect: static assertion failed|static_assert failed
// expect: HasProximity
// expect: no type named .Proximity|typename M::Proximity. is invalid
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Misspelt {
    using Beam = beam::DirectorBeam<3>;
    using Proximty = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Misspelt>);

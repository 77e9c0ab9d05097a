// SPDX-License-Identifier: MIT
// A model names every part: one without friction says so with a null law.
// expect: static assertion failed|static_assert failed
// expect: HasFriction
// expect: Friction
// expect: no type named .Friction|typename M::Friction. is invalid
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Incomplete {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Incomplete>);

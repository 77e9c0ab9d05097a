// SPDX-License-Identifier: MIT
// A friction law is no normal law.
// expect: static assertion failed|static_assert failed
// expect: HasNormal
// expect: NormalLaw
// expect: Frictionless
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Confused {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Frictionless;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Confused>);

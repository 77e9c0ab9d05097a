// SPDX-License-Identifier: MIT
// What acts is a list of terms: a law is none.
// expect: static assertion failed|static_assert failed
// expect: ActsAreTerms
// expect: ListFor
// expect: Acting
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Acting {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
    using Acts = law::RegularisedPenalty;
};
static_assert(simulation::Model<Acting>);

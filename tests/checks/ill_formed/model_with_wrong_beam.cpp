// SPDX-License-Identifier: MIT
// A material is no beam element.
// expect: static assertion failed|static_assert failed
// expect: HasBeam
// expect: BeamElement
// expect: ElasticMaterial
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Beamless {
    using Beam = scene::ElasticMaterial;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Beamless>);

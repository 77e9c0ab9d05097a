// SPDX-License-Identifier: MIT
// A gap limit for a law that limits no gap would do nothing.
// expect: GapLimiting
// expect: RegularisedPenalty
// expect: with_limit|GapShifting
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;

struct Unlimited {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};

void limit(simulation::Stage<Unlimited>& stage) { stage.gap_limit = 0.1; }

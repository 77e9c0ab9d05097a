// SPDX-License-Identifier: MIT
#pragma once
/// @file The usual model, compiled once: a program that has it compiles in a fourth of the time, and links the target
/// fibrant::compiled.
///
/// The same is open to a model of one's own: `extern template class simulation::Simulator<Mine>;` where it is used, and `template
/// class simulation::Simulator<Mine>;` in one source file.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

namespace fibrant::compiled {

/// Fibres whose sections deform, with friction; a coefficient of 0 leaves it out.
struct RoughFibres {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<RoughFibres>);

}  // namespace fibrant::compiled

namespace fibrant::simulation {
extern template class Simulator<compiled::RoughFibres>;
extern template Audit audit(const Simulator<compiled::RoughFibres>&, double);
}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file Models that tests of several folders share: compiled once in models.cpp and in fibrant::compiled, not once in every file
/// that runs one.

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/compiled/rough_fibres.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/solver/any_solver.hpp>

#include <type_traits>

namespace fibrant::test {

using Rough = compiled::RoughFibres;
/// Solved directly as well, by blocks of nodes, which takes a third of the time that it takes by single numbers.
struct Smooth : Rough {
    using Friction = law::Frictionless;
    using Solver = solver::DoubleBlockCholesky;
};
/// Contacts that multipliers hold apart; with friction, which a coefficient of 0 leaves out.
struct Multiplied : Rough {
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Solver = solver::DoubleBlockCholesky;
    using Tools = contact::RigidTools;
};
/// Touched on centrelines; friction without its lever, which a coefficient of 0 leaves out.
struct Centred : Rough {
    using Beam = beam::OnCentreline<beam::DirectorBeam<3>, beam::FrictionLever::dropped>;
    using Solver = solver::DoubleBlockCholesky;
    using Tools = contact::RigidTools;
};
/// All that a scene may have: friction, which a coefficient of 0 leaves out, tools, bodies, and a strategy of solution that is
/// told when it runs. Of every beam one that is compiled, for tests whose subject is none of these.
template <beam::BeamElement B>
struct Every {
    using Beam = B;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::AnySolver;
    using Tools = contact::RigidTools;
    using Connections = connection::RigidBodies;
};
using EveryDirector = Every<beam::DirectorBeam<3>>;
using EveryRod = Every<beam::RigidSectionRod>;
using EveryCable = Every<beam::KirchhoffCable>;
/// Those of a model, solved directly. @param strategy  of models that are told theirs when they run
template <simulation::Model M>
simulation::ModelParameters<M> direct_parameters(const char* strategy = "double_block_cholesky") {
    simulation::ModelParameters<M> parameters;
    if constexpr (std::is_same_v<typename M::Solver, solver::AnySolver>) parameters.solver.strategy = strategy;
    return parameters;
}
static_assert(simulation::Model<Rough> && simulation::Model<Smooth> && simulation::Model<Multiplied> &&
              simulation::Model<Centred> && simulation::Model<EveryDirector>);

}  // namespace fibrant::test

namespace fibrant::simulation {
extern template class Simulator<test::Smooth>;
extern template class Simulator<test::Multiplied>;
extern template class Simulator<test::Centred>;
extern template class Simulator<test::EveryDirector>;
extern template class Simulator<test::EveryRod>;
extern template class Simulator<test::EveryCable>;
}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file Models that tests of several folders share: compiled once in models.cpp and in fibrant::compiled, not once in every file
/// that runs one.

#include <fibrant/beam/kirchhoff_cable.hpp>
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
struct Smooth : Rough {
    using Friction = law::Frictionless;
};
struct Pressing : Smooth {
    using Tools = contact::RigidTools;
};
struct RoughPressing : Rough {
    using Tools = contact::RigidTools;
};
/// Contacts that multipliers hold apart; with friction, which a coefficient of 0 leaves out.
struct Multiplied : RoughPressing {
    using Normal = law::Augmented<law::RegularisedPenalty>;
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
/// Those of a model, solved directly.
template <simulation::Model M>
simulation::ModelParameters<M> direct_parameters() {
    simulation::ModelParameters<M> parameters;
    if constexpr (std::is_same_v<typename M::Solver, solver::AnySolver>) parameters.solver.strategy = "sparse_cholesky";
    return parameters;
}
static_assert(simulation::Model<RoughPressing> && simulation::Model<Smooth> && simulation::Model<Rough> &&
              simulation::Model<Pressing>);

}  // namespace fibrant::test

namespace fibrant::simulation {
extern template class Simulator<test::Smooth>;
extern template class Simulator<test::Pressing>;
extern template class Simulator<test::RoughPressing>;
extern template class Simulator<test::Multiplied>;
extern template class Simulator<test::EveryDirector>;
extern template class Simulator<test::EveryRod>;
extern template class Simulator<test::EveryCable>;
}  // namespace fibrant::simulation

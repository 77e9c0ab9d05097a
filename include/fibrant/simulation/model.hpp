// SPDX-License-Identifier: MIT
#pragma once
/// @file What a model names: every part, nothing defaulted.

#include <fibrant/assembly/solid_system.hpp>
#include <fibrant/beam/beam_element.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/contact/passage.hpp>
#include <fibrant/law/friction_law.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/simulation/near_names.hpp>
#include <fibrant/solver/linear_solver.hpp>
#include <fibrant/solver/newton.hpp>
#include <fibrant/term/list.hpp>

namespace fibrant::contact {
// Comes with RigidTools, which a model that has tools names; others are spared its compilation.
template <beam::BeamElement B, proximity::ProximitySearch Search, law::NormalLaw Normal, law::FrictionLaw Friction, class Part>
class ContactsWithTools;
}  // namespace fibrant::contact

namespace fibrant::simulation {

/// One concept a part, so that a missing or ill-formed one is named by the compiler.
template <class M>
concept HasBeam = requires {
    typename M::Beam;
}
&&beam::BeamElement<typename M::Beam>;
template <class M>
concept HasProximity = requires {
    typename M::Proximity;
}
&&proximity::ProximitySearch<typename M::Proximity>;
template <class M>
concept HasNormal = requires {
    typename M::Normal;
}
&&law::NormalLaw<typename M::Normal>;
template <class M>
concept HasFriction = requires {
    typename M::Friction;
}
&&law::FrictionLaw<typename M::Friction>&& law::HistoryIsKept<typename M::Friction>;
/// A model whose fibres are bonded to solids says so: `using Solid = connection::BondedSolid<...>;`. May be left out too.
template <class M>
concept HasSolid = requires {
    typename M::Solid;
}
&&core::Policy<typename M::Solid>&& core::Active<typename M::Solid>;

namespace detail {
template <class M>
struct SolidOf {
    using Type = solid::NoSolid;
};
template <HasSolid M>
struct SolidOf<M> {
    using Type = typename M::Solid;
};
}  // namespace detail

/// Its linear solver solves the system of the model, whatever parts that has.
template <class M>
concept HasSolver = requires {
    typename M::Solver;
}
&&solver::LinearSolver<typename M::Solver,
                       assembly::Seen<typename assembly::SystemOf<typename M::Beam, typename detail::SolidOf<M>::Type>::Type>>;

/// A model whose scenes have rigid tools says so: `using Tools = contact::RigidTools;`. It may be left out, as the next.
template <class M>
concept HasTools = requires {
    typename M::Tools;
}
&&core::Policy<typename M::Tools>&& core::Active<typename M::Tools>;

/// A model whose scenes tie fibre ends to rigid bodies or to periodic images says so: `using Connections =
/// connection::RigidBodies;`.
template <class M>
concept HasConnections = requires {
    typename M::Connections;
}
&&core::Policy<typename M::Connections>&& core::Active<typename M::Connections>;

/// Before an increment is accepted, its motion is checked for fibres that would pass through each other unseen. A model whose
/// scenes rule that out says so: `using Passage = contact::NoPassage;`. May be left out, and then nothing is.
template <class M>
concept HasPassage = requires {
    typename M::Passage;
}
&&core::Policy<typename M::Passage>;

/// A model whose fibres are pushed by more than contacts and what a scene applies says so: `using Acts =
/// term::List<load::Gravity, ...>;`. May be left out.
template <class M>
concept HasActs = requires {
    typename M::Acts;
};
/// Where it has a list, that is one of terms.
template <class M>
concept ActsAreTerms = !HasActs<M> || term::ListFor<typename M::Acts, typename M::Beam>;

/// A model whose increments are cut and grown in a way of their own says so: `using Steps = ...;`, a StepControl. May be left
/// out.
template <class M>
concept HasSteps = requires {
    typename M::Steps;
};

/// A part that may be left out is refused under a name that is nearly its own.
template <class M>
concept SpellsTools = !detail::NearTools<M>;
template <class M>
concept SpellsConnections = !detail::NearConnections<M>;
template <class M>
concept SpellsSolid = !detail::NearSolid<M>;
template <class M>
concept SpellsPassage = !detail::NearPassage<M>;
template <class M>
concept SpellsActs = !detail::NearActs<M>;
template <class M>
concept SpellsSteps = !detail::NearSteps<M>;

/// A model names its Beam, Proximity, Normal, Friction and Solver, each of which satisfies its own contract.
template <class M>
concept Model = HasBeam<M> && HasProximity<M> && HasNormal<M> && HasFriction<M> && HasSolver<M> && ActsAreTerms<M> &&
    SpellsTools<M> && SpellsConnections<M> && SpellsSolid<M> && SpellsPassage<M> && SpellsActs<M> && SpellsSteps<M>;

namespace detail {
template <Model M>
struct ActsOf {
    using Type = term::List<>;
};
template <Model M>
    requires HasActs<M>
struct ActsOf<M> {
    using Type = typename M::Acts;
};
template <Model M>
struct ContactsOf {
    using Type = contact::ContactSet<typename M::Beam, typename M::Proximity, typename M::Normal, typename M::Friction>;
};
template <Model M>
    requires HasTools<M>
struct ContactsOf<M> {
    using Type = contact::ContactsWithTools<typename M::Beam, typename M::Proximity, typename M::Normal, typename M::Friction,
                                            typename M::Tools>;
};
template <Model M>
struct PassageOf {
    using Type = typename contact::Swept::template Of<typename M::Beam>;
};
template <Model M>
    requires HasPassage<M>
struct PassageOf<M> {
    using Type = typename M::Passage::template Of<typename M::Beam>;
};
template <Model M>
struct ConnectionsOf {
    using Type = connection::NoConnections;
};
template <Model M>
    requires HasConnections<M>
struct ConnectionsOf<M> {
    using Type = typename M::Connections;
};
template <class B, class... T>
constexpr bool any_moves(const term::List<T...>&) {
    return (term::Moving<term::For<T, B>> || ...);
}
}  // namespace detail

/// A model whose fibres move in time: one of its terms is inertia.
template <class M>
concept MovesInTime = Model<M> && detail::any_moves<typename M::Beam>(typename detail::ActsOf<M>::Type());

/// Parameters of a model's parts, by the names of the parts.
template <Model M>
struct ModelParameters {
    typename M::Beam::Parameters beam{};
    typename M::Proximity::Parameters proximity{};
    typename M::Normal::Parameters normal{};
    typename M::Friction::Parameters friction{};
    typename M::Solver::Parameters solver{};
    [[no_unique_address]] typename detail::SolidOf<M>::Type::Parameters solid{};
    [[no_unique_address]] typename detail::ActsOf<M>::Type::Parameters acts{};
    contact::ContactParameters contact{};
    solver::IterationParameters iteration{};
};

/// The parameters themselves, once what no part checks by itself has passed.
template <Model M>
const ModelParameters<M>& checked(const ModelParameters<M>& parameters) {
    parameters.contact.validate();
    parameters.iteration.validate();
    return parameters;
}

}  // namespace fibrant::simulation

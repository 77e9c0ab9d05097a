// SPDX-License-Identifier: MIT
#pragma once
/// @file The model of textiles that are settled and loaded: bodies and plates at their edges, friction, any solver.

#include "scene_solver.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <type_traits>

namespace example {

/// @tparam Own  sections and friction obey laws of their own; else sections are isotropic and friction is Coulomb's
template <bool Own>
struct LoadedFibres {
    using Beam = fibrant::beam::With<fibrant::beam::DirectorBeam<>,
                                     std::conditional_t<Own, fibrant::material::Elastic, fibrant::beam::Isotropic>>;
    using Proximity = fibrant::proximity::GridSearch;
    using Normal = fibrant::law::LimitedGap<fibrant::law::RegularisedPenalty>;
    using Friction = std::conditional_t<Own, fibrant::law::ShapedFriction, fibrant::law::RegularisedCoulomb>;
    using Solver = SceneSolver;
    using Tools = fibrant::contact::RigidTools;
    using Connections = fibrant::connection::RigidBodies;
};

}  // namespace example

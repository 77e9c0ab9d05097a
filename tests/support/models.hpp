// SPDX-License-Identifier: MIT
#pragma once
/// @file Models that tests of several folders share: compiled once in models.cpp and in fibrant::compiled, not once in every file
/// that runs one.

#include <fibrant/compiled/rough_fibres.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/frictionless.hpp>

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
static_assert(simulation::Model<RoughPressing> && simulation::Model<Smooth> && simulation::Model<Rough> &&
              simulation::Model<Pressing>);

}  // namespace fibrant::test

namespace fibrant::simulation {
extern template class Simulator<test::Smooth>;
extern template class Simulator<test::Pressing>;
extern template class Simulator<test::RoughPressing>;
}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#include "models.hpp"

namespace fibrant::simulation {
template class Simulator<test::Smooth>;
template class Simulator<test::Pressing>;
template class Simulator<test::RoughPressing>;
}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#include "models.hpp"

namespace fibrant::simulation {
template class Simulator<test::Smooth>;
template class Simulator<test::Multiplied>;
template class Simulator<test::Centred>;
template class Simulator<test::EveryDirector>;
template class Simulator<test::EveryRod>;
template class Simulator<test::EveryCable>;
}  // namespace fibrant::simulation

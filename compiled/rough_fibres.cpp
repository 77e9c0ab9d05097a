// SPDX-License-Identifier: MIT
#include <fibrant/compiled/rough_fibres.hpp>

namespace fibrant::simulation {
template class Simulator<compiled::RoughFibres>;
template Audit audit(const Simulator<compiled::RoughFibres>&, double);
}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#define FIBRANT_COMPILES template
#include <fibrant/compiled/solvers.hpp>

// SPDX-License-Identifier: MIT
// NaN marks unset parameters, so arithmetic that denies NaN is refused.
// flags: -ffast-math
// expect: fibrant needs IEEE arithmetic
// expect: -ffast-math
#include <fibrant/core/config.hpp>

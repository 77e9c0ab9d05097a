// SPDX-License-Identifier: MIT
#pragma once
/// @file Coulomb friction that is elastic before it slides.

#include <fibrant/law/coulomb_friction.hpp>

namespace fibrant::law {

/// f(y) = y
struct StraightRise {
    static constexpr const char* name = "RegularisedCoulomb";
    static constexpr double secant(double) noexcept { return 1.0; }
    static constexpr double slope(double) noexcept { return 1.0; }
    static constexpr double work(double y) noexcept { return 0.5 * y * y; }
};

/// Regularised Coulomb friction: elastic up to a reversible displacement u_max, then sliding at mu R_N.
using RegularisedCoulomb = CoulombFriction<StraightRise>;
static_assert(FrictionLaw<RegularisedCoulomb> && core::Active<RegularisedCoulomb>);

}  // namespace fibrant::law

// SPDX-License-Identifier: MIT
#pragma once
/// @file Coulomb friction whose stiffness fades out before it slides.

#include <fibrant/law/coulomb_friction.hpp>

namespace fibrant::law {

/// f(y) = 2 y - y^2
struct RoundedRise {
    static constexpr const char* name = "SmoothCoulomb";
    static constexpr double secant(double y) noexcept { return 2.0 - y; }
    static constexpr double slope(double y) noexcept { return 2.0 - 2.0 * y; }
    static constexpr double work(double y) noexcept { return y * y * (1.0 - y / 3.0); }
};

/// Coulomb friction that bends over into sliding: twice as stiff as RegularisedCoulomb at first, and with a slope that has no
/// jump where sliding begins.
using SmoothCoulomb = CoulombFriction<RoundedRise>;
static_assert(FrictionLaw<SmoothCoulomb> && core::Active<SmoothCoulomb>);

}  // namespace fibrant::law

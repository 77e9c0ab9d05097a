// SPDX-License-Identifier: MIT
#pragma once
/// @file The null friction law.

#include <fibrant/law/friction_law.hpp>

namespace fibrant::law {

/// No friction: no history, no force, no instruction.
struct Frictionless : core::Inactive {
    using Parameters = core::NoParameters;
    struct History {};
    explicit Frictionless(const Parameters& = {}) {}
    FrictionResponse<History> response(const Vec3&, double, const History&) const noexcept { return {}; }
};
static_assert(FrictionLaw<Frictionless> && !core::Active<Frictionless>);

}  // namespace fibrant::law

// SPDX-License-Identifier: MIT
// A law that returns the reaction alone is no normal law.
// expect: static assertion failed|static_assert failed
// expect: NormalLaw
// expect: ReactionOnly
// expect: response
#include <fibrant/law/normal_law.hpp>

struct ReactionOnly {
    using Parameters = fibrant::core::NoParameters;
    explicit ReactionOnly(const Parameters& = {}) {}
    double response(double gap, double stiffness) const noexcept { return gap < 0.0 ? -stiffness * gap : 0.0; }
    double energy(double gap, double stiffness) const noexcept { return gap < 0.0 ? 0.5 * stiffness * gap * gap : 0.0; }
};
static_assert(fibrant::law::NormalLaw<ReactionOnly>);

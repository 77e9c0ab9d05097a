// SPDX-License-Identifier: MIT
#pragma once
/// @file Penalty proportional to the penetration.

#include <fibrant/law/normal_law.hpp>

namespace fibrant::law {

/// Reaction proportional to the penetration; its slope jumps at first touch.
class LinearPenalty {
public:
    using Parameters = core::NoParameters;
    explicit LinearPenalty(const Parameters& = {}) {}

    /// @param gap        < 0 in penetration [length]
    /// @param stiffness  > 0 [force / length]
    NormalResponse response(double gap, double stiffness) const noexcept {
        if (gap >= 0.0) return {0.0, 0.0};
        return {-stiffness * gap, -stiffness};
    }

    /// Work stored by a penetration [force * length].
    double energy(double gap, double stiffness) const noexcept { return gap >= 0.0 ? 0.0 : 0.5 * stiffness * gap * gap; }

    /// Penetration under a reaction >= 0 [length].
    double penetration(double reaction, double stiffness) const noexcept { return reaction / stiffness; }
};
static_assert(InvertibleLaw<LinearPenalty>);

}  // namespace fibrant::law

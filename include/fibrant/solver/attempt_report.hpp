// SPDX-License-Identifier: MIT
#pragma once
/// @file What one attempt at an increment came to.

#include <fibrant/solver/newton.hpp>
#include <fibrant/solver/tolerance_use.hpp>

#include <string>
#include <utility>

namespace fibrant::solver {

/// Outcome of one attempt at an increment.
struct AttemptReport {
    bool converged = false;
    bool astray = false;  ///< Newton's method or contact passes have not found their way
    std::string reason;   ///< why not
    IterationCounts counts;
    double residual = 0.0;      ///< over loads, reactions and contact forces [1]
    double force_scale = 0.0;   ///< norm of those [force]
    double step = 0.0;          ///< last Newton step [length]
    double displacement = 0.0;  ///< greatest of the increment [length]
    ToleranceUse use;           ///< of one that has converged
    Vector unsettled;           ///< last step, or displacement of the last pass or of the whole, of an attempt that has failed
    double allowed = 0.0;       ///< what that may be anywhere without harm [length]

    /// It has forces, and has moved by more than rounding of a radius: where nothing acts a part of them is rounding by rounding.
    bool acts(double radius) const noexcept {
        constexpr double rounding = 1e-12;  // some ten times that of a place in a scene of a few hundred radii
        return force_scale > 0.0 && displacement > rounding * radius;
    }

    /// One that has converged is not accepted, if there is a reason why: whoever moved most is not at fault.
    void refuse(std::string why) {
        reason = std::move(why);
        if (!reason.empty()) converged = false, unsettled.resize(0);
    }
};

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#pragma once
/// @file How far an increment went into each tolerance, or beyond it.

#include <algorithm>

namespace fibrant::solver {

/// What an accepted increment ended with, each over what the parameters state: at most 1 where that was kept [1]. A stage that is
/// loose by its own word may be beyond.
struct ToleranceUse {
    double residual = 0.0;     ///< over IterationParameters.residual_tolerance
    double turn = 0.0;         ///< of normals in the last normal pass, over normal_tolerance
    double travel = 0.0;       ///< displacement of the last contact pass, over contact_tolerance
    double penetration = 0.0;  ///< deepest contact over the penetration that is allowed to its pair of groups in the stage

    double greatest() const noexcept { return std::max({residual, turn, travel, penetration}); }
    /// Keeps the greater of each.
    void add(const ToleranceUse& other) noexcept {
        residual = std::max(residual, other.residual), turn = std::max(turn, other.turn);
        travel = std::max(travel, other.travel), penetration = std::max(penetration, other.penetration);
    }
};

}  // namespace fibrant::solver

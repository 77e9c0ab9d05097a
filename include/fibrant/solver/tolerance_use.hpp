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
    double travel = 0.0;       ///< displacement of the last contact pass, over contact_tolerance; of what points stand aside
                               ///< by, over standing_points, where that is more
    double penetration = 0.0;  ///< deepest contact over the penetration that is allowed to its pair of groups in the stage

    /// Deepest place of two fibres by the true gap, between contact points as well, over what is allowed there; 0 where nothing
    /// touches, and where it was not measured: in stages that are loose by their own word.
    double between = 0.0;

    double greatest() const noexcept { return std::max({residual, turn, travel, penetration, between}); }
    /// Keeps the greater of each.
    void add(const ToleranceUse& other) noexcept {
        residual = std::max(residual, other.residual), turn = std::max(turn, other.turn);
        travel = std::max(travel, other.travel), penetration = std::max(penetration, other.penetration);
        between = std::max(between, other.between);
    }
};

}  // namespace fibrant::solver

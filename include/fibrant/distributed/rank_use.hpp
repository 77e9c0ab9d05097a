// SPDX-License-Identifier: MIT
#pragma once
/// @file What a solver that ranks share has done, and what that took.

#include <fibrant/distributed/routes.hpp>

namespace fibrant::distributed {

/// What the ranks of a solver have done so far, seen from one of them.
struct RankUse {
    Index parts = 0, coarse_unknowns = 0;  ///< of the last analysis
    Index solves = 0, iterations = 0;
    Traffic traffic;
    double prepare_seconds = 0.0;  ///< all of the preparations
    double sweep_seconds = 0.0;    ///< of the iterations: chains,
    double product_seconds = 0.0;  ///< products,
    double joint_seconds = 0.0;    ///< joints of chains, their exchange included,
    double coarse_seconds = 0.0;   ///< coarse space, its gathering included,
    double waiting_seconds = 0.0;  ///< other exchanges,
    double whole_seconds = 0.0;    ///< and all
};

}  // namespace fibrant::distributed

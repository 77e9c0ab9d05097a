// SPDX-License-Identifier: MIT
#pragma once
/// @file What solves the linear systems of a scene: in a program of one process any strategy, in one that ranks of MPI run
/// together those that they can share.

#include "example.hpp"
#include "usual_keys.hpp"
#ifdef FIBRANT_WITH_MPI
#include "ranks.hpp"
#else
#include <fibrant/solver/any_solver.hpp>
#endif

namespace example {

#ifdef FIBRANT_WITH_MPI
inline constexpr bool run_by_ranks = true;
using SceneSolver = RankSolver;
inline void choose_solver(auto& parameters, const LinearSolver& how) {
    parameters.solver = {how.strategy, static_cast<int>(how.subdomains), how.petsc_options};
}
/// All ranks stop after the same increment.
inline void stop_together(auto& loading) { loading.stop = stopped_together; }
#else
inline constexpr bool run_by_ranks = false;
using SceneSolver = fibrant::solver::AnySolver;
inline void choose_solver(auto& parameters, const LinearSolver& how) { parameters.solver.strategy = how.strategy; }
inline void stop_together(auto&) {}
/// One process writes to the folder that was named.
struct RankFolder {
    explicit RankFolder(const Output&) {}
    bool shown() const noexcept { return true; }
};
#endif

}  // namespace example

// SPDX-License-Identifier: MIT
#pragma once
/// @file Figures of a run and of its increments.

#include <fibrant/core/stage_clock.hpp>
#include <fibrant/solver/nested_loops.hpp>

#include <array>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// Work done since the start of a run, by the trapezoidal rule over increments [force * length].
struct EnergyBalance {
    double elastic = 0.0;     ///< stored in the fibres
    double contact = 0.0;     ///< stored in penetrations and in reversible slips
    double external = 0.0;    ///< done by loads and prescribed motion
    double dissipated = 0.0;  ///< by sliding, >= 0
    double lost = 0.0;        ///< by the laws of sections: plastic, viscous, hysteretic, >= 0
    double damped = 0.0;      ///< taken by the damping of stages that have one, >= 0
    double rearranged = 0.0;  ///< put in by changes of contact elements, gap shifts, friction's bound and penalty stiffness
    double released = 0.0;    ///< let go in stages that force an order: an increment starts from an imposed overlap and leaps
    double kinetic = 0.0;     ///< of fibres that move in time
    double numerical = 0.0;   ///< of a motion `error()`: lost to the scheme, impacts that its steps do not resolve included
    /// What is missing: external + rearranged - released - dissipated - lost - damped - stored.
    double error() const noexcept {
        return external + rearranged - released - dissipated - lost - damped - elastic - contact - kinetic;
    }
};

/// One accepted increment.
struct IncrementReport {
    Index number = 0;  ///< accepted increments so far
    std::string stage;
    double stage_progress = 0;       ///< in [0, 1]
    double progress = 0;             ///< of the whole loading, in [0, 1]
    bool waits = false;              ///< its stage has come to its end, and goes on until fibres part or rest
    double fraction = 1;             ///< of the stage's increment, smaller after cuts
    Index cuts = 0;                  ///< rejected attempts at it
    solver::IterationCounts counts;  ///< rejected attempts included
    bool unstable = false;           ///< its tangent was indefinite: it may rest on a saddle
    double residual = 0;             ///< over loads, reactions and contact forces [1]
    double displacement = 0;         ///< greatest [length]
    double damping = 0;              ///< norm of the damping's force, over loads, reactions and contact forces [1]
    /// Springs of the damping over those of the stage: of all fibres, and of the fibre that is held hardest. Cuts make them
    /// harder. Both are 1 for increments from before a resume.
    double springs = 1, hardest_springs = 1;
    /// What it was accepted at, over the tolerances that are stated: at most 1 each, but in stages that are loose by their own
    /// word.
    solver::ToleranceUse use;
    contact::ContactFigures contact;
    EnergyBalance energy;
    double seconds = 0;  ///< wall time of the increment
};

/// An attempt at an increment that was given up: a smaller one, or one that is held harder, follows.
struct FailedAttempt {
    Index number = 0;  ///< of the increment
    std::string stage;
    Index attempts = 0;   ///< at it, this one included
    double fraction = 1;  ///< of the stage's increment that it tried
    double springs = 1;   ///< of the damping over those of the stage
    Index newton = 0;     ///< iterations that it took
    std::string reason;
    double seconds = 0;  ///< wall time since the increment began
};

/// A whole run.
struct Report {
    bool converged = false;
    std::string reason;  ///< why it stopped early; empty if it did not
    std::vector<IncrementReport> increments;
    Index rejected_increments = 0;
    solver::IterationCounts counts;
    double residual = 0;              ///< at the end [1]
    contact::ContactFigures contact;  ///< at the end
    solver::ToleranceUse use;         ///< of the last increment: what the end was accepted at, over what is stated [1]
    solver::ToleranceUse most_use;    ///< greatest of all increments
    EnergyBalance energy;
    std::string solver;  ///< what a linear solver that chooses has used and why, in this process; empty for others
    std::array<double, core::part_count> seconds{};  ///< by core::Part
    double wall_seconds = 0;

    /// Takes what increments tell of the end, and the most of all.
    void sum_up() {
        if (!increments.empty()) contact = increments.back().contact, residual = increments.back().residual;
        if (!increments.empty()) use = increments.back().use;
        for (const IncrementReport& increment : increments) most_use.add(increment.use);
    }
};

}  // namespace fibrant::simulation

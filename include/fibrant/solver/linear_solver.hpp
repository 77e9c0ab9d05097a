// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of a linear solver: a strategy that is given the system, not a matrix.

#include <fibrant/assembly/linear_system.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/core/parameters.hpp>

#include <cmath>
#include <concepts>
#include <cstdint>
#include <memory>

namespace fibrant::solver {

/// How a linear solve ended.
enum class SolveStatus : std::uint8_t {
    converged,
    iteration_limit,
    indefinite,  ///< a direction of curvature <= 0 was met: A is not positive definite
    not_finite,  ///< NaN or infinity in the values, the right-hand side or the result
};

/// What a linear solve did.
struct SolveReport {
    SolveStatus status = SolveStatus::not_finite;
    int iterations = 0;
    double residual = core::unset;   ///< |b - A x| / |b| in `scaled_norm`, of the x returned
    double curvature = core::unset;  ///< least p.Ap / p.Mp met, M the preconditioner; `indefinite` if <= 0
};

/// Of a solve that has reached its limit: its step still leads down [1].
inline constexpr double useful_residual = 0.3;

/// How many iterations a solve may take.
struct IterationLimit {
    int most;   ///< > 0
    int trial;  ///< after so many it ends where it has not come to a `useful_residual`; 0: there is no trial

    IterationLimit(int iterations, int trial_iterations = 0) noexcept : most{iterations}, trial{trial_iterations} {}
    bool ends(const SolveReport& report) const noexcept {
        return report.iterations >= most || (report.iterations == trial && trial > 0 && report.residual >= useful_residual);
    }
};

/// Solves A x = b.
///
/// - analyse(system): the graph; once per set of contact elements, before the first prepare.
/// - prepare(system): the values; once per iteration. `converged` if the system may be solved, `indefinite` if A (or a
///   block of it) is seen not to be positive definite: solve may be called all the same and gives a descent direction.
/// - solve(system, b, tolerance, x): until the residual is below the tolerance. x need not be sized or set: the start
///   is always zero. With `indefinite` x is the last iterate before, a descent direction: b.x > 0 unless b = 0.
/// A copy of a solver has to analyse again. The bits of x depend neither on the number of threads nor on what was
/// solved before. All of it is checked by tests/solver/linear_solver_contract.hpp.
template <class S, class T>
concept LinearSolver = core::Policy<S> && assembly::LinearSystem<T> &&
    requires(S solver, const T& system, const Vector& b, double tolerance, Vector& x) {
    solver.analyse(system);
    { solver.prepare(system) } -> std::same_as<SolveStatus>;
    { solver.solve(system, b, tolerance, x) } -> std::same_as<SolveReport>;
};

/// A strategy that multiplies by the bands of chains: a system has to give it all that lies within them.
template <class S>
concept ReadsWholeBands = requires {
    requires S::reads_whole_bands;
};

/// Norm of a residual, in which forces on directions count as forces at the surface: each 3-vector is divided by its
/// length in the layout [force].
inline double scaled_norm(const scene::DofLayout& layout, const Vector& r) {
    return std::sqrt(core::ordered_sum(layout.vectors(), 0.0, [&](Index first, Index last) {
        double sum = 0.0;
        for (Index v = first; v < last; ++v) {
            const double length = layout.length[core::at(v)];
            sum += r.segment<3>(3 * v).squaredNorm() / (length * length);
        }
        return sum;
    }));
}

using scene::grain;

/// |b - A x| / |b| in `scaled_norm`; r is set to b - A x.
///
/// @param norm  of b, > 0
template <assembly::LinearSystem System>
double relative_residual(const System& system, const Vector& b, double norm, const Vector& x, Vector& r) {
    r.resize(b.size());
    system.apply(x, r);
    r = b - r;
    return scaled_norm(system.layout(), r) / norm;
}

/// What a solver works with, and a copy of it does not take along.
template <class Value>
class Workspace {
public:
    Workspace() : value_{std::make_unique<Value>()} {}
    Workspace(const Workspace&) : Workspace() {}
    Workspace(Workspace&&) noexcept = default;
    Workspace& operator=(const Workspace& other) {
        if (this != &other) value_ = std::make_unique<Value>();
        return *this;
    }
    Workspace& operator=(Workspace&&) noexcept = default;
    ~Workspace() = default;
    Value& operator*() const noexcept { return *value_; }
    Value* operator->() const noexcept { return value_.get(); }

private:
    std::unique_ptr<Value> value_;
};

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#pragma once
/// @file Preconditioned BiCGStab: for tangents whose friction follows the reaction, which are not symmetric.

#include <fibrant/solver/linear_solver.hpp>

#include <cmath>
#include <utility>

namespace fibrant::solver {

/// A system with a part that its `apply` leaves out.
template <class T>
concept UnsymmetricSystem = assembly::LinearSystem<T> && requires(const T system, const Vector& x, Vector& y) {
    { system.unsymmetric() } -> std::same_as<bool>;
    system.apply_skews(x, y);
};

/// Vectors of BiCGStab, kept from solve to solve.
struct BiconjugateVectors {
    Vector r, shadow, p, v, t, preconditioned_p, preconditioned_s;
};

/// Solves (A + S) x = b from x = 0 by BiCGStab (van der Vorst 1992), preconditioned from the right; all vectors in double.
/// An iteration is two products. A breakdown starts again from the present residual.
/// @param precondition     precondition(r, z): z = M^-1 r
template <UnsymmetricSystem System, class Precondition>
SolveReport stabilised_biconjugate_gradient(const System& system, const Precondition& precondition, const Vector& b,
                                            double tolerance, const IterationLimit& limit, BiconjugateVectors& work, Vector& x) {
    const scene::DofLayout& layout = system.layout();
    const assembly::HeldProjector held(layout);
    x.setZero(b.size());
    if (!b.allFinite()) return {};
    const double norm = scaled_norm(layout, b);
    if (norm == 0.0) return {SolveStatus::converged, 0, 0.0, core::unset};
    const auto apply = [&](const Vector& from, Vector& to) {
        system.apply(from, to);
        system.apply_skews(from, to);
    };
    work.r = b;
    held.project(work.r);
    scene::add_held(layout, b, work.r, x);
    for (Vector* vector : {&work.p, &work.v, &work.t, &work.preconditioned_p, &work.preconditioned_s}) vector->setZero(b.size());
    SolveReport report{SolveStatus::iteration_limit, 0, scaled_norm(layout, work.r) / norm, core::unset};
    double rho = 0.0, alpha = 0.0, omega = 0.0;
    bool fresh = true;  // begin with the residual as the only direction
    while (report.residual > tolerance && !limit.ends(report)) {
        if (fresh) work.shadow = work.r, work.p = work.r, rho = core::dot(work.shadow, work.r);
        precondition(std::as_const(work.p), work.preconditioned_p);
        held.project(work.preconditioned_p);
        apply(work.preconditioned_p, work.v);
        const double along = core::dot(work.shadow, work.v);
        if (!std::isfinite(along) || along == 0.0) {
            report.status = SolveStatus::not_finite;
            return report;
        }
        alpha = rho / along;
        work.r -= alpha * work.v;
        precondition(std::as_const(work.r), work.preconditioned_s);
        held.project(work.preconditioned_s);
        apply(work.preconditioned_s, work.t);
        const double square = core::dot(work.t, work.t);
        omega = square > 0.0 ? core::dot(work.t, work.r) / square : 0.0;
        x += alpha * work.preconditioned_p + omega * work.preconditioned_s;
        work.r -= omega * work.t;
        report.residual = scaled_norm(layout, work.r) / norm;
        ++report.iterations;
        const double next = core::dot(work.shadow, work.r);
        fresh =
            omega == 0.0 || std::abs(next) < 1e-12 * std::sqrt(core::dot(work.shadow, work.shadow) * core::dot(work.r, work.r));
        if (!fresh) work.p = work.r + next / rho * alpha / omega * (work.p - omega * work.v);
        rho = next;
    }
    if (!std::isfinite(report.residual))
        report.status = SolveStatus::not_finite;
    else if (report.residual <= tolerance)
        report.status = SolveStatus::converged;
    return report;
}

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#pragma once
/// @file Preconditioned conjugate gradients that notice an indefinite system.

#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <concepts>
#include <limits>
#include <utility>

namespace fibrant::solver {

/// Vectors of conjugate gradients, kept from solve to solve.
struct ConjugateGradientVectors {
    Vector r, z, p, product;
    Vector passed;  ///< A z, of preconditioners that know it
};

/// A preconditioner that finds A z on its way to z = M^-1 r: with_product(r, z, product) is false where it does not.
template <class P>
concept PassesProduct = requires(const P precondition, const Vector& r, Vector& z) {
    { precondition.with_product(r, z, z) } -> std::same_as<bool>;
};

namespace detail {

/// x += alpha p, r -= alpha product, in one pass. Returns the squared scaled norm of r.
inline double advance(const scene::DofLayout& layout, double alpha, const ConjugateGradientVectors& cg, Vector& x, Vector& r) {
    return core::ordered_sum(layout.vectors(), 0.0, [&](Index first, Index last) {
        double sum = 0.0;
        for (Index v = first; v < last; ++v) {
            x.segment<3>(3 * v) += alpha * cg.p.segment<3>(3 * v);
            r.segment<3>(3 * v) -= alpha * cg.product.segment<3>(3 * v);
            const double length = layout.length[core::at(v)];
            sum += r.segment<3>(3 * v).squaredNorm() / (length * length);
        }
        return sum;
    });
}

/// Never asks for another preconditioner.
struct SamePreconditioner {
    bool operator()(int) const noexcept { return false; }
};

}  // namespace detail

/// Solves A x = b by conjugate gradients from x = 0, all vectors in double.
///
/// The held part of b is the held part of x from the start; the rest is sought among free vectors. When the recursive
/// residual has reached the tolerance the true one is computed; should it have not, the iteration starts again from it.
///
/// Where the preconditioner passes on A z, and does so to a twentieth of the tolerance at the first step, products with p are
/// summed from those with z in the place of being formed. Its error goes down with the residual, so it may do later what it does
/// not at first; there it is to be some ten times smaller, for what was formed exactly is to keep what it had. What products err
/// by is seen in the true residual.
///
/// @param precondition     precondition(r, z): z = M^-1 r, symmetric positive definite
/// @param renewed          renewed(iterations) is asked before every iteration: true if the preconditioner is another one
///                         from now on, with which the iteration starts again where it is
template <assembly::LinearSystem System, class Precondition, class Renewed = detail::SamePreconditioner>
SolveReport conjugate_gradient(const System& system, const Precondition& precondition, const Vector& b, double tolerance,
                               const IterationLimit& limit, ConjugateGradientVectors& cg, Vector& x,
                               const Renewed& renewed = {}) {
    const scene::DofLayout& layout = system.layout();
    const assembly::HeldProjector held(layout);
    x.setZero(b.size());
    if (!b.allFinite()) return {};
    const double norm = scaled_norm(layout, b);
    if (norm == 0.0) return {SolveStatus::converged, 0, 0.0, core::unset};

    cg.r = b;
    held.project(cg.r);
    scene::add_held(layout, b, cg.r, x);
    cg.z.resize(b.size());
    cg.product.resize(b.size());
    cg.p.setZero(b.size());
    SolveReport report{SolveStatus::iteration_limit, 0, scaled_norm(layout, cg.r) / norm, core::unset};
    double before = 0.0, weight = 0.0;                         // r.z of the iteration before, and p.M p
    bool given = false;                                        // A z by the preconditioner, to the accuracy that is wanted
    double passing = std::numeric_limits<double>::infinity();  // error of that at the last first step, over the residual
    bool exact = true;                                         // whether the residual is that of x, not the recursive one
    double reached = std::numeric_limits<double>::infinity();  // true residual at the last restart
    while (!limit.ends(report)) {
        if (report.residual <= (given ? 0.9 : 1.0) * tolerance) {
            if (!exact) report.residual = relative_residual(system, b, norm, x, cg.r);
            held.project(cg.r);
            if (report.residual <= tolerance) {
                report.status = SolveStatus::converged;
                break;
            }
            if (report.residual > 0.5 * reached) break;  // rounding allows no less
            reached = report.residual;
            exact = true;
            before = 0.0;
        }
        if (renewed(report.iterations)) before = 0.0;
        bool passed = false;
        if constexpr (PassesProduct<Precondition>) {
            given = before > 0.0 && passing * report.residual <= (given ? 0.05 : 0.003) * tolerance;
            if (before == 0.0 || given) passed = precondition.with_product(std::as_const(cg.r), cg.z, cg.passed);
            if (passed) held.project(cg.passed);
        }
        if (!passed) precondition(std::as_const(cg.r), cg.z);
        held.project(cg.z);
        given = given && passed;
        const double rz = core::dot(cg.r, cg.z);
        const double beta = before > 0.0 ? rz / before : 0.0;
        core::parallel_for((b.size() + 8191) / 8192, [&](Index block) {
            const Index first = 8192 * block, size = std::min<Index>(8192, b.size() - first);
            cg.p.segment(first, size) = cg.z.segment(first, size) + beta * cg.p.segment(first, size);
            if (given) cg.product.segment(first, size) = cg.passed.segment(first, size) + beta * cg.product.segment(first, size);
        });
        weight = rz + beta * beta * weight;  // r is orthogonal to the directions before
        if (!given) system.apply(cg.p, cg.product);
        if (passed && before == 0.0) {
            held.project(cg.product);
            cg.passed -= cg.product;
            passing = scaled_norm(layout, cg.passed) / (norm * report.residual);
            given = passing * report.residual <= 0.05 * tolerance;
        }
        const double curvature = core::dot(cg.p, cg.product);
        if (!std::isfinite(curvature) || !std::isfinite(rz)) {
            report.status = SolveStatus::not_finite;
            return report;
        }
        if (!(report.curvature <= curvature / weight)) report.curvature = curvature / weight;
        if (curvature <= 0.0) {
            report.status = SolveStatus::indefinite;
            if (report.iterations == 0) x += cg.z;
            break;
        }
        const double square = detail::advance(layout, rz / curvature, cg, x, cg.r);
        report.residual = std::sqrt(square) / norm;
        exact = false;
        before = rz;
        ++report.iterations;
    }
    if (report.status != SolveStatus::converged) report.residual = relative_residual(system, b, norm, x, cg.r);
    if (report.status == SolveStatus::iteration_limit && report.residual <= tolerance) report.status = SolveStatus::converged;
    if (!std::isfinite(report.residual)) report.status = SolveStatus::not_finite;
    return report;
}

}  // namespace fibrant::solver

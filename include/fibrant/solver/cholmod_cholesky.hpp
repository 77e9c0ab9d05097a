// SPDX-License-Identifier: MIT
#pragma once
/// @file Direct solution with CHOLMOD: a baseline that benchmarks name, off by default. Only this header includes it.

#if !__has_include(<cholmod.h>)
#error "fibrant/solver/cholmod_cholesky.hpp needs <cholmod.h> of SuiteSparse: install it and add its folder to the include path"
#endif

#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <Eigen/CholmodSupport>

#include <algorithm>

namespace fibrant::solver {

/// Supernodal LL^T of the assembled matrix, ordered by METIS where CHOLMOD was built with it, with steps of refinement.
///
/// CHOLMOD says that a matrix is not positive definite and no more: x is then the right-hand side scaled by the diagonal.
/// Curvature reported: 1, or 0 if A is indefinite. To be linked with cholmod.
class CholmodCholesky {
public:
    struct Parameters {
        int refinements = 3;  ///< steps of iterative refinement at most, taken while the tolerance is not met; >= 0
        void validate() const { core::require_at_least("CholmodCholesky.refinements", refinements, 0); }
    };
    CholmodCholesky() : CholmodCholesky(Parameters{}) {}
    explicit CholmodCholesky(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        work_->terms.analyse(system);
        work_->terms.fill(system, work_->a);
        auto& common = work_->factor.cholmod();
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_METIS;
        common.postorder = 1;
        common.print = 0;
        work_->factor.analyzePattern(work_->a);
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system) {
        Work& work = *work_;
        assembly::TermAssembly now;  // contact elements that come to carry force add terms
        now.analyse(system);
        if (!(now == work.terms)) analyse(system);
        work.terms.fill(system, work.a);
        if (!Eigen::Map<const Vector>(work.a.valuePtr(), work.a.nonZeros()).allFinite())
            return work.status = SolveStatus::not_finite;
        work.factor.factorize(work.a);
        return work.status = work.factor.info() == Eigen::Success ? SolveStatus::converged : SolveStatus::indefinite;
    }
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        Work& work = *work_;
        x.setZero(b.size());
        if (work.status == SolveStatus::not_finite || !b.allFinite()) return {};
        const double norm = scaled_norm(system.layout(), b);
        if (norm == 0.0) return {SolveStatus::converged, 0, 0.0, 1.0};
        if (work.status == SolveStatus::indefinite) {
            const Vector diagonal = work.a.diagonal().cwiseAbs();
            x = b.cwiseQuotient(diagonal.cwiseMax(1e-12 * diagonal.maxCoeff()));
            return {SolveStatus::indefinite, 1, relative_residual(system, b, norm, x, work.residual), 0.0};
        }
        SolveReport report{SolveStatus::iteration_limit, 0, 1.0, 1.0};
        Vector best = x;
        work.residual = b;
        for (; report.iterations <= parameters_.refinements && report.residual > tolerance; ++report.iterations) {
            x += work.factor.solve(work.residual);
            const double residual = relative_residual(system, b, norm, x, work.residual);
            if (!(residual < report.residual)) {  // refinement has reached its floor
                x = best;
                break;
            }
            report.residual = residual;
            best = x;
        }
        if (report.residual <= tolerance) report.status = SolveStatus::converged;
        return report;
    }

private:
    struct Work {
        assembly::TermAssembly terms;
        SparseMatrix a;
        Eigen::CholmodSupernodalLLT<SparseMatrix> factor;
        Vector residual;
        SolveStatus status = SolveStatus::not_finite;
    };
    Parameters parameters_;
    Workspace<Work> work_;
};

}  // namespace fibrant::solver

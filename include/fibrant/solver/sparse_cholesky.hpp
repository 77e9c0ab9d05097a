// SPDX-License-Identifier: MIT
#pragma once
/// @file Direct solution with Eigen's sparse Cholesky: for tests and small scenes.

#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/solver/conjugate_gradient.hpp>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// LDL^T of the assembled matrix (simplicial, minimum degree), with a few steps of refinement.
///
/// Exact and simple; beyond some 20,000 unknowns in contact the fill makes it slower by orders of magnitude than the
/// iterative solvers. Pivots <= 0 are replaced by their magnitude, which makes the result a descent direction.
/// Curvature reported: 1 if all pivots are > 0, else the least pivot over the largest.
class SparseCholesky {
public:
    struct Parameters {
        int refinements = 3;  ///< steps of iterative refinement at most, taken while the tolerance is not met; >= 0
        void validate() const { core::require_at_least("SparseCholesky.refinements", refinements, 0); }
    };
    SparseCholesky() : SparseCholesky(Parameters{}) {}
    explicit SparseCholesky(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system);
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system);
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x);

private:
    using Permutation = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;
    static constexpr int tied_limit = 500;  ///< iterations where a system has ties
    struct Work {
        assembly::TermAssembly terms;
        ConjugateGradientVectors vectors;
        SparseMatrix a;
        Permutation order;    // from unknowns to places in the factor
        SparseMatrix sorted;  // lower part, in that order
        Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factor;
        Vector pivots, scale, residual;
        SolveStatus status = SolveStatus::not_finite;
        double curvature = 0.0;
    };

    template <assembly::LinearSystem System>
    void assemble(const System& system) {
        if constexpr (assembly::AssembledSystem<System>) {
            system.assemble(work_->a);
            if (work_->order.size() != work_->a.cols()) find_order(*work_);
            sort(*work_);
        } else {
            // Contact elements that come to carry force add terms; the pattern is that of the system alone, so that the
            // bits do not depend on what was solved before.
            assembly::TermAssembly now;
            now.analyse(system);
            const bool same = now == work_->terms;
            if (!same) work_->terms = std::move(now);
            work_->terms.fill(system, work_->a);
            if (!same) find_order(*work_);
            sort(*work_);
            if (!same) work_->factor.analyzePattern(work_->sorted);
        }
    }
    /// Minimum degree of vectors, not of unknowns: their graph is a ninth of the matrix, and contact changes it often. A
    /// template, so that a program without this solver does not compile it.
    template <class Own>
    static void find_order(Own& work) {
        const SparseMatrix& a = work.a;
        const Index vectors = a.cols() / 3;
        std::vector<int> starts{0}, rows, last(core::at(vectors), -1);
        for (int v = 0; v < vectors; ++v) {
            for (int k = 3 * v; k < 3 * v + 3; ++k)
                for (SparseMatrix::InnerIterator it(a, k); it; ++it) {
                    const int row = static_cast<int>(it.row()) / 3;
                    if (row < v || std::exchange(last[core::at(row)], v) == v) continue;
                    rows.push_back(row);
                }
            std::sort(rows.begin() + starts.back(), rows.end());
            starts.push_back(static_cast<int>(rows.size()));
        }
        const std::vector<double> ones(rows.size(), 1.0);
        const Eigen::Map<const SparseMatrix> graph(vectors, vectors, core::count(rows), starts.data(), rows.data(), ones.data());
        Permutation order;
        Eigen::AMDOrdering<int>()(SparseMatrix(graph).selfadjointView<Eigen::Lower>(), order);
        work.order.resize(a.cols());
        for (int place = 0; place < vectors; ++place)
            for (int c = 0; c < 3; ++c) work.order.indices()[3 * order.indices()[place] + c] = 3 * place + c;
    }
    template <class Own>
    static void sort(Own& work) {
        work.sorted.resize(work.a.rows(), work.a.cols());
        work.sorted.template selfadjointView<Eigen::Lower>() =
            work.a.template selfadjointView<Eigen::Lower>().twistedBy(work.order);
    }

    /// x = L^-T |D|^-1 L^-1 b, or b scaled by the diagonal where there is no factor.
    void descend(const Vector& b, Vector& x) const {
        const Work& work = *work_;
        if (work.pivots.size() == 0) {
            const Vector diagonal = work.a.diagonal();
            const double floor = 1e-12 * most_over(diagonal, work.scale);
            x = b;
            for (Index k = 0; k < x.size(); ++k)
                x[k] /= floor > 0.0 ? std::max(std::abs(diagonal[k]), floor * work.scale[k]) : work.scale[k];
            return;
        }
        x = ordered(b);
        work.factor.matrixL().solveInPlace(x);
        const double least = 1e-14 * most_over(work.pivots, work.scale);
        for (Index k = 0; k < x.size(); ++k) x[k] /= std::max(std::abs(work.pivots[k]), least * work.scale[k]);
        work.factor.matrixU().solveInPlace(x);
        x = plain(x);
    }
    /// A vector in the order of the factor.
    Vector ordered(const Vector& plain) const {
        const auto& order = work_->order.indices();
        Vector values(plain.size());
        for (Index k = 0; k < plain.size(); ++k) values[order[k]] = plain[k];
        return values;
    }
    /// And back.
    Vector plain(const Vector& ordered) const {
        const auto& order = work_->order.indices();
        Vector values(ordered.size());
        for (Index k = 0; k < ordered.size(); ++k) values[k] = ordered[order[k]];
        return values;
    }
    static double most_over(const Vector& values, const Vector& scale) noexcept {
        double most = 0.0;
        for (Index k = 0; k < values.size(); ++k) most = std::max(most, std::abs(values[k]) / scale[k]);
        return most;
    }

    Parameters parameters_;
    Workspace<Work> work_;
};

// Outside of the class: `extern template` then leaves them to the file that has `template`.

template <assembly::LinearSystem System>
void SparseCholesky::analyse(const System& system) {
    if constexpr (assembly::AssembledSystem<System>) work_->order.resize(0);
    assemble(system);
    if constexpr (assembly::AssembledSystem<System>) work_->factor.analyzePattern(work_->sorted);
}

template <assembly::LinearSystem System>
SolveStatus SparseCholesky::prepare(const System& system) {
    Work& work = *work_;
    assemble(system);
    work.pivots.resize(0);
    work.scale.resize(system.layout().unknowns());
    for (Index k = 0; k < work.scale.size(); ++k) work.scale[k] = system.layout().held_stiffness(k / 3);
    if (!Eigen::Map<const Vector>(work.a.valuePtr(), work.a.nonZeros()).allFinite()) {
        return work.status = SolveStatus::not_finite;
    }
    work.factor.factorize(work.sorted);
    work.status = SolveStatus::indefinite;
    work.curvature = 0.0;
    if (work.factor.info() != Eigen::Success) return work.status;  // a pivot is exactly zero
    work.pivots = work.factor.vectorD();
    if (!work.pivots.allFinite()) {
        work.pivots.resize(0);
        return work.status;
    }
    // Measured by what vectors have where they are held: the stiffness of directions has other units than that of positions.
    work.scale = ordered(work.scale);
    double least = work.pivots.size() > 0 ? std::numeric_limits<double>::infinity() : 1.0, most = 0.0;
    for (Index k = 0; k < work.pivots.size(); ++k) {
        const double pivot = work.pivots[k] / work.scale[k];
        least = std::min(least, pivot), most = std::max(most, std::abs(pivot));
    }
    work.curvature = least > 0.0 ? 1.0 : least / most;
    if (least > 0.0) work.status = SolveStatus::converged;
    return work.status;
}

template <assembly::LinearSystem System>
SolveReport SparseCholesky::solve(const System& system, const Vector& b, double tolerance, Vector& x) {
    Work& work = *work_;
    x.setZero(b.size());
    if (work.status == SolveStatus::not_finite || !b.allFinite()) return {};
    const double norm = scaled_norm(system.layout(), b);
    if (norm == 0.0) return {SolveStatus::converged, 0, 0.0, work.curvature};
    SolveReport report{SolveStatus::iteration_limit, 0, 1.0, work.curvature};
    if (!system.layout().ties.empty()) {  // the factor knows their supports only
        const auto precondition = [&](const Vector& r, Vector& z) { descend(r, z); };
        return conjugate_gradient(system, precondition, b, tolerance, tied_limit, work.vectors, x);
    }
    if (work.status == SolveStatus::indefinite) {
        descend(b, x);
        report.iterations = 1;
        report.residual = relative_residual(system, b, norm, x, work.residual);
        report.status = x.allFinite() ? SolveStatus::indefinite : SolveStatus::not_finite;
        return report;
    }
    Vector best = x;
    work.residual = b;
    for (; report.iterations <= parameters_.refinements && report.residual > tolerance; ++report.iterations) {
        x += plain(work.factor.solve(ordered(work.residual)));
        const double residual = relative_residual(system, b, norm, x, work.residual);
        if (!std::isfinite(residual)) return {SolveStatus::not_finite, report.iterations, residual, work.curvature};
        if (report.iterations > 0 && residual >= report.residual) {  // refinement has reached its floor
            x = best;
            break;
        }
        report.residual = residual;
        best = x;
    }
    if (report.residual <= tolerance) report.status = SolveStatus::converged;
    if (b.dot(x) <= 0.0) report.status = SolveStatus::indefinite;
    return report;
}

}  // namespace fibrant::solver

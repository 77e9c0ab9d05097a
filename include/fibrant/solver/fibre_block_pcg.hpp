// SPDX-License-Identifier: MIT
#pragma once
/// @file Conjugate gradients preconditioned with the exact factors of every chain.

#include <fibrant/solver/chain_factors.hpp>
#include <fibrant/solver/conjugate_gradient.hpp>

namespace fibrant::solver {

/// Forms no matrix: products with the system, and a banded factor of every chain, its own part of contacts included.
///
/// Exact (one iteration or two) while nothing touches. The iterations grow with the number and the stiffness of
/// contact elements; TwoLevelPcg needs several times fewer where many fibres touch.
class FibreBlockPcg {
public:
    struct Parameters {
        int iteration_limit = 5000;  ///< > 0
        void validate() const { core::require_at_least("FibreBlockPcg.iteration_limit", iteration_limit, 1); }
    };
    FibreBlockPcg() : FibreBlockPcg(Parameters{}) {}
    explicit FibreBlockPcg(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        work_->factors.analyse(system.layout());
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system);
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x);

private:
    struct Work {
        ChainFactors factors;
        ConjugateGradientVectors vectors;
        SolveStatus status = SolveStatus::not_finite;
    };
    Parameters parameters_;
    Workspace<Work> work_;
};

// Outside of the class: `extern template` then leaves them to the file that has `template`.

template <assembly::LinearSystem System>
SolveStatus FibreBlockPcg::prepare(const System& system) {
    return work_->status = work_->factors.prepare(system);
}

template <assembly::LinearSystem System>
SolveReport FibreBlockPcg::solve(const System& system, const Vector& b, double tolerance, Vector& x) {
    if (work_->status == SolveStatus::not_finite) {
        x.setZero(b.size());
        return {};
    }
    const auto precondition = [&](const Vector& r, Vector& z) { work_->factors.apply(system.layout(), r, z); };
    return conjugate_gradient(system, precondition, b, tolerance, parameters_.iteration_limit, work_->vectors, x);
}

}  // namespace fibrant::solver

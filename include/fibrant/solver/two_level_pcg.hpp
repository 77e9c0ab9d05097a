// SPDX-License-Identifier: MIT
#pragma once
/// @file Conjugate gradients with two levels: exact factors of every chain, and the rigid motions of clusters of chains.

#include <fibrant/solver/chain_factors.hpp>
#include <fibrant/solver/conjugate_gradient.hpp>
#include <fibrant/solver/rigid_coarse_space.hpp>

namespace fibrant::solver {

/// M^-1 = B^-1 + P (P^T A P)^-1 P^T: B the bands of the chains, P a RigidCoarseSpace.
///
/// The factors take the stiff modes of single fibres exactly; what they leave is the bending of neighbours that contact
/// ties together, which the coarse space has. Forms no matrix but P^T A P.
class TwoLevelPcg {
public:
    struct Parameters {
        int fibres_per_cluster = 19;  ///< about, > 0
        int elements_per_station = 2;    ///< along the chains, > 0
        int iteration_limit = 2000;   ///< > 0
        void validate() const {
            core::require_at_least("TwoLevelPcg.fibres_per_cluster", fibres_per_cluster, 1);
            core::require_at_least("TwoLevelPcg.elements_per_station", elements_per_station, 1);
            core::require_at_least("TwoLevelPcg.iteration_limit", iteration_limit, 1);
        }
    };
    TwoLevelPcg() : TwoLevelPcg(Parameters{}) {}
    explicit TwoLevelPcg(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        work_->factors.analyse(system.layout());
        work_->coarse.analyse(system, parameters_.fibres_per_cluster, parameters_.elements_per_station);
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system) {
        Work& work = *work_;
        const scene::DofLayout& layout = system.layout();
        const assembly::HeldProjector held(layout);
        work.coarse.begin(layout);
        work.status = work.factors.prepare(system, [&](Index chain, const Matrix& band) { work.coarse.add_chain(layout, held, chain, band); });
        if (work.status == SolveStatus::not_finite) return work.status;
        const SolveStatus coarse = work.coarse.finish(system);
        if (coarse != SolveStatus::converged) work.status = coarse;
        return work.status;
    }
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        Work& work = *work_;
        if (work.status == SolveStatus::not_finite) {
            x.setZero(b.size());
            return {};
        }
        const auto precondition = [&](const Vector& r, Vector& z) {
            work.factors.apply(system.layout(), r, z);
            work.coarse.add_correction(system.layout(), r, z);
        };
        return conjugate_gradient(system, precondition, b, tolerance, parameters_.iteration_limit, work.vectors, x);
    }

    /// Clusters of the last analysis.
    Index clusters() const { return work_->coarse.clusters(); }
    /// Unknowns of the coarse space.
    Index coarse_unknowns() const { return 6 * work_->coarse.stations(); }

private:
    struct Work {
        ChainFactors factors;
        RigidCoarseSpace coarse;
        ConjugateGradientVectors vectors;
        SolveStatus status = SolveStatus::not_finite;
    };
    Parameters parameters_;
    Workspace<Work> work_;
};

}  // namespace fibrant::solver

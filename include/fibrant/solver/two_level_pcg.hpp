// SPDX-License-Identifier: MIT
#pragma once
/// @file Conjugate gradients with two levels: sweeps over factored chains, and the rigid motions of clusters of chains.

#include <fibrant/solver/chain_sweeps.hpp>
#include <fibrant/solver/conjugate_gradient.hpp>
#include <fibrant/solver/rigid_coarse_space.hpp>
#include <fibrant/solver/stabilised_biconjugate_gradient.hpp>
#include <fibrant/solver/tied_chains.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fibrant::solver {

/// The cycle of ChainSweeps over the factors B of the chains' bands, with Q = P (P^T A P)^-1 P^T, P a RigidCoarseSpace.
///
/// The factors of B take the stiff modes of single fibres exactly; what they leave is the bending of neighbours that contact
/// ties together, which the coarse space has. Forms no matrix but P^T A P. A solve that takes long goes on with a finer
/// space: a quarter of the fibres in a cluster, or, where clusters are single chains, twice the stations. It is formed when
/// first wanted, and kept until the next preparation; every solve begins with the coarser one.
///
/// Between two analyses the coarser space is kept for several systems, as long as solves take no longer with it: forming it costs
/// as much as a loose solve, and contacts that close or open one by one change little of how bundles bend. Conjugate gradients
/// and the product that sweeps pass on are right with any Q. What a solve does depends on those since the last analysis alone.
class TwoLevelPcg {
public:
    struct Parameters {
        int fibres_per_cluster = 19;   ///< about, > 0
        int elements_per_station = 2;  ///< along the chains, > 0
        int refine_after = 300;        ///< iterations before the space is refined, >= 0
        int iteration_limit = 2000;    ///< > 0
        int systems_per_space = 8;     ///< most systems that share a coarse space, > 0; 1: each has its own
        bool unsymmetric = true;       ///< where a system is not symmetric: BiCGStab on all of it, not CG on its symmetric part
        void validate() const {
            core::require_at_least("TwoLevelPcg.fibres_per_cluster", fibres_per_cluster, 1);
            core::require_at_least("TwoLevelPcg.elements_per_station", elements_per_station, 1);
            core::require_at_least("TwoLevelPcg.refine_after", refine_after, 0);
            core::require_at_least("TwoLevelPcg.iteration_limit", iteration_limit, 1);
            core::require_at_least("TwoLevelPcg.systems_per_space", systems_per_space, 1);
        }
    };
    TwoLevelPcg() : TwoLevelPcg(Parameters{}) {}
    explicit TwoLevelPcg(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system);
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system);
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x);

    /// z = M^-1 r with the coarser space, for strategies that have more parts than this.
    template <assembly::LinearSystem System>
    void precondition(const System& system, const Vector& r, Vector& z) {
        apply(system.layout(), work_->coarse, r, z);
    }

    /// From the next solve on so many iterations at most, > 0, and a trial of so many, >= 0: as of `IterationLimit`.
    void limit(int iterations, int trial = 0) { parameters_.iteration_limit = iterations, trial_ = trial; }
    /// Clusters of the last analysis.
    Index clusters() const { return work_->coarse.clusters(); }
    /// Unknowns of the coarse space.
    Index coarse_unknowns() const { return 6 * work_->coarse.stations(); }
    /// Systems since the last analysis that the coarse space was formed for.
    int spaces_formed() const { return work_->formed; }
    /// Unknowns of the finer space; 0 if no solve since the last preparation has wanted it.
    Index fine_unknowns() const { return work_->fine == Fine::ready ? 6 * work_->finer.stations() : 0; }

private:
    struct Cycle {
        TwoLevelPcg* own;
        const scene::DofLayout* layout;
        RigidCoarseSpace<>* const* space;
        void operator()(const Vector& r, Vector& z) const { own->apply(*layout, **space, r, z); }
        bool with_product(const Vector& r, Vector& z, Vector& product) const {
            return own->apply(*layout, **space, r, z, &product);
        }
    };
    enum class Fine : std::uint8_t { none, ready, useless };
    struct Work {
        ChainSweeps chains;
        TiedChains ties;
        RigidCoarseSpace<> coarse, finer;
        Vector forces;  // r as chains that are tied see it
        Fine fine = Fine::none;
        ConjugateGradientVectors vectors;
        BiconjugateVectors biconjugate;
        SolveStatus status = SolveStatus::not_finite;
        // Of the coarse space: systems since the last analysis that it was formed for, systems that have had the present one, the
        // iterations a digit of its first solve, and whether the next system may have it, too.
        int formed = 0, shared_by = 0;
        double first_rate = 0.0;
        bool kept = false;
    };
    /// @return whether there is a product, as ChainSweeps::apply; none of systems with ties
    bool apply(const scene::DofLayout& layout, RigidCoarseSpace<>& space, const Vector& r, Vector& z, Vector* product = nullptr) {
        Work& work = *work_;
        const bool tied = !work.ties.empty();
        if (tied) work.forces = r, work.ties.project_forces(layout, work.forces);
        const auto correct = [&](const Vector& left, Vector& motion) { space.add_correction(layout, left, motion); };
        const bool passed = work.chains.apply(layout, tied ? work.forces : r, z, correct, tied ? nullptr : product);
        if (tied) work.ties.project(layout, z);
        return passed;
    }
    /// After a solve: whether the coarse space is as good as it was for the system that it was formed for.
    void judge(const SolveReport& report) {
        const double slower = 1.3;        // a third more iterations cost what forming it does, by trial on 608 fibres
        const double least_digits = 0.5;  // of a solve that ends at once, which tells little
        Work& work = *work_;
        const double rate = report.iterations / std::max(least_digits, -std::log10(report.residual));
        if (work.shared_by == 1) work.first_rate = rate;
        work.kept = report.status == SolveStatus::converged && rate <= slower * work.first_rate &&
                    work.shared_by < parameters_.systems_per_space;
    }
    /// Forms the finer space of the present values; false if there is none.
    template <assembly::LinearSystem System>
    bool refine(const System& system) {
        Work& work = *work_;
        if (work.fine != Fine::none) return work.fine == Fine::ready;
        work.fine = Fine::useless;
        const int fibres = std::max(1, parameters_.fibres_per_cluster / 4);
        work.finer.analyse(system, fibres, parameters_.elements_per_station);
        if (work.finer.stations() == work.coarse.stations())
            work.finer.analyse(system, fibres, std::max(1, parameters_.elements_per_station / 2));
        if (work.finer.stations() == work.coarse.stations()) return false;
        const scene::DofLayout& layout = system.layout();
        const assembly::HeldProjector held(layout);
        work.finer.begin(layout);
        core::parallel_for(
            core::count(layout.chains),
            [&](Index chain) {
                Matrix band;
                system.chain_band(chain, band);
                work.finer.add_chain(layout, held, chain, band);
            },
            grain(layout, core::count(layout.chains)));
        if (work.finer.finish(system) != SolveStatus::not_finite) work.fine = Fine::ready;
        return work.fine == Fine::ready;
    }

    Parameters parameters_;
    int trial_ = 0;
    Workspace<Work> work_;
};

// Outside of the class: `extern template` then leaves them to the file that has `template`.

template <assembly::LinearSystem System>
void TwoLevelPcg::analyse(const System& system) {
    work_->formed = 0, work_->kept = false;
    work_->chains.analyse(system.layout());
    work_->coarse.analyse(system, parameters_.fibres_per_cluster, parameters_.elements_per_station);
}

template <assembly::LinearSystem System>
SolveStatus TwoLevelPcg::prepare(const System& system) {
    Work& work = *work_;
    const scene::DofLayout& layout = system.layout();
    const assembly::HeldProjector held(layout);
    work.fine = Fine::none;
    const bool formed = !std::exchange(work.kept, false);  // a solve has to say that it may be kept on
    if (formed) ++work.formed, work.shared_by = 0, work.coarse.begin(layout);
    ++work.shared_by;
    work.status = work.chains.prepare(system, [&](Index chain, const Matrix& band) {
        if (formed) work.coarse.add_chain(layout, held, chain, band);
    });
    if (work.status == SolveStatus::not_finite) return work.status;
    work.ties.prepare(layout, [&](const Vector& r, Vector& z) { work.chains.apply_factors(layout, r, z); });
    if (!formed) return work.status;
    const SolveStatus coarse = work.coarse.finish(system);
    if (coarse != SolveStatus::converged) work.status = coarse;
    return work.status;
}

template <assembly::LinearSystem System>
SolveReport TwoLevelPcg::solve(const System& system, const Vector& b, double tolerance, Vector& x) {
    Work& work = *work_;
    if (work.status == SolveStatus::not_finite) {
        x.setZero(b.size());
        return {};
    }
    RigidCoarseSpace<>* space = &work.coarse;
    const Cycle precondition{this, &system.layout(), &space};
    const IterationLimit limit(parameters_.iteration_limit, trial_);
    if constexpr (UnsymmetricSystem<System>)
        if (parameters_.unsymmetric && system.unsymmetric())
            return stabilised_biconjugate_gradient(system, precondition, b, tolerance, limit, work.biconjugate, x);
    const auto renewed = [&](int iterations) {
        if (iterations != parameters_.refine_after || space == &work.finer || !refine(system)) return false;
        space = &work.finer;
        return true;
    };
    const SolveReport report = conjugate_gradient(system, precondition, b, tolerance, limit, work.vectors, x, renewed);
    judge(report);
    return report;
}

}  // namespace fibrant::solver

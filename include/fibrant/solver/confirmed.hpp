// SPDX-License-Identifier: MIT
#pragma once
/// @file An iterative strategy whose verdict that a system is indefinite is confirmed by a factorisation.

#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <utility>

namespace fibrant::solver {

/// Conjugate gradients say that a system is indefinite where rounding makes their preconditioner so, as that of stiff contacts
/// between a few short fibres: no shift of the tangent helps then. A small system is then factored in double precision, and that
/// says what it is. A larger one is from a number of such verdicts in a row on, and until the next analysis: what it does depends
/// on what was solved since the last one.
///
/// What is said of a larger one before it is solved, that it is indefinite or has no numbers, is a doubt, for blocks of
/// preconditioners are of single precision: it is factored at once where that costs no more than a long iteration, and else
/// solved all the same. Conjugate gradients meet a curvature that is not positive in double precision, or none.
template <class Iterative>
class Confirmed {
public:
    static constexpr bool reads_whole_bands = ReadsWholeBands<Iterative>;
    struct Parameters {
        typename Iterative::Parameters iterative{};
        Index small = 6000;  ///< unknowns up to which a factorisation costs no more than the iteration, >= 0
        int patience =
            6;  ///< verdicts in a row before a larger system is factored, >= 1: Newton's shifts mend what is truly indefinite
        double largest_fill = 2.5e8;  ///< entries of a factor that is allowed (8 bytes each), >= 0
        double moderate_fill = 2e7;   ///< up to which a doubt is enough: 16,000 unknowns have 7e6 where fibres cross, >= 0
        void validate() const {
            iterative.validate();
            core::require_at_least("Confirmed.small", small, 0);
            core::require_at_least("Confirmed.patience", patience, 1);
            core::require_not_negative("Confirmed.largest_fill", largest_fill);
            core::require_not_negative("Confirmed.moderate_fill", moderate_fill);
        }
    };
    Confirmed() : Confirmed(Parameters{}) {}
    explicit Confirmed(const Parameters& parameters)
        : parameters_{core::validated(parameters)}, iterative_{parameters.iterative} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        iterative_.analyse(system);
        verdicts_ = 0, factored_ = heavy_ = ordered_ = false;
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system) {
        if (small(system)) factored_ = false;
        if (factored_)
            if (const SolveStatus status = factor_.prepare(system); status != SolveStatus::not_finite) return status;
        factored_ = false;  // it has broken down, as it may where a system is indefinite
        const SolveStatus status = iterative_.prepare(system);
        if (status == SolveStatus::converged) return status;
        const double most =
            small(system) ? parameters_.largest_fill : std::min(parameters_.moderate_fill, parameters_.largest_fill);
        heavy_ = heavy_ || most == 0.0 || !analysed(system, most);
        if (heavy_) return status == SolveStatus::indefinite ? SolveStatus::converged : status;
        // A verdict that holds is no doubt: the iteration goes on with the next tangent.
        const SolveStatus factored = factor_.prepare(system);
        factored_ = factored == SolveStatus::converged;
        return factored == SolveStatus::not_finite ? status : factored;
    }
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        if (factored_) return factor_.solve(system, b, tolerance, x);
        SolveReport report = iterative_.solve(system, b, tolerance, x);
        if (report.status != SolveStatus::indefinite) verdicts_ = 0;
        if (report.status != SolveStatus::indefinite || !factor_instead(system)) return report;
        const SolveStatus status = factor_.prepare(system);
        if (status != SolveStatus::not_finite) report = factor_.solve(system, b, tolerance, x);
        if (status == SolveStatus::indefinite) report.status = status;
        return report;
    }
    /// The present system is factored.
    bool factored() const noexcept { return factored_; }
    /// Whose verdicts are confirmed.
    const Iterative& iterative() const noexcept { return iterative_; }
    Iterative& iterative() noexcept { return iterative_; }

private:
    template <class System>
    bool small(const System& system) const noexcept {
        return system.layout().unknowns() <= parameters_.small;
    }
    template <class System>
    bool factor_instead(const System& system) {
        return (small(system) || ++verdicts_ >= parameters_.patience) && analysed(system, parameters_.largest_fill);
    }
    /// @returns whether the system has a factor that is no larger than that
    template <class System>
    bool analysed(const System& system, double largest_fill) {
        if (!ordered_) factor_.analyse(system), ordered_ = true;
        return factored_ = static_cast<double>(factor_.fill()) <= largest_fill;
    }

    Parameters parameters_;
    Iterative iterative_;
    DoubleBlockCholesky factor_;
    int verdicts_ = 0;
    bool factored_ = false, heavy_ = false;  // the factor of a doubt is too large
    bool ordered_ = false;                   // the factor has been analysed
};

}  // namespace fibrant::solver

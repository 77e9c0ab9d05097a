// SPDX-License-Identifier: MIT
#pragma once
/// @file The cheapest strategy that does it: fibre blocks, two levels, and a factor of the whole when iterations fail.

#include <fibrant/solver/confirmed.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <optional>
#include <span>
#include <sstream>
#include <string>

namespace fibrant::solver {

/// What AutomaticSolver has used, and why.
struct StrategyUse {
    Index fibre_block_pcg = 0, two_level_pcg = 0, float_block_cholesky = 0;  ///< solves that each was the last to try
    Index fallbacks = 0;                                                     ///< solves that more than one tried
    std::string last_fallback;  ///< what the last of these was for, a sentence; empty if there was none

    /// All of it in words.
    std::string text() const {
        std::string words;
        const auto add = [&](const char* name, Index solves) {
            if (solves > 0) words += (words.empty() ? "" : ", ") + std::string(name) + " " + std::to_string(solves);
        };
        add("FibreBlockPcg", fibre_block_pcg), add("TwoLevelPcg", two_level_pcg), add("FloatBlockCholesky", float_block_cholesky);
        words = words.empty() ? "no solves" : "solves by " + words;
        if (!last_fallback.empty())
            words += "; " + std::to_string(fallbacks) + " after another one had failed, the last: " + last_fallback;
        return words;
    }
};

/// Number of terms that couple chains; a system that knows it says so with couplings().
template <assembly::LinearSystem System>
Index count_couplings(const System& system) {
    if constexpr (requires {
                      { system.couplings() } -> std::convertible_to<Index>;
                  }) {
        return system.couplings();
    } else {
        struct Count {
            assembly::VectorPlaces places;
            Index couplings = 0;
            void add(std::span<const Index> vectors) {
                for (const Index v : vectors) {
                    if (places.chain(v) == places.chain(vectors.front())) continue;
                    ++couplings;
                    return;
                }
            }
            void point(const assembly::PointTerm& term) { add(term.vectors); }
            void dense(const assembly::DenseTerm& term) { add(term.vectors); }
        } count{assembly::VectorPlaces(system.layout())};
        system.visit(count);
        return count.couplings;
    }
}

/// Starts with FibreBlockPcg where few terms couple the chains and with TwoLevelPcg elsewhere; where that reaches its
/// limit, goes on to the next, in the end FloatBlockCholesky. What is not wanted is not prepared.
///
/// Systems that follow one another are alike: where iterations have failed, the systems until the next analysis begin with what
/// took over, so a hard one pays for iterations in vain once. Where a factor would be larger than allowed, two levels may take as
/// long as they do alone, unless they have come to nothing at their first limit: that is for Newton's method to shift. What a
/// strategy calls indefinite is Confirmed first, and then reported at once: that is for Newton's iteration to mend.
class AutomaticSolver {
public:
    struct Parameters {
        double few_couplings = 1.0;   ///< couplings over chains up to which fibre blocks come first, >= 0 [1]
        int fibre_block_limit = 200;  ///< iterations before two levels are taken, > 0
        int two_level_limit = 300;    ///< iterations before the whole is factored, which costs about as much, > 0
        int longest = 2000;           ///< iterations of two levels where the factor is larger than allowed, >= two_level_limit
        double largest_fill = 2.5e8;  ///< entries of a factor that is allowed (4 bytes each), >= 0
        void validate() const {
            core::require_not_negative("AutomaticSolver.few_couplings", few_couplings);
            core::require_at_least("AutomaticSolver.fibre_block_limit", fibre_block_limit, 1);
            core::require_at_least("AutomaticSolver.two_level_limit", two_level_limit, 1);
            core::require_at_least("AutomaticSolver.longest", longest, two_level_limit);
            core::require_not_negative("AutomaticSolver.largest_fill", largest_fill);
        }
    };
    AutomaticSolver() : AutomaticSolver(Parameters{}) {}
    explicit AutomaticSolver(const Parameters& parameters)
        : parameters_{core::validated(parameters)},
          fibres_{{.iterative = {.iteration_limit = parameters.fibre_block_limit},
                   .largest_fill = parameters.largest_fill,
                   .moderate_fill = 0.0}},
          levels_{{.largest_fill = parameters.largest_fill, .moderate_fill = 0.0}},  // no doubt is factored: what fails is
          factor_{{.largest_fill = parameters.largest_fill}} {}

    template <assembly::LinearSystem System>
    void analyse(const System& system) {
        fibres_.analyse(system);
        levels_.analyse(system);
        prepared_.fill(false);
        levels_.iterative().limit(parameters_.two_level_limit);
        proven_ = 0, too_large_ = false;
    }
    template <assembly::LinearSystem System>
    SolveStatus prepare(const System& system) {
        prepared_.fill(false);
        const double couplings = static_cast<double>(count_couplings(system));
        const std::size_t cheapest =
            couplings <= parameters_.few_couplings * static_cast<double>(core::count(system.layout().chains)) ? 0 : 1;
        first_ = std::max(cheapest, proven_);
        return status_ = prepare_strategy(first_, system);
    }
    template <assembly::LinearSystem System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        if (status_ == SolveStatus::not_finite) {
            x.setZero(b.size());
            return {};
        }
        int iterations = 0;
        for (std::size_t strategy = first_;;) {
            SolveReport report = with(strategy, [&](auto& solver) { return solver.solve(system, b, tolerance, x); });
            iterations = report.iterations += iterations;
            const std::optional<std::size_t> next = strategy < 2 && report.status == SolveStatus::iteration_limit
                                                        ? after(strategy, system, report, tolerance)
                                                        : std::nullopt;
            if (!next) {
                ++*std::array{&use_.fibre_block_pcg, &use_.two_level_pcg, &use_.float_block_cholesky}[strategy];
                if (strategy != first_) ++use_.fallbacks;
                proven_ = std::max(proven_, strategy);
                return report;
            }
            strategy = *next;
        }
    }

    /// Since the solver was made.
    const StrategyUse& use() const noexcept { return use_; }
    /// The same in words, for the report of a run.
    std::string account() const { return "automatic: " + use_.text(); }

private:
    template <class Body>
    auto with(std::size_t strategy, const Body& body) {
        return strategy == 0 ? body(fibres_) : strategy == 1 ? body(levels_) : body(factor_);
    }
    template <class System>
    SolveStatus prepare_strategy(std::size_t strategy, const System& system) {
        return with(strategy, [&](auto& solver) {
            prepared_[strategy] = true;
            return solver.prepare(system);
        });
    }
    /// Prepares what goes on where a strategy has reached its limit; none if nothing could do better.
    template <class System>
    std::optional<std::size_t> after(std::size_t strategy, const System& system, const SolveReport& report, double tolerance) {
        static constexpr std::array names{"FibreBlockPcg", "TwoLevelPcg"};
        std::ostringstream text;
        text.precision(1);
        text << std::scientific << names[strategy] << " reached a residual of " << report.residual << " in " << report.iterations
             << " iterations, and " << tolerance << " was asked for";
        use_.last_fallback = text.str();
        const std::size_t next = strategy + 1;
        if (prepared_[next]) return next;
        if (strategy == 1) {
            const bool known = too_large_;
            if (!known) factor_.analyse(system);
            too_large_ = known || static_cast<double>(factor_.iterative().fill()) > parameters_.largest_fill;
            if (too_large_) {
                use_.last_fallback += ", but the factor of the whole would be larger than allowed";
                if (known) return std::nullopt;
                levels_.iterative().limit(parameters_.longest, parameters_.two_level_limit);
                if (report.residual >= useful_residual) return std::nullopt;
                return strategy;  // once more, for as long as it takes
            }
        }
        if (prepare_strategy(next, system) == SolveStatus::not_finite) return std::nullopt;
        return next;
    }

    Parameters parameters_;
    Confirmed<FibreBlockPcg> fibres_;
    Confirmed<TwoLevelPcg> levels_;
    Confirmed<FloatBlockCholesky> factor_;
    std::array<bool, 3> prepared_{};
    std::size_t first_ = 1, proven_ = 0;  // the latter since the last analysis
    bool too_large_ = false;              // the factor of the whole is
    SolveStatus status_ = SolveStatus::not_finite;
    StrategyUse use_;
};

}  // namespace fibrant::solver

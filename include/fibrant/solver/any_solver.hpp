// SPDX-License-Identifier: MIT
#pragma once
/// @file A linear solver chosen when the program runs: by a command line, a scene file or a benchmark.

#include <fibrant/solver/automatic_solver.hpp>
#include <fibrant/solver/confirmed.hpp>
#include <fibrant/solver/one_of.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <array>
#include <string>
#include <variant>

namespace fibrant::solver {

/// One of the strategies. What blocks of single precision say is a doubt, whoever asks them.
class AnySolver : public OneOf<Confirmed<TwoLevelPcg>, AutomaticSolver, Confirmed<FibreBlockPcg>, Confirmed<FloatBlockCholesky>,
                               DoubleBlockCholesky, SparseCholesky> {
public:
    static constexpr std::array strategies{
        "automatic", "two_level_pcg", "fibre_block_pcg", "float_block_cholesky", "double_block_cholesky", "sparse_cholesky"};
    struct Parameters {
        std::string strategy = "two_level_pcg";  ///< one of `AnySolver::strategies`
        void validate() const {
            if (std::find(strategies.begin(), strategies.end(), strategy) != strategies.end()) return;
            std::string names;
            for (const char* name : strategies) names += (names.empty() ? "" : ", ") + std::string(name);
            core::refuse("AnySolver.strategy", "\"" + strategy + "\"", "one of " + names);
        }
    };
    AnySolver() : AnySolver(Parameters{}) {}
    explicit AnySolver(const Parameters& parameters)
        : OneOf{make(core::validated(parameters).strategy)}, name_{parameters.strategy} {}

    /// What the automatic strategy has used and why; null if another one was chosen.
    const StrategyUse* use() const noexcept {
        const auto* automatic = std::get_if<AutomaticSolver>(&strategy_);
        return automatic != nullptr ? &automatic->use() : nullptr;
    }
    /// Which strategy it is, and what the automatic one has used and why.
    std::string account() const {
        const auto* automatic = std::get_if<AutomaticSolver>(&strategy_);
        return automatic != nullptr ? automatic->account() : name_;
    }

private:
    static Strategy make(const std::string& name) {
        if (name == "automatic") return AutomaticSolver();
        if (name == "fibre_block_pcg") return Confirmed<FibreBlockPcg>();
        if (name == "float_block_cholesky") return Confirmed<FloatBlockCholesky>();
        if (name == "double_block_cholesky") return DoubleBlockCholesky();
        if (name == "sparse_cholesky") return SparseCholesky();
        return Confirmed<TwoLevelPcg>();
    }
    std::string name_;
};

}  // namespace fibrant::solver

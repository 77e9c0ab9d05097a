// SPDX-License-Identifier: MIT
#pragma once
/// @file A linear solver chosen when the program runs: by a command line, a scene file or a benchmark.

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <string>
#include <utility>
#include <variant>

namespace fibrant::solver {

/// One of the strategies, dispatched once a call.
class AnySolver {
public:
    struct Parameters {
        std::string strategy = "two_level_pcg";  ///< two_level_pcg, fibre_block_pcg or sparse_cholesky
        void validate() const {
            if (strategy != "two_level_pcg" && strategy != "fibre_block_pcg" && strategy != "sparse_cholesky")
                core::refuse("AnySolver.strategy", "\"" + strategy + "\"", "two_level_pcg, fibre_block_pcg or sparse_cholesky");
        }
    };
    AnySolver() : AnySolver(Parameters{}) {}
    explicit AnySolver(const Parameters& parameters) : strategy_{make(core::validated(parameters).strategy)} {}

    template <class System>
    void analyse(const System& system) {
        std::visit([&](auto& solver) { solver.analyse(system); }, strategy_);
    }
    template <class System>
    SolveStatus prepare(const System& system) {
        return std::visit([&](auto& solver) { return solver.prepare(system); }, strategy_);
    }
    template <class System>
    SolveReport solve(const System& system, const Vector& b, double tolerance, Vector& x) {
        return std::visit([&](auto& solver) { return solver.solve(system, b, tolerance, x); }, strategy_);
    }

private:
    using Strategy = std::variant<TwoLevelPcg, FibreBlockPcg, SparseCholesky>;
    static Strategy make(const std::string& name) {
        if (name == "fibre_block_pcg") return FibreBlockPcg();
        if (name == "sparse_cholesky") return SparseCholesky();
        return TwoLevelPcg();
    }
    Strategy strategy_;
};

}  // namespace fibrant::solver

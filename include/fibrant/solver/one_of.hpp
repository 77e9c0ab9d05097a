// SPDX-License-Identifier: MIT
#pragma once
/// @file Strategies of which one is chosen when a program runs.

#include <fibrant/solver/linear_solver.hpp>

#include <utility>
#include <variant>

namespace fibrant::solver {

/// One of several strategies, dispatched once a call. What derives from it names them.
template <class... Strategies>
class OneOf {
public:
    using Strategy = std::variant<Strategies...>;
    static constexpr bool reads_whole_bands = (ReadsWholeBands<Strategies> || ...);
    explicit OneOf(Strategy strategy) : strategy_{std::move(strategy)} {}

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

protected:
    Strategy strategy_;
};

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#include <near.hpp>

#include "refusal.hpp"
#include "solver/linear_solver_contract.hpp"

#include <fibrant/solver/any_solver.hpp>

using namespace fibrant;

namespace automatic_solver_test {

// Chains in contact: the second of the systems that every solver solves.
test::SyntheticSystem touching() { return test::solvable_systems()[1]; }

TEST_CASE("the automatic strategy owes what every solver does, however soon it falls back") {
    test::check_linear_solver(solver::AutomaticSolver{});
    test::check_linear_solver(solver::AutomaticSolver{{.few_couplings = 1e9, .fibre_block_limit = 2, .two_level_limit = 3}});
    test::check_linear_solver(solver::AutomaticSolver{{.few_couplings = 0.0, .two_level_limit = 2}});
}

TEST_CASE("fibres that hardly touch are solved one by one, fibres that do with two levels") {
    const test::SyntheticSystem many = touching();
    test::SyntheticSystem few = many;
    few.points.resize(5);
    few.finish();
    CHECK(solver::count_couplings(few) <= 5);
    CHECK(solver::count_couplings(many) > core::count(many.layout().chains));
    const Vector b = test::random_load(many.layout(), 1);
    Vector x;
    solver::AutomaticSolver solver;
    test::solve(solver, few, b, 1e-6, x);
    CHECK(solver.use().fibre_block_pcg == 1);
    test::solve(solver, many, b, 1e-6, x);
    CHECK(solver.use().two_level_pcg == 1);
    CHECK(solver.use().fallbacks == 0);
    CHECK(solver.use().last_fallback.empty());
}

TEST_CASE("a strategy that reaches its limit hands over to the next, and what was done and why is told") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::AutomaticSolver solver{{.few_couplings = 1e9, .fibre_block_limit = 2, .two_level_limit = 3}};
    const solver::SolveReport report = test::solve(solver, system, b, 1e-9, x);
    CHECK(report.status == solver::SolveStatus::converged);
    CHECK(report.iterations > 5);  // all of them are counted
    CHECK(test::residual_of(system, b, x) < 1.1e-9);
    CHECK(solver.use().float_block_cholesky == 1);
    CHECK(solver.use().fallbacks == 1);
    CHECK(solver.use().last_fallback.starts_with("TwoLevelPcg reached a residual of "));
    CHECK(solver.use().last_fallback.ends_with(" in 5 iterations, and 1.0e-09 was asked for"));
    CHECK(solver.account() ==
          "automatic: solves by FloatBlockCholesky 1; 1 after another one had failed, the last: " + solver.use().last_fallback);
    solver.solve(test::least(system), b, 1e-9, x);
    CHECK(solver.use().float_block_cholesky == 2);
}

TEST_CASE("systems after a hard one begin with what took over, until the next analysis") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::AutomaticSolver solver{{.few_couplings = 0.0, .two_level_limit = 3}};
    CHECK(test::solve(solver, system, b, 1e-9, x).iterations > 3);
    solver.prepare(test::least(system));
    CHECK(solver.solve(test::least(system), b, 1e-9, x).iterations <= 3);  // nothing in vain
    CHECK(test::residual_of(system, b, x) < 1.1e-9);
    CHECK(solver.use().fallbacks == 1);
    CHECK(test::solve(solver, system, b, 1e-9, x).iterations > 3);
    CHECK(solver.use().fallbacks == 2);
}

TEST_CASE("no factor is made that is larger than allowed: two levels go on as long as they may, and the best is returned") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::AutomaticSolver patient{{.few_couplings = 0.0, .two_level_limit = 3, .largest_fill = 10.0}};
    CHECK(test::solve(patient, system, b, 1e-9, x).status == solver::SolveStatus::converged);
    solver::AutomaticSolver solver{{.few_couplings = 0.0, .two_level_limit = 3, .longest = 4, .largest_fill = 10.0}};
    const solver::SolveReport report = test::solve(solver, system, b, 1e-9, x);
    CHECK(report.status == solver::SolveStatus::iteration_limit);
    CHECK(report.iterations == 3 + 4);
    CHECK(report.residual == test::near(test::residual_of(system, b, x), 1e-6));
    CHECK(solver.use().two_level_pcg == 1);
    CHECK(solver.use().last_fallback.ends_with("larger than allowed"));
}

TEST_CASE("what has come to nothing at its first limit is given up there, in each solve, for Newton's method to shift") {
    // Contacts 1e6 times as stiff as fibres: one iteration leaves nine tenths of the residual.
    test::SyntheticSystem system = touching();
    for (auto& point : system.points) point.stiffness *= 1e6;
    system.finish();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::AutomaticSolver solver{{.few_couplings = 0.0, .two_level_limit = 1, .largest_fill = 10.0}};
    solver.analyse(system);
    solver.prepare(system);
    for (int solve = 0; solve < 3; ++solve) {
        const solver::SolveReport report = solver.solve(system, b, 1e-9, x);
        CHECK(report.status == solver::SolveStatus::iteration_limit);
        CHECK(report.iterations == 1);
        CHECK(report.residual >= solver::useful_residual);
    }
    // What converges, if slowly, is not: with a trial it takes the iterations that it takes without.
    const test::SyntheticSystem easy = touching();
    solver::TwoLevelPcg with, without;
    with.limit(2000, 5);
    const solver::SolveReport tried = test::solve(with, easy, b, 1e-9, x), untried = test::solve(without, easy, b, 1e-9, x);
    CHECK(tried.status == solver::SolveStatus::converged);
    CHECK(tried.iterations > 5);
    CHECK(tried.iterations == untried.iterations);
}

TEST_CASE("any strategy can be chosen by name, and a name that means none is refused") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    for (const char* name : solver::AnySolver::strategies) {
        CAPTURE(name);
        Vector x;
        solver::AnySolver solver{{.strategy = name}};
        CHECK(test::solve(solver, system, b, 1e-8, x).status == solver::SolveStatus::converged);
        CHECK(test::residual_of(system, b, x) < 1.1e-8);
        CHECK((solver.use() != nullptr) == (std::string(name) == "automatic"));
    }
    CHECK(test::refusal([] { solver::AnySolver{{.strategy = "lu"}}; }) ==
          "AnySolver.strategy = \"lu\", but it must be one of automatic, two_level_pcg, fibre_block_pcg, "
          "float_block_cholesky, double_block_cholesky, sparse_cholesky");
}

TEST_CASE("what single precision calls indefinite, or finds no numbers for, is solved all the same: a doubt is no verdict") {
    const auto told = [](auto solver, const test::SyntheticSystem& system) {
        solver.analyse(test::least(system));
        return solver.prepare(test::least(system));
    };
    // Beyond what a float tells from the chains' own stiffness of 1: a pivot is negative, or infinite.
    for (const auto& [factor, doubt] :
         {std::pair{3e7, solver::SolveStatus::indefinite}, std::pair{3e8, solver::SolveStatus::not_finite}}) {
        test::SyntheticSystem stiff = touching();
        for (auto& point : stiff.points) point.stiffness *= factor;
        stiff.finish();
        CHECK(told(solver::FloatBlockCholesky{}, stiff) == doubt);
        const Vector b = test::random_load(stiff.layout(), 1);
        for (const std::string name : {"automatic", "float_block_cholesky"}) {
            CAPTURE(name);
            solver::AnySolver solver{{.strategy = name}};
            Vector x;
            CHECK(told(solver, stiff) == solver::SolveStatus::converged);
            CHECK(test::solve(solver, stiff, b, 1e-4, x).status == solver::SolveStatus::converged);
            CHECK(test::residual_of(stiff, b, x) < 1.1e-4);
        }
    }
}

TEST_CASE("a verdict that double precision confirms is no doubt: the next system is solved by the strategy itself") {
    test::SyntheticSystem indefinite = touching();
    for (auto& point : indefinite.points) point.stiffness *= -1e3;
    indefinite.finish();
    const test::SyntheticSystem definite = touching();
    solver::Confirmed<solver::FloatBlockCholesky> solver{{.small = 0}};
    solver.analyse(test::least(indefinite));
    CHECK(solver.prepare(test::least(indefinite)) == solver::SolveStatus::indefinite);
    CHECK(solver.prepare(test::least(definite)) == solver::SolveStatus::converged);
    CHECK(!solver.factored());
}

TEST_CASE("parameters of the automatic strategy that mean nothing are refused by name") {
    using Solver = solver::AutomaticSolver;
    CHECK(test::refusal([] { Solver{{.few_couplings = -1.0}}; }).starts_with("AutomaticSolver.few_couplings = -1"));
    CHECK(test::refusal([] { Solver{{.fibre_block_limit = 0}}; }).starts_with("AutomaticSolver.fibre_block_limit = 0"));
    CHECK(test::refusal([] { Solver{{.two_level_limit = 0}}; }).starts_with("AutomaticSolver.two_level_limit = 0"));
    CHECK(test::refusal([] { Solver{{.longest = 299}}; }).starts_with("AutomaticSolver.longest = 299, but it must be >= 300"));
    CHECK(test::refusal([] { Solver{{.largest_fill = -1.0}}; }).starts_with("AutomaticSolver.largest_fill = -1"));
}

// Says of every system that it is indefinite, as conjugate gradients do where rounding spoils their preconditioner.
struct Doubting {
    struct Parameters {
        void validate() const {}
    };
    Doubting() = default;
    explicit Doubting(const Parameters&) {}
    void analyse(const auto&) {}
    solver::SolveStatus prepare(const auto&) { return solver::SolveStatus::converged; }
    solver::SolveReport solve(const auto&, const Vector& b, double, Vector& x) {
        x = b;
        return {solver::SolveStatus::indefinite, 0, 1.0, 0.0};
    }
};

// Says so before it solves, as blocks of single precision do, and solves it all the same.
struct Prejudiced : solver::TwoLevelPcg {
    using solver::TwoLevelPcg::TwoLevelPcg;
    solver::SolveStatus prepare(const auto& system) {
        solver::TwoLevelPcg::prepare(system);
        return solver::SolveStatus::indefinite;
    }
};

TEST_CASE("what is called indefinite before it is solved is solved, unshifted: factored at once where that costs little") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    for (const double moderate : {0.0, 2e7}) {
        solver::Confirmed<Prejudiced> large{{.small = 0, .patience = 3, .moderate_fill = moderate}};
        large.analyse(test::least(system));
        CHECK(large.prepare(test::least(system)) == solver::SolveStatus::converged);
        CHECK(large.solve(test::least(system), b, 1e-9, x).status == solver::SolveStatus::converged);
        CHECK(test::residual_of(system, b, x) < 1.1e-9);
        CHECK(large.factored() == (moderate > 0.0));
    }
}

TEST_CASE("what iterations call indefinite is factored: it is solved if it is not") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::Confirmed<Doubting> small;
    CHECK(test::solve(small, system, b, 1e-9, x).status == solver::SolveStatus::converged);
    CHECK(test::residual_of(system, b, x) < 1e-9);
    // A larger one is shifted first, by whoever solves it.
    solver::Confirmed<Doubting> large{{.small = 0, .patience = 3}};
    CHECK(test::solve(large, system, b, 1e-9, x).status == solver::SolveStatus::indefinite);
    CHECK(large.solve(test::least(system), b, 1e-9, x).status == solver::SolveStatus::indefinite);
    CHECK(large.solve(test::least(system), b, 1e-9, x).status == solver::SolveStatus::converged);
    CHECK(test::residual_of(system, b, x) < 1e-9);
    large.analyse(test::least(system));
    CHECK(!large.factored());
    solver::Confirmed<Doubting> none{{.largest_fill = 10.0}};  // no factor that is larger than that
    CHECK(test::solve(none, system, b, 1e-9, x).status == solver::SolveStatus::indefinite);
    test::check_linear_solver(solver::Confirmed<solver::TwoLevelPcg>{});
}

// Says so of two systems in three.
struct Moody : Doubting {
    using Doubting::Doubting;
    int solves = 0;
    solver::SolveReport solve(const auto&, const Vector& b, double, Vector& x) {
        x = b;
        return {++solves % 3 == 0 ? solver::SolveStatus::converged : solver::SolveStatus::indefinite, 0, 1.0, 0.0};
    }
};

TEST_CASE("verdicts are counted in a row: one that is solved in between begins anew") {
    const test::SyntheticSystem system = touching();
    const Vector b = test::random_load(system.layout(), 1);
    Vector x;
    solver::Confirmed<Moody> moody{{.small = 0, .patience = 3}};
    moody.analyse(test::least(system));
    REQUIRE(moody.prepare(test::least(system)) == solver::SolveStatus::converged);
    for (int k = 0; k < 9; ++k) {
        moody.solve(test::least(system), b, 1e-9, x);
        CHECK_FALSE(moody.factored());
    }
}

}  // namespace automatic_solver_test

// SPDX-License-Identifier: MIT
#include "solver/linear_solver_contract.hpp"

#include "refusal.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

using namespace fibrant;

namespace linear_solver_test {

// The least system: what the contract asks for, and nothing else.
class LeastSystem {
public:
    explicit LeastSystem(const test::SyntheticSystem& system) : system_{&system} {}
    const scene::DofLayout& layout() const { return system_->layout(); }
    void apply(const Vector& x, Vector& y) const { system_->apply(x, y); }
    void node_blocks(Index chain, Matrix& blocks) const { system_->node_blocks(chain, blocks); }
    void chain_band(Index chain, Matrix& blocks) const { system_->chain_band(chain, blocks); }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        system_->visit(visitor);
    }

protected:
    const test::SyntheticSystem* system_;
};
static_assert(assembly::LinearSystem<LeastSystem>);
static_assert(!assembly::AssembledSystem<LeastSystem>);

class FormedSystem : public LeastSystem {
public:
    using LeastSystem::LeastSystem;
    void assemble(SparseMatrix& a) const { assembly::assemble_from_terms(*system_, a); }
};
static_assert(assembly::AssembledSystem<FormedSystem>);

// The least solver: diagonal scaling, one step.
struct LeastSolver {
    using Parameters = core::NoParameters;
    explicit LeastSolver(const Parameters& = {}) {}
    template <assembly::LinearSystem System>
    void analyse(const System&) {}
    template <assembly::LinearSystem System>
    solver::SolveStatus prepare(const System&) {
        return solver::SolveStatus::converged;
    }
    template <assembly::LinearSystem System>
    solver::SolveReport solve(const System&, const Vector& b, double, Vector& x) {
        x = b;
        return {};
    }
};
static_assert(solver::LinearSolver<LeastSolver, LeastSystem>);
static_assert(!solver::LinearSolver<LeastSolver, scene::DofLayout>);  // not a system

struct SolverWithoutPreparation {
    using Parameters = core::NoParameters;
    explicit SolverWithoutPreparation(const Parameters& = {}) {}
    void analyse(const LeastSystem&) {}
    solver::SolveReport solve(const LeastSystem&, const Vector&, double, Vector&) { return {}; }
};
static_assert(!solver::LinearSolver<SolverWithoutPreparation, LeastSystem>);

TEST_CASE_TEMPLATE("a solver takes the least system for what it is", Solver, solver::SparseCholesky, solver::TwoLevelPcg,
                   solver::FibreBlockPcg, solver::FloatBlockCholesky) {
    static_assert(solver::LinearSolver<Solver, LeastSystem>);
    const test::SyntheticSystem system = test::solvable_systems()[1];
    const Vector b = test::random_load(system.layout(), 1);
    Vector x, y;
    Solver solver;
    test::solve(solver, system, b, 1e-8, x);
    const auto run = [&](const auto& other) {
        solver.analyse(other);
        solver.prepare(other);
        solver.solve(other, b, 1e-8, y);
        CHECK(x == y);  // the same numbers in the same order
    };
    run(LeastSystem(system));
    run(FormedSystem(system));
}

TEST_CASE_TEMPLATE("a solver reaches the solution or says why not, with the same bits always", Solver, solver::SparseCholesky,
                   solver::TwoLevelPcg, solver::FibreBlockPcg, solver::FloatBlockCholesky, solver::DoubleBlockCholesky) {
    test::check_linear_solver(Solver{});
}

TEST_CASE("parameters that mean nothing are refused by name") {
    CHECK(test::refusal([] { solver::SparseCholesky{{.refinements = -1}}; }).starts_with("SparseCholesky.refinements = -1"));
    CHECK(test::refusal([] { solver::FibreBlockPcg{{.iteration_limit = 0}}; }).starts_with("FibreBlockPcg.iteration_limit = 0"));
}

}  // namespace linear_solver_test

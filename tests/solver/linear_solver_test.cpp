// SPDX-License-Identifier: MIT
#include "solver/linear_solver_contract.hpp"

#include "refusal.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

using namespace fibrant;

TEST_CASE_TEMPLATE("a solver reaches the solution or says why not, with the same bits always", Solver, solver::SparseCholesky, solver::TwoLevelPcg,
                   solver::FibreBlockPcg, solver::FloatBlockCholesky, solver::DoubleBlockCholesky) {
    test::check_linear_solver(Solver{});
}

TEST_CASE("parameters that mean nothing are refused by name") {
    CHECK(test::refusal([] { solver::SparseCholesky{{.refinements = -1}}; }).starts_with("SparseCholesky.refinements = -1"));
    CHECK(test::refusal([] { solver::FibreBlockPcg{{.iteration_limit = 0}}; }).starts_with("FibreBlockPcg.iteration_limit = 0"));
}

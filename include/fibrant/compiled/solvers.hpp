// SPDX-License-Identifier: MIT
#pragma once
/// @file The strategies of linear solution, compiled once in compiled/solvers.cpp for systems of any beam.

#include <fibrant/assembly/system_view.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

namespace fibrant::solver {

extern template void TwoLevelPcg::analyse(const assembly::SystemView&);
extern template SolveStatus TwoLevelPcg::prepare(const assembly::SystemView&);
extern template SolveReport TwoLevelPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
extern template SolveStatus FibreBlockPcg::prepare(const assembly::SystemView&);
extern template SolveReport FibreBlockPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
extern template void FloatBlockCholesky::analyse(const assembly::SystemView&);
extern template SolveStatus FloatBlockCholesky::prepare(const assembly::SystemView&);
extern template SolveReport FloatBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
extern template void DoubleBlockCholesky::analyse(const assembly::SystemView&);
extern template SolveStatus DoubleBlockCholesky::prepare(const assembly::SystemView&);
extern template SolveReport DoubleBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
extern template void SparseCholesky::analyse(const assembly::SystemView&);
extern template SolveStatus SparseCholesky::prepare(const assembly::SystemView&);
extern template SolveReport SparseCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);

}  // namespace fibrant::solver

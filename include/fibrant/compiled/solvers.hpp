// SPDX-License-Identifier: MIT
#pragma once
/// @file The strategies of linear solution, compiled once in compiled/solvers.cpp for systems of any beam.
///
/// The list stands here alone: compiled/solvers.cpp takes it as what it has to compile, all others as what is compiled elsewhere.

#include <fibrant/assembly/system_view.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#ifndef FIBRANT_COMPILES
#define FIBRANT_COMPILES extern template
#endif

namespace fibrant::solver {

FIBRANT_COMPILES void TwoLevelPcg::analyse(const assembly::SystemView&);
FIBRANT_COMPILES SolveStatus TwoLevelPcg::prepare(const assembly::SystemView&);
FIBRANT_COMPILES SolveReport TwoLevelPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
FIBRANT_COMPILES SolveStatus FibreBlockPcg::prepare(const assembly::SystemView&);
FIBRANT_COMPILES SolveReport FibreBlockPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
FIBRANT_COMPILES void FloatBlockCholesky::analyse(const assembly::SystemView&);
FIBRANT_COMPILES SolveStatus FloatBlockCholesky::prepare(const assembly::SystemView&);
FIBRANT_COMPILES SolveReport FloatBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
FIBRANT_COMPILES void DoubleBlockCholesky::analyse(const assembly::SystemView&);
FIBRANT_COMPILES SolveStatus DoubleBlockCholesky::prepare(const assembly::SystemView&);
FIBRANT_COMPILES SolveReport DoubleBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
FIBRANT_COMPILES void SparseCholesky::analyse(const assembly::SystemView&);
FIBRANT_COMPILES SolveStatus SparseCholesky::prepare(const assembly::SystemView&);
FIBRANT_COMPILES SolveReport SparseCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);

}  // namespace fibrant::solver

#undef FIBRANT_COMPILES

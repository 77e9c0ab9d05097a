// SPDX-License-Identifier: MIT
#include <fibrant/compiled/solvers.hpp>

namespace fibrant::solver {

template void TwoLevelPcg::analyse(const assembly::SystemView&);
template SolveStatus TwoLevelPcg::prepare(const assembly::SystemView&);
template SolveReport TwoLevelPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
template SolveStatus FibreBlockPcg::prepare(const assembly::SystemView&);
template SolveReport FibreBlockPcg::solve(const assembly::SystemView&, const Vector&, double, Vector&);
template void FloatBlockCholesky::analyse(const assembly::SystemView&);
template SolveStatus FloatBlockCholesky::prepare(const assembly::SystemView&);
template SolveReport FloatBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
template void DoubleBlockCholesky::analyse(const assembly::SystemView&);
template SolveStatus DoubleBlockCholesky::prepare(const assembly::SystemView&);
template SolveReport DoubleBlockCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);
template void SparseCholesky::analyse(const assembly::SystemView&);
template SolveStatus SparseCholesky::prepare(const assembly::SystemView&);
template SolveReport SparseCholesky::solve(const assembly::SystemView&, const Vector&, double, Vector&);

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#pragma once
/// @file Symmetric sparse matrix of 6 x 6 blocks with a factor: the coarse matrix of a two-level preconditioner.

#include <fibrant/solver/linear_solver.hpp>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCholesky>

#include <algorithm>
#include <cassert>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// Blocks are ordered for little fill (minimum degree on the graph of blocks); the lower triangle is kept.
class CoarseMatrix {
public:
    using Block = Eigen::Matrix<double, 6, 6>;
    using BlockPair = std::pair<int, int>;  ///< row and column of a block, either triangle

    static constexpr double least_pivot = 1e-12;  ///< over the diagonal entry, below it the matrix counts as singular
    static constexpr double least_shift = 1e-8;   ///< of a singular matrix, times its diagonal

    /// Sets the pattern: `pairs`, and the diagonal.
    void analyse(Index blocks, std::vector<BlockPair> pairs) {
        for (BlockPair& pair : pairs) {
            if (pair.first > pair.second) std::swap(pair.first, pair.second);
        }
        for (int k = 0; k < static_cast<int>(blocks); ++k) pairs.emplace_back(k, k);
        std::sort(pairs.begin(), pairs.end());
        pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
        std::vector<Eigen::Triplet<double, int>> graph;
        for (const BlockPair& pair : pairs) {
            graph.emplace_back(pair.first, pair.second, 1.0);
            graph.emplace_back(pair.second, pair.first, 1.0);
        }
        SparseMatrix symmetric(blocks, blocks);
        symmetric.setFromTriplets(graph.begin(), graph.end());
        Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int> order;
        Eigen::AMDOrdering<int>()(symmetric, order);
        order_.assign(core::at(blocks), 0);
        for (int k = 0; k < static_cast<int>(blocks); ++k) order_[core::at(order.indices()[k])] = k;

        for (BlockPair& pair : pairs) {  // column first
            pair = std::minmax(order_[core::at(pair.first)], order_[core::at(pair.second)]);
        }
        std::sort(pairs.begin(), pairs.end());
        column_.assign(core::at(blocks + 1), 0);
        row_.clear();
        for (const BlockPair& pair : pairs) {
            ++column_[core::at(pair.first) + 1];
            row_.push_back(pair.second);
        }
        for (Index k = 0; k < blocks; ++k) column_[core::at(k + 1)] += column_[core::at(k)];
        matrix_.resize(6 * blocks, 6 * blocks);
        matrix_.resizeNonZeros(36 * core::count(row_));
        for (Index k = 0; k < blocks; ++k) {
            const int first = column_[core::at(k)], size = column_[core::at(k + 1)] - first;
            for (int c = 0; c < 6; ++c) {
                int entry = 36 * first + 6 * c * size;
                matrix_.outerIndexPtr()[6 * k + c] = entry;
                for (int b = first; b < first + size; ++b)
                    for (int d = 0; d < 6; ++d) matrix_.innerIndexPtr()[entry++] = 6 * row_[core::at(b)] + d;
            }
        }
        matrix_.outerIndexPtr()[6 * blocks] = static_cast<int>(36 * core::count(row_));
        clear();
        factor_.analyzePattern(matrix_);
    }

    Index blocks() const noexcept { return core::count(order_); }
    /// Entries of the factor below its diagonal.
    Index fill() const { return factor_.matrixL().nestedExpression().nonZeros(); }

    void clear() { value_.assign(row_.size(), Block::Zero()); }

    /// Adds `block` at (i, j) and its transpose at (j, i); on the diagonal once, as it stands.
    /// @return whether the pattern has the block
    bool add(int i, int j, const Block& block) {
        const int row = order_[core::at(i)], column = order_[core::at(j)];
        return row >= column ? add_lower(row, column, block) : add_lower(column, row, block.transpose());
    }

    /// `indefinite` if the matrix is not positive semidefinite; it is then shifted until it is, as if singular.
    SolveStatus factor() {
        scatter();
        const Vector diagonal = matrix_.diagonal();
        if (!diagonal.allFinite()) return SolveStatus::not_finite;
        Vector scale(diagonal.size());  // of a shift: columns that are nearly nothing take the scale of their likes
        for (Index k = 0; k < diagonal.size(); k += 3) {
            const double largest = diagonal.segment<3>(k).cwiseAbs().maxCoeff();
            scale.segment<3>(k) = diagonal.segment<3>(k).cwiseAbs().cwiseMax(1e-3 * largest);
            if (largest == 0.0) scale.segment<3>(k).setOnes();
        }
        double shift = 0.0;
        for (int attempt = 0; attempt < 16; ++attempt) {
            for (Index k = 0; k < diagonal.size(); ++k) {
                const double empty = scale[k] == 1.0 && diagonal[k] == 0.0 ? 1.0 : 0.0;
                matrix_.coeffRef(k, k) = diagonal[k] + empty + shift * scale[k];
            }
            factor_.factorize(matrix_);
            if (factor_.info() == Eigen::Success && accepted()) return attempt <= 1 ? SolveStatus::converged : SolveStatus::indefinite;
            shift = attempt == 0 ? least_shift : 10.0 * shift;
        }
        return SolveStatus::not_finite;
    }

    /// y = A^-1 x of the factor.
    void solve(const Vector& x, Vector& y) {
        buffer_.resize(x.size());
        for (Index k = 0; k < blocks(); ++k) buffer_.segment<6>(6 * order_[core::at(k)]) = x.segment<6>(6 * k);
        factor_.matrixL().solveInPlace(buffer_);
        buffer_ = buffer_.cwiseQuotient(factor_.vectorD()).eval();
        factor_.matrixU().solveInPlace(buffer_);
        y.resize(x.size());
        for (Index k = 0; k < blocks(); ++k) y.segment<6>(6 * k) = buffer_.segment<6>(6 * order_[core::at(k)]);
    }

private:
    template <class Derived>
    bool add_lower(int row, int column, const Eigen::MatrixBase<Derived>& block) {
        const auto first = row_.begin() + column_[core::at(column)], last = row_.begin() + column_[core::at(column) + 1];
        const auto found = std::lower_bound(first, last, row);
        if (found == last || *found != row) return false;
        value_[core::at(found - row_.begin())] += block;
        return true;
    }
    /// Blocks to the scalar columns of the matrix.
    void scatter() {
        for (Index k = 0; k < blocks(); ++k) {
            const int first = column_[core::at(k)], size = column_[core::at(k + 1)] - first;
            for (int b = 0; b < size; ++b)
                for (int c = 0; c < 6; ++c) {
                    Eigen::Map<Eigen::Matrix<double, 6, 1>>(matrix_.valuePtr() + 36 * first + 6 * c * size + 6 * b) =
                        value_[core::at(first + b)].col(c);
                }
        }
    }
    bool accepted() const {
        const Vector pivots = factor_.vectorD();
        for (Index k = 0; k < pivots.size(); ++k) {
            if (!(pivots[k] > least_pivot * matrix_.coeff(k, k))) return false;
        }
        return pivots.allFinite();
    }

    std::vector<int> order_;         // place of each block
    std::vector<int> column_, row_;  // blocks of the lower triangle, columns of rising rows
    std::vector<Block> value_;       // of the blocks
    SparseMatrix matrix_;
    Eigen::SimplicialLDLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<int>> factor_;
    Vector buffer_;
};

}  // namespace fibrant::solver

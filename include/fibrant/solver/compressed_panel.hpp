// SPDX-License-Identifier: MIT
#pragma once
/// @file Columns of a sparse Cholesky factor whose blocks off the diagonal are kept as products of thin matrices.

#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/dense_elimination.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// A block as U V^T where half of its size is rank enough, else as it is.
template <class Real>
struct LowRankBlock {
    using RealMatrix = typename DenseElimination<Real>::RealMatrix;
    using RealVector = typename DenseElimination<Real>::RealVector;

    RealMatrix left;   ///< U, rows x rank; the block itself if `whole`
    RealMatrix right;  ///< V, columns x rank; nothing if `whole`, whose V is the identity
    bool whole = false;

    Index rank() const noexcept { return left.cols(); }
    Index entries() const noexcept { return left.size() + right.size(); }

    /// Crosses of the largest entries are taken off the block until none is larger than the tolerance (adaptive cross
    /// approximation, Bebendorf 2000, with full pivoting).
    ///
    /// @param row_scale  what entries of each row are divided by before they are compared; > 0
    template <class Block, class Scale>
    void compress(const Block& block, const Scale& row_scale, Real tolerance) {
        const Index rows = block.rows(), columns = block.cols(), most = std::min(rows, columns) / 2;
        RealMatrix rest(rows, columns), u(rows, most), v(columns, most);
        RealVector largest(columns);
        for (Index j = 0; j < columns; ++j) {
            rest.col(j) = block.col(j).cwiseQuotient(row_scale);
            largest[j] = rest.col(j).cwiseAbs().maxCoeff();
        }
        whole = false;
        for (Index k = 0;; ++k) {
            Index i = 0, j = 0;
            if (!(largest.maxCoeff(&j) > tolerance)) {
                left = row_scale.asDiagonal() * u.leftCols(k);
                right = v.leftCols(k);
                return;
            }
            if (k == most) break;
            rest.col(j).cwiseAbs().maxCoeff(&i);
            u.col(k) = rest.col(j);
            v.col(k) = rest.row(i).transpose() / rest(i, j);
            for (Index c = 0; c < columns; ++c) {
                rest.col(c) -= v(c, k) * u.col(k);
                rest(i, c) = 0;
                largest[c] = c == j ? Real(0) : rest.col(c).cwiseAbs().maxCoeff();
            }
            rest.col(j).setZero();
        }
        whole = true;
        left = block;
        right.resize(0, 0);
    }
};

/// The columns of a supernode, cut into pieces of some two hundred unknowns as its rows are: L_IJ of two pieces that are far from
/// each other has a rank of a few hundredths of its size, so that nearly all products of the elimination are between thin
/// matrices (block low-rank factors: Amestoy and others, SIAM J. Sci. Comput. 37, 2015). What is left out of L is below a
/// tolerance, over the root of the diagonal of the row: the factor of a matrix close by, for use as a preconditioner.
template <class Real>
class CompressedPanel {
public:
    using RealMatrix = typename DenseElimination<Real>::RealMatrix;
    using RealVector = typename DenseElimination<Real>::RealVector;
    struct Piece {
        Index first = 0, size = 0;  ///< rows of the front
    };

    /// @param pieces   of all rows, those of the columns first
    /// @param columns  pieces that are columns
    void set(std::vector<Piece> pieces, Index columns) {
        pieces_ = std::move(pieces);
        columns_ = columns;
        diagonal_.resize(core::at(columns));
        block_.resize(core::at(columns * core::count(pieces_)));
    }
    bool empty() const noexcept { return pieces_.empty(); }
    void clear() {
        pieces_ = {};
        diagonal_ = {};
        block_ = {};
    }
    Index entries() const {
        Index sum = 0;
        for (const RealMatrix& diagonal : diagonal_) sum += diagonal.size();
        for (const auto& block : block_) sum += block.entries();
        return sum;
    }

    /// Eliminates the columns and takes what they make of the rows below off `update`, its lower part.
    ///
    /// @param panel      the front's columns; lost
    /// @param scale      what pivots are compared with, of each column
    /// @param row_scale  of each row of the front, > 0
    template <class Panel, class Update>
    void eliminate(Panel& panel, Update& update, const RealVector& scale, const RealVector& row_scale, Real tolerance,
                   DenseElimination<Real>& dense, Pivots& pivots) {
        const Index all = core::count(pieces_), m = panel.cols();
        const auto part = [&](Index i, Index j) {
            return panel.block(piece(i).first, piece(j).first, piece(i).size, piece(j).size);
        };
        for (Index j = 0; j < columns_; ++j) {
            core::parallel_for<core::Share::turns>(all - j, [&](Index k) {
                Factors factors;
                if (gather(j + k, j, j, factors)) part(j + k, j).noalias() -= factors.left * factors.right.transpose();
            });
            dense.eliminate(panel, piece(j).first, piece(j).first + piece(j).size, scale, pivots);
            diagonal_[core::at(j)] = part(j, j);
            core::parallel_for<core::Share::turns>(all - j - 1, [&](Index k) {
                const Index i = j + 1 + k;
                block(i, j).compress(part(i, j), row_scale.segment(piece(i).first, piece(i).size), tolerance);
            });
        }
        core::parallel_for<core::Share::turns>(all - columns_, [&](Index k) {
            const Index i = all - 1 - k;  // the longest row first
            Factors factors;
            for (Index j = columns_; j <= i; ++j)
                if (gather(i, j, columns_, factors)) {
                    update.block(piece(i).first - m, piece(j).first - m, piece(i).size, piece(j).size).noalias() -=
                        factors.left * factors.right.transpose();
                }
        });
    }

    /// own <- L^-1 own of the diagonal part, below <- what that takes off the rows below.
    template <class Own>
    void forward(Own& own, RealVector& below) const {
        const Index all = core::count(pieces_), m = own.size();
        below.setZero(pieces_.back().first + pieces_.back().size - m);
        RealVector thin;
        for (Index j = 0; j < columns_; ++j) {
            auto x = own.segment(piece(j).first, piece(j).size);
            diagonal_[core::at(j)].template triangularView<Eigen::Lower>().solveInPlace(x);
            for (Index i = j + 1; i < all; ++i) {
                const LowRankBlock<Real>& b = block(i, j);
                if (b.rank() == 0) continue;
                if (!b.whole) thin.noalias() = b.right.transpose() * x;
                const auto taken = [&](const auto& v) {
                    if (i < columns_)
                        own.segment(piece(i).first, piece(i).size).noalias() -= b.left * v;
                    else
                        below.segment(piece(i).first - m, piece(i).size).noalias() += b.left * v;
                };
                if (b.whole)
                    taken(x);
                else
                    taken(thin);
            }
        }
    }
    /// own <- L^-T (own - L_below^T below).
    template <class Own>
    void backward(Own& own, const RealVector& below) const {
        const Index all = core::count(pieces_), m = own.size();
        RealVector thin;
        for (Index j = columns_; j-- > 0;) {
            auto x = own.segment(piece(j).first, piece(j).size);
            for (Index i = j + 1; i < all; ++i) {
                const LowRankBlock<Real>& b = block(i, j);
                if (b.rank() == 0) continue;
                if (i < columns_)
                    thin.noalias() = b.left.transpose() * own.segment(piece(i).first, piece(i).size);
                else
                    thin.noalias() = b.left.transpose() * below.segment(piece(i).first - m, piece(i).size);
                if (b.whole)
                    x -= thin;
                else
                    x.noalias() -= b.right * thin;
            }
            diagonal_[core::at(j)].template triangularView<Eigen::Lower>().transpose().solveInPlace(x);
        }
    }

private:
    struct Factors {
        RealMatrix left, right, middle;
    };
    const Piece& piece(Index k) const { return pieces_[core::at(k)]; }
    LowRankBlock<Real>& block(Index i, Index j) { return block_[core::at(j * core::count(pieces_) + i)]; }
    const LowRankBlock<Real>& block(Index i, Index j) const { return block_[core::at(j * core::count(pieces_) + i)]; }

    /// Sum over the columns k < until of L_ik L_jk^T as one product left right^T of all their thin parts; false if it is nothing.
    bool gather(Index i, Index j, Index until, Factors& to) const {
        Index rank = 0;
        for (Index k = 0; k < until; ++k) rank += std::min(block(i, k).rank(), block(j, k).rank());
        if (rank == 0) return false;
        to.left.resize(piece(i).size, rank);
        to.right.resize(piece(j).size, rank);
        Index first = 0;
        for (Index k = 0; k < until; ++k) {
            const LowRankBlock<Real>&a = block(i, k), &b = block(j, k);
            const Index own = std::min(a.rank(), b.rank());
            if (own == 0) continue;
            auto left = to.left.middleCols(first, own);
            auto right = to.right.middleCols(first, own);
            first += own;
            if (a.whole && b.whole) {
                left = a.left, right = b.left;
                continue;
            }
            if (a.whole)
                to.middle = b.right;
            else if (b.whole)
                to.middle = a.right.transpose();
            else
                to.middle.noalias() = a.right.transpose() * b.right;
            if (a.rank() <= b.rank()) {
                left = a.left;
                right.noalias() = b.left * to.middle.transpose();
            } else {
                left.noalias() = a.left * to.middle;
                right = b.left;
            }
        }
        return true;
    }

    std::vector<Piece> pieces_;
    Index columns_ = 0;
    std::vector<RealMatrix> diagonal_;       // of each column of pieces, factored
    std::vector<LowRankBlock<Real>> block_;  // below the diagonal, column by column
};

}  // namespace fibrant::solver

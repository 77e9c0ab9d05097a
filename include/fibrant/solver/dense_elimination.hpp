// SPDX-License-Identifier: MIT
#pragma once
/// @file Cholesky elimination of the columns of a dense front, by products.

#include <fibrant/core/parallel.hpp>

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace fibrant::solver {

/// What a pivot that is too small, or negative, is replaced by.
enum class SmallPivot : std::uint8_t {
    infinite,   ///< so much that its unknown stays zero: a singular matrix is solved for the other unknowns
    magnitude,  ///< its magnitude, at least `least_pivot`: nearly an inverse, for use as a preconditioner
};

/// What was met while a dense matrix was factored.
struct Pivots {
    Index dropped = 0;   ///< replaced
    Index negative = 0;  ///< of these, negative beyond rounding: the matrix is indefinite
    bool finite = true;
};

/// Eliminates columns of a front, a matrix of which the lower part is used.
///
/// A pivot that is not positive, or that cancellation has left less than `least_pivot` of, is replaced, so that the factor
/// is positive definite always; SmallPivot says by what.
template <class Real>
class DenseElimination {
public:
    using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;

    static constexpr double least_pivot = sizeof(Real) == 4 ? 1e-6 : 1e-12;  ///< over the diagonal entry [1]

    explicit DenseElimination(SmallPivot small) : small_{small} {}

    /// Cholesky of the columns [first, last) of a front, the upper part of `panel`, and what it makes of the rows below.
    ///
    /// By halves, so that most is done by wide products. Below the narrowest diagonal blocks the rows are multiplied by
    /// the inverse, which is faster than a solution and as good: these blocks are small.
    /// @param scale  what pivots are compared with, of each column
    template <class Panel>
    void eliminate(Panel& panel, Index first, Index last, const RealVector& scale, Pivots& pivots) {
        constexpr Index narrow = 24;
        const Index width = last - first, n = panel.rows();
        if (width > narrow) {
            const Index half = first + (width / 2 + narrow - 1) / narrow * narrow, other = last - half;
            eliminate(panel, first, half, scale, pivots);
            const auto own = panel.block(half, first, other, half - first);
            subtract_square(own, panel.block(half, half, other, other));
            strips(n - last, [&](Index row, Index height) {
                panel.block(last + row, half, height, other).noalias() -=
                    panel.block(last + row, first, height, half - first) * own.transpose();
            });
            eliminate(panel, half, last, scale, pivots);
            return;
        }
        eliminate_diagonal(panel, first, width, scale, pivots);
        inverse_.setIdentity(width, width);
        panel.block(first, first, width, width).template triangularView<Eigen::Lower>().solveInPlace(inverse_);
        rows_.resize(n - last, width);
        strips(n - last, [&](Index row, Index height) {
            auto rows = panel.block(last + row, first, height, width);
            rows_.middleRows(row, height) = rows;
            rows.noalias() = rows_.middleRows(row, height) * inverse_.transpose();
        });
    }

    /// square -= rows rows^T, the lower part: below strips' own squares as products, which are faster than Eigen's rank update.
    template <class Rows, class Square>
    static void subtract_square(const Rows& rows, Square&& square) {
        const Index n = (rows.rows() + strip - 1) / strip;
        core::parallel_for<core::Share::turns>(n * (n + 1) / 2, [&](Index k) {
            Index i = 0;
            while ((i + 1) * (i + 2) / 2 <= k) ++i;
            const Index j = k - i * (i + 1) / 2, row = i * strip, column = j * strip, height = std::min(strip, rows.rows() - row);
            const auto own = rows.middleRows(row, height);
            if (i == j)
                square.block(row, row, height, height).template selfadjointView<Eigen::Lower>().rankUpdate(own, Real(-1));
            else
                square.block(row, column, height, strip).noalias() -= own * rows.middleRows(column, strip).transpose();
        });
    }

private:
    static constexpr Index strip = 768;  // rows that a thread takes at once

    template <class Body>
    static void strips(Index rows, const Body& body) {
        core::parallel_for<core::Share::turns>((rows + strip - 1) / strip,
                                               [&](Index k) { body(k * strip, std::min(strip, rows - k * strip)); });
    }

    template <class Panel>
    void eliminate_diagonal(Panel& panel, Index first, Index width, const RealVector& scale, Pivots& pivots) const {
        auto diagonal = panel.block(first, first, width, width);
        for (Index j = 0; j < width; ++j) {
            const Real original = scale[first + j];
            Real pivot = diagonal(j, j) - diagonal.row(j).head(j).squaredNorm();
            if (!std::isfinite(pivot)) pivots.finite = false;
            if (!(pivot > static_cast<Real>(least_pivot) * original)) {
                ++pivots.dropped;
                if (pivot < -static_cast<Real>(100 * least_pivot) * std::abs(original) || original < 0) ++pivots.negative;
                pivot = small_ == SmallPivot::infinite
                            ? static_cast<Real>(1e16) * std::max(std::abs(original), Real(1e-10))
                            : std::max({std::abs(pivot), static_cast<Real>(least_pivot) * std::abs(original), Real(1e-30)});
            }
            const Real root = std::sqrt(pivot);
            diagonal(j, j) = root;
            const Index below = width - j - 1;
            if (below > 0) {
                diagonal.col(j).tail(below).noalias() -=
                    diagonal.bottomLeftCorner(below, j) * diagonal.row(j).head(j).transpose();
                diagonal.col(j).tail(below) /= root;
            }
        }
    }

    SmallPivot small_;
    RealMatrix inverse_, rows_;
};

}  // namespace fibrant::solver

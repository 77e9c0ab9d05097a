// SPDX-License-Identifier: MIT
#pragma once
/// @file Eigenvalues and eigenvectors of small symmetric matrices, in one plain function for all sizes: what a general solver
/// costs the compiler for each of them was more than half of a first program's time.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fibrant::core {

/// Rows of the largest matrix that SymmetricEigen takes.
inline constexpr int most_eigen_rows = 16;

/// Eigenvalues and eigenvectors of a symmetric matrix of plain numbers, by Jacobi's rotations (Golub and Van Loan, Matrix
/// Computations, section 8.5).
/// @param size     rows, at most `most_eigen_rows`
/// @param matrix   column by column; its lower half is read, and all of it is used up
/// @param vectors  gets eigenvectors of unit length, as columns
/// @param values   gets the eigenvalues, least first
inline void symmetric_eigen(int size, double* matrix, double* vectors, double* values) noexcept {
    const auto a = [&](int r, int c) -> double& { return matrix[r + size * c]; };
    const auto v = [&](int r, int c) -> double& { return vectors[r + size * c]; };
    for (int c = 0; c < size; ++c)
        for (int r = 0; r < size; ++r) {
            v(r, c) = r == c ? 1.0 : 0.0;
            if (r < c) a(r, c) = a(c, r);
        }
    constexpr int most_sweeps = 30;  // they converge quadratically: six are usual
    bool turned = true;
    for (int sweep = 0; sweep < most_sweeps && turned; ++sweep) {
        turned = false;
        double largest = 0.0;
        for (int k = 0; k < size * size; ++k) largest = std::max(largest, std::abs(matrix[k]));
        for (int p = 0; p < size; ++p)
            for (int q = p + 1; q < size; ++q) {
                const double off = a(q, p);
                if (std::abs(off) <= 0.5 * std::numeric_limits<double>::epsilon() * largest) continue;
                turned = true;
                const double half = 0.5 * (a(q, q) - a(p, p)) / off;
                const double t = (half < 0.0 ? -1.0 : 1.0) / (std::abs(half) + std::hypot(1.0, half)),
                             c = 1.0 / std::hypot(1.0, t), s = t * c;
                a(p, p) -= t * off, a(q, q) += t * off;
                a(p, q) = a(q, p) = 0.0;
                for (int k = 0; k < size; ++k) {
                    if (k != p && k != q) {
                        const double one = a(k, p), other = a(k, q);
                        a(k, p) = a(p, k) = c * one - s * other, a(k, q) = a(q, k) = s * one + c * other;
                    }
                    const double one = v(k, p), other = v(k, q);
                    v(k, p) = c * one - s * other, v(k, q) = s * one + c * other;
                }
            }
    }
    for (int k = 0; k < size; ++k) values[k] = a(k, k);
    for (int k = 0; k + 1 < size; ++k) {
        const int least = static_cast<int>(std::min_element(values + k, values + size) - values);
        if (least == k) continue;
        std::swap(values[k], values[least]);
        for (int r = 0; r < size; ++r) std::swap(v(r, k), v(r, least));
    }
}

/// Eigenvalues, least first, and eigenvectors of unit length, as columns, of a symmetric matrix of which the lower half is read.
template <int n>
    requires(n >= 2 && n <= most_eigen_rows)
class SymmetricEigen {
public:
    using Square = Eigen::Matrix<double, n, n>;
    using Column = Eigen::Matrix<double, n, 1>;

    explicit SymmetricEigen(Square matrix) noexcept { symmetric_eigen(n, matrix.data(), vectors_.data(), values_.data()); }

    const Column& values() const noexcept { return values_; }
    const Square& vectors() const noexcept { return vectors_; }

    /// Matrix of the same eigenvectors whose eigenvalues are raised to at least `least`.
    Square raised(double least) const noexcept {
        Square sum;
        for (int r = 0; r < n; ++r)
            for (int c = 0; c < n; ++c) {
                double entry = vectors_(r, 0) * std::max(values_[0], least) * vectors_(c, 0);
                for (int k = 1; k < n; ++k) entry += vectors_(r, k) * std::max(values_[k], least) * vectors_(c, k);
                sum(r, c) = entry;
            }
        return sum;
    }

private:
    Square vectors_;
    Column values_;
};

}  // namespace fibrant::core

// SPDX-License-Identifier: MIT
#pragma once
/// @file Eigenvalues and eigenvectors of small symmetric matrices, in one plain function for all sizes: what a general solver
/// costs the compiler for each of them was more than half of a first program's time.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace fibrant::core {

namespace detail {

/// Symmetric matrix of at most eight rows, column by column without gaps, on its way to its eigenvectors.
class SymmetricReduction {
public:
    static constexpr int most = 8;

    /// @param matrix  lower half is read; gets eigenvectors, as columns
    /// @param values  gets eigenvalues, least first
    SymmetricReduction(int size, double* matrix, double* values) noexcept : n_{size}, a_{matrix}, d_{values} {
        double scale = 0.0;
        for (int c = 0; c < n_; ++c)
            for (int r = 0; r < n_; ++r) scale = r < c ? (a(r, c) = 0.0, scale) : std::max(scale, std::abs(a(r, c)));
        if (scale == 0.0) scale = 1.0;  // entries in [-1, 1] neither over- nor underflow
        for (int c = 0; c < n_; ++c)
            for (int r = c; r < n_; ++r) a(r, c) /= scale;
        if (n_ == 3) reduce_three();
        else reduce();
        if (iterate()) sort();
        for (int k = 0; k < n_; ++k) d_[k] *= scale;
    }

private:
    static constexpr double tiny = std::numeric_limits<double>::min();

    double& a(int row, int column) noexcept { return a_[row + n_ * column]; }

    /// Three rows have one entry to be turned away.
    void reduce_three() noexcept {
        const double a11 = a(1, 1), a22 = a(2, 2), a10 = a(1, 0), a20 = a(2, 0), a21 = a(2, 1);
        d_[0] = a(0, 0);
        double m01 = 1.0, m02 = 0.0, m22 = 1.0;
        if (a20 * a20 <= tiny) {
            d_[1] = a11, d_[2] = a22, e_[0] = a10, e_[1] = a21;
        } else {
            const double beta = std::sqrt(a10 * a10 + a20 * a20), inverse = 1.0 / beta;
            m01 = a10 * inverse, m02 = a20 * inverse, m22 = -m01;
            const double q = 2.0 * m01 * a21 + m02 * (a22 - a11);
            d_[1] = a11 + m02 * q, d_[2] = a22 - m02 * q;
            e_[0] = beta, e_[1] = a21 - m01 * q;
        }
        a(0, 0) = 1.0, a(1, 0) = a(2, 0) = a(0, 1) = a(0, 2) = 0.0;
        a(1, 1) = m01, a(2, 1) = a(1, 2) = m02, a(2, 2) = m22;
    }

    /// Householder reduction to three diagonals (Golub and Van Loan, Matrix Computations, section 8.3.1): reflections
    /// 1 - t v v^T with v = (1, v_1, ...), of which v_1, ... are left below the second diagonal.
    void reduce() noexcept {
        std::array<double, most> turn{}, w{}, v{};
        for (int i = 0; i + 1 < n_; ++i) {
            const int first = i + 1;
            double square = 0.0;
            for (int r = first + 1; r < n_; ++r) square += a(r, i) * a(r, i);
            double head = a(first, i), t = 0.0;
            if (square <= tiny) {
                for (int r = first + 1; r < n_; ++r) a(r, i) = 0.0;
            } else {
                const double c0 = head;
                head = std::sqrt(c0 * c0 + square);
                if (c0 >= 0.0) head = -head;
                for (int r = first + 1; r < n_; ++r) a(r, i) /= c0 - head;
                t = (head - c0) / head;
            }
            for (int r = first; r < n_; ++r) v[at(r)] = r == first ? 1.0 : a(r, i), w[at(r)] = 0.0;
            for (int c = first; c < n_; ++c) {  // w = t A v
                const double scaled = t * v[at(c)];
                double below = 0.0;
                w[at(c)] += a(c, c) * scaled;
                for (int r = c + 1; r < n_; ++r) w[at(r)] += a(r, c) * scaled, below += a(r, c) * v[at(r)];
                w[at(c)] += t * below;
            }
            double dot = w[at(first)] * v[at(first)];
            for (int r = first + 1; r < n_; ++r) dot += w[at(r)] * v[at(r)];
            const double back = t * -0.5 * dot;
            for (int r = first; r < n_; ++r) w[at(r)] += back * v[at(r)];
            for (int c = first; c < n_; ++c)
                for (int r = c; r < n_; ++r) a(r, c) += -v[at(c)] * w[at(r)] + -w[at(c)] * v[at(r)];
            a(first, i) = head, turn[at(i)] = t;
        }
        for (int k = 0; k < n_; ++k) d_[k] = a(k, k);
        for (int k = 0; k + 1 < n_; ++k) e_[at(k)] = a(k + 1, k);
        unfold(turn);
    }

    /// Product of the reflections, in the place of their vectors.
    void unfold(const std::array<double, most>& turn) noexcept {
        for (int k = 0; k < n_; ++k) a(k, k) = 1.0;
        for (int k = n_ - 3; k >= 0; --k) {
            std::array<double, most> v{}, sum{};
            const int first = k + 1;
            for (int r = first + 1; r < n_; ++r) v[at(r)] = a(r, k);
            for (int c = first + 1; c < n_; ++c) a(c, first) = 0.0;
            for (int c = first; turn[at(k)] != 0.0 && c < n_; ++c) {
                for (int r = first + 1; r < n_; ++r) sum[at(c)] += v[at(r)] * a(r, c);
                sum[at(c)] += a(first, c);
                a(first, c) -= turn[at(k)] * sum[at(c)];
                for (int r = first + 1; r < n_; ++r) a(r, c) -= turn[at(k)] * v[at(r)] * sum[at(c)];
            }
        }
        for (int r = 1; r < n_; ++r) a(r, 0) = a(0, r) = 0.0;
    }

    /// Implicit steps with Wilkinson's shift (section 8.3.3 there) until all is on the diagonal.
    bool iterate() noexcept {
        constexpr double inverse = 1.0 / std::numeric_limits<double>::epsilon();
        constexpr int patience = 30;  // steps an eigenvalue; two or three are usual
        int end = n_ - 1, start = 0;
        for (int step = 1; end > 0; ++step) {
            for (int k = start; k < end; ++k) {
                const double scaled = inverse * e_[at(k)];
                if (std::abs(e_[at(k)]) < tiny || scaled * scaled <= std::abs(d_[k]) + std::abs(d_[k + 1])) e_[at(k)] = 0.0;
            }
            while (end > 0 && e_[at(end - 1)] == 0.0) --end;
            if (end <= 0) break;
            if (step > patience * n_) return false;
            start = end - 1;
            while (start > 0 && e_[at(start - 1)] != 0.0) --start;
            chase(start, end);
        }
        return true;
    }

    static double length(double x, double y) noexcept {
        const double more = std::max(x, y), part = std::min(x, y) / more;
        return more == 0.0 ? 0.0 : more * std::sqrt(1.0 + part * part);
    }

    void chase(int start, int end) noexcept {
        const double half = (d_[end - 1] - d_[end]) * 0.5, e = e_[at(end - 1)];
        double shift = d_[end];
        if (half == 0.0) {
            shift -= std::abs(e);
        } else if (e != 0.0) {
            const double h = length(std::abs(half), std::abs(e)), sum = half + (half > 0.0 ? h : -h);
            shift -= e * e == 0.0 ? e / (sum / e) : e * e / sum;
        }
        double x = d_[start] - shift, z = e_[at(start)];
        for (int k = start; k < end && z != 0.0; ++k) {
            double c = 0.0, s = z < 0.0 ? 1.0 : -1.0;
            if (x != 0.0) {
                const bool mostly_x = std::abs(x) > std::abs(z);
                const double t = mostly_x ? z / x : x / z;
                double u = std::sqrt(1.0 + t * t);
                if ((mostly_x ? x : z) < 0.0) u = -u;
                if (mostly_x) c = 1.0 / u, s = -t * c;
                else s = -1.0 / u, c = -t * s;
            }
            const double off = e_[at(k)], low = d_[k], high = d_[k + 1];
            const double first = s * low + c * off, second = s * off + c * high;
            d_[k] = c * (c * low - s * off) - s * (c * off - s * high);
            d_[k + 1] = s * first + c * second;
            e_[at(k)] = c * first - s * second;
            if (k > start) e_[at(k - 1)] = c * e_[at(k - 1)] - s * z;
            x = e_[at(k)];
            if (k < end - 1) z = -s * e_[at(k + 1)], e_[at(k + 1)] = c * e_[at(k + 1)];
            if (c == 1.0 && s == 0.0) continue;
            for (int r = 0; r < n_; ++r) {
                const double one = a(r, k), other = a(r, k + 1);
                a(r, k) = c * one - s * other, a(r, k + 1) = s * one + c * other;
            }
        }
    }

    void sort() noexcept {
        for (int i = 0; i + 1 < n_; ++i) {
            const int least = static_cast<int>(std::min_element(d_ + i, d_ + n_) - d_);
            if (least == i) continue;
            std::swap(d_[i], d_[least]);
            for (int r = 0; r < n_; ++r) std::swap(a(r, i), a(r, least));
        }
    }

    int n_;
    double *a_, *d_;
    std::array<double, most> e_{};  ///< second diagonal
};

/// Closed form for two rows.
inline void symmetric_eigen_two(const double* matrix, double* vectors, double* values) noexcept {
    const double shift = (matrix[0] + matrix[3]) / 2.0;
    double low = matrix[0] - shift, off = matrix[1], high = matrix[3] - shift;
    const double scale = std::max({std::abs(low), std::abs(off), std::abs(high)});
    if (scale > 0.0) low /= scale, off /= scale, high /= scale;
    const double half = 0.5 * std::sqrt((low - high) * (low - high) + 4.0 * (off * off)), middle = 0.5 * (low + high);
    values[0] = middle - half, values[1] = middle + half;
    vectors[0] = vectors[3] = 1.0, vectors[1] = vectors[2] = 0.0;
    if (values[1] - values[0] > std::abs(values[1]) * std::numeric_limits<double>::epsilon()) {
        low -= values[1], high -= values[1];
        const double a2 = low * low, c2 = high * high, b2 = off * off, size = std::sqrt((a2 > c2 ? a2 : c2) + b2);
        vectors[2] = (a2 > c2 ? -off : -high) / size, vectors[3] = (a2 > c2 ? low : off) / size;
        const double unit = std::sqrt(vectors[2] * vectors[2] + vectors[3] * vectors[3]);
        vectors[0] = -vectors[3] / unit, vectors[1] = vectors[2] / unit;
    }
    for (int k = 0; k < 2; ++k) values[k] = values[k] * scale + shift;
}

}  // namespace detail

/// Eigenvalues and eigenvectors of a symmetric matrix of plain numbers.
/// @param matrix  column by column, at most eight rows; its lower half is read, and it gets the eigenvectors as columns
/// @param values  gets the eigenvalues, least first
inline void symmetric_eigen(int size, double* matrix, double* values) noexcept {
    detail::SymmetricReduction(size, matrix, values);
}

/// Eigenvalues, least first, and eigenvectors of unit length, as columns, of a symmetric matrix of which the lower half is read.
template <int n>
    requires(n >= 2 && n <= detail::SymmetricReduction::most)
class SymmetricEigen {
public:
    using Square = Eigen::Matrix<double, n, n>;
    using Column = Eigen::Matrix<double, n, 1>;

    explicit SymmetricEigen(const Square& matrix) noexcept : vectors_{matrix} {
        symmetric_eigen(n, vectors_.data(), values_.data());
    }
    /// By the closed form, which is quicker and in matrices of almost equal eigenvalues less exact.
    static SymmetricEigen closed_form(const Square& matrix) noexcept
        requires(n == 2)
    {
        SymmetricEigen made;
        detail::symmetric_eigen_two(matrix.data(), made.vectors_.data(), made.values_.data());
        return made;
    }

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
    SymmetricEigen() = default;
    Square vectors_;
    Column values_;
};

}  // namespace fibrant::core

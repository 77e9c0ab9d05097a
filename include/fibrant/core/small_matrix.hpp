// SPDX-License-Identifier: MIT
#pragma once
/// @file Small matrices as plain numbers, and products of dense ones that are taken seldom: each of these sums is an
/// expression of its own to a general library, which the compiler pays for.

#include <fibrant/core/types.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace fibrant::core {

/// Two numbers, and a matrix of them: what needs no more of Eigen compiles in less time.
using Two = std::array<double, 2>;
using TwoByTwo = std::array<Two, 2>;  ///< rows
using Four = std::array<double, 4>;
using FourByFour = std::array<Four, 4>;  ///< rows

/// Sums and products of vectors and matrices of two rows.
inline double dot(const Two& a, const Two& b) noexcept { return a[0] * b[0] + a[1] * b[1]; }
inline double norm(const Two& a) noexcept { return std::sqrt(dot(a, a)); }
inline Two times(const TwoByTwo& m, const Two& a) noexcept { return {dot(m[0], a), dot(m[1], a)}; }
inline TwoByTwo transposed(const TwoByTwo& m) noexcept { return {Two{m[0][0], m[1][0]}, Two{m[0][1], m[1][1]}}; }
/// a b^T
inline TwoByTwo times_transposed(const TwoByTwo& a, const TwoByTwo& b) noexcept { return {times(b, a[0]), times(b, a[1])}; }
inline double norm(const TwoByTwo& m) noexcept {
    return std::sqrt((m[0][0] * m[0][0] + m[0][1] * m[0][1]) + (m[1][0] * m[1][0] + m[1][1] * m[1][1]));
}
inline double determinant(const TwoByTwo& m) noexcept { return m[0][0] * m[1][1] - m[1][0] * m[0][1]; }
inline TwoByTwo inverse(const TwoByTwo& m) noexcept {
    const double over = 1.0 / determinant(m);
    return {Two{m[1][1] * over, -m[0][1] * over}, Two{-m[1][0] * over, m[0][0] * over}};
}

/// Solution of m x = b by elimination with full pivoting; of a singular matrix one with zeros where nothing is said of x.
inline Four solve(FourByFour m, Four b) noexcept {
    constexpr std::size_t n = 4;
    std::array<std::size_t, n> column{0, 1, 2, 3};
    double largest = 0.0;
    std::size_t pivots = n;
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t row = k, most = k;
        for (std::size_t c = k; c < n; ++c)
            for (std::size_t r = k; r < n; ++r)
                if (std::abs(m[r][c]) > std::abs(m[row][most])) row = r, most = c;
        if (m[row][most] == 0.0) {
            pivots = k;
            break;
        }
        largest = std::fmax(largest, std::abs(m[row][most]));
        std::swap(m[k], m[row]), std::swap(b[k], b[row]);
        for (Four& r : m) std::swap(r[k], r[most]);
        std::swap(column[k], column[most]);
        for (std::size_t r = k + 1; r < n; ++r) {
            m[r][k] /= m[k][k];
            for (std::size_t c = k + 1; c < n; ++c) m[r][c] -= m[r][k] * m[k][c];
        }
    }
    std::size_t rank = 0;
    const double least = largest * (std::numeric_limits<double>::epsilon() * static_cast<double>(n));
    for (std::size_t k = 0; k < pivots; ++k) rank += std::abs(m[k][k]) > least ? 1 : 0;
    for (std::size_t k = 0; k < n; ++k)
        for (std::size_t r = k + 1; r < n; ++r) b[r] -= b[k] * m[r][k];
    Four x{};
    for (std::size_t k = rank; k-- > 0;) {
        b[k] /= m[k][k];
        for (std::size_t r = 0; r < k; ++r) b[r] -= b[k] * m[r][k];
        x[column[k]] = b[k];
    }
    return x;
}

/// sum += a b^T
inline void add_outer(const Vec3& a, const Vec3& b, Mat3& sum) noexcept {
    for (Index c = 0; c < 3; ++c)
        for (Index r = 0; r < 3; ++r) sum(r, c) += a[r] * b[c];
}

/// m x
inline Vector times(const Matrix& m, const Vector& x) {
    Vector sum = Vector::Zero(m.rows());
    for (Index c = 0; c < m.cols(); ++c)
        for (Index r = 0; r < m.rows(); ++r) sum[r] += m(r, c) * x[c];
    return sum;
}
/// m^T x
inline Vector transposed_times(const Matrix& m, const Vector& x) {
    Vector sum(m.cols());
    const Index n = m.rows(), even = n - n % 2, fours = m.cols() == 1 ? n - n % 4 : 0;
    for (Index c = 0; c < m.cols(); ++c) {  // every second term is summed up alone: two at a time are multiplied
        const double* column = m.data() + c * n;
        double first = 0.0, second = 0.0, third = 0.0, fourth = 0.0;
        for (Index r = 0; r < fours; r += 4) {
            first += column[r] * x[r], second += column[r + 1] * x[r + 1];
            third += column[r + 2] * x[r + 2], fourth += column[r + 3] * x[r + 3];
        }
        first += third, second += fourth;
        for (Index r = fours; r < even; r += 2) first += column[r] * x[r], second += column[r + 1] * x[r + 1];
        sum[c] = first + second;
        for (Index r = even; r < n; ++r) sum[c] += column[r] * x[r];
    }
    return sum;
}

}  // namespace fibrant::core

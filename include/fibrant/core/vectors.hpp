// SPDX-License-Identifier: MIT
#pragma once
/// @file Vectors of three and 3 by 3 matrices, and their arithmetic as plain functions.
///
/// Eigen makes a type of every expression, and compilers spend more on these types than on all else. What is found here is taken
/// in its place, by code in namespace fibrant and by all that says `using namespace fibrant`; it gives the same bits. Results are
/// values: what looks at one, as `(a - b).array()` does, ends with the expression that it stands in, and is not kept by `auto`.

#include <fibrant/core/config.hpp>

#include <Eigen/Core>

#include <concepts>
#include <type_traits>

namespace fibrant {

using Index = Eigen::Index;      ///< signed; -1 means "none"
using Vec3 = Eigen::Vector3d;    ///< position, director or force in space
using Mat3 = Eigen::Matrix3d;    ///< projector or stiffness between two 3-vectors
using Vector = Eigen::VectorXd;  ///< unknowns or residual: component k % 3 of 3-vector k / 3
using Matrix = Eigen::MatrixXd;  ///< dense, column-major

namespace core {

/// Whether a type is a matrix that stores its columns one after the other.
template <class T>
inline constexpr bool by_columns = false;
template <int rows, int columns>
inline constexpr bool by_columns<Eigen::Matrix<double, rows, columns, Eigen::ColMajor, rows, columns>> = true;
/// Whether a type is three numbers that lie one after the other.
template <class T>
inline constexpr bool three_numbers = std::is_same_v<T, Vec3>;
template <class M>
inline constexpr bool three_numbers<Eigen::VectorBlock<M, 3>> = by_columns<std::remove_const_t<M>>&& M::ColsAtCompileTime == 1;
template <class M>
inline constexpr bool three_numbers<Eigen::Block<M, 3, 1, true>> = by_columns<std::remove_const_t<M>>;

/// Three numbers in one piece: a Vec3, three of a column vector, a column of a matrix of three rows.
template <class T>
concept Triple = three_numbers<T>;

/// A matrix of a size that is known to the compiler.
template <int rows, int columns>
using SmallMatrix = Eigen::Matrix<double, rows, columns>;
/// Whether a type is such a matrix of at most sixteen numbers, and no Vec3.
template <class T>
inline constexpr bool small_matrix = false;
template <int rows, int columns>
inline constexpr bool small_matrix<Eigen::Matrix<double, rows, columns, Eigen::ColMajor, rows, columns>> =
    rows > 0 && columns > 0 && rows* columns <= 16 && !(rows == 3 && columns == 1);

/// A matrix of at most sixteen numbers that is no Triple.
template <class T>
concept Small = small_matrix<T>;

/// What a transposed matrix is of, const or not.
template <class M>
using Untransposed = std::remove_const_t<M>;

/// A factor: a number as it is, not what converts to one.
template <class T>
concept Factor = std::is_arithmetic_v<T>;

/// A matrix whose numbers, column by column, are of(0), of(1), ...
template <class M, class Of>
M by_entry(const Of& of) noexcept {
    M m;
    for (Index k = 0; k < M::SizeAtCompileTime; ++k) m.data()[k] = of(k);
    return m;
}

/// Sums of three products. Which two are added first is Eigen's choice for packets of two doubles: rows 0 and 1 of a matrix are
/// such a packet, row 2 is left over.
template <int row>
double sum_of_row(double x, double y, double z) noexcept {
    return row < 2 ? (x + y) + z : x + (y + z);
}

/// matrix v, of numbers column by column.
inline Vec3 product(const double* m, const double* v) noexcept {
    return {sum_of_row<0>(m[0] * v[0], m[3] * v[1], m[6] * v[2]), sum_of_row<1>(m[1] * v[0], m[4] * v[1], m[7] * v[2]),
            sum_of_row<2>(m[2] * v[0], m[5] * v[1], m[8] * v[2])};
}
/// matrix^T v.
inline Vec3 transposed_product(const double* m, const double* v) noexcept {
    return {(m[0] * v[0] + m[1] * v[1]) + m[2] * v[2], (m[3] * v[0] + m[4] * v[1]) + m[5] * v[2],
            (m[6] * v[0] + m[7] * v[1]) + m[8] * v[2]};
}

/// A matrix whose columns are of(0), of(1), of(2).
template <class Column>
Mat3 matrix_of_columns(const Column& of) noexcept {
    Mat3 m;
    for (Index c = 0; c < 3; ++c) {
        const Vec3 column = of(c);
        for (Index k = 0; k < 3; ++k) m.data()[3 * c + k] = column.data()[k];
    }
    return m;
}

/// The matrix of three columns.
inline Mat3 columns(const Vec3& a, const Vec3& b, const Vec3& c) noexcept {
    return matrix_of_columns([&](Index k) { return k == 0 ? a : k == 1 ? b : c; });
}

}  // namespace core

template <core::Triple A, core::Triple B>
Vec3 operator+(const A& a, const B& b) noexcept {
    const double *x = a.data(), *y = b.data();
    return {x[0] + y[0], x[1] + y[1], x[2] + y[2]};
}
template <core::Triple A, core::Triple B>
Vec3 operator-(const A& a, const B& b) noexcept {
    const double *x = a.data(), *y = b.data();
    return {x[0] - y[0], x[1] - y[1], x[2] - y[2]};
}
template <core::Triple A>
Vec3 operator-(const A& a) noexcept {
    const double* x = a.data();
    return {-x[0], -x[1], -x[2]};
}
template <core::Factor F, core::Triple A>
Vec3 operator*(F factor, const A& a) noexcept {
    const double *x = a.data(), f = static_cast<double>(factor);
    return {f * x[0], f * x[1], f * x[2]};
}
template <core::Triple A, core::Factor F>
Vec3 operator*(const A& a, F factor) noexcept {
    return factor * a;
}
template <core::Triple A, core::Factor F>
Vec3 operator/(const A& a, F divisor) noexcept {
    const double *x = a.data(), d = static_cast<double>(divisor);
    return {x[0] / d, x[1] / d, x[2] / d};
}

template <core::Small M>
M operator+(const M& a, const M& b) noexcept {
    return core::by_entry<M>([&](Index k) { return a.data()[k] + b.data()[k]; });
}
template <core::Small M>
M operator-(const M& a, const M& b) noexcept {
    return core::by_entry<M>([&](Index k) { return a.data()[k] - b.data()[k]; });
}
template <core::Small M>
M operator-(const M& m) noexcept {
    return core::by_entry<M>([&](Index k) { return -m.data()[k]; });
}
template <core::Factor F, core::Small M>
M operator*(F factor, const M& m) noexcept {
    return core::by_entry<M>([&](Index k) { return static_cast<double>(factor) * m.data()[k]; });
}
template <core::Small M, core::Factor F>
M operator*(const M& m, F factor) noexcept {
    return factor * m;
}
template <core::Small M, core::Factor F>
M operator/(const M& m, F divisor) noexcept {
    return core::by_entry<M>([&](Index k) { return m.data()[k] / static_cast<double>(divisor); });
}
/// Identity less m.
template <std::same_as<Mat3> M>
Mat3 operator-(const Mat3::IdentityReturnType&, const M& m) noexcept {
    return core::by_entry<Mat3>([&](Index k) { return (k % 4 == 0 ? 1.0 : 0.0) - m.data()[k]; });
}

/// a b, of two products in each entry.
template <core::Small A, core::Small B>
    requires(A::ColsAtCompileTime == 2 && B::RowsAtCompileTime == 2)
core::SmallMatrix<A::RowsAtCompileTime, B::ColsAtCompileTime>
operator*(const A& a, const B& b) noexcept {
    constexpr Index rows = A::RowsAtCompileTime;
    return core::by_entry<core::SmallMatrix<A::RowsAtCompileTime, B::ColsAtCompileTime>>([&](Index k) {
        const double *of_a = a.data() + k % rows, *of_b = b.data() + 2 * (k / rows);
        return of_a[0] * of_b[0] + of_a[rows] * of_b[1];
    });
}
/// a^T b, the same.
template <class A, core::Small B>
    requires(core::Small<core::Untransposed<A>>&& A::RowsAtCompileTime == 2 && B::RowsAtCompileTime == 2)
core::SmallMatrix<A::ColsAtCompileTime, B::ColsAtCompileTime>
operator*(const Eigen::Transpose<A>& a, const B& b) noexcept {
    constexpr Index rows = A::ColsAtCompileTime;
    return core::by_entry<core::SmallMatrix<A::ColsAtCompileTime, B::ColsAtCompileTime>>([&](Index k) {
        const double *of_a = a.nestedExpression().data() + 2 * (k % rows), *of_b = b.data() + 2 * (k / rows);
        return of_a[0] * of_b[0] + of_a[1] * of_b[1];
    });
}

template <std::same_as<Mat3> M, core::Triple A>
Vec3 operator*(const M& m, const A& a) noexcept {
    return core::product(m.data(), a.data());
}
template <class M, core::Triple A>
requires std::same_as<core::Untransposed<M>, Mat3> Vec3 operator*(const Eigen::Transpose<M>& m, const A& a) noexcept {
    return core::transposed_product(m.nestedExpression().data(), a.data());
}
template <std::same_as<Mat3> M>
Mat3 operator*(const M& a, const M& b) noexcept {
    return core::matrix_of_columns([&](Index c) { return core::product(a.data(), b.data() + 3 * c); });
}
template <class T, std::same_as<Mat3> M>
requires std::same_as<core::Untransposed<T>, Mat3> Mat3 operator*(const Eigen::Transpose<T>& a, const M& b) noexcept {
    return core::matrix_of_columns(
        [&](Index c) { return core::transposed_product(a.nestedExpression().data(), b.data() + 3 * c); });
}
template <std::same_as<Mat3> M, class T>
requires std::same_as<core::Untransposed<T>, Mat3> Mat3 operator*(const M& a, const Eigen::Transpose<T>& b) noexcept {
    const double* rows = b.nestedExpression().data();
    return core::matrix_of_columns([&](Index c) {
        const double row[3] = {rows[c], rows[c + 3], rows[c + 6]};
        return core::product(a.data(), row);
    });
}
/// a b^T, of vectors that are no Triple.
template <core::Small A, class B>
    requires(core::Small<core::Untransposed<B>>&& A::ColsAtCompileTime == 1 && B::ColsAtCompileTime == 1)
core::SmallMatrix<A::RowsAtCompileTime, B::RowsAtCompileTime>
operator*(const A& a, const Eigen::Transpose<B>& b) noexcept {
    constexpr Index rows = A::RowsAtCompileTime;
    return core::by_entry<core::SmallMatrix<A::RowsAtCompileTime, B::RowsAtCompileTime>>(
        [&](Index k) { return a.data()[k % rows] * b.nestedExpression().data()[k / rows]; });
}
/// The same of Triples.
template <core::Triple A, class V>
requires std::same_as<core::Untransposed<V>, Vec3> Mat3 operator*(const A& a, const Eigen::Transpose<V>& b) noexcept {
    const double *x = a.data(), *y = b.nestedExpression().data();
    return core::matrix_of_columns([&](Index c) { return Vec3(x[0] * y[c], x[1] * y[c], x[2] * y[c]); });
}

}  // namespace fibrant

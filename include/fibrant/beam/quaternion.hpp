// SPDX-License-Identifier: MIT
#pragma once
/// @file Quaternion of a rotation vector with two derivatives, and the strains of a rod as algebra of quaternions.

#include <fibrant/core/rotation.hpp>

#include <array>
#include <cmath>

namespace fibrant::beam::detail {

using Vec4 = Eigen::Vector4d;  ///< quaternion: scalar part, then vector part
using Mat4 = Eigen::Matrix4d;
using Mat34 = Eigen::Matrix<double, 3, 4>;
using Mat43 = Eigen::Matrix<double, 4, 3>;

/// q = (cos(p/2), s psi), s = sin(p/2) / p: unit, and smooth up to |psi| = 2 pi, where its derivative becomes singular.
struct TurnedQuaternion {
    Vec4 value;
    Mat43 slope;
    Vec3 psi;
    double s, s_1, s_2, sign = 1.0;  // derivatives of s over p

    explicit TurnedQuaternion(const Vec3& vector) noexcept : psi{vector} {
        const double t = psi.squaredNorm(), p = std::sqrt(t);
        if (t < 1.0) {
            const auto half = core::detail::even_series(0.25 * t, 1);  // s = half / 2, d/dt = 1/4 of its derivative
            s = 0.5 * half[0], s_1 = 0.25 * half[1], s_2 = 0.125 * half[2];
        } else {
            s = std::sin(0.5 * p) / p;
            s_1 = (0.5 * std::cos(0.5 * p) - s) / t;
            s_2 = (-0.25 * s - 3.0 * s_1) / t;
        }
        value << std::cos(0.5 * p), s * psi;
        slope.row(0) = -0.5 * s * psi.transpose();
        slope.bottomRows<3>() = s_1 * psi * psi.transpose();
        slope.bottomRows<3>().diagonal().array() += s;
    }
    /// q and -q are the same rotation.
    void flip() noexcept { value = -value, slope = -slope, sign = -sign; }
    /// Second derivative of c . q.
    Mat3 curvature(const Vec4& c) const noexcept {
        const Vec3 v = c.tail<3>();
        const double along = v.dot(psi);
        Mat3 sum = (s_2 * along - 0.5 * s_1 * c[0]) * psi * psi.transpose() + s_1 * (v * psi.transpose() + psi * v.transpose());
        sum.diagonal().array() += s_1 * along - 0.5 * s * c[0];
        return sign * sum;
    }
};

/// |q|^2 R(q) n, and its derivative by q.
inline Vec3 turned_forwards(const Vec4& q, const Vec3& n) noexcept {
    const Vec3 v = q.tail<3>();
    return (q[0] * q[0] - v.squaredNorm()) * n + 2.0 * v.dot(n) * v + 2.0 * q[0] * v.cross(n);
}
inline Mat34 turned_forwards_slope(const Vec4& q, const Vec3& n) noexcept {
    const Vec3 v = q.tail<3>();
    Mat34 L;
    L.col(0) = 2.0 * (q[0] * n + v.cross(n));
    L.rightCols<3>() = 2.0 * (v * n.transpose() - n * v.transpose() - q[0] * core::cross_matrix(n));
    L.rightCols<3>().diagonal().array() += 2.0 * v.dot(n);
    return L;
}
/// The same of |q|^2 R(q)^T n.
inline Vec4 conjugate(const Vec4& q) noexcept { return {q[0], -q[1], -q[2], -q[3]}; }
inline Mat34 turned_back_slope(const Vec4& q, const Vec3& n) noexcept {
    Mat34 L = turned_forwards_slope(conjugate(q), n);
    L.rightCols<3>() *= -1.0;
    return L;
}
/// N with d . |q|^2 R(q) n = q^T N q.
inline Mat4 turned_form(const Vec3& d, const Vec3& n) noexcept {
    Mat4 N;
    const Vec3 c = n.cross(d);
    N(0, 0) = d.dot(n);
    N.block<1, 3>(0, 1) = c.transpose();
    N.block<3, 1>(1, 0) = c;
    N.bottomRightCorner<3, 3>() = d * n.transpose() + n * d.transpose();
    N.bottomRightCorner<3, 3>().diagonal().array() -= N(0, 0);
    return N;
}
/// V with m . vec(q_1* q_2) = q_1^T V q_2.
inline Mat4 relative_form(const Vec3& m) noexcept {
    Mat4 V;
    V(0, 0) = 0.0;
    V.block<1, 3>(0, 1) = m.transpose();
    V.block<3, 1>(1, 0) = -m;
    V.bottomRightCorner<3, 3>() = core::cross_matrix(m);
    return V;
}

/// F with (rotation vector of q_1* q_2) = F(w) vec(q_1* q_2), w = q_1 . q_2 > 0, and two derivatives.
inline std::array<double, 3> logarithm(double w) noexcept {
    const double z = 1.0 - w;
    if (z < 0.1) {  // 2 sum 2^k k!^2 / (2k + 1)! z^k
        double term = 2.0, power = 1.0, power_1 = 0.0, power_2 = 0.0;
        std::array<double, 3> sum{};
        for (int k = 0; k < 13; ++k) {
            sum[0] += term * power, sum[1] -= term * power_1, sum[2] += term * power_2;
            power_2 = 2.0 * power_1 + z * power_2;
            power_1 = power + z * power_1;
            power *= z;
            term *= static_cast<double>(k + 1) / static_cast<double>(2 * k + 3);
        }
        return sum;
    }
    const double square = 1.0 - w * w, g = std::acos(w) / std::sqrt(square);
    const double g_1 = (w * g - 1.0) / square, g_2 = (g + 3.0 * w * g_1) / square;
    return {2.0 * g, 2.0 * g_1, 2.0 * g_2};
}

}  // namespace fibrant::beam::detail

// SPDX-License-Identifier: MIT
#pragma once
/// @file Rotation vectors: their rotations, the spin of a change, and which of the vectors of one rotation is nearest.

#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>

namespace fibrant::core {

inline Mat3 cross_matrix(const Vec3& v) noexcept {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

namespace detail {
/// sum of (-t)^k / (2k + start)!, and its first derivatives by t, for t < 4.
inline std::array<double, 3> even_series(double t, int start) noexcept {
    double term = 1.0;
    for (int k = 2; k <= start; ++k) term /= k;
    std::array<double, 3> sum{};
    double power_1 = 0.0, power_2 = 0.0;  // d/dt and d^2/dt^2 of t^k
    double power = 1.0, factor = term;
    for (int k = 0; k < 16; ++k) {
        sum[0] += factor * power, sum[1] += factor * power_1, sum[2] += factor * power_2;
        power_2 = 2.0 * power_1 + t * power_2;
        power_1 = power + t * power_1;
        power *= t;
        factor /= -static_cast<double>((2 * k + start + 1) * (2 * k + start + 2));
    }
    return sum;
}
}  // namespace detail

/// Rotation by |psi| about psi.
inline Mat3 rotation(const Vec3& psi) noexcept {
    const double angle = psi.norm();
    return angle > 0.0 ? Mat3(Eigen::AngleAxisd(angle, psi / angle)) : Mat3(Mat3::Identity());
}

/// Rotation vector of a rotation, of the length pi at most.
inline Vec3 rotation_vector(const Mat3& turn) noexcept {
    Eigen::Quaterniond q(turn);
    if (q.w() < 0.0) q.coeffs() *= -1.0;
    const double sine = q.vec().norm();
    return sine > 0.0 ? Vec3(2.0 * std::atan2(sine, q.w()) / sine * q.vec()) : Vec3(Vec3::Zero());
}

/// The rotation vector psi + 2 pi k psi / |psi| of the same rotation that is nearest to another one.
inline Vec3 nearest_rotation_vector(const Vec3& psi, const Vec3& to) noexcept {
    const double angle = psi.norm(), turn = 2.0 * std::numbers::pi;
    if (angle == 0.0) {  // any axis will do
        const double turns = std::round(to.norm() / turn);
        return turns == 0.0 ? psi : Vec3(turns * turn * to.normalized());
    }
    const Vec3 axis = psi / angle;
    return psi + turn * std::round((to.dot(axis) - angle) / turn) * axis;
}

/// Coefficients of the spin: a = sin p / p, b = (1 - cos p) / p^2, c = (p - sin p) / p^3, and their derivatives over p.
struct SpinCoefficients {
    double a, b, c, a_1, b_1, c_1;
};
inline SpinCoefficients spin_coefficients(double p) noexcept {
    const double t = p * p;
    if (t < 1.0) {  // d/dp over p is 2 d/dt
        const auto a = detail::even_series(t, 1), b = detail::even_series(t, 2), c = detail::even_series(t, 3);
        return {a[0], b[0], c[0], 2.0 * a[1], 2.0 * b[1], 2.0 * c[1]};
    }
    const double s = std::sin(p), k = std::cos(p);
    return {s / p, (1.0 - k) / t, (p - s) / (t * p), (p * k - s) / (t * p), (p * s - 2.0 * (1.0 - k)) / (t * t),
            (p * (1.0 - k) - 3.0 * (p - s)) / (t * t * p)};
}

/// T with spin = T change of psi, the spin in space: T = a 1 + b [psi] + c psi psi^T. Singular at |psi| = 2 pi.
inline Mat3 spin_matrix(const Vec3& psi) noexcept {
    const SpinCoefficients k = spin_coefficients(psi.norm());
    Mat3 sum = cross_matrix(psi);
    for (Index c = 0; c < 3; ++c)
        for (Index r = 0; r < 3; ++r) sum(r, c) = (r == c ? k.a : 0.0) + k.b * sum(r, c) + k.c * psi[r] * psi[c];
    return sum;
}

/// Symmetric part of the derivative of T^T m by psi.
inline Mat3 spin_slope(const Vec3& psi, const Vec3& m) noexcept {
    const SpinCoefficients k = spin_coefficients(psi.norm());
    const double along = m.dot(psi);
    const Vec3 across = m.cross(psi);
    const double twice = 0.5 * k.c_1 * along;
    Mat3 part, sum;
    for (Index c = 0; c < 3; ++c)
        for (Index r = 0; r < 3; ++r)
            part(r, c) = k.a_1 * psi[r] * m[c] + k.b_1 * psi[r] * across[c] + twice * psi[r] * psi[c] + k.c * m[r] * psi[c];
    for (Index c = 0; c < 3; ++c)
        for (Index r = 0; r < 3; ++r) sum(r, c) = 0.5 * (part(r, c) + part(c, r)) + twice * psi[r] * psi[c];
    for (Index c = 0; c < 3; ++c) sum(c, c) += k.c * along;
    return sum;
}

}  // namespace fibrant::core

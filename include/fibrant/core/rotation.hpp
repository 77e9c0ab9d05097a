// SPDX-License-Identifier: MIT
#pragma once
/// @file Rotation vectors: their rotations, the spin of a change, and which of the vectors of one rotation is nearest.

#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cmath>
#include <numbers>

namespace fibrant::core {

/// Matrix of the cross product: cross_matrix(v) w = v x w.
inline Mat3 cross_matrix(const Vec3& v) noexcept {
    return columns(Vec3(0, v.z(), -v.y()), Vec3(-v.z(), 0, v.x()), Vec3(v.y(), -v.x(), 0));
}

/// Rotation by an angle [radian] about a unit axis.
inline Mat3 turn_about(const Vec3& axis, double angle) noexcept {
    const Vec3 across = std::sin(angle) * axis;
    const double cosine = std::cos(angle);
    const Vec3 along = (1.0 - cosine) * axis;
    const double xy = along.x() * axis.y(), xz = along.x() * axis.z(), yz = along.y() * axis.z();
    return columns(Vec3(along.x() * axis.x() + cosine, xy + across.z(), xz - across.y()),
                   Vec3(xy - across.z(), along.y() * axis.y() + cosine, yz + across.x()),
                   Vec3(xz + across.y(), yz - across.x(), along.z() * axis.z() + cosine));
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
    Mat3 turn = Mat3::Identity();
    if (!(angle > 0.0)) return turn;
    const double sine = std::sin(angle), cosine = std::cos(angle);
    for (Index i = 0; i < 3; ++i) {
        const Index j = (i + 1) % 3, k = (i + 2) % 3;
        const double a = psi[i] / angle, b = psi[j] / angle, c = psi[k] / angle;
        turn(i, i) = (1.0 - cosine) * a * a + cosine;
        const double both = (1.0 - cosine) * (i < j ? a : b) * (i < j ? b : a);
        turn(i, j) = both - sine * c, turn(j, i) = both + sine * c;
    }
    return turn;
}

/// Rotation vector of a rotation, of the length pi at most.
inline Vec3 rotation_vector(const Mat3& turn) noexcept {
    // Its quaternion, from the largest of its four components.
    Vec3 q;
    double w = turn(0, 0) + (turn(1, 1) + turn(2, 2));
    if (w > 0.0) {
        double part = std::sqrt(w + 1.0);
        w = 0.5 * part, part = 0.5 / part;
        q = {(turn(2, 1) - turn(1, 2)) * part, (turn(0, 2) - turn(2, 0)) * part, (turn(1, 0) - turn(0, 1)) * part};
    } else {
        Index i = turn(1, 1) > turn(0, 0) ? 1 : 0;
        if (turn(2, 2) > turn(i, i)) i = 2;
        const Index j = (i + 1) % 3, k = (j + 1) % 3;
        double part = std::sqrt(turn(i, i) - turn(j, j) - turn(k, k) + 1.0);
        q[i] = 0.5 * part, part = 0.5 / part;
        w = (turn(k, j) - turn(j, k)) * part;
        q[j] = (turn(j, i) + turn(i, j)) * part, q[k] = (turn(k, i) + turn(i, k)) * part;
    }
    if (w < 0.0) w = -w, q = Vec3(-q);
    const double sine = q.norm();
    return sine > 0.0 ? Vec3(2.0 * std::atan2(sine, w) / sine * q) : Vec3(Vec3::Zero());
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
    return {s / p,
            (1.0 - k) / t,
            (p - s) / (t * p),
            (p * k - s) / (t * p),
            (p * s - 2.0 * (1.0 - k)) / (t * t),
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

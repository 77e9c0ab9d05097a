// SPDX-License-Identifier: MIT
#pragma once
/// @file Strains of a director beam at one point: every one is a scalar product of two fields, less that at rest.

#include <fibrant/beam/section_law.hpp>
#include <fibrant/core/types.hpp>

#include <utility>

namespace fibrant::beam {

/// Columns a = x_0', g_1, g_2, g_1', g_2' at a point; the prime is the derivative with respect to rest arc length.
using DirectorFields = Eigen::Matrix<double, 3, 5>;

namespace detail {

/// Calls body(integral constant k) for k in [First, Last), unrolled.
template <int First, int Last, class Body>
constexpr void unrolled(const Body& body) {
    [&]<int... k>(std::integer_sequence<int, k...>) { (body(std::integral_constant<int, First + k>{}), ...); }
    (std::make_integer_sequence<int, Last - First>{});
}

/// Which two fields a strain multiplies, first <= second; a field by itself counts half.
struct FieldPair {
    int first, second;
};
inline constexpr std::array<FieldPair, 15> strain_fields{{{1, 1},
                                                          {2, 2},
                                                          {1, 2},  // e11 e22 e12
                                                          {0, 0},
                                                          {0, 1},
                                                          {0, 2},  // e33 e13 e23
                                                          {0, 3},
                                                          {0, 4},  // b1 b2
                                                          {1, 3},
                                                          {1, 4},
                                                          {2, 3},
                                                          {2, 4},  // c11 c12 c21 c22
                                                          {3, 3},
                                                          {3, 4},
                                                          {4, 4}}};  // q11 q12 q22

/// p.q - P.Q = P.dq + dp.Q + dp.dq for p = P + dp, which keeps the digits that p.q - P.Q loses.
inline double product_change(const Vec3& P, const Vec3& dp, const Vec3& Q, const Vec3& dq) noexcept {
    return P.dot(dq) + dp.dot(Q) + dp.dot(dq);
}
/// (p.p - P.P)/2.
inline double half_square_change(const Vec3& P, const Vec3& dp) noexcept { return dp.dot(P) + 0.5 * dp.squaredNorm(); }

/// Strain C from fields at rest and their change.
template <int C>
double strain_change(const DirectorFields& rest, const DirectorFields& change) noexcept {
    constexpr FieldPair f = strain_fields[C];
    if constexpr (f.first == f.second) {
        return half_square_change(rest.col(f.first), change.col(f.first));
    } else {
        return product_change(rest.col(f.first), change.col(f.first), rest.col(f.second), change.col(f.second));
    }
}

/// Derivative of strain C in the direction of `step`.
template <int C>
double strain_rate(const DirectorFields& current, const DirectorFields& step) noexcept {
    constexpr FieldPair f = strain_fields[C];
    double rate = current.col(f.first).dot(step.col(f.second));
    if constexpr (f.first != f.second) rate += step.col(f.first).dot(current.col(f.second));
    return rate;
}

}  // namespace detail

/// Torsion over the mean square of the directors, t = T/m with T = g_2.g_1' - g_1.g_2' and m = g_1.g_1 + g_2.g_2: c12 = s - t and
/// c21 = s + t then, s = (c12 + c21)/2 as ever. A template, so that only beams of this strain have it compiled.
namespace detail {
template <class Fields>
struct TurnStrainOf {
    double m, t;
    explicit TurnStrainOf(const Fields& y) noexcept
        : m{y.col(1).squaredNorm() + y.col(2).squaredNorm()}, t{(y.col(2).dot(y.col(3)) - y.col(1).dot(y.col(4))) / m} {}
    /// Of the directions of the fields g_1, g_2, g_1', g_2', each of which gets a column.
    Eigen::Matrix<double, 3, 4> slope(const Fields& y) const noexcept {
        Eigen::Matrix<double, 3, 4> by;
        by.col(0) = (-y.col(4) - 2.0 * t * y.col(1)) / m;
        by.col(1) = (y.col(3) - 2.0 * t * y.col(2)) / m;
        by.col(2) = y.col(2) / m;
        by.col(3) = -y.col(1) / m;
        return by;
    }
    double rate(const Fields& y, const Fields& step) const noexcept {
        return slope(y).cwiseProduct(step.template rightCols<4>()).sum();
    }
    /// What it is more than in another state, to the digits of `change`.
    static double change(const Fields& rest, const Fields& change) noexcept {
        const TurnStrainOf before(rest);
        const double T = product_change(rest.col(2), change.col(2), rest.col(3), change.col(3)) -
                         product_change(rest.col(1), change.col(1), rest.col(4), change.col(4));
        const double m = 2.0 * (half_square_change(rest.col(1), change.col(1)) + half_square_change(rest.col(2), change.col(2)));
        return (T - before.t * m) / (before.m + m);
    }
};
using TurnStrain = TurnStrainOf<DirectorFields>;
}  // namespace detail

/// Strains at a point and what follows from them; `Section` tells whether E_11, E_22, 2 E_12 are evaluated here.
template <ElasticLaw Law, QuadraticStrain Quadratic, bool Section, TwistStrain Twist = TwistStrain::metric>
struct DirectorStrains {
    using Elastic = SectionLaw<Law, Quadratic>;
    using Strains = typename Elastic::Strains;
    static constexpr int first = Section ? 0 : 3;  ///< strains below belong to the nodes
    static constexpr bool mean = Quadratic != QuadraticStrain::none, turn = Twist == TwistStrain::turn;
    /// Second derivative of (stress . strain) with respect to the fields: scalars, times the unit matrix.
    using FieldMatrix = Eigen::Matrix<double, 5, 5>;
    /// Second derivative of the energy: 15 x 15, one unused row that keeps columns aligned.
    using FieldTangent = Eigen::Matrix<double, 16, 15>;

    /// Writes the strains from `first` on.
    static void change(const Elastic& law, const DirectorFields& rest, const DirectorFields& change, Strains& e) {
        detail::unrolled<first, Elastic::strains>([&](auto c) { e[c()] = detail::strain_change<c()>(rest, change); });
        if constexpr (mean) {
            e[strain::e33] += law.mean_1() * detail::half_square_change(rest.col(3), change.col(3)) +
                              law.mean_2() * detail::half_square_change(rest.col(4), change.col(4));
        }
        if constexpr (turn) take_twist(e, detail::TurnStrain::change(rest, change));
    }
    /// Adds the derivatives in the direction `step` to the strains from `first` on.
    static void add_rate(const Elastic& law, const DirectorFields& current, const DirectorFields& step, Strains& e) {
        const double before = 0.5 * (e[strain::c21] - e[strain::c12]);
        detail::unrolled<first, Elastic::strains>([&](auto c) { e[c()] += detail::strain_rate<c()>(current, step); });
        if constexpr (turn) take_twist(e, before + detail::TurnStrain(current).rate(current, step));
        if constexpr (mean) {
            e[strain::e33] += law.mean_1() * current.col(3).dot(step.col(3)) + law.mean_2() * current.col(4).dot(step.col(4));
        }
    }
    /// sum_c s_c H_c: the force on the fields is `current * geometric(...)`.
    static FieldMatrix geometric(const Elastic& law, const DirectorFields& y, Strains s) {
        FieldMatrix H = FieldMatrix::Zero();
        if constexpr (turn) {  // the conjugate of t goes by T and m
            const detail::TurnStrain twist(y);
            const double even = 0.5 * (s[strain::c12] + s[strain::c21]), torque = s[strain::c21] - s[strain::c12];
            s[strain::c12] = even - torque / twist.m, s[strain::c21] = even + torque / twist.m;
            H(1, 1) = H(2, 2) = -2.0 * twist.t * torque / twist.m;
        }
        detail::unrolled<first, Elastic::strains>([&](auto c) {
            constexpr detail::FieldPair f = detail::strain_fields[c()];
            H(f.first, f.second) += s[c()];
            if constexpr (f.first != f.second) H(f.second, f.first) += s[c()];
        });
        if constexpr (mean) {
            H(3, 3) += law.mean_1() * s[strain::e33];
            H(4, 4) += law.mean_2() * s[strain::e33];
        }
        return H;
    }
    /// weight (B^T C B + G (x) I_3); with nodal section strains, without their coupling to E_33.
    /// @param s  that G is made of
    static void tangent(const Elastic& law, const DirectorFields& y, const FieldMatrix& G, [[maybe_unused]] const Strains& s,
                        double weight, FieldTangent& D) {
        D.setZero();
        const auto add = [&](auto row, auto column, double factor, const Vec3& u, const Vec3& v) {
            static_assert(row() <= column());
            for (int j = 0; j < 3; ++j) {
                for (int i = 0; i < 3; ++i) D(3 * row() + i, 3 * column() + j) += factor * u[i] * v[j];
            }
        };
        constexpr auto f0 = std::integral_constant<int, 0>{};
        constexpr auto f1 = std::integral_constant<int, 1>{};
        constexpr auto f2 = std::integral_constant<int, 2>{};
        constexpr auto f3 = std::integral_constant<int, 3>{};
        constexpr auto f4 = std::integral_constant<int, 4>{};
        const Vec3 a = y.col(0), g1 = y.col(1), g2 = y.col(2), h1 = y.col(3), h2 = y.col(4);
        detail::unrolled<first, Elastic::strains>([&](auto c) {
            if constexpr (turn && (c() == strain::c12 || c() == strain::c21)) return;
            constexpr detail::FieldPair f = detail::strain_fields[c()];
            constexpr auto p = std::integral_constant<int, f.first>{};
            constexpr auto q = std::integral_constant<int, f.second>{};
            const double k = weight * law.diagonal(c());
            const Vec3 u = y.col(f.second), v = y.col(f.first);
            add(p, p, k, u, u);
            if constexpr (f.first != f.second) {
                add(p, q, k, u, v);
                add(q, q, k, v, v);
            }
        });
        if constexpr (turn) {
            const detail::TurnStrain twist(y);
            const Eigen::Matrix<double, 3, 4> by_t = twist.slope(y);
            Eigen::Matrix<double, 3, 4> by_s, by_m = Eigen::Matrix<double, 3, 4>::Zero();
            by_s << 0.5 * h2, 0.5 * h1, 0.5 * g2, 0.5 * g1;
            by_m.col(0) = 2.0 * g1, by_m.col(1) = 2.0 * g2;
            const Eigen::Matrix<double, 3, 4> force_s = weight * (law.even() * by_s + law.odd() * by_t);
            const Eigen::Matrix<double, 3, 4> force_t =
                weight * (law.odd() * by_s + law.twist() * by_t - (s[strain::c21] - s[strain::c12]) / twist.m * by_m);
            const Eigen::Matrix<double, 3, 4> force_m = -weight * (s[strain::c21] - s[strain::c12]) / twist.m * by_t;
            detail::unrolled<1, 5>([&](auto q) {
                detail::unrolled<1, q() + 1>([&](auto p) {
                    add(p, q, 1.0, force_s.col(p() - 1), by_s.col(q() - 1));
                    add(p, q, 1.0, force_t.col(p() - 1), by_t.col(q() - 1));
                    add(p, q, 1.0, force_m.col(p() - 1), by_m.col(q() - 1));
                });
            });
        }
        if (const double k = weight * law.twist_coupling(); !turn && k != 0.0) {
            add(f1, f2, k, h2, h1);
            add(f1, f3, k, h2, g2);
            add(f2, f4, k, h1, g1);
            add(f3, f4, k, g2, g1);
        }
        if constexpr (Section) {
            const double k = weight * law.coupling();
            add(f0, f1, k, a, g1);
            add(f0, f2, k, a, g2);
            add(f1, f2, k, g1, g2);
            if constexpr (mean) {
                add(f1, f3, k * law.mean_1(), g1, h1);
                add(f1, f4, k * law.mean_2(), g1, h2);
                add(f2, f3, k * law.mean_1(), g2, h1);
                add(f2, f4, k * law.mean_2(), g2, h2);
            }
        }
        if constexpr (mean) {
            const double k = weight * law.diagonal(strain::e33), m1 = law.mean_1(), m2 = law.mean_2();
            add(f0, f3, k * m1, a, h1);
            add(f0, f4, k * m2, a, h2);
            add(f3, f3, k * m1 * m1, h1, h1);
            add(f3, f4, k * m1 * m2, h1, h2);
            add(f4, f4, k * m2 * m2, h2, h2);
        }
        if constexpr (Quadratic == QuadraticStrain::complete) {
            add(f3, f4, weight * law.quadratic_coupling(), h1, h2);
        }
        for (int q = 0; q < 5; ++q) {
            for (int p = 0; p <= q; ++p) {
                for (int i = 0; i < 3; ++i) D(3 * p + i, 3 * q + i) += weight * G(p, q);
            }
        }
        for (int q = 0; q < 5; ++q) {
            for (int p = 0; p < q; ++p) {
                for (int j = 0; j < 3; ++j) {
                    for (int i = 0; i < 3; ++i) D(3 * q + j, 3 * p + i) = D(3 * p + i, 3 * q + j);
                }
            }
        }
    }

private:
    /// Writes c12 and c21 for another torsion.
    static void take_twist(Strains& e, double t) noexcept {
        const double even = 0.5 * (e[strain::c12] + e[strain::c21]);
        e[strain::c12] = even - t, e[strain::c21] = even + t;
    }
};

}  // namespace fibrant::beam

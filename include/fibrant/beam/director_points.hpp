// SPDX-License-Identifier: MIT
#pragma once
/// @file From the nodes of a director beam to its Gauss points and back: fields, forces, and columns of the tangent.

#include <fibrant/beam/director_strains.hpp>
#include <fibrant/beam/lagrange.hpp>

namespace fibrant::beam::detail {

/// Interpolation of a director beam at its Nodes - 1 Gauss points; node I has x_0, g_1, g_2 at 9 I, 9 I + 3, 9 I + 6.
template <int Nodes>
struct DirectorPoints {
    static constexpr int points = Nodes - 1;
    static constexpr int unknowns = 9 * Nodes;
    using Values = std::array<double, Nodes>;
    using ElementVector = Eigen::Matrix<double, unknowns, 1>;
    using ElementMatrix = Eigen::Matrix<double, unknowns, unknowns>;
    using Fields = std::array<DirectorFields, points>;

    /// What does not change at a point.
    struct Point {
        double weight = 0;      ///< rest arc length that the point stands for [length]
        Values derivative{};    ///< dN_I/ds [1 / length]
        DirectorFields fields;  ///< at rest
    };
    using Points = std::array<Point, points>;

    static constexpr std::array<QuadraturePoint, points> gauss = gauss_points<points>();
    static constexpr std::array<Values, points> shape_at = [] {
        std::array<Values, points> N{};
        for (std::size_t p = 0; p < N.size(); ++p) N[p] = Lagrange<Nodes>::shape(gauss[p].xi);
        return N;
    }();

    /// Director g_K of node I.
    template <int K>
    static Vec3 director(const ElementVector& y, int I) noexcept {
        return y.template segment<3>(9 * I + 3 * K);
    }
    static DirectorFields fields(const Values& N, const Values& dN, const ElementVector& y) noexcept {
        DirectorFields f;
        for (int k = 0; k < 3; ++k) {
            double a = 0, g1 = 0, g2 = 0, h1 = 0, h2 = 0;
            for (int I = 0; I < Nodes; ++I) {
                const double n = N[core::at(I)], d = dN[core::at(I)];
                a += d * y[9 * I + k];
                g1 += n * y[9 * I + 3 + k];
                g2 += n * y[9 * I + 6 + k];
                h1 += d * y[9 * I + 3 + k];
                h2 += d * y[9 * I + 6 + k];
            }
            f(k, 0) = a;
            f(k, 1) = g1;
            f(k, 2) = g2;
            f(k, 3) = h1;
            f(k, 4) = h2;
        }
        return f;
    }
    static Fields all_fields(const Points& point, const ElementVector& y) noexcept {
        Fields f;
        for (std::size_t p = 0; p < f.size(); ++p) f[p] = fields(shape_at[p], point[p].derivative, y);
        return f;
    }
    /// Adds forces on the fields of point p to those on the nodes.
    static void add_force(const Point& point, std::size_t p, const DirectorFields& f, ElementVector& force) noexcept {
        for (int I = 0; I < Nodes; ++I) {
            const double n = shape_at[p][core::at(I)], d = point.derivative[core::at(I)];
            force.template segment<3>(9 * I) += d * f.col(0);
            force.template segment<3>(9 * I + 3) += n * f.col(1) + d * f.col(3);
            force.template segment<3>(9 * I + 6) += n * f.col(2) + d * f.col(4);
        }
    }
    /// Column j of node J of the nodal tangent, from the tangents of the fields: x_0 by N', directors by N and N'.
    template <class FieldTangent>
    static void column(const Points& point, const std::array<FieldTangent, points>& D, std::size_t J, std::size_t j,
                       double* out) noexcept {
        double by_field[16 * points];  // derivatives of the forces on the fields
        for (std::size_t p = 0; p < points; ++p) {
            const double n = shape_at[p][J], d = point[p].derivative[J];
            const double* const first = D[p].data() + 16 * j;
            const double* const second = first + 16 * 6;
            double* const t = by_field + 16 * p;
            if (j < 3) {
                for (std::size_t r = 0; r < 16; ++r) t[r] = d * first[r];
            } else {
                for (std::size_t r = 0; r < 16; ++r) t[r] = n * first[r] + d * second[r];
            }
        }
        for (std::size_t I = 0; I < Nodes; ++I, out += 9) {
            double row[9] = {};
            for (std::size_t p = 0; p < points; ++p) {
                const double n = shape_at[p][I], d = point[p].derivative[I];
                const double* const t = by_field + 16 * p;
                for (std::size_t r = 0; r < 3; ++r) row[r] += d * t[r];
                for (std::size_t r = 3; r < 9; ++r) row[r] += n * t[r] + d * t[r + 6];
            }
            for (std::size_t r = 0; r < 9; ++r) out[r] = row[r];
        }
    }
};

/// Section strains E_11, E_22, 2 E_12 sampled at the nodes and interpolated to the points.
template <int Nodes>
struct NodalSection {
    using Base = DirectorPoints<Nodes>;
    static constexpr int points = Base::points;
    using ElementVector = typename Base::ElementVector;
    using Three = std::array<std::array<double, 3>, Nodes>;  ///< three numbers a node

    static Three change(const ElementVector& rest, const ElementVector& u) noexcept {
        Three section;
        for (int I = 0; I < Nodes; ++I) {
            const Vec3 G1 = Base::template director<1>(rest, I), G2 = Base::template director<2>(rest, I);
            const Vec3 d1 = Base::template director<1>(u, I), d2 = Base::template director<2>(u, I);
            section[core::at(I)] = {half_square_change(G1, d1), half_square_change(G2, d2), product_change(G1, d1, G2, d2)};
        }
        return section;
    }
    static Three rate(const ElementVector& current, const ElementVector& step) noexcept {
        Three section;
        for (int I = 0; I < Nodes; ++I) {
            const Vec3 g1 = Base::template director<1>(current, I), g2 = Base::template director<2>(current, I);
            const Vec3 d1 = Base::template director<1>(step, I), d2 = Base::template director<2>(step, I);
            section[core::at(I)] = {g1.dot(d1), g2.dot(d2), g1.dot(d2) + g2.dot(d1)};
        }
        return section;
    }
    /// Adds the strains at point p.
    template <class Strains>
    static void interpolate(std::size_t p, const Three& section, Strains& e) noexcept {
        for (std::size_t I = 0; I < Nodes; ++I) {
            for (std::size_t c = 0; c < 3; ++c) e[c] += Base::shape_at[p][I] * section[I][c];
        }
    }
    /// Stresses gathered at the nodes: sum_p w N_I s.
    template <class Stresses>
    static Three gather(const typename Base::Points& point, const Stresses& s) noexcept {
        Three sum{};
        for (std::size_t p = 0; p < point.size(); ++p) {
            for (std::size_t I = 0; I < Nodes; ++I) {
                for (std::size_t c = 0; c < 3; ++c) sum[I][c] += point[p].weight * Base::shape_at[p][I] * s[p][c];
            }
        }
        return sum;
    }
    static void add_force(const ElementVector& current, const Three& stress, ElementVector& force) noexcept {
        for (int I = 0; I < Nodes; ++I) {
            const Vec3 g1 = Base::template director<1>(current, I), g2 = Base::template director<2>(current, I);
            const std::array<double, 3>& t = stress[core::at(I)];
            force.template segment<3>(9 * I + 3) += t[0] * g1 + t[2] * g2;
            force.template segment<3>(9 * I + 6) += t[1] * g2 + t[2] * g1;
        }
    }

    /// Their part of the tangent, in columns: among themselves, with E_33 (Poisson), and geometric.
    template <bool Mean>
    struct Tangent {
        /// With i_K = g_K of node I and j_K of node J, m_IJ = sum_p w N_I N_J and c_J = sum_p w N_J lam A dE_33/dy:
        /// column c of g_1J is j_1[c] first + j_2[c] mixed, of g_2J it is j_2[c] second + j_1[c] mixed.
        using Column = std::array<double, Base::unknowns>;
        std::array<Column, Nodes> first, second, mixed;
        std::array<Column, Nodes> poisson;  ///< c_J
        const double* current;
        Three stress;  ///< gathered

        template <class Law>
        Tangent(const Law& law, const typename Base::Points& point, const typename Base::Fields& y, const ElementVector& current_,
                const Three& stress_) noexcept
            : current{current_.data()}, stress{stress_} {
            const double normal = law.diagonal(strain::e11), lateral = law.coupling();
            const double shear = law.diagonal(strain::e12);
            for (std::size_t J = 0; J < Nodes; ++J) {
                for (std::size_t I = 0; I < Nodes; ++I) {
                    double mass = 0.0;
                    std::array<double, points> axial;
                    for (std::size_t p = 0; p < points; ++p) {
                        const double w = point[p].weight * Base::shape_at[p][J];
                        mass += w * Base::shape_at[p][I];
                        axial[p] = w * lateral * point[p].derivative[I];
                    }
                    const double* const g = current + 9 * I;
                    for (std::size_t k = 0; k < 3; ++k) {
                        double x = 0.0, h1 = 0.0, h2 = 0.0;
                        for (std::size_t p = 0; p < points; ++p) {
                            const double* const f = y[p].data();
                            x += axial[p] * f[k];
                            if constexpr (Mean) {
                                h1 += axial[p] * law.mean_1() * f[9 + k];
                                h2 += axial[p] * law.mean_2() * f[12 + k];
                            }
                        }
                        const double g1 = mass * g[3 + k], g2 = mass * g[6 + k];
                        const std::size_t r = 9 * I + k;
                        poisson[J][r] = first[J][r] = second[J][r] = x;
                        poisson[J][r + 3] = h1;
                        poisson[J][r + 6] = h2;
                        first[J][r + 3] = normal * g1 + h1;
                        first[J][r + 6] = lateral * g2 + h2;
                        second[J][r + 3] = lateral * g1 + h1;
                        second[J][r + 6] = normal * g2 + h2;
                        mixed[J][r] = 0.0;
                        mixed[J][r + 3] = shear * g2;
                        mixed[J][r + 6] = shear * g1;
                    }
                }
            }
        }
        /// Adds to column j of node J.
        void add(std::size_t J, std::size_t j, double* out) const noexcept {
            if (j >= 3) {
                const std::size_t k = j % 3, g1 = 9 * J + 3 + k, g2 = 9 * J + 6 + k;
                const double own = current[j < 6 ? g1 : g2], other = current[j < 6 ? g2 : g1];
                const Column& u = (j < 6 ? first : second)[J];
                for (std::size_t r = 0; r < Base::unknowns; ++r) out[r] += own * u[r] + other * mixed[J][r];
                out[g1] += j < 6 ? stress[J][0] : stress[J][2];
                out[g2] += j < 6 ? stress[J][2] : stress[J][1];
            }
            if (j < 3 || Mean) {
                for (std::size_t I = 0; I < Nodes; ++I) {
                    const double c = poisson[I][9 * J + j];
                    for (std::size_t r = 9 * I + 3; r < 9 * I + 9; ++r) out[r] += c * current[r];
                }
            }
        }
    };
};

}  // namespace fibrant::beam::detail

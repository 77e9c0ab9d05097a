// SPDX-License-Identifier: MIT
#pragma once
/// @file The director beam: a centreline and two free directors, full Green-Lagrange strain, no rotations.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/director_strains.hpp>
#include <fibrant/beam/lagrange.hpp>
#include <fibrant/beam/section_law.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::beam {

/// Variant of the director beam; all combinations are elements, the default is the one to use.
struct DirectorBeamOptions {
    ElasticLaw law = ElasticLaw::split;
    SectionSampling sampling = SectionSampling::nodal;
    QuadraticStrain quadratic = QuadraticStrain::none;
};

/// Beam x = x_0 + xi_1 g_1 + xi_2 g_2 with 9 unknowns a node (Durville, eq. 1 and 2), Nodes - 1 Gauss points.
///
/// All strains are quadratic in the unknowns, eps_c = y.H_c y/2 - rest; the force is sum w S_c H_c y and the tangent
/// sum w (B^T C B + S_c H_c (x) I_3), exact and symmetric. Two Gauss points on three nodes and section strains sampled
/// at the nodes leave no locking; exactly the six rigid motions have no energy. Keep below 90 degrees of turn an element.
template <int Nodes = 3, DirectorBeamOptions Options = DirectorBeamOptions{}>
class DirectorBeam {
public:
    static constexpr int nodes = Nodes, vectors_per_node = 3, dofs_per_node = 9, reach = Nodes - 1;
    static constexpr int points = Nodes - 1;  ///< of Gauss
    static constexpr std::array<scene::VectorKind, 3> kinds{scene::VectorKind::position, scene::VectorKind::direction,
                                                            scene::VectorKind::direction};
    static constexpr DirectorBeamOptions options = Options;
    using ElementVector = Eigen::Matrix<double, 9 * Nodes, 1>;
    using ElementMatrix = Eigen::Matrix<double, 9 * Nodes, 9 * Nodes>;
    using ElementWeights = std::array<double, static_cast<std::size_t>(3 * Nodes)>;
    using Law = SectionLaw<Options.law, Options.quadratic>;
    using Strains = typename Law::Strains;

    struct Parameters {
        double shear_factor = 1.0;  ///< of the transverse shear stiffness [1], > 0
        void validate() const { core::require_positive("DirectorBeam.shear_factor", shear_factor); }
    };

    /// What an element keeps of its rest shape.
    struct Rest {
        struct Point {
            double weight = 0;                       ///< rest arc length that the point stands for [length]
            std::array<double, Nodes> derivative{};  ///< dN_I/ds [1 / length]
            DirectorFields fields;                   ///< at rest
        };
        ElementVector configuration;
        std::array<Point, points> point;
        Law law;

        /// Rest arc length as integrated by the element [length].
        double length() const noexcept {
            double sum = 0.0;
            for (const Point& p : point) sum += p.weight;
            return sum;
        }
    };

    /// Conjugates of all strains at all points, a unit of rest length; indices of `strain`.
    struct Stresses {
        std::array<Strains, points> value{};
    };

    DirectorBeam() : DirectorBeam(Parameters{}) {}
    explicit DirectorBeam(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    /// Throws std::invalid_argument for a section or material that is not valid and for a degenerate rest shape.
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material,
              const ElementVector& rest_configuration) const {
        return rest(section_constants(section), material, rest_configuration);
    }
    /// The same for a section of any shape.
    Rest rest(const SectionConstants& section, const scene::ElasticMaterial& material,
              const ElementVector& rest_configuration) const {
        Rest rest;
        rest.law = Law(section, material, parameters_.shear_factor);
        rest.configuration = rest_configuration;
        check_tangents(rest_configuration);
        for (int p = 0; p < points; ++p) {
            typename Rest::Point& point = rest.point[core::at(p)];
            const std::array<double, Nodes> slope = shape_derivative(gauss[core::at(p)].xi);
            Vec3 tangent = Vec3::Zero();
            for (int I = 0; I < Nodes; ++I) tangent += slope[core::at(I)] * rest_configuration.template segment<3>(9 * I);
            const double jacobian = tangent.norm();
            point.weight = gauss[core::at(p)].weight * jacobian;
            for (int I = 0; I < Nodes; ++I) point.derivative[core::at(I)] = slope[core::at(I)] / jacobian;
            point.fields = fields(shape_at[core::at(p)], point.derivative, rest_configuration);
            const double volume = volume_of(point.fields);
            core::require(std::isfinite(volume) && volume > 0.2, "DirectorBeam.rest: det(g_1, g_2, x_0')", volume,
                          "> 0.2: directors at rest are unit, orthogonal and right-handed with the tangent");
        }
        return rest;
    }

    double energy(const Rest& rest, const ElementVector& current) const {
        const std::array<Strains, points> e = strains(rest, change(rest, current));
        double sum = 0.0;
        for (std::size_t p = 0; p < e.size(); ++p) sum += rest.point[p].weight * rest.law.energy(e[p]);
        return sum;
    }

    ElementVector internal_force(const Rest& rest, const ElementVector& current) const {
        ElementVector force;
        add_force(rest, current, stresses(rest, current), force);
        return force;
    }

    /// Derivative of the internal force.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& current) const {
        return tangent_stiffness(rest, current, stresses(rest, current));
    }
    /// With the geometric part made of given stresses.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& current, const Stresses& geometric) const {
        ElementMatrix tangent;
        write_tangent(rest, current, geometric, tangent);
        return tangent;
    }
    void residual_and_tangent(const Rest& rest, const ElementVector& current, const Stresses& geometric,
                              ElementVector& force, ElementMatrix& tangent) const {
        add_force(rest, current, stresses(rest, current), force);
        write_tangent(rest, current, geometric, tangent);
    }

    Stresses stresses(const Rest& rest, const ElementVector& current) const {
        return stresses_of(rest, strains(rest, change(rest, current)));
    }
    /// C (eps(q) + B(q) step): what the stresses will be after `step` if strains were linear.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& current, const ElementVector& step) const {
        std::array<Strains, points> e = strains(rest, change(rest, current));
        std::array<std::array<double, 3>, Nodes> section{};
        if constexpr (nodal) {
            for (int I = 0; I < Nodes; ++I) {
                const Vec3 g1 = director<1>(current, I), g2 = director<2>(current, I);
                const Vec3 d1 = director<1>(step, I), d2 = director<2>(step, I);
                section[core::at(I)] = {g1.dot(d1), g2.dot(d2), g1.dot(d2) + g2.dot(d1)};
            }
        }
        for (std::size_t p = 0; p < e.size(); ++p) {
            Kernel::add_rate(rest.law, fields(shape_at[p], rest.point[p].derivative, current),
                             fields(shape_at[p], rest.point[p].derivative, step), e[p]);
            if constexpr (nodal) add_interpolated(shape_at[p], section, e[p]);
        }
        return stresses_of(rest, e);
    }
    /// Tension only: its geometric part is positive semidefinite.
    static Stresses without_compression(const Stresses& stresses) noexcept {
        Stresses tension;
        for (std::size_t p = 0; p < tension.value.size(); ++p) {
            tension.value[p][strain::e33] = std::max(0.0, stresses.value[p][strain::e33]);
        }
        return tension;
    }

    /// Least det(g_1, g_2, x_0') over the points, relative to rest [1]; <= 0 once the fibre is turned inside out.
    double least_volume_ratio(const Rest& rest, const ElementVector& current) const {
        double least = 1.0e300;
        for (std::size_t p = 0; p < rest.point.size(); ++p) {
            const DirectorFields y = fields(shape_at[p], rest.point[p].derivative, current);
            least = std::min(least, volume_of(y) / volume_of(rest.point[p].fields));
        }
        return least;
    }

    static constexpr std::array<double, Nodes> shape(double xi) noexcept { return Lagrange<Nodes>::shape(xi); }
    /// dN_I/dxi.
    static constexpr std::array<double, Nodes> shape_derivative(double xi) noexcept {
        return Lagrange<Nodes>::shape_derivative(xi);
    }
    /// x_0 at xi in [-1, 1].
    static constexpr ElementWeights centreline_weights(double xi) noexcept { return particle_weights(xi, 0.0, 0.0); }
    /// dx_0/dxi.
    static constexpr ElementWeights centreline_derivative_weights(double xi) noexcept {
        return node_weights(shape_derivative(xi), 0.0, 0.0);
    }
    /// x_0 + xi_1 g_1 + xi_2 g_2; @param xi1, xi2  material coordinates in the section [length].
    static constexpr ElementWeights particle_weights(double xi, double xi1, double xi2) noexcept {
        return node_weights(shape(xi), xi1, xi2);
    }

private:
    static constexpr bool nodal = Options.sampling == SectionSampling::nodal;
    using Kernel = DirectorStrains<Options.law, Options.quadratic, !nodal>;
    using Values = std::array<double, Nodes>;

    static constexpr std::array<QuadraturePoint, points> gauss = gauss_points<points>();
    static constexpr std::array<Values, points> shape_at = [] {
        std::array<Values, points> N{};
        for (std::size_t p = 0; p < N.size(); ++p) N[p] = Lagrange<Nodes>::shape(gauss[p].xi);
        return N;
    }();

    static constexpr ElementWeights node_weights(const Values& N, double xi1, double xi2) noexcept {
        ElementWeights w{};
        for (std::size_t I = 0; I < N.size(); ++I) {
            w[3 * I] = N[I];
            w[3 * I + 1] = xi1 * N[I];
            w[3 * I + 2] = xi2 * N[I];
        }
        return w;
    }
    template <int K>
    static Vec3 director(const ElementVector& y, int I) noexcept {
        return y.template segment<3>(9 * I + 3 * K);
    }
    static double volume_of(const DirectorFields& y) noexcept {
        const Vec3 normal = y.col(1).cross(y.col(2));
        return normal.dot(y.col(0));
    }
    /// A displacement keeps more digits than the two configurations it is the difference of.
    static ElementVector change(const Rest& rest, const ElementVector& current) noexcept {
        return current - rest.configuration;
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
    static void add_interpolated(const Values& N, const std::array<std::array<double, 3>, Nodes>& section, Strains& e) {
        for (std::size_t I = 0; I < N.size(); ++I) {
            for (std::size_t c = 0; c < 3; ++c) e[c] += N[I] * section[I][c];
        }
    }
    /// The tangent never turns back between the ends and the points, so the arc length grows.
    static void check_tangents(const ElementVector& y) {
        Vec3 before = Vec3::Zero();
        for (int k = 0; k < points + 2; ++k) {
            const double xi = k == 0 ? -1.0 : k <= points ? gauss[core::at(k - 1)].xi : 1.0;
            const Values slope = shape_derivative(xi);
            Vec3 tangent = Vec3::Zero();
            for (int I = 0; I < Nodes; ++I) tangent += slope[core::at(I)] * y.template segment<3>(9 * I);
            const double length = tangent.norm();
            core::require(std::isfinite(length) && length > 0.0, "DirectorBeam.rest: |dx_0/dxi|", length,
                          "finite and > 0");
            if (k > 0) {
                core::require(tangent.dot(before) > 0.0, "DirectorBeam.rest: turn of the tangent, cosine",
                              tangent.dot(before) / (length * before.norm()),
                              "> 0: nodes in order, less than 90 degrees apart");
            }
            before = tangent;
        }
    }

    static std::array<Strains, points> strains(const Rest& rest, const ElementVector& u) noexcept {
        std::array<Strains, points> e{};
        std::array<std::array<double, 3>, Nodes> section{};
        if constexpr (nodal) {
            for (int I = 0; I < Nodes; ++I) {
                const Vec3 G1 = director<1>(rest.configuration, I), G2 = director<2>(rest.configuration, I);
                const Vec3 d1 = director<1>(u, I), d2 = director<2>(u, I);
                section[core::at(I)] = {detail::half_square_change(G1, d1), detail::half_square_change(G2, d2),
                                        detail::product_change(G1, d1, G2, d2)};
            }
        }
        for (std::size_t p = 0; p < e.size(); ++p) {
            Kernel::change(rest.law, rest.point[p].fields, fields(shape_at[p], rest.point[p].derivative, u), e[p]);
            if constexpr (nodal) add_interpolated(shape_at[p], section, e[p]);
        }
        return e;
    }
    static Stresses stresses_of(const Rest& rest, const std::array<Strains, points>& e) noexcept {
        Stresses s;
        for (std::size_t p = 0; p < e.size(); ++p) s.value[p] = rest.law.stress(e[p]);
        return s;
    }
    /// Section stresses gathered at the nodes: sum_p w N_I s.
    static std::array<std::array<double, 3>, Nodes> nodal_section(const Rest& rest, const Stresses& s) noexcept {
        std::array<std::array<double, 3>, Nodes> sum{};
        for (std::size_t p = 0; p < s.value.size(); ++p) {
            for (std::size_t I = 0; I < sum.size(); ++I) {
                for (std::size_t c = 0; c < 3; ++c) sum[I][c] += rest.point[p].weight * shape_at[p][I] * s.value[p][c];
            }
        }
        return sum;
    }

    static void add_force(const Rest& rest, const ElementVector& current, const Stresses& s, ElementVector& force) {
        force.setZero();
        for (std::size_t p = 0; p < s.value.size(); ++p) {
            const typename Rest::Point& point = rest.point[p];
            const DirectorFields y = fields(shape_at[p], point.derivative, current);
            const DirectorFields f = point.weight * y * Kernel::geometric(rest.law, s.value[p]);
            for (int I = 0; I < Nodes; ++I) {
                const double n = shape_at[p][core::at(I)], d = point.derivative[core::at(I)];
                force.template segment<3>(9 * I) += d * f.col(0);
                force.template segment<3>(9 * I + 3) += n * f.col(1) + d * f.col(3);
                force.template segment<3>(9 * I + 6) += n * f.col(2) + d * f.col(4);
            }
        }
        if constexpr (nodal) {
            const std::array<std::array<double, 3>, Nodes> section = nodal_section(rest, s);
            for (int I = 0; I < Nodes; ++I) {
                const Vec3 g1 = director<1>(current, I), g2 = director<2>(current, I);
                const std::array<double, 3>& t = section[core::at(I)];
                force.template segment<3>(9 * I + 3) += t[0] * g1 + t[2] * g2;
                force.template segment<3>(9 * I + 6) += t[1] * g2 + t[2] * g1;
            }
        }
    }

    static void write_tangent(const Rest& rest, const ElementVector& current, const Stresses& geometric,
                              ElementMatrix& tangent) {
        std::array<typename Kernel::FieldTangent, points> D;
        for (std::size_t p = 0; p < D.size(); ++p) {
            const DirectorFields y = fields(shape_at[p], rest.point[p].derivative, current);
            Kernel::tangent(rest.law, y, Kernel::geometric(rest.law, geometric.value[p]), rest.point[p].weight, D[p]);
        }
        expand(rest, D, tangent);
        if constexpr (nodal) add_nodal_section(rest, current, geometric, tangent);
    }

    /// From the fields of the points to the nodes: position by N', directors by N and N'.
    static void expand(const Rest& rest, const std::array<typename Kernel::FieldTangent, points>& D,
                       ElementMatrix& tangent) noexcept {
        for (std::size_t J = 0; J < Nodes; ++J) {
            for (std::size_t j = 0; j < 9; ++j) {
                std::array<double, 16 * points> column;  // derivative of the fields' forces by one unknown
                for (std::size_t p = 0; p < points; ++p) {
                    const double n = shape_at[p][J], d = rest.point[p].derivative[J];
                    const double* const first = D[p].data() + 16 * j;
                    if (j < 3) {
                        for (std::size_t r = 0; r < 16; ++r) column[16 * p + r] = d * first[r];
                    } else {
                        const double* const second = first + 16 * 6;
                        for (std::size_t r = 0; r < 16; ++r) column[16 * p + r] = n * first[r] + d * second[r];
                    }
                }
                double* out = tangent.data() + 9 * Nodes * (9 * J + j);
                for (std::size_t I = 0; I < Nodes; ++I, out += 9) {
                    double row[9] = {};
                    for (std::size_t p = 0; p < points; ++p) {
                        const double n = shape_at[p][I], d = rest.point[p].derivative[I];
                        const double* const t = column.data() + 16 * p;
                        for (std::size_t r = 0; r < 3; ++r) row[r] += d * t[r];
                        for (std::size_t r = 3; r < 9; ++r) row[r] += n * t[r] + d * t[r + 6];
                    }
                    for (std::size_t r = 0; r < 9; ++r) out[r] = row[r];
                }
            }
        }
    }

    /// The part of nodal section strains: among themselves, with E_33 (Poisson), and geometric.
    static void add_nodal_section(const Rest& rest, const ElementVector& current, const Stresses& geometric,
                                  ElementMatrix& tangent) noexcept {
        const double normal = rest.law.diagonal(strain::e11), poisson = rest.law.coupling();
        const double shear = rest.law.diagonal(strain::e12);
        const std::array<std::array<double, 3>, Nodes> section = nodal_section(rest, geometric);
        for (int J = 0; J < Nodes; ++J) {
            const Vec3 j1 = director<1>(current, J), j2 = director<2>(current, J);
            ElementVector axial = ElementVector::Zero();  // sum_p w N_J lam A dE_33/dy
            for (std::size_t p = 0; p < rest.point.size(); ++p) {
                const typename Rest::Point& point = rest.point[p];
                const double k = point.weight * shape_at[p][core::at(J)] * poisson;
                const DirectorFields y = fields(shape_at[p], point.derivative, current);
                for (int I = 0; I < Nodes; ++I) {
                    const double kd = k * point.derivative[core::at(I)];
                    axial.template segment<3>(9 * I) += kd * y.col(0);
                    if constexpr (Kernel::mean) {
                        axial.template segment<3>(9 * I + 3) += kd * rest.law.mean_1() * y.col(3);
                        axial.template segment<3>(9 * I + 6) += kd * rest.law.mean_2() * y.col(4);
                    }
                }
            }
            Eigen::Matrix<double, 6, 1> directors;
            directors << j1, j2;
            constexpr int used = Kernel::mean ? 9 : 3;
            for (int I = 0; I < Nodes; ++I) {
                const Eigen::Matrix<double, used, 1> v = axial.template segment<used>(9 * I);
                tangent.template block<used, 6>(9 * I, 9 * J + 3) += v * directors.transpose();
                tangent.template block<6, used>(9 * J + 3, 9 * I) += directors * v.transpose();
            }
            for (int I = 0; I < Nodes; ++I) {
                double mass = 0.0;
                for (std::size_t p = 0; p < rest.point.size(); ++p) {
                    mass += rest.point[p].weight * shape_at[p][core::at(I)] * shape_at[p][core::at(J)];
                }
                const Vec3 i1 = director<1>(current, I), i2 = director<2>(current, I);
                const double kn = mass * normal, kp = mass * poisson, ks = mass * shear;
                tangent.template block<3, 3>(9 * I + 3, 9 * J + 3) += kn * i1 * j1.transpose() + ks * i2 * j2.transpose();
                tangent.template block<3, 3>(9 * I + 3, 9 * J + 6) += kp * i1 * j2.transpose() + ks * i2 * j1.transpose();
                tangent.template block<3, 3>(9 * I + 6, 9 * J + 3) += kp * i2 * j1.transpose() + ks * i1 * j2.transpose();
                tangent.template block<3, 3>(9 * I + 6, 9 * J + 6) += kn * i2 * j2.transpose() + ks * i1 * j1.transpose();
            }
            const std::array<double, 3>& t = section[core::at(J)];
            for (int k = 0; k < 3; ++k) {
                tangent(9 * J + 3 + k, 9 * J + 3 + k) += t[0];
                tangent(9 * J + 6 + k, 9 * J + 6 + k) += t[1];
                tangent(9 * J + 3 + k, 9 * J + 6 + k) += t[2];
                tangent(9 * J + 6 + k, 9 * J + 3 + k) += t[2];
            }
        }
    }

    Parameters parameters_;
};

static_assert(BeamElement<DirectorBeam<2>> && BeamElement<DirectorBeam<3>>);

}  // namespace fibrant::beam

// SPDX-License-Identifier: MIT
#pragma once
/// @file The Kirchhoff cable: a smooth centreline that stretches and bends, and knows nothing of its section's rotation.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/reference_shape.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fibrant::beam {

namespace detail {
/// d/du of the Hermite polynomials of (x_1, m_1, x_2, m_2), u in [0, 1].
constexpr std::array<double, 4> hermite_slope(double u) noexcept {
    const double v = 1.0 - u;
    return {-6.0 * u * v, v * (1.0 - 3.0 * u), 6.0 * u * v, u * (1.0 - 3.0 * v)};
}
/// d^2/du^2 of the same.
constexpr std::array<double, 4> hermite_bend(double u) noexcept {
    return {12.0 * u - 6.0, 6.0 * u - 4.0, 6.0 - 12.0 * u, 6.0 * u - 2.0};
}
struct HermitePoint {
    double weight;
    std::array<double, 4> slope, bend;  // of dx/du and d^2x/du^2
};
/// Three Gauss points on [0, 1].
constexpr std::array<HermitePoint, 3> hermite_points() noexcept {
    const double offset = 0.38729833462074168852;
    return {{{5.0 / 18.0, hermite_slope(0.5 - offset), hermite_bend(0.5 - offset)},
             {4.0 / 9.0, hermite_slope(0.5), hermite_bend(0.5)},
             {5.0 / 18.0, hermite_slope(0.5 + offset), hermite_bend(0.5 + offset)}}};
}
}  // namespace detail

/// Torsion-free beam with a cubic centreline (Meier, Popp, Wall 2015): 6 unknowns a node, position x and tangent
/// m = dx/du, u counting the elements of the fibre, so that neighbours of equal length share it.
///
/// W = E A/2 int e^2 ds + E I/2 int k^2 ds with e = |x'| - 1 and the vector k = x' x x'' / |x'|^2, both a unit of rest
/// length; no shear. The axial strain is interpolated through the two ends and the middle, which is all that the centreline
/// can follow: without that, slender elements lock. For fibres that are round and straight at rest: only then does the
/// energy not depend on the twist, which the element leaves out. Contact sees the centreline and the radius, so sections
/// neither flatten nor roll, and friction has no lever. Keep an element below 90 degrees of turn.
class KirchhoffCable {
public:
    static constexpr int nodes = 2, vectors_per_node = 2, dofs_per_node = 6, reach = 1;
    static constexpr int points = 3;        ///< of Gauss, for bending
    static constexpr int axial_points = 3;  ///< the ends and the middle
    static constexpr bool centreline_particles = true;
    static constexpr std::array<scene::VectorKind, 2> kinds{scene::VectorKind::position, scene::VectorKind::direction};
    using ElementVector = Eigen::Matrix<double, 12, 1>;
    using ElementMatrix = Eigen::Matrix<double, 12, 12>;
    using ElementWeights = std::array<double, 4>;
    using Parameters = core::NoParameters;

    struct Rest {
        ElementVector configuration;
        double length;          ///< of the element [length]
        double axial, bending;  ///< E A [force], E I [force * length^2]
    };
    /// Conjugates of the axial strains at the ends and the middle [force * length] and of the curvatures at the points
    /// [force * length], a unit of rest length.
    struct Stresses {
        std::array<double, axial_points> axial{};
        std::array<Vec3, points> moment{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    };

    KirchhoffCable() = default;
    explicit KirchhoffCable(const Parameters&) {}

    /// Throws std::invalid_argument for a section that is not round and for a rest shape that is not straight.
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        section.validate();
        material.validate();
        material.require_isotropic("KirchhoffCable");
        core::require(section.semi_axis_1 == section.semi_axis_2, "KirchhoffCable.rest: semi_axis_2", section.semi_axis_2,
                      "semi_axis_1: a cable does not know how its section is turned");
        const Vec3 chord = y.segment<3>(6) - y.head<3>();
        const double length = chord.norm();
        core::require(std::isfinite(length) && length > 0.0, "KirchhoffCable.rest: length", length, "finite and > 0");
        for (const Index end : {3, 9}) {
            const double bend = (y.segment<3>(end) - chord).norm() / length;
            core::require(bend < 1e-6, "KirchhoffCable.rest: turn between chord and tangent", bend,
                          "< 1e-6: straight at rest, since a curved fibre resists torsion by bending");
        }
        return {y, length, material.young_modulus * section.area(), material.young_modulus * section.second_moment_1()};
    }

    double energy(const Rest& rest, const ElementVector& y) const {
        const ElementVector u = y - rest.configuration;
        std::array<double, axial_points> e;
        for (std::size_t a = 0; a < e.size(); ++a) e[a] = axial(rest, u, a).strain;
        double sum = 0.0;
        for (std::size_t a = 0; a < e.size(); ++a)
            for (std::size_t b = 0; b < e.size(); ++b) sum += 0.5 * rest.axial * rest.length * mass[a][b] * e[a] * e[b];
        for (std::size_t p = 0; p < gauss.size(); ++p)
            sum += 0.5 * rest.bending * rest.length * gauss[p].weight * bending(rest, u, p).curvature.squaredNorm();
        return sum;
    }

    ElementVector internal_force(const Rest& rest, const ElementVector& y) const {
        ElementVector force;
        evaluate<false>(rest, y, nullptr, force, nullptr);
        return force;
    }
    /// Derivative of the internal force.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y) const {
        return tangent_stiffness(rest, y, stresses(rest, y));
    }
    /// With the geometric part made of given stresses.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y, const Stresses& geometric) const {
        ElementVector force;
        ElementMatrix tangent;
        evaluate<true>(rest, y, &geometric, force, &tangent);
        return tangent;
    }
    /// Both at once, the geometric part made of given stresses.
    void residual_and_tangent(const Rest& rest, const ElementVector& y, const Stresses& geometric, ElementVector& force,
                              ElementMatrix& tangent) const {
        evaluate<true>(rest, y, &geometric, force, &tangent);
    }

    Stresses stresses(const Rest& rest, const ElementVector& y) const {
        const ElementVector u = y - rest.configuration;
        std::array<double, axial_points> e;
        std::array<Vec3, points> k;
        for (std::size_t a = 0; a < e.size(); ++a) e[a] = axial(rest, u, a).strain;
        for (std::size_t p = 0; p < k.size(); ++p) k[p] = bending(rest, u, p).curvature;
        return stresses_of(rest, e, k);
    }
    /// C (eps(q) + B(q) step): what the stresses will be after `step` if strains were linear.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& y, const ElementVector& step) const {
        const ElementVector u = y - rest.configuration;
        std::array<double, axial_points> e;
        std::array<Vec3, points> k;
        for (std::size_t a = 0; a < e.size(); ++a) {
            const Axial at = axial(rest, u, a);
            e[a] = at.strain + at.direction.dot(sum(axial_weights[a], step)) / rest.length;
        }
        for (std::size_t p = 0; p < k.size(); ++p) {
            const Bending at = bending(rest, u, p);
            const Vec3 da = sum(gauss[p].slope, step), db = sum(gauss[p].bend, step);
            k[p] = at.curvature + (da.cross(at.b) + at.a.cross(db)) / (rest.length * at.square) -
                   2.0 * at.a.dot(da) / at.square * at.curvature;
        }
        return stresses_of(rest, e, k);
    }
    /// Tension only: its geometric part is positive semidefinite.
    static Stresses without_compression(const Stresses& stresses) noexcept {
        Stresses tension;
        for (std::size_t a = 0; a < tension.axial.size(); ++a) tension.axial[a] = std::max(0.0, stresses.axial[a]);
        return tension;
    }

    /// Share of each node in what varies linearly along an element.
    static constexpr std::array<double, 2> shape(double xi) noexcept { return {0.5 - 0.5 * xi, 0.5 + 0.5 * xi}; }
    static constexpr std::array<double, 2> shape_derivative(double) noexcept { return {-0.5, 0.5}; }
    /// x at xi in [-1, 1].
    static constexpr ElementWeights centreline_weights(double xi) noexcept {
        const double u = 0.5 + 0.5 * xi, v = 1.0 - u;
        return {v * v * (1.0 + 2.0 * u), u * v * v, u * u * (1.0 + 2.0 * v), -u * u * v};
    }
    /// dx/dxi.
    static constexpr ElementWeights centreline_derivative_weights(double xi) noexcept {
        ElementWeights slope = detail::hermite_slope(0.5 + 0.5 * xi);
        for (double& weight : slope) weight *= 0.5;
        return slope;
    }
    /// d^2x/du^2, which varies along an element.
    static constexpr ElementWeights centreline_bend_weights(double xi) noexcept { return detail::hermite_bend(0.5 + 0.5 * xi); }
    /// A particle is on the centreline, whatever its place in the section.
    static constexpr ElementWeights particle_weights(double xi, double, double) noexcept { return centreline_weights(xi); }

    // How nodes are made and held, for beam::Mesh and the connections.
    static std::array<Vec3, 2> nodal_vectors(const scene::NodeFrame& frame, double element_length) {
        return {frame.position, element_length * frame.tangent};
    }
    /// A turn of the tangent moves the surface by the radius.
    static constexpr double vector_length(int vector, double radius, double element_length) noexcept {
        return vector == 0 ? 1.0 : radius / element_length;
    }
    /// A director that is held against leaning along the fibre holds the tangent against leaning towards it; twist is not held.
    static bool hold(scene::Hold& condition, const Mat3& basis) {
        if (condition.vector == scene::NodeVector::position) return true;
        const Vec3 tangent = condition.axes == scene::Axes::section ? Vec3(Vec3::UnitZ()) : Vec3(basis.col(2));
        if (tangent.dot(condition.directions * tangent) < 0.5) return false;
        condition.axes = scene::Axes::section;
        condition.directions = condition.vector == scene::NodeVector::director_1 ? Mat3(Vec3(1, 0, 0).asDiagonal())
                                                                                 : Mat3(Vec3(0, 1, 0).asDiagonal());
        condition.vector = static_cast<scene::NodeVector>(1);
        condition.displacement = Vec3::Zero();
        condition.path = {};
        return true;
    }
    /// A moment acts through the tangent; there is no director to pull.
    static int moment_vector(scene::NodeVector) noexcept { return 1; }

private:
    static constexpr std::array<detail::HermitePoint, points> gauss = detail::hermite_points();
    static constexpr std::array<ElementWeights, axial_points> axial_weights{
        {{0, 1, 0, 0}, {-1.5, -0.25, 1.5, -0.25}, {0, 0, 0, 1}}};
    /// Integrals of products of the parabolas through the ends and the middle, over the length.
    static constexpr std::array<std::array<double, 3>, 3> mass{
        {{4.0 / 30.0, 2.0 / 30.0, -1.0 / 30.0}, {2.0 / 30.0, 16.0 / 30.0, 2.0 / 30.0}, {-1.0 / 30.0, 2.0 / 30.0, 4.0 / 30.0}}};

    static Vec3 sum(const ElementWeights& w, const ElementVector& y) noexcept {
        return w[0] * y.segment<3>(0) + w[1] * y.segment<3>(3) + w[2] * y.segment<3>(6) + w[3] * y.segment<3>(9);
    }
    struct Axial {
        double strain, speed;  // |dx/du|
        Vec3 direction;
    };
    /// Made of the displacement, which keeps more digits than the two configurations it is the difference of.
    static Axial axial(const Rest& rest, const ElementVector& u, std::size_t a) noexcept {
        const Vec3 before = rest_chord(rest), change = sum(axial_weights[a], u), now = before + change;
        const double speed = now.norm();
        return {(before + now).dot(change) / (rest.length * (speed + rest.length)), speed, now / speed};
    }
    static Vec3 rest_chord(const Rest& rest) noexcept { return rest.configuration.segment<3>(6) - rest.configuration.head<3>(); }
    struct Bending {
        Vec3 a, b;      // dx/du, d^2x/du^2
        double square;  // |a|^2
        Vec3 curvature;
    };
    static Bending bending(const Rest& rest, const ElementVector& u, std::size_t p) noexcept {
        Bending at;
        at.a = rest_chord(rest) + sum(gauss[p].slope, u);
        at.b = sum(gauss[p].bend, u);
        at.square = at.a.squaredNorm();
        at.curvature = at.a.cross(at.b) / (rest.length * at.square);
        return at;
    }
    static Stresses stresses_of(const Rest& rest, const std::array<double, axial_points>& e,
                                const std::array<Vec3, points>& k) noexcept {
        Stresses s;
        for (std::size_t a = 0; a < e.size(); ++a)
            for (std::size_t b = 0; b < e.size(); ++b) s.axial[a] += rest.axial * mass[a][b] * e[b];
        for (std::size_t p = 0; p < k.size(); ++p) s.moment[p] = rest.bending * k[p];
        return s;
    }
    static Mat3 cross_matrix(const Vec3& v) noexcept {
        Mat3 m;
        m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
        return m;
    }
    static void add(const ElementWeights& w, const ElementWeights& z, const Mat3& block, ElementMatrix& K) noexcept {
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = 0; j < 4; ++j)
                if (w[i] != 0.0 && z[j] != 0.0)
                    K.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)) += w[i] * z[j] * block;
    }

    template <bool WithTangent>
    static void evaluate(const Rest& rest, const ElementVector& y, const Stresses* geometric, ElementVector& force,
                         ElementMatrix* tangent) {
        const ElementVector u = y - rest.configuration;
        const double h = rest.length;
        force.setZero();
        if constexpr (WithTangent) tangent->setZero();
        std::array<Axial, axial_points> e;
        for (std::size_t a = 0; a < e.size(); ++a) e[a] = axial(rest, u, a);
        for (std::size_t a = 0; a < e.size(); ++a) {
            double stress = 0.0;
            for (std::size_t b = 0; b < e.size(); ++b) stress += rest.axial * mass[a][b] * e[b].strain;
            const Vec3 pull = stress * e[a].direction;
            for (std::size_t i = 0; i < 4; ++i) force.segment<3>(3 * static_cast<Index>(i)) += axial_weights[a][i] * pull;
            if constexpr (WithTangent) {
                for (std::size_t b = 0; b < e.size(); ++b)
                    add(axial_weights[a], axial_weights[b],
                        Mat3(rest.axial / h * mass[a][b] * e[a].direction * e[b].direction.transpose()), *tangent);
                add(axial_weights[a], axial_weights[a],
                    Mat3(geometric->axial[a] / e[a].speed * (Mat3::Identity() - e[a].direction * e[a].direction.transpose())),
                    *tangent);
            }
        }
        for (std::size_t p = 0; p < gauss.size(); ++p) {
            const Bending at = bending(rest, u, p);
            const double n = at.square, w = gauss[p].weight;
            const Vec3 moment = rest.bending * at.curvature;
            const Vec3 of_a = w / n * (at.b.cross(moment) - 2.0 * h * moment.dot(at.curvature) * at.a),
                       of_b = w / n * moment.cross(at.a);
            for (std::size_t i = 0; i < 4; ++i)
                force.segment<3>(3 * static_cast<Index>(i)) += gauss[p].slope[i] * of_a + gauss[p].bend[i] * of_b;
            if constexpr (WithTangent) {
                // d k = (-[b] - 2 h k a^T) da / (h n) + [a] db / (h n), and the second derivative of M . k
                const Mat3 k_a = (-cross_matrix(at.b) - 2.0 * h * at.curvature * at.a.transpose()) / (h * n),
                           k_b = cross_matrix(at.a) / (h * n);
                const Vec3& m = geometric->moment[p];
                const Vec3 q_a = at.b.cross(m), q_b = m.cross(at.a);
                const double g = at.a.dot(q_a);
                Mat3 aa = -2.0 / (n * n) * (q_a * at.a.transpose() + at.a * q_a.transpose()) +
                          8.0 * g / (n * n * n) * at.a * at.a.transpose();
                aa.diagonal().array() -= 2.0 * g / (n * n);
                const Mat3 ab = -cross_matrix(m) / n - 2.0 / (n * n) * at.a * q_b.transpose();
                const Mat3 all_aa = w * (h * rest.bending * k_a.transpose() * k_a + aa),
                           all_ab = w * (h * rest.bending * k_a.transpose() * k_b + ab);
                const Mat3 all_bb = w * h * rest.bending * k_b.transpose() * k_b, all_ba = all_ab.transpose();
                for (std::size_t i = 0; i < 4; ++i)
                    for (std::size_t j = 0; j < 4; ++j) {
                        const double si = gauss[p].slope[i], bi = gauss[p].bend[i], sj = gauss[p].slope[j], bj = gauss[p].bend[j];
                        tangent->block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)) +=
                            si * sj * all_aa + si * bj * all_ab + bi * sj * all_ba + bi * bj * all_bb;
                    }
            }
        }
    }
};
static_assert(BeamElement<KirchhoffCable>);

}  // namespace fibrant::beam

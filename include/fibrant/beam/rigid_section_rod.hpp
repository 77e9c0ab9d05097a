// SPDX-License-Identifier: MIT
#pragma once
/// @file The geometrically exact rod: a centreline and sections that turn but keep their shape.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/quaternion.hpp>
#include <fibrant/beam/section_law.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/reference_shape.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::beam {

/// Rod of Simo and Reissner with 6 unknowns a node: position and rotation vector of the section, R(psi) = (g_1, g_2, g_3).
///
/// Two nodes, strains constant in an element: G = R_m^T (x_2 - x_1)/h and K = (rotation vector of R_1^T R_2)/h, less those
/// at rest; R_m is half-way between the two sections. They do not change with a rigid motion nor with the path, are exact for
/// a helix, and one point leaves no locking. N = E A (G_3), Q = ks G A (G_1, G_2), M = (E I_2 K_1, E I_1 K_2, G J K_3).
///
/// The bound of a total rotation vector is 2 pi, where the spin no longer depends on it in all directions. Only R matters, so
/// between increments `rewind` takes each vector to the shortest one of its rotation: an increment may turn a section by
/// pi, and a run by any number of turns. Keep the turn between neighbouring nodes below 90 degrees.
class RigidSectionRod {
public:
    static constexpr int nodes = 2, vectors_per_node = 2, dofs_per_node = 6, reach = 1;
    static constexpr std::array<scene::VectorKind, 2> kinds{scene::VectorKind::position, scene::VectorKind::rotation};
    using ElementVector = Eigen::Matrix<double, 12, 1>;
    using ElementMatrix = Eigen::Matrix<double, 12, 12>;
    using ElementWeights = std::array<double, 4>;
    using Strains = Eigen::Matrix<double, 6, 1>;

    struct Parameters {
        double shear_factor = 1.0;  ///< of the transverse shear stiffness [1], > 0
        void validate() const { core::require_positive("RigidSectionRod.shear_factor", shear_factor); }
    };
    struct Rest {
        ElementVector configuration;
        double length;               ///< of the element [length]
        Strains strains, stiffness;  ///< at rest; of the section
    };
    /// Forces and moments on the mean section, and the tension of a string that stands for them where only what is positive
    /// counts: that of a rod, whose sections turn too, is not.
    struct Stresses {
        Strains value = Strains::Zero();
        double string = 0.0;
    };

    RigidSectionRod() : RigidSectionRod(Parameters{}) {}
    explicit RigidSectionRod(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    /// Throws std::invalid_argument for a section or material that is not valid and for a degenerate rest shape.
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        return rest(section_constants(section), material, y);
    }
    /// The same for a section of any shape.
    Rest rest(const SectionConstants& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        section.validate();
        material.validate();
        material.require_isotropic("RigidSectionRod");
        Rest rest{y, (y.segment<3>(6) - y.head<3>()).norm(), Strains::Zero(), Strains::Zero()};
        core::require(std::isfinite(rest.length) && rest.length > 0.0, "RigidSectionRod.rest: length", rest.length,
                      "finite and > 0");
        const double shear = material.shear_modulus(), young = material.young_modulus;
        const double across = parameters_.shear_factor * shear * section.area;
        rest.stiffness << across, across, young * section.area, young * section.second_moment_2, young * section.second_moment_1,
            shear * section.torsion_factor * (section.second_moment_1 + section.second_moment_2);
        rest.strains = strains(Turned(rest, y));
        core::require(rest.strains[2] > 0.5, "RigidSectionRod.rest: cosine between the chord and the normal of the mean section",
                      rest.strains[2], "> 0.5: nodes in order, directors right-handed with the tangent");
        return rest;
    }

    double energy(const Rest& rest, const ElementVector& y) const {
        const Strains e = strains(Turned(rest, y)) - rest.strains;
        return 0.5 * rest.length * e.dot(rest.stiffness.cwiseProduct(e));
    }
    ElementVector internal_force(const Rest& rest, const ElementVector& y) const {
        const Turned turned(rest, y);
        return rest.length * slope(turned).transpose() * stress(rest, strains(turned));
    }
    /// Derivative of the internal force.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y) const {
        return tangent_stiffness(rest, y, stresses(rest, y));
    }
    /// With the geometric part made of given stresses.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y, const Stresses& geometric) const {
        const Turned turned(rest, y);
        return tangent(rest, turned, slope(turned), geometric);
    }
    /// Both at once, the geometric part made of given stresses.
    void residual_and_tangent(const Rest& rest, const ElementVector& y, const Stresses& geometric, ElementVector& force,
                              ElementMatrix& tangent_matrix) const {
        const Turned turned(rest, y);
        const Slope B = slope(turned);
        force = rest.length * B.transpose() * stress(rest, strains(turned));
        tangent_matrix = tangent(rest, turned, B, geometric);
    }
    Stresses stresses(const Rest& rest, const ElementVector& y) const { return {stress(rest, strains(Turned(rest, y)))}; }
    /// C (eps(q) + B(q) step): what the stresses will be after `step` if strains were linear.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& y, const ElementVector& step) const {
        const Turned turned(rest, y);
        return {stress(rest, Strains(strains(turned) + slope(turned) * step))};
    }
    /// The tension of a string: its geometric part is positive semidefinite.
    static Stresses without_compression(const Stresses& stresses) noexcept {
        return {Strains::Zero(), std::max(0.0, stresses.value[2]) + stresses.string};
    }

    static constexpr std::array<double, 2> shape(double xi) noexcept { return {0.5 - 0.5 * xi, 0.5 + 0.5 * xi}; }
    static constexpr std::array<double, 2> shape_derivative(double) noexcept { return {-0.5, 0.5}; }
    /// x at xi in [-1, 1].
    static constexpr ElementWeights centreline_weights(double xi) noexcept { return {0.5 - 0.5 * xi, 0.0, 0.5 + 0.5 * xi, 0.0}; }
    static constexpr ElementWeights centreline_derivative_weights(double) noexcept { return {-0.5, 0.0, 0.5, 0.0}; }

    /// A particle of a section: it moves with the positions, and by turning. Holds what the rotation vectors do to it in
    /// the state that it followed last.
    class Particle {
    public:
        static constexpr Index vectors = 4;  ///< of an element
        Particle() = default;
        Particle(double xi, double xi_1, double xi_2) noexcept : share_{0.5 - 0.5 * xi, 0.5 + 0.5 * xi}, arm_{xi_1, xi_2, 0.0} {}
        /// @param y  unknowns of the element
        Vec3 place(const Eigen::Ref<const ElementVector>& y) const noexcept {
            return share_[0] * (y.segment<3>(0) + core::rotation(y.segment<3>(3)) * arm_) +
                   share_[1] * (y.segment<3>(6) + core::rotation(y.segment<3>(9)) * arm_);
        }
        void follow(const Eigen::Ref<const ElementVector>& y) noexcept { follow(y, y); }
        /// @param arms  unknowns of a state between, whose arms forces have
        void follow(const Eigen::Ref<const ElementVector>& y, const Eigen::Ref<const ElementVector>& arms) noexcept {
            for (int node = 0; node < 2; ++node) {
                const Vec3 psi = y.segment<3>(6 * node + 3);
                const Vec3 arm = core::rotation(arms.segment<3>(6 * node + 3)) * arm_;
                turn_[core::at(node)] = -share_[core::at(node)] * core::cross_matrix(arm) * core::spin_matrix(psi);
            }
        }
        /// What a shift in the sections is in space.
        Mat3 turn(const Eigen::Ref<const ElementVector>& y) const noexcept {
            return share_[0] * core::rotation(y.segment<3>(3)) + share_[1] * core::rotation(y.segment<3>(9));
        }
        /// Moves by a shift in the sections [length].
        void shift(const Vec3& by) noexcept { arm_ += by; }
        /// Derivative of the place by a vector of the element.
        Mat3 slope(Index vector) const noexcept {
            return vector % 2 == 0 ? Mat3(share_[core::at(vector / 2)] * Mat3::Identity()) : turn_[core::at(vector / 2)];
        }

    private:
        std::array<double, 2> share_{};
        Vec3 arm_ = Vec3::Zero();
        std::array<Mat3, 2> turn_{Mat3::Zero(), Mat3::Zero()};
    };
    /// x + xi_1 g_1 + xi_2 g_2; @param xi1, xi2  material coordinates in the section [length].
    static Particle particle_weights(double xi, double xi1, double xi2) noexcept { return {xi, xi1, xi2}; }

    // How nodes are made and held, for beam::Mesh and the connections.
    static std::array<Vec3, 2> nodal_vectors(const scene::NodeFrame& frame) {
        return {frame.position, core::rotation_vector(frame.basis())};
    }
    /// Components of directors that are held are rotations that are held, about the axes of the section.
    static bool hold(scene::Hold& condition, const Mat3& basis) {
        if (condition.vector == scene::NodeVector::position) return true;
        const bool first = condition.vector == scene::NodeVector::director_1;
        const Mat3 held = condition.axes == scene::Axes::section ? condition.directions
                                                                 : Mat3(basis.transpose() * condition.directions * basis);
        const double about_normal = held(first ? 1 : 0, first ? 1 : 0) > 0.5 ? 1.0 : 0.0, leaning = held(2, 2) > 0.5 ? 1.0 : 0.0;
        condition.axes = scene::Axes::section;
        condition.directions = Vec3(first ? 0.0 : leaning, first ? leaning : 0.0, about_normal).asDiagonal();
        condition.vector = static_cast<scene::NodeVector>(1);
        condition.displacement = Vec3::Zero();
        condition.path = {};
        return about_normal + leaning > 0.0;
    }

protected:
    using Slope = Eigen::Matrix<double, 6, 12>;
    using Vec4 = detail::Vec4;
    using Mat4 = detail::Mat4;

    /// Quaternions of the two sections, of the one half-way (not unit), and of the turn between them.
    struct Turned {
        detail::TurnedQuaternion q_1, q_2;
        Vec4 mean;
        Vec3 chord, between;
        double square, cosine, length;
        std::array<double, 3> F;

        Turned(const Rest& rest, const ElementVector& y) noexcept
            : q_1(y.segment<3>(3)), q_2(y.segment<3>(9)), length{rest.length} {
            if (q_1.value.dot(q_2.value) < 0.0) q_2.flip();
            mean = q_1.value + q_2.value;
            square = mean.squaredNorm();
            // made of the displacement, which keeps more digits than positions far from the origin
            const Vec3 before = rest.configuration.segment<3>(6) - rest.configuration.head<3>();
            chord =
                before + ((y.segment<3>(6) - rest.configuration.segment<3>(6)) - (y.head<3>() - rest.configuration.head<3>()));
            cosine = q_1.value.dot(q_2.value);
            F = detail::logarithm(cosine);
            const Vec3 v_1 = q_1.value.tail<3>(), v_2 = q_2.value.tail<3>();
            between = q_1.value[0] * v_2 - q_2.value[0] * v_1 - v_1.cross(v_2);
        }
    };

    /// One copy for all callers: at rest the strains are the same to the last bit.
    [[gnu::noinline]] static Strains strains(const Turned& t) noexcept {
        Strains e;
        e << detail::turned_forwards(detail::conjugate(t.mean), t.chord) / (t.square * t.length), t.F[0] / t.length * t.between;
        return e;
    }
    static Strains stress(const Rest& rest, const Strains& e) noexcept { return rest.stiffness.cwiseProduct(e - rest.strains); }

    /// Derivative of the strains.
    static Slope slope(const Turned& t) noexcept {
        Slope B = Slope::Zero();
        const Vec4 &q_1 = t.q_1.value, &q_2 = t.q_2.value;
        Mat3 back;  // R_m^T / h
        for (int k = 0; k < 3; ++k)
            back.row(k) = detail::turned_forwards(t.mean, Vec3::Unit(k)).transpose() / (t.square * t.length);
        B.block<3, 3>(0, 0) = -back;
        B.block<3, 3>(0, 6) = back;
        const detail::Mat34 of_mean = detail::turned_back_slope(t.mean, t.chord) / (t.square * t.length) -
                                      2.0 / t.square * (back * t.chord) * t.mean.transpose();
        B.block<3, 3>(0, 3) = of_mean * t.q_1.slope;
        B.block<3, 3>(0, 9) = of_mean * t.q_2.slope;
        detail::Mat34 of_1 = t.F[1] * t.between * q_2.transpose(), of_2 = t.F[1] * t.between * q_1.transpose();
        const Vec3 v_1 = q_1.tail<3>(), v_2 = q_2.tail<3>();
        of_1.col(0) += t.F[0] * v_2;
        of_1.rightCols<3>() += t.F[0] * (core::cross_matrix(v_2) - q_2[0] * Mat3::Identity());
        of_2.col(0) -= t.F[0] * v_1;
        of_2.rightCols<3>() += t.F[0] * (q_1[0] * Mat3::Identity() - core::cross_matrix(v_1));
        B.block<3, 3>(3, 3) = of_1 * t.q_1.slope / t.length;
        B.block<3, 3>(3, 9) = of_2 * t.q_2.slope / t.length;
        return B;
    }

    static ElementMatrix tangent(const Rest& rest, const Turned& t, const Slope& B, const Stresses& geometric) noexcept {
        ElementMatrix K = rest.length * B.transpose() * rest.stiffness.asDiagonal() * B;
        add_geometric(t, geometric, K);
        return K;
    }
    /// The part of the tangent that is made of stresses.
    static void add_geometric(const Turned& t, const Stresses& geometric, ElementMatrix& K) noexcept {
        if (geometric.string > 0.0) {
            const double speed = t.chord.norm();
            const Vec3 along = t.chord / speed;
            const Mat3 pull = geometric.string / speed * (Mat3::Identity() - along * along.transpose());
            K.block<3, 3>(0, 0) += pull, K.block<3, 3>(6, 6) += pull, K.block<3, 3>(0, 6) -= pull, K.block<3, 3>(6, 0) -= pull;
        }
        if (geometric.value.isZero(0.0)) return;
        const Vec3 n = geometric.value.head<3>(), m = geometric.value.tail<3>();
        const Vec4 &q_1 = t.q_1.value, &q_2 = t.q_2.value;
        // n . R_m^T chord = mean^T N mean / |mean|^2
        const Mat4 N = detail::turned_form(t.chord, n);
        const double rho = t.mean.dot(N * t.mean) / t.square;
        const Vec4 of_mean = 2.0 / t.square * (N * t.mean - rho * t.mean);
        const Mat4 mean_mean =
            2.0 / t.square * (N - rho * Mat4::Identity() - of_mean * t.mean.transpose() - t.mean * of_mean.transpose());
        const detail::Mat34 chord_mean = (detail::turned_forwards_slope(t.mean, n) -
                                          2.0 / t.square * detail::turned_forwards(t.mean, n) * t.mean.transpose()) /
                                         t.square;
        // m . rotation vector = F(q_1 . q_2) q_1^T V q_2
        const Mat4 V = detail::relative_form(m);
        const Vec4 right = V * q_2, left = V.transpose() * q_1;
        const double beta = q_1.dot(right);
        const Vec4 of_1 = t.F[1] * beta * q_2 + t.F[0] * right, of_2 = t.F[1] * beta * q_1 + t.F[0] * left;
        const Mat4 both_1 = t.F[2] * beta * q_2 * q_2.transpose() + t.F[1] * (q_2 * right.transpose() + right * q_2.transpose());
        const Mat4 both_2 = t.F[2] * beta * q_1 * q_1.transpose() + t.F[1] * (q_1 * left.transpose() + left * q_1.transpose());
        Mat4 cross =
            t.F[2] * beta * q_2 * q_1.transpose() + t.F[1] * (q_2 * left.transpose() + right * q_1.transpose()) + t.F[0] * V;
        cross.diagonal().array() += t.F[1] * beta;

        const detail::Mat43 &G_1 = t.q_1.slope, &G_2 = t.q_2.slope;
        K.block<3, 3>(3, 3) += G_1.transpose() * (mean_mean + both_1) * G_1 + t.q_1.curvature(of_mean + of_1);
        K.block<3, 3>(9, 9) += G_2.transpose() * (mean_mean + both_2) * G_2 + t.q_2.curvature(of_mean + of_2);
        const Mat3 one_two = G_1.transpose() * (mean_mean + cross) * G_2, chord_1 = chord_mean * G_1, chord_2 = chord_mean * G_2;
        K.block<3, 3>(3, 9) += one_two;
        K.block<3, 3>(9, 3) += one_two.transpose();
        K.block<3, 3>(0, 3) -= chord_1, K.block<3, 3>(3, 0) -= chord_1.transpose();
        K.block<3, 3>(0, 9) -= chord_2, K.block<3, 3>(9, 0) -= chord_2.transpose();
        K.block<3, 3>(6, 3) += chord_1, K.block<3, 3>(3, 6) += chord_1.transpose();
        K.block<3, 3>(6, 9) += chord_2, K.block<3, 3>(9, 6) += chord_2.transpose();
    }

    Parameters parameters_;
};
static_assert(BeamElement<RigidSectionRod>);

}  // namespace fibrant::beam

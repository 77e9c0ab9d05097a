// SPDX-License-Identifier: MIT
#pragma once
/// @file The director beam: a centreline and two free directors, full Green-Lagrange strain, no rotations.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/beam/director_points.hpp>
#include <fibrant/beam/lagrange.hpp>
#include <fibrant/beam/section_law.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace fibrant::beam {

/// Variant of the director beam; all combinations are elements, the default is the one to use.
struct DirectorBeamOptions {
    ElasticLaw law = ElasticLaw::split;
    SectionSampling sampling = SectionSampling::nodal;
    QuadraticStrain quadratic = QuadraticStrain::none;
    TwistStrain twist = TwistStrain::metric;
    bool round_at_rest = false;  ///< all sections are circles at rest, else a mesh refuses them: a program compiles in less time
};

/// Beam x = x_0 + xi_1 g_1 + xi_2 g_2 with 9 unknowns a node (Durville, eq. 1 and 2), Nodes - 1 Gauss points.
///
/// All strains are quadratic in the unknowns, eps_c = y.H_c y/2 - rest; the force is sum w S_c H_c y and the tangent
/// sum w (B^T C B + S_c H_c (x) I_3), exact and symmetric; but for TwistStrain::turn, a quotient of two such. Two Gauss points on
/// three nodes and section strains sampled at the nodes leave no locking; exactly the six rigid motions have no energy. Keep an
/// element below 90 degrees of turn.
template <int Nodes = 3, DirectorBeamOptions Options = DirectorBeamOptions{}>
class DirectorBeam {
protected:
    using Interpolation = detail::DirectorPoints<Nodes>;
    using Section = detail::NodalSection<Nodes>;

public:
    static constexpr int nodes = Nodes, vectors_per_node = 3, dofs_per_node = 9, reach = Nodes - 1;
    static constexpr int points = Nodes - 1;  ///< of Gauss
    static constexpr std::array<scene::VectorKind, 3> kinds{scene::VectorKind::position, scene::VectorKind::direction,
                                                            scene::VectorKind::direction};
    static constexpr DirectorBeamOptions options = Options;
    static constexpr bool round_at_rest = Options.round_at_rest;
    using ElementVector = typename Interpolation::ElementVector;
    using ElementMatrix = typename Interpolation::ElementMatrix;
    using ElementWeights = std::array<double, static_cast<std::size_t>(3 * Nodes)>;
    using Law = SectionLaw<Options.law, Options.quadratic>;
    using Strains = typename Law::Strains;

    struct Parameters {
        double shear_factor = 1.0;  ///< of the transverse shear stiffness [1], > 0
        void validate() const { core::require_positive("DirectorBeam.shear_factor", shear_factor); }
    };

    /// What an element keeps of its rest shape.
    struct Rest {
        ElementVector configuration;
        typename Interpolation::Points point;
        Law law;

        /// Rest arc length as integrated by the element [length].
        double length() const noexcept {
            double sum = 0.0;
            for (const auto& p : point) sum += p.weight;
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
        for (std::size_t p = 0; p < rest.point.size(); ++p) {
            typename Interpolation::Point& point = rest.point[p];
            const Values slope = shape_derivative(Interpolation::gauss[p].xi);
            const double jacobian = tangent(slope, rest_configuration).norm();
            point.weight = Interpolation::gauss[p].weight * jacobian;
            for (std::size_t I = 0; I < Nodes; ++I) point.derivative[I] = slope[I] / jacobian;
            point.fields = Interpolation::fields(Interpolation::shape_at[p], point.derivative, rest_configuration);
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
        write_force(rest, current, Interpolation::all_fields(rest.point, current), stresses(rest, current), force);
        return force;
    }

    /// Derivative of the internal force.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& current) const {
        return tangent_stiffness(rest, current, stresses(rest, current));
    }
    /// With the geometric part made of given stresses.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& current, const Stresses& geometric) const {
        ElementMatrix tangent;
        write_tangent(rest, current, Interpolation::all_fields(rest.point, current), geometric, tangent);
        return tangent;
    }
    /// Both at once, the geometric part made of given stresses.
    void residual_and_tangent(const Rest& rest, const ElementVector& current, const Stresses& geometric, ElementVector& force,
                              ElementMatrix& tangent) const {
        const typename Interpolation::Fields fields = Interpolation::all_fields(rest.point, current);
        write_force(rest, current, fields, stresses(rest, current), force);
        write_tangent(rest, current, fields, geometric, tangent);
    }

    Stresses stresses(const Rest& rest, const ElementVector& current) const {
        return stresses_of(rest, strains(rest, change(rest, current)));
    }
    /// C (eps(q) + B(q) step): what the stresses will be after `step` if strains were linear.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& current, const ElementVector& step) const {
        std::array<Strains, points> e = strains(rest, change(rest, current));
        const typename Interpolation::Fields y = Interpolation::all_fields(rest.point, current);
        const typename Interpolation::Fields dy = Interpolation::all_fields(rest.point, step);
        for (std::size_t p = 0; p < e.size(); ++p) Kernel::add_rate(rest.law, y[p], dy[p], e[p]);
        if constexpr (nodal) {
            const typename Section::Three section = Section::rate(current, step);
            for (std::size_t p = 0; p < e.size(); ++p) Section::interpolate(p, section, e[p]);
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
        const typename Interpolation::Fields y = Interpolation::all_fields(rest.point, current);
        for (std::size_t p = 0; p < y.size(); ++p) {
            least = std::min(least, volume_of(y[p]) / volume_of(rest.point[p].fields));
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

protected:
    static constexpr bool nodal = Options.sampling == SectionSampling::nodal;
    using Kernel = DirectorStrains<Options.law, Options.quadratic, !nodal, Options.twist>;
    using Values = typename Interpolation::Values;

    static constexpr ElementWeights node_weights(const Values& N, double xi1, double xi2) noexcept {
        ElementWeights w{};
        for (std::size_t I = 0; I < N.size(); ++I) {
            w[3 * I] = N[I];
            w[3 * I + 1] = xi1 * N[I];
            w[3 * I + 2] = xi2 * N[I];
        }
        return w;
    }
    static Vec3 tangent(const Values& slope, const ElementVector& y) noexcept {
        Vec3 t = Vec3::Zero();
        for (int I = 0; I < Nodes; ++I) t += slope[core::at(I)] * y.template segment<3>(9 * I);
        return t;
    }
    static double volume_of(const DirectorFields& y) noexcept {
        const Vec3 normal = y.col(1).cross(y.col(2));
        return normal.dot(y.col(0));
    }
    /// The tangent never turns back between the ends and the points, so the arc length grows.
    static void check_tangents(const ElementVector& y) {
        Vec3 before = Vec3::Zero();
        for (int k = 0; k < points + 2; ++k) {
            const double xi = k == 0 ? -1.0 : k <= points ? Interpolation::gauss[core::at(k - 1)].xi : 1.0;
            const Vec3 here = tangent(shape_derivative(xi), y);
            const double length = here.norm();
            core::require(std::isfinite(length) && length > 0.0, "DirectorBeam.rest: |dx_0/dxi|", length, "finite and > 0");
            if (k > 0) {
                core::require(here.dot(before) > 0.0, "DirectorBeam.rest: turn of the tangent, cosine",
                              here.dot(before) / (length * before.norm()), "> 0: nodes in order, less than 90 degrees apart");
            }
            before = here;
        }
    }

    /// A displacement keeps more digits than the two configurations it is the difference of.
    static ElementVector change(const Rest& rest, const ElementVector& current) noexcept { return current - rest.configuration; }
    static std::array<Strains, points> strains(const Rest& rest, const ElementVector& u) noexcept {
        std::array<Strains, points> e{};
        const typename Interpolation::Fields du = Interpolation::all_fields(rest.point, u);
        for (std::size_t p = 0; p < e.size(); ++p) Kernel::change(rest.law, rest.point[p].fields, du[p], e[p]);
        if constexpr (nodal) {
            const typename Section::Three section = Section::change(rest.configuration, u);
            for (std::size_t p = 0; p < e.size(); ++p) Section::interpolate(p, section, e[p]);
        }
        return e;
    }
    static Stresses stresses_of(const Rest& rest, const std::array<Strains, points>& e) noexcept {
        Stresses s;
        for (std::size_t p = 0; p < e.size(); ++p) s.value[p] = rest.law.stress(e[p]);
        return s;
    }
    static void write_force(const Rest& rest, const ElementVector& current, const typename Interpolation::Fields& y,
                            const Stresses& s, ElementVector& force) noexcept {
        force.setZero();
        for (std::size_t p = 0; p < y.size(); ++p) {
            const DirectorFields f = rest.point[p].weight * y[p] * Kernel::geometric(rest.law, y[p], s.value[p]);
            Interpolation::add_force(rest.point[p], p, f, force);
        }
        if constexpr (nodal) Section::add_force(current, Section::gather(rest.point, s.value), force);
    }
    static void write_tangent(const Rest& rest, const ElementVector& current, const typename Interpolation::Fields& y,
                              const Stresses& geometric, ElementMatrix& tangent) noexcept {
        std::array<typename Kernel::FieldTangent, points> D;
        for (std::size_t p = 0; p < D.size(); ++p) {
            Kernel::tangent(rest.law, y[p], Kernel::geometric(rest.law, y[p], geometric.value[p]), geometric.value[p],
                            rest.point[p].weight, D[p]);
        }
        double* out = tangent.data();
        const auto write = [&](const auto& add_to) {
            for (std::size_t J = 0; J < Nodes; ++J) {
                for (std::size_t j = 0; j < 9; ++j, out += 9 * Nodes) {
                    double column[9 * Nodes];  // where nothing else points to, so that loops become vectors
                    Interpolation::column(rest.point, D, J, j, column);
                    add_to(J, j, column);
                    for (std::size_t r = 0; r < 9 * Nodes; ++r) out[r] = column[r];
                }
            }
        };
        if constexpr (nodal) {
            const typename Section::Three stress = Section::gather(rest.point, geometric.value);
            const typename Section::template Tangent<Kernel::mean> section(rest.law, rest.point, y, current, stress);
            write([&](std::size_t J, std::size_t j, double* column) { section.add(J, j, column); });
        } else {
            write([](std::size_t, std::size_t, double*) {});
        }
    }

    Parameters parameters_;
};

static_assert(BeamElement<DirectorBeam<2>> && BeamElement<DirectorBeam<3>>);

/// The same of sections that are circles at rest; a mesh refuses others.
template <int Nodes = 3>
using RoundDirectorBeam = DirectorBeam<Nodes, DirectorBeamOptions{.round_at_rest = true}>;

}  // namespace fibrant::beam

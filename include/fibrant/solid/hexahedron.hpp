// SPDX-License-Identifier: MIT
#pragma once
/// @file The 8-node hexahedron: energy, forces, tangent, with or without enhanced strains.

#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/solid/hexahedron_map.hpp>
#include <fibrant/solid/solid_law.hpp>

#include <Eigen/Cholesky>

#include <array>
#include <cmath>
#include <limits>

namespace fibrant::solid {

/// Forces on the nodes, node by node, and their derivative by the nodes' places.
using CellVector = Eigen::Matrix<double, 24, 1>;
using CellMatrix = Eigen::Matrix<double, 24, 24>;

/// Strains of the displacements alone: locks in bending, by (length / thickness)^2 with one element through the thickness.
struct PlainStrains {
    static constexpr int modes = 0;
};

/// Green-Lagrange strains enhanced by nine modes of the element, which the element itself eliminates (Simo and Rifai 1990,
/// the modes of Wilson's incompatible displacements): E = E(u) + j_0/j T_0 M(xi) alpha, the mean of the modes zero, so that a
/// uniform strain is met exactly whatever the shape. Bends as plates do with one element through the thickness. Under
/// compression to some 60 % of its length an element may become unstable in a mode of its own.
struct EnhancedStrains {
    static constexpr int modes = 9;
};

/// Hexahedron with 2 x 2 x 2 points, in the strains of its rest shape: a rigid motion changes nothing.
///
/// @tparam Strains  PlainStrains or EnhancedStrains
/// @tparam Law      of the material
template <class Strains, SolidLaw Law>
class Hexahedron {
public:
    using Parameters = typename Law::Parameters;
    static constexpr int modes = Strains::modes;
    static constexpr int points = 8;
    using ModeVector = Eigen::Matrix<double, modes, 1>;
    using ModeMatrix = Eigen::Matrix<double, modes, modes>;

    /// What a cell keeps of its rest shape.
    struct Rest {
        std::array<ShapeGradient, 8> gradient;  ///< of the shape functions at each point [1 / length]
        std::array<double, 8> volume;           ///< of each point [length^3], > 0
        VoigtMatrix turn;                       ///< strains along the edges at the middle to strains in space
        double middle_volume = 0.0;             ///< Jacobian there
        double size() const noexcept {
            double sum = 0.0;
            for (const double v : volume) sum += v;
            return sum;
        }
    };

    Hexahedron() = default;
    explicit Hexahedron(const Parameters& parameters) : law_{parameters} {}

    static Rest rest(const CellNodes& nodes) {
        Rest rest;
        const Mat3 middle = jacobian(nodes, Vec3::Zero());
        rest.middle_volume = middle.determinant();
        const Mat3 inverse = middle.inverse();
        for (int k = 0; k < 6; ++k) {
            Voigt unit = Voigt::Zero();
            unit[k] = 1.0;
            rest.turn.col(k) = strain_of(inverse.transpose() * strain_tensor(unit) * inverse);
        }
        for (int p = 0; p < points; ++p) {
            const Mat3 j = jacobian(nodes, point(p));
            rest.gradient[core::at(p)] = shape_derivatives(point(p)) * j.inverse();
            rest.volume[core::at(p)] = j.determinant();
        }
        return rest;
    }

    double energy(const Rest& rest, const scene::ElasticMaterial& material, const CellNodes& now) const {
        Work work;
        relax(rest, material, now, work);
        double sum = 0.0;
        for (int p = 0; p < points; ++p) sum += rest.volume[core::at(p)] * work.response[core::at(p)].energy;
        return sum;
    }
    CellVector force(const Rest& rest, const scene::ElasticMaterial& material, const CellNodes& now) const {
        Work work;
        relax(rest, material, now, work);
        CellVector f;
        add_up(rest, now, work, f, nullptr, false);
        return f;
    }
    /// @param tension_only  leave compression out of the geometric stiffness
    void force_and_tangent(const Rest& rest, const scene::ElasticMaterial& material, const CellNodes& now, CellVector& force,
                           CellMatrix& tangent, bool tension_only = false) const {
        Work work;
        relax(rest, material, now, work);
        add_up(rest, now, work, force, &tangent, tension_only);
    }
    /// Green-Lagrange strain (what the element adds included), and Cauchy stress, at a point.
    struct State {
        Mat3 strain, stress;
    };
    std::array<State, 8> states(const Rest& rest, const scene::ElasticMaterial& material, const CellNodes& now) const {
        Work work;
        relax(rest, material, now, work);
        std::array<State, 8> states;
        for (int p = 0; p < points; ++p) {
            const Mat3 f = now.transpose() * rest.gradient[core::at(p)];
            states[core::at(p)].strain = strain_tensor(work.strain[core::at(p)]);
            states[core::at(p)].stress = f * stress_tensor(work.response[core::at(p)].stress) * f.transpose() / f.determinant();
        }
        return states;
    }
    /// Natural coordinates of a point.
    static Vec3 point(int p) noexcept {
        const double a = 1.0 / std::sqrt(3.0);
        return a * Vec3((p & 1) != 0 ? 1.0 : -1.0, (p & 2) != 0 ? 1.0 : -1.0, (p & 4) != 0 ? 1.0 : -1.0);
    }

private:
    struct Work {
        std::array<Voigt, 8> strain;
        std::array<SolidResponse, 8> response;
        std::array<Eigen::Matrix<double, 6, modes>, 8> mode;
        Eigen::LDLT<ModeMatrix> stiffness;
    };

    /// Shapes of the nine modes: which strain, and which natural coordinate it grows with.
    static constexpr std::array<std::array<int, 2>, 9> mode_shapes{
        {{0, 0}, {1, 1}, {2, 2}, {3, 0}, {3, 1}, {4, 1}, {4, 2}, {5, 0}, {5, 2}}};

    /// Strains of the displacements, and the modes that make the energy least.
    void relax(const Rest& rest, const scene::ElasticMaterial& material, const CellNodes& now, Work& work) const {
        std::array<Voigt, 8> plain;
        for (int p = 0; p < points; ++p) {
            const Mat3 f = now.transpose() * rest.gradient[core::at(p)];
            const Mat3 h = f - Mat3::Identity();  // keeps the digits of small strains
            plain[core::at(p)] = strain_of(0.5 * (h + h.transpose() + h.transpose() * h));
            work.strain[core::at(p)] = plain[core::at(p)];
            work.response[core::at(p)] = law_.response(material, plain[core::at(p)]);
        }
        if constexpr (modes > 0) {
            for (int p = 0; p < points; ++p) {
                const double scale = rest.middle_volume / rest.volume[core::at(p)];
                const Vec3 xi = point(p);
                for (int m = 0; m < modes; ++m) {
                    const auto [strain, grows] = mode_shapes[core::at(m)];
                    work.mode[core::at(p)].col(m) = scale * xi[grows] * rest.turn.col(strain);
                }
            }
            ModeVector alpha = ModeVector::Zero();
            double last = std::numeric_limits<double>::infinity();
            // A law that is linear in the strain is met by the first step.
            for (int iteration = 0; iteration < 20; ++iteration) {
                ModeVector force = ModeVector::Zero();
                ModeMatrix stiffness = ModeMatrix::Zero();
                for (int p = 0; p < points; ++p) {
                    const auto& m = work.mode[core::at(p)];
                    force.noalias() += rest.volume[core::at(p)] * (m.transpose() * work.response[core::at(p)].stress);
                    stiffness.noalias() += rest.volume[core::at(p)] * (m.transpose() * (work.response[core::at(p)].tangent * m));
                }
                work.stiffness.compute(stiffness);
                if (iteration > 0 && (force.isZero(0.0) || !(last > 1e-14 * (1.0 + alpha.norm())))) break;
                const ModeVector step = -work.stiffness.solve(force);
                const double length = step.norm();
                if (!std::isfinite(length) || (iteration > 3 && length >= last)) break;  // not finite, or nothing but rounding
                alpha += step;
                last = length;
                for (int p = 0; p < points; ++p) {
                    work.strain[core::at(p)] = plain[core::at(p)] + work.mode[core::at(p)] * alpha;
                    work.response[core::at(p)] = law_.response(material, work.strain[core::at(p)]);
                }
            }
        }
    }

    static void add_up(const Rest& rest, const CellNodes& now, const Work& work, CellVector& force, CellMatrix* tangent,
                       bool tension_only) {
        force.setZero();
        if (tangent != nullptr) tangent->setZero();
        Eigen::Matrix<double, modes, 24> coupling = Eigen::Matrix<double, modes, 24>::Zero();
        for (int p = 0; p < points; ++p) {
            const ShapeGradient& g = rest.gradient[core::at(p)];
            const double volume = rest.volume[core::at(p)];
            const Mat3 f = now.transpose() * g;
            const Mat3 s = stress_tensor(work.response[core::at(p)].stress);
            const Eigen::Matrix<double, 8, 3> first = volume * g * s * f.transpose();  // forces F S grad N
            for (int a = 0; a < 8; ++a) force.segment<3>(3 * a) += first.row(a).transpose();
            if (tangent == nullptr) continue;
            Eigen::Matrix<double, 6, 24> b;
            for (int a = 0; a < 8; ++a)
                for (int k = 0; k < 6; ++k) {
                    const auto [i, j] = voigt_pairs[core::at(k)];
                    if (i == j)
                        b.block<1, 3>(k, 3 * a) = g(a, i) * f.col(i).transpose();
                    else
                        b.block<1, 3>(k, 3 * a) = g(a, i) * f.col(j).transpose() + g(a, j) * f.col(i).transpose();
                }
            const Eigen::Matrix<double, 6, 24> cb = volume * work.response[core::at(p)].tangent * b;
            tangent->noalias() += b.transpose() * cb;
            if constexpr (modes > 0) coupling.noalias() += work.mode[core::at(p)].transpose() * cb;
            Mat3 geometric = s;
            if (tension_only) {
                const core::SymmetricEigen<3> principal(s);
                geometric = principal.vectors() * principal.values().cwiseMax(0.0).asDiagonal() * principal.vectors().transpose();
            }
            const Eigen::Matrix<double, 8, 8> scalar = volume * g * geometric * g.transpose();
            for (int a = 0; a < 8; ++a)
                for (int c = 0; c < 8; ++c) tangent->block<3, 3>(3 * a, 3 * c).diagonal().array() += scalar(a, c);
        }
        if constexpr (modes > 0) {
            if (tangent != nullptr) {
                tangent->noalias() -= coupling.transpose() * work.stiffness.solve(coupling);
                *tangent = (0.5 * (*tangent + tangent->transpose())).eval();
            }
        }
    }

    [[no_unique_address]] Law law_;
};

}  // namespace fibrant::solid

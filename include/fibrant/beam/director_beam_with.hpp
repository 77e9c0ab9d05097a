// SPDX-License-Identifier: MIT
#pragma once
/// @file The director beam with a law of its own.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/element_memory.hpp>

namespace fibrant::beam {

namespace detail {

/// Material tangent of a law at a point of a director beam, of any pattern.
template <SectionMaterial M, class Kernel>
struct LawTangent {
    using Row = DirectorFields;  ///< derivative of a strain by the fields
    /// Fields that a strain is made of, as bits.
    static constexpr unsigned mask(int c) {
        if (Kernel::turn && (c == strain::c12 || c == strain::c21)) return 0b11110u;
        const FieldPair f = strain_fields[static_cast<std::size_t>(c)];
        return 1u << f.first | 1u << f.second;
    }
    static void rows(const DirectorFields& y, std::array<Row, 12>& B) noexcept {
        unrolled<3, 12>([&](auto c) {
            constexpr FieldPair f = strain_fields[c()];
            Row& row = B[c()];
            row.col(f.first) = y.col(f.second);
            if constexpr (f.first != f.second) row.col(f.second) = y.col(f.first);
        });
        if constexpr (Kernel::turn) {
            const Eigen::Matrix<double, 3, 4> by_t = TurnStrain(y).slope(y);
            Eigen::Matrix<double, 3, 4> by_s;
            by_s << 0.5 * y.col(4), 0.5 * y.col(3), 0.5 * y.col(2), 0.5 * y.col(1);
            B[strain::c12].template rightCols<4>() = by_s - by_t, B[strain::c21].template rightCols<4>() = by_s + by_t;
        }
    }
    /// weight (B^T C B + G (x) I_3) of the strains from E_33 on.
    /// @param C    by M::entries; @param C33  of E_33 alone, with what the contraction of the section adds
    /// @param s    that G is made of
    static void fields(const DirectorFields& y, const std::array<double, M::entries.size()>& C, double C33,
                       const typename Kernel::FieldMatrix& G, [[maybe_unused]] const typename Kernel::Strains& s, double weight,
                       typename Kernel::FieldTangent& D) noexcept {
        D.setZero();
        const auto add = [&](auto row, auto column, double factor, const auto& u, const auto& v) {
            for (int j = 0; j < 3; ++j)
                for (int i = 0; i < 3; ++i) D(3 * row() + i, 3 * column() + j) += factor * u[i] * v[j];
        };
        std::array<Row, 12> B;
        rows(y, B);
        unrolled<0, static_cast<int>(M::entries.size())>([&](auto k) {
            constexpr Entry entry = M::entries[k()];
            constexpr int a = entry.row, b = entry.column;
            if constexpr (a >= 3) {
                const double factor = weight * (k() == strain::e33 ? C33 : C[k()]);
                unrolled<0, 5>([&](auto q) {
                    unrolled<0, q() + 1>([&](auto p) {
                        if constexpr ((mask(a) >> p() & 1u) != 0 && (mask(b) >> q() & 1u) != 0)
                            add(p, q, factor, B[a].col(p()), B[b].col(q()));
                        if constexpr (a != b && (mask(b) >> p() & 1u) != 0 && (mask(a) >> q() & 1u) != 0)
                            add(p, q, factor, B[b].col(p()), B[a].col(q()));
                    });
                });
            }
        });
        if constexpr (Kernel::turn) {  // second derivative of t but for what G has
            const TurnStrain twist(y);
            const Eigen::Matrix<double, 3, 4> by_t = twist.slope(y);
            Eigen::Matrix<double, 3, 4> by_m = Eigen::Matrix<double, 3, 4>::Zero();
            by_m.col(0) = 2.0 * y.col(1), by_m.col(1) = 2.0 * y.col(2);
            const double factor = -weight * (s[strain::c21] - s[strain::c12]) / twist.m;
            unrolled<1, 5>([&](auto q) {
                unrolled<1, q() + 1>([&](auto p) {
                    add(p, q, factor, by_t.col(p() - 1), by_m.col(q() - 1));
                    add(p, q, factor, by_m.col(p() - 1), by_t.col(q() - 1));
                });
            });
        }
        for (int q = 0; q < 5; ++q)
            for (int p = 0; p <= q; ++p)
                for (int i = 0; i < 3; ++i) D(3 * p + i, 3 * q + i) += weight * G(p, q);
        for (int q = 0; q < 5; ++q)
            for (int p = 0; p < q; ++p)
                for (int j = 0; j < 3; ++j)
                    for (int i = 0; i < 3; ++i) D(3 * q + j, 3 * p + i) = D(3 * p + i, 3 * q + j);
    }
};

}  // namespace detail

/// DirectorBeam whose section obeys a law: sections flatten, contract and turn as ever. E_11, E_22, 2 E_12 are sampled at the
/// nodes and interpolated to the points before the law sees them, so that a law never knows the sampling.
template <SectionMaterial M, int Nodes = 3, DirectorBeamOptions Options = DirectorBeamOptions{}>
class DirectorBeamWith : public DirectorBeam<Nodes, Options>, public Lawful<DirectorBeamWith<M, Nodes, Options>, M> {
    using Base = DirectorBeam<Nodes, Options>;
    using Laws = Lawful<DirectorBeamWith<M, Nodes, Options>, M>;
    friend Laws;
    static_assert(
        Options.law == ElasticLaw::split && Options.quadratic == QuadraticStrain::none &&
            Options.sampling == SectionSampling::nodal,
        "a law replaces the split law of the director beam, with section strains at the nodes and none that are quadratic");

public:
    using Parameters = LawParameters<Base, M>;
    using ElementVector = typename Base::ElementVector;
    using ElementMatrix = typename Base::ElementMatrix;
    using Strains = typename Base::Strains;
    using Answer = SectionAnswer<typename M::History, M::entries.size()>;
    using Answers = std::array<Answer, Base::points>;
    /// Of an iteration: at strains of its own, with the tangent there.
    struct Stresses : Base::Stresses {
        std::array<SectionStrains, Base::points> strain{}, law{};
        std::array<std::array<double, M::entries.size()>, Base::points> tangent{};
    };
    struct Rest : Base::Rest {
        ElementMemory<M, Base::points> memory{};
    };
    /// Of its points, in [-1, 1].
    static constexpr std::array<double, Base::points> point_places = [] {
        std::array<double, Base::points> xi{};
        for (std::size_t p = 0; p < xi.size(); ++p) xi[p] = gauss_points<Base::points>()[p].xi;
        return xi;
    }();

    DirectorBeamWith() : DirectorBeamWith(Parameters{}) {}
    explicit DirectorBeamWith(const Parameters& parameters) : Base(core::validated(parameters)), Laws(parameters.laws) {}

    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        return rest(section_constants(section), material, y);
    }
    Rest rest(const SectionConstants& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        Rest rest{Base::rest(section, scene::ElasticMaterial{material.young_modulus, 0.0}, y), {}};
        Laws::begin(rest, section, material, this->parameters_.shear_factor);
        return rest;
    }
    double energy(const Rest& rest, const ElementVector& y) const { return Laws::figures(rest, y).stored; }
    ElementVector internal_force(const Rest& rest, const ElementVector& y) const {
        return internal_force(rest, y, stresses(rest, y));
    }
    /// S(e*) + C(e*) (e - e*) for the strains e* of the iteration.
    ElementVector internal_force(const Rest& rest, const ElementVector& y, const Stresses& iterated) const {
        std::array<SectionStrains, Base::points> e = law_strains(rest, y), s = iterated.law;
        for (std::size_t p = 0; p < e.size(); ++p) {
            for (std::size_t c = 0; c < 12; ++c) e[p][c] -= iterated.strain[p][c];
            for (std::size_t k = 0; k < M::entries.size(); ++k) {
                const auto a = static_cast<std::size_t>(M::entries[k].row), b = static_cast<std::size_t>(M::entries[k].column);
                s[p][a] += iterated.tangent[p][k] * e[p][b];
                if (a != b) s[p][b] += iterated.tangent[p][k] * e[p][a];
            }
        }
        ElementVector force;
        Base::write_force(rest, y, Interpolation::all_fields(rest.point, y), of_law(rest, s), force);
        return force;
    }
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y) const {
        return tangent_stiffness(rest, y, stresses(rest, y));
    }
    /// With the stresses and the tangents of an iteration.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y, const Stresses& iterated) const {
        ElementMatrix tangent;
        write_tangent(rest, y, iterated, tangent);
        return tangent;
    }
    void residual_and_tangent(const Rest& rest, const ElementVector& y, const Stresses& iterated, ElementVector& force,
                              ElementMatrix& tangent) const {
        force = internal_force(rest, y);
        write_tangent(rest, y, iterated, tangent);
    }
    Stresses stresses(const Rest& rest, const ElementVector& y) const { return stresses_at(rest, law_strains(rest, y)); }
    /// At the strains e(q) + B(q) step.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& y, const ElementVector& step) const {
        const typename Interpolation::Fields f = Interpolation::all_fields(rest.point, y),
                                             df = Interpolation::all_fields(rest.point, step);
        std::array<SectionStrains, Base::points> e = Base::strains(rest, Base::change(rest, y));
        for (std::size_t p = 0; p < e.size(); ++p) Kernel::add_rate(rest.law, f[p], df[p], e[p]);
        const typename Base::Section::Three section = Base::Section::rate(y, step);
        for (std::size_t p = 0; p < e.size(); ++p) Base::Section::interpolate(p, section, e[p]), e[p] = to_law(rest, e[p]);
        return stresses_at(rest, e);
    }
    static Stresses without_compression(const Stresses& stresses) noexcept {
        Stresses tension = stresses;
        static_cast<typename Base::Stresses&>(tension) = Base::without_compression(stresses);
        return tension;
    }
    static double weight(const Rest& rest, std::size_t p) noexcept { return rest.point[p].weight; }
    Answers answers(const Rest& rest, const ElementVector& y) const {
        const auto e = law_strains(rest, y);
        Answers now;
        for (std::size_t p = 0; p < now.size(); ++p) now[p] = Laws::answer(rest, p, e[p]);
        return now;
    }
    std::array<SectionStrains, Base::points> law_strains(const Rest& rest, const ElementVector& y) const {
        std::array<SectionStrains, Base::points> e = Base::strains(rest, Base::change(rest, y));
        for (SectionStrains& at : e) at = to_law(rest, at);
        return e;
    }

private:
    using Interpolation = detail::DirectorPoints<Nodes>;
    using Kernel = typename Base::Kernel;
    static constexpr int e33_11 = detail::entry_of(M::entries, strain::e11, strain::e33),
                         e33_22 = detail::entry_of(M::entries, strain::e22, strain::e33);
    static constexpr int e11_22 = detail::entry_of(M::entries, strain::e11, strain::e22);

    static SectionStrains to_law(const Rest& rest, SectionStrains e) noexcept {
        const double contracted = rest.memory.section.contraction * e[strain::e33];
        e[strain::e11] += contracted, e[strain::e22] += contracted;
        return e;
    }
    static typename Base::Stresses of_law(const Rest& rest, const std::array<SectionStrains, Base::points>& s) noexcept {
        typename Base::Stresses all{s};
        for (SectionStrains& at : all.value)
            at[strain::e33] += rest.memory.section.contraction * (at[strain::e11] + at[strain::e22]);
        return all;
    }
    Stresses stresses_at(const Rest& rest, const std::array<SectionStrains, Base::points>& e) const {
        Stresses s;
        s.strain = e;
        for (std::size_t p = 0; p < e.size(); ++p) {
            const Answer at = Laws::answer(rest, p, e[p]);
            s.law[p] = at.stress, s.tangent[p] = at.tangent;
        }
        static_cast<typename Base::Stresses&>(s) = of_law(rest, s.law);
        return s;
    }
    static void write_tangent(const Rest& rest, const ElementVector& y, const Stresses& iterated,
                              ElementMatrix& tangent) noexcept {
        const typename Interpolation::Fields f = Interpolation::all_fields(rest.point, y);
        std::array<typename Kernel::FieldTangent, Base::points> D;
        std::array<Eigen::Matrix4d, Base::points> C;  // of E_11, E_22, 2 E_12, and between them and E_33
        const double nu = rest.memory.section.contraction;
        for (std::size_t p = 0; p < D.size(); ++p) {
            const auto& t = iterated.tangent[p];
            const auto number = [&](int entry) { return entry < 0 ? 0.0 : t[core::at(entry)]; };
            const double c01 = number(e11_22), l0 = number(e33_11), l1 = number(e33_22);
            const double c03 = l0 + nu * (t[0] + c01), c13 = l1 + nu * (t[1] + c01);
            C[p] << t[0], c01, 0, c03, c01, t[1], 0, c13, 0, 0, t[2], 0, c03, c13, 0, 0;
            detail::LawTangent<M, Kernel>::fields(f[p], t, t[strain::e33] + nu * (c03 + c13 + l0 + l1),
                                                  Kernel::geometric(rest.law, f[p], iterated.value[p]), iterated.value[p],
                                                  rest.point[p].weight, D[p]);
        }
        double* out = tangent.data();
        for (std::size_t J = 0; J < Nodes; ++J)
            for (std::size_t j = 0; j < 9; ++j, out += 9 * Nodes) Interpolation::column(rest.point, D, J, j, out);
        const typename Base::Section::Three stress = Base::Section::gather(rest.point, iterated.value);
        for (std::size_t p = 0; p < D.size(); ++p) {
            Eigen::Matrix<double, 9 * Nodes, 4> B = Eigen::Matrix<double, 9 * Nodes, 4>::Zero();
            for (int I = 0; I < Nodes; ++I) {
                const double n = Interpolation::shape_at[p][core::at(I)];
                const Vec3 g1 = n * y.template segment<3>(9 * I + 3), g2 = n * y.template segment<3>(9 * I + 6);
                B.template block<3, 1>(9 * I + 3, 0) = g1, B.template block<3, 1>(9 * I + 6, 1) = g2;
                B.template block<3, 1>(9 * I + 3, 2) = g2, B.template block<3, 1>(9 * I + 6, 2) = g1;
                B.template block<3, 1>(9 * I, 3) = rest.point[p].derivative[core::at(I)] * f[p].col(0);
            }
            const Eigen::Matrix<double, 9 * Nodes, 4> BC = rest.point[p].weight * B * C[p];
            tangent.noalias() += BC * B.transpose();
        }
        for (int I = 0; I < Nodes; ++I) {
            const auto& s = stress[core::at(I)];
            const auto add = [&](int a, int b, double value) {
                tangent.template block<3, 3>(9 * I + a, 9 * I + b).diagonal().array() += value;
            };
            add(3, 3, s[0]), add(6, 6, s[1]), add(3, 6, s[2]), add(6, 3, s[2]);
        }
    }
};

}  // namespace fibrant::beam

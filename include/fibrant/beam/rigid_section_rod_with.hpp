// SPDX-License-Identifier: MIT
#pragma once
/// @file The rod of rigid sections with a law of its own.

#include <fibrant/beam/element_memory.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>

namespace fibrant::beam {

/// RigidSectionRod whose section obeys a law. Its sections keep their shape, so that the law sees no strain of the section.
template <SectionMaterial M>
class RigidSectionRodWith : public RigidSectionRod, public Lawful<RigidSectionRodWith<M>, M> {
    using Base = RigidSectionRod;
    using Laws = Lawful<RigidSectionRodWith<M>, M>;
    friend Laws;

public:
    using Parameters = LawParameters<Base, M>;
    using Base::ElementMatrix, Base::ElementVector, Base::Strains;
    using Answer = SectionAnswer<typename M::History, M::entries.size()>;
    /// Of an iteration: at strains of its own, with the tangent there.
    struct Stresses : Base::Stresses {
        Strains strain = Strains::Zero();
        Eigen::Matrix<double, 6, 6> tangent = Eigen::Matrix<double, 6, 6>::Zero();
    };
    struct Rest : Base::Rest {
        ElementMemory<M, 1> memory{};
    };
    static constexpr std::array<double, 1> point_places{0.0};

    RigidSectionRodWith() : RigidSectionRodWith(Parameters{}) {}
    explicit RigidSectionRodWith(const Parameters& parameters) : Base(core::validated(parameters)), Laws(parameters.laws) {}

    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        return rest(section_constants(section), material, y);
    }
    Rest rest(const SectionConstants& section, const scene::ElasticMaterial& material, const ElementVector& y) const {
        Rest rest{Base::rest(section, scene::ElasticMaterial{material.young_modulus, 0.0}, y), {}};
        Laws::begin(rest, section, material, this->parameters_.shear_factor);
        rest.memory.section.keep_shape();
        return rest;
    }
    double energy(const Rest& rest, const ElementVector& y) const { return rest.length * answers(rest, y)[0].stored; }
    ElementVector internal_force(const Rest& rest, const ElementVector& y) const {
        return internal_force(rest, y, stresses(rest, y));
    }
    /// S(e*) + C(e*) (e - e*) for the strains e* of the iteration.
    ElementVector internal_force(const Rest& rest, const ElementVector& y, const Stresses& iterated) const {
        const typename Base::Turned turned(rest, y);
        const Strains s = iterated.value + iterated.tangent * (Base::strains(turned) - rest.strains - iterated.strain);
        return rest.length * Base::slope(turned).transpose() * s;
    }
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y) const {
        return tangent_stiffness(rest, y, stresses(rest, y));
    }
    /// With the stresses and the tangent of an iteration.
    ElementMatrix tangent_stiffness(const Rest& rest, const ElementVector& y, const Stresses& iterated) const {
        const typename Base::Turned turned(rest, y);
        const typename Base::Slope B = Base::slope(turned);
        ElementMatrix tangent = rest.length * B.transpose() * iterated.tangent * B;
        Base::add_geometric(turned, iterated, tangent);
        return tangent;
    }
    void residual_and_tangent(const Rest& rest, const ElementVector& y, const Stresses& iterated, ElementVector& force,
                              ElementMatrix& tangent) const {
        force = internal_force(rest, y);
        tangent = tangent_stiffness(rest, y, iterated);
    }
    Stresses stresses(const Rest& rest, const ElementVector& y) const {
        return stresses_at(rest, Base::strains(typename Base::Turned(rest, y)) - rest.strains);
    }
    /// At the strains e(q) + B(q) step.
    Stresses predicted_stresses(const Rest& rest, const ElementVector& y, const ElementVector& step) const {
        const typename Base::Turned turned(rest, y);
        return stresses_at(rest, Base::strains(turned) - rest.strains + Base::slope(turned) * step);
    }
    static Stresses without_compression(const Stresses& stresses) noexcept {
        Stresses tension = stresses;
        static_cast<Base::Stresses&>(tension) = Base::without_compression(stresses);
        return tension;
    }
    static double weight(const Rest& rest, std::size_t) noexcept { return rest.length; }
    std::array<Answer, 1> answers(const Rest& rest, const ElementVector& y) const {
        return {Laws::answer(rest, 0, law_strains(rest, y)[0])};
    }
    std::array<SectionStrains, 1> law_strains(const Rest& rest, const ElementVector& y) const {
        return {to_law(Base::strains(typename Base::Turned(rest, y)) - rest.strains)};
    }

private:
    using Matrix = Eigen::Matrix<double, 6, 6>;
    Stresses stresses_at(const Rest& rest, const Strains& e) const {
        const Answer at = Laws::answer(rest, 0, to_law(e));
        Stresses s{{of_law(at.stress)}, e, stiffness(at)};
        return s;
    }
    /// G and K on the axes of the section: g_1' = K_3 g_2 - K_2 g_3 and g_2' = K_1 g_3 - K_3 g_1.
    static SectionStrains to_law(const Strains& e) noexcept {
        SectionStrains s{};
        s[strain::e13] = e[0], s[strain::e23] = e[1], s[strain::e33] = e[2];
        s[strain::b2] = e[3], s[strain::b1] = -e[4];
        s[strain::c21] = e[5], s[strain::c12] = -e[5];
        return s;
    }
    static Strains of_law(const SectionStrains& s) noexcept {
        Strains e;
        e << s[strain::e13], s[strain::e23], s[strain::e33], s[strain::b2], -s[strain::b1], s[strain::c21] - s[strain::c12];
        return e;
    }
    static Matrix stiffness(const Answer& answer) {
        const Eigen::Matrix<double, 12, 12> C = full_tangent<M>(answer.tangent);
        Matrix K;
        for (int k = 0; k < 6; ++k) {
            SectionStrains column;
            Strains unit = Strains::Zero();
            unit[k] = 1.0;
            const SectionStrains e = to_law(unit);
            Eigen::Map<Eigen::Matrix<double, 12, 1>>(column.data()) =
                C * Eigen::Map<const Eigen::Matrix<double, 12, 1>>(e.data());
            K.col(k) = of_law(column);
        }
        return K;
    }
};

}  // namespace fibrant::beam

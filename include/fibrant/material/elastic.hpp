// SPDX-License-Identifier: MIT
#pragma once
/// @file The elastic section: isotropic, or transversely isotropic as carbon, aramid and polyethylene are.

#include <fibrant/beam/section_material.hpp>

#include <cmath>

namespace fibrant::material {

using beam::Drive;
using beam::PointPlace;
using beam::SectionStrains;
using beam::detail::elastic_entries;
namespace strain = beam::strain;

/// Stiffnesses of a section, a unit of rest length. The energy is half the quadratic form of
///   A [E_L E33^2 + k_T (X11 + X22)^2 + G_TT ((X11 - X22)^2 + (2 E12)^2) + ks G_LT ((2 E13)^2 + (2 E23)^2)]
///   + E_L (I1 b1^2 + I2 b2^2) + G_LT [I1 (c11^2 + c21^2) + I2 (c12^2 + c22^2)],
/// 1/k_T = 2 (1 - nu_TT)/E_T - 4 nu_LT^2/E_L the plane-strain bulk modulus (Hashin and Rosen 1964), G_TT = E_T/(2 (1 + nu_TT)).
/// The twist (c21 - c12)/2 counts as sqrt(torsion_factor) times itself, as in beam::SectionLaw, whose split law this is if
/// isotropic.
struct ElasticSection {
    double contraction = 0.0;                  ///< nu_LT [1]
    std::array<double, 12> diagonal{};         ///< by `strain`
    double lateral = 0.0, twist_coupling = 0;  ///< between X11 and X22, and c12 and c21

    ElasticSection() = default;
    ElasticSection(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) {
        shape.validate();
        elastic.validate();
        core::require_positive("shear_factor", shear_factor);
        const double young = elastic.young_modulus, nu = elastic.poisson_ratio, shear = elastic.shear_modulus(), A = shape.area;
        double bulk = elastic.lame() + shear, across = shear;
        if (elastic.transverse.given()) {
            const scene::TransverseConstants& t = elastic.transverse;
            bulk = 1.0 / (2.0 * (1.0 - t.poisson_ratio) / t.young_modulus - 4.0 * nu * nu / young);
            across = 0.5 * t.young_modulus / (1.0 + t.poisson_ratio);
        }
        contraction = nu;
        diagonal[strain::e11] = diagonal[strain::e22] = A * (bulk + across);
        lateral = A * (bulk - across);
        diagonal[strain::e12] = A * across;
        diagonal[strain::e33] = A * young;
        diagonal[strain::e13] = diagonal[strain::e23] = shear_factor * A * shear;
        const double m1 = shape.second_moment_1, m2 = shape.second_moment_2, f = shape.torsion_factor;
        diagonal[strain::b1] = young * m1, diagonal[strain::b2] = young * m2;
        diagonal[strain::c11] = shear * m1, diagonal[strain::c22] = shear * m2;
        const double even = 0.25 * shear * (m1 + m2) * (1.0 + f), odd = 0.5 * shear * (m1 - m2) * std::sqrt(f);
        diagonal[strain::c12] = even - odd, diagonal[strain::c21] = even + odd;
        twist_coupling = 0.25 * shear * (m1 + m2) * (1.0 - f);
    }
    /// Of a beam whose sections keep their shape: nothing is stored there, and they contract freely.
    void keep_shape() noexcept { diagonal[strain::e11] = diagonal[strain::e22] = diagonal[strain::e12] = lateral = 0.0; }
    SectionStrains stress(const SectionStrains& e) const noexcept {
        SectionStrains s;
        for (std::size_t c = 0; c < s.size(); ++c) s[c] = diagonal[c] * e[c];
        s[strain::e11] += lateral * e[strain::e22], s[strain::e22] += lateral * e[strain::e11];
        s[strain::c12] += twist_coupling * e[strain::c21], s[strain::c21] += twist_coupling * e[strain::c12];
        return s;
    }
    /// a . C b
    double product(const SectionStrains& a, const SectionStrains& b) const noexcept {
        const SectionStrains s = stress(b);
        double sum = 0.0;
        for (std::size_t c = 0; c < s.size(); ++c) sum += a[c] * s[c];
        return sum;
    }
    /// By elastic_entries.
    std::array<double, elastic_entries.size()> tangent(double factor = 1.0) const noexcept {
        std::array<double, elastic_entries.size()> C;
        for (std::size_t c = 0; c < diagonal.size(); ++c) C[c] = factor * diagonal[c];
        C[12] = factor * lateral, C[13] = factor * twist_coupling;
        return C;
    }
};

/// Linear elasticity by scene::ElasticMaterial, isotropic or transversely isotropic; what other laws start from.
class Elastic {
public:
    using Parameters = core::NoParameters;
    using History = beam::NoMemory;
    using Section = ElasticSection;
    static constexpr auto entries = elastic_entries;
    static constexpr bool has_rate = false;
    using Answer = beam::SectionAnswer<History, entries.size()>;

    explicit Elastic(const Parameters& = {}) {}
    Section section(const beam::SectionConstants& shape, const scene::ElasticMaterial& elastic, double shear_factor) const {
        return {shape, elastic, shear_factor};
    }
    History fresh(const Section&, const PointPlace&) const noexcept { return {}; }
    Answer response(const Section& section, const SectionStrains& e, const History&, const Drive&) const noexcept {
        Answer answer;
        answer.stress = section.stress(e);
        answer.tangent = section.tangent();
        for (std::size_t c = 0; c < e.size(); ++c) answer.stored += 0.5 * e[c] * answer.stress[c];
        return answer;
    }
};
static_assert(beam::SectionMaterial<Elastic>);

}  // namespace fibrant::material

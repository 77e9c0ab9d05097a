// SPDX-License-Identifier: MIT
#pragma once
/// @file Elastic law of a fibre's section: from the generalised strains of a director beam to their conjugates.

#include <fibrant/core/parameters.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <array>
#include <cmath>
#include <cstddef>

namespace fibrant::beam {

/// Law of the strain that is linear in the section's coordinates.
enum class ElasticLaw {
    split,  ///< the section's mean obeys the 3-D law, bending the uniaxial one: exactly EA and EI for any nu
    full,   ///< the 3-D law everywhere: bends (1 - nu) / ((1 + nu)(1 - 2 nu)) too stiffly, since directors cannot widen
};
/// Where the strains E_11, E_22, 2 E_12 of the section are evaluated.
enum class SectionSampling {
    nodal,  ///< at the nodes, and interpolated: an interpolated director is too short between turned nodes
    gauss,  ///< at the Gauss points, as all others
};
/// What is kept of E_33 quadratic in the section's coordinates, of the order of (r kappa)^2.
enum class QuadraticStrain {
    none,
    mean,      ///< its mean over the section, added to E_33
    complete,  ///< and its deviation from the mean
};

/// What the torsion of a section is measured by, t = (c21 - c12)/2 or less of it.
enum class TwistStrain {
    metric,  ///< Green's: a section that narrows by d is twisted by d^2 less, so it narrows, and M is (r t)^2 (1 - nu)/(1 + nu)
             ///< short of G J t
    turn,    ///< over the mean square of the directors: what the section turns by along the fibre, however wide it is; M = G J t
};

/// Generalised strains: coefficients of the Green-Lagrange strain as a polynomial in (xi_1, xi_2), less those at rest.
namespace strain {
inline constexpr int e11 = 0, e22 = 1, e12 = 2;             ///< E_11, E_22, 2 E_12 of the section [1]
inline constexpr int e33 = 3, e13 = 4, e23 = 5;             ///< E_33, 2 E_13, 2 E_23: stretch and shear [1]
inline constexpr int b1 = 6, b2 = 7;                        ///< a . g_a': bending [1 / length]
inline constexpr int c11 = 8, c12 = 9, c21 = 10, c22 = 11;  ///< g_a . g_b': torsion and gradients [1 / length]
inline constexpr int q11 = 12, q12 = 13, q22 = 14;          ///< g_a' . g_b' (halved if a = b) [1 / length^2]
/// How many strains there are, by whether the quadratic ones are complete.
inline constexpr int count(QuadraticStrain quadratic) noexcept { return quadratic == QuadraticStrain::complete ? 15 : 12; }
}  // namespace strain

/// Integrals over a section. Any shape with axes of symmetry along g_1 and g_2; the fourth moments are an ellipse's, also of a
/// hollow one.
struct SectionConstants {
    double area = core::unset;             ///< [length^2], > 0
    double second_moment_1 = core::unset;  ///< integral of xi_1^2 [length^4], > 0
    double second_moment_2 = core::unset;  ///< integral of xi_2^2 [length^4], > 0
    double torsion_factor = 1.0;           ///< torsion constant over second_moment_1 + second_moment_2 [1], > 0
    double bore = 0.0;                     ///< radius of a round hole along the axis, which the others are without [length], >= 0

    void validate() const {
        core::require_positive("SectionConstants.area", area);
        core::require_positive("SectionConstants.second_moment_1", second_moment_1);
        core::require_positive("SectionConstants.second_moment_2", second_moment_2);
        core::require_positive("SectionConstants.torsion_factor", torsion_factor);
    }
};

/// Throws std::invalid_argument if the section is not valid.
inline SectionConstants section_constants(const scene::CrossSection& section) {
    section.validate();
    return {section.area(), section.second_moment_1(), section.second_moment_2(), section.torsion_factor(), section.bore};
}

/// St Venant-Kirchhoff law integrated over the section; the energy a unit of rest length is quadratic in the strains.
///
/// split: A [lam/2 (E11+E22+E33)^2 + mu (E11^2+E22^2+E33^2) + mu/2 ((2E12)^2 + ks (2E13)^2 + ks (2E23)^2)]
///        + E/2 (I1 b1^2 + I2 b2^2) + mu/2 [I1 (c11^2 + c21^2) + I2 (c12^2 + c22^2)].
/// full:  lam + 2 mu stands for E.
/// In (c12, c21) the twist rate t = (c21 - c12)/2 counts as sqrt(torsion_factor) t, which keeps the law positive
/// definite and gives torsion_factor mu (I1 + I2) in pure twist. In `complete` the deviation of the quadratic strain
/// from its mean obeys the modulus of bending; its moments are I^2/A (11, 22), -I1 I2/(3A) (11-22), 2 I1 I2/(3A) (12).
template <ElasticLaw Law, QuadraticStrain Quadratic>
class SectionLaw {
public:
    static constexpr int strains = strain::count(Quadratic);
    using Strains = std::array<double, static_cast<std::size_t>(strains)>;

    SectionLaw() = default;
    /// @param shear_factor  ks [1], > 0. Throws std::invalid_argument for values that are not valid.
    SectionLaw(const SectionConstants& section, const scene::ElasticMaterial& material, double shear_factor) {
        section.validate();
        material.validate();
        material.require_isotropic("DirectorBeam");
        core::require_positive("shear_factor", shear_factor);
        const double lame = material.lame(), shear = material.shear_modulus();
        const double bending = Law == ElasticLaw::split ? material.young_modulus : lame + 2.0 * shear;
        const double area = section.area, m1 = section.second_moment_1, m2 = section.second_moment_2;
        coupling_ = area * lame;
        diagonal_[strain::e11] = diagonal_[strain::e22] = diagonal_[strain::e33] = area * (lame + 2.0 * shear);
        diagonal_[strain::e12] = area * shear;
        diagonal_[strain::e13] = diagonal_[strain::e23] = shear_factor * area * shear;
        diagonal_[strain::b1] = bending * m1;
        diagonal_[strain::b2] = bending * m2;
        diagonal_[strain::c11] = shear * m1;
        diagonal_[strain::c22] = shear * m2;
        // With s = (c12 + c21)/2 and t' = sqrt(f) t: mu/2 [(m1 + m2)(s^2 + t'^2) + 2 (m1 - m2) s t'].
        const double f = section.torsion_factor;
        const double even = 0.25 * shear * (m1 + m2) * (1.0 + f), odd = 0.5 * shear * (m1 - m2) * std::sqrt(f);
        diagonal_[strain::c12] = even - odd;
        diagonal_[strain::c21] = even + odd;
        twist_coupling_ = 0.25 * shear * (m1 + m2) * (1.0 - f);
        mean_1_ = m1 / area;
        mean_2_ = m2 / area;
        if constexpr (Quadratic == QuadraticStrain::complete) {
            diagonal_[strain::q11] = bending * m1 * m1 / area;
            diagonal_[strain::q22] = bending * m2 * m2 / area;
            diagonal_[strain::q12] = bending * 2.0 / 3.0 * m1 * m2 / area;
            quadratic_coupling_ = -bending / 3.0 * m1 * m2 / area;
        }
    }

    /// Conjugates of the strains, a unit of rest length.
    Strains stress(const Strains& e) const noexcept {
        Strains s;
        for (std::size_t c = 0; c < s.size(); ++c) s[c] = diagonal_[c] * e[c];
        s[strain::e11] += coupling_ * (e[strain::e22] + e[strain::e33]);
        s[strain::e22] += coupling_ * (e[strain::e11] + e[strain::e33]);
        s[strain::e33] += coupling_ * (e[strain::e11] + e[strain::e22]);
        s[strain::c12] += twist_coupling_ * e[strain::c21];
        s[strain::c21] += twist_coupling_ * e[strain::c12];
        if constexpr (Quadratic == QuadraticStrain::complete) {
            s[strain::q11] += quadratic_coupling_ * e[strain::q22];
            s[strain::q22] += quadratic_coupling_ * e[strain::q11];
        }
        return s;
    }
    /// Energy a unit of rest length.
    double energy(const Strains& e) const noexcept {
        const Strains s = stress(e);
        double sum = 0.0;
        for (std::size_t c = 0; c < s.size(); ++c) sum += 0.5 * s[c] * e[c];
        return sum;
    }

    /// Stiffness of one strain by itself.
    double diagonal(int c) const noexcept { return diagonal_[static_cast<std::size_t>(c)]; }
    /// Between any two of E_11, E_22, E_33 (Poisson).
    double coupling() const noexcept { return coupling_; }
    /// Between c12 and c21.
    double twist_coupling() const noexcept { return twist_coupling_; }
    /// Of s = (c12 + c21)/2 and t = (c21 - c12)/2, as the energy is half of even s^2 + twist t^2 + 2 odd s t.
    double even() const noexcept { return diagonal(strain::c12) + diagonal(strain::c21) + 2.0 * twist_coupling_; }
    double twist() const noexcept { return diagonal(strain::c12) + diagonal(strain::c21) - 2.0 * twist_coupling_; }
    double odd() const noexcept { return diagonal(strain::c21) - diagonal(strain::c12); }
    /// Between q11 and q22.
    double quadratic_coupling() const noexcept { return quadratic_coupling_; }
    /// Mean of xi_a^2 over the section [length^2].
    double mean_1() const noexcept { return mean_1_; }
    double mean_2() const noexcept { return mean_2_; }

private:
    Strains diagonal_{};
    double coupling_ = 0, twist_coupling_ = 0, quadratic_coupling_ = 0, mean_1_ = 0, mean_2_ = 0;
};

}  // namespace fibrant::beam

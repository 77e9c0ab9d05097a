// SPDX-License-Identifier: MIT
#pragma once
/// @file Elastic laws of a solid: energy, second Piola-Kirchhoff stress and tangent of the Green-Lagrange strain.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <concepts>
#include <limits>

namespace fibrant::solid {

/// Symmetric tensor as (11, 22, 33, 12, 23, 13); of strains the last three are doubled.
using Voigt = Eigen::Matrix<double, 6, 1>;
using VoigtMatrix = Eigen::Matrix<double, 6, 6>;

/// Rows and columns of the six components.
inline constexpr std::array<std::array<int, 2>, 6> voigt_pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}}};

/// Tensor of a stress, or of a strain whose shears are doubled.
inline Mat3 stress_tensor(const Voigt& s) noexcept {
    Mat3 t;
    t << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    return t;
}
inline Mat3 strain_tensor(const Voigt& e) noexcept {
    Mat3 t;
    t << e[0], 0.5 * e[3], 0.5 * e[5], 0.5 * e[3], e[1], 0.5 * e[4], 0.5 * e[5], 0.5 * e[4], e[2];
    return t;
}
/// Strain components of a symmetric tensor.
inline Voigt strain_of(const Mat3& e) noexcept {
    Voigt v;
    v << e(0, 0), e(1, 1), e(2, 2), 2.0 * e(0, 1), 2.0 * e(1, 2), 2.0 * e(0, 2);
    return v;
}

/// At one point of a solid.
struct SolidResponse {
    double energy = 0.0;                        ///< a unit of rest volume [force / length^2]
    Voigt stress = Voigt::Zero();               ///< second Piola-Kirchhoff [force / length^2]
    VoigtMatrix tangent = VoigtMatrix::Zero();  ///< d stress / d strain, symmetric [force / length^2]
};

/// Elastic law of a solid.
/// Owed beyond the syntax, and checked by tests/solid/solid_law_test.cpp: stress and tangent are derivatives of the energy,
/// which is zero without strain; small strains meet Hooke's law. Where a strain is impossible (a volume that is not
/// positive) the response is not finite.
template <class L>
concept SolidLaw = core::Policy<L> && requires(const L law, const scene::ElasticMaterial& material, const Voigt& strain) {
    { law.response(material, strain) } -> std::same_as<SolidResponse>;
};

/// W = lambda/2 (tr E)^2 + mu E:E. Softens under compression: at a stretch of 0.58 it gives way.
struct SaintVenantKirchhoff {
    using Parameters = core::NoParameters;
    SaintVenantKirchhoff() = default;
    explicit SaintVenantKirchhoff(const Parameters&) {}

    SolidResponse response(const scene::ElasticMaterial& material, const Voigt& strain) const noexcept {
        const double lame = material.lame(), mu = material.shear_modulus();
        SolidResponse r;
        r.tangent.topLeftCorner<3, 3>().setConstant(lame);
        r.tangent.diagonal() << lame + 2.0 * mu, lame + 2.0 * mu, lame + 2.0 * mu, mu, mu, mu;
        r.stress = r.tangent * strain;
        r.energy = 0.5 * strain.dot(r.stress);
        return r;
    }
};
static_assert(SolidLaw<SaintVenantKirchhoff>);

/// W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2, with C = 2 E + 1 and J^2 = det C: resists compression to the end.
struct NeoHookean {
    using Parameters = core::NoParameters;
    NeoHookean() = default;
    explicit NeoHookean(const Parameters&) {}

    SolidResponse response(const scene::ElasticMaterial& material, const Voigt& strain) const noexcept {
        const double lame = material.lame(), mu = material.shear_modulus();
        const Mat3 e = strain_tensor(strain), c = 2.0 * e + Mat3::Identity();
        SolidResponse r;
        // det C - 1 from invariants of E keeps the digits of small strains.
        const double trace = e.trace(), square = (e * e).trace();
        const double volume = 2.0 * trace + 2.0 * (trace * trace - square) + 8.0 * e.determinant();
        if (!(volume > -1.0) || !(c(0, 0) > 0.0) || !(c(0, 0) * c(1, 1) > c(0, 1) * c(0, 1))) {
            const double none = std::numeric_limits<double>::quiet_NaN();
            return {none, Voigt::Constant(none), VoigtMatrix::Constant(none)};
        }
        const double log = 0.5 * std::log1p(volume);
        const Mat3 inverse = c.inverse();
        const Mat3 s = mu * inverse * (2.0 * e) + lame * log * inverse;  // mu (1 - C^-1) = mu C^-1 (C - 1)
        r.energy = mu * (trace - log) + 0.5 * lame * log * log;
        for (int k = 0; k < 6; ++k) {
            const auto [i, j] = voigt_pairs[core::at(k)];
            r.stress[k] = 0.5 * (s(i, j) + s(j, i));
            for (int l = 0; l < 6; ++l) {
                const auto [m, n] = voigt_pairs[core::at(l)];
                r.tangent(k, l) = lame * inverse(i, j) * inverse(m, n) +
                                  (mu - lame * log) * (inverse(i, m) * inverse(j, n) + inverse(i, n) * inverse(j, m));
            }
        }
        return r;
    }
};
static_assert(SolidLaw<NeoHookean>);

}  // namespace fibrant::solid

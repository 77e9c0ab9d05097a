// SPDX-License-Identifier: MIT
#pragma once
/// @file Elastic constants of a fibre, isotropic or transversely isotropic.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <cmath>
#include <string>

namespace fibrant::scene {

/// What a transversely isotropic fibre is in its section, where it differs from what it is along: carbon, aramid, polyethylene.
struct TransverseConstants {
    double young_modulus = core::unset;  ///< E_T [force / length^2], > 0
    double poisson_ratio = core::unset;  ///< nu_TT, in the plane of the section [1], in (-1, 1)
    double shear_modulus = core::unset;  ///< G_LT, between the fibre and its section [force / length^2], > 0

    bool given() const noexcept { return !(std::isnan(young_modulus) && std::isnan(poisson_ratio) && std::isnan(shear_modulus)); }
};

/// Isotropic elasticity (St Venant-Kirchhoff when strains are finite); with `transverse` these are E_L and nu_LT, along the
/// fibre, and nu_LT is the contraction across under tension along.
struct ElasticMaterial {
    double young_modulus = core::unset;  ///< E [force / length^2], > 0
    double poisson_ratio = core::unset;  ///< nu [1], in (-1, 0.5); with `transverse` nu_LT^2 < E_L (1 - nu_TT) / (2 E_T)
    TransverseConstants transverse{};    ///< none: isotropic
    Index law = 0;                       ///< which of the laws of a beam that has several, counted from 0

    void validate() const {
        core::require_positive("ElasticMaterial.young_modulus", young_modulus);
        core::require_at_least("ElasticMaterial.law", law, 0);
        if (!transverse.given()) {
            core::require(poisson_ratio > -1.0 && poisson_ratio < 0.5, "ElasticMaterial.poisson_ratio", poisson_ratio,
                          "> -1 and < 0.5");
            return;
        }
        core::require_positive("ElasticMaterial.transverse.young_modulus", transverse.young_modulus);
        core::require_positive("ElasticMaterial.transverse.shear_modulus", transverse.shear_modulus);
        core::require(transverse.poisson_ratio > -1.0 && transverse.poisson_ratio < 1.0,
                      "ElasticMaterial.transverse.poisson_ratio", transverse.poisson_ratio, "> -1 and < 1");
        const double bound = std::sqrt(0.5 * young_modulus * (1.0 - transverse.poisson_ratio) / transverse.young_modulus);
        core::require(std::abs(poisson_ratio) < bound, "ElasticMaterial.poisson_ratio", poisson_ratio,
                      "between -" + core::text(bound) + " and " + core::text(bound) + ", or the energy is not positive");
    }
    /// Throws std::invalid_argument for constants that only a beam with a law of its own takes.
    void require_isotropic(const std::string& user) const {
        if (transverse.given())
            core::refuse(user + ": ElasticMaterial.transverse", "given",
                         "left out: " + user + " is isotropic; beam::With<..., material::Elastic> is not");
        if (law != 0) core::refuse(user + ": ElasticMaterial.law", std::to_string(law), "0: " + user + " has one law");
    }
    /// Modulus E* of a section that two opposite line loads press at held length [force / length^2]: E / (1 - nu^2) if isotropic.
    double section_modulus() const noexcept {
        const double share = transverse.given() ? transverse.young_modulus / young_modulus : 1.0;
        return (transverse.given() ? transverse.young_modulus : young_modulus) / (1.0 - poisson_ratio * poisson_ratio * share);
    }
    /// First Lame constant, if isotropic [force / length^2].
    double lame() const noexcept { return young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio)); }
    /// Shear modulus G, between the fibre and its section [force / length^2].
    double shear_modulus() const noexcept {
        return transverse.given() ? transverse.shear_modulus : 0.5 * young_modulus / (1.0 + poisson_ratio);
    }
};

}  // namespace fibrant::scene

// SPDX-License-Identifier: MIT
#pragma once
/// @file Isotropic elastic constants of a fibre.

#include <fibrant/core/parameters.hpp>

namespace fibrant::scene {

/// Isotropic elasticity (St Venant-Kirchhoff when strains are finite).
struct ElasticMaterial {
    double young_modulus = core::unset;  ///< E [force / length^2], > 0
    double poisson_ratio = core::unset;  ///< nu [1], in (-1, 0.5)

    void validate() const {
        core::require_positive("ElasticMaterial.young_modulus", young_modulus);
        core::require(poisson_ratio > -1.0 && poisson_ratio < 0.5, "ElasticMaterial.poisson_ratio", poisson_ratio,
                      "> -1 and < 0.5");
    }
    /// First Lame constant [force / length^2].
    double lame() const noexcept {
        return young_modulus * poisson_ratio / ((1.0 + poisson_ratio) * (1.0 - 2.0 * poisson_ratio));
    }
    /// Shear modulus G [force / length^2].
    double shear_modulus() const noexcept { return 0.5 * young_modulus / (1.0 + poisson_ratio); }
};

}  // namespace fibrant::scene

// SPDX-License-Identifier: MIT
#pragma once
/// @file Penalty with a quadratic start.

#include <fibrant/law/normal_law.hpp>

#include <cmath>

namespace fibrant::law {

/// Penalty law, quadratic below a threshold of penetration and linear beyond it.
///
/// Durville, section 15.3.2, eq. [10] of the normal law; its third condition is read as gap <= -p_reg, without which
/// the reaction jumps. The slope is continuous, so a contact that opens and closes does not stop Newton.
class RegularisedPenalty {
public:
    struct Parameters {
        double regularisation_depth = core::unset;  ///< p_reg [length], > 0
        void validate() const { core::require_positive("RegularisedPenalty.regularisation_depth", regularisation_depth); }
    };
    explicit RegularisedPenalty(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    /// @param gap        along the contact normal, < 0 in penetration [length]
    /// @param stiffness  of the element's proximity zone, > 0 [force / length]
    NormalResponse response(double gap, double stiffness) const noexcept {
        const double depth = parameters_.regularisation_depth;
        if (gap >= 0.0) return {0.0, 0.0};
        if (gap > -depth) return {0.5 * stiffness / depth * gap * gap, stiffness / depth * gap};
        return {-stiffness * (gap + 0.5 * depth), -stiffness};
    }

    /// Work stored by a penetration [force * length]; its derivative by the gap is minus the reaction.
    double energy(double gap, double stiffness) const noexcept {
        const double depth = parameters_.regularisation_depth;
        if (gap >= 0.0) return 0.0;
        if (gap > -depth) return -stiffness / (6.0 * depth) * gap * gap * gap;
        return stiffness * (0.5 * gap * gap + 0.5 * gap * depth + depth * depth / 6.0);
    }

    /// Penetration under a reaction >= 0 [length].
    double penetration(double reaction, double stiffness) const noexcept {
        const double depth = parameters_.regularisation_depth;
        return reaction < 0.5 * stiffness * depth ? std::sqrt(2.0 * depth * reaction / stiffness)
                                                  : reaction / stiffness + 0.5 * depth;
    }

    double regularisation_depth() const noexcept { return parameters_.regularisation_depth; }

private:
    Parameters parameters_;
};
static_assert(Regularised<RegularisedPenalty> && InvertibleLaw<RegularisedPenalty>);

}  // namespace fibrant::law

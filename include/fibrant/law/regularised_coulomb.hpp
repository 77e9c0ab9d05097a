// SPDX-License-Identifier: MIT
#pragma once
/// @file Coulomb friction with a reversible displacement before gross sliding.

#include <fibrant/law/friction_law.hpp>

namespace fibrant::law {

/// Regularised Coulomb friction (Durville, section 15.3.2): elastic up to a reversible displacement u_max, then sliding
/// at mu R_N. The chapter prints no formula; this is the return mapping in the tangent plane.
class RegularisedCoulomb {
public:
    struct Parameters {
        double friction_coefficient = core::unset;     ///< mu [1], >= 0
        double reversible_displacement = core::unset;  ///< u_max [length], > 0
        void validate() const {
            core::require_not_negative("RegularisedCoulomb.friction_coefficient", friction_coefficient);
            core::require_positive("RegularisedCoulomb.reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();  ///< u_rev, tangential, |u_rev| <= u_max [length]
    };
    explicit RegularisedCoulomb(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    /// @param slip      tangential displacement of particle j against particle i since the last accepted state [length]
    /// @param reaction  R_N, >= 0 [force]
    /// @param history   of the last accepted state, turned with the fibres
    FrictionResponse<History> response(const Vec3& slip, double reaction, const History& history) const noexcept {
        const double range = parameters_.reversible_displacement;
        const double bound = parameters_.friction_coefficient * reaction;
        FrictionResponse<History> answer;
        if (parameters_.friction_coefficient == 0.0) return answer;  // nothing is ever held, so nothing is remembered
        const Vec3 trial = history.reversible + slip;
        const double length = trial.norm();
        if (length <= range) {
            answer.force = bound / range * trial;
            answer.tangent.diagonal().setConstant(bound / range);
            answer.history.reversible = trial;
            answer.stored = 0.5 * bound / range * length * length;
            return answer;
        }
        const Vec3 direction = trial / length;
        answer.force = bound * direction;
        answer.tangent = bound / length * (Mat3::Identity() - direction * direction.transpose());
        answer.history.reversible = range * direction;
        answer.stored = 0.5 * bound * range;
        answer.dissipated = bound * (length - range);
        answer.sliding = true;
        return answer;
    }

    double friction_coefficient() const noexcept { return parameters_.friction_coefficient; }
    double reversible_displacement() const noexcept { return parameters_.reversible_displacement; }

private:
    Parameters parameters_;
};
static_assert(FrictionLaw<RegularisedCoulomb> && core::Active<RegularisedCoulomb>);

}  // namespace fibrant::law

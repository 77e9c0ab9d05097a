// SPDX-License-Identifier: MIT
#pragma once
/// @file Coulomb friction whose stiffness fades out before it slides.

#include <fibrant/law/friction_law.hpp>

namespace fibrant::law {

/// Coulomb friction with a reversible part that bends over: R_T = mu R_N (2 y - y^2) along the reversible displacement u, with
/// y = |u| / u_max up to 1, and sliding at mu R_N beyond (METHOD 3.3). Twice as stiff as RegularisedCoulomb at first, and with a
/// slope that has no jump where sliding begins.
class SmoothCoulomb {
public:
    struct Parameters {
        double friction_coefficient = core::unset;     ///< mu [1], >= 0
        double reversible_displacement = core::unset;  ///< u_max [length], > 0
        void validate() const {
            core::require_not_negative("SmoothCoulomb.friction_coefficient", friction_coefficient);
            core::require_positive("SmoothCoulomb.reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();  ///< u_rev, tangential, |u_rev| <= u_max [length]
    };
    explicit SmoothCoulomb(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    /// @param slip      tangential displacement of particle j against particle i since the last accepted state [length]
    /// @param reaction  R_N, >= 0 [force]
    /// @param history   of the last accepted state, turned with the fibres
    FrictionResponse<History> response(const Vec3& slip, double reaction, const History& history) const noexcept {
        const double range = parameters_.reversible_displacement;
        const double bound = parameters_.friction_coefficient * reaction;
        FrictionResponse<History> answer;
        if (parameters_.friction_coefficient == 0.0) return answer;
        const Vec3 trial = history.reversible + slip;
        const double length = trial.norm(), y = length / range;
        const Vec3 direction = length > 0.0 ? Vec3(trial / length) : Vec3(Vec3::Zero());
        if (y <= 1.0) {
            const double secant = bound * (2.0 - y) / range, along = 2.0 * bound * (1.0 - y) / range;
            answer.force = secant * trial;
            answer.tangent = secant * Mat3::Identity() + (along - secant) * direction * direction.transpose();
            answer.history.reversible = trial;
            answer.stored = bound * range * y * y * (1.0 - y / 3.0);
            return answer;
        }
        answer.force = bound * direction;
        answer.tangent = bound / length * (Mat3::Identity() - direction * direction.transpose());
        answer.history.reversible = range * direction;
        answer.stored = bound * range * 2.0 / 3.0;
        answer.dissipated = bound * (length - range);
        answer.sliding = true;
        return answer;
    }

    double friction_coefficient() const noexcept { return parameters_.friction_coefficient; }
    double reversible_displacement() const noexcept { return parameters_.reversible_displacement; }

private:
    Parameters parameters_;
};
static_assert(FrictionLaw<SmoothCoulomb> && core::Active<SmoothCoulomb>);

}  // namespace fibrant::law

// SPDX-License-Identifier: MIT
#pragma once
/// @file A friction law of one's own, with memory: a tangential spring whose stiffness does not depend on the reaction, and that
/// slips.

#include <fibrant/law/friction_law.hpp>

#include <algorithm>

/// Force k u, u reversible, of at most mu R_N: what u would be beyond is slipped and lost.
class SlippingSpring {
public:
    struct Parameters {
        double friction_coefficient = fibrant::core::unset;  ///< mu [1], >= 0
        double stiffness = fibrant::core::unset;             ///< k [force / length], > 0
        void validate() const {
            fibrant::core::require_not_negative("SlippingSpring.friction_coefficient", friction_coefficient);
            fibrant::core::require_positive("SlippingSpring.stiffness", stiffness);
        }
    };
    struct History {
        fibrant::Vec3 reversible = fibrant::Vec3::Zero();  ///< u, tangential [length]: turned with the fibres
    };
    explicit SlippingSpring(const Parameters& parameters) : parameters_{fibrant::core::validated(parameters)} {}

    fibrant::law::FrictionResponse<History> response(const fibrant::Vec3& slip, double reaction,
                                                     const History& history) const noexcept {
        const double k = parameters_.stiffness, range = parameters_.friction_coefficient * reaction / k;
        const fibrant::Vec3 trial = history.reversible + slip;
        const double length = trial.norm();
        fibrant::law::FrictionResponse<History> answer;
        answer.sliding = length > range;
        const fibrant::Vec3 direction = length > 0.0 ? fibrant::Vec3(trial / length) : fibrant::Vec3(fibrant::Vec3::Zero());
        answer.history.reversible = answer.sliding ? fibrant::Vec3(range * direction) : trial;
        answer.force = k * answer.history.reversible;
        if (answer.sliding)
            answer.tangent = k * range / length * (fibrant::Mat3::Identity() - direction * direction.transpose());
        else
            answer.tangent = k * fibrant::Mat3::Identity();
        answer.stored = 0.5 * k * answer.history.reversible.squaredNorm();
        if (answer.sliding) answer.dissipated = std::max(0.0, k * range * (length - range));
        return answer;
    }

private:
    Parameters parameters_;
};
static_assert(fibrant::law::FrictionLaw<SlippingSpring>);

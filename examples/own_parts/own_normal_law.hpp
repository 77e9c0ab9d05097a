// SPDX-License-Identifier: MIT
#pragma once
/// @file A normal law of one's own: the reaction grows with the power 3/2 of the penetration, as between smooth bodies (Hertz).

#include <fibrant/law/normal_law.hpp>

#include <cmath>

/// R = k p sqrt(p / d), p the penetration: as stiff as a linear law at the depth 4 d / 9.
class PowerLaw {
public:
    struct Parameters {
        double depth = fibrant::core::unset;  ///< d [length], > 0
        void validate() const { fibrant::core::require_positive("PowerLaw.depth", depth); }
    };
    explicit PowerLaw(const Parameters& parameters) : depth_{fibrant::core::validated(parameters).depth} {}

    fibrant::law::NormalResponse response(double gap, double stiffness) const noexcept {
        if (gap >= 0.0) return {0.0, 0.0};
        const double root = std::sqrt(-gap / depth_);
        return {-stiffness * gap * root, -1.5 * stiffness * root};
    }
    double energy(double gap, double stiffness) const noexcept {
        return gap >= 0.0 ? 0.0 : 0.4 * stiffness * gap * gap * std::sqrt(-gap / depth_);
    }

private:
    double depth_;
};
static_assert(fibrant::law::NormalLaw<PowerLaw>);

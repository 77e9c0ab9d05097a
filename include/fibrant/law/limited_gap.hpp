// SPDX-License-Identifier: MIT
#pragma once
/// @file Wrapper that lets fibres with a deep initial overlap part by a limited distance an increment.

#include <fibrant/law/normal_law.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::law {

/// Limits the penetration that a law is shown at the start of an increment (Durville, section 15.3.5).
///
/// The limit is an offset o = max(0, -gap - limit), taken from the gap at the last accepted state and added to the gap
/// during the increment. A clamp of the gap itself would give a constant force with a zero slope, which controls no
/// displacement; with the offset the element keeps its stiffness and moves by about the limit.
template <NormalLaw Law>
class LimitedGap {
public:
    struct Parameters {
        typename Law::Parameters law;
        double limit = core::unset;  ///< deepest penetration shown to the law [length], > 0; infinity switches it off
        void validate() const {
            law.validate();
            core::require(limit > 0.0, "LimitedGap.limit", limit, "> 0");
        }
    };
    explicit LimitedGap(const Parameters& parameters) : law_{core::validated(parameters).law}, limit_{parameters.limit} {}

    /// Offset of an element whose gap is `gap` at the last accepted state, >= 0 [length].
    double gap_shift(double gap) const noexcept { return std::max(0.0, -gap - limit_); }

    NormalResponse response(double gap, double stiffness) const noexcept { return law_.response(gap, stiffness); }
    double energy(double gap, double stiffness) const noexcept { return law_.energy(gap, stiffness); }
    double regularisation_depth() const noexcept requires Regularised<Law> { return law_.regularisation_depth(); }
    double limit() const noexcept { return limit_; }

    /// The same law with another limit [length], > 0.
    LimitedGap with_limit(double limit) const {
        core::require(limit > 0.0, "LimitedGap.limit", limit, "> 0");
        LimitedGap other = *this;
        other.limit_ = limit;
        return other;
    }

private:
    Law law_;
    double limit_;
};

}  // namespace fibrant::law

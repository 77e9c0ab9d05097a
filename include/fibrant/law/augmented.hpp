// SPDX-License-Identifier: MIT
#pragma once
/// @file Wrapper that frees a penalty of its penetration: augmented Lagrangian by Uzawa's iteration.

#include <fibrant/law/normal_law.hpp>

namespace fibrant::law {

/// Reaction max(0, lambda + k_N p) for a linear penalty k_N p, with a multiplier lambda of each contact element that becomes the
/// reaction at every contact pass. The passes of an increment go on until no contact that carries is deeper or
/// wider than `largest_penetration`, at a penalty that may be soft.
///
/// For any law the multiplier is put in as the penetration that the law would have under it, taken off the gap: the law, its
/// smooth start included, is left as it is, and contact adds the shift.
template <InvertibleLaw Law>
class Augmented {
public:
    struct Parameters {
        typename Law::Parameters law;
        double largest_penetration = core::unset;  ///< that an increment may leave [length], > 0
        void validate() const {
            law.validate();
            core::require_positive("Augmented.largest_penetration", largest_penetration);
        }
    };
    explicit Augmented(const Parameters& parameters)
        : law_{core::validated(parameters).law}, largest_penetration_{parameters.largest_penetration} {}

    NormalResponse response(double gap, double stiffness) const noexcept { return law_.response(gap, stiffness); }
    double energy(double gap, double stiffness) const noexcept { return law_.energy(gap, stiffness); }
    double penetration(double reaction, double stiffness) const noexcept { return law_.penetration(reaction, stiffness); }
    double largest_penetration() const noexcept { return largest_penetration_; }
    double regularisation_depth() const noexcept requires Regularised<Law> { return law_.regularisation_depth(); }

private:
    Law law_;
    double largest_penetration_;
};

}  // namespace fibrant::law

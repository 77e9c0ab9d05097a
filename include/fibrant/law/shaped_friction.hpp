// SPDX-License-Identifier: MIT
#pragma once
/// @file Friction by one coefficient and what makes it larger or smaller: direction, pressure, adhesion, and the way slid.

#include <fibrant/law/directed_friction.hpp>

namespace fibrant::law {

/// What friction is over Coulomb's. All at their defaults it is Coulomb's.
struct FrictionShape {
    double across = 1.0;               ///< coefficient across fibres over that along them [1], > 0
    double exponent = 1.0;             ///< n of T = a N^n [1], in (0, 1]
    double line_load = core::unset;    ///< at which the coefficient is itself where n < 1 [force / length], > 0; by it a is known
    double line_adhesion = 0.0;        ///< p_a, that a line of contact bears friction by without a load [force / length], >= 0
    double crossing_adhesion = 0.0;    ///< of a crossing, or an end [force], >= 0
    double static_over_kinetic = 1.0;  ///< coefficient of what has not slid over that of what has [1], >= 1
    double weakening_length = core::unset;  ///< way over which it falls by 1/e [length], > 0 where static_over_kinetic > 1
    double largest_coefficient = 2.0;       ///< along a fibre, which pressure makes no larger [1], > 0

    bool coulomb() const noexcept {
        return across == 1.0 && exponent == 1.0 && line_adhesion == 0.0 && crossing_adhesion == 0.0 && static_over_kinetic == 1.0;
    }
    void validate() const {
        core::require_positive("FrictionShape.across", across);
        core::require(exponent > 0.0 && exponent <= 1.0, "FrictionShape.exponent", exponent, "in (0, 1]");
        if (exponent < 1.0) core::require_positive("FrictionShape.line_load", line_load);
        core::require_not_negative("FrictionShape.line_adhesion", line_adhesion);
        core::require_not_negative("FrictionShape.crossing_adhesion", crossing_adhesion);
        core::require(std::isfinite(static_over_kinetic) && static_over_kinetic >= 1.0, "FrictionShape.static_over_kinetic",
                      static_over_kinetic, "finite and >= 1");
        if (static_over_kinetic > 1.0) core::require_positive("FrictionShape.weakening_length", weakening_length);
        core::require_positive("FrictionShape.largest_coefficient", largest_coefficient);
    }
};

/// R_T = mu w (R_N + p_a l) [(R_N + p_a l)/(q_0 l)]^(n-1) within the pair's ellipse of directions, w = 1 + (s - 1) exp(-slid/d)
/// by the way of accepted increments: DirectedFriction, AdhesiveFriction and SlipWeakeningFriction in one, with mu that a stage
/// sets. Crossings and ends have no line load: n = 1.
class ShapedFriction {
public:
    struct Parameters {
        double friction_coefficient = core::unset;     ///< mu along fibres, kinetic [1], >= 0
        double reversible_displacement = core::unset;  ///< u_max [length], > 0
        FrictionShape shape{};                         ///< what friction is over that of Coulomb
        void validate() const {
            core::require_not_negative("ShapedFriction.friction_coefficient", friction_coefficient);
            core::require_positive("ShapedFriction.reversible_displacement", reversible_displacement);
            shape.validate();
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();   ///< [length]
        std::array<double, 1> numbers{};  ///< way slid [length]
    };
    explicit ShapedFriction(const Parameters& parameters) : p_{core::validated(parameters)} {}
    SeenFriction<History> response(const Touch& touch, const History& accepted) const noexcept {
        SeenFriction<History> answer;
        if (p_.friction_coefficient == 0.0) return answer;  // nothing is ever held, so nothing is remembered
        answer.history.numbers = accepted.numbers;
        if (!(touch.reaction > 0.0)) return answer;
        const FrictionShape& shape = p_.shape;
        const bool line = touch.length > 0.0;
        double along = p_.friction_coefficient;
        if (shape.static_over_kinetic > 1.0)
            along *= 1.0 + (shape.static_over_kinetic - 1.0) * std::exp(-accepted.numbers[0] / shape.weakening_length);
        double load = touch.reaction + (line ? shape.line_adhesion * touch.length : shape.crossing_adhesion), power = 1.0 / load;
        if (line && shape.exponent < 1.0) {
            const double share = std::pow(load / (shape.line_load * touch.length), shape.exponent - 1.0);
            const bool bounded = along * share > shape.largest_coefficient;
            if (!bounded) power *= shape.exponent;
            load *= bounded ? shape.largest_coefficient / along : share;
        }
        const double across = shape.across * along;
        const Mat3 metric = shape.across == 1.0 ? detail::circle(along, touch.normal)
                                                : Mat3(0.5 * (detail::ellipse(along, across, touch.along_i, touch.normal) +
                                                              detail::ellipse(along, across, touch.along_j, touch.normal)));
        detail::slide(load, metric, along * p_.reversible_displacement, touch.slip, accepted, answer);
        answer.by_reaction = power * answer.force;
        answer.history.numbers[0] += answer.dissipated / (along * load);
        return answer;
    }
    double friction_coefficient() const noexcept { return p_.friction_coefficient; }
    double reversible_displacement() const noexcept { return p_.reversible_displacement; }

private:
    Parameters p_;
};
static_assert(SeeingFriction<ShapedFriction> && core::Active<ShapedFriction>);

/// Parameters of friction by coefficient and reversible displacement; a law that has a shape takes that as well.
template <FrictionLaw Law>
typename Law::Parameters friction_parameters(double coefficient, double reversible_displacement,
                                             [[maybe_unused]] const FrictionShape& shape) {
    if constexpr (requires(typename Law::Parameters p) { p.shape; })
        return {coefficient, reversible_displacement, shape};
    else
        return {coefficient, reversible_displacement};
}

}  // namespace fibrant::law

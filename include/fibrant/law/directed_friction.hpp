// SPDX-License-Identifier: MIT
#pragma once
/// @file Laws of friction that see direction, pressure, adhesion, history and rate.

#include <fibrant/law/friction_law.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fibrant::law {

namespace detail {

/// Bound of friction by direction, R_T . M^-1 R_T <= load^2, with the slip of least force (associated: most is dissipated).
/// Elastic over s(u) = sqrt(u . M u) up to `range`, then sliding: the return mapping of the potential load s(u).
/// @param load   >= 0 [force]; the metric has the squares of the coefficients
/// @param range  coefficient times reversible displacement
template <class History>
void slide(double load, const Mat3& metric, double range, const Vec3& slip, const History& accepted,
           SeenFriction<History>& answer) noexcept {
    const Vec3 trial = accepted.reversible + slip, push = metric * trial;
    const double size = std::sqrt(std::max(0.0, trial.dot(push))), most = std::max(size, range);
    answer.force = load / most * push;
    answer.tangent = load / most * metric;
    answer.sliding = size > range;
    if (answer.sliding) answer.tangent -= load / (size * size * size) * push * push.transpose();
    answer.history = accepted;
    answer.history.reversible = range / most * trial;
    if (!answer.sliding) answer.history.reversible = trial;
    answer.stored = answer.sliding ? 0.5 * load * range : 0.5 * load * size * size / range;
    answer.dissipated = load * std::max(0.0, size - range);
}
/// along^2 t t + across^2 c c in the tangent plane.
inline Mat3 ellipse(double along, double across, const Vec3& tangent, const Vec3& normal) noexcept {
    const Vec3 beside = normal.cross(tangent);
    return along * along * tangent * tangent.transpose() + across * across * beside * beside.transpose();
}
inline Mat3 circle(double coefficient, const Vec3& normal) noexcept {
    return coefficient * coefficient * (Mat3::Identity() - normal * normal.transpose());
}

}  // namespace detail

/// Coulomb friction of another coefficient along fibres than across, and of another power of the pressure than one: a line load q
/// carries a q^n a unit of length (Bowden and Young 1951; Howell 1953 for textile fibres), so an element R_N over l carries a
/// R_N^n l^(1 - n). A pair's ellipse is the mean of those of both fibres. Crossings and ends have no line load: they obey
/// Coulomb's law.
class DirectedFriction {
public:
    struct Parameters {
        double along = core::unset;            ///< a along a fibre [(force / length)^(1 - n)], > 0
        double across = core::unset;           ///< a across it, likewise
        double exponent = 1.0;                 ///< n [1], in (0, 1]
        double crossing_along = core::unset;   ///< coefficient of crossings [1], > 0; unset: `along`, for n = 1
        double crossing_across = core::unset;  ///< likewise
        double largest_coefficient = 2.0;      ///< of R_T over R_N along a fibre, which a q^(n - 1) is without a bound [1], > 0
        double reversible_displacement = core::unset;  ///< u_max [length], > 0
        void validate() const {
            core::require_positive("DirectedFriction.along", along);
            core::require_positive("DirectedFriction.across", across);
            core::require(exponent > 0.0 && exponent <= 1.0, "DirectedFriction.exponent", exponent, "in (0, 1]");
            if (exponent < 1.0 || !std::isnan(crossing_along))
                core::require_positive("DirectedFriction.crossing_along", crossing_along);
            if (exponent < 1.0 || !std::isnan(crossing_across))
                core::require_positive("DirectedFriction.crossing_across", crossing_across);
            core::require_positive("DirectedFriction.largest_coefficient", largest_coefficient);
            core::require_positive("DirectedFriction.reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();  ///< [length]
    };
    explicit DirectedFriction(const Parameters& parameters) : p_{core::validated(parameters)} {
        if (std::isnan(p_.crossing_along)) p_.crossing_along = p_.along;
        if (std::isnan(p_.crossing_across)) p_.crossing_across = p_.across;
    }
    SeenFriction<History> response(const Touch& touch, const History& accepted) const noexcept {
        SeenFriction<History> answer;
        if (!(touch.reaction > 0.0)) return answer;
        const bool line = touch.length > 0.0;
        const double along = line ? p_.along : p_.crossing_along, across = line ? p_.across : p_.crossing_across;
        double share = line && p_.exponent < 1.0 ? std::pow(touch.length / touch.reaction, 1.0 - p_.exponent) : 1.0,
               power = line ? p_.exponent : 1.0;
        if (along * share > p_.largest_coefficient) share = p_.largest_coefficient / along, power = 1.0;
        const Mat3 metric = 0.5 * (detail::ellipse(along, across, touch.along_i, touch.normal) +
                                   detail::ellipse(along, across, touch.along_j, touch.normal));
        detail::slide(share * touch.reaction, metric, along * p_.reversible_displacement, touch.slip, accepted, answer);
        answer.by_reaction = power / touch.reaction * answer.force;
        return answer;
    }

private:
    Parameters p_;
};

/// Coulomb friction of a pair that also sticks: mu (R_N + p_a l) where it touches (Derjaguin 1934), so that it resists without a
/// load.
class AdhesiveFriction {
public:
    struct Parameters {
        double friction_coefficient = core::unset;     ///< mu [1], > 0
        double line_adhesion = core::unset;            ///< p_a, of a line of contact [force / length], >= 0
        double crossing_adhesion = core::unset;        ///< of a crossing [force], >= 0
        double reversible_displacement = core::unset;  ///< [length], > 0
        void validate() const {
            core::require_positive("AdhesiveFriction.friction_coefficient", friction_coefficient);
            core::require_not_negative("AdhesiveFriction.line_adhesion", line_adhesion);
            core::require_not_negative("AdhesiveFriction.crossing_adhesion", crossing_adhesion);
            core::require_positive("AdhesiveFriction.reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();  ///< [length]
    };
    explicit AdhesiveFriction(const Parameters& parameters) : p_{core::validated(parameters)} {}
    SeenFriction<History> response(const Touch& touch, const History& accepted) const noexcept {
        SeenFriction<History> answer;
        if (!(touch.reaction > 0.0)) return answer;
        const double load = touch.reaction + (touch.length > 0.0 ? p_.line_adhesion * touch.length : p_.crossing_adhesion);
        detail::slide(load, detail::circle(p_.friction_coefficient, touch.normal),
                      p_.friction_coefficient * p_.reversible_displacement, touch.slip, accepted, answer);
        answer.by_reaction = answer.force / load;
        return answer;
    }

private:
    Parameters p_;
};

/// Coulomb friction that falls from a static to a kinetic coefficient with the way slid: mu = k + (s - k) exp(-slid / d). The way
/// is that of accepted increments, so that friction has a potential in each; it is not forgotten.
class SlipWeakeningFriction {
public:
    struct Parameters {
        double static_coefficient = core::unset;       ///< s [1], >= k
        double kinetic_coefficient = core::unset;      ///< k [1], > 0
        double weakening_length = core::unset;         ///< d [length], > 0
        double reversible_displacement = core::unset;  ///< [length], > 0
        void validate() const {
            core::require_positive("SlipWeakeningFriction.kinetic_coefficient", kinetic_coefficient);
            core::require(std::isfinite(static_coefficient) && static_coefficient >= kinetic_coefficient,
                          "SlipWeakeningFriction.static_coefficient", static_coefficient,
                          "finite and >= kinetic_coefficient = " + core::text(kinetic_coefficient));
            core::require_positive("SlipWeakeningFriction.weakening_length", weakening_length);
            core::require_positive("SlipWeakeningFriction.reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();   ///< [length]
        std::array<double, 1> numbers{};  ///< way slid [length]
    };
    explicit SlipWeakeningFriction(const Parameters& parameters) : p_{core::validated(parameters)} {}
    SeenFriction<History> response(const Touch& touch, const History& accepted) const noexcept {
        SeenFriction<History> answer;
        answer.history.numbers = accepted.numbers;
        if (!(touch.reaction > 0.0)) return answer;
        const double s = p_.static_coefficient, k = p_.kinetic_coefficient,
                     mu = k + (s - k) * std::exp(-accepted.numbers[0] / p_.weakening_length);
        detail::slide(touch.reaction, detail::circle(mu, touch.normal), mu * p_.reversible_displacement, touch.slip, accepted,
                      answer);
        answer.by_reaction = answer.force / touch.reaction;
        answer.history.numbers[0] += answer.dissipated / (mu * touch.reaction);
        return answer;
    }

private:
    Parameters p_;
};

/// A law and a fluid between the fibres beside it: c l du/dt, of a line of contact, where fibres touch. With Coulomb's a Bingham
/// solid. A stage has to have a duration.
template <SeeingFriction Law>
class Lubricated {
public:
    struct Parameters {
        typename Law::Parameters law{};
        double viscosity = core::unset;           ///< c, of a line of contact [force time / length^2], >= 0
        double crossing_viscosity = core::unset;  ///< of a crossing [force time / length], >= 0
        void validate() const {
            law.validate();
            core::require_not_negative("Lubricated.viscosity", viscosity);
            core::require_not_negative("Lubricated.crossing_viscosity", crossing_viscosity);
        }
    };
    using History = typename Law::History;
    explicit Lubricated(const Parameters& parameters) : law_{core::validated(parameters).law}, p_{parameters} {}
    /// From now on increments are of this duration, > 0 [time].
    void last(double duration) noexcept { duration_ = duration; }
    SeenFriction<History> response(const Touch& touch, const History& accepted) const noexcept {
        SeenFriction<History> answer = law_.response(touch, accepted);
        if (!(touch.reaction > 0.0)) return answer;
        const double rate = (touch.length > 0.0 ? p_.viscosity * touch.length : p_.crossing_viscosity) / duration_;
        answer.force += rate * touch.slip;
        answer.tangent += rate * (Mat3::Identity() - touch.normal * touch.normal.transpose());
        answer.dissipated += rate * touch.slip.squaredNorm();
        return answer;
    }

private:
    Law law_;
    Parameters p_;
    double duration_ = std::numeric_limits<double>::infinity();  // before it is told: nothing flows
};

static_assert(SeeingFriction<DirectedFriction> && SeeingFriction<AdhesiveFriction> && SeeingFriction<SlipWeakeningFriction>);
static_assert(FrictionWithRate<Lubricated<DirectedFriction>> && !FrictionWithRate<DirectedFriction>);

}  // namespace fibrant::law

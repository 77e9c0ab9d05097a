// SPDX-License-Identifier: MIT
#pragma once
/// @file Coulomb friction with a reversible displacement before gross sliding, by the shape of its rise.

#include <fibrant/law/friction_law.hpp>

#include <string>

namespace fibrant::law {

/// How friction rises to its bound over the reversible displacement: f(y), y from 0 to 1, f(0) = 0, f(1) = 1, never falling.
/// secant(y) = f / y, slope(y) = f', work(y) the integral of f; `name` is what refusals call the law.
template <class R>
concept FrictionRise = requires(double y) {
    { R::name } -> std::convertible_to<const char*>;
    { R::secant(y) } -> std::same_as<double>;
    { R::slope(y) } -> std::same_as<double>;
    { R::work(y) } -> std::same_as<double>;
};

/// R_T = mu R_N f(|u| / u_max) along the reversible displacement u up to u_max, and sliding at mu R_N beyond (Durville,
/// section 15.3.2). The chapter prints no formula; this is the return mapping in the tangent plane.
template <FrictionRise Rise>
class CoulombFriction {
public:
    struct Parameters {
        double friction_coefficient = core::unset;     ///< mu [1], >= 0
        double reversible_displacement = core::unset;  ///< u_max [length], > 0
        void validate() const {
            const std::string law = Rise::name;
            core::require_not_negative(law + ".friction_coefficient", friction_coefficient);
            core::require_positive(law + ".reversible_displacement", reversible_displacement);
        }
    };
    struct History {
        Vec3 reversible = Vec3::Zero();  ///< u_rev, tangential, |u_rev| <= u_max [length]
    };
    explicit CoulombFriction(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

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
        const auto rise = [&](double y) {  // answers its secant
            const double secant = bound / range * Rise::secant(y);
            answer.tangent.diagonal().setConstant(secant);
            const double bend = bound / range * (Rise::slope(y) - Rise::secant(y));  // none of a straight rise
            if (bend != 0.0 && length > 0.0) answer.tangent += bend / (length * length) * trial * trial.transpose();
            return secant;
        };
        if (length <= range) {
            const double y = length / range;
            answer.force = rise(y) * trial;
            answer.history.reversible = trial;
            answer.stored = bound * range * Rise::work(y);
            return answer;
        }
        const Vec3 direction = trial / length;
        answer.force = bound * direction;
        // What slid in the last increment begins the next one at the bound: it is to begin it as its mirror image does.
        if (length <= range * (1.0 + rounding))
            rise(1.0);
        else
            answer.tangent = bound / length * (Mat3::Identity() - direction * direction.transpose());
        answer.history.reversible = range * direction;
        answer.stored = bound * range * Rise::work(1.0);
        answer.dissipated = bound * (length - range);
        answer.sliding = true;
        return answer;
    }

    double friction_coefficient() const noexcept { return parameters_.friction_coefficient; }
    double reversible_displacement() const noexcept { return parameters_.reversible_displacement; }

private:
    static constexpr double rounding = 1e-9;  ///< of a slip, over the reversible displacement: of places a thousand times as far
    Parameters parameters_;
};

}  // namespace fibrant::law

// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of what takes a motion over a step of time, and schemes that lose what no step resolves.

#include <fibrant/core/parameters.hpp>

#include <cmath>
#include <concepts>

namespace fibrant::inertia {

/// A step of duration dt from (q, v, a): M (q' - place)/c2 + share F(q') + (1 - share) F_n + contact(q') = 0, with
///   place = q + by_velocity v + by_acceleration a,   a' = (q' - place)/c2,   v' = v + old_acceleration a + new_acceleration a',
/// F the forces of the fibres less the loads, F_n those at the start. What it errs by is error_old a + error_new a', to its
/// leading order.
struct TimeStep {
    double by_velocity = 0.0;                 ///< [time]
    double by_acceleration = 0.0;             ///< [time^2]
    double c2 = 1.0;                          ///< [time^2]
    double share = 1.0;                       ///< [1]
    double old_acceleration = 0.0;            ///< [time]
    double new_acceleration = 0.0;            ///< [time]
    double error_old = 0.0, error_new = 0.0;  ///< [time^2]
};

/// The first step of a motion whose acceleration is not known yet: that of its end, all along. Of second order, as one step among
/// many.
inline TimeStep first_step(double dt) noexcept { return {dt, 0.0, 0.5 * dt * dt, 1.0, 0.0, dt, 0.0, 0.0}; }

/// A scheme of one step. Owed beyond the syntax: without forces a uniform motion goes on exactly; under a constant force the
/// acceleration that it has is kept.
template <class I>
concept TimeIntegrator = core::Policy<I> && requires(const I integrator, double duration) {
    { integrator.step(duration) } -> std::same_as<TimeStep>;
};

/// The scheme of Hilber, Hughes and Taylor (1977) by its spectral radius at high frequencies, rho: alpha = (1 - rho)/(1 + rho),
/// beta = (1 + alpha)^2/4, gamma = 1/2 + alpha; forces of fibres and loads count by 1 - alpha at the end of the step and by alpha
/// at its start. Of second order in free motion. Contact, friction and what materials remember are those of the end: then an
/// impact that a step does not resolve takes energy and gives none, at the price of first order in contact.
class GeneralisedAlpha {
public:
    struct Parameters {
        double spectral_radius = 0.5;  ///< rho [1], in [0.5, 1]; 1: nothing is damped, and sections ring for ever
        void validate() const { core::require_between("GeneralisedAlpha.spectral_radius", spectral_radius, 0.5, 1.0); }
    };
    explicit GeneralisedAlpha(const Parameters& parameters)
        : alpha_{(1.0 - core::validated(parameters).spectral_radius) / (1.0 + parameters.spectral_radius)} {}

    /// @param dt  [time], > 0
    TimeStep step(double dt) const noexcept {
        const double beta = 0.25 * (1.0 + alpha_) * (1.0 + alpha_), gamma = 0.5 + alpha_;
        const double error = (beta - 1.0 / 6.0) * dt * dt;  // Taylor: q + dt v + dt^2 a/2 + dt^3 a'/6
        return {dt, (0.5 - beta) * dt * dt, beta * dt * dt, 1.0 - alpha_, (1.0 - gamma) * dt, gamma * dt, -error, error};
    }

private:
    double alpha_;
};
static_assert(TimeIntegrator<GeneralisedAlpha>);

/// The midpoint rule in its energy form (Simo and Tarnow 1992): forces of the fibres count by half at either end of the step, and
/// the motion gains or loses exactly the work that they do. Nothing is damped: what is stiff and not damped by its own law rings.
/// With `law::Impact` contact takes from a motion what it stores. Where rods turn the work of what turns them is of second order
/// alone.
class Midpoint {
public:
    using Parameters = core::NoParameters;
    explicit Midpoint(const Parameters& = {}) {}
    /// @param dt  [time], > 0
    TimeStep step(double dt) const noexcept {
        const double error = dt * dt / 12.0;  // Taylor, the acceleration of a step being that of its middle
        return {dt, 0.0, 0.5 * dt * dt, 0.5, 0.0, dt, -error, error};
    }
};
static_assert(TimeIntegrator<Midpoint>);

/// Backward Euler: of first order, and loses energy in every step. For what is to come to rest.
class BackwardEuler {
public:
    using Parameters = core::NoParameters;
    explicit BackwardEuler(const Parameters& = {}) {}
    /// @param dt  [time], > 0
    TimeStep step(double dt) const noexcept { return {dt, 0.0, dt * dt, 1.0, 0.0, dt, 0.0, 0.5 * dt * dt}; }
};
static_assert(TimeIntegrator<BackwardEuler>);

}  // namespace fibrant::inertia

// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run does where fibres leap from one equilibrium to another: it follows them by springs that it takes away again.

#include <fibrant/beam/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fibrant::simulation {

/// An equilibrium may end, and the next one may be far (a rod that throws a loop, yarns that slip over each other without
/// friction). No increment is small enough to get there. Springs from every centre to its last place are: the amplitudes stand,
/// increments follow with ever softer springs, and the last one has none, so that what a run goes on from is in balance. What
/// springs took is `damped` in the balance of energies.
struct Calming {
    double springs = 0.0;  ///< now [force / length]
    double held = 0.0;     ///< springs of the last increment
    double failed = 0.0;   ///< springs that have failed since, or lately: they are not tried again at once
    bool resting = false;  ///< amplitudes stand until forces balance without springs
    Index steps = 0;       ///< attempts at these amplitudes
    Index in_row = 0;      ///< leaps one after the other, without an increment between them that took none

    static constexpr double soften = 0.25, harden = 4.0;
    /// Of an increment, from which on springs are tried: four cuts show that size is not what matters.
    static constexpr double first_fraction = 1.0 / 16.0;
    /// Of the springs over the softest: to a fibre that is held as hard as it is stiff in itself.
    static constexpr double range = 1e9;
    static constexpr double none = 0.01;        ///< over the softest: below, springs are left out
    static constexpr double on_its_way = 0.05;  ///< of a radius in an increment: a leap that has begun
    static constexpr double forget = 0.8;       ///< factor on what has failed, after an increment
    static constexpr Index most_steps = 200;    ///< at the same amplitudes

    /// Where each increment ends in another leap, however small, it is not leaps that stop it.
    static constexpr Index most_in_row = 8;

    /// Of nodal springs as stiff against a wave as long as the fibre as the fibre itself is: E I (2 pi / L)^4 a unit of length
    /// [force / length]. The greatest of all fibres.
    template <beam::BeamElement B>
    static double softest(const beam::Mesh<B>& mesh) {
        double spring = 0.0;
        for (const beam::MeshFibre& fibre : mesh.fibres()) {
            const double bending =
                fibre.material.young_modulus * std::min(fibre.section.second_moment_1(), fibre.section.second_moment_2());
            const double wave = bending * std::pow(2.0 * std::numbers::pi / fibre.length(), 4);
            spring = std::max(spring, wave * fibre.element_length / static_cast<double>(B::nodes - 1));
        }
        return spring;
    }

    /// Springs hold, or held a moment ago.
    bool active() const noexcept { return resting || springs > 0.0; }

    /// After an attempt that has failed: harder springs at the same amplitudes. @returns whether there is something to try
    bool harder(double fraction, double least) {
        if (!active() && (fraction > first_fraction || in_row >= most_in_row)) return false;
        if (springs >= range * least || ++steps > most_steps) return false;
        failed = std::max(springs, none * least);
        springs = held > failed ? held : std::max(harden * springs, resting ? failed : least);
        held = 0.0;
        return true;
    }

    /// After an increment that was accepted with springs. A saddle is left by a factor of 1 / (1 - |its stiffness| / springs) an
    /// increment: fastest with springs that are hardly harder than those that fail.
    /// @param unstable  its tangent was indefinite: it rests on a saddle unless it moves
    /// @param moved     over the radius [1]
    void soften_after(bool unstable, double moved, double least) {
        resting = springs > 0.0 || unstable;
        ++steps;
        held = springs;
        if (unstable && steps < most_steps) {
            if (moved < on_its_way) failed = springs, held = 0.0, springs = std::max(2.0 * springs, least);
            return;
        }
        const double softer = std::max(soften * springs, failed > 0.0 ? std::sqrt(failed * springs) : 0.0);
        failed *= forget;
        springs = softer >= none * least ? softer : 0.0;
        if (!resting) *this = {.in_row = in_row + 1};
    }
    /// After an increment that took no springs.
    void none_taken() noexcept { in_row = 0; }

    /// All that a run can come to.
    bool sound() const {
        const auto finite = [](double value) { return std::isfinite(value) && value >= 0.0; };
        return finite(springs) && finite(held) && finite(failed) && steps >= 0 && in_row >= 0;
    }
    template <class Self, class Body>
    static void each_of(Self& self, const Body& body) {
        body(self.springs), body(self.held), body(self.failed), body(self.resting), body(self.steps), body(self.in_row);
    }
};

}  // namespace fibrant::simulation

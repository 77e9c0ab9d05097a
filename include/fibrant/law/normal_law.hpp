// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of the laws that push fibres apart.

#include <fibrant/core/parameters.hpp>

#include <concepts>

namespace fibrant::law {

/// Reaction of one contact element and its slope.
struct NormalResponse {
    double reaction;  ///< R_N >= 0 [force]
    double slope;     ///< dR_N / dgap <= 0 [force / length]
};

/// One contact element as a law sees it that is no penalty.
struct Approach {
    double gap = 0.0;     ///< < 0 in penetration [length]
    double length = 0.0;  ///< of the line of contact that the element stands for; 0: a crossing, or an end [length]
    double reach = 0.0;   ///< sum of both radii; of a tool that of the fibre [length]
    double before = 0.0;  ///< gap in the last accepted state, for a SteppedNormal; along the same normal where contact acts
                          ///< within an increment [length]
};

namespace detail {
template <class L>
struct Asked {
    using Type = double;
};
template <class L>
    requires requires { typename L::Sees; }
struct Asked<L> {
    using Type = typename L::Sees;
};
}  // namespace detail

/// Normal reaction as a function of the gap.
/// Owed beyond the syntax, and checked by tests/law/normal_law_contract.hpp: the reaction is zero once open, never
/// negative, never falls with penetration, `slope` is its derivative, and -reaction that of `energy`.
template <class L>
concept NormalLaw = core::Policy<L> && requires(const L law, const typename detail::Asked<L>::Type& gap, double stiffness) {
    { law.response(gap, stiffness) } -> std::same_as<NormalResponse>;
    { law.energy(gap, stiffness) } -> std::same_as<double>;
};

/// A physical law, `using Sees = Approach`: asked by that instead of the gap, and by no stiffness, for its own is a property,
/// which no adaptation touches; what a fibre sinks is its answer and no fault. Owed beside what NormalLaw owes: two elements of
/// half the length answer as one.
template <class L>
concept SeeingNormal = NormalLaw<L> && requires {
    requires std::same_as<typename L::Sees, Approach>;
};

/// A law that depends on how the gap has changed: told before each increment how long it lasts and at which part of it contact
/// acts, 1 its end. Owed beside: nothing negative is dissipated, and an increment that takes no time is one of the law at rest.
template <class L>
concept SteppedNormal = SeeingNormal<L> && requires(L law, const L seen, const Approach& approach, double number) {
    law.last(number, number);
    law.rest(true);                                         // from now on as in an increment that takes no time; false: as it was
    { seen.acts() } -> std::same_as<double>;                // the part of an increment at which contact acts, as it was told
    { seen.dissipated(approach) } -> std::same_as<double>;  // of an increment, >= 0 [force length]
};

/// A law that also pulls: what pushes bounds friction. Its reaction may be negative, and nothing else that NormalLaw owes falls.
template <class L>
concept PullingNormal = SeeingNormal<L> && requires(const L law, const Approach& approach) {
    { law.push(approach) } -> std::same_as<double>;  // >= 0 [force]
};

/// A normal law that shifts the gap of each contact element by an amount chosen when an increment starts.
template <class L>
concept GapShifting = NormalLaw<L> && requires(const L law, double gap) {
    { law.gap_shift(gap) } -> std::same_as<double>;
};

/// One whose shift is what exceeds a limit, which a loading may change.
template <class L>
concept GapLimiting = GapShifting<L> && requires(const L law, double limit) {
    { law.with_limit(limit) } -> std::same_as<L>;
};

/// A normal law whose response turns from quadratic to linear at a depth that a stiffness adaptation should respect.
template <class L>
concept Regularised = NormalLaw<L> && requires(const L law) {
    { law.regularisation_depth() } -> std::same_as<double>;
};

/// A normal law that can tell the penetration of a reaction: response(-penetration(reaction, stiffness), stiffness) has it.
template <class L>
concept InvertibleLaw = NormalLaw<L> && requires(const L law, double reaction, double stiffness) {
    { law.penetration(reaction, stiffness) } -> std::same_as<double>;
};

/// A normal law whose contact elements carry a multiplier from one contact pass to the next, until what they carry is held
/// without a penetration.
template <class L>
concept Augmenting = InvertibleLaw<L> && requires(const L law) {
    { law.largest_penetration() } -> std::same_as<double>;
};

/// Depth lost to the quadratic start: R_N = k_N (penetration - depth / 2) beyond it; 0 for a law without one [length].
template <NormalLaw L>
double regularisation_depth(const L& law) noexcept {
    if constexpr (Regularised<L>) {
        return law.regularisation_depth();
    } else {
        return 0.0;
    }
}

}  // namespace fibrant::law

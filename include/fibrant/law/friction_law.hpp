// SPDX-License-Identifier: MIT
#pragma once
/// @file Contracts of the laws of tangential contact: of the slip alone, and of all that a contact element sees.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <array>
#include <concepts>
#include <cstddef>
#include <tuple>
#include <type_traits>

namespace fibrant::law {

/// Tangential response of one contact element, at a frozen normal reaction.
template <class History>
struct FrictionResponse {
    Vec3 force = Vec3::Zero();    ///< R_T [force], along the reversible displacement: it resists the slip
    Mat3 tangent = Mat3::Zero();  ///< dR_T / dslip, symmetric [force / length]
    History history{};            ///< to be kept when the increment is accepted
    double stored = 0.0;          ///< in the reversible displacement [force * length]
    double dissipated = 0.0;      ///< work lost to sliding in this increment, >= 0 [force * length]
    bool sliding = false;
};

/// Tangential reaction as a function of the slip since the last accepted state.
/// Owed beyond the syntax, and checked by tests: no force without a reaction, |R_T| <= mu R_N, `tangent` is the
/// derivative at a frozen reaction, nothing negative is dissipated, and what is not dissipated of the work is stored. The factor
/// of a pair or a tool multiplies the reaction, to which the force is proportional.
///
/// A history with something in it has a member `reversible`, a tangential 3-vector [length].
template <class L>
concept SlipFriction = core::Policy<L> && std::default_initializable<typename L::History> &&
    requires(const L law, const Vec3& slip, double reaction, const typename L::History& history) {
    { law.response(slip, reaction, history) } -> std::same_as<FrictionResponse<typename L::History>>;
};

/// One contact element as a law of friction sees it.
struct Touch {
    Vec3 slip = Vec3::Zero();          ///< tangential, of particle j against particle i since the last accepted state [length]
    Vec3 along_i = Vec3::Zero();       ///< unit, in the tangent plane; of a tool that of the fibre
    Vec3 along_j = Vec3::Zero();       ///< likewise
    Vec3 normal = Vec3::Zero();        ///< unit
    double reaction = 0.0;             ///< R_N that bounds friction, >= 0 [force]
    double length = 0.0;               ///< of the line of contact that the element stands for; 0: a crossing, or an end [length]
    Index group_i = -1, group_j = -1;  ///< innermost groups of the fibres; -1: none, or a tool
};

/// What a law answers that sees.
template <class History>
struct SeenFriction : FrictionResponse<History> {
    Vec3 by_reaction = Vec3::Zero();  ///< dR_T / dR_N, for a bound that follows [1]

    /// All of it times the factor of a pair or a tool.
    void scale(double factor) noexcept {
        this->force *= factor, this->tangent *= factor, by_reaction *= factor;
        this->stored *= factor, this->dissipated *= factor;
    }
};

/// Tangential reaction as a function of all that a contact element sees.
/// Owed beyond the syntax, and checked by tests: homogeneous in its coefficients, so that a factor on the answer is one on them;
/// two elements of half the length and half the reaction answer as one; a turn of all vectors turns the answer; `tangent` and
/// `by_reaction` are derivatives; nothing negative is dissipated, and stored + dissipated is a potential of the force at a held
/// reaction.
///
/// A history has the member `reversible`, and may have `numbers`, an array of double that contacts interpolate along the fibres.
template <class L>
concept SeeingFriction = core::Policy<L> && std::default_initializable<typename L::History> &&
    requires(const L law, const Touch& touch, const typename L::History& history) {
    { law.response(touch, history) } -> std::same_as<SeenFriction<typename L::History>>;
};

/// A law of friction has one of two contracts.
template <class L>
concept FrictionLaw = SlipFriction<L> || SeeingFriction<L>;

/// A law that depends on how fast particles slip: told the duration of each increment, > 0 [time].
template <class L>
concept FrictionWithRate = FrictionLaw<L> && requires(L law, double duration) {
    law.last(duration);
};

namespace detail {
template <class L>
struct FrictionAnswer {
    using Type = FrictionResponse<typename L::History>;
};
template <SeeingFriction L>
struct FrictionAnswer<L> {
    using Type = SeenFriction<typename L::History>;
};
}  // namespace detail
/// What a friction law answers with: a SeenFriction if it sees, a FrictionResponse else.
template <FrictionLaw L>
using FrictionAnswer = typename detail::FrictionAnswer<L>::Type;

/// How many numbers a history has beside the reversible displacement.
template <class H>
inline constexpr std::size_t history_numbers = 0;
template <class H>
    requires requires(H h) { h.numbers.size(); }
inline constexpr std::size_t history_numbers<H> = std::tuple_size_v<decltype(H::numbers)>;

/// What contacts keep of a history from one increment to the next: `reversible`, turned with the fibres, `numbers`, and nothing
/// else. A law that needs more would find it empty.
template <class L>
concept HistoryIsKept = std::is_empty_v<typename L::History> || requires(typename L::History history) {
    requires std::same_as<decltype(history.reversible), Vec3>;
    requires sizeof(history) == sizeof(Vec3) + history_numbers<typename L::History> * sizeof(double);
};

}  // namespace fibrant::law

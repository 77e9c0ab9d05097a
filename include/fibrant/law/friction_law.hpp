// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of the laws of tangential contact.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <concepts>
#include <type_traits>

namespace fibrant::law {

/// Tangential response of one contact element, at a frozen normal reaction.
template <class History>
struct FrictionResponse {
    Vec3 force = Vec3::Zero();      ///< R_T [force], along the reversible displacement: it resists the slip
    Mat3 tangent = Mat3::Zero();    ///< dR_T / dslip, symmetric [force / length]
    History history{};              ///< to be kept when the increment is accepted
    double stored = 0.0;            ///< in the reversible displacement [force * length]
    double dissipated = 0.0;        ///< work lost to sliding in this increment, >= 0 [force * length]
    bool sliding = false;
};

/// Tangential reaction as a function of the slip since the last accepted state.
/// Owed beyond the syntax, and checked by tests: no force without a reaction, |R_T| <= mu R_N, `tangent` is the
/// derivative at a frozen reaction, nothing negative is dissipated, and what is not dissipated of the work is stored.
///
/// A history with something in it has a member `reversible`, a tangential 3-vector [length].
template <class L>
concept FrictionLaw = core::Policy<L> && std::default_initializable<typename L::History> &&
    requires(const L law, const Vec3& slip, double reaction, const typename L::History& history) {
        { law.response(slip, reaction, history) } -> std::same_as<FrictionResponse<typename L::History>>;
    };

/// What contacts keep of a history from one increment to the next: `reversible`, turned with the fibres, and nothing else. A law that needs
/// more would find it empty.
template <class L>
concept HistoryIsKept = std::is_empty_v<typename L::History> || requires(typename L::History history) {
    requires std::same_as<decltype(history.reversible), Vec3> && sizeof(history) == sizeof(Vec3);
};

}  // namespace fibrant::law

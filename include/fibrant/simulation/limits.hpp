// SPDX-License-Identifier: MIT
#pragma once
/// @file What contact is limited by in an increment: gaps that are shown to a law, and penetrations that are allowed.

#include <fibrant/law/normal_law.hpp>
#include <fibrant/simulation/position.hpp>

#include <limits>

namespace fibrant::simulation {

/// Sets the gap limit of a law that has one, and the penetration that zones are adapted to, for the next attempt.
/// @param stated  penetration that the model allows [length]
template <Model M, class Contacts>
void set_limits(Contacts& contacts, const Stage<M>& stage, const Position& position, double stated) {
    if constexpr (law::GapLimiting<typename M::Normal>) {
        const double limit =
            position.limits_gap(stage) ? *stage.gap_limit * position.fraction : std::numeric_limits<double>::infinity();
        contacts.normal_law() = contacts.normal_law().with_limit(limit);
    }
    contacts.allow_penetration(position.stride() * stage.allowed_penetration.value_or(stated));
}

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file What an increment is refused for before and after it is solved: turns that are too large, fibres that change sides,
/// sections that collapse.

#include <fibrant/beam/section_sides.hpp>
#include <fibrant/contact/passage.hpp>

#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// Turn of a held section that one increment may prescribe [radian]. A straight rod whose end is turned at once follows to 0.2
/// turns if directors make its sections, which collapse at 0.25, and to 0.45 if they are rigid; from half a turn on it would go
/// the other way.
template <beam::BeamElement B>
inline constexpr double largest_turn = beam::TurningSections<B> ? 2.0 : 1.0;

/// Why an increment between these amplitudes is not even tried: it would turn a held section, or a body, by more than can be
/// followed. Empty if it does not.
template <beam::BeamElement B, class Equilibrium>
std::string turned_too_far(const beam::Mesh<B>& mesh, const Equilibrium& equilibrium, std::span<const double> from,
                           std::span<const double> to) {
    const auto words = [](const std::string& what, double turn) {
        const double whole = 2.0 * std::numbers::pi;
        return what + " is turned by " + core::text(turn / whole) + " turns at once, and follows at most " +
               core::text(largest_turn<B> / whole);
    };
    if (const auto [turn, vector] = equilibrium.motion().greatest_turn(from, to); turn > largest_turn<B>)
        return words(mesh.vector_label(vector), turn);
    if constexpr (requires { equilibrium.ties().motion().greatest_turn(from, to); })
        if (const auto [turn, body] = equilibrium.ties().motion().greatest_turn(from, to); turn > largest_turn<B>)
            return words("body " + std::to_string(body), turn);
    return {};
}

/// Why a state that has converged is not accepted; empty if it is.
/// @param touching  anything may touch anything
template <beam::BeamElement B, class Passage, class Contacts>
std::string refusal(const beam::Mesh<B>& mesh, const B& beam, [[maybe_unused]] const Passage& passage,
                    [[maybe_unused]] const Contacts& contacts, [[maybe_unused]] const Vector& from, const Vector& to,
                    [[maybe_unused]] bool forced, [[maybe_unused]] bool touching) {
    if (const auto found = beam::first_inside_out(mesh, beam, to)) return beam::text(*found);
    if constexpr (core::Active<Passage>)
        if (touching)
            if (const auto passed = passage.first(from, to, contacts, forced, true)) return contact::text(*passed);
    return {};
}

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file The true gap as part of what a run ends with: pairs of fibres that are too deep unseen are mended, or named.

#include <fibrant/contact/deepest_overlap.hpp>
#include <fibrant/contact/watched_places.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/loading.hpp>
#include <fibrant/simulation/position.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// How deep fibres may be anywhere at the end of a stage [length]; NaN where nobody asks.
/// @param radius  of the thinnest fibre [length]
template <Model M, class Contacts>
double deepest_at_end(const Loading<M>& loading, const Stage<M>& stage, bool last, const Contacts& contacts,
                      const contact::ContactParameters& parameters, double radius) {
    const bool stated = parameters.stiffness.adapts();  // a penalty that is one number is as deep as it is
    if (!stage.deepest && !(last && loading.audited && stated)) return core::unset;
    if (!std::isnan(loading.deepest_over_radius)) return loading.deepest_over_radius * radius;
    return stage.deepest ? *stage.deepest : stated_depth(contacts, parameters, radius);
}

/// Looks for places that are deeper than allowed at the end of the present stage, and mends them. @returns what is deepest, in
/// words; empty if nothing is, or nobody asks.
/// @param radius    of the thinnest fibre [length]
/// @param position  counts mends that had no success
template <Model M, class Simulator, class Contacts>
std::string mend_deep_places(const Loading<M>& loading, const std::vector<Stage<M>>& stages, const Simulator& simulator,
                             Contacts& contacts, double radius, Position& position) {
    const Stage<M>& stage = stages[core::at(position.stage)];
    const double allowed =
        deepest_at_end(loading, stage, &stage == &stages.back(), contacts, simulator.parameters().contact, radius);
    if (!(allowed > 0.0)) return {};
    const auto& mesh = simulator.mesh();
    const observe::Snapshot shot = detail::curves_of(mesh, simulator.state());
    for (const observe::FibreSnapshot& fibre : shot.fibres)
        if (fibre.director_1.front().isZero(0.0)) return {};  // a beam whose particles lie on its centreline has no surface
    const auto own = contacts.parameters().detection.self_contact ? observe::OwnTurns::counted : observe::OwnTurns::left_out;
    const std::vector<observe::LeastGap> deep = observe::deep_places(shot, proximity::GridSearch{}, allowed, own);
    if (deep.empty()) return {};
    std::vector<contact::DeepPlace> places;
    for (const observe::LeastGap& place : deep) {
        const auto abscissa = [&](Index fibre, double t) {
            return t * static_cast<double>(mesh.fibre(fibre).elements) /
                   static_cast<double>(shot.fibres[core::at(fibre)].position.size() - 1);
        };
        places.push_back(
            {place.fibre_i, place.fibre_j, abscissa(place.fibre_i, place.t), abscissa(place.fibre_j, place.u), -place.gap});
    }
    contact::mend(mesh, contacts, places, allowed);
    const double better = 0.97;  // of what was deepest: a success
    if (-deep.front().gap < better * position.mended) position.mended = -deep.front().gap, position.mends = 0;
    ++position.mends;
    const observe::LeastGap& worst = deep.front();
    return ": fibres " + std::to_string(worst.fibre_i) + " and " + std::to_string(worst.fibre_j) + " stay " +
           core::text(-worst.gap / radius) + " radii deep in each other at (" + core::text(worst.position.x()) + ", " +
           core::text(worst.position.y()) + ", " + core::text(worst.position.z()) + "), allowed are " +
           core::text(allowed / radius) + ": more elements a fibre, or a greater allowed penetration";
}

/// The two fibres that are deepest in each other as contact sees them, in words; empty of a stage that parts nothing.
template <Model M, class Simulator>
std::string deepest_unparted(const Stage<M>& stage, const Simulator& simulator) {
    if (!stage.gap_limit || stage.gap_limit_when_cut) return {};
    const auto& mesh = simulator.mesh();
    return ": " + contact::text(contact::deepest_overlap(simulator.contacts(), mesh, simulator.state(), false), mesh);
}

}  // namespace fibrant::simulation

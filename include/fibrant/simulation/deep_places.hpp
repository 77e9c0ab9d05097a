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

/// What an audit finds deepest in a state, and all places that are deeper than allowed.
struct DeepPlaces {
    observe::LeastGap least;                 ///< its gap is infinite where no two fibres are within reach of each other
    std::vector<contact::DeepPlace> places;  ///< deeper than allowed, the deepest first

    /// "fibres 3 and 5 stay 0.02 radii deep in each other at (1, 2, 3), allowed are 0.01", `stay` as given.
    std::string text(const char* stay, double allowed, double radius) const {
        return "fibres " + std::to_string(least.fibre_i) + " and " + std::to_string(least.fibre_j) + stay +
               core::text(-least.gap / radius) + " radii deep in each other at (" + core::text(least.position.x()) + ", " +
               core::text(least.position.y()) + ", " + core::text(least.position.z()) + "), allowed are " +
               core::text(allowed / radius);
    }
};

/// Looks for places that are deeper than allowed by the true gap, whatever contact elements say. Beams whose particles lie on
/// their centreline have no surface, and no such place.
/// @param allowed  [length], >= 0
/// @param apart    as of `observe::deep_places`
template <beam::BeamElement B, class Contacts>
DeepPlaces too_deep(const beam::Mesh<B>& mesh, Contacts& contacts, const Vector& state, double allowed, double apart = 1.0) {
    DeepPlaces deep;
    const observe::Snapshot shot = detail::curves_of(mesh, state);
    for (const observe::FibreSnapshot& fibre : shot.fibres)
        if (fibre.director_1.front().isZero(0.0)) return deep;
    const auto own = contacts.parameters().detection.self_contact ? observe::OwnTurns::counted : observe::OwnTurns::left_out;
    deep.least = observe::least_gap(shot, proximity::GridSearch{}, own, 0.0);
    if (!(deep.least.gap < -allowed)) return deep;
    for (const observe::LeastGap& place : observe::deep_places(shot, proximity::GridSearch{}, allowed, own, apart)) {
        const auto abscissa = [&](Index fibre, double t) {
            return t * static_cast<double>(mesh.fibre(fibre).elements) /
                   static_cast<double>(shot.fibres[core::at(fibre)].position.size() - 1);
        };
        deep.places.push_back(
            {place.fibre_i, place.fibre_j, abscissa(place.fibre_i, place.t), abscissa(place.fibre_j, place.u), -place.gap});
    }
    return deep;
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
    const DeepPlaces deep = too_deep(mesh, contacts, simulator.state(), allowed);
    if (deep.places.empty()) return {};
    contact::mend(mesh, contacts, deep.places, allowed);
    const double better = 0.97;  // of what was deepest: a success
    if (deep.least.gap > -better * position.mended) position.mended = -deep.least.gap, position.mends = 0;
    ++position.mends;
    return ": " + deep.text(" stay ", allowed, radius) + ": more elements a fibre, or a greater allowed penetration";
}

/// The two fibres that are deepest in each other as contact sees them, in words; empty of a stage that parts nothing.
template <Model M, class Simulator>
std::string deepest_unparted(const Stage<M>& stage, const Simulator& simulator) {
    if (!stage.gap_limit || stage.gap_limit_when_cut) return {};
    const auto& mesh = simulator.mesh();
    return ": " + contact::text(contact::deepest_overlap(simulator.contacts(), mesh, simulator.state(), false), mesh);
}

}  // namespace fibrant::simulation

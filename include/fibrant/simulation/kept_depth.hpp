// SPDX-License-Identifier: MIT
#pragma once
/// @file The true gap as part of what an increment is accepted by: fibres that are too deep between contact points are mended
/// within it.

#include <fibrant/law/normal_law.hpp>
#include <fibrant/simulation/deep_places.hpp>
#include <fibrant/solver/nested_loops.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace fibrant::simulation {

/// How deep fibres may be anywhere in an increment that is accepted [length]; NaN where it is not asked: of what is loose by its
/// own word, of fibres that are on their way, and where a penalty or a law says itself how deep they are.
/// @param radius  of the thinnest fibre [length]
template <Model M, class Contacts>
double deepest_in_increment(const Loading<M>& loading, const Stage<M>& stage, const Position& position, Contacts& contacts,
                            double radius) {
    const contact::ContactParameters& parameters = contacts.parameters();
    const bool asked = loading.audited && loading.every_increment && parameters.stiffness.adapts();
    if (law::SeeingNormal<typename M::Normal> || !asked || stage.forced_orders || position.limits_gap(stage) ||
        position.looseness(stage) > 1.0)
        return core::unset;
    const double given =
        std::isnan(loading.deepest_over_radius) ? stage.deepest.value_or(0.0) : loading.deepest_over_radius * radius;
    return std::max(given, stated_depth(contacts, parameters, radius));
}

/// Solves an increment, and again from where it ended as long as two fibres are deeper in each other somewhere than `allowed`:
/// these get contact points there, and become stiffer. What stays too deep is refused.
/// @param trial    state that `solve()` goes on from and leaves
/// @param allowed  [length]; NaN: whatever the first solve gives
template <beam::BeamElement B, class Contacts, class Solve>
solver::AttemptReport solve_kept(const beam::Mesh<B>& mesh, Contacts& contacts, const Vector& trial, double allowed,
                                 double radius, core::StageClock& clock, const Solve& solve) {
    constexpr Index most_mends = 6;  // of an increment; one or two are what it takes, or it is too long
    constexpr double better = 0.9;   // of what was deepest: else mends come to nothing
    constexpr double apart = 0.1;    // node intervals: what is symmetric stays so
    solver::AttemptReport attempt = solve();
    double last = std::numeric_limits<double>::infinity();
    for (Index mends = 0; attempt.converged && !std::isnan(allowed); ++mends) {
        const DeepPlaces deep = clock.time(core::Part::search, [&] { return too_deep(mesh, contacts, trial, allowed, apart); });
        attempt.use.between = std::max(0.0, -deep.least.gap) / allowed;
        if (deep.places.empty()) break;
        if (mends >= most_mends || -deep.least.gap > better * last) {
            attempt.refuse(deep.text(" are ", allowed, radius));
            break;
        }
        last = -deep.least.gap;
        contact::mend(mesh, contacts, deep.places, allowed);
        const solver::IterationCounts before = attempt.counts;
        attempt = solve();
        attempt.counts += before;
    }
    return attempt;
}

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file Places contact elements whose stations stand: normal, particles, gap shift and what slips count from.

#include <fibrant/contact/acting_state.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/element_normal.hpp>
#include <fibrant/contact/meeting_point.hpp>
#include <fibrant/contact/seen_touch.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

namespace fibrant::contact {

/// What elements are placed by. It looks at them, and is made where it is needed.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
struct ElementPlacing {
    using Element = ContactElement<B, Normal, Friction>;

    const beam::Mesh<B>& mesh;
    const NormalRule& rule;
    const Normal& law;

    /// Normal, particles, gap shift and accepted offset of an element.
    /// @param zone        of the element
    /// @param state       in which contact acts
    /// @param end         of the increment: `state` itself, or another one of a law that acts within it
    /// @param remembered  last normal, or zero for a contact that is new
    /// @returns its tangents in `state`
    PairTangents place(Element& element, const Zone& zone, const Vector& state, const Vector& end, const Vector& accepted,
                       const Vec3& remembered) const {
        const PairTangents tangents = pair_tangents(mesh, state, element);
        element.normal = element_normal(mesh, state, element, tangents, rule, remembered);
        meet(element, zone, state, tangents, end, accepted);
        if constexpr (law::GapShifting<Normal>) element.shift.shift = law.gap_shift(element.gap(accepted));
        if constexpr (law::Augmenting<Normal>) element.shift.shift = -law.penetration(element.shift.multiplier, zone.stiffness);
        if constexpr (core::Active<Friction>) {
            Vec3& reversible = element.friction.history.reversible;
            if (!remembered.isZero()) reversible = turned_with_plane(reversible, remembered, element.normal);
        }
        return tangents;
    }
    /// Where both forces of an element act, and from where its slip counts.
    /// @param followed  normal in the accepted state of a crossing that is followed, or null: by the rule
    void meet(Element& element, const Zone& zone, const Vector& state, const PairTangents& tangents, const Vector& end,
              const Vector& accepted, const Vec3* followed = nullptr) const {
        find_meeting_point(mesh, state, tangents, element), see_directions(tangents, element);
        count_from(mesh, rule, law, element, end, &end == &state ? tangents : pair_tangents(mesh, end, element), accepted,
                   zone.unseen, followed);
    }
    /// An element as it stood in another state.
    void place_back(Element& element, const Vector& state) const {
        const PairTangents tangents = pair_tangents(mesh, state, element);
        element.normal = element_normal(mesh, state, element, tangents, rule, element.normal);
        find_meeting_point(mesh, state, tangents, element);
    }
};

}  // namespace fibrant::contact

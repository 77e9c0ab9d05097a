// SPDX-License-Identifier: MIT
#pragma once
/// @file Directions of a contact element in a state: its normal, and those that its friction is told in.

#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/element_normal.hpp>
#include <fibrant/contact/normal_direction.hpp>

namespace fibrant::contact {

/// A direction half-way between the tangents of both fibres in the plane of a normal. It turns by the mean of their turns, so
/// that slips do not depend on which fibre comes first; either sign will do as long as it is kept. One between tangents that lean
/// out of the plane by different angles would turn to the other side with the other sign, and a scene would lose the symmetry of
/// its mirror image.
inline Vec3 heading(const PairTangents& tangents, const Vec3& normal, double sign) {
    const auto flat = [&](const Vec3& tangent) { return unit_or(tangent - tangent.dot(normal) * normal, Vec3::Zero()); };
    return flat(tangents.i) + sign * flat(tangents.j);
}
inline double sign_of_j(const PairTangents& tangents) noexcept { return tangents.i.dot(tangents.j) < 0.0 ? -1.0 : 1.0; }

/// Offset of the friction's particles in the last accepted state, turned as the normal and the tangent have
/// since: else a rigid rotation of a pair would slide it by the gap times the angle.
/// @param tangents  of the present
/// @param earlier   of the accepted state
/// @param before    the normal there, by the rule of the present one: what the two rules differ by would be a slip
template <class Element>
Vec3 accepted_offset(const Element& element, const PairTangents& tangents, const Vector& accepted, const PairTangents& earlier,
                     const Vec3& before) {
    const Vec3 offset = element.friction_offset(accepted);
    if (element.end_i || element.end_j) return turned(offset, before, element.normal);
    const double sign = sign_of_j(tangents);
    const TangentPlane then(heading(earlier, before, sign), before), now(heading(tangents, element.normal, sign), element.normal);
    return offset.dot(then.along) * now.along + offset.dot(then.across) * now.across + offset.dot(before) * element.normal;
}

/// A history of friction by components between the tangents of its element, and back.
template <law::FrictionLaw Friction>
RecordedFriction<Friction> recorded_friction(const PairTangents& tangents, const Vec3& normal,
                                             const typename Friction::History& history) {
    const double sign = sign_of_j(tangents);
    return RecordedFriction<Friction>::of(history, TangentPlane(heading(tangents, normal, sign), normal), sign);
}
template <law::FrictionLaw Friction, class Element>
void give_friction(const PairTangents& tangents, Element& element, const RecordedFriction<Friction>& recorded) {
    recorded.give(TangentPlane(heading(tangents, element.normal, recorded.sign), element.normal), element.friction.history);
}

/// What is remembered of contact elements that have been evaluated in a state.
template <law::NormalLaw Normal, law::FrictionLaw Friction, class B, class Elements, class Responses, class Frictions>
auto records_of(const beam::Mesh<B>& mesh, const Vector& state, const Elements& elements, const Responses& responses,
                const Frictions& frictions) {
    std::vector<typename ContactMemory<Normal, Friction>::Record> list(elements.size());
    core::parallel_for(
        core::count(elements),
        [&](Index k) {
            const auto& element = elements[core::at(k)];
            auto& record = list[core::at(k)];
            record.fibre_i = element.fibre_i, record.fibre_j = element.fibre_j;
            record.u_i = element.u_i, record.u_j = element.u_j;
            record.normal = element.normal;
            if constexpr (law::Augmenting<Normal>)
                if (k < core::count(responses)) record.multiplier.force = responses[core::at(k)].reaction;
            if constexpr (core::Active<Friction>) {
                if (k < core::count(frictions) && responses[core::at(k)].reaction != 0.0)
                    record.friction = recorded_friction<Friction>(pair_tangents(mesh, state, element), element.normal,
                                                                  frictions[core::at(k)].history);
            }
        },
        core::light_items);
    return list;
}

}  // namespace fibrant::contact

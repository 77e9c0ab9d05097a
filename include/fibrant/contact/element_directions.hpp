// SPDX-License-Identifier: MIT
#pragma once
/// @file Directions of a contact element in a state: its normal, and those that its friction is told in.

#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/element_normal.hpp>
#include <fibrant/contact/normal_direction.hpp>

namespace fibrant::contact {

/// Unit tangent of fibre i.
template <class B, class Element>
Vec3 tangent_of_i(const beam::Mesh<B>& mesh, const Element& element, const Vector& state) {
    return contact_tangent(mesh, state, element.fibre_i, element.u_i).normalized();
}

/// A direction half-way between the tangents of both fibres in the plane of a normal. It turns by the mean of their turns, so
/// that slips do not depend on which fibre comes first; either sign will do as long as it is kept. One between tangents that lean
/// out of the plane by different angles would turn to the other side with the other sign, and a scene would lose the symmetry of
/// its mirror image.
template <class B, class Element>
Vec3 heading(const beam::Mesh<B>& mesh, const Element& element, const Vector& state, const Vec3& normal, double sign) {
    const auto flat = [&](const Vec3& tangent) { return unit_or(tangent - tangent.dot(normal) * normal, Vec3::Zero()); };
    return flat(tangent_of_i(mesh, element, state)) +
           sign * flat(contact_tangent(mesh, state, element.fibre_j, element.u_j).normalized());
}
template <class B, class Element>
double sign_of_j(const beam::Mesh<B>& mesh, const Element& element, const Vector& state) {
    const Vec3 other = contact_tangent(mesh, state, element.fibre_j, element.u_j);
    return tangent_of_i(mesh, element, state).dot(other) < 0.0 ? -1.0 : 1.0;
}

/// Offset of the friction's particles in the last accepted state, turned as the normal and the tangent have
/// since: else a rigid rotation of a pair would slide it by the gap times the angle.
template <class B, class Element>
Vec3 accepted_offset(const beam::Mesh<B>& mesh, const NormalRule& rule, const Element& element, const Vector& state,
                     const Vector& accepted) {
    const Vec3 offset = element.friction_offset(accepted);
    const Vec3 before = element_normal(mesh, accepted, element, rule, element.normal);
    if (element.end_i || element.end_j) return turned(offset, before, element.normal);
    const double sign = sign_of_j(mesh, element, state);
    const TangentPlane then(heading(mesh, element, accepted, before, sign), before),
        now(heading(mesh, element, state, element.normal, sign), element.normal);
    return offset.dot(then.along) * now.along + offset.dot(then.across) * now.across + offset.dot(before) * element.normal;
}

/// How far the particles of an element were apart in another state along the normal of then, without its cap [length].
template <beam::BeamElement B, class Element>
double apart_in(const beam::Mesh<B>& mesh, const NormalRule& rule, const Element& element, const Vector& other) {
    return element.offset(other).dot(element_normal(mesh, other, element, rule, element.normal));
}

/// A history of friction by components between the tangents of its element, and back.
template <law::FrictionLaw Friction, class B, class Element>
RecordedFriction<Friction> recorded_friction(const beam::Mesh<B>& mesh, const Element& element, const Vector& state,
                                             const typename Friction::History& history) {
    const double sign = sign_of_j(mesh, element, state);
    return RecordedFriction<Friction>::of(
        history, TangentPlane(heading(mesh, element, state, element.normal, sign), element.normal), sign);
}
template <law::FrictionLaw Friction, class B, class Element>
void give_friction(const beam::Mesh<B>& mesh, Element& element, const Vector& state, const RecordedFriction<Friction>& recorded) {
    recorded.give(TangentPlane(heading(mesh, element, state, element.normal, recorded.sign), element.normal),
                  element.friction.history);
}

}  // namespace fibrant::contact

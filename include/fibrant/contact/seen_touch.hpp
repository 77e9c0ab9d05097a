// SPDX-License-Identifier: MIT
#pragma once
/// @file What a contact element shows a law of friction that sees, and what it asks of one that does not.

#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/element_directions.hpp>
#include <fibrant/contact/tool_element.hpp>

namespace fibrant::contact {

/// Sets the length that an element stands for, if its law asks for it.
template <class Element>
void see_length([[maybe_unused]] Element& element, [[maybe_unused]] double length) noexcept {
    if constexpr (requires { element.friction.seen.length; }) element.friction.seen.length = length;
}
/// Sets the directions of the fibres in the tangent plane, if its law asks for them.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void see_directions([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Vector& state,
                    [[maybe_unused]] ContactElement<B, Normal, Friction>& element) {
    if constexpr (law::SeeingFriction<Friction>) {
        element.friction.seen.along_i = TangentPlane(contact_tangent(mesh, state, element.fibre_i, element.u_i).normalized(), element.normal).along;
        element.friction.seen.along_j = TangentPlane(contact_tangent(mesh, state, element.fibre_j, element.u_j).normalized(), element.normal).along;
    }
}
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void see_directions([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Vector& state,
                    [[maybe_unused]] ToolElement<B, Normal, Friction>& element) {
    if constexpr (law::SeeingFriction<Friction>)
        element.friction.seen.along_i = element.friction.seen.along_j =
            TangentPlane(contact_tangent(mesh, state, element.fibre, element.u).normalized(), element.normal).along;
}

/// Friction of an element. The factor of a pair or a tool is one on the coefficients of the law.
/// @param slip   in the tangent plane [length]
/// @param bound  R_N that bounds friction, >= 0 [force]
template <law::FrictionLaw Friction, beam::BeamElement B, class Element>
law::FrictionAnswer<Friction> friction_answer(const Friction& friction, [[maybe_unused]] const beam::Mesh<B>& mesh, const Element& element, const Vec3& slip,
                                              double factor, double bound) {
    if constexpr (law::SeeingFriction<Friction>) {
        law::Touch touch{slip, element.friction.seen.along_i, element.friction.seen.along_j, element.normal, bound, element.friction.seen.length};
        if constexpr (requires { element.fibre_i; }) {
            touch.group_i = mesh.fibre(element.fibre_i).group, touch.group_j = mesh.fibre(element.fibre_j).group;
        } else {
            touch.group_j = mesh.fibre(element.fibre).group;
        }
        law::FrictionAnswer<Friction> answer = friction.response(touch, element.friction.history);
        if (factor != 1.0) answer.scale(factor);
        return answer;
    } else {
        return friction.response(slip, factor * bound, element.friction.history);
    }
}

/// Slope of an element's friction force by its gap, where the bound follows [force / length].
template <law::FrictionLaw Friction>
Vec3 friction_slope(const ContactResponse& response, const law::FrictionAnswer<Friction>& friction) noexcept {
    if constexpr (law::SeeingFriction<Friction>) return response.slope * friction.by_reaction;
    else return response.slope / response.reaction * friction.force;
}

}  // namespace fibrant::contact

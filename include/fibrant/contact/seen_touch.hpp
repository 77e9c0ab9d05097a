// SPDX-License-Identifier: MIT
#pragma once
/// @file What a contact element shows a law of friction that sees, and what it asks of one that does not.

#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/element_directions.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/tool_element.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace fibrant::contact {

/// Sets the length that an element stands for, if its laws ask for it.
template <class Element>
void see_length([[maybe_unused]] Element& element, [[maybe_unused]] double length) noexcept {
    if constexpr (requires { element.shift.length; }) element.shift.length = length;
    if constexpr (requires { element.friction.seen.length; }) element.friction.seen.length = length;
}
template <class Element>
void see_length(Element& element, const StationPair& pair) noexcept {
    see_length(element, pair.crossing ? 0.0 : pair.length);
}
/// Sets the lengths that friction sees at stations of fibres on tools of which not all press: those that do carry what lies
/// between them, if that is no longer than an element or a step. A fibre of straight elements that is drawn over a pin presses
/// with one station of each: with their own steps alone their friction would be that of a shorter, harder pressed line.
/// @param elements  sorted by fibre, tool and u; what bounds their friction is what they press with
/// @param step      of stations [elements]
template <class B, class Element>
void see_pressed_lengths([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] std::vector<Element>& elements,
                         [[maybe_unused]] double step) {
    if constexpr (requires(Element & element) { element.friction.seen.length; }) {
        Element* before = nullptr;
        for (Element& element : elements) {
            if (!(element.friction.bound > 0.0)) continue;
            const beam::MeshFibre& fibre = mesh.fibre(element.fibre);
            const double unit = 0.5 * fibre.element_length, end = static_cast<double>(fibre.elements);
            const auto own = [&](double room) { return unit * (fibre.closed ? step : std::min(step, room)); };
            const bool next = before != nullptr && before->fibre == element.fibre && before->tool == element.tool &&
                              element.u - before->u <= std::max(1.0, step) * (1.0 + 1e-9);
            double& length = element.friction.seen.length;
            if (next) before->friction.seen.length += unit * (element.u - before->u) - own(end - before->u);
            length = (next ? unit * (element.u - before->u) : own(element.u)) + own(end - element.u);
            before = &element;
        }
    }
}
/// Sets the lengths that the elements of a zone stand for, if their laws ask for them: half of the way to either neighbour along
/// the mean of both fibres at rest, so that they add up to the line from the first to the last; 0 of crossings and of caps.
/// @param elements  sorted by u_i
template <class B, class Element>
void see_lengths([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] std::span<Element> elements) {
    if constexpr (
        requires(Element & element) { element.shift.length; } || requires(Element & element) { element.friction.seen.length; }) {
        Element* before = nullptr;
        const auto is_line = [](const Element& element) { return !element.crossing && !element.end_i && !element.end_j; };
        const auto lines = std::count_if(elements.begin(), elements.end(), is_line);
        double half = 0.0;
        for (Element& element : elements) {
            if (!is_line(element)) {
                see_length(element, 0.0);
                continue;
            }
            if (lines == 1) return;  // it stands for a step
            const double last = half;
            half = 0.0;
            if (before != nullptr) {
                half =
                    0.25 * (mesh.fibre(element.fibre_i).element_length * mesh.apart(element.fibre_i, element.u_i, before->u_i) +
                            mesh.fibre(element.fibre_j).element_length * mesh.apart(element.fibre_j, element.u_j, before->u_j));
                see_length(*before, last + half);
            }
            before = &element;
        }
        if (before != nullptr) see_length(*before, half);
    }
}
/// Sets the directions of the fibres in the tangent plane, if its law asks for them.
/// @param tangents  of the element
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void see_directions([[maybe_unused]] const PairTangents& tangents,
                    [[maybe_unused]] ContactElement<B, Normal, Friction>& element) {
    if constexpr (law::SeeingFriction<Friction>) {
        element.friction.seen.along_i = TangentPlane(tangents.i, element.normal).along;
        element.friction.seen.along_j = TangentPlane(tangents.j, element.normal).along;
    }
}
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void see_directions([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Vector& state,
                    [[maybe_unused]] ToolElement<B, Normal, Friction>& element) {
    if constexpr (law::SeeingFriction<Friction>)
        element.friction.seen.along_i = element.friction.seen.along_j =
            TangentPlane(contact_tangent(mesh, state, element.fibre, element.u).normalized(), element.normal).along;
}

/// What a normal law is shown that sees.
template <beam::BeamElement B, class Element>
law::Approach approach(const beam::Mesh<B>& mesh, const Element& element, double gap) noexcept {
    law::Approach seen{gap, element.shift.length};
    if constexpr (requires { element.fibre_i; })
        seen.reach = mesh.fibre(element.fibre_i).section.radius() + mesh.fibre(element.fibre_j).section.radius();
    else
        seen.reach = mesh.fibre(element.fibre).section.radius();
    if constexpr (requires { element.shift.before; }) seen.before = element.shift.before - element.cap;
    return seen;
}
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
law::NormalResponse normal_answer(const Normal& normal, [[maybe_unused]] const beam::Mesh<B>& mesh,
                                  [[maybe_unused]] const Element& element, double gap, [[maybe_unused]] double stiffness) {
    if constexpr (law::SeeingNormal<Normal>)
        return normal.response(approach(mesh, element, gap), 0.0);
    else
        return normal.response(gap, stiffness);
}
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
double normal_energy(const Normal& normal, [[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Element& element,
                     double gap, [[maybe_unused]] double stiffness) {
    if constexpr (law::SeeingNormal<Normal>)
        return normal.energy(approach(mesh, element, gap), 0.0);
    else
        return normal.energy(gap, stiffness);
}

/// What a normal law has dissipated in the increment [force * length].
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
double normal_loss([[maybe_unused]] const Normal& normal, [[maybe_unused]] const beam::Mesh<B>& mesh,
                   [[maybe_unused]] const Element& element, [[maybe_unused]] double gap) {
    if constexpr (law::SteppedNormal<Normal>)
        return normal.dissipated(approach(mesh, element, gap));
    else
        return 0.0;
}
/// What bounds friction of an element [force].
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
double friction_bound([[maybe_unused]] const Normal& normal, [[maybe_unused]] const beam::Mesh<B>& mesh,
                      [[maybe_unused]] const Element& element, const ContactResponse& response) {
    if constexpr (law::PullingNormal<Normal>)
        return normal.push(approach(mesh, element, response.gap));
    else
        return response.reaction;
}

/// The same where none is held from passes before.
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
double standing_bound(const Normal& normal, const beam::Mesh<B>& mesh, const Element& element, const ContactResponse& response) {
    const double held = element.friction.bound;
    return held < 0.0 ? friction_bound(normal, mesh, element, response) : held;
}

/// Friction of an element. The factor of a pair or a tool is one on the coefficients of the law.
/// @param slip   in the tangent plane [length]
/// @param bound  R_N that bounds friction, >= 0 [force]
template <law::FrictionLaw Friction, beam::BeamElement B, class Element>
law::FrictionAnswer<Friction> friction_answer(const Friction& friction, [[maybe_unused]] const beam::Mesh<B>& mesh,
                                              const Element& element, const Vec3& slip, double factor, double bound) {
    if constexpr (law::SeeingFriction<Friction>) {
        law::Touch touch{slip,  element.friction.seen.along_i, element.friction.seen.along_j, element.normal,
                         bound, element.friction.seen.length};
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
    if constexpr (law::SeeingFriction<Friction>)
        return response.slope * friction.by_reaction;
    else
        return response.slope / response.reaction * friction.force;
}

}  // namespace fibrant::contact

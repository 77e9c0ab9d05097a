// SPDX-License-Identifier: MIT
#pragma once
/// @file Where the forces of a pair act, so that they are without a moment.

#include <fibrant/contact/bore.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/support.hpp>

#include <algorithm>
#include <utility>

namespace fibrant::contact {

/// Material components of a shift of the particle of a section: along the fibre and in the section, which deform with it.
/// @param weights  of the particle
/// @param shift    in this state [length]
template <class B>
    requires(!beam::CentreTouched<B>)
Vec3 material_shift(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, Index first,
                    const beam::Particle<B>& weights, const Vec3& shift) {
    if constexpr (beam::TurningSections<B>) {
        return weights.turn(state.segment<beam::Mesh<B>::element_unknowns>(first)).inverse() * shift;
    } else {
        const double xi = mesh.locate(fibre, u).second;
        const auto [g_1, g_2] = beam::Mesh<B>::element_directors(state, first, xi);
        const Vec3 along = beam::Mesh<B>::centre(state, first, B::centreline_derivative_weights(xi));
        const Mat3 inverse = core::columns(along, g_1, g_2).inverse();
        return inverse * shift;
    }
}

/// Weights of the particle that far from one, as a section carries it along.
template <class B>
    requires(!beam::CentreTouched<B>)
void shift_particle(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, Index first, const Vec3& shift,
                    beam::Particle<B>& weights) {
    if constexpr (beam::TurningSections<B>) {
        weights.shift(shift);
        weights.follow(state.segment<beam::Mesh<B>::element_unknowns>(first));
    } else {
        const double xi = mesh.locate(fibre, u).second;
        const beam::ElementWeights<B> section = B::particle_weights(xi, shift[1], shift[2]), centre = B::centreline_weights(xi),
                                      along = B::centreline_derivative_weights(xi);
        for (std::size_t a = 0; a < weights.size(); ++a) weights[a] += shift[0] * along[a] + (section[a] - centre[a]);
    }
}

/// Particles that lie furthest along the normal in this state.
template <class B, class Element>
void follow_support(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
    element.cap = support_weights(mesh, state, element.fibre_i, element.u_i, element.first_i, element.normal, element.end_i,
                                  element.weights_i) +
                  support_weights(mesh, state, element.fibre_j, element.u_j, element.first_j, Vec3(-element.normal),
                                  element.end_j, element.weights_j);
}

/// From there to the meeting point.
template <class B, class Element>
    requires(!beam::CentreTouched<B>)
void shift_to_meeting_point(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
    shift_particle(mesh, state, element.fibre_i, element.u_i, element.first_i, element.meeting.from_i, element.weights_i);
    shift_particle(mesh, state, element.fibre_j, element.u_j, element.first_j, element.meeting.from_j, element.weights_j);
    element.cap += element.meeting.depth;
}

/// Particles of the meeting point that was found last.
template <class B, class Element>
void follow_particles(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
    if (element.in_bore()) return follow_in_bore(mesh, state, element);
    follow_support(mesh, state, element);
    if constexpr (!beam::CentreTouched<B>) shift_to_meeting_point(mesh, state, element);
}

/// Ways along both fibres, flat against the normal, from two particles of fibres that cross to the point where they do [length].
/// @param apart  particle j - particle i, flat against the normal
/// @returns ways from particle i and from particle j: way i - way j = apart
inline std::pair<Vec3, Vec3> ways_to_crossing(const PairTangents& tangents, const Vec3& normal, const Vec3& apart) {
    const auto flat = [&](const Vec3& tangent) { return Vec3(tangent - tangent.dot(normal) * normal); };
    const Vec3 t_i = flat(tangents.i), t_j = flat(tangents.j), both = t_i.cross(t_j);
    const double square = both.squaredNorm();
    if (square < 1e-4) return {0.5 * apart, -0.5 * apart};  // a normal along one of them: half-way
    return {apart.cross(t_j).dot(both) / square * t_i, apart.cross(t_i).dot(both) / square * t_j};
}

/// Both forces act half-way between the particles, or where fibres cross, so that they are without a moment: sections that are
/// strained or lean have their particles a little off the normal, and friction would turn a pair by its depth. Between fibres
/// that do not touch a gap or a cap is left. The place moves with the sections until normals are renewed: if it followed the
/// pair, a slip would turn both fibres. A crossing that went on along its fibres is beside neither of them: half-way, normal
/// forces would spin both, which next to nothing holds.
template <class B, class Element>
void find_meeting_point(const beam::Mesh<B>& mesh, const Vector& state, [[maybe_unused]] const PairTangents& tangents,
                        Element& element) {
    if (element.in_bore()) return follow_in_bore(mesh, state, element);
    follow_support(mesh, state, element);
    if constexpr (!beam::CentreTouched<B>) {
        Vec3 half = 0.5 * element.offset(state);
        const double along = half.dot(element.normal);
        if (along > 0.0) half -= along * element.normal;
        Vec3 from_i = half, from_j = -half;
        if (element.crossing && !element.end_i && !element.end_j) {  // across a round end a fibre has no way
            const Vec3 sunk = half.dot(element.normal) * element.normal;
            const auto [way_i, way_j] = ways_to_crossing(tangents, element.normal, 2.0 * (half - sunk));
            from_i = way_i + sunk, from_j = way_j - sunk;
        }
        element.meeting = {material_shift(mesh, state, element.fibre_i, element.u_i, element.first_i, element.weights_i, from_i),
                           material_shift(mesh, state, element.fibre_j, element.u_j, element.first_j, element.weights_j, from_j),
                           std::max(0.0, -2.0 * along)};
        shift_to_meeting_point(mesh, state, element);
    }
}

/// `section_stiffness_term` of the section on one side of an element. The wall of a bore has none: there the support distance is
/// taken off the gap the other way round, and its part of the tangent would be negative.
template <class B, class Element, class Add>
void side_stiffness_term(const beam::Mesh<B>& mesh, const Vector& state, const Element& element, bool of_j, double reaction,
                         const Add& add) {
    if (element.place == (of_j ? bore_of_j : bore_of_i)) return;
    if (of_j)
        section_stiffness_term(mesh, state, element.fibre_j, element.u_j, element.first_j, element.normal, reaction,
                               element.end_j, add);
    else
        section_stiffness_term(mesh, state, element.fibre_i, element.u_i, element.first_i, element.normal, reaction,
                               element.end_i, add);
}

}  // namespace fibrant::contact

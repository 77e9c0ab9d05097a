// SPDX-License-Identifier: MIT
#pragma once
/// @file Where in an increment contact acts, and what its elements count from.

#include <fibrant/contact/element_directions.hpp>
#include <fibrant/contact/meeting_point.hpp>
#include <fibrant/contact/support.hpp>
#include <fibrant/contact/tool_element.hpp>
#include <fibrant/law/normal_law.hpp>

namespace fibrant::contact {

/// The state in which places and normals of contact elements are found: that of the end of an increment.
template <law::NormalLaw Normal>
class ActingState {
public:
    static constexpr bool within(const Normal&) noexcept { return false; }
    const Vector& of(const Normal&, const Vector& state, const Vector&) const noexcept { return state; }
    const Vector& of(const Normal&, const Vector& state) const noexcept { return state; }
};
/// Of a law that acts within an increment, the state of that part of it. Normals turn with fibres that slide around each other: a
/// force along that of the end pushes them apart by the versed sine of the turn as well, and does work that nothing has stored.
/// That is of first order in the step; of the middle it is of second.
template <law::SteppedNormal Normal>
class ActingState<Normal> {
public:
    static bool within(const Normal& law) noexcept { return law.acts() < 1.0; }
    const Vector& of(const Normal& law, const Vector& state, const Vector& accepted) {
        from_ = accepted;
        return of(law, state);
    }
    /// The same of the increment that it was asked for last.
    const Vector& of(const Normal& law, const Vector& state) {
        if (!within(law) || from_.size() != state.size()) return state;
        return between_ = from_ + law.acts() * (state - from_);
    }

private:
    Vector from_, between_;
};

/// Particles of a section that lie furthest towards a tool.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void follow_particles(const beam::Mesh<B>& mesh, const Vector& state, ToolElement<B, Normal, Friction>& element) {
    element.cap = support_weights(mesh, state, element.fibre, element.u, element.first, Vec3(-element.normal), element.end,
                                  element.weights);
}

/// What forces act on where contact acts within an increment: the particles that touch there, on the arms that they have there.
/// Those of the end would turn sections that lean against each other by more than their gap tells.
/// @param state   of the end
/// @param acting  ActingState::of it
template <law::NormalLaw Normal, beam::BeamElement B, class Element>
void act_within([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Normal& law,
                [[maybe_unused]] const Vector& state, [[maybe_unused]] const Vector& acting, [[maybe_unused]] Element& element) {
    if constexpr (law::SteppedNormal<Normal> && !beam::CentreTouched<B>) {
        if (!ActingState<Normal>::within(law)) return;
        const auto turn = [&]([[maybe_unused]] beam::Particle<B>& weights, [[maybe_unused]] Index first) {
            if constexpr (beam::TurningSections<B>)
                weights.follow(state.segment<beam::Mesh<B>::element_unknowns>(first),
                               acting.segment<beam::Mesh<B>::element_unknowns>(first));
        };
        Element then = element;
        if constexpr (requires { element.place; }) {
            if (element.place >= 0) return;
            follow_particles(mesh, acting, then);
            element.weights_i = then.weights_i, element.weights_j = then.weights_j;
            turn(element.weights_i, element.first_i), turn(element.weights_j, element.first_j);
        } else {
            follow_particles(mesh, acting, then);
            element.weights = then.weights;
            turn(element.weights, element.first);
        }
    }
}

/// Sets the gap that an element had, and the offset that its slip counts from.
/// @param state     of the end
/// @param tangents  of the element there
/// @param unseen    depth that its zone takes off gaps [length]
/// @param followed  normal in the accepted state of a crossing that is followed, or null: by the rule
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
void count_from(const beam::Mesh<B>& mesh, const NormalRule& rule, const Normal& law,
                ContactElement<B, Normal, Friction>& element, const Vector& state, const PairTangents& tangents,
                const Vector& accepted, double unseen, const Vec3* followed) {
    [[maybe_unused]] const auto earlier = [&](const PairTangents& then, const Vec3& present) {
        if (element.in_bore())  // a rod that lay at the middle has no direction there: the present one as both fibres have turned
            return turned(present, mean_tangent(tangents.i, tangents.j), mean_tangent(then.i, then.j));
        return followed ? *followed : element_normal(mesh, accepted, element, then, rule, present);
    };
    const bool within = ActingState<Normal>::within(law) && element.place < 0;
    if constexpr (law::SteppedNormal<Normal>) {
        if (within) {
            ContactElement<B, Normal, Friction> then = element;
            follow_particles(mesh, accepted, then);
            element.shift.before = element.normal.dot(then.offset(accepted)) - unseen;
        } else {
            const Vec3 before = earlier(pair_tangents(mesh, accepted, element), element.normal);
            element.shift.before = element.offset(accepted).dot(before) - unseen;  // along the normal of then
        }
    }
    if constexpr (core::Active<Friction>) {
        element.friction.weights_i = element.weights_i, element.friction.weights_j = element.weights_j;
        const auto offset = [&](const auto& seen) {
            const PairTangents then = pair_tangents(mesh, accepted, seen);
            return accepted_offset(seen, tangents, accepted, then, earlier(then, seen.normal));
        };
        if (!within) {
            element.friction.accepted_offset = offset(element);
            return;
        }
        ContactElement<B, Normal, Friction> turned = element;
        turned.normal = element_normal(mesh, state, element, tangents, rule, element.normal);
        element.friction.accepted_offset = offset(turned);
    }
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file A contact element: a pair of material particles, the normal between them, and what its laws make it carry.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/law/friction_law.hpp>
#include <fibrant/law/normal_law.hpp>

#include <cstdint>

namespace fibrant::contact {

/// Shift of the gap, for laws that ask for one; nothing otherwise.
template <law::NormalLaw Normal>
struct GapShift {
    double value() const noexcept { return 0.0; }
};
template <law::GapShifting Normal>
struct GapShift<Normal> {
    double shift = 0.0;
    double value() const noexcept { return shift; }
};
template <law::Augmenting Normal>
struct GapShift<Normal> {
    double multiplier = 0.0;  ///< reaction without a penetration [force]
    double shift = 0.0;       ///< less what a penalty would sink under it, <= 0 [length]
    double value() const noexcept { return shift; }
};

template <law::SeeingNormal Normal>
struct GapShift<Normal> {
    double length = 0.0;  ///< of the line of contact; 0: a crossing, or an end [length]
    double value() const noexcept { return 0.0; }
};
template <law::SteppedNormal Normal>
struct GapShift<Normal> {
    double length = 0.0;  ///< of the line of contact; 0: a crossing, or an end [length]
    double before = 0.0;  ///< gap in the last accepted state, without the cap, which may change since [length]
    double value() const noexcept { return 0.0; }
};

/// Memory of friction, for laws that have one; nothing otherwise.
template <beam::BeamElement B, law::FrictionLaw Friction>
struct FrictionState {};
/// How fibres lie where they touch, for laws that see it; nothing otherwise. It stands while normals do.
template <law::FrictionLaw Friction>
struct SeenPlace {};
template <law::SeeingFriction Friction>
struct SeenPlace<Friction> {
    Vec3 along_i = Vec3::Zero(), along_j = Vec3::Zero();  ///< unit, in the tangent plane
    double length = 0.0;                                  ///< of the line of contact; 0: a crossing, or an end [length]
};
template <beam::BeamElement B, law::FrictionLaw Friction>
    requires core::Active<Friction>
struct FrictionState<B, Friction> {
    static_assert(law::HistoryIsKept<Friction>, "contacts keep `reversible` and `numbers` of a law's history, and nothing else");
    static_assert(!beam::LeverNeeded<B>, "friction on centrelines has no lever: FrictionLever::dropped says that this is meant");
    typename Friction::History history;          ///< of the last accepted state, turned with the fibres
    beam::Particle<B> weights_i{}, weights_j{};  ///< of the pair of particles whose slip is counted
    double bound = -1.0;  ///< R_N that bounds friction until normals are renewed; < 0: the present one [force]
    [[no_unique_address]] SeenPlace<Friction> seen;
    Vec3 accepted_offset = Vec3::Zero();  ///< particle j - particle i in the last accepted state, turned since with the pair
};

/// The place where both forces of a pair act; nothing where particles are those of the centreline.
template <beam::BeamElement B>
struct MeetingPoint {
    Vec3 from_i = Vec3::Zero(), from_j = Vec3::Zero();  ///< from each particle to it, in material components
    double depth = 0.0;                                 ///< of the two particles in each other when it was found, >= 0 [length]
};
template <beam::BeamElement B>
    requires beam::CentreTouched<B>
struct MeetingPoint<B> {
};

/// Two particles that are predicted to touch (Durville, eq. 8). Fibre i <= fibre j, the normal points from i to j.
template <beam::BeamElement B, law::NormalLaw Normal, law::FrictionLaw Friction>
struct ContactElement {
    double u_i = 0.0, u_j = 0.0;                 ///< abscissae, in elements
    beam::Particle<B> weights_i{}, weights_j{};  ///< of the nodal vectors of each side's element, at the meeting point
    Vec3 normal = Vec3::Zero();
    double cap = 0.0;  ///< radii of fibre ends in contact and depth of the meeting point, taken off the gap [length]
    std::int32_t fibre_i = -1, fibre_j = -1;
    std::int32_t first_i = 0, first_j = 0;  ///< first unknown of each side's element
    std::int32_t zone = -1;
    std::int32_t place = -1;  ///< of a crossing that is followed, or what contact/bore.hpp says
    bool crossing = false, end_i = false, end_j = false;
    std::int8_t slide = 0;  ///< of a crossing that is followed: how its place slides (FollowedPlaces)
    [[no_unique_address]] GapShift<Normal> shift;
    [[no_unique_address]] MeetingPoint<B> meeting;
    [[no_unique_address]] FrictionState<B, Friction> friction;

    /// One fibre is in the other one's bore.
    bool in_bore() const noexcept { return place < -1; }
    /// Particle j - particle i [length].
    Vec3 offset(const Vector& state) const noexcept {
        return beam::Mesh<B>::point(state, first_j, weights_j) - beam::Mesh<B>::point(state, first_i, weights_i);
    }
    /// The same of the pair whose slip is counted, which the last normal pass chose [length].
    Vec3 friction_offset(const Vector& state) const noexcept requires core::Active<Friction> {
        return beam::Mesh<B>::point(state, first_j, friction.weights_j) -
               beam::Mesh<B>::point(state, first_i, friction.weights_i);
    }
    /// What a small step changes of the offset [length].
    Vec3 motion(const Vector& step) const noexcept {
        return beam::Mesh<B>::motion(step, first_j, weights_j) - beam::Mesh<B>::motion(step, first_i, weights_i);
    }
    /// True gap, < 0 in penetration [length] (Durville, eq. 9, with the normal from i to j).
    double gap(const Vector& state) const noexcept { return normal.dot(offset(state)) - cap; }
};

/// State of one contact element in the current iteration.
struct ContactResponse {
    double gap = 0.0;       ///< with the shift of the law [length]
    double reaction = 0.0;  ///< R_N [force]
    double slope = 0.0;     ///< dR_N / dgap [force / length]
};

/// Penetration that the stiffness of an element adapts to: with the shift of a law that limits the gap, and without that of a
/// multiplier [length].
template <class Element>
double adapting_penetration(const Element& element, const ContactResponse& response) noexcept {
    if constexpr (requires { element.shift.multiplier; }) return element.shift.value() - response.gap;
    return -response.gap;
}

}  // namespace fibrant::contact

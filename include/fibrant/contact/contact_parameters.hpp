// SPDX-License-Identifier: MIT
#pragma once
/// @file Parameters of contact that no law holds, and the figures of the contacts in a state.

#include <fibrant/contact/contact_detection.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/normal_direction.hpp>

#include <algorithm>
#include <cstdint>

namespace fibrant::contact {

/// Reaction that bounds friction within Newton: that of the last normal pass, or the one of the moment. The first has a
/// convex potential and a symmetric tangent; the second an unsymmetric one, of which symmetric solvers leave a part out.
enum class FrictionBound : std::uint8_t { held, following };

/// Where crossings touch and how their normals stand within Newton: as the last normal pass left them (Durville), or where the
/// fibres are closest in each iteration, with what sliding and turning makes of the reaction in the tangent. The first is a
/// fixed-point iteration that converges while the reaction over the radius of curvature is small against what holds fibres
/// sideways: loops that hang in each other are beyond. `as_needed` is the second where fibres are loops around each other;
/// elsewhere it begins with the first, and where an attempt at an increment fails tries the other one before anything else.
enum class Places : std::uint8_t { renewed, followed, as_needed };

/// Parameters of contact that no law holds.
struct ContactParameters {
    FrictionBound friction_bound = FrictionBound::held;  ///< which reaction bounds friction within Newton
    Places places = Places::as_needed;                   ///< whether contact places and normals are followed within Newton
    Detection detection;
    ContactSpacing spacing;
    NormalRule normal;
    StiffnessAdaptation stiffness;
    void validate() const {
        detection.validate();
        spacing.validate();
        normal.validate();
        stiffness.validate();
    }
};

/// Figures of the contacts in a state.
struct ContactFigures {
    Index elements = 0;               ///< contact elements, candidates included
    Index active = 0;                 ///< with a reaction
    Index shifted = 0;                ///< still shown a limited gap
    double greatest_penetration = 0;  ///< true, of all elements; 0 if none [length]
    double work = 0;                  ///< stored by the laws [force * length]
    double dissipated = 0;            ///< by sliding since the last accepted state [force * length]
    double reaction_sum = 0;          ///< sum of R_N [force]
    ContactFigures& operator+=(const ContactFigures& other) noexcept {
        elements += other.elements, active += other.active, shifted += other.shifted;
        greatest_penetration = std::max(greatest_penetration, other.greatest_penetration);
        work += other.work, dissipated += other.dissipated, reaction_sum += other.reaction_sum;
        return *this;
    }
};

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file Work of the force on a vector that a hold turns.

#include <fibrant/core/rotation.hpp>

#include <array>
#include <span>

namespace fibrant::connection {

/// What is between the start and the end of an increment.
struct Way {
    std::array<std::span<const double>, 2> amplitudes;  ///< of all channels
    std::array<const Vector*, 2> states, forces;        ///< what fibres and solids take from outside [force]

    Vec3 place(std::size_t k, Index vector) const { return states[k]->segment<3>(3 * vector); }
    /// @param free  of which no hold takes any
    Vec3 force(std::size_t k, Index vector, const Mat3& free) const {
        const Vec3 all = forces[k]->segment<3>(3 * vector);
        return all - free * all;
    }
};

/// A held vector at one end of the way: turned about a place.
struct Turned {
    Mat3 turn;
    Vec3 about;  ///< where the hold has taken what it turns about
    Vec3 place, force;
};

/// What the force does beyond what a trapezium takes. That has it go evenly from one end to the other in space, on the chord: of
/// a couple that goes with its section by an angle t it takes sin(t) / t. Here force and vector go evenly as the turned section
/// sees them, and what is turned about by a trapezium. A couple that grows evenly with its angle is exact.
inline double beyond_chord(const std::array<Turned, 2>& at) {
    std::array<Vec3, 2> arm, seen;
    for (const std::size_t k : {0u, 1u}) {
        arm[k] = at[k].turn.transpose() * (at[k].place - at[k].about);
        seen[k] = at[k].turn.transpose() * at[k].force;
    }
    const Vec3 angle = core::rotation_vector(Mat3(at[0].turn.transpose() * at[1].turn));
    const Vec3 couple = arm[0].cross(seen[0]) + arm[1].cross(seen[1]), drawn = arm[1] - arm[0];
    const Vec3 beside = (at[1].about - at[1].place) - (at[0].about - at[0].place);
    return 0.5 * (couple.dot(angle) + (seen[0] + seen[1]).dot(drawn) + (at[0].force + at[1].force).dot(beside));
}

}  // namespace fibrant::connection

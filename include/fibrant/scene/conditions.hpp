// SPDX-License-Identifier: MIT
#pragma once
/// @file What a user imposes on fibres, as data: held components, dead forces, moments, and the channels that scale them.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/places.hpp>

#include <functional>
#include <string>

namespace fibrant::scene {

/// A material point on a fibre's centreline; it falls on the nearest node.
struct Station {
    Index fibre = -1;
    double fraction = 0.0;  ///< of the rest length, in [0, 1]; of a closed fibre 1 is 0
};

/// Stations at the ends of a fibre.
inline Station first_end(Index fibre) { return {fibre, 0.0}; }
inline Station last_end(Index fibre) { return {fibre, 1.0}; }

/// Index of a vector of a node: 0 the centreline position, 1 and 2 the directors g_1 and g_2 (where the beam has them).
enum class NodeVector : int { position = 0, director_1 = 1, director_2 = 2 };

/// Axes in which directions are given: those of space, or (g_1, g_2, tangent) of the section at rest.
enum class Axes { space, section };

/// Throws unless it is one of the vectors of a node.
inline void require_vector(std::string_view field, NodeVector vector) {
    const int number = static_cast<int>(vector);
    if (number < 0 || number > 2) core::refuse(field, std::to_string(number), "a position or a director");
}

/// Throws unless what a path and a rotation give at an amplitude is finite, and a rotation; either may be empty.
inline void require_at(const std::string& of, double amplitude, const std::function<Vec3(double)>& path,
                       const std::function<Mat3(double)>& rotation) {
    if (path) require_finite(of + ".path(" + core::text(amplitude) + ")", path(amplitude));
    if (rotation) require_rotation(of + ".rotation(" + core::text(amplitude) + ")", rotation(amplitude));
}

/// Components of a nodal vector that follow a prescribed path.
///
/// The vector is held at rotation(a) * rest + displacement(a) in the directions rotation(a) * directions; a is the
/// amplitude of the channel. A rotation of a director turns the direction; of a position, turns it about the origin of
/// `pivot`.
struct Hold {
    Station at{};                              ///< fibre and place on it
    NodeVector vector = NodeVector::position;  ///< position or director of the node that lies there
    Mat3 directions = Mat3::Identity();        ///< symmetric projector on what is held
    Axes axes = Axes::space;                   ///< of `directions`
    std::string channel = "motion";            ///< whose amplitude drives it
    Vec3 displacement = Vec3::Zero();          ///< at amplitude 1 [length], or [1] for a director
    std::function<Vec3(double)> path{};        ///< displacement at amplitude a, where it is not proportional
    std::function<Mat3(double)> rotation{};    ///< at amplitude a; none: identity
    Vec3 pivot = Vec3::Zero();                 ///< of the rotation of a position [length]

    void validate() const {
        require_vector("Hold.vector", vector);
        require_projector("Hold.directions", directions);
        require_finite("Hold.displacement", displacement);
        require_finite("Hold.pivot", pivot);
        require_at("Hold", 0.0, path, rotation);
    }
};

/// A force that keeps its direction and size. On a director it is a force at the material point one length unit off the
/// axis, so a force Q at xi_1 = r acts as Q on the position and r Q on g_1.
struct DeadForce {
    Station at{};                              ///< fibre and place on it
    NodeVector vector = NodeVector::position;  ///< position or director of the node that lies there
    Vec3 force = Vec3::Zero();                 ///< at amplitude 1 [force], [force * length] on a director
    std::string channel = "load";              ///< whose amplitude it is multiplied by

    void validate() const {
        require_vector("DeadForce.vector", vector);
        require_finite("DeadForce.force", force);
    }
};

/// A moment about a fixed axis, applied to a section through one director: force M x g / |g|^2. The moment
/// must stay perpendicular to that director; the tangent is symmetrised, exact while the director turns in a plane.
struct Moment {
    Station at{};                                  ///< fibre and place on it
    NodeVector director = NodeVector::director_1;  ///< that it turns
    Vec3 moment = Vec3::Zero();                    ///< at amplitude 1 [force * length]
    std::string channel = "load";                  ///< whose amplitude it is multiplied by

    void validate() const {
        require_vector("Moment.director", director);
        require_finite("Moment.moment", moment);
        if (director == NodeVector::position) core::refuse("Moment.director", "position", "a director");
    }
};

/// A force per length of the line as it lies, across it: pressure * axis x tangent, so that it follows the fibre. Around a closed
/// fibre in a plane, anticlockwise about the axis, it is that of a fluid outside, and has a potential: pressure times the area
/// inside. Beyond the ends of an open one it has none, and the tangent is symmetrised.
struct LinePressure {
    Index fibre = -1;
    double pressure = core::unset;  ///< at amplitude 1 [force / length]
    Vec3 axis = Vec3::UnitZ();      ///< unit
    std::string channel = "load";   ///< whose amplitude it is multiplied by
};

/// Contact between the fibres of two groups, or within one, where it is not that of the laws. A fibre that is in no rule counts
/// as one of the groups that its group belongs to.
struct PairRule {
    Index first = -1, second = -1;    ///< groups, in any order; may be the same one
    double friction_factor = 1.0;     ///< on the coefficient of the friction law [1], >= 0
    double penetration_factor = 1.0;  ///< on the allowed penetration [1], > 0

    void validate() const {
        core::require_not_negative("PairRule.friction_factor", friction_factor);
        core::require_positive("PairRule.penetration_factor", penetration_factor);
    }
};

}  // namespace fibrant::scene

// SPDX-License-Identifier: MIT
#pragma once
/// @file Rigid bodies that hold sets of fibre ends on the average, and periodic cells, as data.

#include <fibrant/scene/conditions.hpp>

#include <array>
#include <string>
#include <vector>

namespace fibrant::scene {

/// One way in which a body can move: held at a value, or free under a force.
struct Coordinate {
    bool free = false;
    /// At amplitude 1: displacement [length] or angle [radian] if held; force [force] or moment [force * length] if free.
    double value = 0.0;
    std::string channel = "motion";  ///< whose amplitude drives it

    static Coordinate held_at(double value, std::string channel) { return {false, value, std::move(channel)}; }
    static Coordinate under(double force, std::string channel) { return {true, force, std::move(channel)}; }
    static Coordinate loose() { return {true, 0.0, "motion"}; }
};

/// A body of four nodes: a master and the tips of an orthonormal frame about it (Durville, eq. 12). The frame is kept as a
/// rotation, so it is orthonormal to rounding whatever the load.
///
/// Bodies form trees: coordinates count from the parent's frame, along and about its axes as they now stand, or from space.
/// Held rotations make one rotation vector; free ones come after it. Of two free rotations the third axis is held to first
/// order in an increment's turn.
struct RigidBody {
    std::string name{};             ///< in tables and messages
    Vec3 position = Vec3::Zero();   ///< of the master node at the start [length]
    Mat3 frame = Mat3::Identity();  ///< columns: from the master to the other three nodes at the start, orthonormal
    Index parent = -1;              ///< an earlier body, or -1 for space
    std::array<Coordinate, 3> translation{}, rotation{};  ///< along and about the three axes, held or free under a force

    void validate() const {
        require_finite("RigidBody.position", position);
        require_rotation("RigidBody.frame", frame);
        for (const auto* coordinates : {&translation, &rotation})
            for (const Coordinate& coordinate : *coordinates) core::require_finite("RigidBody.coordinate", coordinate.value);
    }
};

/// A node of a solid of the scene.
struct SolidNode {
    Index solid = 0, node = 0;
};

/// Ties the mean of nodal vectors to a body, in up to three directions that turn with it (Durville, eq. 13): single ends
/// move as they like. One end alone is hinged; one end whose directors are tied too is clamped. Nodes of solids have positions
/// only, and count in the mean as ends of fibres do.
struct AverageConnection {
    std::vector<Station> ends{};                 ///< places of fibres that count in the mean
    std::vector<SolidNode> nodes{};              ///< nodes of solids that count in the mean
    NodeVector vector = NodeVector::position;    ///< what is tied: positions, or a director
    Index body = -1;                             ///< number of the body in the assembly
    Mat3 directions = Mat3::Identity();          ///< columns at the start, orthonormal; they turn with the body
    std::array<bool, 3> tied{true, true, true};  ///< which of them
    Vec3 displacement = Vec3::Zero();            ///< of the mean along the directions at amplitude 1 [length]
    std::string channel = "motion";              ///< whose amplitude drives it

    void validate() const {
        if (ends.empty() && nodes.empty()) core::refuse("AverageConnection.ends", "none", "at least one");
        require_vector("AverageConnection.vector", vector);
        if (!nodes.empty() && vector != NodeVector::position)
            core::refuse("AverageConnection.vector", "a director", "the position, where nodes of solids are tied");
        require_orthonormal("AverageConnection.directions", directions);
        require_finite("AverageConnection.displacement", displacement);
    }
};

/// Displacement gradient of a repeating cell: what one period more in direction j moves in direction i.
struct PeriodicCell {
    std::string name{};                    ///< in tables and messages
    double volume = 1.0;                   ///< a force of a free component is its stress times this [length^3], > 0
    std::array<Coordinate, 9> gradient{};  ///< component (i, j) at i + 3 j [1]; free ones under a stress
    /// Second derivatives w,xx, w,yy and w,xy of the height w = u_z of a cell that repeats in the plane of x and y, as a plate
    /// without shear moves (Kirchhoff): u_x = -z w,x, u_y = -z w,y; small, and held [1 / length].
    std::array<Coordinate, 3> curvature{};

    void validate() const {
        core::require_positive("PeriodicCell.volume", volume);
        for (const Coordinate& coordinate : gradient) core::require_finite("PeriodicCell.gradient", coordinate.value);
        for (const Coordinate& coordinate : curvature) {
            core::require_finite("PeriodicCell.curvature", coordinate.value);
            if (coordinate.free) core::refuse("PeriodicCell.curvature", "a free coordinate", "held ones");
        }
    }
    Coordinate& component(int i, int j) noexcept { return gradient[static_cast<std::size_t>(i + 3 * j)]; }
    const Coordinate& component(int i, int j) const noexcept { return gradient[static_cast<std::size_t>(i + 3 * j)]; }
};

/// A fibre seen once more beside its cell, moved from where it is by what lies between the ends of pairs: contact acts on it, and
/// what it bears acts on the fibre and on the cell. It has no unknowns of its own. Of the two images of a fibre at opposite sides
/// one is enough, and images do not touch each other.
struct FibreImage {
    struct Shift {
        Index pair = -1;     ///< of the scene
        double times = 1.0;  ///< its period [1]
    };
    Index fibre = -1;
    std::vector<Shift> shifts{};  ///< at least one
};

/// The section `last` is the image of the section `first`: vectors keep the difference that they start with, and positions move
/// apart by the cell's gradient times the period.
struct PeriodicPair {
    Station first{}, last{};
    Vec3 period = Vec3::Zero();  ///< from first to last at the start [length]
    Index cell = -1;
};

}  // namespace fibrant::scene

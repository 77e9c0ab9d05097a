// SPDX-License-Identifier: MIT
#pragma once
/// @file Rigid tools that fibres touch: planes, cylinders, spheres and bodies of any shape, held or moved on a path.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/tool_surface.hpp>

#include <functional>
#include <memory>
#include <string>

namespace fibrant::scene {

/// Surfaces that a rigid tool may have.
enum class ToolShape { plane, cylinder, sphere, surface };

/// A rigid surface. Fibres stay on one side of it: where the normal of a plane points, outside a cylinder, a sphere or another
/// body, inside a hollow one. Planes and cylinders have no end.
///
/// A material point X of the tool is at origin + rotation(a) (X - origin) + displacement(a); a is the amplitude of the channel.
struct Tool {
    std::string name{};                  ///< in tables and messages
    ToolShape shape = ToolShape::plane;  ///< of its surface
    Vec3 origin = Vec3::Zero();          ///< a point of the plane or of the cylinder's axis, the centre of the sphere, or where
                                         ///< the origin of another body stands [length]
    Vec3 axis = Vec3::UnitZ();           ///< normal of the plane, on the fibres' side, or direction of the cylinder; made unit
    double radius = core::unset;         ///< of a cylinder or a sphere [length], > 0
    bool hollow = false;                 ///< fibres are inside the cylinder, the sphere or the body
    std::shared_ptr<const ToolSurface> surface{};  ///< of a body of any shape: TriangleSurface, Block, Ring or one's own
    double friction_factor = 1.0;                  ///< on the coefficient of the friction law [1], >= 0
    std::string channel = "tools";                 ///< whose amplitude drives it
    Vec3 displacement = Vec3::Zero();              ///< at amplitude 1 [length]
    std::function<Vec3(double)> path{};            ///< displacement at amplitude a, where it is not proportional
    std::function<Mat3(double)> rotation{};        ///< at amplitude a, about the origin; none: identity
    /// Particle of a centreline that carries it, for models whose part Tools is contact::CarriedTools: the tool moves as that
    /// does and pushes it with what it feels. The fibre itself does not touch the tool. Without a fibre there is none.
    Station carrier{};
    bool turns = false;  ///< with the section of its carrier as well, a node of a rod

    bool carried() const noexcept { return carrier.fibre != Station{}.fibre; }
    void validate() const {
        require_finite("Tool.origin", origin);
        require_finite("Tool.displacement", displacement);
        require_at("Tool", 0.0, path, rotation);
        core::require_positive("Tool.axis: length", axis.norm());
        if (shape == ToolShape::cylinder || shape == ToolShape::sphere) core::require_positive("Tool.radius", radius);
        if ((shape == ToolShape::surface) != (surface != nullptr))
            core::refuse("Tool.surface", surface ? "given" : "none",
                         surface ? "left out, for a tool of another shape" : "given, for a tool of this shape");
        core::require_not_negative("Tool.friction_factor", friction_factor);
        if (carried() && (!displacement.isZero(0.0) || path || rotation))
            core::refuse("Tool.carrier", "given", "left out, for a tool that is driven along a path");
        if (turns && !carried()) core::refuse("Tool.turns", "true", "false, for a tool without a carrier");
    }
};

/// Where a tool is: x = turn X + shift.
struct ToolPose {
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();
    Vec3 place(const Vec3& material) const {
        const Vec3 turned = turn * material;
        return turned + shift;
    }
    Vec3 material(const Vec3& place) const {
        const Vec3 arm = place - shift;
        return turn.transpose() * arm;
    }
};

/// Where a tool stands at the amplitude of its channel.
inline ToolPose tool_pose(const Tool& tool, double amplitude) {
    ToolPose pose;
    if (tool.rotation) pose.turn = tool.rotation(amplitude);
    const Vec3 turned = pose.turn * tool.origin, moved = tool.path ? tool.path(amplitude) : Vec3(amplitude * tool.displacement);
    pose.shift = tool.origin - turned;
    pose.shift += moved;
    return pose;
}

/// Distance of a point from a tool's surface.
/// @param tool  with a unit axis
/// @param x     in the tool's own axes, as it stands at amplitude 0 [length]
inline ToolDistance tool_distance(const Tool& tool, const Vec3& x) {
    Vec3 from = x - tool.origin;
    if (tool.shape == ToolShape::plane) return {from.dot(tool.axis), tool.axis};
    if (tool.shape == ToolShape::surface) {
        const ToolDistance outside = tool.surface->distance(from);
        return tool.hollow ? ToolDistance{-outside.distance, -outside.normal} : outside;
    }
    if (tool.shape == ToolShape::cylinder) from -= from.dot(tool.axis) * tool.axis;
    const double length = from.norm();
    // On the axis no direction is better than another; fibres never rest there, but a search may ask.
    const Vec3 outwards = length > 0.0 ? Vec3(from / length) : Vec3(tool.axis.unitOrthogonal());
    return tool.hollow ? ToolDistance{tool.radius - length, -outwards} : ToolDistance{length - tool.radius, outwards};
}

}  // namespace fibrant::scene

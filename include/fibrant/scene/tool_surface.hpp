// SPDX-License-Identifier: MIT
#pragma once
/// @file What a rigid tool of any shape is told by, and bodies with edges: blocks, pins, discs and plates with a hole.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <Eigen/Core>

#include <algorithm>
#include <cmath>

namespace fibrant::scene {

/// Distance of a point from a tool's surface, < 0 beyond it, and its gradient.
struct ToolDistance {
    double distance;  ///< [length]
    Vec3 normal;      ///< unit, away from the tool
};

/// Surface of a solid body of any shape, for a Tool whose shape is `surface`. Fibres stay outside of it, or inside if the tool is
/// hollow. Asked by several threads at once.
class ToolSurface {
public:
    virtual ~ToolSurface() = default;
    /// Of a point in the body's own axes: a true distance, or contact forces have no energy.
    virtual ToolDistance distance(const Vec3& x) const = 0;
};

namespace detail {

/// Distance from a box of as many dimensions, about the origin, whose edges are rounded.
/// @param gradient  of the distance
template <int Size>
double box_distance(const Eigen::Matrix<double, Size, 1>& x, const Eigen::Matrix<double, Size, 1>& half, double edge,
                    Eigen::Matrix<double, Size, 1>& gradient) {
    Eigen::Matrix<double, Size, 1> beyond;
    for (int k = 0; k < Size; ++k) beyond[k] = std::abs(x[k]) - (half[k] - edge);
    int nearest = 0;
    double outside = 0.0;
    for (int k = 0; k < Size; ++k) {
        if (beyond[k] > beyond[nearest]) nearest = k;
        if (beyond[k] > 0.0) outside += beyond[k] * beyond[k];
    }
    outside = std::sqrt(outside);
    for (int k = 0; k < Size; ++k) {
        const double side = x[k] < 0.0 ? -1.0 : 1.0;
        gradient[k] = outside > 0.0 ? side * std::max(beyond[k], 0.0) / outside : k == nearest ? side : 0.0;
    }
    return (outside > 0.0 ? outside : beyond[nearest]) - edge;
}

}  // namespace detail

/// A block, such as a plate of finite size, about the origin along the axes.
class Block : public ToolSurface {
public:
    struct Parameters {
        Vec3 half = Vec3::Constant(core::unset);  ///< half of its lengths [length], > 0
        double edge = 0.0;                        ///< radius that its edges are rounded by [length], in [0, least half length]
        void validate() const {
            for (const double length : half) core::require_positive("Block.half", length);
            core::require(edge >= 0.0 && edge <= half.minCoeff(), "Block.edge", edge, "in [0, least half length]");
        }
    };
    explicit Block(const Parameters& parameters) : own_{core::validated(parameters)} {}
    ToolDistance distance(const Vec3& x) const override {
        Vec3 normal;
        const double distance = detail::box_distance<3>(x, own_.half, own_.edge, normal);
        return {distance, normal};
    }

private:
    Parameters own_;
};

/// A body of revolution about the z axis with a rectangle for a section: a pin or a disc, a plate with a round hole, a tube.
class Ring : public ToolSurface {
public:
    struct Parameters {
        double radius = core::unset;       ///< [length], > 0
        double hole = 0.0;                 ///< radius of the hole [length], in [0, radius); 0: none
        double half_height = core::unset;  ///< [length], > 0
        double edge = 0.0;                 ///< radius that its edges are rounded by [length], at most half of the section's sides
        void validate() const {
            core::require_positive("Ring.radius", radius);
            core::require(hole >= 0.0 && hole < radius, "Ring.hole", hole, "in [0, radius)");
            core::require_positive("Ring.half_height", half_height);
            core::require(edge >= 0.0 && edge <= std::min(half_height, hole > 0.0 ? 0.5 * (radius - hole) : radius), "Ring.edge",
                          edge, "in [0, half of the least side of the section]");
        }
    };
    explicit Ring(const Parameters& parameters) : own_{core::validated(parameters)} {}
    ToolDistance distance(const Vec3& x) const override {
        using Plane = Eigen::Vector2d;
        const double out = std::hypot(x[0], x[1]), inner = own_.hole > 0.0 ? own_.hole : -own_.radius;
        const double middle = 0.5 * (inner + own_.radius);
        Plane normal;
        const double distance = detail::box_distance<2>(Plane(out - middle, x[2]),
                                                        Plane(0.5 * (own_.radius - inner), own_.half_height), own_.edge, normal);
        // On the axis no direction is better than another.
        const Vec3 outwards = out > 0.0 ? Vec3(x[0] / out, x[1] / out, 0.0) : Vec3(Vec3::UnitX());
        return {distance, Vec3(normal[0] * outwards[0], normal[0] * outwards[1], normal[1])};
    }

private:
    Parameters own_;
};

}  // namespace fibrant::scene

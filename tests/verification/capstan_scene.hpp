// SPDX-License-Identifier: MIT
#pragma once
/// @file A fibre wound on a rigid cylinder and drawn around it.

#include <fibrant/scene/assembly.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fibrant::test {

/// Lengths in mm. The fibre lies on the cylinder's top at first; its ends are led by the channel "ends".
struct CapstanScene {
    double cylinder = 0.5;  ///< radius
    double fibre = 0.0201;  ///< radius
    double half = 2.0;      ///< of the fibre's length at rest
    double travel = 0.06;   ///< by which it is drawn
    double tension = 0.03;  ///< strain as it is wound

    /// Wound by half a turn, under tension, while the amplitude goes to 1; drawn from there to 2.
    /// @param one        section, material, mesh of the fibre
    /// @param intervals  between its nodes
    scene::Assembly assembly(scene::FibreSpecification one, Index intervals) const {
        const double rho = cylinder + fibre;
        scene::Assembly assembly;
        one.from = Vec3(-half, rho, 0), one.to = Vec3(half, rho, 0), one.director = Vec3::UnitZ();
        assembly.add(one);
        scene::Tool guide;
        guide.shape = scene::ToolShape::cylinder, guide.radius = cylinder, guide.channel = "ends";
        assembly.add(guide);
        for (const double side : {-1.0, 1.0}) {
            scene::Hold end;
            end.at = side < 0.0 ? scene::first_end(0) : scene::last_end(0);
            end.channel = "ends";
            end.path = [rho, side, given = *this](double amplitude) {
                const double angle = 0.5 * std::numbers::pi * std::min(amplitude, 1.0),
                             drawn = side * given.travel * std::max(0.0, amplitude - 1.0);
                const double free = given.half * (1.0 + given.tension * std::min(1.0, 20.0 * amplitude)) - rho * angle;
                return Vec3(side * (rho * std::sin(angle) + free * std::cos(angle) - given.half),
                            rho * std::cos(angle) - free * std::sin(angle) - rho - drawn, 0.0);
            };
            assembly.hold(end);
        }
        const Mat3 across = Vec3(0, 0, 1).asDiagonal();
        for (Index k = 0; k <= intervals; ++k)
            assembly.hold_position({0, static_cast<double>(k) / static_cast<double>(intervals)}, across);
        assembly.hold_axial_rotation(scene::first_end(0));
        return assembly;
    }
};

}  // namespace fibrant::test

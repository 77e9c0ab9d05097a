// SPDX-License-Identifier: MIT
#pragma once
/// @file A fabric that is formed: a punch pushes it up through the hole of a die, while a blank holder keeps it flat around.

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/triangle_surface.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::weave {

/// Channels: way of the punch over the radius of the hole, and approach of holder and die over the thickness between them [1].
inline constexpr const char* punch_channel = "punch";
inline constexpr const char* holder_channel = "holder";

/// The tools that form a fabric. All friction is that of the fabric's fibres.
struct FormingParameters {
    double punch_radius = core::unset;                      ///< of a ball for a punch, where there is no surface [length], > 0
    std::shared_ptr<const scene::TriangleSurface> punch{};  ///< any other punch, which points up along z; its middle is x = y = 0
    double hole_radius = core::unset;                       ///< of die and holder [length], > 0
    double ring_width = core::unset;                        ///< of die and holder around the hole [length], > 0
    double edge_radius = core::unset;                       ///< of die and holder, at the hole and outside [length], > 0

    void validate() const {
        if (!punch) core::require_positive("FormingParameters.punch_radius", punch_radius);
        core::require_positive("FormingParameters.hole_radius", hole_radius);
        core::require_positive("FormingParameters.ring_width", ring_width);
        core::require_positive("FormingParameters.edge_radius", edge_radius);
        core::require(edge_radius <= 0.5 * ring_width, "FormingParameters.edge_radius", edge_radius, "<= half of ring_width");
    }
};

/// The tools of a scene, by number.
struct FormingTools {
    Index punch = -1, holder = -1, die = -1;
    double thickness = 0.0;  ///< of the fabric between holder and die at the start [length]
};

/// Adds a punch below a settled fabric, a holder below it and a die above, all of which just touch it.
/// @throws std::invalid_argument for a punch that does not fit through the hole with the fabric beside it
inline FormingTools add_forming_tools(scene::Assembly& assembly, const observe::Snapshot& snapshot,
                                      const FormingParameters& parameters) {
    parameters.validate();
    const auto [low, high] = heights(snapshot);
    FormingTools tools;
    tools.thickness = high - low;
    double wide = parameters.punch_radius, top = parameters.punch_radius;
    if (parameters.punch) {
        wide = 0.0, top = -std::numeric_limits<double>::infinity();
        for (const Vec3& corner : parameters.punch->corners())
            wide = std::max(wide, std::hypot(corner.x(), corner.y())), top = std::max(top, corner.z());
    }
    core::require(wide + tools.thickness <= parameters.hole_radius, "FormingParameters.hole_radius", parameters.hole_radius,
                  ">= the punch's radius and the thickness of the fabric, " + core::text(wide + tools.thickness));
    scene::Tool punch;
    punch.name = "punch", punch.channel = punch_channel;
    if (parameters.punch)
        punch.shape = scene::ToolShape::surface, punch.surface = parameters.punch;
    else
        punch.shape = scene::ToolShape::sphere, punch.radius = parameters.punch_radius;
    punch.origin = {0.0, 0.0, low - top}, punch.displacement = {0.0, 0.0, parameters.hole_radius};
    tools.punch = assembly.add(punch);
    const double half = 2.0 * parameters.edge_radius;  // thick enough that nothing goes around
    const auto ring =
        std::make_shared<const scene::Ring>(scene::Ring::Parameters{.radius = parameters.hole_radius + parameters.ring_width,
                                                                    .hole = parameters.hole_radius,
                                                                    .half_height = half,
                                                                    .edge = parameters.edge_radius});
    for (const bool above : {false, true}) {
        scene::Tool plate;
        plate.name = above ? "die" : "holder", plate.channel = holder_channel;
        plate.shape = scene::ToolShape::surface, plate.surface = ring;
        plate.origin = {0.0, 0.0, above ? high + half : low - half};
        plate.displacement = {0.0, 0.0, above ? 0.0 : tools.thickness};
        (above ? tools.die : tools.holder) = assembly.add(plate);
    }
    return tools;
}

/// Greatest change of the right angle between the tows of a fabric at its crossings [degree]; 0 where none is seen in plan.
inline double greatest_shear_deg(const observe::Snapshot& snapshot, const FabricParameters& fabric) {
    double most = 0.0;
    std::vector<std::vector<Vec3>> weft;
    for (Index k = 0; k < fabric.weft_tows; ++k) weft.push_back(tow_centreline(snapshot, fabric, Family::weft, k));
    for (Index tow = 0; tow < fabric.warp_tows; ++tow) {
        const std::vector<Vec3> nodes = tow_centreline(snapshot, fabric, Family::warp, tow);
        const observe::NodalCurve own{nodes};
        for (const std::vector<Vec3>& others : weft) {
            const observe::NodalCurve across{others};
            for_each_plan_crossing(own, across, [&](const PlanCrossing& crossing) {
                const double cosine = own.tangent(crossing.warp).normalized().dot(across.tangent(crossing.weft).normalized());
                most = std::max(most, std::abs(std::asin(std::clamp(cosine, -1.0, 1.0))));
            });
        }
    }
    return most * 180.0 / std::numbers::pi;
}

}  // namespace fibrant::compositions::weave

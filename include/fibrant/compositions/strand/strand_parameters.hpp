// SPDX-License-Identifier: MIT
#pragma once
/// @file A strand as a user describes it: a core, and layers of helical wires around it.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace fibrant::compositions::strand {

/// Wires of one radius on one helix, at equal angles around the axis.
struct Layer {
    Index wires = 6;              ///< >= 1
    double radius = core::unset;  ///< of a wire [length], > 0
    /// Angle of the wires to the axis [degree], in (-80, 80): positive is a right-handed helix; 0: straight wires.
    double lay_angle_deg = core::unset;
    double clearance = 0.0;                            ///< from the layer inside [length], >= 0
    std::optional<scene::ElasticMaterial> material{};  ///< of its wires; none: that of the strand

    void validate() const {
        core::require_at_least("Layer.wires", wires, 1);
        core::require_positive("Layer.radius", radius);
        core::require_between("Layer.lay_angle_deg", lay_angle_deg, -80.0, 80.0);
        core::require_not_negative("Layer.clearance", clearance);
        if (material) material->validate();
    }
};

/// How wires lie in a strand, whatever line its core follows.
struct StrandSection {
    double core_radius = core::unset;  ///< [length], > 0
    std::vector<Layer> layers;         ///< from the inside

    /// Radius of the helix of a layer's centrelines [length].
    double helix_radius(std::size_t layer) const noexcept {
        double radius = core_radius;
        for (std::size_t k = 0; k <= layer; ++k) radius += layers[k].clearance + (k < layer ? 2.0 : 1.0) * layers[k].radius;
        return radius;
    }
    /// Angle about the axis per length of it [radian / length].
    double turn_rate(std::size_t layer) const noexcept {
        return std::tan(layers[layer].lay_angle_deg * std::numbers::pi / 180.0) / helix_radius(layer);
    }
    /// Length of the axis on which a layer goes round once; infinite if straight [length].
    double pitch(std::size_t layer) const noexcept { return 2.0 * std::numbers::pi / std::abs(turn_rate(layer)); }
    /// Between the surfaces of neighbours in a layer, < 0 if they overlap; infinite for a single wire [length].
    double neighbour_gap(std::size_t layer) const {
        const Layer& own = layers[layer];
        if (own.wires < 2) return std::numeric_limits<double>::infinity();
        const double a = helix_radius(layer), rate = turn_rate(layer),
                     step = 2.0 * std::numbers::pi / static_cast<double>(own.wires);
        // From the point at z = 0 to the one at z of the neighbour, whose angle is step + rate z: least along z, by bisection of
        // the slope, which rises with z (a^2 rate sin + z) on each side of the minimum next to z = 0.
        const auto slope = [&](double z) { return a * a * rate * std::sin(step + rate * z) + z; };
        double low = rate > 0.0 ? -step / rate : 0.0, high = rate > 0.0 ? 0.0 : rate < 0.0 ? -step / rate : 0.0;
        for (int k = 0; k < 100; ++k) {
            const double middle = 0.5 * (low + high);
            (slope(middle) < 0.0 ? low : high) = middle;
        }
        const double z = 0.5 * (low + high), angle = step + rate * z;
        return std::sqrt(2.0 * a * a * (1.0 - std::cos(angle)) + z * z) - 2.0 * own.radius;
    }
    Index wires() const noexcept {
        Index sum = 1;
        for (const Layer& layer : layers) sum += layer.wires;
        return sum;
    }
    /// Of all wires [length^2].
    double area() const noexcept {
        double sum = core_radius * core_radius;
        for (const Layer& layer : layers) sum += static_cast<double>(layer.wires) * layer.radius * layer.radius;
        return std::numbers::pi * sum;
    }
};

/// A straight strand along z, its first end at z = 0. Wires are free of stress as they lie.
struct StrandParameters : StrandSection {
    scene::ElasticMaterial material;
    double length = core::unset;  ///< along the axis [length], > 0
    Index elements = 40;          ///< along each wire, >= 2

    const scene::ElasticMaterial& material_of(const Layer& layer) const noexcept {
        return layer.material ? *layer.material : material;
    }
    /// Sum of E A of all wires [force].
    double metal_stiffness() const noexcept {
        double sum = material.young_modulus * core_radius * core_radius;
        for (const Layer& layer : layers)
            sum += material_of(layer).young_modulus * static_cast<double>(layer.wires) * layer.radius * layer.radius;
        return std::numbers::pi * sum;
    }

    void validate() const {
        core::require_positive("StrandParameters.core_radius", core_radius);
        core::require_positive("StrandParameters.length", length);
        core::require_at_least("StrandParameters.elements", elements, 2);
        material.validate();
        for (std::size_t k = 0; k < layers.size(); ++k) {
            layers[k].validate();
            const double gap = neighbour_gap(k);
            core::require(gap > -1e-9 * layers[k].radius,
                          "StrandParameters.layers[" + std::to_string(k) + "]: gap between neighbours", gap, ">= 0");
        }
    }
};

/// Which angle wires of a layer have to the axis, the layers being counted from 0.
enum class Lay {
    equal_angle,  ///< that of the outermost layer
    equal_pitch,  ///< such that all layers go round once on the length on which the outermost does
};

/// Layers of 6, 12, 18, ... wires until there are `wires` in all, just not touching each other.
/// @param wires          7, 19, 37, 61, 91, ...
/// @param radius         of the outer wires; the core is thicker, so that each layer has room
/// @param lay_angle_deg  of the outermost layer, with the hand of the innermost
/// @param alternate      every second layer has the other hand
inline StrandParameters regular_strand(Index wires, double radius, double lay_angle_deg, bool alternate,
                                       Lay lay = Lay::equal_angle) {
    core::require_positive("regular_strand.radius", radius);
    Index layers = 0;
    for (Index sum = 1; sum < wires; sum += 6 * layers) ++layers;
    if (wires != 1 + 3 * layers * (layers + 1))
        core::refuse("regular_strand.wires", std::to_string(wires), "1 + 6 + 12 + ...: 1, 7, 19, 37, 61, 91");
    const double tangent = std::tan(lay_angle_deg * std::numbers::pi / 180.0);
    StrandParameters parameters;
    // Room for the wires of the first layer comes from the core, for those of the others from a clearance below them.
    const auto build = [&](double pitch) {
        parameters.core_radius = radius, parameters.layers.clear();
        for (Index k = 0; k < layers; ++k) {
            parameters.layers.push_back({.wires = 6 * (k + 1), .radius = radius, .lay_angle_deg = lay_angle_deg});
            const auto room = [&](double more) {
                (k == 0 ? parameters.core_radius : parameters.layers.back().clearance) = (k == 0 ? radius : 0.0) + more;
                const double angle = lay == Lay::equal_angle
                                         ? lay_angle_deg
                                         : std::atan(2.0 * std::numbers::pi * parameters.helix_radius(core::at(k)) / pitch) *
                                               180.0 / std::numbers::pi;
                parameters.layers.back().lay_angle_deg = alternate && k % 2 == 1 ? -angle : angle;
                return parameters.neighbour_gap(core::at(k));
            };
            double low = 0.0, high = radius;
            if (room(0.0) >= 0.0) continue;
            for (int n = 0; n < 60; ++n) {
                const double middle = 0.5 * (low + high);
                (room(middle) < 0.0 ? low : high) = middle;
            }
            room(high);
        }
    };
    double pitch = layers > 0 ? 2.0 * std::numbers::pi * radius * 2.0 * static_cast<double>(layers) / tangent : 1.0;
    build(pitch);
    for (int n = 0; n < 40 && lay == Lay::equal_pitch && layers > 0; ++n)  // the outermost helix hardly changes with the pitch
        build(pitch = 2.0 * std::numbers::pi * parameters.helix_radius(core::at(layers - 1)) / tangent);
    return parameters;
}

}  // namespace fibrant::compositions::strand

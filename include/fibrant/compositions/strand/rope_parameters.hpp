// SPDX-License-Identifier: MIT
#pragma once
/// @file A rope as a user describes it: a strand in its middle, and layers of strands wound around it, each of which has wires
/// wound around its core.

#include <fibrant/compositions/strand/wire_line.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace fibrant::compositions::strand {

/// Equal strands on one helix, at equal angles around the axis. The lay of rope and strands is one way if their angles have one
/// sign (lang lay), and ordinary if they have two: outer wires then lie along the rope.
struct StrandLayer {
    Index strands = 6;  ///< >= 1
    StrandSection strand;
    double lay_angle_deg = core::unset;  ///< of their cores to the axis [degree], in (-60, 60): positive is a right-handed helix
    double helix_radius = core::unset;   ///< of their cores; `lay_up` finds it [length], > 0
    double lay() const noexcept { return lay_angle_deg * std::numbers::pi / 180.0; }
};

/// A straight rope along z, its first end at z = 0. Wires are free of stress as they lie.
struct RopeParameters {
    StrandSection core;               ///< in the middle; of one wire if it has no layers
    std::vector<StrandLayer> layers;  ///< from the inside
    scene::ElasticMaterial material;
    double length = core::unset;  ///< along the axis [length], > 0
    Index elements = 40;          ///< along each wire, >= 2
    double overlap = 0.0;         ///< by which surfaces of wires may be in each other at the start [length], >= 0

    Index strands() const noexcept {
        Index sum = 1;
        for (const StrandLayer& layer : layers) sum += layer.strands;
        return sum;
    }
    Index wires() const noexcept {
        Index sum = core.wires();
        for (const StrandLayer& layer : layers) sum += layer.strands * layer.strand.wires();
        return sum;
    }
    /// Sum of E A of all wires [force].
    double metal_stiffness() const noexcept {
        double area = core.area();
        for (const StrandLayer& layer : layers) area += static_cast<double>(layer.strands) * layer.strand.area();
        return material.young_modulus * area;
    }
    /// Wires of a strand, counted from the inside and round: 0 is the one in the middle.
    std::vector<WireLine> lines(Index strand) const {
        if (strand == 0) return lines_of(core);
        Index first = 1;
        for (const StrandLayer& layer : layers) {
            if (strand < first + layer.strands)
                return lines_of(
                    layer.strand, layer.helix_radius, layer.lay(),
                    2.0 * std::numbers::pi * static_cast<double>(strand - first) / static_cast<double>(layer.strands));
            first += layer.strands;
        }
        return {};
    }
    void validate() const;
};

namespace detail {

/// @param enough  gaps that are not below need not be known
inline double least_gap(const std::vector<WireLine>& some, const std::vector<WireLine>& others, double length, double enough) {
    double least = enough;
    for (const WireLine& one : some)
        for (const WireLine& other : others) least = std::min(least, strand::least_gap(one, other, length, least));
    return least;
}

/// Between neighbours of a layer of wires. (The distance from a core, and from the next layer, does not change as the core is
/// bent.)
inline double gap_in_layer(const StrandSection& section, std::size_t layer, double helix_radius, double lay, double length,
                           double enough) {
    const std::vector<WireLine> lines = lines_of(section, helix_radius, lay);
    Index first = 1;
    for (std::size_t k = 0; k < layer; ++k) first += section.layers[k].wires;
    const Index wires = section.layers[layer].wires;
    double least = enough;
    for (Index k = 0; k < wires && wires > 1; ++k)
        least = std::min(least,
                         strand::least_gap(lines[core::at(first + k)], lines[core::at(first + (k + 1) % wires)], length, least));
    return least;
}

/// Between neighbours of a layer of strands, which are all alike.
inline double gap_beside(const RopeParameters& rope, std::size_t layer, double enough) {
    Index first = 1;
    for (std::size_t k = 0; k < layer; ++k) first += rope.layers[k].strands;
    return rope.layers[layer].strands > 1 ? least_gap(rope.lines(first), rope.lines(first + 1), rope.length, enough) : enough;
}

/// Between the strands of a layer and those inside it.
inline double gap_inside(const RopeParameters& rope, std::size_t layer, double enough) {
    Index first = 1;
    for (std::size_t k = 0; k < layer; ++k) first += rope.layers[k].strands;
    const Index strands = rope.layers[layer].strands, inside = layer == 0 ? 1 : rope.layers[layer - 1].strands;
    double least = enough;
    for (Index k = 0; k < strands; ++k)
        for (Index n = 0; n < inside; ++n)
            least = std::min(least, least_gap(rope.lines(first + k), rope.lines(first - inside + n), rope.length, least));
    return least;
}

/// Least x in [low, high] with room(x), to a millionth; `high` if there is none. The other way round if low > high.
template <class Room>
double least_with_room(double low, double high, const Room& room) {
    if (room(low)) return low;
    for (int n = 0; n < 24; ++n) {
        const double middle = 0.5 * (low + high);
        (room(middle) ? high : low) = middle;
    }
    room(high);
    return high;
}

/// Radius of a strand's section: its core, layers and the clearances between them [length].
inline double thickness(const StrandSection& section) {
    double sum = section.core_radius;
    for (const Layer& layer : section.layers) sum += layer.clearance + 2.0 * layer.radius;
    return sum;
}

}  // namespace detail

/// Gives each layer of strands the least radius, and each strand the least thicker core, at which surfaces of wires are nowhere
/// deeper in each other than `overlap`. A strand that is bent to a helix needs more room than a straight one: its wires come
/// closer on the inside of the bend.
/// @param apart     between neighbouring strands of a layer [length], >= - overlap
inline void lay_up(RopeParameters& rope, double apart = 0.0) {
    double inside = detail::thickness(rope.core);
    for (std::size_t k = 0; k < rope.layers.size(); ++k) {
        StrandLayer& layer = rope.layers[k];
        const StrandSection given = layer.strand;
        const double outer = detail::thickness(given);
        const double beside =
            layer.strands > 1 ? outer / std::sin(std::numbers::pi / static_cast<double>(layer.strands)) / std::cos(layer.lay())
                              : 0.0;
        const double most = 1.3 * std::max(inside + outer, beside);
        layer.helix_radius = std::max(inside + outer, beside);
        for (int pass = 0; pass < 2;
             ++pass) {  // the thickness of a strand and the radius of its helix hardly ask anything of each other
            layer.strand = given;
            for (std::size_t n = 0; n < given.layers.size(); ++n) {
                double& room = n == 0 ? layer.strand.core_radius : layer.strand.layers[n].clearance;
                detail::least_with_room(room, room + given.layers[n].radius, [&](double value) {
                    room = value;
                    return detail::gap_in_layer(layer.strand, n, layer.helix_radius, layer.lay(), rope.length, -rope.overlap) >=
                           -rope.overlap;
                });
            }
            detail::least_with_room(0.6 * most, most, [&](double value) {
                layer.helix_radius = value;
                return detail::gap_beside(rope, k, apart - rope.overlap) >= apart - rope.overlap &&
                       detail::gap_inside(rope, k, -rope.overlap) >= -rope.overlap;
            });
        }
        inside = layer.helix_radius + outer;
    }
}

/// Six strands of 1 + 6 wires around a seventh, whose wires are thicker, so that the others rest on it rather than on each other.
/// @param radius             of the outer strands' wires [length]
/// @param wire_lay_angle_deg of the wires of the outer strands in them; those of the middle one lie against the rope
/// @param rope_lay_angle_deg of the strands to the axis
/// @param apart              between neighbouring strands [length], >= 0
inline RopeParameters rope_of_seven(double radius, double wire_lay_angle_deg, double rope_lay_angle_deg, double length,
                                    double apart = 0.0, double overlap = 0.0) {
    RopeParameters rope;
    rope.length = length, rope.overlap = overlap;
    rope.core =
        regular_strand(7, radius, rope_lay_angle_deg > 0.0 ? -std::abs(wire_lay_angle_deg) : std::abs(wire_lay_angle_deg), false);
    rope.layers = {
        {.strands = 6, .strand = regular_strand(7, radius, wire_lay_angle_deg, false), .lay_angle_deg = rope_lay_angle_deg}};
    lay_up(rope, apart);
    const StrandSection thin = rope.core;
    detail::least_with_room(1.4, 0.7, [&](double factor) {
        rope.core.core_radius = factor * thin.core_radius, rope.core.layers[0].radius = factor * thin.layers[0].radius;
        return detail::gap_inside(rope, 0, -overlap) >= -overlap;
    });
    return rope;
}

/// Least distance between the surfaces of any two wires of the rope as it lies, < 0 if they overlap [length].
inline double least_gap(const RopeParameters& rope) {
    std::vector<WireLine> all;
    for (Index strand = 0; strand < rope.strands(); ++strand)
        for (const WireLine& line : rope.lines(strand)) all.push_back(line);
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < all.size(); ++k)
        for (std::size_t n = 0; n < k; ++n) least = std::min(least, least_gap(all[k], all[n], rope.length, least));
    return least;
}

inline void RopeParameters::validate() const {
    core::require_positive("RopeParameters.core.core_radius", core.core_radius);
    core::require_positive("RopeParameters.length", length);
    core::require_at_least("RopeParameters.elements", elements, 2);
    core::require_not_negative("RopeParameters.overlap", overlap);
    material.validate();
    const auto check = [](const Layer& wires, const std::string& name) {
        wires.validate();
        if (wires.material)
            core::refuse(name + ".material", "given", "left out: all wires of a rope are of RopeParameters.material");
    };
    for (const Layer& wires : core.layers) check(wires, "RopeParameters.core.layers");
    for (std::size_t k = 0; k < layers.size(); ++k) {
        const std::string name = "RopeParameters.layers[" + std::to_string(k) + "]";
        core::require_at_least(name + ".strands", layers[k].strands, 1);
        core::require_between(name + ".lay_angle_deg", layers[k].lay_angle_deg, -60.0, 60.0);
        core::require_positive(name + ".helix_radius", layers[k].helix_radius);
        core::require_positive(name + ".strand.core_radius", layers[k].strand.core_radius);
        for (const Layer& wires : layers[k].strand.layers) check(wires, name + ".strand.layers");
    }
    double thinnest = core.core_radius;
    for (const StrandLayer& layer : layers) thinnest = std::min(thinnest, layer.strand.core_radius);
    const double gap = least_gap(*this);
    core::require(gap > -overlap - 1e-6 * thinnest, "RopeParameters: least gap between wires", gap, ">= - overlap");
}

/// What a rope carries whose wires keep their distance from its axis, by the tension of its wires alone: no rope of the same
/// wires that is drawn and turned by little carries more, but for what bends and twists wires. By strain and by rotation a length
/// [force, force * length, force * length^2].
struct RopeStiffness {
    double force_by_strain = 0.0, torque_by_strain = 0.0, torque_by_rotation = 0.0;
};
/// The bound of a rope's stiffness.
/// @param stuck  each piece of a wire is stretched as its place says; otherwise a wire has one tension all along, as without
/// friction, which is less
inline RopeStiffness stiffness_bound(const RopeParameters& rope, bool stuck = false) {
    RopeStiffness sum;
    for (Index strand = 0; strand < rope.strands(); ++strand)
        for (const WireLine& line : rope.lines(strand)) {
            const double first = line.at_height(0.0), last = line.at_height(rope.length),
                         stiffness = rope.material.young_modulus * std::numbers::pi * line.radius * line.radius / rope.length;
            const int steps = 2000;
            double length = 0.0, along = 0.0, around = 0.0;
            for (int k = 0; k < steps; ++k) {
                const double s = first + (k + 0.5) / steps * (last - first);
                const auto [x, d] = line.at(s);
                const Vec3 tangent = d.normalized();
                const double piece = d.norm() * (last - first) / steps;
                const double by_strain = tangent.z() * tangent.z(),
                             by_rotation = tangent.z() * (x.x() * tangent.y() - x.y() * tangent.x());
                length += piece, along += by_strain * piece, around += by_rotation * piece;
                if (!stuck) continue;
                sum.force_by_strain += stiffness * by_strain * by_strain * piece;
                sum.torque_by_strain += stiffness * by_strain * by_rotation * piece;
                sum.torque_by_rotation += stiffness * by_rotation * by_rotation * piece;
            }
            if (stuck) continue;
            sum.force_by_strain += stiffness * along * along / length;
            sum.torque_by_strain += stiffness * along * around / length;
            sum.torque_by_rotation += stiffness * around * around / length;
        }
    return sum;
}

}  // namespace fibrant::compositions::strand

// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres one above the other between two plates.

#include <fibrant/scene/assembly.hpp>

namespace example {

/// Along z, one above the other; plates below (tool 0) and above (tool 1), which comes down by `depth` on the channel "press".
inline fibrant::scene::Assembly stacked(fibrant::Index fibres, double radius, double length, fibrant::Index elements,
                                        const fibrant::scene::ElasticMaterial& material, double depth) {
    fibrant::scene::Assembly assembly;
    for (fibrant::Index f = 0; f < fibres; ++f) {
        const double height = 2.0 * radius * static_cast<double>(f);
        assembly.add({.from = {0, height, 0},
                      .to = {0, height, length},
                      .section = fibrant::scene::circular(radius),
                      .material = material,
                      .elements = elements,
                      .director = fibrant::Vec3::UnitX()});
        // Ends stay above each other and do not turn; up and down they go where contacts push them.
        for (const double end : {0.0, 1.0})
            assembly.hold_position({f, end}, fibrant::Vec3(1, 0, 1).asDiagonal()), assembly.hold_rotation({f, end});
    }
    fibrant::scene::Tool below, above;
    below.origin = {0, -radius, 0}, below.axis = fibrant::Vec3::UnitY(), below.channel = "press";
    above.origin = {0, (2.0 * static_cast<double>(fibres) - 1.0) * radius, 0}, above.axis = -fibrant::Vec3::UnitY(),
    above.channel = "press";
    above.displacement = {0, -depth, 0};
    assembly.add(below), assembly.add(above);
    return assembly;
}

}  // namespace example

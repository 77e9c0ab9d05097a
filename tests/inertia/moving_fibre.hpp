// SPDX-License-Identifier: MIT
#pragma once
/// @file A fibre that moves, and for how long.

#include <fibrant/scene/assembly.hpp>
#include <fibrant/simulation/loading.hpp>

namespace fibrant::test {

/// A round fibre from the origin.
inline scene::FibreSpecification along_x(double length, double radius, double young, Index elements) {
    return {.from = {0, 0, 0},
            .to = {length, 0, 0},
            .section = scene::circular(radius),
            .material = {young, 0.3},
            .elements = elements,
            .director = Vec3::UnitZ()};
}

/// What a channel drives acts in full from the start.
template <class M>
simulation::Loading<M> lasting(double duration, Index steps, const char* channel) {
    simulation::Loading<M> loading;
    loading.stages.push_back({.name = "move",
                              .increments = steps,
                              .duration = duration,
                              .ramps = {{.channel = channel, .at_once = true}},
                              .most_increments = 20 * steps});
    return loading;
}

}  // namespace fibrant::test

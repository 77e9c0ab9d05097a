// SPDX-License-Identifier: MIT
#pragma once
/// @file A loading of one stage that lasts.

#include <fibrant/simulation/loading.hpp>

namespace fibrant::test {

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

// SPDX-License-Identifier: MIT
#pragma once
/// @file Force and moment that supports exert on sections of fibres, as one pair.

#include <fibrant/simulation/simulator.hpp>

#include <span>

namespace fibrant::simulation {

struct Wrench {
    Vec3 force = Vec3::Zero();   ///< [force]
    Vec3 moment = Vec3::Zero();  ///< about the origin that was asked for [force * length]
};

/// What supports exert on sections, positions and directors together.
template <Model M>
Wrench support_wrench(const Simulator<M>& simulator, std::span<const scene::Station> sections, const Vec3& origin = Vec3::Zero()) {
    Wrench sum;
    for (const scene::Station& at : sections) {
        const Vec3 force = simulator.reaction(at);
        sum.force += force;
        sum.moment += (simulator.value(at) - origin).cross(force);
        if constexpr (M::Beam::vectors_per_node == 3)
            for (const scene::NodeVector vector : {scene::NodeVector::director_1, scene::NodeVector::director_2})
                sum.moment += simulator.value(at, vector).cross(simulator.reaction(at, vector));
    }
    return sum;
}

}  // namespace fibrant::simulation

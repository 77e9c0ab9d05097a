// SPDX-License-Identifier: MIT
#pragma once
/// @file Force and moment that supports exert on sections of fibres, as one pair.

#include <fibrant/simulation/simulator.hpp>

#include <span>

namespace fibrant::simulation {

/// Force and moment of supports.
struct Wrench {
    Vec3 force = Vec3::Zero();   ///< [force]
    Vec3 moment = Vec3::Zero();  ///< about the origin that was asked for [force * length]
};

/// Moment of a force on a nodal vector about its section's centre: of a director, or a tangent, by its lever; of a rotation
/// vector, whose force works on its change, by the spin of that.
template <beam::BeamElement B>
Vec3 vector_moment(Index vector, const Vec3& value, const Vec3& force) {
    if (B::kinds[core::at(vector)] == scene::VectorKind::rotation) return core::spin_matrix(value).transpose().inverse() * force;
    return value.cross(force);
}

/// What supports exert on sections: on their centres, and on all that turns with them.
template <Model M>
Wrench support_wrench(const Simulator<M>& simulator, std::span<const scene::Station> sections,
                      const Vec3& origin = Vec3::Zero()) {
    Wrench sum;
    for (const scene::Station& at : sections) {
        const Vec3 force = simulator.reaction(at);
        sum.force += force;
        sum.moment += (simulator.value(at) - origin).cross(force);
        for (Index v = 1; v < M::Beam::vectors_per_node; ++v) {
            const auto vector = static_cast<scene::NodeVector>(v);
            sum.moment += vector_moment<typename M::Beam>(v, simulator.value(at, vector), simulator.reaction(at, vector));
        }
    }
    return sum;
}

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file Dead forces and moments on nodal vectors.

#include <fibrant/connection/prescribed_motion.hpp>

#include <span>
#include <vector>

namespace fibrant::connection {

/// Loads of a scene on a mesh.
template <beam::BeamElement B>
class AppliedLoad {
public:
    AppliedLoad(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels) {
        const auto item = [&](const auto& load, scene::NodeVector vector, const Vec3& value) {
            if (static_cast<Index>(vector) >= B::vectors_per_node)
                core::refuse("load.vector", std::to_string(static_cast<int>(vector)), "a vector of the beam's nodes");
            return Item{mesh.node_vector(load.at.fibre, station_node(mesh, load.at), static_cast<Index>(vector)),
                        channels.find(load.channel), value};
        };
        for (const scene::DeadForce& load : assembly.forces()) forces_.push_back(item(load, load.vector, load.force));
        for (const scene::Moment& load : assembly.moments()) moments_.push_back(item(load, load.director, load.moment));
    }

    /// Adds the external forces at the given amplitudes.
    void add_forces(std::span<const double> amplitudes, const Vector& state, Vector& external) const {
        for (const Item& item : forces_)
            external.segment<3>(3 * item.vector) += amplitudes[core::at(item.channel)] * item.value;
        for (const Item& item : moments_) {
            const Vec3 director = state.segment<3>(3 * item.vector);
            external.segment<3>(3 * item.vector) +=
                amplitudes[core::at(item.channel)] * item.value.cross(director) / director.squaredNorm();
        }
    }

    /// Calls add(vector, stiffness) with minus the derivative of each moment's force by its own director, symmetrised.
    template <class Add>
    void add_stiffness(std::span<const double> amplitudes, const Vector& state, const Add& add) const {
        for (const Item& item : moments_) {
            const Vec3 director = state.segment<3>(3 * item.vector);
            const Vec3 moment = amplitudes[core::at(item.channel)] * item.value;
            const double square = director.squaredNorm();
            Mat3 cross;
            cross << 0, -moment.z(), moment.y(), moment.z(), 0, -moment.x(), -moment.y(), moment.x(), 0;
            const Mat3 slope = cross / square - 2.0 / (square * square) * moment.cross(director) * director.transpose();
            add(item.vector, Mat3(-0.5 * (slope + slope.transpose())));
        }
    }

private:
    struct Item {
        Index vector, channel;
        Vec3 value;
    };
    std::vector<Item> forces_, moments_;
};

}  // namespace fibrant::connection

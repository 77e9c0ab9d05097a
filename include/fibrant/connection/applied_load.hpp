// SPDX-License-Identifier: MIT
#pragma once
/// @file Dead forces and moments on nodal vectors.

#include <fibrant/connection/prescribed_motion.hpp>
#include <fibrant/core/rotation.hpp>

#include <span>
#include <vector>

namespace fibrant::connection {

/// Loads of a scene on a mesh.
template <beam::BeamElement B>
class AppliedLoad {
public:
    AppliedLoad(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels) {
        const auto item = [&](const auto& load, int vector, bool there, const Vec3& value) {
            if (!there) core::refuse("load.vector", std::to_string(vector), "a vector of the beam's nodes");
            return Item{mesh.node_vector(load.at.fibre, station_node(mesh, load.at), vector), channels.find(load.channel), value};
        };
        if constexpr (beam::TurningSections<B>) {  // what acts on directors turns the section
            for (const scene::DeadForce& load : assembly.forces()) {
                if (load.vector == scene::NodeVector::position) {
                    forces_.push_back(item(load, 0, true, load.force));
                } else {
                    turning_.push_back(item(load, 1, true, load.force));
                    turning_.back().director = static_cast<int>(load.vector);
                }
            }
            for (const scene::Moment& load : assembly.moments()) turning_.push_back(item(load, 1, true, load.moment));
            return;
        }
        for (const scene::DeadForce& load : assembly.forces()) {
            const int vector = static_cast<int>(load.vector);
            forces_.push_back(item(load, vector, vector == 0 || (vector < B::vectors_per_node && !beam::CentrelineOnly<B>), load.force));
        }
        for (const scene::Moment& load : assembly.moments()) {
            int vector = static_cast<int>(load.director);
            if constexpr (requires { B::moment_vector(load.director); }) vector = B::moment_vector(load.director);
            moments_.push_back(item(load, vector, vector < B::vectors_per_node, load.moment));
        }
    }

    /// Adds the external forces at the given amplitudes.
    void add_forces(std::span<const double> amplitudes, const Vector& state, Vector& external) const {
        for (const Item& item : forces_)
            external.segment<3>(3 * item.vector) += amplitudes[core::at(item.channel)] * item.value;
        for (const Item& item : turning_) {
            const Vec3 psi = state.segment<3>(3 * item.vector), value = amplitudes[core::at(item.channel)] * item.value;
            external.segment<3>(3 * item.vector) += core::spin_matrix(psi).transpose() * (item.director > 0 ? director(psi, item).cross(value) : value);
        }
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
        for (const Item& item : turning_) {
            const Vec3 psi = state.segment<3>(3 * item.vector), value = amplitudes[core::at(item.channel)] * item.value;
            if (item.director == 0) {
                add(item.vector, Mat3(-core::spin_slope(psi, value)));
            } else {
                const Vec3 g = director(psi, item);
                Mat3 bend = 0.5 * (g * value.transpose() + value * g.transpose());
                bend.diagonal().array() -= g.dot(value);
                const Mat3 T = core::spin_matrix(psi);
                add(item.vector, Mat3(-T.transpose() * bend * T - core::spin_slope(psi, g.cross(value))));
            }
        }
    }

private:
    struct Item {
        Index vector, channel;
        Vec3 value;
        int director = 0;  ///< on which a force acts, where sections turn; 0: a moment
    };
    static Vec3 director(const Vec3& psi, const Item& item) noexcept { return core::rotation(psi).col(item.director - 1); }
    std::vector<Item> forces_, moments_, turning_;
};

}  // namespace fibrant::connection

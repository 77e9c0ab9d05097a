// SPDX-License-Identifier: MIT
#pragma once
/// @file Prescribed components of nodal vectors: which they are, and where they go.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/connection/channels.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <span>
#include <vector>

namespace fibrant::connection {

/// Node of a station.
template <class B>
Index station_node(const beam::Mesh<B>& mesh, const scene::Station& at) {
    return static_cast<Index>(std::lround(at.fraction * static_cast<double>(mesh.node_count(at.fibre) - 1)));
}

/// Holds of a scene, merged by nodal vector. Where two holds of a vector overlap, the one added first decides.
template <beam::BeamElement B>
class PrescribedMotion {
public:
    PrescribedMotion(const scene::Assembly& assembly, const beam::Mesh<B>& mesh, const Channels& channels) {
        for (const scene::Hold& hold : assembly.holds()) {
            if (static_cast<Index>(hold.vector) >= B::vectors_per_node)
                core::refuse("Hold.vector", std::to_string(static_cast<int>(hold.vector)), "a vector of the beam's nodes");
            const Index node = station_node(mesh, hold.at);
            Item item{mesh.node_vector(hold.at.fibre, node, static_cast<Index>(hold.vector)), channels.find(hold.channel),
                      mesh.frame(hold.at.fibre, node).basis(), Vec3::Zero(), hold};
            item.rest = mesh.start_state().template segment<3>(3 * item.vector);
            items_.push_back(item);
        }
        std::stable_sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) { return a.vector < b.vector; });
    }

    /// Held vectors at the given amplitudes; target[k] is the held part of held[k]'s vector.
    void at(std::span<const double> amplitudes, std::vector<scene::HeldVector>& held, std::vector<Vec3>& target) const {
        held.clear(), target.clear();
        for (const Item& item : items_) {
            const double amplitude = amplitudes[core::at(item.channel)];
            const Mat3 turn = item.hold.rotation ? item.hold.rotation(amplitude) : Mat3(Mat3::Identity());
            const Mat3 axes = item.hold.axes == scene::Axes::section ? Mat3(turn * item.basis) : turn;
            const bool position = item.hold.vector == scene::NodeVector::position;
            const Vec3 goal =
                (position ? Vec3(item.hold.pivot + turn * (item.rest - item.hold.pivot)) : Vec3(turn * item.rest)) +
                (item.hold.path ? item.hold.path(amplitude) : Vec3(amplitude * item.hold.displacement));
            if (held.empty() || held.back().vector != item.vector) {
                held.push_back({item.vector, Mat3::Identity()});
                target.push_back(Vec3::Zero());
            }
            Mat3& free = held.back().free;
            const Eigen::SelfAdjointEigenSolver<Mat3> directions(axes * item.hold.directions * axes.transpose());
            for (int k = 0; k < 3; ++k) {
                if (directions.eigenvalues()[k] < 0.5) continue;
                const Vec3 direction = directions.eigenvectors().col(k);
                Vec3 fresh = free * direction;  // what earlier holds leave of it
                if (fresh.norm() < 1e-8) continue;
                fresh = (free * fresh.normalized()).normalized();  // again: cancellation may have left digits only
                target.back() += fresh * (direction.dot(goal - target.back()) / direction.dot(fresh));
                free -= fresh * fresh.transpose();
            }
        }
    }

private:
    struct Item {
        Index vector, channel;
        Mat3 basis;
        Vec3 rest;
        scene::Hold hold;
    };
    std::vector<Item> items_;
};

}  // namespace fibrant::connection

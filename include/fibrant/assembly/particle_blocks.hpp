// SPDX-License-Identifier: MIT
#pragma once
/// @file Blocks that a particle's stiffness has between the nodal vectors of its element.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/beam/on_centreline.hpp>

namespace fibrant::assembly {

/// see(node a, vector, node b, vector, block) of (w w^T) (x) stiffness between the vectors of an element, b <= a.
/// @param weights  w of all vectors of the element
template <beam::BeamElement B, class See>
void each_pair(const beam::ElementWeights<B>& weights, const Mat3& stiffness, const See& see) {
    for (Index a = 0; a < B::nodes; ++a)
        for (Index v = 0; v < B::vectors_per_node; ++v) {
            const double left = weights[core::at(a * B::vectors_per_node + v)];
            if (left == 0.0) continue;
            for (Index b = 0; b <= a; ++b)
                for (Index w = 0; w < B::vectors_per_node; ++w)
                    see(a, v, b, w, Mat3(left * weights[core::at(b * B::vectors_per_node + w)] * stiffness));
        }
}
/// The same of a particle of the centreline.
template <beam::BeamElement B, class See>
void each_pair(const beam::CentreWeights<B::nodes, B::vectors_per_node>& centre, const Mat3& stiffness, const See& see) {
    for (Index a = 0; a < B::nodes; ++a)
        for (Index b = 0; b <= a; ++b) see(a, 0, b, 0, Mat3(centre[core::at(a)] * centre[core::at(b)] * stiffness));
}
/// The same of J^T stiffness J, J the derivatives of a particle whose section turns.
template <beam::BeamElement B, class See>
    requires beam::TurningSections<B>
void each_pair(const beam::Particle<B>& particle, const Mat3& stiffness, const See& see) {
    for (Index a = 0; a < B::nodes; ++a)
        for (Index v = 0; v < B::vectors_per_node; ++v) {
            const Mat3 left = particle.slope(a * B::vectors_per_node + v).transpose() * stiffness;
            for (Index b = 0; b <= a; ++b)
                for (Index w = 0; w < B::vectors_per_node; ++w)
                    see(a, v, b, w, Mat3(left * particle.slope(b * B::vectors_per_node + w)));
        }
}

}  // namespace fibrant::assembly

// SPDX-License-Identifier: MIT
#pragma once
/// @file What the nodes of a beam carry at rest, and sums over the nodes of an element: weights, and forces spread by them.

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <array>
#include <type_traits>

namespace fibrant::beam {

/// Vectors of a node at rest: position and directors, unless the beam says what else its nodes carry.
template <BeamElement B>
std::array<Vec3, static_cast<std::size_t>(B::vectors_per_node)> nodal_vectors(const scene::NodeFrame& frame,
                                                                              [[maybe_unused]] double element_length) {
    if constexpr (requires { B::nodal_vectors(frame, element_length); }) {
        return B::nodal_vectors(frame, element_length);
    } else if constexpr (requires { B::nodal_vectors(frame); }) {
        return B::nodal_vectors(frame);
    } else {
        static_assert(B::vectors_per_node == 3, "a beam whose nodes are not position and two directors gives nodal_vectors");
        return {frame.position, frame.director_1, frame.director_2};
    }
}

/// What makes a nodal vector a displacement of the surface: 1 for a position, the radius for a director, unless the beam
/// says what else its nodes carry.
template <BeamElement B>
double vector_length(int vector, double radius, [[maybe_unused]] double element_length) {
    if constexpr (requires { B::vector_length(vector, radius, element_length); }) {
        return B::vector_length(vector, radius, element_length);
    } else {
        return B::kinds[core::at(vector)] == scene::VectorKind::position ? 1.0 : radius;
    }
}

/// Adds to forces on the nodal vectors of an element what a force on a particle is to them.
template <std::size_t Vectors>
void spread(const std::array<double, Vectors>& weights, const Vec3& value, Index first_unknown, Vector& forces) noexcept {
    for (std::size_t a = 0; a < weights.size(); ++a)
        forces.segment<3>(first_unknown + 3 * static_cast<Index>(a)) += weights[a] * value;
}
template <int Nodes, int Vectors>
void spread(const CentreWeights<Nodes, Vectors>& centre, const Vec3& value, Index first_unknown, Vector& forces) noexcept {
    for (std::size_t node = 0; node < centre.size(); ++node)
        forces.segment<3>(first_unknown + 3 * Vectors * static_cast<Index>(node)) += centre[node] * value;
}
template <class Turning>
    requires requires(const Turning& particle) { particle.slope(Index{}); }
void spread(const Turning& particle, const Vec3& value, Index first_unknown, Vector& forces) noexcept {
    for (Index a = 0; a < Turning::vectors; ++a)
        forces.segment<3>(first_unknown + 3 * a) += particle.slope(a).transpose() * value;
}

/// Weights of director g_1 (which = 1) or g_2 (which = 2) at xi in [-1, 1].
template <BeamElement B>
constexpr ElementWeights<B> director_weights(double xi, int which) noexcept {
    ElementWeights<B> weights = B::particle_weights(xi, which == 1 ? 1.0 : 0.0, which == 2 ? 1.0 : 0.0);
    const ElementWeights<B> centre = B::centreline_weights(xi);
    for (std::size_t a = 0; a < weights.size(); ++a) weights[a] -= centre[a];
    return weights;
}

namespace detail {
/// The only vector of each node that has a weight among those that Weights{}(xi) gives, so that sums may leave the others out: a
/// third of the time where nodes have three. -1 where several have, or the compiler cannot tell.
template <class B, class Weights>
constexpr int only_vector(Weights) noexcept {
    if constexpr (requires { typename std::bool_constant<(static_cast<void>(Weights{}(0.3)), true)>; }) {
        int only = -1;
        for (const double xi : {-0.83, -0.29, 0.3, 0.71}) {  // no root of any shape function
            const ElementWeights<B> weights = Weights{}(xi);
            for (int a = 0; a < B::nodes * B::vectors_per_node; ++a) {
                if (weights[core::at(a)] == 0.0) continue;
                if (only >= 0 && only != a % B::vectors_per_node) return -1;
                only = a % B::vectors_per_node;
            }
        }
        return only;
    } else {
        return -1;
    }
}
}  // namespace detail

}  // namespace fibrant::beam

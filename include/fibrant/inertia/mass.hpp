// SPDX-License-Identifier: MIT
#pragma once
/// @file Masses of fibres, and the coordinates in which they are constant.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/core/rotation.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace fibrant::inertia {

/// Consistent mass of the elements of one fibre: a number for each pair of nodal vectors, times the unit matrix of space.
///
/// The kinetic energy of x = x_0 + xi_1 g_1 + xi_2 g_2 is rho/2 times the integral of A |x_0'|^2 + I_1 |g_1'|^2 + I_2 |g_2'|^2:
/// constant, without gyroscopic terms, rotary inertia included. Cables have that of their centreline. Rods have it with the
/// directors of their rotations, the part of the directors lumped at the nodes: a turn does not mix them.
template <beam::BeamElement B>
struct ElementMass {
    static constexpr int vectors = B::nodes * B::vectors_per_node;
    std::array<std::array<double, static_cast<std::size_t>(vectors)>, static_cast<std::size_t>(vectors)>
        of{};                         ///< [mass], directors [mass length^2]
    std::array<double, 2> turning{};  ///< of either director of a node of a rod, from one element [mass length^2]

    /// @param density  [mass / length^3], > 0
    ElementMass(const beam::MeshFibre& fibre, double density) {
        const double area = density * fibre.section.area(), first = density * fibre.section.second_moment_1(),
                     second = density * fibre.section.second_moment_2();
        // Gauss, four points: exact to the seventh degree, and weights are of the third at most.
        const double near = std::sqrt(3.0 / 7.0 - 2.0 / 7.0 * std::sqrt(1.2)),
                     far = std::sqrt(3.0 / 7.0 + 2.0 / 7.0 * std::sqrt(1.2));
        const double most = 0.5 + std::sqrt(30.0) / 36.0, least = 0.5 - std::sqrt(30.0) / 36.0;
        for (const auto& [xi, weight] :
             {std::pair{-far, least}, std::pair{-near, most}, std::pair{near, most}, std::pair{far, least}}) {
            const beam::ElementWeights<B> w = B::centreline_weights(xi);
            const double length = 0.5 * weight * fibre.element_length;
            for (std::size_t a = 0; a < w.size(); ++a)
                for (std::size_t b = 0; b < w.size(); ++b) {
                    of[a][b] += length * area * w[a] * w[b];
                    if constexpr (beam::DeformableSections<B>)
                        if (a + 2 < w.size() &&
                            b + 2 < w.size()) {  // directors follow the position of their node, and have its weights
                            of[a + 1][b + 1] += length * first * w[a] * w[b];
                            of[a + 2][b + 2] += length * second * w[a] * w[b];
                        }
                }
        }
        if constexpr (beam::TurningSections<B>)
            turning = {0.5 * fibre.element_length * first, 0.5 * fibre.element_length * second};
    }
};

/// Coordinates in which mass is constant: nodal vectors themselves, and for rods position and directors of each node.
template <beam::BeamElement B>
class Coordinates {
public:
    static constexpr bool turn = beam::TurningSections<B>;
    static constexpr Index per_node = turn ? 3 : B::vectors_per_node;  ///< vectors

    static Index size(const Vector& state) noexcept { return state.size() / B::vectors_per_node * per_node; }
    static Vector of(const Vector& state) {
        if constexpr (!turn) {
            return state;
        } else {
            Vector q(size(state));
            for (Index node = 0; 6 * node < state.size(); ++node) {
                const Mat3 R = core::rotation(state.segment<3>(6 * node + 3));
                q.segment<3>(9 * node) = state.segment<3>(6 * node), q.segment<3>(9 * node + 3) = R.col(0),
                                 q.segment<3>(9 * node + 6) = R.col(1);
            }
            return q;
        }
    }
    /// Forces on nodal vectors as they are in space: on rotation vectors those are moments.
    static Vector in_space(const Vector& state, Vector forces) {
        if constexpr (turn)
            for (Index k = 3; k < state.size(); k += 6)
                forces.segment<3>(k) =
                    core::spin_matrix(state.segment<3>(k)).transpose().partialPivLu().solve(Vec3(forces.segment<3>(k))).eval();
        return forces;
    }
    /// And back.
    static Vector from_space(const Vector& state, Vector forces) {
        if constexpr (turn)
            for (Index k = 3; k < state.size(); k += 6)
                forces.segment<3>(k) = (core::spin_matrix(state.segment<3>(k)).transpose() * forces.segment<3>(k)).eval();
        return forces;
    }
};

}  // namespace fibrant::inertia

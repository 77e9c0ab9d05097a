// SPDX-License-Identifier: MIT
#pragma once
/// @file What the stiffness of a term goes into: bands and points of a linear system.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/term/stiffness.hpp>

#include <cstdint>
#include <type_traits>

namespace fibrant::assembly {

/// What terms add their stiffness to: bands of fibres and pairs of particles.
/// @tparam scaled  bands are multiplied by a factor: terms that act by a mean over a step of time
template <class System, beam::BeamElement B, bool scaled>
struct StiffnessSink {
    System& system;
    const beam::Mesh<B>& mesh;
    const Vector& state;
    [[no_unique_address]] std::conditional_t<scaled, double, core::Inactive> factor{};  ///< on what is added to bands

    void add_diagonal(Index vector, const Mat3& stiffness) {
        if constexpr (scaled)
            system.add_diagonal(vector, Mat3(factor * stiffness));
        else
            system.add_diagonal(vector, stiffness);
    }
    void add_element(Index f, Index e, const double* entries) {
        const Eigen::Map<const beam::ElementMatrix<B>> stiffness(entries);
        if constexpr (scaled)
            system.add(f, e, beam::ElementMatrix<B>(factor * stiffness));
        else
            system.add(f, e, stiffness);
    }
    void add_coupling(const term::CentrePoint& i, const term::CentrePoint& j, const Mat3& stiffness) {
        system.points().push_back({static_cast<std::int32_t>(3 * i.first_vector), static_cast<std::int32_t>(3 * j.first_vector),
                                   static_cast<std::int32_t>(i.fibre), static_cast<std::int32_t>(j.fibre), particle(i),
                                   particle(j), stiffness});
    }
    beam::Particle<B> particle(const term::CentrePoint& at) const {
        if constexpr (beam::TouchedOnCentreline<B>) {
            return B::centre_weights(at.xi);
        } else {
            beam::Particle<B> one = B::particle_weights(at.xi, 0.0, 0.0);
            if constexpr (beam::TurningSections<B>) one.follow(mesh.element(state, at.fibre, at.element));
            return one;
        }
    }
};

}  // namespace fibrant::assembly

// SPDX-License-Identifier: MIT
#pragma once
/// @file The particle of a deformed section that touches: its weights on the nodal vectors, and what its motion stiffens.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/particle.hpp>

#include <algorithm>
#include <cmath>

namespace fibrant::contact {

/// Weights of the particle of a section that lies furthest along a direction in a state.
/// @param first      first unknown of the element that holds u
/// @param direction  unit
/// @param end        the contact is with the rounded end of the fibre
/// @returns radius of the cap that stands for the particle, 0 on the contour; the radius of a beam that is touched on its
///          centreline [length]
template <class B>
double support_weights(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, Index first, const Vec3& direction,
                       bool end, beam::Particle<B>& weights) {
    const double xi = mesh.locate(fibre, u).second;
    if constexpr (beam::CentreTouched<B>) {
        weights = beam::touched_centre<B>(xi);
        return mesh.fibre(fibre).section.radius();
    } else {
        const auto [g_1, g_2] = beam::Mesh<B>::element_directors(state, first, xi);
        const Particle particle = support_particle(mesh.fibre(fibre).section, g_1, g_2, direction, end);
        weights = B::particle_weights(xi, particle.xi_1, particle.xi_2);
        if constexpr (beam::TurningSections<B>) weights.follow(state.segment<beam::Mesh<B>::element_unknowns>(first));
        return particle.cap;
    }
}

/// Second derivative of a gap by the directors of a section: its support distance is convex in them, so this part of the
/// tangent is positive. Without it a section between two contacts would tip over like a pencil on its point.
/// Calls add(first unknown, weights on the nodal vectors, stiffness) of a rank-one term R_N / h (m m^T) (x) N N^T.
/// Nothing where sections keep their shape or feel nothing: what the particle gains by moving around a round section it loses by
/// turning back.
/// @param end  the contact is with the rounded end of the fibre, whose particle is the centre
template <class B, class Add>
void section_stiffness_term([[maybe_unused]] const beam::Mesh<B>& mesh, [[maybe_unused]] const Vector& state,
                            [[maybe_unused]] Index fibre, [[maybe_unused]] double u, [[maybe_unused]] Index first,
                            [[maybe_unused]] const Vec3& normal, [[maybe_unused]] double reaction, [[maybe_unused]] bool end,
                            [[maybe_unused]] const Add& add) {
    if constexpr (beam::DeformableSections<B>) {
        if (reaction == 0.0 || end) return;
        const double xi = mesh.locate(fibre, u).second;
        const beam::ElementWeights<B> w_1 = beam::director_weights<B>(xi, 1), w_2 = beam::director_weights<B>(xi, 2);
        const scene::CrossSection& section = mesh.fibre(fibre).section;
        const double p = section.semi_axis_1 * beam::Mesh<B>::template director<1>(state, first, w_1).dot(normal);
        const double q = section.semi_axis_2 * beam::Mesh<B>::template director<2>(state, first, w_2).dot(normal);
        const double h = std::hypot(p, q);
        if (h < 0.1 * std::min(section.semi_axis_1, section.semi_axis_2)) return;
        beam::ElementWeights<B> weights;
        for (std::size_t a = 0; a < weights.size(); ++a)
            weights[a] = (-section.semi_axis_1 * q * w_1[a] + section.semi_axis_2 * p * w_2[a]) / h;
        add(first, weights, Mat3(reaction / h * normal * normal.transpose()));
    }
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether the sections of all fibres are right side out.

#include <fibrant/beam/mesh.hpp>

#include <optional>
#include <string>
#include <vector>

namespace fibrant::beam {

/// An element that is turned inside out, or all but.
struct InsideOut {
    Index fibre = -1, element = -1;
    double ratio = 0.0;  ///< of det(g_1, g_2, x_0') to that at rest, at the point where it is least [1]
};

/// What is said of a fibre whose sections are flat or inside out.
inline std::string text(const InsideOut& found) {
    return "fibre " + std::to_string(found.fibre) + ", element " + std::to_string(found.element) +
           ": its sections are flat or inside out, with " + core::text(found.ratio) + " of their volume at rest";
}

/// Least det(g_1, g_2, x_0') of an element over that at rest: at its integration points, where the beam says so of itself, else,
/// with directors of unit length, at its ends and its middle [1]. Beams that have no sections: 1.
template <BeamElement B>
double least_volume_ratio([[maybe_unused]] const Mesh<B>& mesh, [[maybe_unused]] const B& beam,
                          [[maybe_unused]] const Vector& state, [[maybe_unused]] Index fibre, [[maybe_unused]] Index element) {
    if constexpr (requires { beam.least_volume_ratio(mesh.rest(fibre, element), mesh.element(state, fibre, element)); }) {
        return beam.least_volume_ratio(mesh.rest(fibre, element), mesh.element(state, fibre, element));
    } else if constexpr (!CentrelineOnly<B> && B::vectors_per_node > 1) {
        double least = 1.0;
        const Index first = mesh.first_unknown(fibre, element);
        for (const double xi : {-1.0, 0.0, 1.0}) {
            const auto [g_1, g_2] = Mesh<B>::element_directors(state, first, xi);
            const Vec3 along = Mesh<B>::centre(state, first, B::centreline_derivative_weights(xi));
            least = std::min(least, g_1.cross(g_2).dot(along) / (0.5 * mesh.fibre(fibre).element_length));
        }
        return least;
    } else {
        return 1.0;
    }
}

/// Of sections that have volume left: below, they are as good as turned inside out [1].
inline constexpr double least_volume = 0.01;

/// The first element with less volume than that, if there is one.
template <BeamElement B>
std::optional<InsideOut> first_inside_out(const Mesh<B>& mesh, const B& beam, const Vector& state) {
    std::vector<InsideOut> worst(core::at(mesh.fibre_count()));
    core::parallel_for(
        mesh.fibre_count(),
        [&](Index f) {
            worst[core::at(f)].ratio = 1.0;
            for (Index e = 0; e < mesh.fibre(f).elements; ++e) {
                const double ratio = least_volume_ratio(mesh, beam, state, f, e);
                if (!(ratio >= worst[core::at(f)].ratio)) worst[core::at(f)] = {f, e, ratio};
            }
        },
        mesh.grain());
    for (const InsideOut& one : worst)
        if (!(one.ratio > least_volume)) return one;
    return {};
}

}  // namespace fibrant::beam

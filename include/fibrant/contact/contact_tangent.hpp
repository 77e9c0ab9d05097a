// SPDX-License-Identifier: MIT
#pragma once
/// @file Direction of a centreline as contact sees it: continuous from element to element.

#include <fibrant/beam/mesh.hpp>

namespace fibrant::contact {

/// Jump of the centreline's derivative by u where element `node` begins and the one before it ends [length]; around a closed
/// fibre `node` may be 0 and the number of elements.
template <class B>
Vec3 kink(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, Index node) noexcept {
    const auto at = [&](Index e, double end) {
        return Vec3(2.0 * beam::Mesh<B>::centre(state, mesh.first_unknown(fibre, e), B::centreline_derivative_weights(end)));
    };
    const Index elements = mesh.fibre(fibre).elements;
    return at(node == elements ? 0 : node, -1.0) - at(node == 0 ? elements - 1 : node - 1, 1.0);
}

/// Derivative of the centreline by u [length], with its jump at a node shared by two elements evened out linearly over both.
///
/// A centreline of quadratic elements has kinks, above all under a point force. In a kink the closest point and the normal
/// are not unique, and contact passes jump between its two sides for ever.
/// @param u  in elements, in [0, elements]
template <class B>
Vec3 contact_tangent(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u) noexcept {
    const auto [element, xi] = mesh.locate(fibre, u);
    Vec3 tangent = 2.0 * beam::Mesh<B>::centre(state, mesh.first_unknown(fibre, element), B::centreline_derivative_weights(xi));
    const bool closed = mesh.fibre(fibre).closed || mesh.fibre(fibre).goes_on;
    if (element > 0 || closed) tangent -= 0.25 * (1.0 - xi) * kink(mesh, state, fibre, element);
    if (element + 1 < mesh.fibre(fibre).elements || closed) tangent += 0.25 * (1.0 + xi) * kink(mesh, state, fibre, element + 1);
    return tangent;
}

/// Unit tangents of the fibres of a pair.
struct PairTangents {
    Vec3 i, j;
};
template <class B, class Element>
PairTangents pair_tangents(const beam::Mesh<B>& mesh, const Vector& state, const Element& element) noexcept {
    return {contact_tangent(mesh, state, element.fibre_i, element.u_i).normalized(),
            contact_tangent(mesh, state, element.fibre_j, element.u_j).normalized()};
}

}  // namespace fibrant::contact

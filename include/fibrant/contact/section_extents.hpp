// SPDX-License-Identifier: MIT
#pragma once
/// @file How the half extent of sections along one direction changes over an element: what a contact point does not see beside
/// it.

#include <fibrant/beam/mesh.hpp>

namespace fibrant::contact {

/// Half extents over an element as a parabola by u in [0, 1] through both ends and the middle [length].
struct ElementExtents {
    double first = 0.0, middle = 0.0, last = 0.0;
    double slope_at_first() const noexcept { return -3.0 * first + 4.0 * middle - last; }
    double slope_at_last() const noexcept { return first - 4.0 * middle + 3.0 * last; }
    double second() const noexcept { return 4.0 * (first - 2.0 * middle + last); }
};

/// Half extents of the sections of an element; all the same, and 0 here, where contact takes the radius at rest or a round
/// section keeps its shape.
/// @param direction  unit
template <class B>
ElementExtents extents_along(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, Index element,
                             const Vec3& direction) noexcept {
    if constexpr (!beam::DeformableSections<B> && !beam::TurningSections<B>) {
        return {};
    } else {
        const scene::CrossSection& section = mesh.fibre(fibre).section;
        const Index first = mesh.first_unknown(fibre, element);
        if constexpr (beam::TurningSections<B>)
            if (section.semi_axis_1 == section.semi_axis_2) return {};
        const auto at = [&](double xi) {
            const auto [g_1, g_2] = beam::Mesh<B>::element_directors(state, first, xi);
            return section.extent(g_1, g_2, direction);
        };
        return {at(-1.0), at(0.0), at(1.0)};
    }
}

/// Jump of their derivative by u where element `node` begins and the one before it ends [length].
/// @param direction  unit
template <class B>
double extent_kink(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, Index node, const Vec3& direction) noexcept {
    const Index elements = mesh.fibre(fibre).elements, begins = node == elements ? 0 : node,
                ends = node == 0 ? elements - 1 : node - 1;
    return extents_along(mesh, state, fibre, begins, direction).slope_at_first() -
           extents_along(mesh, state, fibre, ends, direction).slope_at_last();
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file The normal of a contact element in a state, by what its sections are.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/bore.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/section_gap.hpp>

#include <limits>

namespace fibrant::contact {

/// Whether one of the sections of two fibres is not round, or may be pressed flat.
template <class B>
bool flat_sections(const beam::Mesh<B>& mesh, Index i, Index j) noexcept {
    if constexpr (beam::DeformableSections<B>) return true;
    if constexpr (beam::CentreTouched<B>) return false;
    const auto oval = [&](Index f) { return mesh.fibre(f).section.semi_axis_1 != mesh.fibre(f).section.semi_axis_2; };
    return oval(i) || oval(j);
}

/// Section of a fibre as it stands in a state.
template <class B>
SectionAxes section_axes(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u) noexcept {
    const auto [g_1, g_2] = mesh.directors(state, fibre, u);
    const scene::CrossSection& section = mesh.fibre(fibre).section;
    return {section.semi_axis_1 * g_1, section.semi_axis_2 * g_2};
}

/// Normal of a contact element, from fibre i to fibre j.
/// @param tangents    of the element in that state
/// @param remembered  last normal, or zero for a contact that is new
template <class B, class Element>
Vec3 element_normal(const beam::Mesh<B>& mesh, const Vector& state, const Element& element, const PairTangents& tangents,
                    const NormalRule& rule, const Vec3& remembered) noexcept {
    const Index i = element.fibre_i, j = element.fibre_j;
    if constexpr (requires { element.in_bore(); })
        if (element.in_bore()) return bore_normal(mesh, state, element, tangents, remembered);
    const Vec3 centres = mesh.position(state, j, element.u_j) - mesh.position(state, i, element.u_i);
    if (element.end_i || element.end_j) {
        const Vec3 side = remembered.isZero() ? centres : remembered;
        return unit_or(centres.dot(side) > 0.0 ? centres : side, Vec3::UnitZ());
    }
    const double radii = mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius();
    if (flat_sections(mesh, i, j))
        return normal_direction(rule, centres, tangents.i, tangents.j, remembered,
                                FlatSections{section_axes(mesh, state, i, element.u_i), section_axes(mesh, state, j, element.u_j),
                                             element.crossing, radii});
    return normal_direction(rule, centres, tangents.i, tangents.j, remembered,
                            RoundSections{element.crossing ? std::numeric_limits<double>::infinity() : radii, radii});
}
template <class B, class Element>
Vec3 element_normal(const beam::Mesh<B>& mesh, const Vector& state, const Element& element, const NormalRule& rule,
                    const Vec3& remembered) noexcept {
    return element_normal(mesh, state, element, pair_tangents(mesh, state, element), rule, remembered);
}

}  // namespace fibrant::contact

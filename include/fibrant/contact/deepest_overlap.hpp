// SPDX-License-Identifier: MIT
#pragma once
/// @file Which two fibres are deepest in each other, as contact elements see it, and in words.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/scene/places.hpp>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace fibrant::contact {

/// Where two fibres, or two parts of one, are deepest in each other.
struct Overlap {
    Index fibre_i = -1, fibre_j = -1;  ///< -1: nothing touches
    double u_i = 0.0, u_j = 0.0;       ///< in elements
    double depth = 0.0;                ///< >= 0 [length]
    double radius = 0.0;               ///< of the thinner fibre [length]
    double thinnest = 0.0;             ///< radius of the thinnest fibre that overlaps at all, anywhere [length]
    Vec3 position = Vec3::Zero();      ///< half way between the two axes [length]
};

/// "fibre 3 'core' and fibre 5 are 0.02 deep in each other, 0.4 radii of the thinner one, at (1, 2, 3), in elements 4 and 7".
template <class B>
std::string text(const Overlap& overlap, const beam::Mesh<B>& mesh) {
    if (overlap.fibre_i < 0) return "no two fibres touch";
    const auto element = [&](Index f, double u) { return std::to_string(mesh.locate(f, u).first); };
    const std::string deep = core::text(overlap.depth), radii = core::text(overlap.depth / overlap.radius);
    return (overlap.fibre_i == overlap.fibre_j
                ? mesh.label(overlap.fibre_i) + " is " + deep + " deep in itself"
                : mesh.label(overlap.fibre_i) + " and " + mesh.label(overlap.fibre_j) + " are " + deep + " deep in each other") +
           ", " + radii + " radii of the thinner one, at " + scene::text(overlap.position) + ", in elements " +
           element(overlap.fibre_i, overlap.u_i) + " and " + element(overlap.fibre_j, overlap.u_j);
}

/// The deepest overlap as contact elements that stand see it.
/// @param relative  by the radius of the thinner fibre, not by length
/// @param deep      if not null: gets the fibres that are deeper in another one than `allowed` [length]
template <class Contacts, class B>
Overlap deepest_overlap(const Contacts& contacts, const beam::Mesh<B>& mesh, const Vector& state, bool relative,
                        std::vector<Index>* deep = nullptr, double allowed = 0.0) {
    Overlap deepest;
    double thinnest = std::numeric_limits<double>::infinity();
    for (const auto& element : contacts.elements()) {
        const double depth = -element.gap(state);
        if (!(depth > 0.0)) continue;
        const double radius =
            std::min(mesh.fibre(element.fibre_i).section.radius(), mesh.fibre(element.fibre_j).section.radius());
        thinnest = std::min(thinnest, radius);
        if (deep && depth > allowed) deep->push_back(element.fibre_i), deep->push_back(element.fibre_j);
        const bool deeper = relative ? depth * deepest.radius > deepest.depth * radius : depth > deepest.depth;
        if (deepest.fibre_i >= 0 && !deeper) continue;
        deepest = {element.fibre_i,
                   element.fibre_j,
                   element.u_i,
                   element.u_j,
                   depth,
                   radius,
                   radius,
                   Vec3(0.5 * (mesh.position(state, element.fibre_i, element.u_i) +
                               mesh.position(state, element.fibre_j, element.u_j)))};
    }
    if (deepest.fibre_i >= 0) deepest.thinnest = thinnest;
    return deepest;
}

}  // namespace fibrant::contact

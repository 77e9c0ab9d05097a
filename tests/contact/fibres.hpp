// SPDX-License-Identifier: MIT
#pragma once
/// @file Fibres and meshes of small contact scenes.

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/scene/assembly.hpp>

#include <utility>

namespace fibrant::test {

using Beam = beam::DirectorBeam<3>;
using Mesh = beam::Mesh<Beam>;

inline const scene::ElasticMaterial glass{7300.0, 0.3};  ///< mm, N

/// A straight fibre, round unless given another section.
inline scene::FibreSpecification straight_fibre(const Vec3& from, const Vec3& to, double radius, Index elements) {
    scene::FibreSpecification fibre;
    fibre.from = from, fibre.to = to;
    fibre.section = scene::circular(radius);
    fibre.material = glass;
    fibre.elements = elements;
    return fibre;
}

/// A fibre along a curve.
inline scene::FibreSpecification curved_fibre(scene::Curve curve, double radius, Index elements) {
    scene::FibreSpecification fibre;
    fibre.curve = std::move(curve);
    fibre.section = scene::circular(radius);
    fibre.material = glass;
    fibre.elements = elements;
    return fibre;
}

}  // namespace fibrant::test

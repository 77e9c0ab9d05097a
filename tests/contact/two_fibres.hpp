// SPDX-License-Identifier: MIT
#pragma once
/// @file Two fibres at rest, and a proximity zone of theirs, for tests of the intermediate geometry.

#include "fibres.hpp"

#include <fibrant/proximity/proximity_search.hpp>

#include <vector>

namespace fibrant::test {

inline Mesh mesh_of(const std::vector<scene::FibreSpecification>& fibres) {
    scene::Assembly assembly;
    for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
    return Mesh(assembly, Beam{});
}

/// Zone of the first two fibres, closest in its middle; abscissae in elements.
inline proximity::ProximityZone zone_of(double a_i, double b_i, double a_j, double b_j) {
    proximity::ProximityZone zone;
    zone.fibre_i = 0, zone.fibre_j = 1;
    zone.a_i = a_i, zone.b_i = b_i, zone.a_j = a_j, zone.b_j = b_j;
    zone.closest_i = 0.5 * (a_i + b_i), zone.closest_j = 0.5 * (a_j + b_j);
    return zone;
}

/// From centre to centre of the first two fibres, at abscissae of theirs.
inline double distance(const Mesh& mesh, double u, double v) {
    return (mesh.position(mesh.rest_state(), 1, v) - mesh.position(mesh.rest_state(), 0, u)).norm();
}

}  // namespace fibrant::test

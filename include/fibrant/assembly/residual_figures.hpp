// SPDX-License-Identifier: MIT
#pragma once
/// @file What the residual of a state is measured by, and how much of it is rounding.

#include <fibrant/beam/mesh.hpp>

#include <cmath>
#include <limits>

namespace fibrant::assembly {

/// Residual R = internal - external forces, and what its size is measured by. Norms divide forces on directors by the
/// radius (layout length), so they are forces throughout.
struct ResidualFigures {
    double residual = 0.0;  ///< norm of the free part [force]
    double scale = 0.0;     ///< norm of loads, reactions and contact forces [force]
    double rounding = 0.0;  ///< norm below which a residual is nothing but rounding [force]
    /// 0 where only rounding is left: a fibre that moves freely has no force to compare with.
    double relative() const noexcept { return residual <= rounding ? 0.0 : residual / scale; }
};

/// Norm of a residual that is nothing but rounding [force]: strains keep the digits of coordinates over an element's length, and
/// E A of them is a force at each node.
/// @param extent  of the scene [length]   @param solid  norm of the same forces of solids, over the rounding of 1 [force]
template <beam::BeamElement B>
double rounding_of(const beam::Mesh<B>& mesh, double extent, double solid) {
    constexpr double operations = 8.0;  // whose roundings add up in a force
    double sum = 0.0;
    for (Index f = 0; f < mesh.fibre_count(); ++f) {
        const beam::MeshFibre& fibre = mesh.fibre(f);
        const double digits = extent / fibre.element_length + fibre.element_length / fibre.section.radius();
        const double force = fibre.material.young_modulus * fibre.section.area() * digits;
        sum += static_cast<double>(mesh.node_count(f)) * force * force;
    }
    return operations * std::numeric_limits<double>::epsilon() * std::sqrt(sum + solid * solid);
}

}  // namespace fibrant::assembly

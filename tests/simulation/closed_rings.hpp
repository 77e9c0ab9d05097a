// SPDX-License-Identifier: MIT
#pragma once
/// @file Closed rings for tests, of unit radius and bending stiffness.

#include <support/models.hpp>

#include <cmath>
#include <numbers>

namespace fibrant::test {

inline constexpr double pi = std::numbers::pi;

/// Around z, anticlockwise; its first node is `shift` of its length from the x axis.
struct Ring {
    Index elements = 40;
    double radius = 0.002;  ///< of the fibre
    double shift = 0.0;
    bool straight = false;  ///< at rest
    double twist = 0.0;
    double ellipse = 0.0;  ///< of its radius, with cos 2 theta

    template <beam::BeamElement B>
    scene::FibreSpecification specification() const {
        scene::FibreSpecification fibre{.section = scene::circular(radius),
                                        .material = {.young_modulus = 4.0 / (pi * std::pow(radius, 4)), .poisson_ratio = 0.3},
                                        .elements = elements,
                                        .closed = true,
                                        .twist = twist};
        (straight ? fibre.start : fibre.curve) = [first = shift, e = ellipse](double t) {
            const double a = 2.0 * pi * (t + first);
            return Vec3((1.0 + e * std::cos(2.0 * a)) * Vec3(std::cos(a), std::sin(a), 0.0));
        };
        return fibre;
    }
    /// The node at a share of the way around from the x axis.
    template <beam::BeamElement B>
    scene::Station at(double share) const {
        const double nodes = static_cast<double>(elements * (B::nodes - 1)), place = std::round((share - shift) * nodes) / nodes;
        return {0, place - std::floor(place)};
    }
};

template <class M>
simulation::ModelParameters<M> ring_parameters(const Ring& ring) {
    simulation::ModelParameters<M> parameters;
    parameters.normal.regularisation_depth = 1e-3 * ring.radius;
    parameters.contact.stiffness.allowed_penetration = 1e-2 * ring.radius;
    if constexpr (core::Active<typename M::Friction>)
        parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = 1e-2 * ring.radius};
    parameters.iteration.step_tolerance = 1e-9;
    parameters.iteration.residual_tolerance = 1e-7;
    parameters.iteration.linear_tolerance = 1e-10;
    return parameters;
}

}  // namespace fibrant::test

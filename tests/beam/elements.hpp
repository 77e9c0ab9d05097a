// SPDX-License-Identifier: MIT
#pragma once
/// @file Single elements of the director beam for tests: their rest shapes, and the list of all variants.

#include <fibrant/beam/director_beam.hpp>

#include <Eigen/Geometry>

namespace fibrant::test {

using beam::DirectorBeam;
using beam::DirectorBeamOptions;
using beam::ElasticLaw;
using beam::QuadraticStrain;
using beam::SectionSampling;
using beam::TwistStrain;

template <int Nodes, ElasticLaw Law, SectionSampling Sampling, QuadraticStrain Quadratic, TwistStrain Twist = TwistStrain::metric>
using Variant = DirectorBeam<Nodes, DirectorBeamOptions{Law, Sampling, Quadratic, Twist}>;

#define FIBRANT_VARIANTS_OF(nodes, law)                                         \
    Variant<nodes, law, SectionSampling::nodal, QuadraticStrain::none>,         \
        Variant<nodes, law, SectionSampling::nodal, QuadraticStrain::mean>,     \
        Variant<nodes, law, SectionSampling::nodal, QuadraticStrain::complete>, \
        Variant<nodes, law, SectionSampling::gauss, QuadraticStrain::none>,     \
        Variant<nodes, law, SectionSampling::gauss, QuadraticStrain::mean>,     \
        Variant<nodes, law, SectionSampling::gauss, QuadraticStrain::complete>
/// Of all laws and samplings, and of both numbers of nodes, one each that tells torsion by the turn of sections.
#define FIBRANT_TURN_VARIANTS                                                                            \
    Variant<3, ElasticLaw::split, SectionSampling::nodal, QuadraticStrain::none, TwistStrain::turn>,     \
        Variant<2, ElasticLaw::split, SectionSampling::nodal, QuadraticStrain::mean, TwistStrain::turn>, \
        Variant<3, ElasticLaw::full, SectionSampling::gauss, QuadraticStrain::complete, TwistStrain::turn>
/// All 24 of Green's strain, and those.
#define FIBRANT_ALL_VARIANTS                                                             \
    FIBRANT_VARIANTS_OF(2, ElasticLaw::split), FIBRANT_VARIANTS_OF(2, ElasticLaw::full), \
        FIBRANT_VARIANTS_OF(3, ElasticLaw::split), FIBRANT_VARIANTS_OF(3, ElasticLaw::full), FIBRANT_TURN_VARIANTS

template <class B>
inline constexpr int unknowns = B::nodes* B::dofs_per_node;

/// Straight along z with directors x, y.
template <class B>
beam::ElementVector<B> straight_element(double length) {
    beam::ElementVector<B> y;
    for (int I = 0; I < B::nodes; ++I) {
        y.template segment<9>(9 * I) << 0, 0, length * I / (B::nodes - 1), 1, 0, 0, 0, 1, 0;
    }
    return y;
}

/// Arc in the plane x-z from the origin along z, turning by `angle` towards x; g_2 = y stays, so g_1 does not twist.
/// The whole is turned about an axis of no particular direction.
template <class B>
beam::ElementVector<B> curved_element(double length, double angle) {
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    beam::ElementVector<B> y;
    for (int I = 0; I < B::nodes; ++I) {
        const double t = angle * I / (B::nodes - 1), radius = length / angle;
        const Vec3 x(radius * (1 - std::cos(t)), 0, radius * std::sin(t)), g1(std::cos(t), 0, -std::sin(t));
        y.template segment<9>(9 * I) << turn * x, turn * g1, turn * Vec3::UnitY();
    }
    return y;
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file What every beam element owes, as one function.

#include "../support/random_vector.hpp"

#include <fibrant/beam/beam_element.hpp>
#include <fibrant/core/rotation.hpp>

#include <near.hpp>

#include <Eigen/Geometry>
#include <Eigen/Jacobi>
#include <doctest/doctest.h>

#include <algorithm>
#include <random>

namespace fibrant::test {

/// Largest values met while checking, for the record.
struct ElementErrors {
    double force = 0, tangent = 0, prediction = 0, rotation = 0;
};

/// Strains of the director beam are quadratic in its unknowns; others say so by not being.
template <class B>
inline constexpr bool quadratic_strains = requires {
    B::options;
};
/// The tangent of a cable is a length.
template <class B>
inline constexpr bool tangents_are_lengths = beam::CentrelineOnly<B>;

/// Multiplies unknowns of the same kind: positions by `length`, directors and rotation vectors by 1.
template <beam::BeamElement B>
beam::ElementVector<B> unknown_scale(double length) {
    beam::ElementVector<B> scale;
    for (int v = 0; v < B::nodes * B::vectors_per_node; ++v) {
        const bool position =
            tangents_are_lengths<B> || B::kinds[core::at(v % B::vectors_per_node)] == scene::VectorKind::position;
        scale.template segment<3>(3 * v).setConstant(position ? length : 1.0);
    }
    return scale;
}

/// The configuration turned, then moved; directors are only turned.
template <beam::BeamElement B>
beam::ElementVector<B> moved(const beam::ElementVector<B>& y, const Mat3& rotation, const Vec3& translation) {
    beam::ElementVector<B> image;
    for (int v = 0; v < B::nodes * B::vectors_per_node; ++v) {
        const scene::VectorKind kind = B::kinds[core::at(v % B::vectors_per_node)];
        const Vec3 value = y.template segment<3>(3 * v);
        if (kind == scene::VectorKind::rotation)
            image.template segment<3>(3 * v) = core::rotation_vector(rotation * core::rotation(value));
        else
            image.template segment<3>(3 * v) =
                rotation * value + (kind == scene::VectorKind::position ? translation : Vec3::Zero());
    }
    return image;
}

/// Eigenvalues of a symmetric matrix, ascending, by Jacobi's rotations: small ones keep their digits.
template <int n>
Eigen::Matrix<double, n, 1> symmetric_eigenvalues(Eigen::Matrix<double, n, n> A) {
    const double scale = A.norm();
    for (int sweep = 0; sweep < 50; ++sweep) {
        double off_diagonal = 0.0;
        for (int q = 1; q < n; ++q) {
            for (int p = 0; p < q; ++p) {
                off_diagonal = std::max(off_diagonal, std::abs(A(p, q)));
                if (A(p, q) == 0.0) continue;
                Eigen::JacobiRotation<double> rotation;
                rotation.makeJacobi(A, p, q);
                A.applyOnTheLeft(p, q, rotation.adjoint());
                A.applyOnTheRight(p, q, rotation);
            }
        }
        if (off_diagonal <= 1e-17 * scale) break;
    }
    Eigen::Matrix<double, n, 1> values = A.diagonal();
    std::ranges::sort(values);
    return values;
}

/// Eigenvalues of the stiffness at rest with unknowns made displacements by `length` (section radius), ascending.
template <beam::BeamElement B>
beam::ElementVector<B> rest_modes(const B& beam, const typename B::Rest& rest, const beam::ElementVector<B>& at_rest,
                                  double radius) {
    const beam::ElementVector<B> s = unknown_scale<B>(radius) / radius;
    const beam::ElementMatrix<B> K = s.asDiagonal() * beam.tangent_stiffness(rest, at_rest) * s.asDiagonal();
    return symmetric_eigenvalues<B::nodes * B::dofs_per_node>(K);
}

/// Number of independent rigid motions: six, but for a straight centreline that knows nothing else.
template <beam::BeamElement B>
int rigid_motions(const beam::ElementVector<B>& at_rest, double size) {
    Eigen::Matrix<double, B::nodes * B::dofs_per_node, 6> motions;
    for (int k = 0; k < 6; ++k) {
        const Vec3 axis = Vec3::Unit(k % 3);
        const Mat3 turn = k < 3 ? Mat3(Mat3::Identity()) : Mat3(Eigen::AngleAxisd(1e-6, axis));
        motions.col(k) = (moved<B>(at_rest, turn, k < 3 ? Vec3(1e-6 * size * axis) : Vec3(Vec3::Zero())) - at_rest)
                             .cwiseQuotient(unknown_scale<B>(size)) /
                         1e-6;
    }
    const Eigen::Matrix<double, 6, 1> squares = symmetric_eigenvalues<6>(motions.transpose() * motions);
    return static_cast<int>(std::count_if(squares.begin(), squares.end(), [](double square) { return square > 1e-8; }));
}

/// Checks what an element owes beyond its syntax, on `states` random states around the rest shape.
///
/// @param at_rest  configuration that `rest` was made of
/// @param size     length of the element [length]: positions vary by a fifth of it, directors by 0.2
/// @param radius   of the section [length]
template <beam::BeamElement B>
ElementErrors check_beam_element(const B& beam, const typename B::Rest& rest, const beam::ElementVector<B>& at_rest, double size,
                                 double radius, int states) {
    using Y = beam::ElementVector<B>;
    using K = beam::ElementMatrix<B>;
    const Y scale = unknown_scale<B>(size);
    std::mt19937_64 generator(20240229);
    std::normal_distribution<double> normal;
    const auto random = [&] {
        Y y;
        for (double& component : y) component = normal(generator);
        return y;
    };
    ElementErrors errors;

    // The rest shape is free of stress to the last bit, since strains are made of the displacement.
    CHECK(beam.energy(rest, at_rest) == 0.0);
    CHECK(beam.internal_force(rest, at_rest).isZero(0.0));
    // The rigid motions are without energy, and no other: round-off of the eigenvalues is 1e-16 of the largest.
    const Y modes = rest_modes(beam, rest, at_rest, radius);
    const double largest = modes[modes.size() - 1];
    const int rigid = rigid_motions<B>(at_rest, size);
    CHECK(rigid == (beam::CentrelineOnly<B> ? 5 : 6));
    CHECK(std::max(std::abs(modes[0]), std::abs(modes[rigid - 1])) < 1e-14 * largest);  // ascending
    CHECK(modes[rigid] > 1e-4 * largest);

    for (int state = 0; state < states; ++state) {
        CAPTURE(state);
        const Y y = at_rest + 0.2 * scale.cwiseProduct(random());
        const double energy = beam.energy(rest, y);
        const Y force = scale.cwiseProduct(beam.internal_force(rest, y));
        const K tangent = scale.asDiagonal() * beam.tangent_stiffness(rest, y) * scale.asDiagonal();
        REQUIRE(energy > 0.0);

        // The energy is of degree 4 in the unknowns: a central difference with the relative step 1e-5 errs by about
        // 1e-10 of the largest entry where stiffness changes by 1 for a step of 1, and 1e-16/1e-5 = 1e-11 is round-off;
        // both grow where terms of opposite sign meet.
        const double h = 1e-5;
        Y difference;
        K slope;
        for (int k = 0; k < y.size(); ++k) {
            Y ahead = y, behind = y;
            ahead[k] += h * scale[k];
            behind[k] -= h * scale[k];
            difference[k] = (beam.energy(rest, ahead) - beam.energy(rest, behind)) / (2.0 * h);
            slope.col(k) = scale.cwiseProduct(beam.internal_force(rest, ahead) - beam.internal_force(rest, behind)) / (2.0 * h);
        }
        const double of_force = (difference - force).norm() / force.norm();
        const double of_tangent = (slope - tangent).norm() / tangent.norm();
        CHECK(of_force < 1e-6);
        CHECK(of_tangent < 1e-6);
        CHECK((tangent - tangent.transpose()).norm() < 1e-14 * tangent.norm());
        errors.force = std::max(errors.force, of_force);
        errors.tangent = std::max(errors.tangent, of_tangent);

        // One call for both gives the same.
        Y force_too;
        K tangent_too;
        const typename B::Stresses stresses = beam.stresses(rest, y);
        beam.residual_and_tangent(rest, y, stresses, force_too, tangent_too);
        // To round-off: a compiler may fuse products in one of two copies of the same lines.
        const Y force_scaled = scale.cwiseProduct(force_too);
        const K tangent_scaled = scale.asDiagonal() * tangent_too * scale.asDiagonal();
        const K tangent_given = scale.asDiagonal() * beam.tangent_stiffness(rest, y, stresses) * scale.asDiagonal();
        CHECK((force_scaled - force).norm() < 1e-14 * force.norm());
        CHECK((tangent_scaled - tangent).norm() < 1e-14 * tangent.norm());
        CHECK((tangent_given - tangent).norm() < 1e-14 * tangent.norm());

        // A rigid motion leaves the energy: strains of the order of 0.1 keep 15 of 16 digits.
        const Vec3 axis = test::random_vector(normal, generator).normalized();
        const Mat3 rotation = Eigen::AngleAxisd(2.0 * normal(generator), axis).toRotationMatrix();
        const double turned = beam.energy(rest, moved<B>(y, rotation, size * axis));
        errors.rotation = std::max(errors.rotation, std::abs(turned - energy) / energy);
        CHECK(std::abs(turned - energy) < 1e-12 * energy);

        // Predicted stresses: without a step those of the state, and right to first order: as the step halves, the
        // error (strains are quadratic) is a quarter; checked through the geometric stiffness they cause.
        const K exact = scale.asDiagonal() * beam.tangent_stiffness(rest, y, stresses) * scale.asDiagonal();
        const K still = scale.asDiagonal() * beam.tangent_stiffness(rest, y, beam.predicted_stresses(rest, y, Y::Zero())) *
                        scale.asDiagonal();
        CHECK((still - exact).norm() <= 1e-14 * exact.norm());
        const Y direction = scale.cwiseProduct(random());
        double error[2], change = 0.0;
        for (int half = 0; half < 2; ++half) {
            const Y step = (half == 0 ? 1e-3 : 5e-4) * direction;
            const K predicted = beam.tangent_stiffness(rest, y, beam.predicted_stresses(rest, y, step));
            const K reached = beam.tangent_stiffness(rest, y, beam.stresses(rest, y + step));
            error[half] = (scale.asDiagonal() * (predicted - reached) * scale.asDiagonal()).norm();
            change = (scale.asDiagonal() * (reached - tangent_too) * scale.asDiagonal()).norm();
        }
        CHECK(error[1] < (quadratic_strains<B> ? 0.02 : 0.05) * change);  // step 5e-4 against strains of 0.1
        // Exactly so where strains are quadratic; elsewhere but for terms of third order.
        CHECK(error[1] / error[0] == test::near(0.25, quadratic_strains<B> ? 1e-6 : 2e-2));
        errors.prediction = std::max(errors.prediction, error[1] / change);

        // With tension alone the geometric part takes nothing from the material part.
        const typename B::Stresses tension = B::without_compression(stresses);
        const K part = scale.asDiagonal() *
                       (beam.tangent_stiffness(rest, y, tension) - beam.tangent_stiffness(rest, y, typename B::Stresses{})) *
                       scale.asDiagonal();
        CHECK(symmetric_eigenvalues<B::nodes * B::dofs_per_node>(part)[0] >= -1e-13 * tangent.norm());
    }
    return errors;
}

}  // namespace fibrant::test

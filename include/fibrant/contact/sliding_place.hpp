// SPDX-License-Identifier: MIT
#pragma once
/// @file The place of a crossing as a function of the state: the force, and the tangent, of the energy of the gap between two patches.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace fibrant::contact {

/// The second variation of the distance of two centrelines by arc lengths, times that distance, that tangents count with at least: bent around
/// each other any tighter, they touch along a line [1].
inline constexpr double least_closeness = 0.02;

/// One side of a followed crossing, by the nodal vectors that its patch averages.
template <class B>
struct PatchSide {
    static constexpr std::size_t most = static_cast<std::size_t>((2 * (B::nodes - 1) + 1) * B::vectors_per_node);
    using Weights = std::array<double, most>;
    std::array<Index, most> vectors{};  ///< of the mesh; of a closed fibre's last node those of its first
    std::size_t count = 0;   ///< of them
    Weights place{};         ///< of the centreline [1]
    Weights slope{};         ///< of the unit tangent's turns [1 / length]
    Weights press{};         ///< of the mean section's particle that lies furthest along the normal
    Weights flatten{};       ///< of what stiffens it: section_stiffness_term
    double extent = 0.0;     ///< of that section along the normal [length]
    double hardening = 0.0;  ///< over the reaction, of `flatten` [1 / length]
};

/// @param normal  from this fibre to the other one
template <class B>
PatchSide<B> patch_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, double half, double speed, const Vec3& normal) noexcept {
    constexpr Index step = beam::Mesh<B>::vectors_per_element_step;
    const Patches<B> patches(mesh, state);
    const Index low = patches.located(fibre, u - half).first, high = patches.located(fibre, u + half).first;
    PatchSide<B> side;
    side.count = core::at((high - low) * step + B::nodes * B::vectors_per_node);
    const Index first = low * (B::nodes - 1), own = mesh.own_nodes(fibre);
    for (Index a = 0; a < core::count(side.vectors); ++a) {
        const Index node = first + a / B::vectors_per_node;
        side.vectors[core::at(a)] = mesh.node_vector(fibre, (node % own + own) % own, a % B::vectors_per_node);
    }
    const auto add = [&](typename PatchSide<B>::Weights& to, Index e, double factor, const auto& of) {
        for (std::size_t a = 0; a < of.size(); ++a) to[core::at((e - low) * step) + a] += factor * of[a];
    };
    patches.each_sample(fibre, u, half, [&](Index e, double xi, double weight) { add(side.place, e, weight, B::centreline_weights(xi)); });
    for (const double end : {-1.0, 1.0}) {
        const auto [e, xi] = patches.located(fibre, u + end * half);
        add(side.slope, e, end / (2.0 * half * speed), B::centreline_weights(xi));
    }
    side.press = side.place;
    side.extent = mesh.fibre(fibre).section.radius();
    if constexpr (beam::DeformableSections<B>) {
        typename PatchSide<B>::Weights g_1{}, g_2{};
        patches.each_sample(fibre, u, half, [&](Index e, double xi, double weight) {
            add(g_1, e, weight, beam::director_weights<B>(xi, 1));
            add(g_2, e, weight, beam::director_weights<B>(xi, 2));
        });
        const auto sum = [&](const typename PatchSide<B>::Weights& weights) {
            Vec3 total = Vec3::Zero();
            for (std::size_t a = 0; a < side.count; ++a) total += weights[a] * state.segment<3>(3 * side.vectors[a]);
            return total;
        };
        const scene::CrossSection& section = mesh.fibre(fibre).section;
        const double p = section.semi_axis_1 * sum(g_1).dot(normal), q = section.semi_axis_2 * sum(g_2).dot(normal), h = std::hypot(p, q);
        if (h >= 0.1 * section.radius()) {
            side.extent = h;
            side.hardening = 1.0 / h;
            for (std::size_t a = 0; a < side.count; ++a) {
                side.press[a] += (section.semi_axis_1 * p * g_1[a] + section.semi_axis_2 * q * g_2[a]) / h;
                side.flatten[a] = (-section.semi_axis_1 * q * g_1[a] + section.semi_axis_2 * p * g_2[a]) / h;
            }
        }
    }
    return side;
}

/// A followed crossing in a state: where it pushes, and how its gap bends with the nodal vectors of both sides.
///
/// With the points sliding along and the normal turning, the second derivative of a distance d is that of four numbers y: the motion x of
/// point j less that of point i along two directions across the normal, then the turns tau of tangents i and j towards the normal times d. With t unit tangents in
/// the plane of the two directions and M the second derivatives of half the square of the distance by the arc lengths, it is (x . x - b^T M^-1 b) / d
/// with b = (-(t_i . x + tau_i), t_j . x + tau_j). For straight lines M takes away all of x . x: only where they bend does a crossing that
/// slides aside sink or rise, which holds loops that hang in each other.
template <class B>
struct SlidingPlace {
    PatchSide<B> i, j;
    double gap = 0.0;                                         ///< [length]
    double distance = 0.0;                                    ///< d [length]
    Eigen::Matrix4d curvature = Eigen::Matrix4d::Zero();      ///< of y, for d [1 / length]
};

/// @param normal  from i to j, across both centrelines
template <class B>
SlidingPlace<B> sliding_place(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j, const Vec3& normal) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    SlidingPlace<B> place;
    place.i = patch_side(mesh, state, i, u_i, half_of_patch(mesh, i, j, i), pair.speed_i, normal);
    place.j = patch_side(mesh, state, j, u_j, half_of_patch(mesh, i, j, j), pair.speed_j, Vec3(-normal));
    place.gap = pair.centres.dot(normal) - place.i.extent - place.j.extent;
    place.distance = std::max(std::abs(pair.centres.dot(normal)), 0.1 * (place.i.extent + place.j.extent));
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    Eigen::Matrix<double, 2, 4> b;
    b << -pair.t_i.dot(along), -pair.t_i.dot(across), -1.0, 0.0, pair.t_j.dot(along), pair.t_j.dot(across), 0.0, 1.0;
    Eigen::Matrix2d slack = raised(pair.closeness, least_closeness).inverse();
    // What is at an end of its fibre does not slide.
    const bool held_i = u_i <= mesh.bounds(i).first || u_i >= mesh.bounds(i).second;
    const bool held_j = u_j <= mesh.bounds(j).first || u_j >= mesh.bounds(j).second;
    if (held_i || held_j) slack.setZero();
    if (held_i && !held_j) slack(1, 1) = 1.0 / std::max(pair.closeness(1, 1), least_closeness);
    if (held_j && !held_i) slack(0, 0) = 1.0 / std::max(pair.closeness(0, 0), least_closeness);
    place.curvature = -b.transpose() * slack * b;
    place.curvature(0, 0) += 1.0, place.curvature(1, 1) += 1.0;
    place.curvature /= place.distance;
    return place;
}

/// Adds forces on the vectors that a side averages.
template <class B>
void spread(const PatchSide<B>& side, const Vec3& value, Vector& forces) noexcept {
    for (std::size_t a = 0; a < side.count; ++a) forces.segment<3>(3 * side.vectors[a]) += side.press[a] * value;
}

/// Stiffness of a followed crossing: rows^T stiffness rows.
struct SlidingStiffness {
    std::vector<Index> vectors;  ///< 3-vectors of unknowns, each once
    Matrix rows;                 ///< by the unknowns of these
    Matrix stiffness;            ///< symmetric
};

/// @param positive  without the negative part of what the curvature of the gap makes of the reaction
template <class B>
SlidingStiffness sliding_stiffness(const SlidingPlace<B>& place, const Vec3& normal, double reaction, double slope, bool positive) {
    constexpr Index rows = beam::DeformableSections<B> ? 7 : 5;
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    SlidingStiffness sum{{}, Matrix::Zero(rows, 3 * static_cast<Index>(place.i.count + place.j.count)), Matrix::Zero(rows, rows)};
    const auto fill = [&](const PatchSide<B>& side, double sign, Index turn) {
        for (std::size_t a = 0; a < side.count; ++a) {
            const Index column = 3 * core::count(sum.vectors);
            sum.vectors.push_back(side.vectors[a]);
            sum.rows.block<1, 3>(0, column) = sign * side.press[a] * normal.transpose();
            sum.rows.block<1, 3>(1, column) = sign * side.place[a] * along.transpose();
            sum.rows.block<1, 3>(2, column) = sign * side.place[a] * across.transpose();
            sum.rows.block<1, 3>(turn, column) = place.distance * side.slope[a] * normal.transpose();
            if constexpr (rows == 7) sum.rows.block<1, 3>(turn + 2, column) = side.flatten[a] * normal.transpose();
        }
    };
    fill(place.i, -1.0, 3), fill(place.j, 1.0, 4);
    sum.stiffness(0, 0) = -slope;
    Eigen::Matrix4d form = -reaction * place.curvature;
    if (positive) form = core::SymmetricEigen<4>(form).raised(0.0);
    sum.stiffness.block<4, 4>(1, 1) = form;
    if constexpr (rows == 7) sum.stiffness(5, 5) = reaction * place.i.hardening, sum.stiffness(6, 6) = reaction * place.j.hardening;
    return sum;
}

}  // namespace fibrant::contact

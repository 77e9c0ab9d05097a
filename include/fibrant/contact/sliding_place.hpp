// SPDX-License-Identifier: MIT
#pragma once
/// @file The place of a crossing as a function of the state: the force, and the tangent, of the energy of the gap between two patches.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/contact/normal_direction.hpp>
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
    static constexpr std::size_t most = static_cast<std::size_t>((3 * (B::nodes - 1) + 1) * B::vectors_per_node);  // two patches less than an element apart
    using Weights = std::array<double, most>;
    std::array<Index, most> vectors{};  ///< of the mesh; of a closed fibre's last node those of its first
    std::size_t count = 0;   ///< of them
    Weights place{};         ///< of the centreline [1]
    Weights slope{};         ///< of the unit tangent's turns [1 / length]
    Weights press{};         ///< of the mean section's particle that lies furthest across, less those of the centreline
    Weights flatten{};       ///< of what stiffens it: section_stiffness_term
    Vec3 across = Vec3::Zero();  ///< direction in which the section faces the other fibre, unit
    double extent = 0.0;     ///< of the section across [length]
    double hardening = 0.0;  ///< over the reaction, of `flatten` [1 / length]
};

/// Where the section of a followed place is taken, and the direction in which it faces the other fibre: both stand while the place slides. A reaction
/// presses flat what it rests on, and a place that went to where sections are less flat would flee from its own force.
struct StandingSection {
    double u = 0.0;              ///< abscissa, less than an element from the place
    Vec3 across = Vec3::Zero();  ///< unit, in the section
};

/// @param normal  from this fibre to the other one, unit
template <class B>
StandingSection standing_section(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, double half, const Vec3& normal) noexcept {
    const Vec3 tangent = Patches<B>(mesh, state).tangent(fibre, u, half).normalized();
    return {u, unit_or(normal - normal.dot(tangent) * tangent, normal)};  // the gap is that of surfaces, which a normal that leans does not cut straight
}

template <class B>
PatchSide<B> patch_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const StandingSection& section_at, double half,
                        double speed) noexcept {
    constexpr Index step = beam::Mesh<B>::vectors_per_element_step;
    const Patches<B> patches(mesh, state);
    const auto [least, most] = std::minmax(u, section_at.u);
    const Index low = patches.located(fibre, least - half).first, high = patches.located(fibre, most + half).first;
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
    side.extent = mesh.fibre(fibre).section.radius();
    if constexpr (beam::DeformableSections<B>) {
        typename PatchSide<B>::Weights g_1{}, g_2{};
        patches.each_sample(fibre, section_at.u, half, [&](Index e, double xi, double weight) {
            add(g_1, e, weight, beam::director_weights<B>(xi, 1));
            add(g_2, e, weight, beam::director_weights<B>(xi, 2));
        });
        const auto sum = [&](const typename PatchSide<B>::Weights& weights) {
            Vec3 total = Vec3::Zero();
            for (std::size_t a = 0; a < side.count; ++a) total += weights[a] * state.segment<3>(3 * side.vectors[a]);
            return total;
        };
        const scene::CrossSection& section = mesh.fibre(fibre).section;
        const Vec3& across = section_at.across;
        const double p = section.semi_axis_1 * sum(g_1).dot(across), q = section.semi_axis_2 * sum(g_2).dot(across), h = std::hypot(p, q);
        if (h >= 0.1 * section.radius()) {
            side.extent = h, side.across = across;
            side.hardening = 1.0 / h;
            for (std::size_t a = 0; a < side.count; ++a) {
                side.press[a] = (section.semi_axis_1 * p * g_1[a] + section.semi_axis_2 * q * g_2[a]) / h;
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
/// the plane of the two directions and M the second derivatives of half the square of the distance by the arc lengths, it is (x . x - b^T S b) / d
/// with b = (-(t_i . x + tau_i), t_j . x + tau_j) and S the inverse of M, or of its part in the direction in which the place may slide. For straight
/// lines M takes away all of x . x: only where they bend does a crossing that slides aside sink or rise, which holds loops that hang in each other.
template <class B>
struct SlidingPlace {
    PatchSide<B> i, j;
    double gap = 0.0;                                     ///< [length]
    double distance = 0.0;                                ///< d [length]
    Eigen::Matrix4d curvature = Eigen::Matrix4d::Zero();  ///< of y, for d [1 / length]
};

/// @param at_i, at_j  sections that stand
/// @param normal      from i to j, along the line of both centres
template <class B>
SlidingPlace<B> sliding_place(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j, const StandingSection& at_i,
                              const StandingSection& at_j, const Vec3& normal, const Slide& slide = {}) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    SlidingPlace<B> place;
    place.i = patch_side(mesh, state, i, u_i, at_i, half_of_patch(mesh, i, j, i), pair.speed_i);
    place.j = patch_side(mesh, state, j, u_j, at_j, half_of_patch(mesh, i, j, j), pair.speed_j);
    place.gap = pair.centres.dot(normal) - place.i.extent - place.j.extent;
    place.distance = std::max(std::abs(pair.centres.dot(normal)), 0.1 * (place.i.extent + place.j.extent));
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    Eigen::Matrix<double, 2, 4> b;
    b << -pair.t_i.dot(along), -pair.t_i.dot(across), -1.0, 0.0, pair.t_j.dot(along), pair.t_j.dot(across), 0.0, 1.0;
    Eigen::Matrix2d slack = slide.slack(pair, least_closeness);
    // What is at an end of its fibre does not slide.
    const bool held_i = u_i <= mesh.bounds(i).first || u_i >= mesh.bounds(i).second;
    const bool held_j = u_j <= mesh.bounds(j).first || u_j >= mesh.bounds(j).second;
    if (held_i || held_j) slack.setZero();
    if (slide.kind == Slide::freely && held_i && !held_j) slack(1, 1) = 1.0 / std::max(pair.closeness(1, 1), least_closeness);
    if (slide.kind == Slide::freely && held_j && !held_i) slack(0, 0) = 1.0 / std::max(pair.closeness(0, 0), least_closeness);
    place.curvature = -b.transpose() * slack * b;
    place.curvature(0, 0) += 1.0, place.curvature(1, 1) += 1.0;
    place.curvature /= place.distance;
    return place;
}

/// Derivative of a gap by a nodal vector of one of its sides.
/// @param sign  -1 for side i, 1 for side j
template <class B>
Vec3 gap_gradient(const SlidingPlace<B>& place, const Vec3& normal, double sign, std::size_t a) noexcept {
    const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
    return sign * side.place[a] * normal - side.press[a] * side.across;
}

/// Adds the forces of a reaction on the vectors that a side averages, of internal minus external ones.
template <class B>
void spread(const SlidingPlace<B>& place, const Vec3& normal, double sign, double reaction, Vector& forces) noexcept {
    const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
    for (std::size_t a = 0; a < side.count; ++a) forces.segment<3>(3 * side.vectors[a]) -= reaction * gap_gradient(place, normal, sign, a);
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
            sum.rows.block<1, 3>(0, column) = gap_gradient(place, normal, sign, a).transpose();
            sum.rows.block<1, 3>(1, column) = sign * side.place[a] * along.transpose();
            sum.rows.block<1, 3>(2, column) = sign * side.place[a] * across.transpose();
            sum.rows.block<1, 3>(turn, column) = place.distance * side.slope[a] * normal.transpose();
            if constexpr (rows == 7) sum.rows.block<1, 3>(turn + 2, column) = side.flatten[a] * side.across.transpose();
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

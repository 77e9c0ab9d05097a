// SPDX-License-Identifier: MIT
#pragma once
/// @file The place of a crossing of fibres whose sections are not round, as a function of the state: the saddle point of their true gap.

#include <fibrant/contact/sliding_place.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fibrant::contact {

/// A section that stands while a place slides, as the normal of a pair sees it. With c the components of the normal along the directors its half extent
/// is |A c| over the part of the normal that lies in the section: the surface of a fibre knows nothing of a normal that leans along it.
struct SeenSection {
    std::array<Vec3, 2> directors;
    Vec3 out = Vec3::Zero();                            ///< its normal, unit
    Eigen::Vector2d c, particle;                        ///< normal along the directors; material coordinates of the particle furthest along it [length]
    Eigen::Vector2d line = Eigen::Vector2d::Zero();     ///< of the material that lies along the normal
    Vec3 furthest, turning;                             ///< that particle from the centre [length]; how c turns in the section with the normal [1]
    double extent = 0.0, bend = 0.0, tilt = 0.0;        ///< |A c| [length]; a^2 b^2 / |A c|^3 [length]; cosine of `out` and the normal [1]

    SeenSection(const std::array<Vec3, 2>& of, const scene::CrossSection& section, const Vec3& normal) noexcept : directors{of} {
        const double a = section.semi_axis_1, b = section.semi_axis_2;
        const Vec3 &g_1 = directors[0], &g_2 = directors[1];
        c = {g_1.dot(normal), g_2.dot(normal)};
        extent = std::max(std::hypot(a * c[0], b * c[1]), 0.01 * std::min(a, b));  // seen along its fibre it has none
        particle = Eigen::Vector2d(a * a * c[0], b * b * c[1]) / extent;
        bend = a * a * b * b / (extent * extent * extent);
        furthest = particle[0] * g_1 + particle[1] * g_2, turning = c[0] * g_2 - c[1] * g_1;
        out = g_1.cross(g_2).normalized(), tilt = out.dot(normal);
        const double c_11 = g_1.dot(g_1), c_12 = g_1.dot(g_2), c_22 = g_2.dot(g_2), determinant = c_11 * c_22 - c_12 * c_12;
        line = Eigen::Vector2d(c_22 * c[0] - c_12 * c[1], c_11 * c[1] - c_12 * c[0]) / determinant;
    }
    double half() const noexcept { return extent * (1.0 + 0.5 * tilt * tilt); }
    Vec3 slope() const noexcept { return furthest + extent * tilt * out; }  ///< of `half` by the normal [length]
};

/// Gap of two fibres at two places along a normal, G = n . (x_j - x_i) - h_i(n) - h_j(n), and its derivatives by both and by arc lengths.
struct OvalGap {
    Vec3 normal, e, f;       ///< unit, across each other
    SeenSection i, j;
    double gap, distance;    ///< G; n . (x_j - x_i), at least a part of both extents [length]
    Eigen::Vector2d by_normal;   ///< along e and f [length]
    Eigen::Matrix2d flat;        ///< minus the second derivative by the normal, positive [length]
    Eigen::Vector2d by_arc;      ///< [1]
    Eigen::Matrix2d mixed;       ///< by the normal, and by both arc lengths [1]
    Eigen::Matrix2d closeness;   ///< second derivatives by both arc lengths with the normal turning, times the distance [1]

    OvalGap(const PairGeometry& pair, const SeenSection& of_i, const SeenSection& of_j, const Vec3& n) noexcept
        : normal{n}, e{n.unitOrthogonal()}, f{n.cross(e)}, i{of_i}, j{of_j} {
        const double along = pair.centres.dot(n);
        gap = along - i.half() - j.half();
        distance = std::max(along, 0.1 * (i.extent + j.extent));
        const Vec3 off = pair.centres - i.slope() - j.slope();
        by_normal = {off.dot(e), off.dot(f)};
        flat = (along - i.extent - j.extent) * Eigen::Matrix2d::Identity();
        for (const SeenSection* section : {&i, &j}) {
            const Eigen::Vector2d turning = across(section->turning), out = across(section->out);
            flat += section->bend * turning * turning.transpose() + section->extent * out * out.transpose();
        }
        flat = raised(flat, 0.1 * distance);
        by_arc = {-n.dot(pair.t_i), n.dot(pair.t_j)};
        mixed.col(0) = -across(pair.t_i), mixed.col(1) = across(pair.t_j);
        closeness = distance * mixed.transpose() * flat.inverse() * mixed;
        closeness(0, 0) -= distance * n.dot(pair.bend_i), closeness(1, 1) += distance * n.dot(pair.bend_j);
    }
    Eigen::Vector2d across(const Vec3& vector) const noexcept { return {vector.dot(e), vector.dot(f)}; }
};

/// Means of the directors of both sections that stand.
template <class B>
std::array<std::array<Vec3, 2>, 2> standing_directors(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, const StandingSection& at_i, const StandingSection& at_j) noexcept {
    return {mean_directors(mesh, state, i, at_i.u, half_of_patch(mesh, i, j, i)), mean_directors(mesh, state, j, at_j.u, half_of_patch(mesh, i, j, j))};
}

template <class B>
PatchSide<B> oval_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const StandingSection& section_at, double half, double speed,
                       const SeenSection& seen, const Vec3& normal) noexcept {
    return line_side(mesh, state, fibre, u, section_at, half, speed, [&](PatchSide<B>& side, const auto& g_1, const auto& g_2) {
        side.extent = seen.extent, side.across = side.aside = normal, side.out = seen.out, side.tilt = seen.extent * seen.tilt;
        for (std::size_t a = 0; a < side.count; ++a) {
            side.press[a] = seen.particle[0] * g_1[a] + seen.particle[1] * g_2[a];
            side.beside[a] = seen.c[0] * g_2[a] - seen.c[1] * g_1[a];
            side.lean[a] = seen.line[0] * g_1[a] + seen.line[1] * g_2[a];
        }
    });
}

/// Moves a pair of places to where the gap is least along its fibres and greatest among normals, from nearby, by Newton's method.
/// @param normal  from i to j; in: of the side that they are on
template <class B>
void follow_oval(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, const StandingSection& at_i, const StandingSection& at_j, double& u_i, double& u_j,
                 Vec3& normal) noexcept {
    const auto directors = standing_directors(mesh, state, i, j, at_i, at_j);
    const scene::CrossSection &section_i = mesh.fibre(i).section, &section_j = mesh.fibre(j).section;
    const Vec3 side = normal;
    bool first = true;
    follow_steps(mesh, state, i, j, u_i, u_j, [&](const PairGeometry& pair) {
        if (const Vec3 crossing = pair.t_i.cross(pair.t_j); first && crossing.norm() > 0.1) normal = crossing.dot(side) < 0.0 ? Vec3(-crossing.normalized()) : Vec3(crossing.normalized());
        first = false;
        const OvalGap gap(pair, SeenSection(directors[0], section_i, normal), SeenSection(directors[1], section_j, normal), normal);
        const Eigen::Matrix2d flatter = gap.flat.inverse();
        const Eigen::Vector2d arcs = -gap.distance * (raised(gap.closeness, least_of_steps).inverse() * (gap.by_arc + gap.mixed.transpose() * flatter * gap.by_normal));
        Eigen::Vector2d turn = flatter * (gap.by_normal + gap.mixed * arcs);
        const double most_turn = 0.3;
        if (const double size = turn.norm(); size > most_turn) turn *= most_turn / size;
        normal = (normal + turn[0] * gap.e + turn[1] * gap.f).normalized();
        return std::pair{arcs[0] / pair.speed_i, arcs[1] / pair.speed_j};
    });
}

/// A followed crossing of sections that are not round.
///
/// By the theorem of the envelope its force is that of the particles that are furthest along the normal. The gap's second derivative is that with places and normal
/// held, less what both take: with y these four and q the state, G_qq - G_qy G_yy^-1 G_yq. It is a form of twelve numbers: the motion of centre j less that of
/// centre i across the normal (2), the turns of both tangents towards it (2), and of each section the motion of its furthest particle across the normal (2), the turn
/// in its plane, and that of its material along the normal out of its plane.
/// @param normal  that of follow_oval
template <class B>
SlidingPlace<B> oval_place(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j, const StandingSection& at_i, const StandingSection& at_j,
                           const Vec3& normal) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    const auto directors = standing_directors(mesh, state, i, j, at_i, at_j);
    const OvalGap gap(pair, SeenSection(directors[0], mesh.fibre(i).section, normal), SeenSection(directors[1], mesh.fibre(j).section, normal), normal);
    SlidingPlace<B> place;
    place.oval = true, place.gap = gap.gap, place.distance = gap.distance;
    place.i = oval_side(mesh, state, i, u_i, at_i, half_of_patch(mesh, i, j, i), pair.speed_i, gap.i, normal);
    place.j = oval_side(mesh, state, j, u_j, at_j, half_of_patch(mesh, i, j, j), pair.speed_j, gap.j, normal);
    Eigen::Matrix<double, 2, 12> by_normal = Eigen::Matrix<double, 2, 12>::Zero(), by_arc = by_normal;
    place.bending.setZero();
    by_normal(0, 0) = by_normal(1, 1) = 1.0;
    by_arc(0, 2) = -1.0, by_arc(1, 3) = 1.0;
    for (const auto& [first, section] : {std::pair<Index, const SeenSection*>{4, &gap.i}, {8, &gap.j}}) {
        by_normal.template block<2, 2>(0, first) = -Eigen::Matrix2d::Identity();
        by_normal.col(first + 2) = -section->bend * gap.across(section->turning), by_normal.col(first + 3) = section->extent * gap.across(section->out);
        place.bending(first + 2, first + 2) = -section->bend, place.bending(first + 3, first + 3) = -section->extent;
    }
    const Eigen::Matrix2d flatter = gap.flat.inverse();
    by_arc += gap.mixed.transpose() * flatter * by_normal;
    place.bending += by_normal.transpose() * flatter * by_normal;
    const bool held_i = u_i <= mesh.bounds(i).first || u_i >= mesh.bounds(i).second;
    const bool held_j = u_j <= mesh.bounds(j).first || u_j >= mesh.bounds(j).second;
    const Eigen::Matrix2d slack = held_i || held_j ? Eigen::Matrix2d(Eigen::Matrix2d::Zero()) : Eigen::Matrix2d(raised(gap.closeness, least_closeness).inverse());
    place.bending -= gap.distance * by_arc.transpose() * slack * by_arc;
    return place;
}

/// Its stiffness.
/// @param positive  without the negative part of what the curvature of the gap makes of the reaction
template <class B>
SlidingStiffness oval_stiffness(const SlidingPlace<B>& place, const Vec3& normal, double reaction, double slope, bool positive) {
    const Vec3 e = normal.unitOrthogonal(), f = normal.cross(e);
    SlidingStiffness sum{{}, Matrix::Zero(13, 3 * static_cast<Index>(place.i.count + place.j.count)), Matrix::Zero(13, 13)};
    for (const double sign : {-1.0, 1.0}) {
        const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
        const Index turn = sign < 0.0 ? 3 : 4, section = sign < 0.0 ? 5 : 9;
        for (std::size_t a = 0; a < side.count; ++a) {
            const Index column = 3 * core::count(sum.vectors);
            sum.vectors.push_back(side.vectors[a]);
            const auto row = [&](Index at, const Vec3& value) { sum.rows.block<1, 3>(at, column) = value.transpose(); };
            row(0, gap_gradient(place, normal, sign, a));
            row(1, sign * side.place[a] * e), row(2, sign * side.place[a] * f);
            row(turn, side.slope[a] * normal);
            row(section, side.press[a] * e), row(section + 1, side.press[a] * f), row(section + 2, side.beside[a] * normal), row(section + 3, side.lean[a] * side.out);
        }
    }
    sum.stiffness(0, 0) = -slope;
    Eigen::Matrix<double, 12, 12> form = -reaction * place.bending;
    if (positive) form = core::SymmetricEigen<12>(form).raised(0.0);
    sum.stiffness.block<12, 12>(1, 1) = form;
    return sum;
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file The place of a crossing of fibres whose sections are not round, as a function of the state: the saddle point of their
/// true gap.

#include <fibrant/contact/sliding_place.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

namespace fibrant::contact {

// What computes here is a template throughout: a program whose model is in the compiled library does not pay for it.

/// A section that stands while a place slides, as the normal of a pair sees it. With c the components of the normal along the
/// directors its half extent is h = |A c| / s, s the part of the normal that lies in the section: the surface of a fibre knows
/// nothing of a normal that leans along it.
struct SeenSection {
    Vec3 out = Vec3::Zero();                         ///< normal of the section, unit
    Eigen::Vector2d c;                               ///< normal along the directors [1]
    Eigen::Vector2d particle;                        ///< material coordinates of the particle furthest along it [length]
    Eigen::Vector2d line = Eigen::Vector2d::Zero();  ///< of the part of the normal that lies in the section
    Vec3 furthest, turning;  ///< that particle from the centre [length]; how c turns in the section with the normal [1]
    std::array<Vec3, 2> reciprocal{Vec3::Zero(), Vec3::Zero()};
    double size = 0.0, bend = 0.0;        ///< |A c|, a^2 b^2 / |A c|^3 [length]
    double tilt = 0.0, lengthened = 1.0;  ///< cosine of `out` and the normal; 1 / s [1]

    /// @param directors  two of them
    template <class Directors>
    SeenSection(const Directors& directors, const scene::CrossSection& section, const Vec3& normal) noexcept {
        const double a = section.semi_axis_1, b = section.semi_axis_2;
        const Vec3 &g_1 = directors[0], &g_2 = directors[1];
        c = {g_1.dot(normal), g_2.dot(normal)};
        size = std::max(std::hypot(a * c[0], b * c[1]), 0.01 * std::min(a, b));  // seen along its fibre it has none
        particle = Eigen::Vector2d(a * a * c[0], b * b * c[1]) / size;
        bend = a * a * b * b / (size * size * size);
        furthest = particle[0] * g_1 + particle[1] * g_2, turning = c[0] * g_2 - c[1] * g_1;
        out = g_1.cross(g_2).normalized(), tilt = out.dot(normal);
        lengthened = 1.0 / std::sqrt(std::max(1.0 - tilt * tilt, 0.1));
        const double c_11 = g_1.dot(g_1), c_12 = g_1.dot(g_2), c_22 = g_2.dot(g_2), determinant = c_11 * c_22 - c_12 * c_12;
        reciprocal = {(c_22 * g_1 - c_12 * g_2) / determinant, (c_11 * g_2 - c_12 * g_1) / determinant};
        line = {reciprocal[0].dot(normal), reciprocal[1].dot(normal)};
    }
    double extent() const noexcept { return size * lengthened; }
    /// Slope of the extent by the tilt [length].
    double leaning() const noexcept { return size * tilt * lengthened * lengthened * lengthened; }
    Vec3 slope() const noexcept { return lengthened * furthest + leaning() * out; }  ///< of the extent by the normal [length]
};

/// Adds a form of n numbers, factor (a b^T + b a^T) / 2. By loops: unrolled, sums of this size cost the compiler more than all
/// else.
template <int n>
void add_product(Eigen::Matrix<double, n, n>& sum, double factor, const Eigen::Matrix<double, n, 1>& a,
                 const Eigen::Matrix<double, n, 1>& b) noexcept {
    for (Index r = 0; r < n; ++r)
        for (Index c = 0; c < n; ++c) sum(r, c) += 0.5 * factor * (a[r] * b[c] + b[r] * a[c]);
}
/// Adds by^T form by.
template <int n>
void add_form(Eigen::Matrix<double, n, n>& sum, const Eigen::Matrix2d& form, const Eigen::Matrix<double, 2, n>& by) noexcept {
    for (Index c = 0; c < n; ++c) {
        const double one = form(0, 0) * by(0, c) + form(0, 1) * by(1, c), two = form(1, 0) * by(0, c) + form(1, 1) * by(1, c);
        for (Index r = 0; r < n; ++r) sum(r, c) += by(0, r) * one + by(1, r) * two;
    }
}

/// Second derivative of a section's extent by eight numbers: normal along two directions e and f across it, motion of the
/// furthest particle along e, f and the normal, turn of the section's components of the normal in its plane, and motion of its
/// material out of it, by both directors (2). What the section's normal turns of second order is left out, of a normal that
/// leans only.
using ExtentBending = Eigen::Matrix<double, 8, 8>;
/// Second derivatives of a section's extent by what turns and presses it.
template <class Seen>
ExtentBending extent_bending(const Seen& seen, const Vec3& e, const Vec3& f) noexcept {
    using Form = Eigen::Matrix<double, 8, 1>;
    enum : Index { by_e, by_f, press_e, press_f, press_n, turn, out_1, out_2 };
    const Form none = Form::Zero();
    const auto along = [&](const Vec3& vector) {
        Form form = none;
        form[by_e] = vector.dot(e), form[by_f] = vector.dot(f);
        return form;
    };
    const double one = seen.lengthened, cube = one * one * one, fifth = cube * one * one, tau = seen.tilt;
    Form turning = along(seen.turning), tilting = along(seen.out), size = along(seen.furthest);
    turning[turn] += 1.0, tilting[out_1] -= seen.line[0], tilting[out_2] -= seen.line[1], size[press_n] += 1.0;
    ExtentBending sum = ExtentBending::Zero();
    add_product(sum, one * seen.bend, turning, turning);
    add_product(sum, 2.0 * tau * cube, size, tilting);
    add_product(sum, seen.size * (cube + 3.0 * tau * tau * fifth), tilting, tilting);
    for (const auto& [normal, press] : {std::pair<Index, Index>{by_e, press_e}, {by_f, press_f}}) {
        sum(normal, press) += one, sum(press, normal) += one;
        sum(normal, normal) -= one * seen.size + seen.size * tau * tau * cube;
    }
    const double leaning = seen.leaning();
    for (const auto& [at, reciprocal] : {std::pair<Index, Vec3>{out_1, seen.reciprocal[0]}, {out_2, seen.reciprocal[1]}}) {
        const Form back = along(reciprocal);
        for (Index k = 0; k < 8; ++k) sum(at, k) -= leaning * back[k], sum(k, at) -= leaning * back[k];
    }
    return sum;
}

/// Gap of two fibres at two places along a normal, G = n . (x_j - x_i) - h_i(n) - h_j(n), and its derivatives by both and by
/// arc lengths.
struct OvalGap {
    Vec3 normal, e, f;  ///< unit, across each other
    SeenSection i, j;
    ExtentBending bending_i, bending_j;
    double gap, distance;       ///< G; n . (x_j - x_i), at least a part of both extents [length]
    Eigen::Vector2d by_normal;  ///< along e and f [length]
    Eigen::Matrix2d flat;       ///< minus the second derivative by the normal, positive [length]
    Eigen::Vector2d by_arc;     ///< [1]
    Eigen::Matrix2d mixed;      ///< by the normal, and by both arc lengths [1]
    Eigen::Matrix2d closeness;  ///< second derivatives by both arc lengths with the normal turning, times the distance [1]

    template <class Pair>
    OvalGap(const Pair& pair, const SeenSection& of_i, const SeenSection& of_j, const Vec3& n) noexcept
        : normal{n},
          e{n.unitOrthogonal()},
          f{n.cross(e)},
          i{of_i},
          j{of_j},
          bending_i{extent_bending(i, e, f)},
          bending_j{extent_bending(j, e, f)} {
        const double along = pair.centres.dot(n);
        gap = along - i.extent() - j.extent();
        distance = std::max(along, 0.1 * (i.extent() + j.extent()));
        by_normal = across(pair.centres - i.slope() - j.slope());
        flat = along * Eigen::Matrix2d::Identity() + bending_i.topLeftCorner<2, 2>() + bending_j.topLeftCorner<2, 2>();
        flat = raised(flat, 0.1 * distance);
        by_arc = {-n.dot(pair.t_i), n.dot(pair.t_j)};
        mixed.col(0) = -across(pair.t_i), mixed.col(1) = across(pair.t_j);
        closeness = distance * mixed.transpose() * flat.inverse() * mixed;
        closeness(0, 0) -= distance * n.dot(pair.bend_i), closeness(1, 1) += distance * n.dot(pair.bend_j);
    }
    Eigen::Vector2d across(const Vec3& vector) const noexcept { return {vector.dot(e), vector.dot(f)}; }
};

/// Side of a place where sections are not round, or are pressed flat.
template <class B>
PatchSide<B> oval_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const StandingSection& section_at,
                       double half, double speed, const SeenSection& seen, const Vec3& normal) noexcept {
    return line_side(mesh, state, fibre, u, section_at, half, speed, [&](PatchSide<B>& side, const auto& g_1, const auto& g_2) {
        side.extent = seen.extent(), side.across = side.aside = normal, side.out = seen.out, side.lengthened = seen.lengthened,
        side.tilt = seen.leaning();
        for (std::size_t a = 0; a < side.count; ++a) {
            side.press[a] = seen.lengthened * (seen.particle[0] * g_1[a] + seen.particle[1] * g_2[a]);
            side.beside[a] = seen.c[0] * g_2[a] - seen.c[1] * g_1[a];
            side.lean[a] = seen.line[0] * g_1[a] + seen.line[1] * g_2[a];
            side.directors[0][a] = g_1[a], side.directors[1][a] = g_2[a];
        }
    });
}

/// Means of the directors of both sections that stand.
template <class B>
std::array<std::array<Vec3, 2>, 2> standing_directors(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j,
                                                      const StandingSection& at_i, const StandingSection& at_j) noexcept {
    return {mean_directors(mesh, state, i, at_i.u, half_of_patch(mesh, i, j, i)),
            mean_directors(mesh, state, j, at_j.u, half_of_patch(mesh, i, j, j))};
}
template <class B>
OvalGap oval_gap(const beam::Mesh<B>& mesh, const PairGeometry& pair, Index i, Index j,
                 const std::array<std::array<Vec3, 2>, 2>& directors, const Vec3& normal) noexcept {
    return {pair, SeenSection(directors[0], mesh.fibre(i).section, normal),
            SeenSection(directors[1], mesh.fibre(j).section, normal), normal};
}

/// Moves a pair of places to where the gap is least along its fibres, as far as they may slide, and greatest among normals,
/// from nearby, by Newton's method.
/// @param normal  from i to j; in: of the side that they are on
template <class B>
OvalGap follow_oval(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, const StandingSection& at_i,
                    const StandingSection& at_j, const Slide& slide, double& u_i, double& u_j, Vec3& normal) noexcept {
    const auto directors = standing_directors(mesh, state, i, j, at_i, at_j);
    const auto [low_i, high_i] = mesh.bounds(i);
    const auto [low_j, high_j] = mesh.bounds(j);
    PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    if (const Vec3 crossing = pair.t_i.cross(pair.t_j); slide.kind == Slide::freely && crossing.norm() > 0.1)
        normal = crossing.dot(normal) < 0.0 ? Vec3(-crossing.normalized()) : Vec3(crossing.normalized());
    for (int iteration = 0; iteration < 30; ++iteration) {
        const OvalGap gap = oval_gap(mesh, pair, i, j, directors, normal);
        const Eigen::Matrix2d flatter = gap.flat.inverse();
        const Eigen::Vector2d downhill = -gap.distance * (gap.by_arc + gap.mixed.transpose() * flatter * gap.by_normal);
        Eigen::Vector2d step = slide.slack(pair, gap.closeness, least_of_steps) * downhill;
        Eigen::Vector2d turn = flatter * (gap.by_normal + gap.mixed * step);
        const double most_turn = 0.3, most_step = 0.5;  // [radian], [element]
        if (const double size = turn.norm(); size > most_turn) turn *= most_turn / size;
        normal = (normal + turn[0] * gap.e + turn[1] * gap.f).normalized();
        step[0] /= pair.speed_i, step[1] /= pair.speed_j;
        const double largest = std::max(std::abs(step[0]), std::abs(step[1]));
        step *= std::min(largest > most_step ? most_step / largest : 1.0,
                         iteration > 8 ? 0.5 : 1.0);  // bends jump where a patch comes to another element
        u_i = std::clamp(u_i + step[0], low_i, high_i), u_j = std::clamp(u_j + step[1], low_j, high_j);
        pair = pair_geometry(mesh, state, i, j, u_i, u_j);
        if (largest < 1e-11 && turn.norm() < 1e-11) break;
    }
    u_i = mesh.wrapped(i, u_i), u_j = mesh.wrapped(j, u_j);
    return oval_gap(mesh, pair, i, j, directors, normal);
}

/// A followed crossing of sections that are not round.
///
/// By the theorem of the envelope its force is that of the particles that are furthest along the normal. The gap's second
/// derivative is that with places and normal held, less what both take: with y these four and q the state, G_qq - G_qy G_yy^-1
/// G_yq. It is a form of sixteen numbers: the motion of centre j less that of centre i across the normal (2), the turns of both
/// tangents towards it (2), and of each section six of those of extent_bending.
/// @param gap  of follow_oval
template <class B>
SlidingPlace<B> oval_place(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j,
                           const StandingSection& at_i, const StandingSection& at_j, const OvalGap& gap,
                           const Slide& slide) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    SlidingPlace<B> place;
    place.oval = true, place.gap = gap.gap, place.distance = gap.distance;
    place.i = oval_side(mesh, state, i, u_i, at_i, half_of_patch(mesh, i, j, i), pair.speed_i, gap.i, gap.normal);
    place.j = oval_side(mesh, state, j, u_j, at_j, half_of_patch(mesh, i, j, j), pair.speed_j, gap.j, gap.normal);
    Eigen::Matrix<double, 2, 16> by_normal = Eigen::Matrix<double, 2, 16>::Zero(), by_arc = by_normal;
    place.bending.setZero();
    by_normal(0, 0) = by_normal(1, 1) = 1.0;
    by_arc(0, 2) = -1.0, by_arc(1, 3) = 1.0;
    for (const auto& [first, bending] : {std::pair<Index, const ExtentBending*>{4, &gap.bending_i}, {10, &gap.bending_j}}) {
        for (Index c = 0; c < 6; ++c) {
            for (Index r = 0; r < 2; ++r) by_normal(r, first + c) = -(*bending)(r, 2 + c);
            for (Index r = 0; r < 6; ++r) place.bending(first + r, first + c) = -(*bending)(2 + r, 2 + c);
        }
    }
    const Eigen::Matrix2d flatter = gap.flat.inverse(), sliding = gap.mixed.transpose() * flatter;
    for (Index k = 0; k < 16; ++k) by_arc.col(k) += sliding * by_normal.col(k);
    add_form(place.bending, flatter, by_normal);
    const bool held_i = u_i <= mesh.bounds(i).first || u_i >= mesh.bounds(i).second;  // at an end
    const bool held_j = u_j <= mesh.bounds(j).first || u_j >= mesh.bounds(j).second;
    if (!held_i && !held_j)
        add_form<16>(place.bending, -gap.distance * slide.slack(pair, gap.closeness, least_closeness), by_arc);
    return place;
}

/// Its stiffness.
/// @param positive  without the negative part of what the curvature of the gap makes of the reaction
template <class B>
SlidingStiffness oval_stiffness(const SlidingPlace<B>& place, const Vec3& normal, double reaction, double slope, bool positive) {
    const Vec3 e = normal.unitOrthogonal(), f = normal.cross(e);
    SlidingStiffness sum{{}, Matrix::Zero(17, 3 * static_cast<Index>(place.i.count + place.j.count)), Matrix::Zero(17, 17)};
    for (const double sign : {-1.0, 1.0}) {
        const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
        const Index turn = sign < 0.0 ? 3 : 4, section = sign < 0.0 ? 5 : 11;
        for (std::size_t a = 0; a < side.count; ++a) {
            const Index column = 3 * core::count(sum.vectors);
            sum.vectors.push_back(side.vectors[a]);
            const auto row = [&](Index at, const Vec3& value) { sum.rows.block<1, 3>(at, column) = value.transpose(); };
            row(0, gap_gradient(place, normal, sign, a));
            row(1, sign * side.place[a] * e), row(2, sign * side.place[a] * f);
            row(turn, side.slope[a] * normal);
            const double press = side.press[a] / side.lengthened;
            row(section, press * e), row(section + 1, press * f), row(section + 2, press * normal),
                row(section + 3, side.beside[a] * normal);
            row(section + 4, side.directors[0][a] * side.out), row(section + 5, side.directors[1][a] * side.out);
        }
    }
    sum.stiffness(0, 0) = -slope;
    Eigen::Matrix<double, 16, 16> form = -reaction * place.bending;
    if (positive) form = core::SymmetricEigen<16>(form).raised(0.0);
    sum.stiffness.block<16, 16>(1, 1) = form;
    return sum;
}

}  // namespace fibrant::contact

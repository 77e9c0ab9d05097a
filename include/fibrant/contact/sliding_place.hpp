// SPDX-License-Identifier: MIT
#pragma once
/// @file The place of a crossing as a function of the state: the force, and the tangent, of the energy of the gap between two
/// patches.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// The second variation of the distance of two centrelines by arc lengths, times that distance, that tangents count with at
/// least: bent around each other any tighter, they touch along a line [1].
inline constexpr double least_closeness = 0.02;

/// One side of a followed crossing, by the nodal vectors that its patch averages.
template <class B>
struct PatchSide {
    static constexpr std::size_t most =
        static_cast<std::size_t>((3 * (B::nodes - 1) + 1) * B::vectors_per_node);  // two patches less than an element apart
    using Weights = std::array<double, most>;
    std::array<Index, most> vectors{};  ///< of the mesh; of a closed fibre's last node those of its first
    std::size_t count = 0;              ///< of them
    Weights place{};                    ///< of the centreline [1]
    Weights slope{};                    ///< of the unit tangent's turns [1 / length]
    Weights press{};   ///< of the mean section's particle that lies `extent` across, less those of the centreline
    Weights beside{};  ///< of the one that lies as far aside; of an oval section those of how it turns about its fibre
    Weights lean{};    ///< of an oval section: of its material along the normal
    Vec3 across = Vec3::Zero(), aside = Vec3::Zero();  ///< in the section, unit: where it faces the other fibre, and across that
    double extent = 0.0;                               ///< of the section across [length]
    Vec3 out = Vec3::Zero();                           ///< normal of an oval section, unit
    double tilt = 0.0,
           lengthened =
               1.0;  ///< slope of its extent by the cosine between that and the normal of the pair [length]; 1 / its sine
    std::array<Weights, 2> directors{};  ///< of the means of its directors
};

/// Where the section of a followed place is taken, and the lines of its material that face the other fibre: both stand while the
/// place slides. A reaction presses flat what it rests on, and a place that went to where sections are less flat would flee from
/// its own force. Lines of material turn with the section: directions that stood in space would push a pair that turns back with
/// force x radius x turn.
struct StandingSection {
    double u = 0.0;                                    ///< abscissa, less than an element from the place
    Eigen::Vector2d facing = Eigen::Vector2d::Zero();  ///< components of the direction along both directors
    bool stands = false;
};

/// Means of the directors of a patch.
template <class B>
std::array<Vec3, 2> mean_directors(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, double half) noexcept {
    const Patches<B> patches(mesh, state);
    std::array<Vec3, 2> mean{Vec3::Zero(), Vec3::Zero()};
    patches.each_sample(fibre, u, half, [&](Index e, double xi, double weight) {
        const Index first = mesh.first_unknown(fibre, patches.around(fibre, e));
        mean[0] += weight * beam::Mesh<B>::template director<1>(state, first, beam::director_weights<B>(xi, 1));
        mean[1] += weight * beam::Mesh<B>::template director<2>(state, first, beam::director_weights<B>(xi, 2));
    });
    return mean;
}

/// A section between two lines of its material that are tangents of its contour.
struct FacingSection {
    Vec3 across = Vec3::Zero(), aside = Vec3::Zero();  ///< in the plane of the directors, unit: across the lines, and along them
    Eigen::Vector2d particle = Eigen::Vector2d::Zero(),
                    sideways = particle;  ///< of both directors: `extent` times across and aside [length]
    double extent = 0.0;                  ///< from the centre to either line [length]

    /// The extent is |A c| / sqrt(c C^-1 c) with c the covector of the lines, A the half axes and C the products of the directors
    /// with each other: it knows of the section's strain alone, however the section turns.
    FacingSection(const std::array<Vec3, 2>& directors, const Eigen::Vector2d& facing,
                  const scene::CrossSection& section) noexcept {
        const Vec3& g_1 = directors[0];
        const Vec3& g_2 = directors[1];
        const double c_11 = g_1.dot(g_1), c_12 = g_1.dot(g_2), c_22 = g_2.dot(g_2), determinant = c_11 * c_22 - c_12 * c_12;
        if (!(determinant > 1e-4 * c_11 * c_22)) return;  // no plane
        const Eigen::Vector2d raised((c_22 * facing[0] - c_12 * facing[1]) / determinant,
                                     (c_11 * facing[1] - c_12 * facing[0]) / determinant);
        const double size = std::sqrt(facing.dot(raised));
        if (!(size > 0.0)) return;
        extent = std::hypot(section.semi_axis_1 * facing[0], section.semi_axis_2 * facing[1]) / size;
        across = (raised[0] * g_1 + raised[1] * g_2) / size;
        aside = g_1.cross(g_2).normalized().cross(across);
        const double p = aside.dot(g_1), q = aside.dot(g_2);
        particle = extent / size * raised;
        sideways = extent / determinant * Eigen::Vector2d(c_22 * p - c_12 * q, c_11 * q - c_12 * p);
    }
};

/// A fibre's section at a place, as it faces the other fibre.
/// @param normal  from this fibre to the other one, unit
template <class B>
StandingSection standing_section(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, double half,
                                 const Vec3& normal) noexcept {
    StandingSection section{u, Eigen::Vector2d::UnitX(), true};
    if constexpr (beam::DeformableSections<B>) {
        const Vec3 tangent = Patches<B>(mesh, state).tangent(fibre, u, half).normalized();
        const Vec3 across = unit_or(normal - normal.dot(tangent) * tangent,
                                    normal);  // the gap is that of surfaces, which a normal that leans does not cut straight
        const std::array<Vec3, 2> directors = mean_directors(mesh, state, fibre, u, half);
        section.facing = {directors[0].dot(across), directors[1].dot(across)};
    }
    return section;
}

/// One side of a place: its vectors, `place` and `slope`.
/// @param rest  called with it and the weights of the means of both directors, where sections deform
template <class B, class Rest>
PatchSide<B> line_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const StandingSection& section_at,
                       double half, double speed, const Rest& rest) noexcept {
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
    patches.each_sample(fibre, u, half,
                        [&](Index e, double xi, double weight) { add(side.place, e, weight, B::centreline_weights(xi)); });
    for (const double end : {-1.0, 1.0}) {
        const auto [e, xi] = patches.located(fibre, u + end * half);
        add(side.slope, e, end / (2.0 * half * speed), B::centreline_weights(xi));
    }
    if constexpr (beam::DeformableSections<B>) {
        typename PatchSide<B>::Weights g_1{}, g_2{};  // of the means of the directors
        patches.each_sample(fibre, section_at.u, half, [&](Index e, double xi, double weight) {
            add(g_1, e, weight, beam::director_weights<B>(xi, 1));
            add(g_2, e, weight, beam::director_weights<B>(xi, 2));
        });
        rest(side, g_1, g_2);
    }
    return side;
}

/// Side of a place where fibres touch: what its gap depends on, of one fibre.
template <class B>
PatchSide<B> patch_side(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const StandingSection& section_at,
                        double half, double speed) noexcept {
    const scene::CrossSection& section = mesh.fibre(fibre).section;
    PatchSide<B> side =
        line_side(mesh, state, fibre, u, section_at, half, speed, [&](PatchSide<B>& of, const auto& g_1, const auto& g_2) {
            const FacingSection faces(mean_directors(mesh, state, fibre, section_at.u, half), section_at.facing, section);
            if (!(faces.extent >= 0.1 * section.radius())) return;
            of.extent = faces.extent, of.across = faces.across, of.aside = faces.aside;
            for (std::size_t a = 0; a < of.count; ++a) {
                of.press[a] = faces.particle[0] * g_1[a] + faces.particle[1] * g_2[a];
                of.beside[a] = faces.sideways[0] * g_1[a] + faces.sideways[1] * g_2[a];
            }
        });
    if (!(side.extent > 0.0)) side.extent = section.radius();
    return side;
}

/// A followed crossing in a state: where it pushes, and how its gap bends with the nodal vectors of both sides.
///
/// With the points sliding along and the normal turning, the second derivative of a distance d is that of four numbers y: the
/// motion x of point j less that of point i along two directions across the normal, then the turns tau of tangents i and j
/// towards the normal times d. With t unit tangents in the plane of the two directions and M the second derivatives of half the
/// square of the distance by the arc lengths, it is (x . x - b^T S b) / d with b = (-(t_i . x + tau_i), t_j . x + tau_j) and S
/// the inverse of M, or of its part in the direction in which the place may slide. For straight lines M takes away all of x . x:
/// only where they bend does a crossing that slides aside sink or rise, which holds loops that hang in each other.
template <class B>
struct SlidingPlace {
    PatchSide<B> i, j;
    double gap = 0.0;                                     ///< [length]
    double distance = 0.0;                                ///< d [length]
    Eigen::Matrix4d curvature = Eigen::Matrix4d::Zero();  ///< of y, for d [1 / length]
    bool oval = false;  ///< of sections that are not round: the gap bends with sixteen numbers (oval_place)
    Eigen::Matrix<double, 16, 16> bending = Eigen::Matrix<double, 16, 16>::Zero();  ///< then its second derivative by these
};

/// Where two fibres cross, with the derivatives of its gap.
/// @param at_i, at_j  sections that stand
/// @param normal      from i to j, along the line of both centres
template <class B>
SlidingPlace<B> sliding_place(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j,
                              const StandingSection& at_i, const StandingSection& at_j, const Vec3& normal,
                              const Slide& slide = {}) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, i, j, u_i, u_j);
    SlidingPlace<B> place;
    place.i = patch_side(mesh, state, i, u_i, at_i, half_of_patch(mesh, i, j, i), pair.speed_i);
    place.j = patch_side(mesh, state, j, u_j, at_j, half_of_patch(mesh, i, j, j), pair.speed_j);
    place.gap = pair.centres.dot(normal) - place.i.extent - place.j.extent;
    place.distance = std::max(std::abs(pair.centres.dot(normal)), 0.1 * (place.i.extent + place.j.extent));
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    Eigen::Matrix<double, 2, 4> b;
    b.row(0) = Eigen::RowVector4d(-pair.t_i.dot(along), -pair.t_i.dot(across), -1.0, 0.0);
    b.row(1) = Eigen::RowVector4d(pair.t_j.dot(along), pair.t_j.dot(across), 0.0, 1.0);
    Eigen::Matrix2d slack = slide.slack(pair, pair.closeness, least_closeness);
    // What is at an end of its fibre does not slide.
    const bool held_i = u_i <= mesh.bounds(i).first || u_i >= mesh.bounds(i).second;
    const bool held_j = u_j <= mesh.bounds(j).first || u_j >= mesh.bounds(j).second;
    if (held_i || held_j) slack.setZero();
    if (slide.kind == Slide::freely && held_i && !held_j) slack(1, 1) = 1.0 / std::max(pair.closeness(1, 1), least_closeness);
    if (slide.kind == Slide::freely && held_j && !held_i) slack(0, 0) = 1.0 / std::max(pair.closeness(0, 0), least_closeness);
    place.curvature = -(b.transpose() * slack * b);
    place.curvature(0, 0) += 1.0, place.curvature(1, 1) += 1.0;
    place.curvature /= place.distance;
    return place;
}

/// Derivative of a gap by a nodal vector of one of its sides.
/// @param sign  -1 for side i, 1 for side j
template <class B>
Vec3 gap_gradient(const SlidingPlace<B>& place, const Vec3& normal, double sign, std::size_t a) noexcept {
    const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
    return sign * side.place[a] * normal - side.press[a] * side.across + side.tilt * side.lean[a] * side.out;
}

/// Adds the forces of a reaction on the vectors that a side averages, of internal minus external ones.
template <class B>
void spread(const SlidingPlace<B>& place, const Vec3& normal, double sign, double reaction, Vector& forces) noexcept {
    const PatchSide<B>& side = sign < 0.0 ? place.i : place.j;
    for (std::size_t a = 0; a < side.count; ++a)
        forces.segment<3>(3 * side.vectors[a]) -= reaction * gap_gradient(place, normal, sign, a);
}

/// Stiffness of a followed crossing: rows^T stiffness rows.
struct SlidingStiffness {
    std::vector<Index> vectors;  ///< 3-vectors of unknowns, each once
    Matrix rows;                 ///< by the unknowns of these
    Matrix stiffness;            ///< symmetric
};

///
/// Of a section's extent h the second derivative is ((N.x)^2 + (f.x)^2 - (f.x + e.y)^2) / h, x and y the motions of `press` and
/// `beside`, e and f across and aside, N across both.
/// @param positive  without the negative part of what the curvature of the gap makes of the reaction
template <class B>
SlidingStiffness sliding_stiffness(const SlidingPlace<B>& place, const Vec3& normal, double reaction, double slope,
                                   bool positive) {
    constexpr Index rows = beam::DeformableSections<B> ? 11 : 5;
    const Vec3 along = normal.unitOrthogonal(), across = normal.cross(along);
    SlidingStiffness sum{{}, Matrix::Zero(rows, 3 * static_cast<Index>(place.i.count + place.j.count)), Matrix::Zero(rows, rows)};
    const auto fill = [&](const PatchSide<B>& side, double sign, Index turn, [[maybe_unused]] Index section) {
        [[maybe_unused]] const Vec3 out = side.across.cross(side.aside);
        for (std::size_t a = 0; a < side.count; ++a) {
            const Index column = 3 * core::count(sum.vectors);
            sum.vectors.push_back(side.vectors[a]);
            sum.rows.block<1, 3>(0, column) = gap_gradient(place, normal, sign, a).transpose();
            sum.rows.block<1, 3>(1, column) = sign * side.place[a] * along.transpose();
            sum.rows.block<1, 3>(2, column) = sign * side.place[a] * across.transpose();
            sum.rows.block<1, 3>(turn, column) = place.distance * side.slope[a] * normal.transpose();
            if constexpr (rows == 11) {
                sum.rows.block<1, 3>(section, column) = side.press[a] * out.transpose();
                sum.rows.block<1, 3>(section + 1, column) = side.press[a] * side.aside.transpose();
                sum.rows.block<1, 3>(section + 2, column) = side.beside[a] * side.across.transpose();
            }
        }
    };
    fill(place.i, -1.0, 3, 5), fill(place.j, 1.0, 4, 8);
    sum.stiffness(0, 0) = -slope;
    Eigen::Matrix4d form = -reaction * place.curvature;
    if (positive) form = core::SymmetricEigen<4>(form).raised(0.0);
    sum.stiffness.block<4, 4>(1, 1) = form;
    if constexpr (rows == 11) {
        Eigen::Matrix2d shear;
        shear(0, 0) = 0.0, shear(0, 1) = shear(1, 0) = shear(1, 1) = -1.0;
        if (positive) shear = core::SymmetricEigen<2>(shear).raised(0.0);
        for (const auto& [row, side] : {std::pair<Index, const PatchSide<B>&>{5, place.i}, {8, place.j}}) {
            sum.stiffness(row, row) = reaction / side.extent;
            sum.stiffness.block<2, 2>(row + 1, row + 1) = reaction / side.extent * shear;
        }
    }
    return sum;
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
// Followed crossings: closest patches, and the derivatives of the energy of their gap.
#include "two_fibres.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/oval_place.hpp>
#include <fibrant/contact/sliding_place.hpp>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fibrant;

namespace sliding_place_test {

const double r = 0.05;

/// Two arcs that hang in each other, a little off their middles: bent from straight, as cables are.
template <class B>
beam::Mesh<B> hanging(Index elements, double flatness = 1.0) {
    scene::Assembly assembly;
    const double R = 8.0 * r, half = 0.4 * std::numbers::pi;
    const auto add = [&](const scene::Curve& arc, double y) {
        scene::FibreSpecification fibre = test::straight_fibre(Vec3(0.0, y, 0.0), Vec3(2.0 * half * R, y, 0.0), r, elements);
        fibre.start = arc;
        if (flatness != 1.0) fibre.section = scene::elliptical(r, flatness * r);
        assembly.add(fibre);
    };
    add(
        [=](double t) {
            const double a = half * (2.0 * t - 1.04);
            return Vec3(R * std::sin(a), 0.0, R - R * std::cos(a));
        },
        0.0);
    add(
        [=](double t) {
            const double a = half * (2.0 * t - 0.97);
            return Vec3(0.28 * R * std::sin(a), 0.96 * R * std::sin(a), 2.0 * r - R + R * std::cos(a));
        },
        R);
    return beam::Mesh<B>(assembly, B());
}

/// A followed place: where it is near, and how it slides.
struct Followed {
    double u = 2.6, v = 3.3;
    contact::Slide slide{};
    contact::StandingSection i{2.6, {0.6, 0.7}, true}, j{3.3, {-0.2, -1.0}, true};
    bool oval = false;
};

/// Gap of the closest patches of a state, from places that are near.
template <class B>
contact::SlidingPlace<B> closest_place(const beam::Mesh<B>& mesh, const Vector& state, const Followed& at, Vec3& normal) {
    double u = at.u, v = at.v;
    if (at.slide.kind == contact::Slide::freely) contact::follow_closest(mesh, state, 0, 1, u, v);
    if (at.slide.kind == contact::Slide::along) contact::follow_along(mesh, state, 0, 1, at.slide, u, v);
    const contact::PairGeometry pair = contact::pair_geometry(mesh, state, 0, 1, u, v);
    if constexpr (beam::DeformableSections<B>) {
        if (at.oval) {
            normal = pair.centres.normalized();
            const contact::OvalGap gap = contact::follow_oval(mesh, state, 0, 1, at.i, at.j, at.slide, u, v, normal);
            return contact::oval_place(mesh, state, 0, 1, u, v, at.i, at.j, gap, at.slide);
        }
    }
    normal = at.slide.kind == contact::Slide::freely ? pair.t_i.cross(pair.t_j).normalized() : pair.centres.normalized();
    if (normal.dot(pair.centres) < 0.0) normal = -normal;
    return contact::sliding_place(mesh, state, 0, 1, u, v, at.i, at.j, normal, at.slide);
}

TEST_CASE("the closest patches are those of all pairs nearby") {
    const beam::Mesh<beam::KirchhoffCable> mesh = hanging<beam::KirchhoffCable>(6);
    const Vector& state = mesh.start_state();
    const contact::Patches<beam::KirchhoffCable> patches(mesh, state);
    const double half = contact::half_of_patch(mesh, 0, 1, 0);
    double u = 2.6, v = 3.3;
    contact::follow_closest(mesh, state, 0, 1, u, v);
    const double least = (patches.place(1, v, half) - patches.place(0, u, half)).norm();
    for (double a = -0.3; a <= 0.3; a += 0.05)
        for (double b = -0.3; b <= 0.3; b += 0.05)
            CHECK((patches.place(1, v + b, half) - patches.place(0, u + a, half)).norm() >= least * (1.0 - 1e-12));
}

/// Force of a followed crossing under a reaction c (g_0 - g), whose energy is c (g_0 - g)^2 / 2.
template <class B>
Vector force_of(const beam::Mesh<B>& mesh, const Vector& state, const Followed& at, double c, double g_0) {
    Vec3 normal;
    const contact::SlidingPlace<B> place = closest_place(mesh, state, at, normal);
    Vector force = Vector::Zero(state.size());
    for (const double sign : {-1.0, 1.0}) contact::spread(place, normal, sign, c * (g_0 - place.gap), force);
    return force;
}

struct Misfit {
    double force = 0.0, stiffness = 0.0;  ///< over the greatest of all [1]
};

/// Of force and stiffness against central differences of energy and force.
template <class B>
Misfit misfit(const beam::Mesh<B>& mesh, const Vector& state, const Followed& at) {
    const double c = 300.0, g_0 = 0.2 * r, step = 1e-5 * r;
    Vec3 normal;
    const contact::SlidingPlace<B> place = closest_place(mesh, state, at, normal);
    const double reaction = c * (g_0 - place.gap);
    contact::SlidingStiffness stiffness = contact::sliding_stiffness(place, normal, reaction, -c, false);
    if constexpr (beam::DeformableSections<B>)
        if (at.oval) stiffness = contact::oval_stiffness(place, normal, reaction, -c, false);
    Matrix tangent = Matrix::Zero(state.size(), state.size());
    const Matrix own = stiffness.rows.transpose() * stiffness.stiffness * stiffness.rows;
    for (std::size_t a = 0; a < stiffness.vectors.size(); ++a)
        for (std::size_t b = 0; b < stiffness.vectors.size(); ++b)
            tangent.block<3, 3>(3 * stiffness.vectors[a], 3 * stiffness.vectors[b]) +=
                own.block<3, 3>(3 * static_cast<Index>(a), 3 * static_cast<Index>(b));
    const Vector force = force_of(mesh, state, at, c, g_0);
    const auto energy = [&](const Vector& in) {
        Vec3 ignored;
        const double depth = g_0 - closest_place(mesh, in, at, ignored).gap;
        return 0.5 * c * depth * depth;
    };
    Misfit worst;
    for (Index k = 0; k < state.size(); ++k) {
        Vector before = state, after = state;
        before[k] -= step, after[k] += step;
        const Vector slope = (force_of(mesh, after, at, c, g_0) - force_of(mesh, before, at, c, g_0)) / (2.0 * step);
        worst.stiffness =
            std::max(worst.stiffness, (slope - tangent.col(k)).cwiseAbs().maxCoeff() / tangent.cwiseAbs().maxCoeff());
        worst.force = std::max(
            worst.force, std::abs((energy(after) - energy(before)) / (2.0 * step) - force[k]) / force.cwiseAbs().maxCoeff());
    }
    return worst;
}

TEST_CASE(
    "on cables the force is the derivative of the energy, and the stiffness that of the force, with the place sliding and the "
    "normal turning") {
    const beam::Mesh<beam::KirchhoffCable> mesh = hanging<beam::KirchhoffCable>(6);
    for (const contact::Slide& slide : {contact::Slide{}, contact::Slide{contact::Slide::along, Eigen::Vector2d(0.8, -0.6)},
                                        contact::Slide{contact::Slide::nowhere, {}}}) {
        const Misfit worst = misfit(mesh, mesh.start_state(), {.slide = slide});
        CAPTURE(slide.kind);
        CHECK(worst.stiffness <
              1e-6);  // steps of 1e-5 leave 1e-10 of third derivatives and 1e-11 of rounding, times some hundreds
        CHECK(worst.force < 1e-6);
    }
}

TEST_CASE("with sections that are pressed flat as well, which stand while the place slides") {
    const beam::Mesh<test::Beam> mesh = hanging<test::Beam>(6);
    Vector state = mesh.start_state();
    // Flatter by a tenth near the middle, and less beside it.
    for (Index fibre = 0; fibre < 2; ++fibre)
        for (Index node = 0; node < mesh.node_count(fibre); ++node)
            for (const Index part : {1, 2})
                state[3 * mesh.node_vector(fibre, node, part) + 2] *= 0.9 + 0.01 * std::pow(static_cast<double>(node) - 6.0, 2);
    for (const contact::Slide& slide : {contact::Slide{}, contact::Slide{contact::Slide::along, Eigen::Vector2d(0.8, -0.6)},
                                        contact::Slide{contact::Slide::nowhere, {}}}) {
        const Misfit worst = misfit(mesh, state, {.slide = slide});
        CAPTURE(slide.kind);
        CHECK(worst.stiffness < 1e-6);
        CHECK(worst.force < 1e-6);
    }
}

TEST_CASE("with sections that are not round: the true gap, along its own normal") {
    for (const double flatness : {1.0, 2.5, 0.4}) {
        CAPTURE(flatness);
        const beam::Mesh<test::Beam> mesh = hanging<test::Beam>(6, flatness);
        Vector state = mesh.start_state();
        // Sections that lie askew in both fibres, are strained, and clear of each other.
        for (Index fibre = 0; fibre < 2; ++fibre)
            for (Index node = 0; node < mesh.node_count(fibre); ++node) {
                const Index centre = 3 * mesh.node_vector(fibre, node, 0), first = 3 * mesh.node_vector(fibre, node, 1),
                            second = 3 * mesh.node_vector(fibre, node, 2);
                const Vec3 g_1 = state.segment<3>(first), g_2 = state.segment<3>(second);
                state.segment<3>(first) = 0.9 * g_1 + (fibre == 0 ? 0.4 : -0.3) * g_2,
                state.segment<3>(second) = 0.95 * g_2 + (fibre == 0 ? -0.3 : 0.4) * g_1;
                if (fibre == 1 && flatness > 1.0) state[centre + 2] += 3.0 * r;
            }
        for (const contact::Slide& slide : {contact::Slide{}, contact::Slide{contact::Slide::along, Eigen::Vector2d(0.8, -0.6)},
                                            contact::Slide{contact::Slide::nowhere, {}}}) {
            CAPTURE(slide.kind);
            Followed at{.slide = slide, .oval = true};
            for (int pass = 0; pass < 3 && slide.kind == contact::Slide::freely;
                 ++pass) {  // sections that stand where the place is
                Vec3 normal = Vec3::UnitZ();
                double u = at.i.u, v = at.j.u;
                contact::follow_oval(mesh, state, 0, 1, at.i, at.j, slide, u, v, normal);
                at.i.u = u, at.j.u = v;
            }
            const Misfit worst = misfit(mesh, state, at);
            // Where a place may not slide the pair's normal leans along fibres, and what a section's own turns by of second order
            // is left out.
            CHECK(worst.stiffness < (slide.kind == contact::Slide::freely ? 3e-6 : 5e-3));
            CHECK(worst.force < 1e-6);
        }
    }
}

TEST_CASE("fibres that clasp each other touch at two places of one zone, with opposite normals; a crossing is one") {
    const double h = 2.0 * r, w = 4.0 * r;
    const auto mesh_of = [&](bool clasp) {
        std::vector<scene::FibreSpecification> fibres(2, test::straight_fibre(Vec3(0, 0, 0), Vec3(1, 0, 0), r, 8));
        for (const double side : {1.0, -1.0})
            fibres[side < 0.0 ? 1 : 0].curve = [=](double t) {
                const double x = 3.2 * t - 1.6;
                return clasp ? Vec3(w * x, side * h * (1.0 - x * x), side * r * x) : Vec3(w * x, side * w * x, -side * r);
            };
        return test::mesh_of(fibres);
    };
    for (const bool clasp : {true, false}) {
        const test::Mesh mesh = mesh_of(clasp);
        const Vector& state = mesh.rest_state();
        proximity::ProximityZone zone = test::zone_of(0.0, 8.0, 0.0, 8.0);
        zone.closest_i = zone.closest_j = clasp ? 6.5 : 4.0;
        contact::follow_closest(mesh, state, 0, 1, zone.closest_i, zone.closest_j);
        const auto places = contact::closest_places(mesh, state, zone, {zone.closest_i, zone.closest_j});
        CHECK(places.size() == (clasp ? 2 : 1));
        CHECK(contact::clasped(mesh, state, zone) == clasp);
        if (!clasp || places.size() < 2) continue;
        // Mirror images of each other.
        CHECK(std::abs(places[0][0] + places[1][0] - 8.0) < 1e-9);
        CHECK(std::abs(places[0][1] + places[1][1] - 8.0) < 1e-9);
        const auto centres = [&](const auto& place) {
            return contact::pair_geometry(mesh, state, 0, 1, place[0], place[1]).centres;
        };
        CHECK(centres(places[0]).dot(centres(places[1])) < 0.0);
    }
}

TEST_CASE("what turns as one within an iteration pushes as it did, turned, and without a moment") {
    const beam::Mesh<test::Beam> mesh = hanging<test::Beam>(6);
    Vector state = mesh.start_state();
    for (Index k = 0; k < state.size(); ++k)
        state[k] += 0.02 * r * std::sin(1.7 * static_cast<double>(k));  // sections strained, and none like another
    const Mat3 turn = Eigen::AngleAxisd(0.4, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    Vector turned = state;
    for (Index k = 0; k < state.size(); k += 3) turned.segment<3>(k) = turn * state.segment<3>(k);
    const Followed at;
    const Vector before = force_of(mesh, state, at, 300.0, 0.2 * r), after = force_of(mesh, turned, at, 300.0, 0.2 * r);
    double misfit = 0.0;
    Vec3 moment = Vec3::Zero();
    for (Index k = 0; k < state.size(); k += 3) {
        misfit = std::max(misfit, (after.segment<3>(k) - turn * before.segment<3>(k)).norm());
        moment += turned.segment<3>(k).cross(after.segment<3>(k));
    }
    const double size = after.cwiseAbs().maxCoeff();
    CHECK(misfit < 1e-9 * size);  // places are found to 1e-11 of an element
    CHECK(moment.norm() < 1e-9 * r * size);
}

TEST_CASE("what a hook pushes against holds it sideways, with reaction times curvature; straight fibres hold nothing so") {
    using Cable = beam::KirchhoffCable;
    const beam::Mesh<Cable> mesh = hanging<Cable>(6);
    Vec3 normal;
    const contact::SlidingPlace<Cable> place = closest_place(mesh, mesh.start_state(), {}, normal);
    const Eigen::Matrix2d sideways = -place.curvature.topLeftCorner<2, 2>();  // for a reaction of 1
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> parts(sideways);
    CHECK(parts.eigenvalues()[0] > 0.5 / (8.0 * r));  // 1 / R, more by bends that add up
    scene::Assembly assembly;
    assembly.add(test::straight_fibre(Vec3(-1, 0, 0), Vec3(1, 0, 0), r, 6));
    assembly.add(test::straight_fibre(Vec3(0.2, -1, 2.0 * r), Vec3(-0.2, 1, 2.0 * r), r, 6));
    const test::Mesh straight(assembly, test::Beam{});
    const auto crossing =
        closest_place(straight, straight.rest_state(), {2.7, 2.8, {}, {3.0, {0.0, 1.0}, true}, {3.0, {0.0, 1.0}, true}}, normal);
    CHECK(crossing.curvature.topLeftCorner<2, 2>().cwiseAbs().maxCoeff() < 1e-9 / r);
    CHECK(std::abs(crossing.gap) < 1e-12);
}

}  // namespace sliding_place_test

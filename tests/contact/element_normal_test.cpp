// SPDX-License-Identifier: MIT
#include "fibres.hpp"

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace fibrant;

namespace element_normal_test {

using law::Frictionless;
using law::RegularisedPenalty;

constexpr double pi = std::numbers::pi;

Vec3 heading(double degrees) { return {std::cos(degrees * pi / 180.0), std::sin(degrees * pi / 180.0), 0.0}; }

/// A straight fibre of half axes a and 1, the first `tilt` from the horizontal.
scene::FibreSpecification flat_fibre(double a, const Vec3& middle, const Vec3& along, double half, double tilt,
                                     Index elements = 16) {
    scene::FibreSpecification fibre = test::straight_fibre(middle - half * along, middle + half * along, 1.0, elements);
    fibre.section = scene::elliptical(a, 1.0);
    fibre.director = std::cos(tilt) * Vec3::UnitZ().cross(along) + std::sin(tilt) * Vec3::UnitZ();
    return fibre;
}

template <class B>
struct Contacts {
    scene::Assembly assembly;
    beam::Mesh<B> mesh;
    contact::ContactSet<B, proximity::GridSearch, RegularisedPenalty, Frictionless> set;

    explicit Contacts(const std::vector<scene::FibreSpecification>& fibres, bool self = false)
        : assembly{gather(fibres)}, mesh{assembly, B{}}, set{assembly,
                                                             mesh,
                                                             parameters(self),
                                                             proximity::GridSearch{},
                                                             RegularisedPenalty({.regularisation_depth = 1e-3}),
                                                             Frictionless{}} {}
    static scene::Assembly gather(const std::vector<scene::FibreSpecification>& fibres) {
        scene::Assembly assembly;
        for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
        return assembly;
    }
    static contact::ContactParameters parameters(bool self) {
        contact::ContactParameters parameters;
        parameters.stiffness.allowed_penetration = 0.01;
        parameters.detection.self_contact = self;
        return parameters;
    }
    /// Least gap of all contact elements that are made anew.
    double least_gap(const Vector& state) {
        set.detect(state, state, 0.5, false);
        set.evaluate(state);
        double least = std::numeric_limits<double>::infinity();
        for (const auto& element : set.elements()) least = std::min(least, element.gap(state));
        return least;
    }
    /// Energy of contact at the stations that stand, normals made anew.
    double energy(const Vector& state) {
        set.refresh(state, state);
        set.evaluate(state);
        return set.figures(state).work;
    }
    Vector forces(const Vector& state) {
        set.refresh(state, state);
        set.evaluate(state);
        Vector sum = Vector::Zero(state.size());
        set.add_forces(sum);
        return sum;
    }
};

TEST_CASE_TEMPLATE("two parallel ellipses that are askew are apart by what is between their contours", B, test::Beam,
                   beam::RigidSectionRod) {
    for (const double sense : {-1.0, 1.0}) {
        Contacts<B> pair({flat_fibre(2.0, Vec3::Zero(), heading(0), 40.0, 0.0),
                          flat_fibre(2.0, {0.0, 2.0, 1.8}, sense * heading(0), 40.0, 0.0)});
        CHECK(std::abs(pair.least_gap(pair.mesh.rest_state()) - 0.0653) <
              1e-4);  // by points of the contours: tests/contact/section_gap_test.cpp
    }
}

TEST_CASE_TEMPLATE(
    "flat fibres that cross at any angle, flat, tilted or on edge, are as far apart and as deep in each other as they were moved",
    B, test::Beam, beam::RigidSectionRod) {
    for (const double ratio : {2.0, 5.0, 10.0})
        for (const double degrees : {5.0, 10.0, 20.0, 45.0, 90.0})
            for (std::size_t kind = 0; kind < 6; ++kind) {
                const std::array<double, 6> tilt_i{0.0, 0.0, 0.5 * pi, 0.4, 0.3, 0.0},
                    tilt_j{0.0, 0.5 * pi, 0.5 * pi, -0.4, 1.1, 0.0};
                const double a_i = kind == 5 ? 1.0 : ratio;  // round on flat
                const auto height = [](double a, double tilt) { return std::hypot(a * std::sin(tilt), std::cos(tilt)); };
                const double touching = height(a_i, tilt_i[kind]) + height(ratio, tilt_j[kind]);
                for (const double gap : {0.1, -0.01}) {
                    Contacts<B> pair(
                        {flat_fibre(a_i, Vec3::Zero(), heading(-0.5 * degrees), 20.0 * ratio, tilt_i[kind]),
                         flat_fibre(ratio, {0.0, 0.0, touching + gap}, heading(0.5 * degrees), 20.0 * ratio, tilt_j[kind])});
                    CAPTURE(ratio);
                    CAPTURE(degrees);
                    CAPTURE(kind);
                    const double found = pair.least_gap(pair.mesh.rest_state());
                    // Between stations a two hundredth of the thickness goes unseen, twice that where three halvings are not
                    // enough.
                    CHECK(found > gap - 1e-6);
                    CHECK(found < gap + 0.01);
                }
            }
}

TEST_CASE("a flat fibre against itself is held by its surfaces") {
    const double radius = 2.5, leg = 30.0;
    scene::FibreSpecification fibre = test::curved_fibre(
        [=](double s) -> Vec3 {
            const double arc = s * (2.0 * leg + pi * radius), angle = (arc - leg) / radius;
            if (angle < 0.0) return {arc, 0.0, 0.0};
            if (angle < pi)
                return {leg + radius * std::sin(angle), 1.2 * (1.0 - std::cos(angle)), radius - radius * std::cos(angle)};
            return {leg - (arc - leg - pi * radius), 2.4, 2.0 * radius};
        },
        1.0, 60);
    fibre.section = scene::elliptical(3.0, 1.0);
    fibre.director = Vec3::UnitY();
    Contacts<test::Beam> turned({fibre}, true);
    const double found = turned.least_gap(turned.mesh.rest_state());
    observe::Snapshot snapshot;
    snapshot.fibres.resize(1);
    snapshot.fibres[0].section = fibre.section;
    const Vector& rest = turned.mesh.rest_state();
    for (Index node = 0; node < turned.mesh.node_count(0); ++node) {
        const Index v = 3 * turned.mesh.node_vector(0, node);
        snapshot.fibres[0].position.push_back(rest.segment<3>(v));
        snapshot.fibres[0].director_1.push_back(rest.segment<3>(v + 3));
        snapshot.fibres[0].director_2.push_back(rest.segment<3>(v + 6));
    }
    const observe::LeastGap least = observe::least_gap(snapshot, proximity::GridSearch{}, observe::OwnTurns::counted);
    CHECK(least.gap > 1.0);
    CHECK(std::abs(found - least.gap) < 0.01);
}

/// A state with the second fibre moved along the normal of the first element until it is that deep in the first one.
template <class B>
Vector sunk(Contacts<B>& pair, Vector state, double depth) {
    for (int pass = 0; pass < 4; ++pass) {
        pair.set.detect(state, state, 0.5, false);
        const Vec3 way = -(pair.set.elements()[0].gap(state) + depth) * pair.set.elements()[0].normal;
        for (Index node = 0; node < pair.mesh.node_count(1); ++node) state.segment<3>(3 * pair.mesh.node_vector(1, node)) += way;
    }
    return state;
}

/// Forces against differences of the energy along random ways. They act where the two sections meet, half of the depth inside, so
/// that they have no moment: by so much of the size of a section they are not those of the two particles.
template <class B>
void check_energy(Contacts<B>& pair, const Vector& start) {
    for (const double depth : {1e-2, 1e-4}) {
        const Vector state = sunk(pair, start, depth);
        pair.set.detect(state, state, 0.5, false);
        const Vector force = pair.forces(state);
        CHECK(pair.set.figures(state).active > 2);
        std::mt19937 generator(7);
        std::normal_distribution<double> normal;
        for (int n = 0; n < 10; ++n) {
            Vector way(state.size());
            for (Index k = 0; k < way.size(); ++k) way[k] = normal(generator);
            const double e = 1e-4 * depth;  // the energy is a cubic of the gap at most
            const double slope = (pair.energy(state + e * way) - pair.energy(state - e * way)) / (2.0 * e);
            CHECK(std::abs(slope - force.dot(way)) < (depth + 1e-6) * force.norm());
        }
    }
}

TEST_CASE("contact forces are the slope of the contact energy although the normals of flat sections turn") {
    // Flat against flat askew, and pressed flat besides: sections across their fibres.
    Contacts<test::Beam> pair(
        {flat_fibre(2.0, Vec3::Zero(), heading(0), 20.0, 0.1, 6), flat_fibre(3.0, {0.0, 2.2, 1.65}, heading(0), 20.0, -0.2, 6)});
    Vector state = pair.mesh.rest_state();
    check_energy(pair, state);
    for (Index f = 0; f < 2; ++f)
        for (Index node = 0; node < pair.mesh.node_count(f); ++node) {
            state.segment<3>(3 * pair.mesh.node_vector(f, node, 1)) *= 1.05;
            state.segment<3>(3 * pair.mesh.node_vector(f, node, 2)) += Vec3(0, 0.05, -0.04);
        }
    check_energy(pair, state);
}

TEST_CASE_TEMPLATE("a rigid motion of flat fibres in contact turns their forces with it, and these have no moment", B, test::Beam,
                   beam::RigidSectionRod) {
    const auto fibres = [](const Mat3& turn) {
        std::vector<scene::FibreSpecification> made{flat_fibre(2.0, Vec3::Zero(), heading(0), 20.0, 0.1, 6),
                                                    flat_fibre(3.0, {0.5, 2.2, 1.65}, heading(0), 20.0, -0.2, 6),
                                                    flat_fibre(4.0, {0.0, 0.3, -2.02}, heading(12), 20.0, 0.15, 6)};
        for (scene::FibreSpecification& fibre : made)
            fibre.from = turn * fibre.from, fibre.to = turn * fibre.to, fibre.director = turn * fibre.director;
        return made;
    };
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    Contacts<B> here(fibres(Mat3::Identity())), there(fibres(turn));
    here.set.detect(here.mesh.rest_state(), here.mesh.rest_state(), 0.5, false);
    there.set.detect(there.mesh.rest_state(), there.mesh.rest_state(), 0.5, false);
    const Vector force = here.forces(here.mesh.rest_state()), turned = there.forces(there.mesh.rest_state());
    CHECK(here.set.figures(here.mesh.rest_state()).active > 2);
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (Index v = 0; v < here.mesh.layout().vectors(); ++v) {
        const Vec3 f = force.segment<3>(3 * v), y = here.mesh.rest_state().template segment<3>(3 * v);
        if (here.mesh.layout().kind[core::at(v)] == scene::VectorKind::position) {
            CHECK((turned.segment<3>(3 * v) - turn * f).norm() < 1e-9 * force.norm());
            sum += f;
            moment += y.cross(f);
        } else if constexpr (beam::TurningSections<B>) {
            moment += core::spin_matrix(y).inverse().transpose() * f;
        } else {
            moment += y.cross(f);
        }
    }
    CHECK(sum.norm() < 1e-12 * force.norm());
    CHECK(moment.norm() < 1e-11 * 20.0 * force.norm());
}

TEST_CASE("the mirror image of flat fibres in contact has the mirror image of their forces") {
    const auto fibres = [](double sign) {
        return std::vector<scene::FibreSpecification>{flat_fibre(2.0, Vec3::Zero(), heading(0), 20.0, sign * 0.1, 6),
                                                      flat_fibre(3.0, {0.0, sign * 2.2, 1.65}, heading(0), 20.0, -sign * 0.2, 6)};
    };
    Contacts<test::Beam> one(fibres(1.0)), other(fibres(-1.0));
    one.set.detect(one.mesh.rest_state(), one.mesh.rest_state(), 0.5, false);
    other.set.detect(other.mesh.rest_state(), other.mesh.rest_state(), 0.5, false);
    const Vector force = one.forces(one.mesh.rest_state()), image = other.forces(other.mesh.rest_state());
    CHECK(one.set.figures(one.mesh.rest_state()).active > 2);
    const Vec3 mirror(1, -1, 1);
    for (Index f = 0; f < 2; ++f)
        for (Index node = 0; node < one.mesh.node_count(f); ++node) {
            const Index v = 3 * one.mesh.node_vector(f, node);
            CHECK((image.segment<3>(v) - mirror.cwiseProduct(force.segment<3>(v))).norm() < 1e-10 * force.norm());
        }
}

TEST_CASE("a section that is ten and more times as wide as thick is touched on its contour, not at a round end") {
    for (const double ratio : {10.0, 20.0, 50.0}) {
        Contacts<test::Beam> pair({flat_fibre(ratio, Vec3::Zero(), heading(0), 10.0 * ratio, 0.0),
                                   flat_fibre(ratio, {0.0, 0.3, 2.1}, heading(90), 10.0 * ratio, 0.0)});
        CHECK(std::abs(pair.least_gap(pair.mesh.rest_state()) - 0.1) < 1e-9);
    }
}

}  // namespace element_normal_test

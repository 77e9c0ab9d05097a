// SPDX-License-Identifier: MIT
// A fibre inside a hollow one: gap, forces and tangent of its contact with the wall, and what is refused.
#include "fibres.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/bore_passage.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <random>

using namespace fibrant;

namespace bore_test {

using test::refusal;
using test::straight_fibre;

const double r = 0.02, bore = 1.5 * r, wall = 1.8 * r;

scene::FibreSpecification tube(const Vec3& from, const Vec3& to, Index elements) {
    scene::FibreSpecification fibre = straight_fibre(from, to, wall, elements);
    fibre.section = scene::hollow(wall, bore);
    return fibre;
}

/// A rod that leans against the wall of a tube, somewhere deeper and somewhere apart; the tube first or last.
template <class B>
struct Leaning {
    using Contacts = contact::ContactSet<B, proximity::GridSearch, law::RegularisedPenalty, law::RegularisedCoulomb>;
    scene::Assembly assembly;
    beam::Mesh<B> mesh;
    Contacts contacts;

    Leaning(bool tube_first, double friction) : assembly{scene_of(tube_first)}, mesh{assembly, B{}}, contacts{made(friction)} {}
    static scene::Assembly scene_of(bool tube_first) {
        const scene::FibreSpecification outer = tube({-0.3, 0, 0}, {0.3, 0.01, 0.01}, 6),
                                        inner = straight_fibre({-0.35, 0.4 * r, 0.01 * r}, {0.25, 0.57 * r + 0.01, 0.01}, r, 5);
        scene::Assembly assembly;
        assembly.add(tube_first ? outer : inner), assembly.add(tube_first ? inner : outer);
        assembly.add(scene::Tube{tube_first ? 0 : 1, {tube_first ? 1 : 0}});
        return assembly;
    }
    Contacts made(double friction) const {
        contact::ContactParameters parameters;
        parameters.stiffness.allowed_penetration = 0.05 * r;
        return {assembly,
                mesh,
                parameters,
                proximity::GridSearch{},
                law::RegularisedPenalty({.regularisation_depth = 0.005 * r}),
                law::RegularisedCoulomb({.friction_coefficient = friction, .reversible_displacement = 0.02 * r})};
    }
    Vector shaken(unsigned seed, double amount) const {
        std::mt19937 generator(seed);
        std::uniform_real_distribution<double> value(-1.0, 1.0);
        Vector state = mesh.rest_state();
        for (Index v = 0; v < mesh.layout().vectors(); ++v)
            for (int k = 0; k < 3; ++k)
                state[3 * v + k] += amount * (mesh.layout().kind[core::at(v)] == scene::VectorKind::position ? 0.02 * r : 0.02) *
                                    value(generator);
        return state;
    }
    Vector forces(const Vector& state) {
        contacts.evaluate(state);
        Vector sum = Vector::Zero(state.size());
        contacts.add_forces(sum);
        return sum;
    }
    double energy(const Vector& state) {
        contacts.evaluate(state);
        return contacts.figures(state).work;
    }
    /// The tangent of the last evaluation times a step.
    Vector product(const Vector& state, const Vector& along) const {
        using Mesh = beam::Mesh<B>;
        struct Point {
            std::int32_t first_i, first_j, fibre_i, fibre_j;
            beam::Particle<B> weights_i, weights_j;
            Mat3 stiffness;
        };
        std::vector<Point> points;
        for (Index k = 0; k < core::count(contacts.elements()); ++k) {
            const auto& element = contacts.elements()[core::at(k)];
            points.push_back({element.first_i, element.first_j, element.fibre_i, element.fibre_j, element.weights_i,
                              element.weights_j, contacts.point_tangent(k)});
        }
        contacts.bores().add_points(mesh, state, contacts, points);
        Vector sum = Vector::Zero(state.size());
        for (const Point& point : points) {
            const Vec3 force = point.stiffness * (Mesh::motion(along, point.first_j, point.weights_j) -
                                                  Mesh::motion(along, point.first_i, point.weights_i));
            beam::spread(point.weights_j, force, point.first_j, sum),
                beam::spread(point.weights_i, Vec3(-force), point.first_i, sum);
        }
        return sum;
    }
};

TEST_CASE_TEMPLATE("forces on the wall of a bore are the slope of their energy, and the tangent is all of their slope", B,
                   beam::RigidSectionRod, beam::KirchhoffCable) {
    for (const bool tube_first : {true, false}) {
        Leaning<B> scene(tube_first, 0.0);
        const Vector accepted = scene.shaken(3, 0.7), state = scene.shaken(1, 1.0),
                     along = scene.shaken(2, 1.0) - scene.mesh.rest_state();
        scene.contacts.detect(state, accepted, 0.1 * r, false);
        scene.contacts.evaluate(state);
        Index active = 0;
        for (const contact::ContactResponse& response : scene.contacts.responses()) active += response.reaction > 0.0 ? 1 : 0;
        CHECK(active >= 3);
        CHECK(active < core::count(scene.contacts.elements()));  // and some are open
        const double h = 1e-5;
        const Vector slope = (scene.forces(state + h * along) - scene.forces(state - h * along)) / (2.0 * h);
        const double work = (scene.energy(state + h * along) - scene.energy(state - h * along)) / (2.0 * h);
        const Vector here = scene.forces(state), product = scene.product(state, along);
        CHECK(here.dot(along) == test::near(work, 1e-6));  // differences
        std::printf("tangent off by %.1e\n", (product - slope).norm() / product.norm());
        CHECK((product - slope).norm() < 1e-6 * product.norm());
        CHECK(along.dot(product) > 0.0);
    }
}

TEST_CASE(
    "friction on a wall pushes a pair without a force or a moment on the whole, and its tangent is that of a standing bound") {
    using B = beam::RigidSectionRod;
    Leaning<B> scene(true, 0.3);
    const Vector accepted = scene.shaken(3, 0.7), state = scene.shaken(1, 1.0),
                 along = scene.shaken(2, 1.0) - scene.mesh.rest_state();
    scene.contacts.detect(state, accepted, 0.1 * r, false);
    scene.contacts.evaluate(state);
    scene.contacts.refresh(state, accepted);
    scene.contacts.evaluate(state);
    double most = 0.0;
    for (Index k = 0; k < core::count(scene.contacts.elements()); ++k) {
        const auto& element = scene.contacts.elements()[core::at(k)];
        const Vec3 force = scene.contacts.force(k), apart = element.offset(state);
        if (force.isZero(0.0)) continue;
        const Vec3 friction = force + scene.contacts.responses()[core::at(k)].reaction * element.normal;
        most = std::max(most, friction.norm() / scene.contacts.responses()[core::at(k)].reaction);
        CHECK(std::abs(friction.dot(element.normal)) < 1e-9 * force.norm());
        // Both act at one point, but for what a station is beside its plane along fibres that are shaken.
        const contact::PairTangents tangents = contact::pair_tangents(scene.mesh, state, element);
        const Vec3 along_both = contact::mean_tangent(tangents.i, tangents.j);
        CHECK((apart - apart.dot(along_both) * along_both).norm() < 1e-9 * r);
        CHECK(apart.norm() < 1e-3 * r);
    }
    CHECK(most == test::near(0.3, 1e-9));  // some slide
    const double h = 1e-6;
    const Vector slope = (scene.forces(state + h * along) - scene.forces(state - h * along)) / (2.0 * h);
    scene.contacts.evaluate(state);
    const Vector product = scene.product(state, along);
    std::printf("with friction: tangent off by %.1e\n", (product - slope).norm() / product.norm());
    CHECK((product - slope).norm() < 1e-2 * product.norm());  // the arm of friction moves, and is left out
}

TEST_CASE("the gap of a rod in a bore is the clearance less the distance of the axes, and open ends are free") {
    using B = beam::RigidSectionRod;
    scene::Assembly assembly;
    assembly.add(tube({-0.3, 0, 0}, {0.3, 0, 0}, 6));
    assembly.add(straight_fibre({-0.5, 0.3 * r, 0.4 * r}, {0.0, 0.3 * r, 0.4 * r}, r, 5));
    assembly.add(scene::Tube{0, {1}});
    const beam::Mesh<B> mesh(assembly, B{});
    contact::ContactParameters parameters;
    parameters.stiffness.allowed_penetration = 0.05 * r;
    contact::ContactSet<B, proximity::GridSearch, law::RegularisedPenalty, law::RegularisedCoulomb> contacts(
        assembly, mesh, parameters, proximity::GridSearch{}, law::RegularisedPenalty({.regularisation_depth = 0.005 * r}),
        law::RegularisedCoulomb({.friction_coefficient = 0.3, .reversible_displacement = 0.02 * r}));
    const Vector& state = mesh.rest_state();
    contacts.detect(state, state, 0.1 * r, false);
    contacts.evaluate(state);
    REQUIRE(!contacts.elements().empty());
    for (const auto& element : contacts.elements()) {
        CHECK(std::abs(element.gap(state)) < 1e-9 * r);  // 0.5 r of clearance, 0.5 r of distance
        CHECK((element.normal - Vec3(0, -0.6, -0.8)).norm() < 1e-9);
        CHECK(element.u_i > -1e-9);
        const double x = mesh.position(state, 1, element.u_j).x();
        CHECK(x > -0.3 - 1e-9);
    }
    const contact::BoreGap gap = contact::least_bore_gap(mesh, state);
    CHECK(std::abs(gap.gap) < 1e-9 * r);
    CHECK(gap.tube == 0);
    CHECK(gap.rod == 1);
}

TEST_CASE("a motion takes a rod through the wall of its tube, or by the end of it, or along with it") {
    using B = beam::RigidSectionRod;
    scene::Assembly assembly;
    assembly.add(tube({-0.3, 0, 0}, {0.3, 0, 0}, 6));
    assembly.add(straight_fibre({-0.4, 0.3 * r, 0}, {0.2, 0.3 * r, 0}, r, 6));
    assembly.add(scene::Tube{0, {1}});
    const beam::Mesh<B> mesh(assembly, B{});
    const auto moved = [&](const Vec3& tube_by, const Vec3& rod_by) {
        Vector to = mesh.rest_state();
        for (Index f = 0; f < 2; ++f)
            for (Index node = 0; node < mesh.node_count(f); ++node)
                to.segment<3>(3 * mesh.node_vector(f, node)) += f == 0 ? tube_by : rod_by;
        return contact::through_walls(mesh, mesh.rest_state(), to);
    };
    const Vec3 still = Vec3::Zero();
    CHECK(moved(still, still).empty());
    CHECK(moved(still, {0, 0.5 * r, 0}).empty());              // deep, but its axis is in the bore
    CHECK(moved(still, {-2.0, 0, 0}).empty());                 // drawn out
    CHECK(moved({0, 40.0 * r, 0}, {0, 40.0 * r, 0}).empty());  // with the tube
    CHECK(moved(still, {-0.45, 0, 0}).empty());                // nearly out
    const auto through = moved(still, {0, 2.0 * r, 0}), far = moved({0, 0, -0.5}, {0, 0, 0.5});
    REQUIRE(through.size() == 1);
    REQUIRE(far.size() == 1);
    CHECK(through.front().bore);
    CHECK(through.front().fibre == 1);
    CHECK(through.front().other == 0);
    CHECK(through.front().touch <= 0.1);  // its clearance is 0.2 r
    CHECK(contact::text(through.front()).starts_with("fibre 1 at 0.1667 of its length leaves through the wall of fibre 0 at 0"));
    CHECK(far.front().time < 0.1);
}

TEST_CASE("tubes and rods that cannot be are refused by fibre and value") {
    const scene::FibreSpecification outer = tube({-0.3, 0, 0}, {0.3, 0, 0}, 6),
                                    inner = straight_fibre({0, 0, 0}, {1, 0, 0}, r, 4),
                                    thick = straight_fibre({0, 0, 0}, {1, 0, 0}, 1.6 * r, 4);
    const auto said = [&](const scene::Tube& tube) {
        scene::Assembly assembly;
        assembly.add(outer), assembly.add(inner), assembly.add(thick);
        return refusal([&] { assembly.add(tube); });
    };
    CHECK(said({0, {1}}).empty());
    CHECK(said({1, {0}}) == "Tube.fibre: CrossSection.bore = 0, but it must be > 0 (fibre 1)");
    CHECK(said({0, {2}}) ==
          "CrossSection.semi_axis_1 = 0.032, but it must be <= 0.03, the bore that it is in (fibre 2 in fibre 0)");
    CHECK(said({0, {0}}) == "Tube.rods = 0, but it must be another fibre than the tube (fibre 0 in fibre 0)");
    CHECK(said({0, {1, 1}}) == "Tube.rods = 1, but it must be listed once (fibre 1 in fibre 0)");
    CHECK(said({0, {}}) == "Tube.rods = none, but it must be one fibre at least (fibre 0)");
    CHECK(said({0, {3}}) == "Tube: fibre = 3, but it must be a fibre of this assembly");
    // Beside the tube where a run begins; in front of it is fine.
    const auto begun = [&](const Vec3& by) {
        scene::Assembly assembly;
        scene::FibreSpecification moved = inner;
        moved.from += by, moved.to += by;
        assembly.add(outer), assembly.add(moved), assembly.add(scene::Tube{0, {1}});
        const beam::Mesh<beam::RigidSectionRod> mesh(assembly, beam::RigidSectionRod{});
        return refusal([&] { contact::require_in_bores(mesh); });
    };
    CHECK(begun({0, 1.4 * r, 0}).empty());
    CHECK(begun({0.4, 9.0 * r, 0}).empty());
    CHECK(
        begun({0, 2.0 * r, 0}) ==
        "Tube.rods: distance from the tube's axis = 0.04, but it must be < 0.03, its bore (fibre 1 in fibre 0, at (0, 0.04, 0))");
}

}  // namespace bore_test

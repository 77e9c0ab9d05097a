// SPDX-License-Identifier: MIT
// Closed fibres in contact: with each other, and with themselves.
#include "simulation/closed_rings.hpp"

#include <fibrant/simulation/refined_state.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <string>

using namespace fibrant;

namespace closed_contact_test {

using test::pi;

using Rubbing = test::EveryDirector;

simulation::ModelParameters<Rubbing> parameters(double radius, double friction) {
    simulation::ModelParameters<Rubbing> p;
    p.solver.strategy = "two_level_pcg";
    p.normal.regularisation_depth = 1e-3 * radius;
    p.contact.stiffness.allowed_penetration = 1e-2 * radius;
    p.friction = {.friction_coefficient = friction, .reversible_displacement = 1e-2 * radius};
    return p;
}

/// The node of a fibre of `nodes` at a share of the way around, where the first lies at `shift`.
scene::Station at(Index fibre, Index nodes, double share, double shift) {
    const double n = static_cast<double>(nodes), place = std::round((share - shift) * n) / n;
    return {fibre, place - std::floor(place)};
}

/// Two rings of unit radius and bending stiffness, one through the other at a right angle, pulled until each is 2.0702675 R long,
/// as under F R^2 / EI = 0.5 in the plane elastica.
struct LinkedRings {
    double shift_a = 0.0, shift_b = 0.5;  // where the first nodes lie; they meet at 0 and 0.5
    double friction = 0.0;
    Index elements = 40;
    static constexpr double radius = 0.02;

    scene::Assembly assembly() const {
        const Index nodes = 2 * elements;
        scene::Assembly assembly;
        for (const bool second : {false, true})
            assembly.add({.curve =
                              [second, shift = second ? shift_b : shift_a](double t) {
                                  const double a = 2.0 * pi * (t + shift);
                                  return second ? Vec3(2.0 - 2.0 * radius + std::cos(a), 0, std::sin(a))
                                                : Vec3(std::cos(a), std::sin(a), 0);
                              },
                          .section = scene::circular(radius),
                          .material = {.young_modulus = 4.0 / (pi * std::pow(radius, 4)), .poisson_ratio = 0.3},
                          .elements = elements,
                          .closed = true});
        const Mat3 across = Vec3(0, 1, 1).asDiagonal();
        assembly.hold_position(at(0, nodes, 0.5, shift_a));
        assembly.hold_position(at(0, nodes, 0.0, shift_a), across);
        assembly.hold_position(at(0, nodes, 0.25, shift_a), Vec3(0, 0, 1).asDiagonal());
        assembly.prescribe(driven(), Vec3(2.0 * 2.0702675 - 4.0, 0, 0));
        assembly.hold_position(at(1, nodes, 0.5, shift_b), across);
        assembly.hold_position(at(1, nodes, 0.25, shift_b), Vec3(0, 1, 0).asDiagonal());
        return assembly;
    }
    scene::Station driven() const { return at(1, 2 * elements, 0.0, shift_b); }
    simulation::ModelParameters<Rubbing> tight() const {
        simulation::ModelParameters<Rubbing> p = parameters(radius, friction);
        p.iteration.linear_tolerance = 1e-8, p.iteration.step_tolerance = 1e-6, p.iteration.residual_tolerance = 1e-6;
        p.iteration.contact_tolerance = 1e-5, p.iteration.normal_step_tolerance = 1e-5, p.iteration.normal_tolerance = 1e-6;
        return p;
    }
    /// Force of the pull [EI / R^2].
    double pull() const {
        simulation::Simulator<Rubbing> simulator(assembly(), tight());
        const simulation::Report report = simulator.run({.increments = 5});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        CHECK(report.contact.greatest_penetration < 0.01 * radius);
        return simulator.reaction(driven()).x();
    }
};

TEST_CASE("two linked rings pull as the elastica says, wherever their first nodes lie, at the contact too") {
    const double away = LinkedRings{0.3, 0.1}.pull();
    std::printf("linked rings: F = %.6f EI / R^2\n", away);
    CHECK(std::abs(away / 0.5 - 1.0) < 5e-3);  // r = R / 50: shear and stretch of 0.2 %, the penetration of 0.3 % of the pull
    for (const double friction : {0.0, 0.2})
        for (const double shift : {0.5, 0.2}) {
            const double force = LinkedRings{0.0, shift, friction}.pull();
            std::printf("first nodes at 0 and %.1f, friction %.1f: off by %.1e\n", shift, friction, force / away - 1.0);
            CHECK(std::abs(force / away - 1.0) < 1e-5);  // passes settle to 1e-5 r
        }
}

TEST_CASE("an interrupted run of closed fibres goes on to the same bits, and its elements may be cut") {
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_closed_contact_test.bin").string();
    std::filesystem::remove(file);
    const LinkedRings rings{0.0, 0.5, 0.2};
    simulation::Loading<Rubbing> loading{.increments = 5};
    simulation::Simulator<Rubbing> whole(rings.assembly(), rings.tight());
    REQUIRE(whole.run(loading).converged);
    struct Interruption {};
    struct Interrupter {
        void reported(const simulation::IncrementReport& increment) const {
            if (increment.number == 3) throw Interruption{};
        }
    } interrupter;
    loading.checkpoint = file;
    simulation::Simulator<Rubbing> first(rings.assembly(), rings.tight());
    CHECK_THROWS_AS(first.run(loading, interrupter), Interruption);
    loading.resume = true;
    simulation::Simulator<Rubbing> second(rings.assembly(), rings.tight());
    REQUIRE(second.run(loading).converged);
    CHECK(second.state() == whole.state());
    CHECK(second.reaction(rings.driven()) == whole.reaction(rings.driven()));

    LinkedRings finer = rings;
    finer.elements = 80;
    const beam::Mesh<Rubbing::Beam> coarse(rings.assembly(), whole.beam()), fine(finer.assembly(), whole.beam());
    const Vector refined = simulation::refined<Rubbing>(simulation::read_state<Rubbing>(file, coarse), coarse, fine, 2).state;
    for (Index f = 0; f < 2; ++f)
        for (double u = -3.0; u < 43.0; u += 0.37)
            CHECK((fine.position(refined, f, 2.0 * u) - coarse.position(whole.state(), f, u)).norm() < 1e-12);
    for (const scene::ImageVector& one : fine.layout().images)
        CHECK(refined.segment<3>(3 * one.image) == refined.segment<3>(3 * one.source));
    std::filesystem::remove(file);
}

TEST_CASE("a trefoil of a straight fibre relaxes to a circle that it runs through twice, around a fibre's own seam") {
    double energy = 0.0;
    for (const Index first : {0, 13}) {
        const Index elements = 48;
        const double radius = 0.1, shift = static_cast<double>(first) / static_cast<double>(elements);
        scene::Assembly assembly;
        assembly.add({.start =
                          [=](double t) {
                              const double a = 2.0 * pi * (t + shift), rho = 1.0 + 0.4 * std::cos(3.0 * a);
                              return Vec3(rho * std::cos(2.0 * a), rho * std::sin(2.0 * a), 0.4 * std::sin(3.0 * a));
                          },
                      .section = scene::circular(radius),
                      .material = {.young_modulus = 4.0 / (pi * std::pow(radius, 4)), .poisson_ratio = 0.3},
                      .elements = elements,
                      .closed = true});
        assembly.hold_position(at(0, 2 * elements, 0.0, shift));
        for (const double third : {1.0 / 3.0, 2.0 / 3.0})
            assembly.hold_position(at(0, 2 * elements, third, shift), Vec3(0, 0, 1).asDiagonal());
        simulation::ModelParameters<Rubbing> p = parameters(radius, 0.0);
        p.contact.detection.self_contact = true;
        simulation::Stage<Rubbing> relax;
        relax.name = "relax", relax.increments = 1, relax.most_increments = 100;
        relax.damping = 2.0, relax.damping_decay = 0.7, relax.damping_calm = 0.3 * radius,
        relax.largest_displacement = 2.0 * radius;
        relax.damping_share = 1e-4;  // the fibre may spin about its own axis, which nothing else holds
        relax.until = simulation::until_settled(1e-3 * radius, 0.02 * radius);
        simulation::Simulator<Rubbing> simulator(assembly, p);
        const simulation::Report report = simulator.run({.stages = {relax}});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const double length = simulator.mesh().fibre(0).length();
        // Two turns of a helix on a torus: curvature a little below that of the circle.
        const double circle = 0.5 * std::pow(4.0 * pi, 2) / length;
        std::printf("trefoil: elastic energy %.6f, of the circle twice %.6f, %td contacts, deepest %.4f r\n",
                    report.energy.elastic, circle, report.contact.active, report.contact.greatest_penetration / radius);
        CHECK(report.energy.elastic > circle);
        CHECK(report.energy.elastic < 1.1 * circle);
        CHECK(report.contact.active >=
              48);  // it lies beside itself all along: once half-way around its length, two points an element
        CHECK(report.contact.greatest_penetration < 0.01 * radius);
        if (first > 0) CHECK(std::abs(report.energy.elastic / energy - 1.0) < 1e-5);
        energy = report.energy.elastic;
        for (const auto& element : simulator.contacts().elements()) {
            CHECK(element.u_i <= element.u_j);
            CHECK(element.u_j < static_cast<double>(elements));
        }
    }
}

}  // namespace closed_contact_test

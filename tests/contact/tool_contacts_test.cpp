// SPDX-License-Identifier: MIT
// Fibres against rigid planes, cylinders and spheres: forces and tangent by differences, reactions by balance, and scenes
// whose answer is known.
#include "../support/random_vector.hpp"

#include <contact/contact_model.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/directed_friction.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <random>

using namespace fibrant;

namespace tool_contacts_test {

using test::Beam;
using test::Mesh;
using test::straight_fibre;

const double r = 0.02, pi = std::numbers::pi;
const law::RegularisedPenalty penalty({.regularisation_depth = 0.005 * r});
const law::RegularisedCoulomb coulomb({.friction_coefficient = 0.3, .reversible_displacement = 0.02 * r});

using Pressing = test::EveryDirector;
using Tools = contact::ToolContacts<Beam, law::RegularisedPenalty, law::RegularisedCoulomb>;
using Simulator = simulation::Simulator<Pressing>;

// Without the part there is not a byte of it.
static_assert(std::is_same_v<simulation::Simulator<test::Smooth>::Contacts,
                             contact::ContactSet<Beam, proximity::GridSearch, law::RegularisedPenalty, law::Frictionless>>);

scene::Tool plane(const Vec3& origin, const Vec3& normal) {
    scene::Tool tool;
    tool.origin = origin, tool.axis = normal;
    return tool;
}
scene::Tool round(scene::ToolShape shape, const Vec3& origin, const Vec3& axis, double radius, bool hollow = false) {
    scene::Tool tool;
    tool.shape = shape, tool.origin = origin, tool.axis = axis, tool.radius = radius, tool.hollow = hollow;
    return tool;
}

/// A bent fibre with an elliptical section in the middle of all kinds of tools, each a little too close.
scene::Assembly crowded() {
    scene::Assembly assembly;
    scene::FibreSpecification fibre = straight_fibre({-0.3, 0, 0}, {0.3, 0.01, 0.01}, r, 6);
    fibre.section = scene::elliptical(1.1 * r, 0.9 * r);
    fibre.director = Vec3(0, 1, 0.4);
    assembly.add(fibre);
    assembly.add(plane({0, 0, -0.93 * r}, {0.02, 0.03, 2.0}));
    assembly.add(round(scene::ToolShape::cylinder, {-0.1, 0, 0.3 + 0.9 * r}, {0.1, 1, 0}, 0.3));
    assembly.add(round(scene::ToolShape::sphere, {0.2, 0.2 + 0.93 * r, 0}, Vec3::UnitZ(), 0.2));
    assembly.add(round(scene::ToolShape::cylinder, {0, 0, 0}, {1, 0, 0}, 1.02 * r, true));
    assembly.add(round(scene::ToolShape::sphere, {0.05, 0, 0}, Vec3::UnitZ(), 0.3, true));
    return assembly;
}

Vector shaken(const Mesh& mesh, unsigned seed, double amount) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    Vector state = mesh.rest_state();
    for (Index v = 0; v < mesh.layout().vectors(); ++v)
        for (int k = 0; k < 3; ++k)
            state[3 * v + k] +=
                amount * (mesh.layout().kind[core::at(v)] == scene::VectorKind::position ? 0.02 * r : 0.05) * value(generator);
    return state;
}

Vector forces(const Tools& tools, Index size) {
    Vector sum = Vector::Zero(size);
    tools.add_forces(sum);
    return sum;
}

simulation::ModelParameters<Pressing> parameters(double mu) {
    auto all = test::pressed_parameters<Pressing>(1e-3 * r);
    all.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * r};
    // As it is given, or reactions would creep where nothing moves.
    all.contact.stiffness.initial_fraction = all.contact.stiffness.floor_fraction = all.contact.stiffness.cap_fraction = 10.0;
    return all;
}

TEST_CASE("the distance of a point from a tool grows along its normal by as much as the point moves") {
    std::mt19937 generator(7);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    const scene::Assembly assembly = crowded();
    for (const scene::Tool& tool : assembly.tools())
        for (int n = 0; n < 20; ++n) {
            const Vec3 x = 0.1 * test::random_vector(value, generator);
            const scene::ToolDistance here = scene::tool_distance(tool, x);
            CHECK(std::abs(here.normal.norm() - 1.0) < 1e-14);
            CHECK(std::abs(scene::tool_distance(tool, x - here.distance * here.normal).distance) < 1e-14);
            for (int k = 0; k < 3; ++k) {
                const double h = 1e-6;
                const Vec3 step = h * Vec3::Unit(k);
                const double slope =
                    (scene::tool_distance(tool, x + step).distance - scene::tool_distance(tool, x - step).distance) / (2 * h);
                CHECK(std::abs(slope - here.normal[k]) < 1e-7);  // h^2 over the smallest square of a radius, and rounding / h
            }
        }
}

TEST_CASE("forces of tools are the slope of their energy, and the tangent is the slope of the forces") {
    const scene::Assembly assembly = crowded();
    const Mesh mesh(assembly, Beam{});
    contact::StiffnessAdaptation adaptation;
    adaptation.allowed_penetration = 0.05 * r;
    for (const bool rough : {false, true}) {
        // Friction is only in the tangent at a standing bound, and it is not the slope of an energy.
        const law::RegularisedCoulomb friction({.friction_coefficient = rough ? 0.3 : 0.0, .reversible_displacement = 0.02 * r});
        Tools tools(assembly, mesh, adaptation, 2.0);
        const Vector accepted = shaken(mesh, 3, 0.7);
        tools.detect(mesh.rest_state(), accepted, 0.1 * r, penalty);
        tools.evaluate(mesh.rest_state(), penalty, friction);
        tools.hold_reactions();
        const Vector state = shaken(mesh, 1, 1.0), along = shaken(mesh, 2, 1.0) - mesh.rest_state();
        const auto figures = [&](const Vector& at) {
            tools.evaluate(at, penalty, friction);
            contact::ContactFigures sum;
            tools.add_figures(at, penalty, sum);
            return sum;
        };
        CHECK(figures(state).active > 20);
        const double h = 1e-6;
        const Vector ahead = state + h * along, behind = state - h * along;
        const double energy_slope = (figures(ahead).work - figures(behind).work) / (2 * h);
        const Vector force_ahead = (tools.evaluate(ahead, penalty, friction), forces(tools, state.size()));
        const Vector force_behind = (tools.evaluate(behind, penalty, friction), forces(tools, state.size()));
        const Vector force_slope = (force_ahead - force_behind) / (2 * h);
        tools.evaluate(state, penalty, friction);
        const Vector here = forces(tools, state.size());
        if (!rough) CHECK(std::abs(here.dot(along) / energy_slope - 1.0) < 1e-6);
        Vector product = Vector::Zero(state.size());
        tools.stiffness_terms(0, state, [&](Index first, const beam::ElementWeights<Beam>& weights, const Mat3& stiffness) {
            CHECK((stiffness - stiffness.transpose()).norm() <= 1e-12 * stiffness.norm());
            const Vec3 force = stiffness * Mesh::point(along, first, weights);
            for (std::size_t a = 0; a < weights.size(); ++a)
                product.segment<3>(first + 3 * static_cast<Index>(a)) += weights[a] * force;
        });
        // Without friction the tangent is complete. The friction's arm moves with the support too, and that small part is left
        // out, as between fibres: it would not be symmetric.
        std::printf("%s: tangent off by %.1e\n", rough ? "rough" : "smooth", (product - force_slope).norm() / product.norm());
        CHECK((product - force_slope).norm() < (rough ? 5e-2 : 1e-6) * product.norm());
    }
}

TEST_CASE("an oval section touches a round tool where its contour is nearest, and the audit sees the same gap") {
    // A straight fibre beside a cylinder of half its width, along it and at a slant, its section turned by any angle. Against:
    // the least distance of a thousand points of the contour from the cylinder.
    const double wide = 3.0 * r, thin = r;
    for (const bool hollow : {false, true})
        for (const double slant : {0.0, 0.6})
            for (int k = 0; k < 12; ++k) {
                const double turn = 0.05 + k * pi / 12.0;
                scene::FibreSpecification fibre = straight_fibre({-0.3, 0, 0}, {0.3, 0, 0}, r, 6);
                fibre.section = scene::elliptical(wide, thin);
                fibre.director = Vec3(0.0, std::cos(turn), std::sin(turn));
                scene::Assembly assembly;
                assembly.add(fibre);
                const double depth = 0.2 * thin, radius = hollow ? 2.0 * wide : 0.5 * wide,
                             height = std::hypot(wide * std::sin(turn), thin * std::cos(turn));
                const double centre = hollow ? -(radius - height + depth) : radius + height - depth;
                const Vec3 axis(std::cos(slant), std::sin(slant), 0.0), at(0.0, 0.0, centre);
                const scene::Tool tool = round(scene::ToolShape::cylinder, at, axis, radius, hollow);
                assembly.add(tool);
                const Mesh mesh(assembly, Beam{});
                Tools tools(assembly, mesh, {}, 2.0);
                tools.detect(mesh.rest_state(), mesh.rest_state(), 2.0 * thin, penalty);
                double seen = 1.0, true_gap = 1.0;
                for (const auto& element : tools.elements()) {
                    if (element.u != 3.0) continue;  // the middle, above the cylinder
                    seen = element.gap(mesh.rest_state());
                    for (int p = 0; p < 1000; ++p) {
                        const double angle = 2.0 * pi * p / 1000.0, y = wide * std::cos(angle), z = thin * std::sin(angle);
                        const Vec3 x(0.0, y * std::cos(turn) - z * std::sin(turn), y * std::sin(turn) + z * std::cos(turn));
                        true_gap = std::min(true_gap, scene::tool_distance(tool, x).distance);
                    }
                }
                CHECK(std::abs(true_gap) < thin);                // near enough to matter
                CHECK(std::abs(seen - true_gap) < 1e-4 * thin);  // half the square of the points' distance, over the radius
                const auto audited =
                    observe::tool_gap(simulation::detail::curves_of(mesh, mesh.rest_state()).fibres[0], tool, {});
                if (slant == 0.0) CHECK(std::abs(audited.gap - true_gap) < 2e-3 * thin);
            }
}

TEST_CASE("the audit finds where a fibre is nearest to a tool, touching or not") {
    // A fibre that comes down to a plane and goes up again, its ends higher than its middle: least in the middle, far from all.
    for (const double height : {1.5, 20.0}) {
        scene::FibreSpecification fibre = straight_fibre({-0.3, 0, 0}, {0.3, 0, 0}, r, 6);
        fibre.curve = [height](double t) { return Vec3(0.6 * t, 0.0, height * r + 0.4 * r * std::cos(2.0 * pi * t)); };
        scene::Assembly assembly;
        assembly.add(fibre);
        const scene::Tool tool = plane({0, 0, 0}, Vec3::UnitZ());
        const Mesh mesh(assembly, Beam{});
        const auto seen = observe::tool_gap(simulation::detail::curves_of(mesh, mesh.rest_state()).fibres[0], tool, {});
        CHECK(std::abs(seen.gap - (height - 0.4 - 1.0) * r) < 1e-3 * r);  // the height of the middle, less a radius
    }
}

TEST_CASE("what a tool feels is what its fibre feels, turned round") {
    const scene::Assembly assembly = crowded();
    const Mesh mesh(assembly, Beam{});
    contact::StiffnessAdaptation adaptation;
    adaptation.allowed_penetration = 0.05 * r;
    Tools tools(assembly, mesh, adaptation, 2.0);
    tools.detect(mesh.rest_state(), shaken(mesh, 3, 0.7), 0.1 * r, penalty);
    tools.evaluate(mesh.rest_state(), penalty, coulomb);
    const Vector on_fibre = -forces(tools, mesh.rest_state().size());
    Vec3 sum = Vec3::Zero(), total = Vec3::Zero();
    for (Index node = 0; node < mesh.node_count(0); ++node) total += on_fibre.segment<3>(3 * mesh.node_vector(0, node));
    double scale = 0.0;
    for (Index t = 0; t < 5; ++t) sum += tools.reaction(t).force, scale += tools.reaction(t).force.norm();
    CHECK(scale > 0.0);
    CHECK((sum + total).norm() < 1e-12 * scale);
}

TEST_CASE("a fibre pressed between two plates carries what the theory of its section says, and gives it to both") {
    // The section between two opposite line loads: the closed form of the St Venant-Kirchhoff law, E_11 = S_11 / E with the
    // length free to change (section.json), S_11 = -2 r p / (A |g_1|).
    const double length = 1.0, squeeze = 0.01;  // of the diameter
    scene::Assembly assembly;
    scene::FibreSpecification fibre = straight_fibre({0, 0, 0}, {length, 0, 0}, r, 20);
    fibre.director = Vec3::UnitZ();
    assembly.add(fibre);
    assembly.hold_position({0, 0.5});
    assembly.hold_axial_rotation({0, 0.5});
    scene::Tool below = plane({0, 0, -r}, Vec3::UnitZ()), above = plane({0, 0, r}, -Vec3::UnitZ());
    below.displacement = {0, 0, squeeze * r}, above.displacement = {0, 0, -squeeze * r};
    assembly.add(below), assembly.add(above);
    Simulator simulator(assembly, parameters(0.0));
    const simulation::Report report = simulator.run(test::stage<Pressing>({{"tools", 1.0}}, 6));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const Vec3 down = simulator.contacts().tools().reaction(0).force, up = simulator.contacts().tools().reaction(1).force;
    double load = 0.0;  // mean along the fibre, by Simpson's rule
    for (Index node = 0; node <= 40; ++node) {
        const double stretch = simulator.value({0, static_cast<double>(node) / 40.0}, scene::NodeVector::director_1).norm();
        const double weight = node % 2 == 1 ? 4.0 / 120.0 : (node == 0 || node == 40 ? 1.0 : 2.0) / 120.0;
        load -= weight * 0.5 * (stretch * stretch - 1.0) * test::glass.young_modulus * pi * r * r * stretch / (2.0 * r);
        CHECK(std::abs(stretch - (1.0 - squeeze)) < 0.2 * squeeze);  // the rest is penetration
    }
    std::printf("plates: %.6f N/mm below, %.6f above, %.6f expected; energy %.2e of %.2e missing\n", -down.z() / length,
                up.z() / length, load, report.energy.error(), report.energy.external);
    CHECK((down + up).norm() < 1e-6 * up.norm());
    // Observers and files are shown what presses.
    const observe::Snapshot shot = simulator.snapshot();
    Vec3 shown[2]{Vec3::Zero(), Vec3::Zero()};
    for (const observe::ToolContactSnapshot& contact : shot.tool_contacts)
        shown[contact.tool] += contact.friction - contact.reaction * contact.normal;
    CHECK((shown[0] - down).norm() < 1e-12 * down.norm());
    CHECK((shown[1] - up).norm() < 1e-12 * up.norm());
    CHECK(shot.contacts.empty());
    CHECK(std::abs(up.z() / length / load - 1.0) < 1e-3);
    CHECK(report.energy.external > 0.0);
    CHECK(std::abs(report.energy.error()) < 1e-3 * report.energy.external);  // the trapezoidal rule over six increments
}

TEST_CASE("a fibre pressed on a rough plate is dragged along with it, and slips at the friction of its pressure") {
    const double mu = 0.15, law = 0.3;  // by the tool's own factor
    scene::Assembly assembly;
    assembly.add(straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    scene::Tool table = plane(Vec3::Zero(), Vec3::UnitZ());
    table.channel = "table", table.displacement = {0, 0.02 * r, 0};  // a reversible displacement
    table.friction_factor = mu / law;
    assembly.add(table);
    for (const double end : {0.0, 1.0}) assembly.clamp({0, end}, Vec3(0, 0, -0.01 * r), Vec3::Zero(), Vec3::Zero(), "press");
    Simulator simulator(assembly, parameters(law));
    simulation::Report report = simulator.run(test::stage<Pressing>({{"press", 1.0}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const auto felt = [&] { return simulator.contacts().tools().reaction(0).force; };
    const Vec3 before = felt();
    CHECK(before.head<2>().norm() < 1e-6 * before.norm());
    // Friction holds the fibre's middle while its ends are held still: a part of the reversible way is in the fibre.
    report = simulator.run(test::stage<Pressing>({{"table", 0.25}}, 2));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double quarter = -felt().y();
    CHECK(quarter > 0.1 * mu * -before.z());
    CHECK(quarter < 0.25 * mu * -before.z() * 1.001);
    CHECK(report.energy.dissipated == 0.0);
    report = simulator.run(test::stage<Pressing>({{"table", 0.0}}, 2));
    CHECK(std::abs(felt().y()) < 1e-3 * quarter);  // elastic
    report = simulator.run(test::stage<Pressing>({{"table", 20.0}}, 40));
    REQUIRE_MESSAGE(report.converged, report.reason);
    std::printf("plate: presses %.5f N, drags %.5f N, ratio %.5f\n", -felt().z(), -felt().y(), felt().y() / felt().z());
    CHECK(std::abs(felt().y() / felt().z() - mu) < 1e-3 * mu);
    CHECK(report.energy.dissipated > 0.0);
    std::printf("energy %.2e of %.2e missing\n", report.energy.error(), report.energy.external);
    CHECK(std::abs(report.energy.error()) <
          0.002 * report.energy.external);  // increments of half the reversible way: the force bends within none
}

TEST_CASE("friction by a power of the pressure does not see how many stations of an element press on a round tool") {
    // A rod of straight elements around a pin, turned about it: of two stations an element, nodes do not touch, by less than they
    // are shown, or both press.
    using Rod = beam::RigidSectionRod;
    const Index elements = 24;
    const double R = 0.5, h = 0.05, a = 0.3, n = 0.8, turn = h / R, sagitta = 0.125 * h * turn;
    const law::DirectedFriction friction(
        {.along = a, .across = a, .exponent = n, .crossing_along = a, .crossing_across = a, .reversible_displacement = 1e-4 * r});
    scene::Assembly assembly;
    assembly.add(straight_fibre({0, 0, 0}, {h * static_cast<double>(elements), 0, 0}, r, elements));
    assembly.add(round(scene::ToolShape::cylinder, {0, 0, 0}, {0, 0, 1}, R));
    const beam::Mesh<Rod> mesh(assembly, Rod());
    for (const double deep : {0.5 * sagitta, 10.0 * sagitta}) {
        const auto around = [&](double by) {
            Vector state = mesh.rest_state();
            for (Index k = 0; k <= elements; ++k) {
                const double angle = turn * static_cast<double>(k - elements / 2) - by, away = R + r + sagitta - deep;
                state.segment<3>(6 * k) = away * Vec3(std::sin(angle), std::cos(angle), 0.0);
                state.segment<3>(6 * k + 3) =
                    core::rotation_vector(core::turn_about(Vec3::UnitZ(), -angle) * core::rotation(state.segment<3>(6 * k + 3)));
            }
            return state;
        };
        contact::ToolContacts<Rod, law::RegularisedPenalty, law::DirectedFriction> tools(assembly, mesh,
                                                                                         {.allowed_penetration = r}, 2.0);
        const Vector accepted = around(0.01), state = around(0.0);
        tools.detect(state, accepted, 0.1 * r, penalty);
        for (int pass = 0; pass < 2; ++pass) tools.refresh(state, accepted, penalty), tools.evaluate(state, penalty, friction);
        contact::ContactFigures sum;
        tools.add_figures(state, penalty, sum);
        CHECK(sum.active == (deep < sagitta ? elements : 2 * elements + 1));
        const double length = h * static_cast<double>(elements),
                     bound = a * std::pow(sum.reaction_sum, n) * std::pow(length, 1.0 - n);
        const double held = std::abs(tools.reaction(0).moment.z()) / R;
        std::printf("%td stations press on the pin: friction %.4f of a continuous line's\n", sum.active, held / bound);
        CHECK(held == test::near(bound, 0.015));  // outer stations of the line stand for three quarters
    }
}

TEST_CASE("a tool that comes closer in long steps does not hold by more than the friction of what it presses with") {
    // Each step begins with the tool deep in the fibre: what that overlap would press with bounds nothing.
    const double mu = 0.15;
    scene::Assembly assembly;
    assembly.add(straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    scene::Tool table = plane(Vec3::Zero(), Vec3::UnitZ());
    table.displacement = {0, 2.0 * r, 0.5 * r};
    assembly.add(table);
    for (const double end : {0.0, 1.0}) assembly.clamp({0, end});
    auto ordinary = parameters(mu);
    ordinary.iteration = {};
    ordinary.contact.stiffness.initial_fraction = 1.0;
    Simulator simulator(assembly, ordinary);
    simulation::Loading<Pressing> loading = test::stage<Pressing>({{"tools", 1.0}}, 20);
    loading.stages[0].looseness = 1000.0;  // a single pass an increment
    struct Held {
        const Simulator* simulator;
        std::vector<double> ratios{};
        void reported(const simulation::IncrementReport&) {
            const Vec3 sum = simulator->reaction({0, 0.0}) + simulator->reaction({0, 1.0});
            ratios.push_back(std::abs(sum.y() / sum.z()));
        }
    } held{&simulator};
    const simulation::Report report = simulator.run(loading, held);
    REQUIRE_MESSAGE(report.converged, report.reason);
    for (const double ratio : held.ratios)
        CHECK(ratio < 1.05 * mu);  // bounds are those of the increment before, and the pressure grows
    CHECK(held.ratios.back() > 0.8 * mu);
}

TEST_CASE("a stuck fibre that turns with its tool feels nothing of it") {
    // From -1 to 0 the fibre is pressed on a drum and drawn along it by a part of the reversible way; then both turn about the
    // drum's axis as one rigid body.
    const double R = 0.3;
    const auto turned = [](double a) { return Mat3(Eigen::AngleAxisd(std::max(a, 0.0), Vec3::UnitZ())); };
    scene::Assembly assembly;
    assembly.add(straight_fibre({-0.1, R + r, 0}, {0.1, R + r, 0}, r, 5));
    scene::Tool drum = round(scene::ToolShape::cylinder, Vec3::Zero(), Vec3::UnitZ(), R);
    drum.channel = "turn", drum.rotation = turned;
    assembly.add(drum);
    for (const double end : {0.0, 1.0})
        for (const auto vector : {scene::NodeVector::position, scene::NodeVector::director_1, scene::NodeVector::director_2}) {
            scene::Hold hold;
            hold.at = {0, end}, hold.vector = vector, hold.channel = "turn", hold.rotation = turned;
            if (vector == scene::NodeVector::position)
                hold.path = [=](double a) {
                    const double pressed = 1.0 + std::min(a, 0.0);
                    return Vec3(turned(a) * Vec3(0.008 * r * pressed, -0.02 * r * pressed, 0.0));
                };
            assembly.hold(hold);
        }
    auto all = parameters(0.3);
    all.contact.stiffness.initial_fraction = all.contact.stiffness.floor_fraction = all.contact.stiffness.cap_fraction = 0.1;
    Simulator simulator(assembly, all);
    simulation::Report report = simulator.run(test::stage<Pressing>({{"turn", -1.0}}, 1));
    report = simulator.run(test::stage<Pressing>({{"turn", 0.0}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const contact::ToolReaction before = simulator.contacts().tools().reaction(0);
    const double elastic = report.energy.elastic;
    report = simulator.run(test::stage<Pressing>({{"turn", 0.5 * pi}}, 5));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const contact::ToolReaction after = simulator.contacts().tools().reaction(0);
    const Mat3 turn(Eigen::AngleAxisd(0.5 * pi, Vec3::UnitZ()));
    std::printf(
        "turning: %.5f N on the drum, tangential %.5f N; after a quarter turn off by %.1e, moment by %.1e, energy by %.1e\n",
        before.force.norm(), before.force.x(), (after.force - turn * before.force).norm() / before.force.norm(),
        (after.moment - before.moment).norm() / before.moment.norm(), report.energy.elastic / elastic - 1.0);
    CHECK(std::abs(before.force.x()) > 0.01 * before.force.norm());
    CHECK((after.force - turn * before.force).norm() < 1e-5 * before.force.norm());
    CHECK((after.moment - turn * before.moment).norm() < 1e-5 * before.moment.norm());
    CHECK(report.energy.dissipated == 0.0);
}

TEST_CASE("a fibre's end is round to a tool: as deep in it at any slant") {
    for (const double slant_deg : {20.0, 30.0, 60.0, 80.0, 84.0, 85.0, 90.0}) {  // to the plane
        CAPTURE(slant_deg);
        const double slant = slant_deg * pi / 180.0;
        const Vec3 foot(0, 0, 0.98 * r), along(std::cos(slant), 0, std::sin(slant));
        scene::Assembly assembly;
        assembly.add(straight_fibre(foot, foot + 0.5 * along, r, 6));
        assembly.add(plane(Vec3::Zero(), Vec3::UnitZ()));
        const Mesh mesh(assembly, Beam{});
        contact::StiffnessAdaptation adaptation;
        adaptation.allowed_penetration = 0.05 * r;
        Tools tools(assembly, mesh, adaptation, 2.0);
        tools.detect(mesh.rest_state(), mesh.rest_state(), 0.1 * r, penalty);
        tools.evaluate(mesh.rest_state(), penalty, coulomb);
        contact::ContactFigures sum;
        tools.add_figures(mesh.rest_state(), penalty, sum);
        CHECK(sum.active == 1);
        CHECK(std::abs(sum.greatest_penetration - 0.02 * r) < 1e-12);
    }
}

TEST_CASE("a slanted fibre that stands with its end on a smooth plate bends and shortens as a cantilever does") {
    for (const double tilt_deg :
         {3.0, 5.6, 20.0}) {  // from the plate's normal; the section reaches a tenth of a radius down at 5.7
        CAPTURE(tilt_deg);
        const double tilt = tilt_deg * pi / 180.0, length = 0.5, way = 5e-3 * r;
        const Vec3 foot(0, 0, r), along(std::sin(tilt), 0, std::cos(tilt));
        scene::Assembly assembly;
        assembly.add(straight_fibre(foot, foot + length * along, r, 6));
        assembly.clamp(scene::last_end(0), Vec3(0, 0, -way), Vec3::Zero(), Vec3::Zero(), "press");
        assembly.add(plane(Vec3::Zero(), Vec3::UnitZ()));
        Simulator simulator(assembly, parameters(0.0));
        const simulation::Report report = simulator.run(test::stage<Pressing>({{"press", 1.0}}, 4));
        REQUIRE_MESSAGE(report.converged, report.reason);
        const double area = pi * r * r, inertia = 0.25 * area * r * r, young = test::glass.young_modulus,
                     shear = young / (2.0 * (1.0 + test::glass.poisson_ratio));
        const double depth = r - simulator.value(scene::first_end(0), scene::NodeVector::position).z();
        const double load = -simulator.contacts().tools().reaction(0).force.z();
        // A cantilever under a load along and across it: both bend it (Timoshenko and Gere, 1.11).
        const double k = std::sqrt(load * std::cos(tilt) / (young * inertia));
        const double give = std::pow(std::cos(tilt), 2) * length / (young * area) +
                            std::pow(std::sin(tilt), 2) * length / (shear * area) +
                            std::sin(tilt) * std::tan(tilt) * (std::tan(k * length) / k - length) / load;
        std::printf("end on a plate, %.1f degrees: %.3e N, %.3e expected, %.1e radii deep\n", tilt_deg, load,
                    (way - depth) / give, depth / r);
        CHECK(depth > 0.0);
        CHECK(depth < 2e-3 * r);
        // The end turns by up to a tenth of the tilt, which shortens the lever by half of that in the square: terms of the third
        // order.
        CHECK(std::abs(load * give / (way - depth) - 1.0) < 0.03);
    }
}

TEST_CASE("a run with tools that is interrupted goes on to the same bits") {
    scene::Assembly assembly;
    assembly.add(straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    scene::Tool table = plane(Vec3::Zero(), Vec3::UnitZ());
    table.channel = "table", table.displacement = {0, 0.1 * r, 0};
    assembly.add(table);
    for (const double end : {0.0, 1.0}) assembly.clamp({0, end}, Vec3(0, 0, -0.01 * r), Vec3::Zero(), Vec3::Zero(), "press");
    simulation::Loading<Pressing> loading = test::stage<Pressing>({{"press", 1.0}, {"table", 1.0}}, 4);
    auto all = parameters(0.3);
    all.contact.stiffness.largest_change = 3.0;
    Simulator whole(assembly, all);
    const simulation::Report report = whole.run(loading);
    REQUIRE(report.converged);
    struct Stop {
        void reported(const simulation::IncrementReport& increment) const {
            if (increment.number == 3) throw 3;
        }
    } stop;
    loading.checkpoint = (std::filesystem::temp_directory_path() / "fibrant_tool_contacts_test").string();
    Simulator first(assembly, all), second(assembly, all);
    CHECK_THROWS_AS(first.run(loading, stop), int);
    loading.resume = true;
    const simulation::Report resumed = second.run(loading);
    std::filesystem::remove(loading.checkpoint);
    REQUIRE(resumed.converged);
    CHECK(second.state() == whole.state());
    CHECK(resumed.energy.external == report.energy.external);
    CHECK(resumed.energy.dissipated == report.energy.dissipated);
    CHECK(second.contacts().tools().reaction(0).force == whole.contacts().tools().reaction(0).force);
}

TEST_CASE("a tool that is not one, and a scene whose model knows no tools, are refused by name") {
    scene::Assembly assembly;
    CHECK(test::refusal([&] { assembly.add(plane(Vec3::Zero(), Vec3::Zero())); }) ==
          "Tool.axis: length = 0, but it must be finite and > 0 (tool 0)");
    CHECK(test::refusal([&] { assembly.add(round(scene::ToolShape::sphere, Vec3::Zero(), Vec3::UnitZ(), -1.0)); }) ==
          "Tool.radius = -1, but it must be finite and > 0 (tool 0)");
    assembly.add(straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    assembly.add(plane(Vec3::Zero(), Vec3::UnitZ()));
    CHECK(test::refusal([&] {
              simulation::Simulator<test::Smooth>(assembly, test::pressed_parameters<test::Smooth>(r));
          }).find("assembly.tools = 1") == 0);
}

}  // namespace tool_contacts_test

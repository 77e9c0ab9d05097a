// SPDX-License-Identifier: MIT
// Tools that fibres carry: forces and tangent by differences, a plate that presses with a force, and one that falls.
#include <contact/contact_model.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/carried_tools.hpp>
#include <fibrant/inertia/bodies.hpp>
#include <fibrant/law/impact.hpp>
#include <fibrant/load/gravity.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

using namespace fibrant;

namespace carried_tools_test {

const double r = 0.02;

/// Rigid sections and a stiffness that is a property: what a force presses in is known.
struct Pressing {
    using Beam = beam::RigidSectionRod;
    using Proximity = proximity::GridSearch;
    using Normal = law::PowerNormal;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
    using Tools = contact::CarriedTools;
};
struct Falling : Pressing {
    using Motion = inertia::WithBodies<inertia::Midpoint>;
    using Normal = law::Impact<law::PowerNormal>;
    using Acts = term::List<Motion, load::Gravity>;
};

scene::Tool plane(const Vec3& origin, const Vec3& normal) {
    scene::Tool tool;
    tool.origin = origin, tool.axis = normal;
    return tool;
}

TEST_CASE("forces of tools that a fibre carries are the slope of their energy, and the tangent is the slope of the forces") {
    using test::Beam;
    using test::Mesh;
    using Tools = contact::CarriedToolContacts<Beam, law::RegularisedPenalty, law::RegularisedCoulomb>;
    const law::RegularisedPenalty penalty({.regularisation_depth = 0.005 * r});
    scene::Assembly assembly;
    assembly.add(test::straight_fibre({-0.3, 0, 0}, {0.3, 0.01, 0.01}, r, 6));
    assembly.add(test::straight_fibre({0, 0, -0.3}, {0, 0, -0.6}, r, 2));  // carries two of the three
    scene::Tool below = plane({0, 0, -0.93 * r}, {0.02, 0.03, 2.0}), held = plane({0, 0, 0.97 * r}, {0.0, 0.1, -1.0}), ball;
    ball.shape = scene::ToolShape::sphere, ball.origin = {0.2, 0.2 + 0.93 * r, 0}, ball.radius = 0.2;
    below.carrier = scene::Station{1, 0.3}, ball.carrier = scene::Station{1, 1.0};
    assembly.add(below), assembly.add(held), assembly.add(ball);
    const Mesh mesh(assembly, Beam{});
    const auto shaken = [&](unsigned seed, double amount) {
        std::mt19937 generator(seed);
        std::uniform_real_distribution<double> value(-1.0, 1.0);
        Vector state = mesh.rest_state();
        for (Index v = 0; v < mesh.layout().vectors(); ++v)
            for (int k = 0; k < 3; ++k)
                state[3 * v + k] += amount * (mesh.layout().kind[core::at(v)] == scene::VectorKind::position ? 0.02 * r : 0.05) *
                                    value(generator);
        return state;
    };
    contact::StiffnessAdaptation adaptation;
    adaptation.allowed_penetration = 0.05 * r;
    for (const bool rough : {false, true}) {
        // Friction is only in the tangent at a standing bound, and it is not the slope of an energy.
        const law::RegularisedCoulomb friction({.friction_coefficient = rough ? 0.3 : 0.0, .reversible_displacement = 0.02 * r});
        Tools tools(assembly, mesh, adaptation, 2.0);
        const Vector accepted = shaken(3, 0.7), state = shaken(1, 1.0), along = shaken(2, 1.0) - mesh.rest_state();
        const auto evaluate = [&](const Vector& at) { tools.evaluate(at, at, penalty, friction); };
        const auto forces = [&](const Vector& at) {
            evaluate(at);
            Vector sum = Vector::Zero(at.size());
            tools.add_forces(sum);
            return sum;
        };
        const auto energy = [&](const Vector& at) {
            evaluate(at);
            contact::ContactFigures sum;
            tools.add_figures(at, penalty, sum);
            return sum.work;
        };
        tools.detect(mesh.rest_state(), accepted, 0.1 * r, penalty);
        for (const auto& element : tools.elements())
            CHECK(element.fibre == 0);  // the other one is behind a plane, and carries it
        evaluate(mesh.rest_state());
        tools.hold_reactions();
        const double h = 1e-6;
        const Vector slope = (forces(state + h * along) - forces(state - h * along)) / (2.0 * h);
        const double work = (energy(state + h * along) - energy(state - h * along)) / (2.0 * h);
        const Vector here = forces(state);
        // What acts on the carrier is what acts on the fibre, but for the plane that stands.
        Vec3 sum = tools.reaction(1).force;
        for (Index v = 0; v < mesh.layout().vectors(); ++v)
            if (mesh.layout().kind[core::at(v)] == scene::VectorKind::position) sum -= here.segment<3>(3 * v);
        CHECK(sum.norm() < 1e-12 * here.norm());
        if (!rough) CHECK(here.dot(along) == test::near(work, 1e-6));  // differences
        Vector product = Vector::Zero(state.size());
        const auto spread = [&](Index first, const beam::ElementWeights<Beam>& weights, const Vec3& force) {
            for (std::size_t a = 0; a < weights.size(); ++a)
                product.segment<3>(first + 3 * static_cast<Index>(a)) += weights[a] * force;
        };
        for (Index f = 0; f < 2; ++f)
            tools.stiffness_terms(f, state, [&](Index first, const beam::ElementWeights<Beam>& weights, const Mat3& stiffness) {
                spread(first, weights, stiffness * Mesh::point(along, first, weights));
            });
        std::vector<assembly::ChainSystem<Beam>::Point> points;
        tools.add_points(points);
        for (const auto& point : points) {
            const Vec3 force = point.stiffness * (Mesh::point(along, point.first_j, point.weights_j) -
                                                  Mesh::point(along, point.first_i, point.weights_i));
            spread(point.first_j, point.weights_j, force), spread(point.first_i, point.weights_i, -force);
        }
        std::printf("%s: tangent off by %.1e\n", rough ? "rough" : "smooth", (product - slope).norm() / product.norm());
        CHECK((product - slope).norm() < (rough ? 5e-2 : 1e-6) * product.norm());  // the arm of friction moves, and is left out
    }
}

/// Parallel rods on a floor under a plate, on a ram that stands on it.
struct Row {
    Index fibres = 5;
    double length = 0.5, line = 40.0, overlap = 1e-4 * r;  // of each with either plate at the start
    scene::Assembly assembly;
    /// @param way  down, of a plate that nothing carries [length]; 0: it is carried
    /// @param off  of a plate that is carried and tilts, from the middle of the row to the ram [length]
    explicit Row(double way = 0.0, double off = 0.0) {
        for (Index f = 0; f < fibres; ++f) {
            const double y = 4.0 * r * static_cast<double>(f), z = r - overlap;
            scene::FibreSpecification fibre = test::straight_fibre({0, y, z}, {length, y, z}, r, 2);
            fibre.director = Vec3::UnitZ();
            assembly.add(fibre);
            for (const double end : {0.0, 0.5, 1.0}) {
                assembly.hold_position({f, end}, Vec3(1, 1, 0).asDiagonal());
                assembly.hold_axial_rotation({f, end});
            }
        }
        assembly.add(plane(Vec3::Zero(), Vec3::UnitZ()));
        scene::Tool plate = plane({0, 0, 2.0 * r - 2.0 * overlap}, -Vec3::UnitZ());
        if (way > 0.0) {
            plate.displacement = {0, 0, -way};
        } else {
            const double y = 2.0 * r * static_cast<double>(fibres - 1) + off;
            scene::FibreSpecification ram = test::straight_fibre({0.5 * length, y, 4.0 * r}, {0.5 * length, y, 12.0 * r}, r, 1);
            ram.director = Vec3::UnitX();
            const Index f = assembly.add(ram);
            for (const double end : {0.0, 1.0}) {
                if (off != 0.0 && end == 1.0) continue;
                assembly.hold_position({f, end}, Vec3(1, 1, 0).asDiagonal());
                off != 0.0 ? assembly.hold_axial_rotation({f, end}) : assembly.hold_rotation({f, end});
            }
            plate.turns = off != 0.0;
            plate.carrier = scene::Station{f, 0.0};
        }
        assembly.add(plate);
    }
    simulation::ModelParameters<Pressing> parameters() const {
        simulation::ModelParameters<Pressing> all;
        all.friction = {.friction_coefficient = 0.3, .reversible_displacement = 1e-3 * r};
        all.contact.stiffness.allowed_penetration = r;
        all.iteration.step_tolerance = 1e-10, all.iteration.residual_tolerance = 1e-10;
        all.normal = {.line_stiffness = line, .line_exponent = 1.0, .crossing_stiffness = line, .crossing_exponent = 1.0};
        return all;
    }
};

TEST_CASE("a plate that presses with a force sinks by what the contacts give way, and feels that force") {
    const double force = 0.8;
    Row row;
    row.assembly.apply(scene::DeadForce{.at = {row.fibres, 1.0}, .force = {0, 0, -force}});
    simulation::Simulator<Pressing> simulator(row.assembly, row.parameters());
    simulation::Report report = simulator.run(test::stage<Pressing>({{"load", 1.0}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    // The floor and the plate, both with as many springs as there are rods.
    const double felt = simulator.contacts().tools().reaction(1).force.z(),
                 sinks = 4.0 * r - simulator.value({row.fibres, 0.0}).z(),
                 way = 2.0 * (force / (static_cast<double>(row.fibres) * row.line * row.length) - row.overlap);
    std::printf("press: feels %.10f of %.10f, sinks by %.10f of %.10f; energy misses %.1e of the work; %td iterations\n", felt,
                force, sinks, way, report.energy.error() / report.energy.external, report.counts.newton);
    CHECK(felt == test::near(force, 1e-8));
    CHECK(simulator.contacts().tools().reaction(0).force.z() == test::near(-force, 1e-8));
    CHECK(sinks == test::near(way, 1e-8));
    CHECK(std::abs(report.energy.error()) < 1e-3 * report.energy.external);  // trapezia, and the overlap at the start

    Row driven(way);
    simulation::Simulator<Pressing> other(driven.assembly, driven.parameters());
    report = other.run(test::stage<Pressing>({{"tools", 1.0}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    CHECK(other.contacts().tools().reaction(1).force.z() == test::near(force, 1e-8));
}

TEST_CASE("a plate that is pressed beside the middle tilts by the moment over the stiffness of the row against it") {
    const double force = 0.004, off = 1.5 * r;
    Row row(0.0, off);
    row.assembly.apply(scene::DeadForce{.at = {row.fibres, 0.0}, .force = {0, 0, -force}});
    auto smooth = row.parameters();
    smooth.friction.friction_coefficient = 0.0;  // the plate turns about the ram's end above it
    simulation::Simulator<Pressing> simulator(row.assembly, smooth);
    const simulation::Report report = simulator.run(test::stage<Pressing>({{"load", 1.0}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    // A rod between floor and plate is two springs in a row; y of the rods from their middle: 0, 4 r, 8 r.
    const double spring = 0.5 * row.line * row.length, tilt = force * off / (spring * 160.0 * r * r),
                 way = force / (static_cast<double>(row.fibres) * spring) - 2.0 * row.overlap + tilt * off;
    const double sinks = 4.0 * r - simulator.value({row.fibres, 0.0}).z(),
                 turned = -simulator.contacts().tools().pose(1).turn(2, 1);
    const contact::ToolReaction felt = simulator.contacts().tools().reaction(1);
    std::printf("tilt: %.6e of %.6e, sinks by %.6e of %.6e, feels %.10f of %.10f; energy misses %.1e of the work\n", turned, tilt,
                sinks, way, felt.force.z(), force, report.energy.error() / report.energy.external);
    CHECK(felt.force.z() == test::near(force, 1e-8));
    CHECK(turned == test::near(tilt, 2e-3));  // the plate touches rods beside their middles, by the tilt times r
    CHECK(sinks == test::near(way, 2e-3));
    CHECK(std::abs(report.energy.error()) < 1e-3 * report.energy.external);
}

/// A plate of mass that falls on rods that are held.
struct Drop {
    double mass = 1.0, g = 9.81, height = r, length = 1.0, line = 8e3, light = 1e-4;
    Index fibres = 3;
    scene::Assembly assembly;
    simulation::ModelParameters<Falling> with;
    Drop() {
        for (Index f = 0; f < fibres; ++f) {
            const double y = 4.0 * r * static_cast<double>(f);
            scene::FibreSpecification fibre = test::straight_fibre({0, y, r}, {length, y, r}, r, 1);
            fibre.director = Vec3::UnitZ();
            assembly.add(fibre);
            for (const double end : {0.0, 1.0}) assembly.clamp({f, end});
        }
        scene::FibreSpecification ram = test::straight_fibre({0, 0, 1.0}, {0, 0, 1.0 + 4.0 * r}, r, 1);
        ram.director = Vec3::UnitX(), ram.material.young_modulus = 1e6;
        assembly.add(ram);
        for (const double end : {0.0, 1.0}) {
            assembly.hold_position({fibres, end}, Vec3(1, 1, 0).asDiagonal());
            assembly.hold_rotation({fibres, end});
        }
        scene::Tool plate = plane({0, 0, 2.0 * r + height}, -Vec3::UnitZ());
        plate.carrier = scene::Station{fibres, 0.0};
        assembly.add(plate);
        const double density = light * mass / (std::numbers::pi * r * r * 4.0 * r);
        assembly.apply(scene::DeadForce{.at = {fibres, 0.0}, .force = {0, 0, -mass * g}, .channel = "gravity"});
        with.normal.law = {.line_stiffness = line, .line_exponent = 1.0, .crossing_stiffness = line, .crossing_exponent = 1.0};
        with.friction = {.friction_coefficient = 0.0, .reversible_displacement = 1e-3 * r};
        with.contact.stiffness.allowed_penetration = r;
        with.iteration.step_tolerance = 1e-9, with.iteration.residual_tolerance = 1e-9;
        with.acts.inertia.density = density, with.acts.gravity.weight = Vec3(0, 0, -density * g);
        with.acts.inertia.bodies = {{.at = {fibres, 0.0}, .mass = mass}};
    }
    simulation::Loading<Falling> lasting(double duration, Index steps) const {
        simulation::Loading<Falling> loading;
        loading.stages.push_back({.name = "fall",
                                  .increments = steps,
                                  .duration = duration,
                                  .ramps = {{.channel = "gravity", .at_once = true}},
                                  .most_increments = 4 * steps});
        return loading;
    }
};

TEST_CASE("a plate that falls on springs sinks as deep as the closed form says, comes back to where it was, and loses nothing") {
    const Drop drop;
    simulation::Simulator<Falling> simulator(drop.assembly, drop.with);
    const double stiffness = static_cast<double>(drop.fibres) * drop.line * drop.length, w = std::sqrt(stiffness / drop.mass),
                 falls = std::sqrt(2.0 * drop.height / drop.g), speed = drop.g * falls, sag = drop.g / (w * w),
                 deepest = sag + std::hypot(sag, speed / w), touching = 2.0 / w * (std::numbers::pi - std::atan2(speed / w, sag)),
                 all = 2.0 * falls + touching;
    struct Seen {
        const simulation::Simulator<Falling>* of;
        double lowest = 1.0, most = 0.0;
        void reported(const simulation::IncrementReport&) {
            lowest = std::min(lowest, of->value({3, 0.0}).z());
            most = std::max(most, of->contacts().tools().reaction(0).force.z());
        }
    } seen{&simulator};
    const simulation::Report report = simulator.run(drop.lasting(all, 400), seen);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double depth = 1.0 - drop.height - seen.lowest, back = 1.0 - simulator.value({3, 0.0}).z(),
                 work = drop.mass * drop.g * (drop.height + deepest);
    std::printf(
        "drop: sinks by %.6f of %.6f, pushed by %.3f of %.3f, back to %.1e of the height; energy misses %.1e of the work\n",
        depth, deepest, seen.most, stiffness * deepest, back / drop.height, report.energy.error() / work);
    CHECK(depth == test::near(deepest, 1e-3));  // the steps are second order, 58 to a touch; the ram has 1e-4 of the mass
    CHECK(std::abs(back) < 2e-3 * drop.height);
    CHECK(std::abs(report.energy.error()) < 1e-3 * work);
}

/// A ball that comes down aslant on a rod that is held, on a pin that weighs next to nothing.
struct Ball {
    double R = 0.3, mass = 1.0, mu = 0.05;
    Vec3 velocity{0.2, 0, -0.3};
    scene::Assembly assembly;
    simulation::ModelParameters<Falling> with = Drop().with;
    Ball() {
        const double length = 0.1, thin = 0.02, wave = 50.0, density = 1e-6 * mass / (std::numbers::pi * thin * thin * length);
        const Vec3 start(0.5, 0, 2.0 * r + R + 1e-3);
        scene::FibreSpecification rail = test::straight_fibre({0, 0, r}, {1, 0, r}, r, 50);
        rail.director = Vec3::UnitZ();
        assembly.add(rail);
        for (Index node = 0; node <= 50; ++node) assembly.clamp({0, static_cast<double>(node) / 50.0});
        scene::FibreSpecification pin = test::straight_fibre(start, start + Vec3(0, 0, length), thin, 1);
        pin.director = Vec3::UnitX(), pin.material.young_modulus = wave * wave * density;
        assembly.add(pin);
        scene::Tool ball;
        ball.shape = scene::ToolShape::sphere, ball.origin = start, ball.radius = R, ball.carrier = scene::first_end(1),
        ball.turns = true;
        assembly.add(ball);
        with.normal.law = {.line_stiffness = 6e4, .line_exponent = 1.0, .crossing_stiffness = 6e4, .crossing_exponent = 1.0};
        with.friction = {.friction_coefficient = mu, .reversible_displacement = 1e-3 * r};
        with.acts.inertia.density = density, with.acts.gravity.weight = Vec3::Zero();
        with.acts.inertia.bodies = {{.at = scene::first_end(1), .mass = mass, .moments = Vec3::Constant(0.4 * mass * R * R)}};
        with.acts.inertia.starts = {{.fibre = 1, .velocity = velocity}};
    }
};

TEST_CASE("a ball that strikes a rod loses speed along it by friction, and spins by that impulse times its radius") {
    const Ball ball;
    const auto& [R, mass, mu, velocity, assembly, with] = ball;
    simulation::Simulator<Falling> simulator(assembly, with);
    double deepest = 0.0;
    struct Seen {
        const simulation::Simulator<Falling>* of;
        double* deepest;
        void reported(const simulation::IncrementReport& increment) {
            *deepest = std::max(*deepest, increment.contact.greatest_penetration);
        }
    } seen{&simulator, &deepest};
    const simulation::Report report = simulator.run(Drop().lasting(0.08, 160), seen);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const inertia::Motion motion = simulator.equilibrium().terms().get<Falling::Motion>().motion(simulator.state());
    const Vec3 impulse = motion.momentum - mass * velocity,
               spin = motion.angular_momentum - simulator.value(scene::first_end(1)).cross(motion.momentum);
    const double arm = spin.y() / -impulse.x(), kinetic = 0.5 * mass * velocity.squaredNorm();
    std::printf(
        "ball: pushed by %.4f, friction %.5f of it; arm %.4f of %.4f, %.4f deep; energy misses %.1e, dissipated %.2e of it\n",
        impulse.z(), -impulse.x() / impulse.z(), arm, R, deepest, report.energy.error() / kinetic,
        report.energy.dissipated / kinetic);
    CHECK(impulse.z() > 1.9 * mass * -velocity.z());            // nothing is lost along the normal
    CHECK(-impulse.x() == test::near(mu * impulse.z(), 1e-2));  // it slides all along, but for the reversible way
    CHECK(arm < R);
    CHECK(arm > R - deepest);
    CHECK(std::abs(spin.x()) + std::abs(spin.z()) < 1e-6 * spin.y());
    CHECK(std::abs(report.energy.error()) < 1e-3 * kinetic);
}

TEST_CASE("a plate, and a ball that turns, that are stopped while they touch and resumed go on to the same bits") {
    const Drop drop;
    const Ball ball;
    for (const bool turns : {false, true}) {
        const scene::Assembly& assembly = turns ? ball.assembly : drop.assembly;
        const simulation::ModelParameters<Falling>& with = turns ? ball.with : drop.with;
        simulation::Simulator<Falling> whole(assembly, with), first(assembly, with), second(assembly, with);
        simulation::Loading<Falling> loading = drop.lasting(turns ? 0.01 : 0.08, 16);  // they touch from 0.003 and 0.064 on
        REQUIRE(whole.run(loading).converged);
        struct Stop {
            void reported(const simulation::IncrementReport& increment) const {
                if (increment.number == 14) throw 14;
            }
        } stop;
        loading.checkpoint = (std::filesystem::temp_directory_path() / "fibrant_carried_tools_test").string();
        CHECK_THROWS_AS(first.run(loading, stop), int);
        REQUIRE(first.contacts().tools().reaction(0).force.z() > 0.0);
        loading.resume = true;
        const simulation::Report resumed = second.run(loading);
        std::filesystem::remove(loading.checkpoint);
        REQUIRE(resumed.converged);
        CHECK(second.state() == whole.state());
        CHECK(second.contacts().tools().reaction(0).force == whole.contacts().tools().reaction(0).force);
        CHECK(second.contacts().tools().reaction(0).moment == whole.contacts().tools().reaction(0).moment);
    }
}

TEST_CASE("a tool with a carrier that is none, or with a path as well, and a model that carries none, are refused by name") {
    scene::Assembly assembly;
    assembly.add(test::straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    scene::Tool tool = plane(Vec3::Zero(), Vec3::UnitZ());
    tool.carrier = scene::Station{1, 0.0};
    CHECK(test::refusal([&] { assembly.add(tool); }) == "Station.fibre = 1, but it must be a fibre of this assembly (tool 0)");
    tool.carrier = scene::Station{0, 0.0}, tool.displacement = Vec3::UnitZ();
    CHECK(test::refusal([&] { assembly.add(tool); }) ==
          "Tool.carrier = given, but it must be left out, for a tool that is driven along a path (tool 0)");
    tool.displacement = Vec3::Zero();
    scene::Assembly turning = assembly;
    tool.turns = true;
    turning.add(tool);
    CHECK(test::refusal([&] {
              const test::Mesh mesh(turning, test::Beam{});
              contact::CarriedToolContacts<test::Beam, law::RegularisedPenalty, law::RegularisedCoulomb>(turning, mesh, {}, 2.0);
          }) == "Tool.turns = true, but it must be false, for a beam whose nodes have no rotation (tool 0)");
    tool.carrier = {};
    CHECK(test::refusal([&] { assembly.add(tool); }) ==
          "Tool.turns = true, but it must be false, for a tool without a carrier (tool 0)");
    tool.carrier = scene::Station{0, 0.0}, tool.turns = false;
    assembly.add(tool);
    auto all = test::pressed_parameters<test::EveryDirector>(r);
    all.friction = {.friction_coefficient = 0.3, .reversible_displacement = 0.02 * r};
    CHECK(test::refusal([&] { simulation::Simulator<test::EveryDirector>(assembly, all); }) ==
          "Tool.carrier = given, but it must be left out, for a model whose part Tools is not CarriedTools");
}

}  // namespace carried_tools_test

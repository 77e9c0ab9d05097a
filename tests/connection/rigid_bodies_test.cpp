// SPDX-License-Identifier: MIT
// Rigid bodies that hold fibre ends on the average, and periodic cells, against closed forms of cantilevers and bars.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/textile/cell_prestress.hpp>
#include <fibrant/compositions/weave/periodic.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/part_overlaps.hpp>
#include <fibrant/simulation/programme.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

using namespace fibrant;

namespace rigid_bodies_test {

struct Tied {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::DoubleBlockCholesky;
    using Connections = connection::RigidBodies;
};
static_assert(simulation::Model<Tied> && simulation::HasConnections<Tied>);
static_assert(std::is_empty_v<connection::NoConnections::Of<beam::DirectorBeam<3>>>,
              "a scene without bodies has no trace of them");

constexpr double radius = 0.02, length = 2.0, young = 7300.0, apart = 0.1;

double inertia() { return std::numbers::pi * std::pow(radius, 4) / 4.0; }
double area() { return std::numbers::pi * radius * radius; }

/// Fibres along z, side by side in x, that do not touch; their first ends are clamped to body 0.
struct Bundle {
    scene::Assembly assembly;
    Index fibres;
    Mat3 section;  // g_1, g_2, tangent

    explicit Bundle(Index count, scene::RigidBody base = {}) : fibres{count} {
        section.col(0) = Vec3::UnitX(), section.col(1) = Vec3::UnitY(), section.col(2) = Vec3::UnitZ();
        assembly.add(std::move(base));
        for (Index k = 0; k < count; ++k) {
            const double x = apart * (static_cast<double>(k) - 0.5 * static_cast<double>(count - 1));
            const Index f = assembly.add({.from = {x, 0, 0},
                                          .to = {x, 0, length},
                                          .section = scene::circular(radius),
                                          .material = {young, 0.3},
                                          .elements = 8,
                                          .director = Vec3::UnitX()});
            assembly.clamp_to(0, scene::first_end(f), section);
        }
    }
    std::vector<scene::Station> last_ends() const {
        std::vector<scene::Station> ends;
        for (Index k = 0; k < fibres; ++k) ends.push_back(scene::last_end(k));
        return ends;
    }
};

simulation::ModelParameters<Tied> parameters() {
    simulation::ModelParameters<Tied> model;
    model.normal.regularisation_depth = 1e-3 * radius;
    model.contact.stiffness.allowed_penetration = 1e-2 * radius;
    model.iteration.step_tolerance = 1e-9, model.iteration.residual_tolerance = 1e-10, model.iteration.linear_tolerance = 1e-11;
    model.iteration.newton_limit = 40;
    return model;
}

TEST_CASE("the mean of fibre ends follows its body exactly while single ends give way to their own loads") {
    // Cantilevers with dead forces f_k at their ends and a mean that is prescribed: w_k = (f_k + c) L^3 / 3 E I.
    const double stiffness = 3.0 * young * inertia() / std::pow(length, 3), given = 1e-3;
    Bundle bundle(7);
    scene::RigidBody mover;
    mover.position = {0, 0, length};
    mover.translation[1] = scene::Coordinate::held_at(given, "push");
    const Index body = bundle.assembly.add(mover);
    bundle.assembly.connect({.ends = bundle.last_ends(), .body = body, .tied = {true, true, false}});
    double loads = 0.0;
    for (Index k = 0; k < 7; ++k) {
        const double force = stiffness * given * (k % 2 == 0 ? 1.0 : -0.5) * static_cast<double>(k);
        loads += force;
        bundle.assembly.apply(scene::DeadForce{scene::last_end(k), scene::NodeVector::position, Vec3(0, force, 0), "push"});
    }
    simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
    const simulation::Report report = simulator.run({.increments = 1});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double share = stiffness * given - loads / 7.0;
    double mean = 0.0;
    for (Index k = 0; k < 7; ++k) {
        const double deflection = simulator.value(scene::last_end(k)).y();
        mean += deflection / 7.0;
        const double force = stiffness * given * (k % 2 == 0 ? 1.0 : -0.5) * static_cast<double>(k);
        // Shear and large deflection: (r/L)^2 and (w/L)^2, below 2e-4.
        CHECK(std::abs(deflection - (force + share) / stiffness) < 1e-3 * given);
    }
    CHECK(std::abs(mean - given) < 1e-12);
    CHECK(simulator.equilibrium().ties().misfit() < 1e-12);
    const auto& ties = simulator.equilibrium().ties();
    CHECK(std::abs(ties.wrench(1).force.y() - 7.0 * share) < 2e-4 * 7.0 * stiffness * given);  // of what the loads take away most
    // All of the sample: bodies and loads balance, in force and in moment about the origin.
    Vec3 force = ties.wrench(0).force + ties.wrench(1).force,
         moment = ties.wrench(0, Vec3::Zero()).moment + ties.wrench(1, Vec3::Zero()).moment;
    for (const scene::DeadForce& load : bundle.assembly.forces())
        force += load.force, moment += simulator.value(load.at).cross(load.force);
    // Fibres this slender leave E A times the rounding of strains in every force.
    const double rounding = 3e-13 * young * area();
    CHECK(force.norm() < 1e-8 * std::abs(loads) + rounding);
    CHECK(moment.norm() < (1e-8 * std::abs(loads) + rounding) * length);
}

TEST_CASE("an end that is tied to what is prescribed altogether is held, and stands where a force on its body brings it") {
    // Clamped at both ends, the far one turned and moved aside; then with the force that this takes in the place of the motion.
    const double bending = young * inertia();
    Vector states[2];
    Vec3 force = Vec3::Zero();
    for (const bool driven : {true, false}) {
        Bundle bundle(1);
        scene::RigidBody end;
        end.position = {0, 0, length};
        end.rotation[0] = scene::Coordinate::held_at(0.2, "turn");
        end.translation[1] =
            driven ? scene::Coordinate::held_at(0.1 * length, "turn") : scene::Coordinate::under(force.y(), "turn");
        end.translation[2] =
            scene::Coordinate::held_at(-0.004 * length, "turn");  // its chord grows by 0.1 %: pulled, not buckled
        const Index body = bundle.assembly.add(end);
        bundle.assembly.clamp_to(body, scene::last_end(0), bundle.section);
        simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 4});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const scene::DofLayout& layout = simulator.equilibrium().system().layout();
        // Of each end a place and two directors; a body that only moves along does not turn directors.
        CHECK(core::count(layout.ties) == (driven ? 0 : 1));
        CHECK(core::count(layout.held) == (driven ? 6 : 5));
        CHECK(simulator.equilibrium().ties().misfit() < 1e-14 * length);
        states[driven ? 0 : 1] = simulator.state();
        const connection::Wrench wrench = simulator.equilibrium().ties().wrench(body),
                                 base = simulator.equilibrium().ties().wrench(0, Vec3::Zero());
        if (driven) force = wrench.force;
        CHECK((wrench.force + base.force).norm() < 1e-8 * force.norm());
        const Vec3 about = simulator.value(scene::last_end(0));
        CHECK((wrench.moment + about.cross(wrench.force) + base.moment).norm() < 1e-8 * force.norm() * length);
    }
    // Of the size of what bends a cantilever by the angle and the deflection: the test would pass with nothing, else.
    CHECK(force.norm() > 0.1 * bending / (length * length));
    CHECK((states[0] - states[1]).cwiseAbs().maxCoeff() < 1e-8 * length);
}

TEST_CASE("a rigid motion of all bodies strains nothing") {
    scene::RigidBody base;
    base.rotation[0] = scene::Coordinate::held_at(0.7, "turn"), base.rotation[2] = scene::Coordinate::held_at(-0.4, "turn");
    base.translation[1] = scene::Coordinate::held_at(0.5, "turn");
    Bundle bundle(3, base);
    scene::RigidBody far;
    far.position = {0.3, 0.1, length}, far.parent = 0;
    far.frame = core::rotation(Vec3(0.2, 0.5, -1.0));
    const Index body = bundle.assembly.add(far);
    bundle.assembly.connect({.ends = bundle.last_ends(), .body = body});
    simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
    const simulation::Report report = simulator.run({.increments = 8});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const Mat3 turn = core::rotation(Vec3(0.7, 0.0, -0.4));
    CHECK((simulator.value({1, 0.5}) - (turn * Vec3(0, 0, 0.5 * length) + Vec3(0, 0.5, 0))).norm() < 1e-9);
    // An energy of strains of rounding: E A L eps^2 with eps = 1e-10 or so.
    CHECK(std::abs(report.energy.elastic) < 1e-15);
    CHECK(simulator.equilibrium().ties().wrench(body).force.norm() < 1e-8);
    CHECK(simulator.equilibrium().ties().motion().orthonormality_error() < 1e-14);
}

TEST_CASE("ends of a body that turns freely hold to rounding, however loosely forces balance") {
    // Three fibres whose ends are clamped to a body that a moment turns in their plane: so little that one step of Newton's
    // method is near enough, which leaves the outer ends further apart by half of the angle's square, 3e-9.
    const double angle = 2.5e-4;
    Bundle bundle(3);
    scene::RigidBody end;
    end.position = {0, 0, length};
    for (std::size_t k = 0; k < 3; ++k) end.translation[k] = scene::Coordinate::under(0.0, "turn");
    const double stiffness = young * (2.0 * area() * apart * apart + 3.0 * inertia()) / length;
    end.rotation[1] = scene::Coordinate::under(stiffness * angle, "turn");
    const Index body = bundle.assembly.add(end);
    for (const scene::Station& last : bundle.last_ends()) bundle.assembly.clamp_to(body, last, bundle.section);
    simulation::ModelParameters<Tied> loose = parameters();
    loose.iteration.step_tolerance = 0.02, loose.iteration.residual_tolerance = 1.0;
    loose.iteration.normal_step_tolerance = loose.iteration.contact_tolerance = 1.0;
    simulation::Simulator<Tied> simulator(bundle.assembly, loose);
    const simulation::Report report = simulator.run({.increments = 1});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(report.counts.newton == 1);  // or the test would pass without
    CHECK(simulator.equilibrium().ties().misfit() <= 1e-13 * length);
    const Vec3 between = simulator.value(scene::last_end(2)) - simulator.value(scene::last_end(0));
    CHECK(std::abs(between.norm() - 2.0 * apart) < 1e-13 * length);
    CHECK(between.z() == test::near(-2.0 * apart * angle, 0.1));  // the one step is solved to a hundredth of the forces
}

TEST_CASE("ends tied to a body that hangs on another do what ends tied to the other do") {
    Vector states[2];
    for (const bool direct : {true, false}) {
        Bundle bundle(4);
        scene::RigidBody edge;
        edge.position = {0.5, 0.2, length};
        edge.rotation[0] = scene::Coordinate::held_at(0.3, "turn"), edge.rotation[1] = scene::Coordinate::held_at(0.2, "turn");
        edge.translation[2] = scene::Coordinate::loose();
        Index body = bundle.assembly.add(edge);
        if (!direct) {
            scene::RigidBody end;
            end.position = {0, 0, length}, end.parent = body, end.frame = core::rotation(Vec3(0.4, 0.0, 0.3));
            end.rotation[1] = scene::Coordinate::loose();  // nothing asks for it: it stays
            body = bundle.assembly.add(end);
        }
        bundle.assembly.connect({.ends = bundle.last_ends(), .body = body});
        simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 4});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        states[direct ? 0 : 1] = simulator.state();
    }
    CHECK((states[0] - states[1]).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("a free coordinate of a body that hangs on another goes along the axes of that one, as it stands") {
    scene::Assembly assembly;
    scene::RigidBody base, arm;
    base.rotation[0] = scene::Coordinate::held_at(0.7, "turn"), base.rotation[2] = scene::Coordinate::held_at(-0.4, "turn");
    arm.position = {0.3, 0.1, 1.0}, arm.parent = assembly.add(base);
    for (std::size_t k = 0; k < 3; ++k) arm.translation[k] = arm.rotation[k] = scene::Coordinate::loose();
    const Index body = assembly.add(arm);
    const connection::Channels channels(assembly);
    connection::BodyMotion motion(assembly, channels);
    motion.begin(std::vector<double>{1.0});
    REQUIRE(motion.free_coordinates() == 6);
    const double step = 1e-5;  // to whose square a difference is wrong
    for (Index k = 0; k < 6; ++k) {
        CAPTURE(k);
        connection::BodyMotion forth = motion, back = motion;
        forth.move(step * Vector::Unit(6, k)), back.move(-step * Vector::Unit(6, k));
        const Vec3 moved = (forth.position(body) - back.position(body)) / (2.0 * step);
        const Mat3 turned = (forth.frame(body) - back.frame(body)) / (2.0 * step);
        CHECK((moved - motion.velocity(k, motion.position(body))).norm() < 1e-9);
        for (int a = 0; a < 3; ++a) CHECK((turned.col(a) - motion.spin(k, motion.frame(body).col(a))).norm() < 1e-9);
        CHECK(moved.norm() + turned.norm() > 0.9);
    }
}

TEST_CASE("a body that is free under a force and a moment moves as a beam's end would") {
    const double bending = young * inertia();
    // Large deflection: a dead force on a free body at the end of one fibre is a dead force on the fibre.
    Vec3 tips[2];
    for (const bool by_body : {true, false}) {
        Bundle bundle(1);
        const double force = 2.0 * bending / (length * length);
        if (by_body) {
            scene::RigidBody end;
            end.position = {0, 0.3, length};  // not at the end itself, but nothing holds its rotation
            for (auto& coordinate : end.translation) coordinate = scene::Coordinate::loose();
            end.translation[1] = scene::Coordinate::under(force, "load");
            const Index body = bundle.assembly.add(end);
            bundle.assembly.connect({.ends = {scene::last_end(0)}, .body = body});
        } else {
            bundle.assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(0, force, 0), "load"});
        }
        simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 4});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        tips[by_body ? 0 : 1] = simulator.value(scene::last_end(0));
    }
    CHECK(tips[1].y() > 0.2 * length);
    CHECK((tips[0] - tips[1]).norm() < 1e-8 * length);

    // A moment on a body to which the end is clamped makes an arc of the angle M L / E I.
    for (const double turns : {1e-3, 1.2}) {
        Bundle bundle(1);
        scene::RigidBody end;
        end.position = {0, 0, length};
        for (auto& coordinate : end.translation) coordinate = scene::Coordinate::loose();
        end.rotation[0] = scene::Coordinate::under(-turns * bending / length, "load");
        const Index body = bundle.assembly.add(end);
        bundle.assembly.clamp_to(body, scene::last_end(0), bundle.section);
        simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
        const simulation::Report report = simulator.run({.increments = turns > 0.1 ? 6 : 1});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const Mat3 frame = simulator.equilibrium().ties().motion().frame(body);
        // Mesh of 8 elements: 1e-5; radius over that of the arc: 1e-4.
        CHECK(std::atan2(frame(1, 2), frame(2, 2)) == test::near(turns, 3e-4));
        const Vec3 tip = simulator.value(scene::last_end(0));
        CHECK(tip.y() == test::near(length * (1.0 - std::cos(turns)) / turns, 5e-4));
        CHECK((simulator.equilibrium().ties().motion().position(body) - tip).norm() < 1e-10);
    }

    // Two fibres clamped to one body are flanges: M = theta (2 E I + E A d^2 / 2) / L for a distance d.
    Bundle bundle(2);
    scene::RigidBody end;
    end.position = {0, 0, length};
    for (auto& coordinate : end.translation) coordinate = scene::Coordinate::loose();
    const double flanges = (2.0 * bending + 0.5 * young * area() * apart * apart) / length, angle = 1e-4;
    end.rotation[1] = scene::Coordinate::under(flanges * angle, "load");
    const Index body = bundle.assembly.add(end);
    for (Index k = 0; k < 2; ++k) bundle.assembly.clamp_to(body, scene::last_end(k), bundle.section);
    simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
    REQUIRE(simulator.run({.increments = 1}).converged);
    const Mat3 frame = simulator.equilibrium().ties().motion().frame(body);
    CHECK(std::atan2(frame(0, 2), frame(2, 2)) == test::near(angle, 1e-3));  // St Venant-Kirchhoff: 1.5 eps
}

/// A straight rod that repeats by what it is along, in the cell 0, which is there. Its spin is held in its middle: the other
/// rotations of a straight periodic fibre are held by its period.
Index periodic_rod(scene::Assembly& assembly, const Vec3& from, const Vec3& along, Index elements, const Vec3& director) {
    const Index f = assembly.add({.from = from,
                                  .to = from + along,
                                  .section = scene::circular(radius),
                                  .material = {young, 0.3},
                                  .elements = elements,
                                  .director = director});
    assembly.connect(scene::PeriodicPair{scene::first_end(f), scene::last_end(f), along, 0});
    assembly.hold_axial_rotation({f, 0.5});
    return f;
}

TEST_CASE("a periodic fibre stretches under a mean stress as a bar, and carries what a prescribed strain asks for") {
    const double strain = 0.01, stretch = 1.0 + strain;
    const double force = young * area() * 0.5 * (stretch * stretch - 1.0) * stretch;  // St Venant-Kirchhoff, nominal
    for (const bool prescribed : {true, false}) {
        scene::Assembly assembly;
        scene::PeriodicCell cell;
        cell.volume = 3.0;
        cell.component(2, 2) = prescribed ? scene::Coordinate::held_at(strain, "strain")
                                          : scene::Coordinate::under(force * length / cell.volume, "strain");
        assembly.add(cell);
        const Index f = periodic_rod(assembly, Vec3::Zero(), Vec3(0, 0, length), 8, Vec3::UnitX());
        assembly.hold_position({f, 0.5});
        simulation::Simulator<Tied> simulator(assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 2});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const auto& ties = simulator.equilibrium().ties();
        CHECK(ties.motion().gradient(0)(2, 2) == test::near(strain, 1e-8));
        CHECK(ties.cell_force(0)(2, 2) == test::near(force * length, 1e-8));
        const Vec3 apart_now = simulator.value(scene::last_end(f)) - simulator.value(scene::first_end(f));
        CHECK((apart_now - Vec3(0, 0, stretch * length)).norm() < 1e-9);
        const Vec3 g = simulator.value(scene::last_end(f), scene::NodeVector::director_1) -
                       simulator.value(scene::first_end(f), scene::NodeVector::director_1);
        CHECK(g.norm() < 1e-10);
    }
}

TEST_CASE("a cell that is stretched and sheared holds the force of its bar along the bar, component by component") {
    Mat3 gradient;
    gradient << 0.01, 0.02, -0.03, 0.04, -0.015, 0.05, 0.06, -0.07, 0.025;  // no two alike
    scene::Assembly assembly;
    const Vec3 along = Vec3(1, 2, 3).normalized(), period = length * along, now = period + gradient * period;
    const Index f = assembly.add({.from = {0, 0, 0},
                                  .to = period,
                                  .section = scene::circular(radius),
                                  .material = {young, 0.3},
                                  .elements = 4,
                                  .director = Vec3::UnitX()});
    assembly.hold_position({f, 0.5});
    scene::Hold spin;  // by one director alone: the bar turns with the cell, and both could not stay
    spin.at = {f, 0.5}, spin.axes = scene::Axes::section, spin.vector = scene::NodeVector::director_1,
    spin.directions = Vec3(0, 1, 0).asDiagonal();
    assembly.hold(spin);
    scene::PeriodicCell cell;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) cell.component(i, j) = scene::Coordinate::held_at(gradient(i, j), "strain");
    assembly.add(cell);
    assembly.connect(scene::PeriodicPair{scene::first_end(f), scene::last_end(f), period, 0});
    simulation::Simulator<Tied> simulator(assembly, parameters());
    const simulation::Report report = simulator.run({.increments = 2});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double stretch = now.norm() / length, force = young * area() * 0.5 * (stretch * stretch - 1.0) * stretch;
    const Mat3 expected = force * now.normalized() * period.transpose();  // nominal: force now, area at the start
    const Mat3 seams = simulator.equilibrium().ties().cell_force(0), inside = compositions::weave::virial(simulator);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            CAPTURE(i);
            CAPTURE(j);
            CHECK(simulator.equilibrium().ties().motion().gradient(0)(i, j) == test::near(gradient(i, j), 1e-12));
            CHECK(seams(i, j) == test::near(expected(i, j), 1e-7));
            CHECK(inside(i, j) == test::near(expected(i, j), 1e-7));
        }
    CHECK((simulator.value(scene::last_end(f)) - simulator.value(scene::first_end(f)) - now).norm() < 1e-12);
}

TEST_CASE("a cell that bends stretches, bends and twists a bar off its middle plane, and bears its force and moments") {
    // By the kinematics of a plate without shear: strain -z w,xx, curvature w,xx, twist w,xy.
    const double z = 0.3, y = -0.7, axial = young * area(), shear = young / 2.6;
    for (const int of : {0, 1, 2}) {
        const double bent = of == 2 ? 1e-6 : 1e-5;  // what a twist tilts it stretches by the square, 1e-3 of the moment then
        scene::Assembly assembly;
        scene::PeriodicCell cell;
        cell.curvature[core::at(of)] = scene::Coordinate::held_at(bent, "bend");
        assembly.add(cell);
        const Index f = periodic_rod(assembly, Vec3(-0.5 * length, y, z), Vec3(length, 0, 0), 4, Vec3::UnitY());
        assembly.hold_position({f, 0.5});
        simulation::Simulator<Tied> simulator(assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 1});
        CAPTURE(of);
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const auto& ties = simulator.equilibrium().ties();
        const Vec3 expected = of == 0   ? Vec3(bent * length * (axial * z * z + young * inertia()), 0, 0)
                              : of == 2 ? Vec3(0, 0, bent * length * shear * 2.0 * inertia())
                                        : Vec3(Vec3::Zero());
        const double unit = bent * length * young * inertia();
        CHECK((ties.cell_moment(0) - expected).norm() < 2e-3 * std::max(unit, expected.norm()));
        CHECK(std::abs(ties.cell_force(0)(0, 0) + (of == 0 ? bent * length * axial * z : 0.0)) <
              1e-3 * bent * length * axial * z);
    }
    scene::PeriodicCell loose;
    loose.curvature[1] = scene::Coordinate::loose();
    CHECK(test::refusal([&] { scene::Assembly().add(loose); }).find("PeriodicCell.curvature") != std::string::npos);
}

TEST_CASE("what a thread bears changes nothing of its stiffness against bending and twist, wherever it lies in its cell") {
    // E I of the curvature along it and G J of the twist about it; the tension over them is e L^2 / 3 r^2 = 3.3.
    namespace textile = compositions::textile;
    const double tension = 1e-3, bent = 1e-4, bending = young * inertia(), torsion = young / 2.6 * 2.0 * inertia();
    for (const double angle : {0.0, 0.5 * std::numbers::pi, 0.6}) {
        const Vec3 t(std::cos(angle), std::sin(angle), 0), n(-t.y(), t.x(), 0), period = length * t;
        const Vec3 along(t.x() * t.x(), t.y() * t.y(), 2.0 * t.x() * t.y());
        const Vec3 about(t.x() * n.x(), t.y() * n.y(), t.x() * n.y() + t.y() * n.x());
        const auto thread = [&](const Mat3& gradient, const Vec3& apart_now) {
            scene::Assembly assembly;
            scene::PeriodicCell cell;
            for (int i = 0; i < 9; ++i) cell.gradient[core::at(i)] = scene::Coordinate::held_at(gradient.data()[i], "pull");
            for (std::size_t k = 0; k < 3; ++k)
                cell.curvature[k] = scene::Coordinate::held_at(1.0, textile::cell_channels()[3 + k]);
            assembly.add(cell);
            const Vec3 middle(0.3, -0.7, 0.0);
            const Index f = assembly.add({.from = middle - 0.5 * period,
                                          .to = middle + 0.5 * period,
                                          .section = scene::circular(radius),
                                          .material = {young, 0.3},
                                          .elements = 4,
                                          .director = Vec3::UnitZ()});
            assembly.connect(scene::PeriodicPair{scene::first_end(f), scene::last_end(f), apart_now, 0});
            assembly.hold_axial_rotation({f, 0.5});
            assembly.hold_position({f, 0.5});
            return assembly;
        };
        const auto run = [](simulation::Simulator<Tied>& simulator, const std::string& channel, double to) {
            simulation::LoadProgramme programme;
            programme.stages = {{.name = channel, .increments = 2, .ramps = {{channel, to}}}};
            REQUIRE(simulator.run(simulation::loading_of<Tied>(programme)).converged);
        };
        simulation::Simulator<Tied> stretching(thread(tension * t * t.transpose(), period), parameters());
        run(stretching, "pull", 1.0);
        scene::Assembly cell = thread(Mat3::Zero(), (1.0 + tension) * period);
        cell.begin_at(stretching.state());
        simulation::Simulator<Tied> resting(cell, parameters());
        run(resting, textile::cell_channels()[3], 0.0);
        const textile::CellPrestress prestress(resting);
        const double stretched = (1.0 + tension) * length;
        for (Index k = 0; k < 3; ++k) {
            Vec3 found = Vec3::Zero();
            for (const double side : {1.0, -1.0}) {
                scene::Assembly assembly = cell;
                prestress.apply(assembly);
                simulation::Simulator<Tied> simulator(assembly, parameters());
                run(simulator, textile::cell_channels()[core::at(3 + k)], side * bent);
                found += 0.5 * side / bent * textile::cell_efforts(simulator, 1.0, prestress).tail<3>();
            }
            const Vec3 expected = (bending * along[k] * along + torsion * about[k] * about) * stretched * stretched / length;
            CAPTURE(angle);
            CAPTURE(k);
            CAPTURE(found.transpose());
            CAPTURE(expected.transpose());
            CHECK((found - expected).norm() < 5e-3 * bending * length);  // sections stretch by e and contract by 0.3 e
        }
    }
}

TEST_CASE("contact across the seams of a cell is contact: where a cell is cut changes nothing") {
    // Two rods along x that are pressed on both sides, once inside the cell and once across its seam.
    constexpr double depth = 0.01 * radius, width = 2.0 * (2.0 * radius);
    const auto rod = [](scene::Assembly& assembly, const Vec3& from, const Vec3& along, Index elements) {
        return periodic_rod(assembly, from, along, elements, Vec3::UnitZ());
    };
    const auto see_beside = [](scene::Assembly& assembly, const std::vector<scene::FibreImage::Shift>& shifts) {
        for (Index f = 0; f < core::count(assembly.fibres()); ++f) assembly.add(scene::FibreImage{f, shifts});
    };
    const auto settle = [](simulation::Simulator<Tied>& simulator) {
        const simulation::Report report = simulator.run({.increments = 4});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
    };
    double pressed = 0.0;
    for (const double cut : {0.1, 0.25, 0.4}) {
        scene::Assembly assembly;
        scene::PeriodicCell cell;
        cell.component(1, 1) = scene::Coordinate::held_at(-depth / (2.0 * radius), "press");
        assembly.add(cell);
        const Vec3 x = 20.0 * radius * Vec3::UnitX(), y = width * Vec3::UnitY();
        assembly.hold_position({rod(assembly, cut * y, x, 4), 0.5});
        assembly.hold_position({rod(assembly, (cut + 0.5) * y, x, 4), 0.5}, Vec3(1, 0, 1).asDiagonal());  // free between the two
        assembly.hold_position({rod(assembly, 10.0 * radius * Vec3::UnitZ(), y, 2), 0.5});                // what repeats by y
        see_beside(assembly, {{2, 1.0}});
        see_beside(assembly, {{0, 1.0}});
        simulation::Simulator<Tied> simulator(assembly, parameters());
        settle(simulator);
        double inside = 0.0, across = 0.0;
        const auto& contacts = simulator.contacts();
        for (std::size_t k = 0; k < contacts.elements().size(); ++k)
            (contacts.elements()[k].fibre_j < 3 ? inside : across) += contacts.responses()[k].reaction;
        CAPTURE(cut);
        REQUIRE(inside > 0.0);
        CHECK(across == test::near(inside, 1e-9));
        if (pressed == 0.0) pressed = inside;
        CHECK(inside == test::near(pressed, 1e-9));
        // Work of the strain: the pressure of one seam times the width, beside that of the rod that repeats by it.
        const double strain = -depth / (2.0 * radius), stretch = 1.0 + strain;
        const double bar = young * area() * 0.5 * (stretch * stretch - 1.0) * stretch;
        CHECK(simulator.equilibrium().ties().cell_force(0)(1, 1) == test::near((bar - inside) * width, 1e-6));
    }
    // Two threads that cross, pressed together by forces that are alike at all nodes.
    double energy = 0.0;
    for (const double shift : {0.5, 1.5, 2.5, 3.5, 0.0, 2.0}) {  // elements: where they are cut; last at the crossing
        scene::Assembly assembly;
        assembly.add(scene::PeriodicCell{});
        constexpr Index elements = 4;
        const double side = 16.0 * radius;
        const Vec3 x = side * Vec3::UnitX(), y = side * Vec3::UnitY(), z = 2.0 * radius * Vec3::UnitZ();
        const double from = -0.5 + shift / static_cast<double>(elements);
        rod(assembly, from * x, x, elements), rod(assembly, from * y + z, y, elements);
        for (const Index f : {0, 1})
            for (Index node = 0; node < 2 * elements; ++node)
                assembly.apply(scene::DeadForce{{f, static_cast<double>(node) / (2.0 * elements)},
                                                scene::NodeVector::position,
                                                (f == 0 ? 1e-4 : -1e-4) * Vec3::UnitZ()});
        const Index ground = assembly.add(scene::RigidBody{});
        assembly.connect({.ends = {{0, 0.5}}, .body = ground});
        assembly.connect({.ends = {{1, 0.5}}, .body = ground, .tied = {true, true, false}});
        see_beside(assembly, {{0, 1.0}});
        for (const double back : {-1.0, 0.0, 1.0}) see_beside(assembly, {{0, back}, {1, 1.0}});
        simulation::Simulator<Tied> simulator(assembly, parameters());
        settle(simulator);
        const double own = simulator.equilibrium().elastic_energy(simulator.state());
        CAPTURE(shift);
        if (shift == 0.5 || shift == 0.0) energy = own;
        // Elements that are bent have a kink between them, and at a seam both sides of it touch.
        CHECK(own == test::near(energy, shift == 2.0 ? 1e-4 : 1e-8));
    }
}

TEST_CASE("what is in each other across a seam parts, and what passes through another one there is seen") {
    constexpr double r = radius, width = 40.0 * r, side = 20.0 * r;
    const auto scene_of = [&](double off, double aside) {  // two rods along x, beside the seam, and one across: all go on
        scene::Assembly assembly;
        assembly.add(scene::PeriodicCell{});
        const std::array<Vec3, 3> from{Vec3(0, off, 0), Vec3(0, width - off, 0), Vec3(-0.3 * r, 0, 10.0 * r)},
            along{Vec3(side, 0, 0), Vec3(side, 0, 0), Vec3(0, width, 0)};
        for (std::size_t k = 0; k < 3; ++k) {
            const Index f = periodic_rod(assembly, from[k], along[k], 4, k < 2 ? Vec3::UnitZ() : Vec3::UnitX());
            assembly.hold_position({f, 0.5}, k == 1 ? Mat3(Vec3(1, aside, 1).asDiagonal()) : Mat3(Mat3::Identity()));
        }
        for (Index f = 0; f < 3; ++f) {
            assembly.add(scene::FibreImage{f, {{0, 1.0}}});
            for (const double back : {-1.0, 0.0, 1.0}) assembly.add(scene::FibreImage{f, {{0, back}, {2, 1.0}}});
        }
        return assembly;
    };
    {
        simulation::Simulator<Tied> simulator(scene_of(3.0 * r, 1.0), parameters());
        const auto& mesh = simulator.mesh();
        const contact::Swept::Of<Tied::Beam> swept(mesh, contact::Detection{});
        const auto moved = [&](std::initializer_list<Index> fibres, const Vec3& by) {
            Vector state = simulator.state();
            for (const Index f : fibres)
                for (Index a = 0; a < mesh.node_count(f); ++a) state.segment<3>(3 * mesh.node_vector(f, a)) += by;
            scene::copy_to_images(mesh.layout(), state);
            return state;
        };
        const auto passed = [&](std::initializer_list<Index> fibres, const Vec3& by) {
            return swept.first(simulator.state(), moved(fibres, by), simulator.contacts(), false, true);
        };
        const auto through = passed({1}, Vec3(0, 12.0 * r, 0));
        REQUIRE(through);
        CHECK(through->image);
        CHECK(through->fibre + through->other == 1);
        CHECK(contact::text(*through).find("with the image of fibre 0 across a seam at ") != std::string::npos);
        CHECK_FALSE(passed({1}, Vec3(0, 4.0 * r, 0)));               // they touch
        CHECK_FALSE(passed({0, 1, 2}, Vec3(7.0 * r, 30.0 * r, r)));  // all go together
        CHECK(passed({2}, Vec3(0, 0, -20.0 * r)));                   // beyond the end of a rod, which goes on there
        CHECK_FALSE(passed({2}, Vec3(0, 0, -7.0 * r)));
    }
    simulation::PartingParameters parting;
    const auto part = [&](double aside) {
        return simulation::part_overlaps<Tied>(scene_of(0.6 * r, aside), parameters(), parting);
    };
    for (const double aside : {0.0, 1.0}) {  // the second one is free to move aside, or is held and goes along
        CAPTURE(aside);
        const simulation::Parting found = part(aside);
        CAPTURE(found.reason);
        CHECK(found.before.depth == test::near(0.8 * r, 1e-9));
        CHECK(found.before.fibre_i + found.before.fibre_j == 1);
        CHECK(found.parted);
        CHECK(found.after.depth <= 0.01 * r);
        for (const Index f : found.loosened) CHECK(f < 3);
        CHECK(found.loosened.empty() == (aside == 0.0));
    }
    parting.loosen_holds = false;
    const simulation::Parting held = part(1.0);
    CHECK_FALSE(held.parted);
    CHECK(held.reason.find("the image of fibre") != std::string::npos);
    CHECK(held.after.fibre_i + held.after.fibre_j == 1);
}

TEST_CASE("a scene that starts from the state of another one ties the means that it finds there") {
    const double stiffness = 3.0 * young * inertia() / std::pow(length, 3), given = 1e-3;
    const std::string file = "rigid_bodies_test_checkpoint.bin";
    Bundle loaded(3), tied(3);
    for (Index k = 0; k < 3; ++k)
        loaded.assembly.apply(scene::DeadForce{scene::last_end(k), scene::NodeVector::position,
                                               Vec3(0, stiffness * given * static_cast<double>(k), 0), "load"});
    {
        simulation::Simulator<Tied> simulator(loaded.assembly, parameters());
        simulation::Loading<Tied> loading{.increments = 1};
        loading.checkpoint = file;
        REQUIRE(simulator.run(loading).converged);
        CHECK(simulator.value(scene::last_end(2)).y() == test::near(2.0 * given, 1e-3));
    }
    scene::RigidBody mean;
    mean.position = {0, 0.3, length};  // anywhere
    const Index body = tied.assembly.add(mean);
    tied.assembly.connect({.ends = tied.last_ends(), .body = body, .tied = {false, true, false}});
    simulation::Simulator<Tied> simulator(tied.assembly, parameters());
    simulator.start_from(file);
    std::remove(file.c_str());
    CHECK(simulator.value(scene::last_end(2)).y() == test::near(2.0 * given, 1e-3));
    double found = 0.0;
    for (Index k = 0; k < 3; ++k) found += simulator.value(scene::last_end(k)).y() / 3.0;
    REQUIRE(simulator.run({.increments = 1}).converged);
    // Without their own loads all bend as the mean, which is where it was: a cantilever's but for shear and large deflection.
    CHECK(found == test::near(given, 1e-3));
    for (Index k = 0; k < 3; ++k) CHECK(simulator.value(scene::last_end(k)).y() == test::near(found, 1e-6));
    CHECK(simulator.equilibrium().ties().wrench(body).force.y() == test::near(3.0 * stiffness * given, 1e-3));
}

TEST_CASE("a programme of stages is a loading: ramps, cycles to and fro, halved increments") {
    simulation::LoadProgramme programme;
    programme.stages = {{.name = "tighten", .increments = 2, .ramps = {{"load", 0.5}}, .damping = 3.0},
                        {.name = "cycle", .increments = 4, .ramps = {{"load", 1.0}}, .cycles = 2, .back = 0.25}};
    programme.damping = 2.0, programme.halvings = 1;
    const simulation::Loading<Tied> loading = simulation::loading_of<Tied>(programme);
    REQUIRE(loading.stages.size() == 5);
    std::vector<double> ends;
    for (const auto& stage : loading.stages) ends.push_back(stage.ramps.at(0).to);
    CHECK(ends == std::vector<double>{0.5, 1.0, 0.25, 1.0, 0.25});
    CHECK(loading.stages[0].increments == 4);
    CHECK(loading.stages[1].increments == 8);
    CHECK(loading.stages[0].damping == 6.0);
    loading.validate();
    programme.stages[1].rest = true;
    CHECK(test::refusal([&] { simulation::loading_of<Tied>(programme); }).find("LoadProgramme.rest_motion") != std::string::npos);
}

TEST_CASE("an end that is held cannot be tied, nor tied twice, and a body needs a model that knows it") {
    Bundle bundle(1);
    bundle.assembly.hold_position(scene::last_end(0));
    bundle.assembly.connect({.ends = {scene::last_end(0)}, .body = 0});
    CHECK(test::refusal([&] {
              simulation::Simulator<Tied>(bundle.assembly, parameters());
          }).find("neither held nor tied twice") != std::string::npos);
    scene::RigidBody skew;
    skew.frame(0, 0) = 2.0;
    CHECK(test::refusal([&] { bundle.assembly.add(skew); }).find("RigidBody.frame") != std::string::npos);
    CHECK(test::refusal([&] {
              bundle.assembly.connect(scene::AverageConnection{.ends = {scene::last_end(0)}, .body = 7});
          }).find("AverageConnection.body = 7") != std::string::npos);
}

TEST_CASE("a rod that is seen beside its cell by the period of another one moves as the plate does where it lies") {
    const Vec3 bends(0.3, -0.2, 0.5);
    scene::Assembly assembly;
    scene::PeriodicCell cell;
    for (const std::size_t k : {0u, 1u, 2u})
        cell.curvature[k] = scene::Coordinate::held_at(1e-5 * bends[static_cast<Index>(k)], "bend");
    assembly.add(cell);
    for (const double side : {-1.0, 1.0}) {
        const Vec3 middle(0.0, 0.4 * side, 0.3 * side), along(length, 0, 0);
        assembly.hold_position({periodic_rod(assembly, middle - 0.5 * along, along, 4, Vec3::UnitY()), 0.5});
    }
    assembly.add(scene::FibreImage{1, {{0, 1.0}}});
    simulation::Simulator<Tied> simulator(assembly, parameters());
    REQUIRE(simulator.run({.increments = 1}).converged);
    Index seen = 0;
    for (const scene::ImageVector& one : simulator.equilibrium().system().layout().images) {
        if (one.shift < 0) continue;
        ++seen;
        const Vec3 start = simulator.mesh().start_state().segment<3>(3 * one.source), along(length, 0, 0);
        const Vec3 apart_now = simulator.state().segment<3>(3 * one.image) - simulator.state().segment<3>(3 * one.source);
        CHECK((apart_now - along - 1e-5 * connection::bend_jump(start, along, false) * bends).norm() < 1e-12);
    }
    CHECK(seen == 9);
}

TEST_CASE("the mean of ends is moved by what is asked for, however many ends there are") {
    const double given = 1e-3;
    Bundle bundle(3);
    const Index ground = bundle.assembly.add(scene::RigidBody{});
    bundle.assembly.connect({.ends = bundle.last_ends(),
                             .body = ground,
                             .tied = {false, true, false},
                             .displacement = {0, given, 0},
                             .channel = "push"});
    simulation::Simulator<Tied> simulator(bundle.assembly, parameters());
    REQUIRE(simulator.run({.increments = 1}).converged);
    for (Index k = 0; k < 3; ++k) CHECK(simulator.value(scene::last_end(k)).y() == test::near(given, 1e-9));
}

}  // namespace rigid_bodies_test

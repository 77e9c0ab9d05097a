// SPDX-License-Identifier: MIT
// The same scenes over thirty decades of length and of modulus, by each solver: no number of the program is one of millimetres.
#include "simulation/scenes.hpp"

#include <fibrant/compositions/strand/strand.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace units_test {

using simulation::Ramp;

/// A scene whose lengths are given in `length`, and whose moduli in `modulus`.
struct Scene {
    scene::Assembly assembly;
    std::vector<Ramp> ramps;
};
constexpr double r = 0.0201, young = 7300.0;

Scene cantilever(double length, double modulus) {
    test::Rod rod;
    rod.radius *= length, rod.length *= length, rod.young *= modulus, rod.elements = 8;
    return {rod.pushed(3.0), {{"load", 1.0}}};
}
Scene crossing(double length, double modulus) {
    test::Crossing crossing;
    crossing.radius *= length, crossing.length *= length, crossing.young *= modulus;
    crossing.approach = 1.5 * crossing.radius, crossing.drag = 0.1 * crossing.radius;
    return {crossing.assembly(), {{"approach", 1.0}, {"drag", 1.0}}};
}
Scene strand(double length, double modulus) {
    compositions::strand::StrandParameters parameters;
    parameters.core_radius = 1.1 * r * length, parameters.length = 40.0 * r * length, parameters.elements = 8;
    parameters.material = {young * modulus, 0.3}, parameters.layers = {{6, r * length, 15.0}};
    return {compositions::strand::straight_strand(parameters), {{"stretch", 0.004}, {"twist", 0.02 / parameters.length}}};
}
/// Three fibres, clamped to a body at either end; the far one is pushed aside, and turns and slides as it likes.
Scene tied(double length, double modulus) {
    Scene scene;
    const Vec3 far(0, 0, 2.0 * length);
    scene.assembly.add(scene::RigidBody{});
    scene::RigidBody end;
    end.position = far;
    end.translation[1] = scene::Coordinate::held_at(0.1 * length, "push");
    end.translation[2] = end.rotation[0] = scene::Coordinate::loose();
    const Index body = scene.assembly.add(end);
    for (const double x : {-0.1 * length, 0.0, 0.1 * length}) {
        const Index fibre = scene.assembly.add({.from = {x, 0, 0},
                                                .to = Vec3(x, 0, 0) + far,
                                                .section = scene::circular(r * length),
                                                .material = {young * modulus, 0.3},
                                                .elements = 6,
                                                .director = Vec3::UnitX()});
        scene.assembly.clamp_to(0, scene::first_end(fibre), Mat3::Identity());
        scene.assembly.clamp_to(body, scene::last_end(fibre), Mat3::Identity());
    }
    scene.ramps = {{"push", 1.0}};
    return scene;
}
/// A cantilever that a cylinder pushes aside.
Scene pushed(double length, double modulus) {
    test::Rod rod;
    rod.radius *= length, rod.length *= length, rod.young *= modulus, rod.elements = 8;
    Scene scene{rod.clamped(), {{"tools", 1.0}}};
    scene::Tool tool;
    tool.shape = scene::ToolShape::cylinder, tool.radius = 0.1 * length, tool.axis = Vec3::UnitY();
    tool.origin = Vec3(0.1 * length + 1.02 * rod.radius, 0, 1.6 * length), tool.displacement = Vec3(-0.1, 0, 0.01) * length;
    scene.assembly.add(tool);
    return scene;
}

/// What a run came to, in the units of its scene.
struct Outcome {
    Vector state, figures;
    simulation::Report report;
};

template <simulation::Model M>
Outcome run(const Scene& scene, double length, double modulus, const char* strategy) {
    auto parameters = test::tight_parameters<M>(r * length);
    parameters.solver.strategy = strategy;
    parameters.iteration.newton_limit = 40;
    // Passes that end a pass earlier or later by rounding must not differ by more than is asked of digits.
    parameters.iteration.normal_step_tolerance = 1e-8, parameters.iteration.contact_tolerance = 1e-7;
    parameters.iteration.normal_limit = parameters.iteration.contact_limit = 40;
    simulation::Simulator<M> simulator(scene.assembly, parameters);
    simulation::Loading<M> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = scene.ramps, loading.stages[0].increments = 3;
    Outcome outcome;
    outcome.report = simulator.run(loading);
    outcome.state = simulator.state();
    for (Index v = 0; v < outcome.state.size() / 3; ++v) {
        const bool tangent =
            M::Beam::vectors_per_node == 2 && simulator.mesh().layout().kind[core::at(v)] == scene::VectorKind::direction;
        if (tangent || simulator.mesh().layout().kind[core::at(v)] == scene::VectorKind::position)
            outcome.state.segment<3>(3 * v) /= length;
    }
    const double work = modulus * std::pow(length, 3);
    const simulation::EnergyBalance& energy = outcome.report.energy;
    outcome.figures.resize(4);
    outcome.figures << energy.elastic / work, energy.external / work, energy.contact / work,
        outcome.report.contact.reaction_sum / (modulus * length * length);
    return outcome;
}

const double decade = std::pow(10.0, 15), two = std::ldexp(1.0, 50);
struct Units {
    double length, modulus;
};

/// What is left is the rounding of the scene's numbers, and what iterations make of it; of powers of two there is next to none.
/// @param tolerance  of places; forces and energies of contact are those of a penetration of 1e-2 r, in which places are a
/// hundredth as exact
template <class M>
void check_any_units(const char* name, Scene (*build)(double, double), const char* strategy, double tolerance = 1e-9) {
    const auto of = [&](const Units& units) {
        return run<M>(build(units.length, units.modulus), units.length, units.modulus, strategy);
    };
    const Outcome one = of({1.0, 1.0});
    CAPTURE(name);
    REQUIRE_MESSAGE(one.report.converged, one.report.reason);
    double off = 0.0, figures = 0.0;
    for (const Units& units : {Units{1.0 / decade, 1.0}, Units{decade, 1.0}, Units{1.0, 1.0 / decade}, Units{1.0, decade},
                               Units{1.0 / decade, 1.0 / decade}, Units{decade, decade}, Units{1e-4, 1e6}}) {
        const Outcome other = of(units);
        CAPTURE(units.length);
        CAPTURE(units.modulus);
        CHECK_MESSAGE(other.report.converged, other.report.reason);
        off = std::max(off, (other.state - one.state).cwiseAbs().maxCoeff());
        figures = std::max(figures, (other.figures - one.figures).cwiseAbs().maxCoeff() / one.figures.cwiseAbs().maxCoeff());
    }
    for (const Units& units :
         {Units{1.0 / two, 1.0}, Units{two, 1.0}, Units{1.0, 1.0 / two}, Units{1.0, two}, Units{1.0 / two, 1.0 / two}}) {
        const Outcome other = of(units);
        CAPTURE(units.length);
        CAPTURE(units.modulus);
        CHECK_MESSAGE(other.report.converged, other.report.reason);
        // Solvers that keep parts in single precision round them in their own scale.
        CHECK((other.state - one.state).cwiseAbs().maxCoeff() < 1e-11);
    }
    std::printf("%s: off by %.1e of the unit of length, energies and forces by %.1e; %td solves, %td linear iterations\n", name,
                off, figures, one.report.counts.linear_solves, one.report.counts.linear_iterations);
    CHECK(off < tolerance);
    CHECK(figures < 100.0 * tolerance);
}

TEST_CASE("scenes of director beams are the same in any units, by each solver") {
    for (const char* strategy : solver::AnySolver::strategies) {
        CAPTURE(strategy);
        std::printf("%s\n", strategy);
        check_any_units<test::EveryDirector>("  cantilever", cantilever, strategy);
        check_any_units<test::EveryDirector>("  crossing", crossing, strategy);
        check_any_units<test::EveryDirector>("  strand", strand, strategy);
        check_any_units<test::EveryDirector>("  tied", tied, strategy);
        check_any_units<test::EveryDirector>("  pushed", pushed, strategy);
    }
}

TEST_CASE("so are those of rods of rigid sections and of cables") {
    check_any_units<test::EveryRod>("cantilever, rod", cantilever, "fibre_block_pcg");
    check_any_units<test::EveryRod>("crossing, rod", crossing, "fibre_block_pcg");
    check_any_units<test::EveryRod>("pushed, rod", pushed, "fibre_block_pcg");
    check_any_units<test::EveryCable>("cantilever, cable", cantilever, "fibre_block_pcg");
    check_any_units<test::EveryCable>("crossing, cable", crossing, "fibre_block_pcg");
}

}  // namespace units_test

// SPDX-License-Identifier: MIT
// What a run says of itself at its end.
#include "simulation/scenes.hpp"

#include <fibrant/solver/automatic_solver.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace report_test {

using test::Crossing;
using test::Smooth;

struct Choosing : Smooth {
    using Solver = solver::AutomaticSolver;
};

template <simulation::Model M>
simulation::Report pressed(const simulation::ModelParameters<M>& parameters) {
    simulation::Simulator<M> simulator(Crossing{}.assembly(), parameters);
    simulation::Loading<M> loading;
    loading.increments = 4;
    return simulator.run(loading);
}

TEST_CASE(
    "a run with a solver that chooses says which strategies it used and why it left one, and finds what a direct solver finds") {
    simulation::ModelParameters<Choosing> parameters = test::model_parameters<Choosing>(Crossing{}.radius);
    parameters.solver.few_couplings = 0.0, parameters.solver.two_level_limit = 1;  // one iteration is never enough here
    const simulation::Report chosen = pressed<Choosing>(parameters),
                             direct = pressed<Smooth>(test::model_parameters<Smooth>(Crossing{}.radius));
    REQUIRE(chosen.converged);
    REQUIRE(direct.converged);
    CAPTURE(chosen.solver);
    CHECK(chosen.solver.starts_with("automatic: solves by "));
    CHECK(chosen.solver.find("FloatBlockCholesky") != std::string::npos);
    CHECK(chosen.solver.find("the last: TwoLevelPcg reached a residual of ") != std::string::npos);
    CHECK(direct.solver.empty());
    // Both balance forces to 1e-4.
    CHECK(chosen.contact.reaction_sum == test::near(direct.contact.reaction_sum, 1e-3));
    CHECK(direct.contact.reaction_sum > 0.0);
}

TEST_CASE("what a snapshot shows of contacts between fibres balances what the supports of these bear, friction and all") {
    Crossing crossing;
    crossing.drag = 0.05;
    const simulation::ModelParameters<test::Rough> parameters = test::tight_parameters<test::Rough>(crossing.radius);
    simulation::Simulator<test::Rough> simulator(crossing.assembly(), parameters);
    simulation::Loading<test::Rough> loading;
    for (const char* channel : {"approach", "drag"})
        loading.stages.push_back({.name = channel, .increments = 4, .ramps = {{channel, 1.0}}});
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const observe::Snapshot shot = simulator.snapshot();
    Vec3 normal = Vec3::Zero(), friction = Vec3::Zero();  // on the upper fibre
    for (const observe::ContactSnapshot& contact : shot.contacts) {
        REQUIRE(contact.fibre_i + contact.fibre_j == 1);
        const double side = contact.fibre_j == crossing.upper() ? 1.0 : -1.0;
        normal += side * contact.reaction * contact.normal, friction -= side * contact.friction;
    }
    Vec3 borne = Vec3::Zero();
    for (const double end : {0.0, 1.0}) borne += simulator.reaction({crossing.upper(), end});
    CHECK(normal.z() > 0.0);
    CHECK(friction.norm() > 0.1 * parameters.friction.friction_coefficient * normal.norm());
    CHECK((normal + friction + borne).norm() < 1e-6 * borne.norm());
    // Ends went where they were taken.
    const observe::FibreSnapshot &lower = shot.fibres[core::at(crossing.lower())],
                                 &upper = shot.fibres[core::at(crossing.upper())];
    CHECK((lower.displacement.front() - Vec3(crossing.drag, 0, 0)).norm() < 1e-9 * crossing.drag);
    CHECK((upper.displacement.back() - Vec3(0, 0, -crossing.approach)).norm() < 1e-9 * crossing.approach);
}

TEST_CASE("a snapshot shows how far a cantilever has moved from its rest, and the curvature P (L - s) / E I") {
    const test::Rod rod;
    const double load = 1e-3;  // P L^2 / E I: slopes to 5e-4, so that squares of these are rounding
    simulation::Simulator<Smooth> simulator(rod.pushed(load), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(simulator.run({.increments = 1}).converged);
    const observe::FibreSnapshot shown = simulator.snapshot().fibres[0];
    REQUIRE(core::count(shown.curvature) == 2 * rod.elements + 1);
    for (Index e = 0; e < rod.elements; ++e) {  // in the middle of each element, where a parabola has the curvature of the rod
        const double left = 1.0 - (static_cast<double>(e) + 0.5) / static_cast<double>(rod.elements);
        CHECK(std::abs(shown.curvature[core::at(2 * e + 1)] * rod.length / load - left) < 5e-3);
    }
    // P L^3 / 3 E I, and what shear adds: 2.2 (r / L)^2 or so.
    CHECK(shown.displacement.back().x() == test::near(load * rod.length / 3.0, 2e-3));
    CHECK(shown.displacement.front().norm() < 1e-12 * rod.length);
}

}  // namespace report_test

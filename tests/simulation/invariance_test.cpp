// SPDX-License-Identifier: MIT
// What the result of a run must not depend on: earlier runs, the number of threads, units, the order of the fibres.
#include "simulation/scenes.hpp"
#include "support/threads.hpp"

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace invariance_test {

using simulation::Report;
using simulation::Simulator;
using test::Crossing;
using test::Rod;
using test::Rough;
using test::same_bits;

Crossing dragged() {
    Crossing crossing;
    crossing.approach = 1.5 * crossing.radius;
    crossing.drag = 0.1 * crossing.radius;
    return crossing;
}

struct Outcome {
    Vector state;  ///< positions over the radius
    Report report;
    double radius = 1, force = 1;
};

template <simulation::Model M>
Outcome run(const Crossing& crossing, double length_unit = 1.0, double force_unit = 1.0) {
    Crossing scaled = crossing;
    scaled.radius *= length_unit, scaled.length *= length_unit, scaled.approach *= length_unit, scaled.drag *= length_unit;
    scaled.young *= force_unit / (length_unit * length_unit);
    simulation::ModelParameters<M> parameters = test::model_parameters<M>(scaled.radius);
    if constexpr (std::is_same_v<M, test::EveryDirector>) parameters.solver.strategy = "fibre_block_pcg";  // that iterates
    Simulator<M> simulator(scaled.assembly(), parameters);
    Outcome outcome;
    outcome.report = simulator.run({.increments = 4});
    outcome.state = simulator.state();
    if (scaled.swapped) {  // the upper fibre's unknowns last, as without
        const Index half = outcome.state.size() / 2;
        outcome.state << simulator.state().tail(half), simulator.state().head(half);
    }
    outcome.radius = scaled.radius, outcome.force = force_unit;
    for (Index v = 0; v < outcome.state.size() / 3; v += 3) outcome.state.segment<3>(3 * v) /= scaled.radius;
    CAPTURE(outcome.report.reason);
    REQUIRE(outcome.report.converged);
    return outcome;
}

/// Same dimensionless results; a tolerance that is not dimensionless would show as another path of the iterations.
void check_same(const Outcome& a, const Outcome& b, double tolerance) {
    std::printf("off by %.1e r, reaction by %.1e\n", (a.state - b.state).cwiseAbs().maxCoeff(),
                b.report.contact.reaction_sum / b.force / (a.report.contact.reaction_sum / a.force) - 1.0);
    CHECK((a.state - b.state).cwiseAbs().maxCoeff() < tolerance);
    CHECK(a.report.counts.newton == b.report.counts.newton);
    CHECK(a.report.counts.contact_passes == b.report.counts.contact_passes);
    CHECK(a.report.contact.active > 0);
    CHECK(a.report.contact.active == b.report.contact.active);
    const auto close = [&](double x, double y) { return std::abs(x - y) <= 10.0 * tolerance * std::abs(x); };
    CHECK(close(a.report.contact.reaction_sum / a.force, b.report.contact.reaction_sum / b.force));
    CHECK(close(a.report.contact.greatest_penetration / a.radius, b.report.contact.greatest_penetration / b.radius));
    CHECK(close(a.report.energy.elastic / (a.force * a.radius), b.report.energy.elastic / (b.force * b.radius)));
    CHECK(close(a.report.energy.external / (a.force * a.radius), b.report.energy.external / (b.force * b.radius)));
}

TEST_CASE_TEMPLATE("a run repeated gives the same bits, on one thread as on two", M, Rough, test::EveryDirector) {
    const Outcome first = run<M>(dragged()), second = run<M>(dragged());
    CHECK(same_bits(first.state, second.state));
    const Outcome one = test::with_threads(1, [] { return run<M>(dragged()); });
    const Outcome two = test::with_threads(2, [] { return run<M>(dragged()); });
    CHECK(same_bits(one.state, two.state));
    CHECK(same_bits(one.state, first.state));
    CHECK(one.report.energy.external == two.report.energy.external);
    CHECK(one.report.energy.dissipated == two.report.energy.dissipated);
}

TEST_CASE("results do not depend on the units: millimetres and newtons, metres, kilonewtons") {
    const Outcome millimetres = run<Rough>(dragged());
    // The same operations on scaled numbers: what is left is rounding, of which a contact's stiffness keeps six digits.
    check_same(millimetres, run<Rough>(dragged(), 1e-3, 1.0), 1e-9);
    check_same(millimetres, run<Rough>(dragged(), 1e-3, 1e-3), 1e-9);
    check_same(millimetres, run<Rough>(dragged(), 1e3, 1e6), 1e-9);
}

TEST_CASE("powers of two as units change no bit") {
    const Outcome one = run<Rough>(dragged()), scaled = run<Rough>(dragged(), std::ldexp(1.0, -10), std::ldexp(1.0, 7));
    CHECK(same_bits(one.state, scaled.state));
}

TEST_CASE("results do not depend on the order in which fibres are given") {
    Crossing swapped = dragged();
    swapped.swapped = true;
    check_same(run<Rough>(dragged()), run<Rough>(swapped), 1e-9);
}

TEST_CASE("a single fibre bends alike in any units") {
    const auto tip = [](double length_unit, double force_unit) {
        Rod rod;
        rod.radius *= length_unit, rod.length *= length_unit;
        rod.young *= force_unit / (length_unit * length_unit);
        Simulator<Rough> simulator(rod.pushed(5.0), test::model_parameters<Rough>(rod.radius));
        const Report report = simulator.run({.increments = 1});
        REQUIRE(report.converged);
        return Vec3(simulator.value(scene::last_end(0)) / rod.length);
    };
    const Vec3 reference = tip(1.0, 1.0);
    CHECK((tip(1e-3, 1.0) - reference).norm() < 1e-9);
    CHECK((tip(1e3, 1e-6) - reference).norm() < 1e-9);
}

}  // namespace invariance_test

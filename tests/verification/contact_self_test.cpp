// SPDX-License-Identifier: MIT
// One fibre that touches itself: where its arc crosses, beside itself in a bend, and never with what is next to it along it.
#include <contact/contact_model.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace contact_self_test {

using test::Smooth;

const double r = 0.0201, pi = std::numbers::pi;

simulation::ModelParameters<Smooth> parameters() {
    auto all = test::pressed_parameters<Smooth>(1e-3 * r);
    all.contact.detection.self_contact = true;
    return all;
}

void hold(scene::Assembly& assembly, Index fibre, double fraction, const Vec3& displacement) {
    for (const auto vector : {scene::NodeVector::position, scene::NodeVector::director_1, scene::NodeVector::director_2}) {
        scene::Hold still;
        still.at = {fibre, fraction}, still.vector = vector;
        if (vector == scene::NodeVector::position) still.displacement = displacement;
        assembly.hold(still);
    }
}

/// A hairpin: two legs side by side, joined by half a circle of centreline radius R. Parameter 0 to 1.
scene::Curve hairpin(double leg, double R) {
    return [=](double t) {
        const double arc = t * (2.0 * leg + pi * R);
        if (arc < leg) return Vec3(arc - leg, -R, 0.0);
        if (arc > leg + pi * R) return Vec3(leg + pi * R - arc, R, 0.0);
        const double angle = (arc - leg) / R;
        return Vec3(R * std::sin(angle), -R * std::cos(angle), 0.0);
    };
}

TEST_CASE("a fibre that crosses itself is held apart as two fibres are") {
    // Two straight spans of one fibre, one across the other at mid-span, joined by a loop whose nodes are all held: each span is
    // clamped at both ends, and the reference is crossed_fibres.json, 1.005 long, pressed by 0.01005.
    const double span = 1.005, approach = 0.01005, expected = 0.000891765717759;
    const double half = 0.5 * span, turn = 0.5 * span;  // three quarters of a circle lead from (half, 0) to (0, half)
    const double arc = 1.5 * pi * turn, total = 2.0 * span + arc;
    const Index per_span = 20;
    // Spans and arc in elements of nearly equal length, with nodes at the ends of the spans.
    const auto curve = [=](double t) {
        const double s = t * total;
        if (s <= span) return Vec3(s - half, 0.0, 0.0);
        if (s >= span + arc) return Vec3(0.0, half - (s - span - arc), 2.0 * r);
        const double w = (s - span) / arc, angle = -0.5 * pi + 1.5 * pi * w, rise = w * w * (3.0 - 2.0 * w);
        return Vec3(half + turn * std::cos(angle), turn + turn * std::sin(angle), 2.0 * r * rise);
    };
    // elements: span / h each, arc / h = 2.356 spans; take h so that both are close to whole numbers
    const Index elements = static_cast<Index>(std::lround(total / span * static_cast<double>(per_span)));
    scene::Assembly assembly;
    scene::FibreSpecification fibre = test::curved_fibre(curve, r, elements);
    fibre.director = Vec3::UnitZ();
    assembly.add(fibre);
    // The nearest node to each end of a span is held, and so is all between: spans are then off by up to a quarter element.
    const Index nodes = 2 * elements;
    const auto node_at = [&](double s) { return static_cast<Index>(std::lround(s / total * static_cast<double>(nodes))); };
    const Index last_of_first = node_at(span), first_of_second = node_at(span + arc);
    for (Index k = 0; k <= nodes; ++k) {
        const double fraction = static_cast<double>(k) / static_cast<double>(nodes);
        if (k == 0 || (k >= last_of_first && k < (last_of_first + first_of_second) / 2))
            hold(assembly, 0, fraction, Vec3::Zero());
        if (k == nodes || (k >= (last_of_first + first_of_second) / 2 && k <= first_of_second))
            hold(assembly, 0, fraction, Vec3(0, 0, -approach));
    }
    simulation::Simulator<Smooth> simulator(assembly, parameters());
    const simulation::Report report = simulator.run(test::stage<Smooth>({{"motion", 1.0}}, 5));
    REQUIRE_MESSAGE(report.converged, report.reason);
    CHECK(report.contact.active == 1);
    for (const auto& element : simulator.contacts().elements()) {
        CHECK(element.fibre_i == element.fibre_j);
        CHECK(element.u_j - element.u_i > 1.0);
    }
    // F goes with the cube of the spans, whose ends fell on nodes.
    const double h = total / static_cast<double>(nodes);
    const double first = static_cast<double>(last_of_first) * h, second = total - static_cast<double>(first_of_second) * h;
    const double force = report.contact.reaction_sum, lost = report.contact.greatest_penetration;
    std::printf("spans %.4f and %.4f of %.4f: force %.8f, %.8f expected, %+.2e, penetration %.1e r\n", first, second, span, force,
                expected, force / expected - 1.0, lost / r);
    CHECK(std::abs(first / span - 1.0) < 0.003);
    CHECK(std::abs(second / span - 1.0) < 0.003);
    CHECK(std::abs(force / expected - 1.0) < 0.015);  // 3 times the error of a span, and what the pinch takes off the approach
}

TEST_CASE("a fibre does not touch what is next to it along itself, however short its elements or tight its bend") {
    // Elements of 0.3 to 3 radii in a bend of 1.5 radii: neighbours are nearer than a diameter along the arc, the legs are not.
    for (const double length : {0.3, 1.0, 3.0}) {
        const double leg = 12.0 * r, R = 1.5 * r;
        scene::Assembly assembly;
        assembly.add(
            test::curved_fibre(hairpin(leg, R), r, static_cast<Index>(std::lround((2.0 * leg + pi * R) / (length * r)))));
        hold(assembly, 0, 0.0, Vec3::Zero());
        simulation::Simulator<Smooth> simulator(assembly, parameters());
        const simulation::Report report = simulator.run({.increments = 1});
        REQUIRE_MESSAGE(report.converged, report.reason);
        CHECK(report.contact.active == 0);
        CHECK(report.contact.greatest_penetration == 0.0);
    }
}

TEST_CASE("the legs of a hairpin that is pressed shut touch each other") {
    // The legs start 0.6 radii apart, held at their ends; two forces press them together.
    const double leg = 20.0 * r, R = 1.3 * r, push = 0.05;
    scene::Assembly assembly;
    assembly.add(test::curved_fibre(hairpin(leg, R), r, 40));
    hold(assembly, 0, 0.0, Vec3::Zero());
    hold(assembly, 0, 1.0, Vec3::Zero());
    for (const double side : {0.0, 1.0})
        assembly.apply(
            scene::DeadForce{{0, 0.25 + 0.5 * side}, scene::NodeVector::position, Vec3(0, (1.0 - 2.0 * side) * push, 0), "load"});
    const auto apart = [](const auto& simulator) { return simulator.value({0, 0.75}).y() - simulator.value({0, 0.25}).y(); };
    auto seeing = parameters();
    seeing.contact.stiffness.initial_fraction = 1.0;
    simulation::Simulator<Smooth> simulator(assembly, seeing);
    const simulation::Report report = simulator.run(test::stage<Smooth>({{"load", 1.0}}, 6));
    REQUIRE_MESSAGE(report.converged, report.reason);
    const Vec3 first = simulator.reaction(scene::first_end(0));
    std::printf("hairpin: %td active, %.5f N in contact, %.5f N at an end, %.5f r apart, penetration %.1e r\n",
                report.contact.active, report.contact.reaction_sum, first.y(), apart(simulator) / r,
                report.contact.greatest_penetration / r);
    CHECK(report.contact.active >= 1);
    CHECK(report.contact.greatest_penetration < 5e-3 * r);
    CHECK(apart(simulator) > 1.98 * r);  // sections flatten a little
    // Half the fibre in balance: the push, its end and contact with the other half; the bend, which is stiff, holds the rest.
    CHECK(std::abs(push + first.y() - report.contact.reaction_sum) < 0.15 * push);
    // Without self-contact the legs pass into each other.
    auto blind = seeing;
    blind.contact.detection.self_contact = false;
    simulation::Simulator<Smooth> through(assembly, blind);
    REQUIRE(through.run(test::stage<Smooth>({{"load", 1.0}}, 6)).converged);
    std::printf("without: %.5f r apart\n", apart(through) / r);
    CHECK(apart(through) < 1.9 * r);
}

}  // namespace contact_self_test

// SPDX-License-Identifier: MIT
// Multipliers take the penetration away that a penalty leaves, at a penalty that may be soft.
#include <contact/contact_model.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/augmented.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace contact_augmented_test {

using Held = test::Multiplied;
using test::Smooth;

const double r = 0.0201;

template <simulation::Model M>
simulation::ModelParameters<M> parameters(double fraction, double largest) {
    auto all = test::pressed_parameters<Smooth>(0.05 * r);
    simulation::ModelParameters<M> own;
    own.contact = all.contact, own.iteration = all.iteration;
    own.iteration.multiplier_limit = 3;  // those that bring contacts nearer do not count, however many a soft penalty takes
    if constexpr (core::Active<typename M::Friction>)
        own.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};
    if constexpr (law::Augmenting<typename M::Normal>) {
        own.normal = {.law = {.regularisation_depth = 1e-3 * r}, .largest_penetration = largest};
    } else {
        own.normal = {.regularisation_depth = 1e-3 * r};
    }
    own.contact.stiffness.initial_fraction = own.contact.stiffness.floor_fraction = own.contact.stiffness.cap_fraction = fraction;
    return own;
}

/// Two crossing fibres, each clamped at both ends, the upper one moved down.
scene::Assembly crossing(double approach) {
    const double half = 0.5025;
    scene::Assembly assembly;
    const Index lower = assembly.add(test::straight_fibre({-half, 0, 0}, {half, 0, 0}, r, 24));
    const Index upper = assembly.add(test::straight_fibre({0, -half, 2 * r}, {0, half, 2 * r}, r, 24));
    for (const double end : {0.0, 1.0}) {
        assembly.clamp({lower, end});
        assembly.clamp({upper, end}, Vec3(0, 0, -approach));
    }
    return assembly;
}

TEST_CASE("crossed fibres push each other apart as if neither could enter the other, however soft the penalty") {
    const double approach = 0.0402, expected = 0.00435476149304;  // crossed_fibres.json
    simulation::Simulator<Smooth> hard(crossing(approach), parameters<Smooth>(10.0, 0.0)),
        soft(crossing(approach), parameters<Smooth>(0.001, 0.0));
    REQUIRE(hard.run(test::stage<Smooth>({{"motion", 1.0}}, 4)).converged);
    const simulation::Report sunk = soft.run(test::stage<Smooth>({{"motion", 1.0}}, 4));
    REQUIRE(sunk.converged);
    const auto force = [](const auto& simulator) { return (simulator.reaction({0, 0.0}) + simulator.reaction({0, 1.0})).z(); };
    double first = 0.0;
    for (const double fraction : {0.001, 0.01, 1.0}) {
        simulation::Simulator<Held> held(crossing(approach), parameters<Held>(fraction, 1e-6 * r));
        const simulation::Report report = held.run(test::stage<Held>({{"motion", 1.0}}, 4));
        REQUIRE_MESSAGE(report.converged, report.reason);
        std::printf(
            "penalty %g: force %.9f, %.9f with a hard one (%+.1e), %.9f for rods (%+.1e); penetration %.1e r, alone %.1e r; %td "
            "contact passes\n",
            fraction, force(held), force(hard), force(held) / force(hard) - 1.0, expected, force(held) / expected - 1.0,
            report.contact.greatest_penetration / r, sunk.contact.greatest_penetration / r, report.counts.contact_passes);
        CHECK(report.contact.greatest_penetration < 1e-6 * r);
        CHECK(std::abs(force(held) / force(hard) - 1.0) < 5e-4);  // the hard penalty sinks by 5e-4 r, of an approach of 2 r
        CHECK(std::abs(force(held) / expected - 1.0) <
              3e-3);  // the pinch, which the reference does not have, takes 2e-3 off the approach
        CHECK(std::abs(report.contact.reaction_sum / force(held) - 1.0) < 1e-6);
        if (first == 0.0) first = force(held);
        CHECK(std::abs(force(held) / first - 1.0) < 2e-6);  // 1e-6 r of 2 r, which the force follows
    }
    CHECK(sunk.contact.greatest_penetration > 1e-2 * r);  // what there was to take away
    CHECK(std::abs(force(soft) / expected - 1.0) > 5e-3);
}

TEST_CASE("a contact that opens lets its multiplier go") {
    simulation::Simulator<Held> held(crossing(0.0402), parameters<Held>(0.01, 1e-6 * r));
    REQUIRE(held.run(test::stage<Held>({{"motion", 1.0}}, 4)).converged);
    const simulation::Report report = held.run(test::stage<Held>({{"motion", -0.1}}, 4));
    REQUIRE_MESSAGE(report.converged, report.reason);
    CHECK(report.contact.active == 0);
    CHECK(report.contact.reaction_sum == 0.0);
    CHECK(held.reaction({0, 0.0}).norm() < 1e-9);
}

TEST_CASE("multipliers hold a fibre on a plate without a penetration") {
    scene::Assembly assembly;
    assembly.add(test::straight_fibre({0, 0, r}, {0.5, 0, r}, r, 6));
    scene::Tool plate;
    plate.displacement = {0, 0, 0.02 * r};
    assembly.add(plate);
    for (const double end : {0.0, 1.0}) assembly.hold_position({0, end});
    assembly.hold_axial_rotation({0, 0.0});
    auto soft = parameters<Held>(0.5, 1e-6 * r);
    simulation::Simulator<Held> simulator(assembly, soft);
    const simulation::Report report = simulator.run(test::stage<Held>({{"tools", 1.0}}, 2));
    REQUIRE_MESSAGE(report.converged, report.reason);
    std::printf("plate: %.6f N, penetration %.1e r\n", simulator.contacts().tools().reaction(0).force.z(),
                report.contact.greatest_penetration / r);
    CHECK(report.contact.greatest_penetration < 1e-6 * r);
    CHECK(report.contact.reaction_sum > 0.0);
}

}  // namespace contact_augmented_test

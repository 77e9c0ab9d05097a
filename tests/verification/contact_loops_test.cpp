// SPDX-License-Identifier: MIT
// Loops that hang in each other and are drawn tight: the place of contact slides in the valley that each is to the other.
#include "../support/hooked_rings.hpp"

#include <doctest/doctest.h>

#include <cstdio>
#include <string>

using namespace fibrant;

namespace contact_loops_test {

using test::Hooked;
using test::Hooks;

/// @param touching  sum of both radii, over that of the upper one
void check_held(const Hooked& hooked, const char* name, Index given_up = 1, double touching = 2.0) {
    std::printf(
        "%s: %td increments, %td Newton iterations, force %.5f, hooked by %.4f radii, r kappa %.3f, asymmetry %.1e radii\n", name,
        core::count(hooked.report.increments), hooked.report.counts.newton, hooked.force, hooked.crossing, hooked.bend,
        hooked.asymmetry);
    CAPTURE(hooked.report.reason);
    CHECK(hooked.report.converged);
    CHECK(hooked.report.rejected_increments <= given_up);  // with places that are renewed: from there they are followed
    CHECK(hooked.crossing > 0.75 * touching);              // still in each other, sections flattened
    CHECK(hooked.closest > 0.75 * touching);
    CHECK(hooked.deepest <= 1.0);  // of any increment, by the true gap
}

TEST_CASE("hooks without friction hold and stay symmetric, and what pulls them does not depend on the increments") {
    const Hooked few = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 10});
    const Hooked many = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 20});
    check_held(few, "10 increments"), check_held(many, "20 increments");
    CHECK(std::abs(many.force - few.force) < 0.01 * many.force);
    // Nothing but rounding tells one side from the other.
    CHECK(few.asymmetry < 1e-6);
    CHECK(many.asymmetry < 1e-6);
    CHECK(few.report.counts.newton < 200);
}

TEST_CASE("hooks stay symmetric all the way in many small increments, wherever they begin to hang by their loops") {
    // What rounding leaves grew by up to nine an increment while places were renewed outside of Newton's method: to 3e-3 radii.
    for (const double ring : {20.0, 50.0}) {
        const Hooked hooked = test::pull_hooks<test::Smooth>(
            {.elements = 20, .increments = 100, .ring_over_radius = ring, .free_stretch = true, .directed = false});
        CAPTURE(ring);
        check_held(hooked, "100 increments", 0);
        CHECK(hooked.most_asymmetric < 1e-6);
        CHECK(hooked.report.counts.newton < 450);
    }
}

TEST_CASE("clamps whose directors nobody gave do to one side of a hook what they do to the other, at a slant as well") {
    const Hooked hooked = test::pull_hooks<test::Rough>(
        {.elements = 20, .increments = 10, .friction = 0.1, .angle_deg = 75.0, .free_stretch = true, .directed = false});
    check_held(hooked, "directors as they come");
    CHECK(hooked.most_asymmetric < 1e-6);
}

TEST_CASE("hooks with friction hold as well, and stay symmetric") {
    for (const double friction : {0.1, 0.5}) {
        const Hooked hooked = test::pull_hooks<test::Rough>({.elements = 20, .increments = 10, .friction = friction});
        CAPTURE(friction);
        check_held(hooked, "friction");
        CHECK(hooked.asymmetry < 1e-6);
    }
}

TEST_CASE("hooks at a slant touch along a valley, and hold as well") {
    for (const double angle : {75.0, 60.0, 45.0}) {
        const Hooked smooth = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 10, .angle_deg = angle});
        const Hooked rough =
            test::pull_hooks<test::Rough>({.elements = 20, .increments = 10, .friction = 0.1, .angle_deg = angle});
        CAPTURE(angle);
        // They swing out of their symmetric state.
        check_held(smooth, "slant", 5), check_held(rough, "slant, friction 0.1", angle > 45.0 ? 1 : 5);
        // Half a turn about the pull brings each ring onto itself. The nearer to each other their planes are, the less holds them
        // from swinging aside, and what the tolerances leave is seen.
        if (angle > 45.0) CHECK(rough.asymmetry < 1e-6);
        if (angle > 60.0) CHECK(smooth.asymmetry < 1e-6);
        // The loops turn until they are square to each other, but for what bending and friction hold: nearly the force of those
        // that are at the start.
        const double upright = 5.34;
        CHECK(smooth.force > upright);
        CHECK(smooth.force < 1.1 * upright);
    }
}

TEST_CASE("hooks of unequal fibres hold and stay symmetric, and what pulls them does not depend on the increments") {
    for (const double thickness : {0.25, 4.0}) {
        const bool thin = thickness < 1.0;  // a thin fibre has no friction here, a thick one much
        const auto pulled = [&](Index increments) {
            const Hooks hooks{
                .elements = thin ? 60 : 40, .increments = increments, .friction = thin ? 0.0 : 0.5, .lower_radius = thickness};
            return thin ? test::pull_hooks<test::Smooth>(hooks) : test::pull_hooks<test::Rough>(hooks);
        };
        const Hooked few = pulled(10), many = pulled(20);
        CAPTURE(thickness);
        check_held(few, "unequal", 2, 1.0 + thickness), check_held(many, "unequal, twice as many", 2, 1.0 + thickness);
        CHECK(std::abs(many.force - few.force) < 0.01 * many.force);
        CHECK(many.asymmetry < 1e-6);
    }
}

TEST_CASE("hooks at a slant that are pulled by most of their radius hold, whatever the increments") {
    const auto pulled = [](Index increments, double tolerance) {
        return test::pull_hooks<test::Rough>(
            {.elements = 20, .increments = increments, .friction = 0.1, .pull = 0.8, .angle_deg = 60.0, .tolerance = tolerance});
    };
    const Hooked few = pulled(10, 1.0), many = pulled(20, 1.0), closer = pulled(20, 0.01);
    check_held(few, "far", 2), check_held(many, "far, twice as many", 2), check_held(closer, "far, tolerances / 100", 2);
    CHECK(std::abs(many.force - few.force) < 1e-3 * many.force);
    CHECK(std::abs(many.force - closer.force) < 1e-3 * many.force);
    // Little holds them from swinging aside: of the tolerances so much is left.
    CHECK(many.asymmetry < 1e-3);
    CHECK(closer.asymmetry < 1e-5);
}

TEST_CASE("hooks that are drawn until their radius of curvature is the diameter hold, whatever the increments") {
    // The tips lie within an element: at a node between two the point force of a crossing shears a centreline into a corner.
    const auto pulled = [](Index increments, double friction) {
        const Hooks hooks{.elements = 41, .increments = increments, .friction = friction, .pull = 0.8};
        return friction > 0.0 ? test::pull_hooks<test::Rough>(hooks) : test::pull_hooks<test::Smooth>(hooks);
    };
    const Hooked few = pulled(10, 0.5), many = pulled(20, 0.5), smooth = pulled(20, 0.0);
    check_held(few, "diameter", 2), check_held(many, "diameter, twice as many", 2),
        check_held(smooth, "diameter, no friction", 2);
    for (const Hooked* hooked : {&few, &many, &smooth}) {
        CHECK(hooked->bend > 0.5);
        CHECK(hooked->asymmetry < (hooked == &few ? 1e-4 : 1e-6));  // what is left of the tolerances in steps so long
    }
    CHECK(std::abs(many.force - few.force) < 0.01 * many.force);
}

TEST_CASE("hooks that are drawn by nearly all of their radius hold, or stop with a reason, and are no deeper than they may") {
    // At the tips the radius of curvature comes down to the diameter. Friction that pushed where nothing slid had them 0.15 radii
    // deep in each other between contact points at a pull of 1, and stopped them at 0.9.
    for (const double pull : {0.9, 1.0}) {
        const Hooked hooked = test::pull_hooks<test::Rough>(
            {.elements = 40, .increments = 20, .friction = 0.5, .pull = pull, .free_stretch = true});
        std::printf("tight, %.1f: %td increments, deepest %.2f of what is stated; %s\n", pull,
                    core::count(hooked.report.increments), hooked.deepest, hooked.report.reason.c_str());
        CAPTURE(hooked.report.reason);
        CHECK(hooked.deepest <= 1.0);
        CHECK(hooked.report.increments.size() > 15);
        CHECK(hooked.report.converged == hooked.report.reason.empty());
        if (pull == 0.9) CHECK(hooked.report.converged);
    }
}

TEST_CASE("hooks that are pulled at a slant hold where the valley between them turns, in few iterations") {
    const Hooked hooked = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 20, .slant = 0.8, .angle_deg = 75.0});
    check_held(hooked, "pulled at a slant", 5);
    CHECK(hooked.report.counts.newton < 500);
}

TEST_CASE("a loop that turns back along what it lies over presses on it once, though it runs along it and against it there") {
    const double r = 0.05, bend = 3.0 * r, leg = 8.0 * r, quarter = 0.5 * std::numbers::pi * bend;
    scene::Assembly assembly;
    scene::FibreSpecification fibre;
    fibre.section = scene::circular(r), fibre.material = {1e4, 0.3}, fibre.elements = 20;
    fibre.from = Vec3(-10.0 * r, 0.0, 0.0), fibre.to = Vec3(20.0 * r, 0.0, 0.0), fibre.director = Vec3::UnitZ();
    const Index straight = assembly.add(fibre);
    fibre.curve = [=](double t) {
        const double s = (2.0 * t - 1.0) * (quarter + leg), beyond = std::max(0.0, std::abs(s) - quarter),
                     turn = std::clamp(s / bend, -0.5 * std::numbers::pi, 0.5 * std::numbers::pi);
        return Vec3(bend * (1.0 - std::cos(turn)) + beyond, bend * std::sin(turn), 2.0 * r);
    };
    const Index loop = assembly.add(fibre);
    for (const Index of : {straight, loop})
        for (const scene::Station& end : {scene::first_end(of), scene::last_end(of)})
            assembly.clamp(end, (of == loop ? -0.2 * r : 0.0) * Vec3::UnitZ());
    simulation::ModelParameters<test::Smooth> parameters;
    parameters.normal.regularisation_depth = 1e-3 * r;
    parameters.contact.stiffness.allowed_penetration = 1e-2 * r;
    parameters.contact.places = contact::Places::followed;
    simulation::Simulator<test::Smooth> simulator(assembly, parameters);
    const simulation::Report report = simulator.run({.increments = 2});
    INFO(report.reason);
    REQUIRE(report.converged);
    const auto& elements = simulator.contacts().elements();
    REQUIRE(!elements.empty());
    const auto& mesh = simulator.mesh();
    Index twice = 0;
    for (const auto& one : elements)
        for (const auto& other : elements) {
            const double apart = std::max(std::abs(one.u_i - other.u_i) * mesh.fibre(straight).element_length,
                                          std::abs(one.u_j - other.u_j) * mesh.fibre(loop).element_length);
            twice += &one < &other && apart < 0.1 * r ? 1 : 0;
        }
    CHECK(twice == 0);
    CHECK(report.contact.active >= 1);
}

TEST_CASE("with places that are renewed outside of Newton hooks do not hold") {
    const Hooked hooked = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 50, .places = contact::Places::renewed});
    CHECK_FALSE((hooked.report.converged && hooked.crossing > 1.5));
}

}  // namespace contact_loops_test

// SPDX-License-Identifier: MIT
// Loops that hang in each other and are drawn tight: the place of contact slides in the valley that each is to the other.
#include "../support/hooked_rings.hpp"

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace contact_loops_test {

using test::Hooked;
using test::Hooks;

void check_held(const Hooked& hooked, const char* name, Index given_up = 1) {
    std::printf(
        "%s: %td increments, %td Newton iterations, force %.5f, hooked by %.4f radii, r kappa %.3f, asymmetry %.1e radii\n", name,
        core::count(hooked.report.increments), hooked.report.counts.newton, hooked.force, hooked.crossing, hooked.bend,
        hooked.asymmetry);
    CAPTURE(hooked.report.reason);
    CHECK(hooked.report.converged);
    CHECK(hooked.report.rejected_increments <= given_up);  // with places that are renewed: from there they are followed
    CHECK(hooked.crossing > 1.5);                          // still in each other, sections flattened
    CHECK(hooked.closest > 1.5);
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

TEST_CASE("hooks with friction hold as well, and stay symmetric") {
    for (const double friction : {0.1, 0.5}) {
        const Hooked hooked = test::pull_hooks<test::Rough>({.elements = 20, .increments = 10, .friction = friction});
        CAPTURE(friction);
        check_held(hooked, "friction");
        CHECK(hooked.asymmetry < 1e-6);
    }
}

TEST_CASE("hooks at a slant touch along a valley, and hold as well") {
    for (const double angle : {60.0, 45.0}) {
        const Hooked smooth = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 10, .angle_deg = angle});
        const Hooked rough =
            test::pull_hooks<test::Rough>({.elements = 20, .increments = 10, .friction = 0.1, .angle_deg = angle});
        CAPTURE(angle);
        check_held(smooth, "slant", 5),
            check_held(rough, "slant, friction 0.1");  // without friction they swing out of their symmetric state
        // The loops turn until they are square to each other, but for what bending and friction hold: nearly the force of those
        // that are at the start.
        const double upright = 5.34;
        CHECK(smooth.force > upright);
        CHECK(smooth.force < 1.1 * upright);
    }
}

TEST_CASE("hooks that are pulled at a slant hold where the valley between them turns, in few iterations") {
    const Hooked hooked = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 20, .slant = 0.8, .angle_deg = 75.0});
    check_held(hooked, "pulled at a slant", 5);
    CHECK(hooked.report.counts.newton < 500);
}

TEST_CASE("with places that are renewed outside of Newton hooks do not hold") {
    const Hooked hooked = test::pull_hooks<test::Smooth>({.elements = 20, .increments = 50, .places = contact::Places::renewed});
    CHECK_FALSE((hooked.report.converged && hooked.crossing > 1.5));
}

}  // namespace contact_loops_test

// SPDX-License-Identifier: MIT
// Settling small fabrics to their rest: what two fibres may be deep in each other holds anywhere along them.
#include "small_weave.hpp"

#include <fibrant/compositions/weave/audit.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace settle_test {

namespace cloth = fibrant::compositions::weave;

using Model = test::SmallWeave;
using test::small_fabric;

TEST_CASE("a settled fabric's fibres cross as the pattern says and are nowhere deeper in each other than allowed") {
    const cloth::SettleParameters settle;
    simulation::Simulator<Model> simulator(cloth::flat_fabric(small_fabric(), settle.tension_strain), cloth::model_parameters<Model>(small_fabric(), settle));
    const simulation::Report report = simulator.run(cloth::settling<Model>(small_fabric(), settle));
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double r = cloth::smallest_radius(small_fabric());
    const cloth::Audit audit = cloth::audit(simulator.snapshot(), small_fabric(), proximity::GridSearch());
    std::printf("%td increments, %td Newton iterations, deepest contact %.5f, least gap %.5f radii, %.1f s\n", core::count(report.increments),
                report.counts.newton, report.contact.greatest_penetration / r, audit.least_gap.gap_over_radius, report.wall_seconds);
    CHECK(audit.crossings == 100);  // 10 warp fibres over or under 10 weft fibres
    CHECK(audit.clean(settle.allowed_penetration_over_radius * r));
    CHECK(audit.least_gap.gap < 0.0);  // fibres touch: the bound is one that could be broken
}

TEST_CASE("a fabric is at rest once forces balance and no two fibres are deeper in each other than allowed, whatever contact points say") {
    const cloth::SettleParameters settle;
    const double allowed = settle.allowed_penetration_over_radius * cloth::smallest_radius(small_fabric());
    const simulation::Loading<Model> loading = cloth::settling<Model>(small_fabric(), settle);
    const simulation::Stage<Model>& rest = loading.stages.back();
    REQUIRE(rest.deepest.has_value());
    CHECK(*rest.deepest == allowed);
    simulation::IncrementReport increment;  // moves nothing
    increment.contact.greatest_penetration = 1.5 * allowed;
    CHECK(rest.until(increment));
    increment.displacement = 2.0 * settle.rest_motion_over_radius * cloth::smallest_radius(small_fabric()), increment.damping = 2.0 * settle.rest_share;
    CHECK_FALSE(rest.until(increment));
}

TEST_CASE("tows part at no more tension than fibres of that many elements can turn under") {
    cloth::FabricParameters fabric = small_fabric();
    CHECK(cloth::parting_tension(fabric, 2e-3) == 1.0);
    // E I / T = f r^2 / (4 strain) of round fibres; a third of an element is 0.3 L / n.
    fabric.warp.inertia_factor = 1e-4;
    const double turn = 0.3 * fabric.fibre_length(cloth::Family::warp) / 12.0;
    CHECK(std::abs(cloth::parting_tension(fabric, 2e-3) / (1e-4 * 0.04 * 0.04 / (4.0 * 2e-3 * turn * turn)) - 1.0) < 1e-12);
    CHECK(std::abs(cloth::parting_tension(fabric, 4e-3) / cloth::parting_tension(fabric, 2e-3) - 0.5) < 1e-12);
}

TEST_CASE("contact on the way is as soft as allowed, but no softer than what parts tows") {
    cloth::SettleParameters settle;
    const double r = cloth::smallest_radius(small_fabric());
    const auto soft = [&] { return *cloth::settling<Model>(small_fabric(), settle).stages[1].allowed_penetration / r; };
    CHECK(std::abs(soft() / 0.05 - 1.0) < 1e-12);  // five times 0.01, which is a fifth of the gap limit
    settle.allowed_penetration_over_radius = 0.002;
    CHECK(std::abs(soft() / 0.01 - 1.0) < 1e-12);
    settle.allowed_penetration_over_radius = 0.04;
    CHECK(std::abs(soft() / 0.05 - 1.0) < 1e-12);
    settle.allowed_penetration_over_radius = 0.2;
    CHECK(std::abs(soft() / 0.2 - 1.0) < 1e-12);
}

}  // namespace settle_test

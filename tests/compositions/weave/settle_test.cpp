// SPDX-License-Identifier: MIT
// Settling small fabrics to their rest: what two fibres may be deep in each other holds anywhere along them.
#include "small_weave.hpp"

#include <fibrant/compositions/weave/audit.hpp>

#include <doctest/doctest.h>

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

TEST_CASE("a fabric is not at rest while contact points are as deep as allowed, for between them fibres are deeper") {
    const cloth::SettleParameters settle;
    const double allowed = settle.allowed_penetration_over_radius * cloth::smallest_radius(small_fabric());
    const simulation::Loading<Model> loading = cloth::settling<Model>(small_fabric(), settle);
    simulation::IncrementReport increment;  // moves nothing
    increment.contact.greatest_penetration = 0.9 * allowed;  // 0.002 of a radius more, seen in weaves, is more than allowed
    CHECK_FALSE(loading.stages.back().until(increment));
    increment.contact.greatest_penetration = 0.7 * allowed;
    CHECK(loading.stages.back().until(increment));
}

}  // namespace settle_test

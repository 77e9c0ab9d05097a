// SPDX-License-Identifier: MIT
// Laws of sections in whole runs: what a fibre does with them, what it remembers, and that its energy is all there.
#include "simulation/lawful.hpp"
#include <near.hpp>
#include <refusal.hpp>

#include <fibrant/beam/with_law.hpp>
#include <fibrant/material/brittle.hpp>
#include <fibrant/material/eigenstrain.hpp>

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace section_laws_test {

using test::Lawful;
using test::lawful_parameters;
using test::missing;
using test::refusal;
using test::Rod;
const double pi = std::numbers::pi;

using Breaking = Lawful<material::Eigenstrain<material::Brittle>>;
const material::Brittle::Parameters endless{.strength = 1e30, .modulus = 5.0, .reference_length = 1.0};

TEST_CASE("curvature, twist, length and width that are set in bend a free fibre without energy, and heat presses a held one") {
    using M = Breaking;
    double error[2];
    for (int fine = 0; fine < 2; ++fine) {
        Rod rod;
        rod.elements = fine == 0 ? 8 : 16;
        scene::FibreSpecification fibre = rod.specification();
        fibre.law_channel = "heat";
        scene::Assembly assembly;
        assembly.clamp(scene::first_end(assembly.add(fibre)));
        const double kappa = 2.0 / rod.length;
        simulation::Simulator<M> simulator(
            assembly,
            lawful_parameters<M>(rod.radius, {{.base = endless, .along = 0.01, .across = -0.004, .curvature_1 = kappa}}));
        const simulation::Report report = simulator.run({.increments = 4});
        REQUIRE_MESSAGE(report.converged, report.reason);
        // The clamp holds no stretch of the section, but a circle of the elongated fibre: its curvature is a rotation a unit of
        // rest length.
        const double R = 1.01 / kappa;
        const Vec3 tip(R * (1.0 - std::cos(2.0)), 0.0, R * std::sin(2.0));
        error[fine] = (simulator.value(scene::last_end(0)) - tip).norm() / rod.length;
        CHECK(report.energy.elastic < 1e-20 * rod.young * pi * rod.radius * rod.radius * rod.length);
    }
    std::printf("set-in curvature: tip off by %.1e, %.1e L with 8 and 16 elements\n", error[0], error[1]);
    CHECK(error[0] < 8e-6);             // a turn of 2 in 8 elements
    CHECK(error[0] / error[1] > 12.0);  // fourth order

    Rod rod;
    rod.elements = 4;
    scene::FibreSpecification fibre = rod.specification();
    fibre.law_channel = "heat";
    scene::Assembly assembly;
    assembly.add(fibre);
    assembly.clamp(scene::first_end(0)), assembly.clamp(scene::last_end(0));
    const double rise = 0.5 * std::pow(pi * rod.radius / rod.length, 2);  // half of what buckles it
    simulation::Simulator<M> simulator(assembly,
                                       lawful_parameters<M>(rod.radius, {{.base = endless, .along = rise, .across = rise}}));
    const simulation::Report report = simulator.run({.increments = 3});
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double EA = rod.young * pi * rod.radius * rod.radius;
    CHECK(simulator.reaction(scene::last_end(0)).z() / (-EA * (rise + 0.5 * rise * rise)) == test::near(1.0, 1e-6));
    CHECK(missing(report) < 1e-9);
    CHECK(report.energy.elastic / (0.5 * EA * rise * rise * rod.length) == test::near(1.0, 1e-3));
    // A channel for a beam without a law is refused by name.
    CHECK(refusal([&] {
              simulation::Simulator<test::Smooth>(assembly, test::tight_parameters<test::Smooth>(rod.radius));
          }).find("law_channel = heat") != std::string::npos);
}

TEST_CASE("fibres break one by one at the weakest of their points, and what they stored is released") {
    using M = Breaking;
    const Index count = 6;
    scene::Assembly assembly;
    Rod rod;
    rod.elements = 3;
    for (Index k = 0; k < count; ++k) {
        scene::FibreSpecification fibre = rod.specification();
        fibre.from.x() = fibre.to.x() = 10.0 * rod.radius * static_cast<double>(k);
        assembly.clamp(scene::first_end(assembly.add(fibre)));
        assembly.clamp(scene::last_end(k), Vec3(0, 0, 0.02 * rod.length), Vec3::Zero(), Vec3::Zero(), "pull");
    }
    const double EA = rod.young * pi * rod.radius * rod.radius;
    const auto parameters = lawful_parameters<M>(
        rod.radius, {{.base = {.strength = 0.01 * rod.young, .modulus = 5.0, .reference_length = rod.length, .seed = 3}}});
    simulation::Simulator<M> simulator(assembly, parameters);
    // The strengths that the fibres drew, by the same lots.
    std::vector<double> breaks;
    for (Index f = 0; f < count; ++f) {
        double least = 1e300;
        for (Index e = 0; e < rod.elements; ++e)
            for (const auto& memory : simulator.mesh().rest(f, e).memory.accepted) least = std::min(least, memory.base.strength);
        breaks.push_back(least / rod.young);
    }
    std::sort(breaks.begin(), breaks.end());
    simulation::Loading<M> loading;
    loading.stages.push_back({.name = "pull", .increments = 40, .ramps = {{"pull", 1.0}}, .most_increments = 400});
    struct Seen {
        std::vector<double> released, progress;
        void reported(const simulation::IncrementReport& increment) {
            released.push_back(increment.energy.released), progress.push_back(increment.stage_progress);
        }
    } seen;
    const simulation::Report report = simulator.run(loading, seen);
    REQUIRE_MESSAGE(report.converged, report.reason);
    std::size_t seen_breaks = 0;
    for (std::size_t k = 1; k < seen.released.size(); ++k) {
        // What lets go in an increment that moves nothing is of the break before it.
        if (!(seen.released[k] > seen.released[k - 1] * (1.0 + 1e-9)) || seen.progress[k] == seen.progress[k - 1]) continue;
        const double e = 0.02 * seen.progress[k], green = e + 0.5 * e * e;
        CHECK(green >= breaks[seen_breaks]);
        CHECK(green <= 1.021 * breaks[seen_breaks]);  // the overshoot of an increment
        ++seen_breaks;
    }
    Index breaking = 0;
    for (Index f = 0; f < count; ++f) {
        double broken = 0.0, least = 1e300;
        for (Index e = 0; e < rod.elements; ++e)
            for (const auto& memory : simulator.mesh().rest(f, e).memory.accepted)
                broken += memory.base.broken, least = std::min(least, memory.base.strength);
        CHECK(broken == (least <= 0.0202 * rod.young ? 1.0 : 0.0));
        breaking += broken > 0.0;
    }
    CHECK(core::at(breaking) == seen_breaks);
    CHECK(breaking >= 3);
    double force = 0.0;
    for (Index f = 0; f < count; ++f) force += simulator.reaction(scene::last_end(f)).z();
    const double whole = EA * 0.0202 * 1.02;                                                // (s^2 - 1)/2 s
    CHECK(std::abs(force - static_cast<double>(count - breaking) * whole) < 1e-3 * whole);  // of one fibre
    CHECK(missing(report) < 1e-3);
}

}  // namespace section_laws_test

// SPDX-License-Identifier: MIT
// Force and moment of supports against statics: what holds a fibre balances what loads it, whatever its sections are told by.
#include "simulation/scenes.hpp"

#include <fibrant/simulation/support_wrench.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cstdio>

using namespace fibrant;

namespace support_wrench_test {

template <class M>
double unbalanced(const char* name, const scene::Assembly& assembly, std::span<const scene::Station> sections, const Vec3& place,
                  Index increments) {
    simulation::Simulator<M> simulator(assembly, test::tight_parameters<M>(0.0201));
    const simulation::Report report = simulator.run({.increments = increments});
    REQUIRE_MESSAGE(report.converged, report.reason);
    simulation::Wrench sum = simulation::support_wrench(simulator, sections, place);
    double size = 0.0;
    for (const scene::Station& at : sections) {
        const simulation::Wrench one = simulation::support_wrench(simulator, std::span(&at, 1), simulator.value(at));
        size = std::max(size, one.moment.norm());
        CHECK(one.moment.norm() > 0.0);
    }
    for (const scene::DeadForce& load : assembly.forces())
        sum.force += load.force, sum.moment += (simulator.value(load.at) - place).cross(load.force);
    std::printf("%s: moment of a support %.3e, left over %.1e of it\n", name, size, sum.moment.norm() / size);
    return sum.moment.norm() / size;
}

TEST_CASE_TEMPLATE("a cantilever's support bears its load, about any place", M, test::Smooth, test::EveryRod, test::EveryCable) {
    // About the tip the load has no lever, so all is the support's own moment.
    const test::Rod rod;
    const scene::Assembly assembly = rod.pushed(3.0);
    const std::array ends{scene::first_end(0)};
    CHECK(unbalanced<M>("cantilever", assembly, ends, Vec3::Zero(), 1) < 1e-7);
    CHECK(unbalanced<M>("cantilever, about elsewhere", assembly, ends, Vec3(0.3, -1.0, 2.0), 1) < 1e-7);
}

TEST_CASE_TEMPLATE("two supports of a fibre that is twisted by one and a quarter turns and moved aside balance each other", M,
                   test::Smooth, test::EveryRod) {
    test::Rod rod;
    rod.elements = 24;
    scene::Assembly assembly = rod.clamped();
    assembly.clamp(scene::last_end(0), Vec3(0.1, 0.05, -0.02), Vec3(0, 0, 2.5 * std::numbers::pi), Vec3(0, 0, rod.length));
    const std::array ends{scene::first_end(0), scene::last_end(0)};
    CHECK(unbalanced<M>("twisted", assembly, ends, Vec3(0.1, 0.2, 0.3), 10) < 1e-6);
}

}  // namespace support_wrench_test

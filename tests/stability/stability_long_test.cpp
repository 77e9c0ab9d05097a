// SPDX-License-Identifier: MIT
// Sweeps over decades of slenderness, stiffness and penetration, friction whose history must not depend on how it is followed,
// and a thousand random scenes. Prints a line a case, as CSV. The decades of a penalty that stays as it is are in
// stability_test.cpp.
#include <stability/cycles.hpp>
#include <stability/random_scenes.hpp>
#include <stability/sweeps.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace stability_long_test {

using namespace fibrant::test;

const double r = 0.0201;

long iterations(const SmallResult& result) { return static_cast<long>(result.report.counts.newton); }
long rejected(const SmallResult& result) { return static_cast<long>(result.report.rejected_increments); }

TEST_CASE("crossed fibres of any slenderness from 10 to 1e5 obey beam theory") {
    std::printf("slenderness,force over beam theory,active,newton,rejected\n");
    for (const double slenderness : slendernesses) {
        CAPTURE(slenderness);
        const SmallScene scene = pressed(slenderness);
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        const double ratio = force_over_theory(scene, result);
        std::printf("%g,%.6f,%ld,%ld,%ld\n", slenderness, ratio, static_cast<long>(result.report.contact.active),
                    iterations(result), rejected(result));
        // At L/r = 10 elements are half a radius long and the section gives way under the load.
        CHECK(ratio == test::near(1.0, slenderness < 50.0 ? 0.1 : 5e-3));
    }
}

TEST_CASE("a fibre on another one up to a million times as stiff gives way alone") {
    std::printf("stiffness ratio,force over beam theory,newton,rejected\n");
    for (const double ratio : stiffness_ratios) {
        CAPTURE(ratio);
        const SmallScene scene = pressed(200.0, ratio);
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        std::printf("%g,%.6f,%ld,%ld\n", ratio, force_over_theory(scene, result), iterations(result), rejected(result));
        CHECK(force_over_theory(scene, result) == test::near(1.0, 5e-3));
        CHECK(result.support[1].z() == test::near(-result.support[0].z(), 1e-6));
    }
}

TEST_CASE("allowed penetrations from 1e-5 to 5e-2 of a radius cost no more than they allow") {
    std::printf("allowed,force,error in force,penetration over allowed,newton,rejected\n");
    double hard = 0.0;
    for (const double allowed : allowed_penetrations) {
        CAPTURE(allowed);
        const SmallResult result = run(sinking(allowed));
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        const double force = result.support[0].z();
        if (hard == 0.0) hard = force;
        std::printf("%g,%.6e,%.2e,%.3f,%ld,%ld\n", allowed, force, 1.0 - force / hard,
                    result.report.contact.greatest_penetration / (allowed * r), iterations(result), rejected(result));
        CHECK(result.report.contact.greatest_penetration < 1.5 * allowed * r);
        CHECK(std::abs(1.0 - force / hard) <
              2.0 * allowed + 1e-4);  // of an approach of a radius, in a force that grows a little faster
    }
}

TEST_CASE("what friction has done does not depend on how finely it was followed") {
    // Dragged across by a radius: the force on the dragged fibre and what was dissipated, over mesh, contact spacing and
    // increments.
    SmallScene scene = dragged_three();
    std::printf("elements,spacing,increments,force,dissipated\n");
    std::vector<double> forces, losses;
    for (const auto& [elements, spacing, increments] : {std::tuple(8, 2.0, 8), std::tuple(16, 2.0, 8), std::tuple(16, 4.0, 8),
                                                        std::tuple(16, 2.0, 24), std::tuple(24, 2.0, 16)}) {
        for (SmallFibre& f : scene.fibres) f.elements = elements;
        scene.spacing = spacing, scene.increments = increments;
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        forces.push_back(result.support[1].norm()), losses.push_back(result.report.energy.dissipated);
        std::printf("%d,%g,%d,%.6e,%.6e\n", elements, spacing, increments, forces.back(), losses.back());
    }
    // The coarsest mesh, with elements of three diameters, is its own error away from the others.
    for (std::size_t k = 1; k < forces.size(); ++k) {
        CHECK(forces[k] == test::near(forces.back(), 0.03));
        CHECK(losses[k] == test::near(losses.back(), 0.1));
    }
}

TEST_CASE("a thousand random small scenes neither crash nor leave a fibre in another one without saying so") {
    check_random_scenes(1, 1000);
}

TEST_CASE("a fibre that goes there and back with friction, deep in the other one, loses no work either") {
    check_resolved_cycle(1e-2, 2e-6);
}

}  // namespace stability_long_test

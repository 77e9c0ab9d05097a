// SPDX-License-Identifier: MIT
// Sweeps over decades of slenderness, stiffness, penalty and penetration, friction whose history must not depend on how it is
// followed, and a thousand random scenes. Prints a line a case, as CSV.
#include <stability/random_scenes.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace stability_long_test {

using namespace fibrant::test;

const double r = 0.0201;

/// Two fibres of a length that cross in the middle, clamped at their ends; the upper one comes down by `approach`.
SmallScene crossed(double length, double approach) {
    SmallScene scene;
    SmallFibre lower{Vec3(0, -0.5 * length, 0), Vec3(0, 0.5 * length, 0)}, upper{Vec3(-0.5 * length, 0, 2.0 * r), Vec3(0.5 * length, 0, 2.0 * r)};
    upper.move_from = upper.move_to = Vec3(0, 0, -approach);
    scene.fibres = {lower, upper};
    return scene;
}
/// Deflections of the two middles under a force, by beam theory with shear: F L^3 / (192 E I) (1 + 24 (1 + nu) (r/L)^2) each.
double stiffness_of(const SmallFibre& f) {
    const double length = (f.to - f.from).norm(), inertia = 0.25 * std::numbers::pi * std::pow(f.radius, 4);
    return 192.0 * f.young * inertia / std::pow(length, 3) / (1.0 + 24.0 * 1.3 * std::pow(f.radius / length, 2));
}

TEST_CASE("crossed fibres of any slenderness from 10 to 1e5 obey beam theory") {
    std::printf("slenderness,force over beam theory,active,newton,rejected\n");
    for (const double slenderness : {10.0, 30.0, 100.0, 1e3, 1e4, 1e5}) {
        CAPTURE(slenderness);
        SmallScene scene = crossed(slenderness * r, 0.02 * r);
        for (SmallFibre& f : scene.fibres) f.elements = 16;
        scene.allowed = 1e-4;
        scene.tight = true;
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        const double u = 0.02 * r - result.report.contact.greatest_penetration, expected = u / (1.0 / stiffness_of(scene.fibres[0]) + 1.0 / stiffness_of(scene.fibres[1]));
        std::printf("%g,%.6f,%ld,%ld,%ld\n", slenderness, result.support[0].z() / expected, static_cast<long>(result.report.contact.active), static_cast<long>(result.report.counts.newton),
                    static_cast<long>(result.report.rejected_increments));
        // At L/r = 10 elements are half a radius long and the section gives way under the load; the tension of the deflection is (u/r)^2 / 8.
        CHECK(result.support[0].z() / expected == doctest::Approx(1.0).epsilon(slenderness < 50.0 ? 0.1 : 5e-3));
    }
}

TEST_CASE("a fibre on another one up to a million times as stiff gives way alone") {
    std::printf("stiffness ratio,force over beam theory,newton,rejected\n");
    for (const double ratio : {1.0, 1e2, 1e4, 1e6}) {
        CAPTURE(ratio);
        SmallScene scene = crossed(200.0 * r, 0.02 * r);
        scene.fibres[0].young *= ratio;
        scene.allowed = 1e-4;
        scene.tight = true;
        for (SmallFibre& f : scene.fibres) f.elements = 16;
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        const double u = 0.02 * r - result.report.contact.greatest_penetration, expected = u / (1.0 / stiffness_of(scene.fibres[0]) + 1.0 / stiffness_of(scene.fibres[1]));
        std::printf("%g,%.6f,%ld,%ld\n", ratio, result.support[1].z() / expected, static_cast<long>(result.report.counts.newton), static_cast<long>(result.report.rejected_increments));
        CHECK(result.support[1].z() / expected == doctest::Approx(-1.0).epsilon(5e-3));
    }
}

TEST_CASE("allowed penetrations from 1e-5 to 5e-2 of a radius cost no more than they allow") {
    std::printf("allowed,force,error in force,penetration over allowed,newton,rejected\n");
    SmallScene scene = crossed(100.0 * r, r);
    for (SmallFibre& f : scene.fibres) f.elements = 16;
    double hard = 0.0;
    for (const double allowed : {1e-5, 1e-4, 1e-3, 1e-2, 5e-2}) {
        CAPTURE(allowed);
        scene.allowed = allowed;
        scene.cycle.assign(4, 1.0);  // the stiffness adapts after each increment: three at rest
        scene.increments = 6;
        const SmallResult result = run(scene);
        CAPTURE(result.report.reason);
        REQUIRE(result.report.converged);
        const double force = result.support[0].z();
        if (hard == 0.0) hard = force;
        std::printf("%g,%.6e,%.2e,%.3f,%ld,%ld\n", allowed, force, 1.0 - force / hard, result.report.contact.greatest_penetration / (allowed * r), static_cast<long>(result.report.counts.newton),
                    static_cast<long>(result.report.rejected_increments));
        CHECK(result.report.contact.greatest_penetration < 1.5 * allowed * r);
        CHECK(std::abs(1.0 - force / hard) < 2.0 * allowed + 1e-4);  // of an approach of a radius, in a force that grows a little faster
    }
}

TEST_CASE("what friction has done does not depend on how finely it was followed") {
    // Dragged across by a radius: the force on the dragged fibre and what was dissipated, over mesh, contact spacing and increments.
    SmallScene scene = dragged_three();
    std::printf("elements,spacing,increments,force,dissipated\n");
    std::vector<double> forces, losses;
    for (const auto& [elements, spacing, increments] : {std::tuple(8, 2.0, 8), std::tuple(16, 2.0, 8), std::tuple(16, 4.0, 8), std::tuple(16, 2.0, 24), std::tuple(24, 2.0, 16)}) {
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
        CHECK(forces[k] == doctest::Approx(forces.back()).epsilon(0.03));
        CHECK(losses[k] == doctest::Approx(losses.back()).epsilon(0.1));
    }
}

TEST_CASE("a thousand random small scenes neither crash nor leave a fibre in another one without saying so") { check_random_scenes(1, 1000); }

}  // namespace stability_long_test

// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"

#include <fibrant/contact/particle.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace fibrant;

namespace particle_test {

using contact::Particle;
using contact::support_particle;

/// Distance from the centre of the furthest of many particles of the contour along a direction.
double furthest(const scene::CrossSection& section, const Vec3& g_1, const Vec3& g_2, const Vec3& direction, int particles) {
    double most = 0.0;
    for (int k = 0; k < particles; ++k) {
        const double angle = 2.0 * std::numbers::pi * k / particles;
        const Vec3 place = section.semi_axis_1 * std::cos(angle) * g_1 + section.semi_axis_2 * std::sin(angle) * g_2;
        most = std::max(most, place.dot(direction));
    }
    return most;
}

double reach(const scene::CrossSection& section, const Vec3& g_1, const Vec3& g_2, const Vec3& direction) {
    const Particle particle = support_particle(section, g_1, g_2, direction, false);
    return (particle.xi_1 * g_1 + particle.xi_2 * g_2).dot(direction);
}

TEST_CASE("a round section touches where the normal leaves it") {
    const scene::CrossSection section = scene::circular(0.02);
    const Particle particle = support_particle(section, Vec3::UnitX(), Vec3::UnitY(), Vec3(0.6, -0.8, 0.0), false);
    CHECK(particle.xi_1 == test::near(0.012, 1e-14));
    CHECK(particle.xi_2 == test::near(-0.016, 1e-14));
    CHECK(particle.cap == 0.0);
}

TEST_CASE("the particle lies on the contour, and none lies further along the normal") {
    std::mt19937 generator(2);
    const scene::CrossSection section = scene::elliptical(0.03, 0.01);
    for (int n = 0; n < 200; ++n) {
        // stretched, sheared and turned
        const Vec3 g_1 = Vec3::UnitX() + 0.3 * test::normal_vector(generator),
                   g_2 = Vec3::UnitY() + 0.3 * test::normal_vector(generator);
        const Vec3 direction = test::normal_vector(generator).normalized();
        const Particle particle = support_particle(section, g_1, g_2, direction, false);
        if (particle.cap > 0.0) continue;
        CHECK(std::hypot(particle.xi_1 / 0.03, particle.xi_2 / 0.01) == test::near(1.0, 1e-14));
        const double most = furthest(section, g_1, g_2, direction, 2000), found = reach(section, g_1, g_2, direction);
        CHECK(found >= most * (1.0 - 1e-14));
        CHECK(found - most <= 5e-6 * found);  // 1 - cos(pi / 2000) = 1.2e-6 is what sampling misses
    }
}

TEST_CASE("where the particle sits on the contour does not change the gap to first order") {
    // d reach / d g_a = xi_a direction: the derivative at a frozen particle is the whole derivative.
    std::mt19937 generator(3);
    const scene::CrossSection section = scene::elliptical(0.03, 0.02);
    const double step = 1e-5;
    for (int n = 0; n < 50; ++n) {
        const Vec3 g_1 = Vec3::UnitX() + 0.2 * test::normal_vector(generator),
                   g_2 = Vec3::UnitY() + 0.2 * test::normal_vector(generator);
        const Vec3 direction = (g_1 + 0.7 * g_2 + 0.3 * test::normal_vector(generator)).normalized(),
                   aside = test::normal_vector(generator);
        const Particle particle = support_particle(section, g_1, g_2, direction, false);
        const double by_1 =
            (reach(section, g_1 + step * aside, g_2, direction) - reach(section, g_1 - step * aside, g_2, direction)) /
            (2 * step);
        const double by_2 =
            (reach(section, g_1, g_2 + step * aside, direction) - reach(section, g_1, g_2 - step * aside, direction)) /
            (2 * step);
        // central differences: step^2 over the squared distance of g . direction from zero, in units of the section
        CHECK(std::abs(by_1 - particle.xi_1 * direction.dot(aside)) < 1e-8 * 0.03);
        CHECK(std::abs(by_2 - particle.xi_2 * direction.dot(aside)) < 1e-8 * 0.03);
    }
}

TEST_CASE("a fibre's end is rounded: a cap about the centre") {
    const scene::CrossSection section = scene::elliptical(0.03, 0.01);
    const Particle end = support_particle(section, Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitX(), true);
    CHECK(end.xi_1 == 0.0);
    CHECK(end.xi_2 == 0.0);
    CHECK(end.cap == 0.03);
    // so is a section that is looked at along the fibre
    CHECK(support_particle(section, Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), false).cap == 0.03);
}

}  // namespace particle_test

// SPDX-License-Identifier: MIT
// Fibres on bodies with edges and of triangles: as on what they stand for, and at edges as theory says.
#include <contact/contact_model.hpp>
#include <near.hpp>

#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/scene/triangle_surface.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>

using namespace fibrant;

namespace tool_surfaces_test {

using Pressing = test::EveryDirector;
using test::straight_fibre;

const double r = 0.02, pi = std::numbers::pi;

/// A prism about the y axis.
std::shared_ptr<const scene::TriangleSurface> prism(double radius, double half, std::uint32_t sides) {
    std::vector<Vec3> corners;
    std::vector<scene::TriangleSurface::Triangle> triangles;
    for (std::uint32_t k = 0; k < sides; ++k)
        for (const double y : {-half, half})
            corners.emplace_back(radius * std::sin(2.0 * pi * (k + 0.5) / sides), y,
                                 radius * std::cos(2.0 * pi * (k + 0.5) / sides));
    for (std::uint32_t k = 0; k < sides; ++k) {
        const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % sides);
        triangles.push_back({a, b, b + 1}), triangles.push_back({a, b + 1, a + 1});
        if (k > 0 && k + 1 < sides) triangles.push_back({0, b, a}), triangles.push_back({1, a + 1, b + 1});
    }
    return std::make_shared<const scene::TriangleSurface>(corners, triangles);
}
scene::Tool body(std::shared_ptr<const scene::ToolSurface> surface) {
    scene::Tool tool;
    tool.shape = scene::ToolShape::surface, tool.surface = std::move(surface);
    return tool;
}

/// Force that a pin feels over which a fibre is bent by its clamped ends, with friction.
Vec3 bent_over(const scene::Tool& pin) {
    scene::Assembly assembly;
    const Index one = assembly.add(straight_fibre({-0.8, 0, 0.2 + r}, {0.8, 0, 0.2 + r}, r, 24));
    assembly.clamp(scene::first_end(one), {0, 0, -0.1});
    assembly.clamp(scene::last_end(one), {0, 0, -0.1});
    assembly.add(pin);
    auto parameters = test::pressed_parameters<Pressing>(2e-3 * r);
    parameters.friction = {.friction_coefficient = 0.2, .reversible_displacement = 0.02 * r};
    simulation::Simulator<Pressing> simulator(assembly, parameters);
    const simulation::Report report = simulator.run({.increments = 10});
    CAPTURE(report.reason);
    CHECK(report.converged);
    return simulator.contacts().tools().reaction(0).force;
}

TEST_CASE("a fibre over a pin of any kind bears the same, and over a prism nearly so") {
    scene::Tool cylinder;
    cylinder.shape = scene::ToolShape::cylinder, cylinder.radius = 0.2, cylinder.axis = Vec3::UnitY();
    const double expected = bent_over(cylinder).z();
    scene::Tool ring = body(std::make_shared<scene::Ring>(scene::Ring::Parameters{.radius = 0.2, .half_height = 0.5}));
    Mat3 upright;
    upright << 1, 0, 0, 0, 0, -1, 0, 1, 0;  // its axis lies along y
    ring.rotation = [upright](double) { return upright; };
    CHECK(bent_over(ring).z() == test::near(expected, 1e-9));
    double before = 0.0;
    for (const std::uint32_t sides : {90u, 180u}) {
        const double off = bent_over(body(prism(0.2, 0.5, sides))).z() / expected - 1.0;
        std::printf("%u sides: %.2e off\n", sides, off);
        CHECK(std::abs(off) < 2e-2);
        if (before > 0.0) CHECK(std::abs(off) < before);
        before = std::abs(off);
    }
}

TEST_CASE("a plate that ends lifts a cantilever by its edge") {
    const double length = 2.0, at = 1.25, lift = 0.02;
    scene::Assembly assembly;
    const scene::FibreSpecification fibre = straight_fibre({0, 0, 0}, {length, 0, 0}, r, 24);
    const Index one = assembly.add(fibre);
    assembly.clamp(scene::first_end(one));
    // A station of the fibre, which has two an element, is where the edge is.
    scene::Tool plate = body(std::make_shared<scene::Block>(scene::Block::Parameters{.half = {1.0, 1.0, 0.1}, .edge = 0.01}));
    plate.origin = {at + 1.0 - 0.01, 0, -0.1 - r};  // the edge's middle is at x = at
    plate.displacement = {0, 0, lift};
    assembly.add(plate);
    auto parameters = test::pressed_parameters<Pressing>(1e-3 * r);
    parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};
    simulation::Simulator<Pressing> simulator(assembly, parameters);
    const simulation::Report report = simulator.run({.increments = 4});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    // Small deflections: P = 3 E I w / a^3. The contact is beside the edge's middle by (edge + r) times the slope there.
    const double stiffness = fibre.material.young_modulus * 0.25 * pi * r * r * r * r, slope = 1.5 * lift / at;
    const double touch = at - (0.01 + r) * slope, expected = 3.0 * stiffness * lift / (touch * touch * touch);
    const double felt = -simulator.contacts().tools().reaction(0).force.z();
    std::printf("edge of a plate: %.5f of theory\n", felt / expected);
    CHECK(felt == test::near(expected, 5e-3));  // slope squared, 6e-4; r over the length; steps of the contact places
}

}  // namespace tool_surfaces_test

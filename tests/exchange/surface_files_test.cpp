// SPDX-License-Identifier: MIT
// Bodies of triangles, with edges and of one's own: distances against closed forms, and files that are no closed surface.
#include "../refusal.hpp"
#include "../support/random_vector.hpp"
#include <near.hpp>

#include <fibrant/exchange/surface_files.hpp>
#include <fibrant/exchange/tubes.hpp>
#include <fibrant/scene/tool.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <sstream>
#include <string>
#include <vector>

namespace exchange_surface_files_test {

using namespace fibrant;
using fibrant::test::refusal;
constexpr double pi = std::numbers::pi;

exchange::Surface box(const Vec3& half) {
    exchange::Surface surface;
    for (int k = 0; k < 8; ++k)
        surface.points.emplace_back((k & 1) ? half[0] : -half[0], (k & 2) ? half[1] : -half[1], (k & 4) ? half[2] : -half[2]);
    surface.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                         {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return surface;
}
/// @param rings  of quadrilaterals from pole to pole, of twice as many each
exchange::Surface ball(double radius, std::uint32_t rings) {
    exchange::Surface surface;
    const std::uint32_t round = 2 * rings;
    surface.points.emplace_back(0, 0, radius);
    for (std::uint32_t i = 1; i < rings; ++i)
        for (std::uint32_t k = 0; k < round; ++k) {
            const double a = pi * i / rings, b = 2.0 * pi * k / round;
            surface.points.push_back(radius * Vec3(std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), std::cos(a)));
        }
    surface.points.emplace_back(0, 0, -radius);
    const auto last = static_cast<std::uint32_t>(surface.points.size() - 1);
    const auto at = [&](std::uint32_t i, std::uint32_t k) { return 1 + (i - 1) * round + k % round; };
    for (std::uint32_t k = 0; k < round; ++k) {
        surface.triangles.push_back({0, at(1, k), at(1, k + 1)});
        surface.triangles.push_back({last, at(rings - 1, k + 1), at(rings - 1, k)});
        for (std::uint32_t i = 1; i + 1 < rings; ++i) {
            surface.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
            surface.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
        }
    }
    return surface;
}
scene::TriangleSurface body(const exchange::Surface& surface) { return {surface.points, surface.triangles}; }

/// Points in and about a box of half a length.
std::vector<Vec3> places(double half, int count) {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> value(-1.0, 1.0);
    std::vector<Vec3> all;
    for (int k = 0; k < count; ++k) all.push_back(half * test::random_vector(value, generator));
    return all;
}
void check_gradient(const scene::ToolSurface& surface, const Vec3& x) {
    const scene::ToolDistance here = surface.distance(x);
    CHECK(here.normal.norm() == test::near(1.0, 1e-13));
    const double h = 1e-6;
    for (int k = 0; k < 3; ++k) {
        const Vec3 step = h * Vec3::Unit(k);
        CHECK(std::abs((surface.distance(x + step).distance - surface.distance(x - step).distance) / (2 * h) - here.normal[k]) <
              2e-5);  // h over the least distance from an edge
    }
    CHECK(std::abs(surface.distance(x - here.distance * here.normal).distance) < 1e-13);
}

TEST_CASE("a box of triangles is as far as a block from every point, inside and outside, on whichever side triangles turn") {
    const Vec3 half(0.5, 0.3, 0.8);
    const scene::Block block({.half = half});
    exchange::Surface turned = box(half);
    for (auto& t : turned.triangles) std::swap(t[0], t[1]);
    const scene::TriangleSurface triangles = body(box(half)), inside_out = body(turned);
    CHECK(triangles.volume() == test::near(8.0 * half.prod(), 1e-14));
    for (const Vec3& x : places(1.2, 300)) {
        // A block written out: what is beyond its faces, or the nearest of them.
        const Vec3 beyond = x.cwiseAbs() - half;
        const double outside = beyond.cwiseMax(0.0).norm(), expected = outside > 0.0 ? outside : beyond.maxCoeff();
        for (const scene::ToolSurface* one :
             {static_cast<const scene::ToolSurface*>(&block), static_cast<const scene::ToolSurface*>(&triangles),
              static_cast<const scene::ToolSurface*>(&inside_out)}) {
            CHECK(std::abs(one->distance(x).distance - expected) < 1e-14);
            if (std::abs(expected) > 0.02) CHECK((one->distance(x).normal - block.distance(x).normal).norm() < 1e-12);
        }
    }
    // On a face, an edge and a corner: the distance is nothing, and the normal points away.
    for (const Vec3& x : {Vec3(0.5, 0.1, 0.2), Vec3(0.5, 0.3, 0.2), half}) {
        CHECK(std::abs(triangles.distance(x).distance) < 1e-15);
        CHECK(triangles.distance(x).normal.dot(x.normalized()) > 0.3);
    }
}

TEST_CASE("a ball of triangles comes near a sphere with the square of their size, and is exact within") {
    double before = 0.0;
    for (const std::uint32_t rings : {8u, 16u, 32u}) {
        const exchange::Surface surface = ball(1.0, rings);
        const scene::TriangleSurface triangles = body(surface);
        CHECK(triangles.volume() == test::near(surface.volume(), 1e-13));
        double worst = 0.0;
        for (const Vec3& x : places(1.0, 400)) {
            worst = std::max(worst, std::abs(triangles.distance(x).distance - (x.norm() - 1.0)));
            if (x.norm() > 0.9) continue;
            // Within a convex body the nearest place is on the plane of a face that no other is nearer than.
            double nearest = std::numeric_limits<double>::infinity();
            for (const auto& t : surface.triangles) {
                const Vec3 &a = surface.points[t[0]], &b = surface.points[t[1]], &c = surface.points[t[2]];
                nearest = std::min(nearest, (b - a).cross(c - a).normalized().dot(a - x));
            }
            CHECK(triangles.distance(x).distance == test::near(-nearest, 1e-12));
        }
        std::printf("%u rings: %.2e off\n", rings, worst);
        const double angle = pi / rings;
        CHECK(worst < 0.25 * angle * angle);  // sagitta of the diagonals, 1/8 (angle^2 + angle^2)
        if (before > 0.0) CHECK(before / worst == test::near(4.0, 0.15));
        before = worst;
    }
}

TEST_CASE("pins, discs, plates with a hole, rounded or not, have true distances") {
    const scene::Ring pin({.radius = 0.2, .half_height = 0.6}),
        plate({.radius = 1.0, .hole = 0.4, .half_height = 0.1, .edge = 0.06});
    CHECK(pin.distance({0.5, 0, 0.1}).distance == test::near(0.3, 1e-14));
    CHECK(pin.distance({0, 0.3, 1.0}).distance == test::near(std::hypot(0.1, 0.4), 1e-14));
    CHECK(pin.distance({0, 0, 0.9}).distance == test::near(0.3, 1e-14));
    CHECK(pin.distance({0.05, 0, 0}).distance == test::near(-0.15, 1e-14));
    CHECK(plate.distance({0, 0, 0}).distance == test::near(0.4, 1e-14));
    CHECK(plate.distance({0.7, 0, 0.3}).distance == test::near(0.2, 1e-14));
    CHECK(plate.distance({0, 1.1, 0.2}).distance == test::near(std::hypot(0.16, 0.16) - 0.06, 1e-14));
    CHECK(plate.distance({0.3, 0, -0.2}).distance == test::near(std::hypot(0.16, 0.16) - 0.06, 1e-14));
    for (const scene::ToolSurface* one :
         {static_cast<const scene::ToolSurface*>(&pin), static_cast<const scene::ToolSurface*>(&plate)})
        for (const Vec3& x : places(1.2, 200))
            if (one->distance(x).distance > 0.02 && std::hypot(x[0], x[1]) > 0.05) check_gradient(*one, x);
}

TEST_CASE("a surface is the same from STL of both kinds, and what is no closed surface is refused by its file and place") {
    exchange::Surface cube = box({0.5, 0.25, 0.75});  // halves and quarters: exact in single precision
    const std::string binary = exchange::stl_of(cube);
    std::ostringstream text;
    text << "solid a cube\n";
    for (const auto& t : cube.triangles) {
        text << " facet normal 0 0 0\n  outer loop\n";
        for (const auto k : t)
            text << "   vertex " << cube.points[k][0] << " " << cube.points[k][1] << " " << cube.points[k][2] << "\n";
        text << "  endloop\n endfacet\n";
    }
    text << "endsolid\n";
    const auto of_bytes = exchange::surface_of_stl(binary, "cube.stl"),
               of_text = exchange::surface_of_stl(text.str(), "cube.stl", 2.0);
    CHECK(of_bytes->corners().size() == 8);
    CHECK(of_bytes->triangles().size() == 12);
    for (const Vec3& x : places(1.0, 50)) {
        CHECK(of_bytes->distance(x).distance == scene::Block({.half = {0.5, 0.25, 0.75}}).distance(x).distance);
        CHECK(of_text->distance(2.0 * x).distance == 2.0 * of_bytes->distance(x).distance);
    }

    const auto refused = [](const std::string& bytes) { return refusal([&] { exchange::surface_of_stl(bytes, "cube.stl"); }); };
    CHECK(refused("").find("cube.stl:byte 0: is no STL file") == 0);
    CHECK(refused(binary.substr(0, 200)).find("cube.stl:byte 0: is no STL file") == 0);
    CHECK(refused("solid nothing\nendsolid\n").find("vertices = 0, but it must be three a facet") != std::string::npos);
    CHECK(refused("solid x\nvertex 1 2 three\n").find("z = three") != std::string::npos);
    CHECK(refused("solid x\nvertex 1 nan 3\n").find("cube.stl:byte") == 0);
    CHECK(refusal([&] { exchange::read_surface("no such file.stl"); }) == "no such file.stl: is no file that can be read");
    CHECK(refusal([&] { exchange::surface_of_stl(binary, "cube.stl", -1.0); }) ==
          "surface_of_stl.scale = -1, but it must be finite and > 0");
    exchange::Surface open = cube, against = cube, flat = cube;
    open.triangles.pop_back();
    CHECK(refused(exchange::stl_of(open)).find("of 1 triangle, but it must be of two that turn alike") != std::string::npos);
    std::swap(against.triangles[3][0], against.triangles[3][1]);
    CHECK(refused(exchange::stl_of(against)).find("of two triangles that turn against each other") != std::string::npos);
    flat.points[3] = 0.5 * (flat.points[1] + flat.points[2]);
    CHECK(refused(exchange::stl_of(flat)).find("its corners are on one line") != std::string::npos);

    scene::Tool tool;
    tool.shape = scene::ToolShape::surface;
    CHECK(refusal([&] { tool.validate(); }) == "Tool.surface = none, but it must be given, for a tool of this shape");
    tool.surface = of_bytes;
    CHECK(refusal([&] { tool.validate(); }).empty());
    tool.origin = {1.0, 0.0, 0.0}, tool.hollow = true;
    CHECK(scene::tool_distance(tool, {1.25, 0.0, 0.0}).distance == test::near(0.25, 1e-14));
    CHECK(refusal([] { scene::Block({.half = {1, 1, 0}}); }) == "Block.half = 0, but it must be finite and > 0");
    CHECK(refusal([] { scene::Ring({.radius = 1, .hole = 1, .half_height = 1}); }) ==
          "Ring.hole = 1, but it must be in [0, radius)");
}

}  // namespace exchange_surface_files_test

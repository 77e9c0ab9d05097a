// SPDX-License-Identifier: MIT
#include "../refusal.hpp"
#include "../support/random_vector.hpp"

#include <fibrant/solid/cell_search.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <random>

using namespace fibrant;

namespace hexahedron_map_test {

/// A box of random size, sheared, tapered and with shifted corners, somewhere in space.
solid::CellNodes random_cell(std::mt19937& generator) {
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    while (true) {
        const Vec3 size = Vec3::Constant(0.55) + 0.45 * test::random_vector(draw, generator);
        const double shear = draw(generator), taper = 0.5 * draw(generator);
        Mat3 turn = Mat3::Identity();
        turn(0, 1) = shear, turn(0, 2) = 0.5 * draw(generator), turn(2, 1) = 0.3 * draw(generator);
        solid::CellNodes nodes;
        const Vec3 place(10.0 * draw(generator), 10.0 * draw(generator), 10.0 * draw(generator));
        for (int k = 0; k < 8; ++k) {
            const Vec3 c = solid::corner(k);
            Vec3 x = size.cwiseProduct(c);
            x.x() *= 1.0 + taper * c.z();
            for (int i = 0; i < 3; ++i) x[i] += 0.08 * draw(generator);
            nodes.row(k) = (place + turn * x).transpose();
        }
        if (solid::least_jacobian(nodes) > 0.02) return nodes;
    }
}

void check_round_trips(int cells, int points) {
    std::mt19937 generator(11);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    double worst = 0.0;
    int lost = 0, found_outside = 0, most = 0;
    for (int c = 0; c < cells; ++c) {
        const solid::CellNodes nodes = random_cell(generator);
        for (int p = 0; p < points; ++p) {
            const Vec3 xi = test::random_vector(draw, generator);
            const Vec3 x = nodes.transpose() * solid::shape(xi);
            const solid::MapResult map = solid::inverse_map(nodes, x);
            if (map.status != solid::MapStatus::inside)
                ++lost;
            else
                worst = std::max(worst, (map.xi - xi).cwiseAbs().maxCoeff());
            most = std::max(most, map.iterations);
            // The same point pushed out through a face.
            const int axis = p % 3;
            Vec3 beyond = xi;
            beyond[axis] = (xi[axis] < 0.0 ? -1.0 : 1.0) * (1.0 + 1e-6 + std::abs(draw(generator)) * 0.2);
            if (solid::inverse_map(nodes, nodes.transpose() * solid::shape(beyond)).status == solid::MapStatus::inside)
                ++found_outside;
        }
    }
    CHECK(lost == 0);
    CHECK(found_outside == 0);
    // Coordinates of the order of 10 carry 2e-15, natural ones of such cells ten times that and more where they are thin.
    CHECK(worst <= 1e-12);
    CHECK(most <= 20);
}

TEST_CASE("a point of a sheared and tapered cell is found again to 1e-12, a million times, and nothing outside") {
    check_round_trips(10000, 100);
}

TEST_CASE("points of faces, edges and corners are inside, and those 1e-6 beyond are not") {
    std::mt19937 generator(3);
    for (int sample = 0; sample < 200; ++sample) {
        const solid::CellNodes nodes = random_cell(generator);
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                for (int k = -1; k <= 1; ++k) {
                    const Vec3 xi(i, j, k);
                    const solid::MapResult map = solid::inverse_map(nodes, nodes.transpose() * solid::shape(xi));
                    CHECK(map.status == solid::MapStatus::inside);
                    CHECK((map.xi - xi).cwiseAbs().maxCoeff() <= 1e-12);
                    if (xi.isZero()) continue;
                    const Vec3 beyond = (1.0 + 1e-6) * xi;
                    CHECK(solid::inverse_map(nodes, nodes.transpose() * solid::shape(beyond)).status ==
                          solid::MapStatus::outside);
                }
    }
}

TEST_CASE("a cell that is flat or inside out is reported, and refused by name") {
    solid::CellNodes nodes;
    for (int k = 0; k < 8; ++k) nodes.row(k) = solid::corner(k).transpose();
    CHECK(solid::least_jacobian(nodes) == test::near(1.0, 1e-12));
    solid::CellNodes flat = nodes;
    flat.col(2).setZero();
    CHECK(solid::inverse_map(flat, Vec3(0.1, 0.2, 0.0)).status == solid::MapStatus::degenerate);
    CHECK(solid::inverse_map(solid::CellNodes::Zero(), Vec3::Zero()).status == solid::MapStatus::degenerate);
    CHECK_FALSE(solid::least_jacobian(flat) > 0.0);
    scene::Solid solid;
    solid.material = {1.0, 0.3};
    for (int k = 0; k < 8; ++k) solid.nodes.push_back(solid::corner(k));
    solid.cells.push_back({0, 1, 2, 3, 4, 5, 6, 7});
    solid::require_valid_cells(solid);
    std::swap(solid.nodes[0], solid.nodes[4]);
    CHECK(test::refusal([&] { solid::require_valid_cells(solid); }).starts_with("Solid.cells[0].jacobian = "));
}

TEST_CASE("the search finds the lowest cell of those that hold a point, as trying all of them does") {
    scene::Solid solid;
    solid.material = {1.0, 0.3};
    const Index n = 6;
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> draw(-1.0, 1.0);
    for (Index k = 0; k <= n; ++k)
        for (Index j = 0; j <= n; ++j)
            for (Index i = 0; i <= n; ++i) {
                Vec3 x(static_cast<double>(i), static_cast<double>(j), 0.2 * static_cast<double>(k));
                x += 0.04 * test::random_vector(draw, generator);
                x.z() += 0.3 * std::sin(x.x());
                solid.nodes.push_back(x);
            }
    const auto node = [&](Index i, Index j, Index k) { return (k * (n + 1) + j) * (n + 1) + i; };
    for (Index k = 0; k < n; ++k)
        for (Index j = 0; j < n; ++j)
            for (Index i = 0; i < n; ++i)
                solid.cells.push_back({node(i, j, k), node(i + 1, j, k), node(i + 1, j + 1, k), node(i, j + 1, k),
                                       node(i, j, k + 1), node(i + 1, j, k + 1), node(i + 1, j + 1, k + 1),
                                       node(i, j + 1, k + 1)});
    solid::require_valid_cells(solid);
    const solid::CellSearch search(solid);
    const auto check = [&](const Vec3& x) {
        Index lowest = -1;
        for (Index c = 0; c < core::count(solid.cells) && lowest < 0; ++c)
            if (solid::inverse_map(solid::cell_nodes(solid, c), x).status == solid::MapStatus::inside) lowest = c;
        const solid::CellSearch::Found found = search.find(x);
        CHECK(found.cell == lowest);
        CHECK_FALSE(found.degenerate);
        if (lowest >= 0) CHECK((solid::cell_nodes(solid, lowest).transpose() * solid::shape(found.xi) - x).norm() <= 1e-12);
        return found.cell >= 0;
    };
    int inside = 0;
    for (int sample = 0; sample < 3000; ++sample)
        inside += check(Vec3(3.0 + 3.6 * draw(generator), 3.0 + 3.6 * draw(generator), 0.6 + 1.2 * draw(generator))) ? 1 : 0;
    CHECK(inside > 500);
    CHECK(inside < 2500);
    for (const Vec3& x : solid.nodes) CHECK(check(x));  // corners, shared by up to eight
    for (Index c = 0; c < core::count(solid.cells); ++c)
        CHECK(check(solid::cell_nodes(solid, c).transpose() * solid::shape(Vec3(1.0, 0.3, -0.2))));
}

}  // namespace hexahedron_map_test

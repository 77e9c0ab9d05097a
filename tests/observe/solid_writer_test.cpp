// SPDX-License-Identifier: MIT
#include <fibrant/observe/svg_solid.hpp>

#include "../refusal.hpp"

#include <near.hpp>

#include <doctest/doctest.h>

#include <filesystem>
#include <sstream>
#include <unistd.h>

using namespace fibrant;

namespace solid_writer_test {

/// Two cubes side by side along x, from 0 to 2.
observe::SolidSnapshot two_cells() {
    observe::SolidSnapshot solid;
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 2; ++j)
            for (int i = 0; i < 3; ++i)
                solid.position.push_back(Vec3(i, j, k)), solid.displacement.push_back(Vec3(0, 0, 0.1 * i));
    const auto node = [](Index i, Index j, Index k) { return (k * 2 + j) * 3 + i; };
    for (Index i = 0; i < 2; ++i)
        solid.cells.push_back({node(i, 0, 0), node(i + 1, 0, 0), node(i + 1, 1, 0), node(i, 1, 0), node(i, 0, 1),
                               node(i + 1, 0, 1), node(i + 1, 1, 1), node(i, 1, 1)});
    for (const double size : {1.0, 2.0}) {
        Mat3 stress = Mat3::Zero();
        stress(0, 0) = size;
        solid.stress.push_back(stress), solid.strain.push_back(0.01 * stress);
    }
    solid.bonds.push_back({Vec3(0.5, 0.5, 0.5), Vec3(1, 2, 3), true});
    return solid;
}

TEST_CASE("uniaxial stress is its own von Mises stress, and a pressure has none") {
    Mat3 stress = Mat3::Zero();
    stress(1, 1) = -3.0;
    CHECK(observe::von_mises(stress) == test::near(3.0, 1e-12));
    CHECK(observe::von_mises(Mat3(5.0 * Mat3::Identity())) == 0.0);
    stress.setZero();
    stress(0, 1) = stress(1, 0) = 2.0;
    CHECK(observe::von_mises(stress) == test::near(2.0 * std::sqrt(3.0), 1e-12));
}

TEST_CASE("the grid's file has every node, cell and value") {
    const std::string text = observe::solid_data(two_cells());
    CHECK(text.find("NumberOfPoints=\"12\" NumberOfCells=\"2\"") != std::string::npos);
    const auto numbers = [&](const std::string& name) {
        const std::size_t at = text.find("Name=\"" + name + "\""), first = text.find('>', at) + 1;
        std::istringstream in(text.substr(first, text.find("</DataArray>", first) - first));
        std::vector<double> values;
        for (double value = 0.0; in >> value;) values.push_back(value);
        return values;
    };
    CHECK(numbers("Points").size() == 36);
    CHECK(numbers("connectivity").size() == 16);
    CHECK(numbers("connectivity")[9] == 2.0);
    CHECK(numbers("offsets") == std::vector<double>{8, 16});
    CHECK(numbers("types") == std::vector<double>{12, 12});
    CHECK(numbers("stress") == std::vector<double>{1, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0});
    CHECK(numbers("von_mises") == std::vector<double>{1, 2});
    CHECK(numbers("displacement")[5] == test::near(0.1, 1e-7));  // a float
    CHECK(observe::solid_data({}).empty());
    CHECK(observe::bond_data(two_cells()).text().find("Name=\"force\"") != std::string::npos);
}

TEST_CASE("a writer keeps a series, and writes nothing where there is no solid") {
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("fibrant_solid_" + std::to_string(::getpid()));
    {
        observe::SolidWriter writer(folder);
        observe::Snapshot snapshot;
        writer.accepted(snapshot);
        CHECK(std::filesystem::is_empty(folder));
        snapshot.solid = two_cells(), snapshot.increment = 7;
        writer.accepted(snapshot);
        CHECK(std::filesystem::exists(folder / "solid_0007.vtu"));
        CHECK(std::filesystem::exists(folder / "bonds_0007.vtp"));
        CHECK(observe::read_file(folder / "solid.pvd").find("solid_0007.vtu") != std::string::npos);
    }
    std::filesystem::remove_all(folder);
}

TEST_CASE("outer faces are those of one cell, and a plane cuts cells in polygons of their section") {
    const observe::SolidSnapshot solid = two_cells();
    CHECK(observe::outer_faces(solid).size() == 10);
    const auto across = observe::solid_cuts(solid, 0, 0.25), along = observe::solid_cuts(solid, 2, 0.5);
    REQUIRE(across.size() == 1);
    REQUIRE(along.size() == 2);
    for (const auto& cut : {across[0], along[0], along[1]}) {
        double area = 0.0;
        for (std::size_t k = 0; k < cut.size(); ++k) {
            const auto &a = cut[k], &b = cut[(k + 1) % cut.size()];
            area += 0.5 * (a.x() * b.y() - a.y() * b.x());
        }
        CHECK(std::abs(area) == test::near(1.0, 1e-12));
    }
    CHECK(observe::solid_cuts(solid, 0, 5.0).empty());
    CHECK(observe::svg_solid(solid, {1.0, 2.0}, 15.178661).find(">15.2<") != std::string::npos);  // room for so many digits
    const std::string picture = observe::svg_solid(solid, {1.0, 2.0}, 2.0);
    CHECK(picture.find("</svg>") != std::string::npos);
    CHECK(test::refusal([&] { observe::svg_solid(solid, {1.0}, 2.0); }).starts_with("svg_solid.values = 1"));
    CHECK(test::refusal([&] { observe::svg_solid(solid, {1.0, 2.0}, 0.0); }).starts_with("svg_solid.most = 0"));
}

}  // namespace solid_writer_test

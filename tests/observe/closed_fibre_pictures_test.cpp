// SPDX-License-Identifier: MIT
// Files and pictures of closed fibres close.
#include "observe/snapshot_samples.hpp"

#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <doctest/doctest.h>

#include <string>

using namespace fibrant;

namespace closed_fibre_pictures_test {

using namespace fibrant::observe;

/// A ring of 24 elements in the plane z = 0, whose first node is at the share `shift` of it.
Snapshot ring(double shift, bool closed = true) {
    FibreSnapshot fibre;
    fibre.section = scene::circular(0.1), fibre.closed = closed;
    for (int node = 0; node <= 48; ++node) {
        const double a = 2.0 * std::numbers::pi * ((node % 48) / 48.0 + shift);
        fibre.position.emplace_back(std::cos(a), std::sin(a), 0.0);
        fibre.displacement.emplace_back(Vec3::Zero());
        fibre.director_1.emplace_back(std::cos(a), std::sin(a), 0.0);
        fibre.director_2.emplace_back(0.0, 0.0, 1.0);
        fibre.curvature.push_back(1.0);
    }
    Snapshot snapshot;
    snapshot.fibres.push_back(fibre);
    return snapshot;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
    return found;
}

TEST_CASE("the polyline of a closed fibre comes back to its first point, which is there once") {
    const std::string file = fibre_data(ring(0.0)).text();
    CHECK(file.find("NumberOfPoints=\"48\" NumberOfVerts=\"0\" NumberOfLines=\"1\"") != std::string::npos);
    const std::string open = fibre_data(ring(0.0, false)).text();
    CHECK(open.find("NumberOfPoints=\"49\"") != std::string::npos);
    PolyData data;
    for (int k = 0; k < 3; ++k) data.add_point(Vec3::UnitX() * k);
    data.add_line(0, 3, true);
    CHECK(data.text().size() == [] {  // four points on the line
        PolyData other;
        for (int k = 0; k < 3; ++k) other.add_point(Vec3::UnitX() * k);
        other.add_line(0, 3);
        return other.text().size();
    }() + 8);
}

TEST_CASE("a closed fibre has no cut faces in a view") {
    std::size_t open = 0;
    for (const double elevation : {20.0, 60.0, -30.0}) {
        CHECK(occurrences(svg_view(ring(0.1), {.elevation = elevation}), "class=\"f") == 0);
        open += occurrences(svg_view(ring(0.1, false), {.elevation = elevation}), "class=\"f");
    }
    CHECK(open > 0);  // from some sides it hides them itself
}

TEST_CASE("a slice of a closed fibre is the same wherever its first node lies") {
    // Near its top the ring runs along the plane in one strip; around the middle the plane cuts it twice.
    for (const double level : {0.95, 0.3})
        for (const double shift : {0.0, 0.25, 0.5}) {
            const auto shapes = slice_shapes(ring(shift), 1, level), away = slice_shapes(ring(0.125), 1, level);
            CHECK(shapes.size() == away.size());
        }
    CHECK(slice_shapes(ring(0.25), 1, 0.95).size() == 1);
    CHECK(slice_shapes(ring(0.25, false), 1, 0.95).size() == 2);  // cut in two where it begins
}

TEST_CASE("the least gap of linked rings is at their crossing, on their first nodes too") {
    for (const double shift : {0.0, 0.13}) {
        Snapshot both = ring(shift);
        FibreSnapshot other = ring(0.5 + shift).fibres.front();
        for (std::size_t k = 0; k < other.position.size(); ++k) {
            const Vec3 x = other.position[k];
            other.position[k] = Vec3(1.9 + x.x(), 0.0, x.y());
            other.director_1[k] = Vec3(x.x(), 0.0, x.y()), other.director_2[k] = Vec3::UnitY();
        }
        both.fibres.push_back(other);
        const LeastGap least = least_gap(both, proximity::GridSearch());
        CHECK(std::abs(least.gap + 0.1) < 1e-3);  // centre lines 0.1 apart, to what quadratic elements miss of circles
    }
}

}  // namespace closed_fibre_pictures_test

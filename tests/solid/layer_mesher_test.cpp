// SPDX-License-Identifier: MIT
#include "../refusal.hpp"

#include <fibrant/solid/layer_mesher.hpp>

#include <near.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

using namespace fibrant;

namespace layer_mesher_test {

using solid::SectionPlace;

constexpr double radius = 0.1;

/// A fibre along `axis` (0: x, 1: y) through (0, at), whose height is amplitude cos(pi s), s from -2 to 2.
std::vector<SectionPlace> wave(int axis, double at, double amplitude, double flatness = 1.0, Index nodes = 129) {
    std::vector<SectionPlace> fibre;
    for (Index k = 0; k < nodes; ++k) {
        const double s = -2.0 + 4.0 * static_cast<double>(k) / static_cast<double>(nodes - 1);
        const double z = amplitude * std::cos(std::numbers::pi * s),
                     slope = -std::numbers::pi * amplitude * std::sin(std::numbers::pi * s);
        Vec3 along = Vec3::Zero(), across = Vec3::Zero(), centre(0, 0, z);
        along[axis] = 1.0, along.z() = slope, across[1 - axis] = 1.0;
        centre[axis] = s, centre[1 - axis] = at;
        along.normalize();
        fibre.push_back({centre, radius * across, radius / flatness * along.cross(across)});
    }
    return fibre;
}
/// A plain weave of fibres at odd and even places.
std::vector<std::vector<SectionPlace>> sheet() {
    std::vector<std::vector<SectionPlace>> fibres;
    for (int k = -1; k <= 1; ++k) {
        const double sign = k % 2 == 0 ? 1.0 : -1.0;
        fibres.push_back(wave(0, k, sign * 0.12)), fibres.push_back(wave(1, k, -sign * 0.12));
    }
    return fibres;
}
solid::LayerParameters parameters() {
    solid::LayerParameters p;
    p.low = {-1.5, -1.5}, p.high = {1.5, 1.5}, p.cells = {48, 48};
    p.upper_face = 0.35, p.lower_face = -0.35;
    p.penetration_depth = 0.05, p.least_thickness = 0.02, p.clearance = 0.01;
    p.material = {100.0, 0.3};
    return p;
}

TEST_CASE("a straight round or flattened fibre is met where its contour is") {
    std::vector<SectionPlace> fibre;
    const Vec3 along = Vec3(1.0, 0.5, 0.3).normalized(), side = along.cross(Vec3::UnitZ()).normalized(), up = side.cross(along);
    for (int k = 0; k <= 10; ++k) fibre.push_back({(0.2 * k - 1.0) * along, 2.0 * radius * side, radius * up});
    const solid::FibreSurface surface({fibre});
    int met = 0;
    for (double x = -0.5; x <= 0.5; x += 0.037)
        for (double y = -0.5; y <= 0.5; y += 0.041)
            for (const double sign : {1.0, -1.0}) {
                const auto height = surface.height(x, y, sign);
                const double across = Vec3(x, y, 0.0).dot(side);
                CHECK(height.has_value() == (std::abs(across) < 2.0 * radius));
                if (!height) continue;
                ++met;
                const Vec3 p(x, y, *height);
                CHECK(std::pow(p.dot(side) / (2.0 * radius), 2) + std::pow(p.dot(up) / radius, 2) == test::near(1.0, 1e-10));
                CHECK(sign * (*height - (p - p.dot(up) * up).z()) > 0.0);  // on the side that is looked at
            }
    CHECK(met > 200);
    CHECK_FALSE(surface.height(5.0, 0.0, 1.0).has_value());
}

TEST_CASE("a wavy fibre is met over its crest and in its trough, without cracks") {
    const solid::FibreSurface surface({wave(0, 0.0, 0.12)});
    for (double x = -1.8; x <= 1.8; x += 0.0013) {
        const auto height = surface.height(x, 0.0, 1.0);
        REQUIRE(height.has_value());
        // The offset curve, a radius from the centreline along its normal: where it is over x.
        double low = x - radius, high = x + radius, exact = 0.0;
        for (int k = 0; k < 50; ++k) {
            const double s = 0.5 * (low + high), slope = -0.12 * std::numbers::pi * std::sin(std::numbers::pi * s),
                         secant = std::hypot(1.0, slope);
            (s - radius * slope / secant < x ? low : high) = s;
            exact = 0.12 * std::cos(std::numbers::pi * s) + radius / secant;
        }
        CHECK(std::abs(*height - exact) < 2e-3 * radius);
    }
    CHECK(*surface.height(0.0, 0.0, 1.0) == test::near(0.22, 2e-3));
    CHECK(*surface.height(1.0, 0.0, -1.0) == test::near(-0.22, 2e-3));
}

TEST_CASE("layers lie on both sides of a sheet, reach into its fibres and span its pores") {
    auto p = parameters();
    p.through = 3, p.grading = 2.0, p.smoothing = 0;
    const solid::FibreSurface surface(sheet());
    const solid::Layers layers = solid::mesh_layers(surface, p);
    REQUIRE(layers.list.size() == 2);
    CHECK(layers.met + layers.filled == 2 * 49 * 49);
    CHECK(layers.filled > 500);
    CHECK(layers.met > 500);
    for (std::size_t side = 0; side < 2; ++side) {
        const solid::Layer& layer = layers.list[side];
        const double sign = side == 0 ? 1.0 : -1.0;
        const Index inner = side == 0 ? 0 : 3, outer = 3 - inner, next = side == 0 ? 1 : 2;
        CHECK(core::count(layer.solid.nodes) == 49 * 49 * 4);
        CHECK(core::count(layer.solid.cells) == 48 * 48 * 3);
        double least = 1.0;
        for (Index c = 0; c < core::count(layer.solid.cells); ++c)
            least = std::min(least, solid::least_jacobian(solid::cell_nodes(layer.solid, c)));
        CHECK(least > 0.0);
        double low = 1.0, high = -1.0;
        for (Index j = 0; j <= 48; ++j)
            for (Index i = 0; i <= 48; ++i) {
                const Vec3 a = layer.solid.nodes[core::at(layer.node(i, j, inner))],
                           b = layer.solid.nodes[core::at(layer.node(i, j, outer))];
                const Vec3 c = layer.solid.nodes[core::at(layer.node(i, j, next))];
                CHECK(b.z() == test::near(sign * 0.35, 1e-14));
                CHECK(std::hypot(a.x() - b.x(), a.y() - b.y()) <= 1e-14);
                // 1 : sqrt(2) : 2 from the inside out.
                CHECK((c.z() - a.z()) * (3.0 + std::numbers::sqrt2) == test::near(b.z() - a.z(), 1e-12));
                const auto height = surface.height(a.x(), a.y(), sign);
                if (height) {
                    CHECK(a.z() == test::near(*height - sign * 0.05, 1e-12));
                    low = std::min(low, sign * a.z()), high = std::max(high, sign * a.z());
                }
            }
        for (Index j = 0; j <= 48; ++j)  // a film has no height beyond those that it hangs from
            for (Index i = 0; i <= 48; ++i) {
                const double z = sign * layer.solid.nodes[core::at(layer.node(i, j, inner))].z();
                CHECK(z >= low - 1e-12);
                CHECK(z <= high + 1e-12);
            }
    }
    // The fibres' centres on the crests are 0.05 above the inner face, and those in the troughs are in no layer.
    const solid::CellSearch search(layers.list[0].solid);
    CHECK(search.find(Vec3(0, 0, 0.13)).cell < 0);
    CHECK(search.find(Vec3(0, 0, 0.18)).cell >= 0);
    p.sides = solid::Sides::lower;
    CHECK(solid::mesh_layers(surface, p).list.size() == 1);
}

TEST_CASE("smoothing keeps a plane and takes the tip off a peak") {
    solid::detail::HeightGrid grid(5, 4);
    for (Index j = 0; j < 4; ++j)
        for (Index i = 0; i < 5; ++i) grid.set(i, j, 2.0);
    grid.at(2, 1) = 3.0;
    grid.smooth();
    CHECK(grid.at(2, 1) == test::near(2.5, 1e-12));
    CHECK(grid.at(1, 1) == test::near(2.125, 1e-12));
    CHECK(grid.at(0, 3) == 2.0);
}

TEST_CASE("what cannot be meshed is refused by name, and inner faces that would cross are clipped") {
    const solid::FibreSurface surface(sheet());
    auto p = parameters();
    const auto says = [&](const std::string& text) {
        return test::refusal([&] { solid::mesh_layers(surface, p); }).starts_with(text);
    };
    p.penetration_depth = 0.4;  // more than the sheet has
    const solid::Layers clipped = solid::mesh_layers(surface, p);
    CHECK(clipped.clipped > 1000);
    for (Index n = 0; n < 49 * 49; ++n)
        CHECK(clipped.list[0].solid.nodes[core::at(n)].z() - clipped.list[1].solid.nodes[core::at(n + 2 * 49 * 49)].z() >=
              0.01 - 1e-12);
    p.crossing = solid::Crossing::refuse;
    CHECK(says("LayerParameters.penetration_depth = 0.4"));
    p.sides = solid::Sides::upper;
    p.penetration_depth = 0.6;
    CHECK(says("LayerParameters.penetration_depth = 0.6"));
    p = parameters();
    p.upper_face = 0.17;  // the crests are at 0.22, less the depth 0.05
    CHECK(says("LayerParameters.upper_face = 0.17"));
    p.upper_face = 0.35, p.lower_face = 0.4;
    CHECK(says("LayerParameters.lower_face = 0.4"));
    p = parameters();
    p.penetration_depth = -0.1;
    CHECK(says("LayerParameters.penetration_depth = -0.1"));
    p = parameters();
    p.cells = {0, 4};
    CHECK(says("LayerParameters.cells.x = 0"));
    p = parameters();
    p.low = {10.0, 10.0}, p.high = {11.0, 11.0};
    CHECK(says("LayerParameters.low, high"));
    p = parameters();
    p.least_thickness = 0.0;
    CHECK(says("LayerParameters.least_thickness = 0"));
}

TEST_CASE(
    "a layer without thickness, one thinner than the sheet is rough, and one of cells inside out are refused with place, value "
    "and bound") {
    const solid::FibreSurface surface(sheet());
    auto p = parameters();
    const auto refusal = [&] { return test::refusal([&] { solid::mesh_layers(surface, p); }); };
    p.penetration_depth = 0.0, p.smoothing = 0, p.upper_face = 0.22;  // level with the crests
    CHECK_MESSAGE(refusal().starts_with("LayerParameters.upper_face = 0.22, but it must be higher: at x = "), refusal());
    CHECK(refusal().ends_with("less than least_thickness = 0.02"));
    p.upper_face = 0.35, p.lower_face = -0.15;  // in the troughs, above the crests of the other side
    CHECK_MESSAGE(refusal().starts_with("LayerParameters.lower_face = -0.15, but it must be lower: at x = "), refusal());
    p.lower_face = 0.35, p.upper_face = -0.35;  // both faces changed over
    CHECK_MESSAGE(refusal().starts_with("LayerParameters.upper_face = -0.35, but it must be higher: at x = "), refusal());
    p = parameters();
    p.sides = solid::Sides::lower, p.penetration_depth = 2.0;  // through the sheet and out again
    CHECK_MESSAGE(refusal().starts_with("LayerParameters.penetration_depth = 2, but it must be less: at x = "), refusal());
    // From both sides the depth is cut to what there is, however large; what is left are cells that are whole.
    p.sides = solid::Sides::both, p.penetration_depth = 1e6;
    const solid::Layers clipped = solid::mesh_layers(surface, p);
    CHECK(clipped.clipped == clipped.columns);
    for (const solid::Layer& layer : clipped.list)
        for (Index c = 0; c < core::count(layer.solid.cells); ++c)
            REQUIRE(solid::least_jacobian(solid::cell_nodes(layer.solid, c)) > 0.0);
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const auto& [field, name] : {std::pair{&solid::LayerParameters::penetration_depth, "penetration_depth"},
                                      {&solid::LayerParameters::upper_face, "upper_face"},
                                      {&solid::LayerParameters::lower_face, "lower_face"},
                                      {&solid::LayerParameters::clearance, "clearance"},
                                      {&solid::LayerParameters::least_thickness, "least_thickness"},
                                      {&solid::LayerParameters::grading, "grading"}}) {
        p = parameters();
        p.*field = nan;
        CHECK_MESSAGE(refusal().starts_with(std::string("LayerParameters.") + name + " = nan, but it must be"), refusal());
    }
}

}  // namespace layer_mesher_test

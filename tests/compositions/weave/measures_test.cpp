// SPDX-License-Identifier: MIT
#include "compositions/weave/woven_snapshot.hpp"
#include "refusal.hpp"

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/tow_section.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace measures_test {

using namespace fibrant::compositions::weave;

constexpr double pi = std::numbers::pi;

/// Arc length of y = a sin(k x) over [0, length], by Simpson's rule on 20,000 intervals.
double sine_length(double a, double k, double length) {
    const int n = 20000;
    double sum = 0.0;
    for (int i = 0; i <= n; ++i) {
        const double slope = a * k * std::cos(k * length * i / n);
        sum += (i == 0 || i == n ? 1.0 : i % 2 == 1 ? 4.0 : 2.0) * std::sqrt(1.0 + slope * slope);
    }
    return sum * length / n / 3.0;
}

std::vector<Vec3> sine_nodes(double a, double k, double length, Index elements) {
    std::vector<Vec3> nodes;
    for (Index node = 0; node <= 2 * elements; ++node) {
        const double x = length * static_cast<double>(node) / static_cast<double>(2 * elements);
        nodes.emplace_back(x, 0.0, a * std::sin(k * x));
    }
    return nodes;
}

TEST_CASE("crimp of a sine path is that of its integral, to the fourth order in the elements") {
    const double a = 0.115, k = 2.0 * pi / 1.76, length = 3.52;
    const double exact = sine_length(a, k, length) / length - 1.0;
    double previous = 0.0;
    for (const Index elements : {16, 32, 64}) {
        const std::vector<Vec3> nodes = sine_nodes(a, k, length, elements);
        const double error = std::abs(crimp(observe::NodalCurve{nodes}, 0, 0.0, length) - exact);
        CHECK(error < 2e-3 * exact);
        if (elements > 16) CHECK(previous / error > 12.0);  // 16 in the limit
        previous = error;
    }
    // A part that begins and ends within elements.
    const std::vector<Vec3> nodes = sine_nodes(a, k, length, 64);
    const double part = (sine_length(a, k, 3.0) - sine_length(a, k, 0.7)) / 2.3 - 1.0;
    CHECK(crimp(observe::NodalCurve{nodes}, 0, 0.7, 3.0) == test::near(part, 1e-4));
}

TEST_CASE("a straight fibre has no crimp, and one that does not reach has none to tell") {
    const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    CHECK(std::abs(crimp(observe::NodalCurve{nodes}, 0, 0.25, 1.5)) < 1e-15);  // rounding of lengths
    CHECK(std::isnan(crimp(observe::NodalCurve{nodes}, 0, 0.25, 2.5)));
    CHECK(std::isnan(crimp(observe::NodalCurve{nodes}, 0, 1.5, 0.25)));
    CHECK(test::refusal([&] { observe::NodalCurve{std::span<const Vec3>{nodes}.first(2)}; }) ==
          "NodalCurve.nodes = 2, but it must be odd and >= 3");
}

TEST_CASE("a curve is met by a plane where its parabolas cross it, at nodes and tangents too") {
    const std::vector<Vec3> nodes{{0, 0, 0}, {1, 0, 1}, {2, 0, 0}, {3, 0, -1}, {4, 0, 0}};
    const observe::NodalCurve curve{nodes};
    CHECK(*curve.meets(Vec3::UnitX(), 2.5) == test::near(2.5, 1e-12));
    CHECK(*curve.meets(Vec3::UnitZ(), 0.75) == test::near(0.5, 1e-12));  // z = 1 - (t - 1)^2
    CHECK(*curve.meets(Vec3::UnitZ(), 1.0) == test::near(1.0, 1e-12));   // touches
    CHECK(*curve.meets(Vec3::UnitZ(), 0.0) == 0.0);
    CHECK(*curve.meets(Vec3::UnitX(), 4.0) == test::near(4.0, 1e-12));
    CHECK_FALSE(curve.meets(Vec3::UnitZ(), 1.1).has_value());
    CHECK_FALSE(curve.meets(Vec3::UnitY(), 0.5).has_value());
}

TEST_CASE("curvature of a circle is one over its radius, and its length two pi times that") {
    std::vector<Vec3> nodes;
    for (int k = 0; k <= 128; ++k) nodes.emplace_back(2.0 * std::cos(pi * k / 64.0), 1.0, 2.0 * std::sin(pi * k / 64.0));
    const observe::NodalCurve curve{nodes};
    // Middle of an element: the parabola's curvature is 8 sag / chord^2 = 1 / (R cos^2(angle / 2)), angle = pi / 64
    // here.
    CHECK(curve.curvature(5.0) == test::near(0.5, 1e-3));
    CHECK(curve.length(0.0, curve.end()) == test::near(4.0 * pi, 1e-6));
    observe::Snapshot snapshot;
    snapshot.fibres.emplace_back();
    snapshot.fibres[0].position = nodes;
    const Index fibre = 0;
    const CurvatureStatistics statistics = curvature_statistics(snapshot, {&fibre, 1});
    CHECK(statistics.mean == test::near(0.5, 2e-3));
    CHECK(statistics.root_mean_square == test::near(0.5, 2e-3));
    CHECK(statistics.greatest == test::near(0.5, 1e-2));
}

TEST_CASE("crimp of a drawn plain weave is that of its cosine, equal for warp and weft") {
    const FabricParameters fabric = small_fabric(4, 7);
    const double amplitude = 0.1;
    const observe::Snapshot snapshot = woven_snapshot(fabric, amplitude);
    const CrimpMeasures crimp = crimp_measures(snapshot, fabric);
    // Between crossings a half period of amplitude cos(pi x / spacing): a sine of the same amplitude, shifted.
    const double exact = sine_length(amplitude, pi / 0.88, 0.88) / 0.88 - 1.0;
    CHECK(crimp.weft == test::near(crimp.warp, 1e-9));
    REQUIRE(crimp.warp_tows.size() == 4);
    for (const double tow : crimp.warp_tows) CHECK(tow == test::near(exact, 5e-3));
    // Fibres beside the centre line run on parallel curves: longer outside a bend by as much as shorter inside the
    // next.
    CHECK(crimp.warp == test::near(exact, 5e-3));
    CHECK(crimp.fibres.size() == 56);
}

TEST_CASE("the same amplitude with longer floats gives a twill less crimp than a plain weave") {
    const FabricParameters plain = small_fabric(4, 7), twill = small_fabric(4, 7, Pattern::named("twill22"));
    CHECK(crimp_measures(woven_snapshot(twill, 0.1), twill).warp < 0.8 * crimp_measures(woven_snapshot(plain, 0.1), plain).warp);
}

TEST_CASE("a fabric is as thick as its two layers of tows") {
    const FabricParameters fabric = small_fabric(4, 7);
    const double amplitude = 0.12;
    const observe::Snapshot snapshot = woven_snapshot(fabric, amplitude);
    // The quadratic elements overshoot the drawn path by less than a hundredth of a radius.
    CHECK(thickness(snapshot, fabric) == test::near(2.0 * amplitude + fabric.warp.packing().thickness, 4e-4 / 0.4));
    observe::Snapshot loose = snapshot;  // a free end that stands up does not count
    loose.fibres[0].position.front().z() += 1.0;
    CHECK(thickness(loose, fabric) == test::near(thickness(snapshot, fabric), 1e-12));
}

TEST_CASE("the hull of seven touching discs is a hexagon with rounded corners") {
    const double r = 0.04;
    std::vector<SectionEllipse> discs;
    for (const Vec2& centre : compact_packing(7, r, 1.0, 0.0).centres)
        discs.push_back({centre + Vec2{3.0, -2.0}, {r, 0.0}, {0.0, r}});
    const TowSection section = section_of(discs);
    const double hull = (6.0 * std::sqrt(3.0) + 12.0 + pi) * r * r;  // hexagon of side 2 r, and a border r wide
    CHECK(section.fibre_area == test::near(7.0 * pi * r * r, 1e-12));
    CHECK(section.area == test::near(hull, 2e-4));
    CHECK(section.fibre_volume_fraction == test::near(7.0 * pi * r * r / hull, 2e-4));
    CHECK((section.centroid - Vec2{3.0, -2.0}).norm() < 1e-9);
    CHECK(section.second_moments(0, 0) == test::near(section.second_moments(1, 1), 1e-3));
}

TEST_CASE("a tilted ellipse is found with its axes, area and second moments") {
    const double a = 0.3, b = 0.1, angle = 0.4;
    const Vec2 long_axis{std::cos(angle), std::sin(angle)}, short_axis{-std::sin(angle), std::cos(angle)};
    const TowSection section = section_of({{{1.0, 2.0}, a * long_axis, b * short_axis}});
    CHECK(section.area == test::near(pi * a * b, 1e-12));  // polygons of equal area
    CHECK(section.fibre_volume_fraction == test::near(1.0, 1e-12));
    CHECK(section.width == test::near(2.0 * a, 1e-3));
    CHECK(section.thickness == test::near(2.0 * b, 1e-3));
    CHECK(section.aspect == test::near(3.0, 1e-3));
    CHECK(long_axis.dot(section.second_moments * long_axis) == test::near(pi * a * a * a * b / 4.0, 1e-3));
    CHECK(short_axis.dot(section.second_moments * short_axis) == test::near(pi * a * b * b * b / 4.0, 1e-3));
    CHECK(std::abs(long_axis.dot(section.second_moments * short_axis)) < 1e-12);
}

TEST_CASE("the section of a tow across its own path is its packing, also where it climbs") {
    const FabricParameters fabric = small_fabric(4, 19);
    const observe::Snapshot snapshot = woven_snapshot(fabric, 0.12);
    std::vector<SectionEllipse> discs;
    const double r = fabric.warp.fibre_radius;
    for (const Vec2& centre : fabric.warp.packing().centres) discs.push_back({centre, {r, 0.0}, {0.0, r}});
    const double area = section_of(discs).area;
    for (const Family family : {Family::warp, Family::weft}) {
        for (const double t : {20.0, 32.0, 38.4}) {  // level, half way up, at a crossing
            const TowSection section = tow_section(snapshot, fabric, family, 1, t);
            CHECK(section.fibres.size() == 19);
            CHECK(section.area == test::near(area, 1e-2));  // planes across fibres turn a little within the tow
            CHECK(section.fibre_area == test::near(19.0 * pi * r * r, 1e-2));
        }
    }
}

TEST_CASE("a snapshot of another fabric is refused") {
    const FabricParameters fabric = small_fabric(4, 7);
    observe::Snapshot snapshot = woven_snapshot(fabric, 0.1);
    snapshot.fibres.pop_back();
    CHECK(test::refusal([&] { crimp_measures(snapshot, fabric); }) ==
          "Snapshot.fibres = 55, but it must be those of the fabric, 56");
    snapshot = woven_snapshot(fabric, 0.1);
    snapshot.fibres[3].position.resize(33);
    CHECK(test::refusal([&] { thickness(snapshot, fabric); }) ==
          "Snapshot.fibres[3].position = 33 nodes, but it must be of 65 nodes");
}

TEST_CASE("the woven part lies between the middles of the outermost tows of either family") {
    FabricParameters fabric = small_fabric(4, 7);
    fabric.weft_tows = 2;
    const Outline part = outline(woven_snapshot(fabric, 0.1), fabric);
    CHECK(part.x_to - part.x_from == test::near(fabric.weft_spacing, 1e-9));
    CHECK(part.y_to - part.y_from == test::near(3.0 * fabric.warp_spacing, 1e-9));
}

}  // namespace measures_test

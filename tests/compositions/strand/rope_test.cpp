// SPDX-License-Identifier: MIT
// Strands wound around each other. Their wires are helices about helices; what they carry is held to what wires carry that keep
// their distance from the axis.

#include <compositions/strand/drawn_rope.hpp>
#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace rope_test {

namespace strand = compositions::strand;
const double degree = std::numbers::pi / 180.0;

TEST_CASE("a wire goes round its core at its lay angle, the core round the axis at its own, and both close after a turn") {
    const strand::WireLine line{.helix_radius = 6.2,
                                .lay = 14.0 * degree,
                                .start = 0.4,
                                .distance = 2.0,
                                .rate = std::tan(-12.0 * degree) / 2.0,
                                .phase = 1.1,
                                .radius = 1.0};
    strand::WireLine core = line;
    core.distance = 0.0;
    for (double s = 0.0; s < 100.0; s += 3.7) {
        const double h = 1e-5;
        const Vec3 slope = (line.place(s + h) - line.place(s - h)) / (2.0 * h), along = core.at(s).derivative;
        CHECK((slope - line.at(s).derivative).norm() < 1e-8);
        CHECK(along.norm() == test::near(1.0, 1e-12));
        CHECK(std::acos(along.z()) == test::near(line.lay, 1e-12));
        const Vec3 arm = line.place(s) - core.place(s);
        CHECK(arm.norm() == test::near(2.0, 1e-12));
        CHECK(std::abs(arm.dot(along)) < 1e-12);  // in the core's section
        // What is across core and arm, over what is along the core where the core is as long: the tangent of the lay angle,
        // whatever the place.
        CHECK(line.at(s).derivative.dot(along.cross(arm).normalized()) == test::near(std::tan(-12.0 * degree), 1e-9));
    }
    // A turn of the core about the axis turns a section that does not turn about the core by the angle that a helix leaves open:
    // 2 pi (1 - cos).
    const double turn = 2.0 * std::numbers::pi * 6.2 / std::sin(line.lay);
    strand::WireLine idle = line;
    idle.rate = 0.0;
    const Vec3 then = idle.place(0.0) - core.place(0.0), after = idle.place(turn) - core.place(turn);
    CHECK(std::acos(then.dot(after) / 4.0) == test::near(2.0 * std::numbers::pi * (1.0 - std::cos(line.lay)), 1e-9));
    CHECK(line.place(line.at_height(17.0)).z() == test::near(17.0, 1e-12));
}

TEST_CASE("in lang lay the outermost place of a wire leans with its strand, in ordinary lay against it") {
    for (const double rope_lay : {14.6, -14.6})
        for (const double wire_lay : {13.0, -13.0}) {
            strand::RopeParameters rope = strand::rope_of_seven(1.0, wire_lay, rope_lay, 54.0, 0.02);
            const strand::WireLine wire = rope.lines(1)[1], core = rope.lines(1)[0];  // at the height 0 it is outside its core
            const Vec3 out = core.place(0.0).normalized(), around = Vec3::UnitZ().cross(out), slope = wire.at(0.0).derivative;
            CHECK((wire.place(0.0) - core.place(0.0)).dot(out) == test::near(wire.distance, 1e-12));
            // Its core's line is longer there by the bend: 1 + distance * curvature.
            const double longer = 1.0 + wire.distance * std::pow(std::sin(rope_lay * degree), 2) / rope.layers[0].helix_radius;
            CHECK(std::atan2(slope.dot(around), slope.z()) ==
                  test::near(rope_lay * degree + std::atan(std::tan(wire_lay * degree) / longer), 1e-9));
        }
}

TEST_CASE("the least distance of two wires is that of all their points") {
    const strand::RopeParameters rope = strand::rope_of_seven(1.0, -13.0, 14.6, 54.0, 0.02);
    const auto brute = [&](const strand::WireLine& one, const strand::WireLine& other) {
        const int steps = 4000, window = 120;
        const auto point = [&](const strand::WireLine& line, int k) {
            return line.place(line.at_height(0.0) +
                              static_cast<double>(k) / steps * (line.at_height(54.0) - line.at_height(0.0)));
        };
        std::vector<Vec3> there;
        for (int k = 0; k <= steps; ++k) there.push_back(point(other, k));
        double least = 1e9;
        for (int k = 0; k <= steps; k += 2) {
            const Vec3 here = point(one, k);
            for (int n = std::max(0, k - window); n <= std::min(steps, k + window); ++n)
                least = std::min(least, (here - there[core::at(n)]).norm());
        }
        return least - one.radius - other.radius;
    };
    const auto middle = rope.lines(0), first = rope.lines(1), second = rope.lines(2);
    for (const auto& [one, other] : {std::pair{middle[2], first[5]},
                                     {middle[3], first[4]},
                                     {first[1], first[2]},
                                     {first[2], second[5]},
                                     {first[0], first[4]},
                                     {first[3], second[6]}}) {
        const double found = strand::least_gap(one, other, 54.0), all = brute(one, other);
        CHECK(found < all + 1e-9);
        CHECK(found > all - 1e-3);  // points of the brute search are 0.013 and 0.027 apart
        CHECK(std::abs(strand::least_gap(other, one, 54.0) - found) < 1e-6);       // of a wire's radius
        CHECK(strand::least_gap(one, other, 54.0, found - 0.01) == found - 0.01);  // not below what is known
    }
}

TEST_CASE("strands are laid up as tightly as their wires allow, and wires that are in each other are refused") {
    for (const double wire_lay : {13.0, -13.0})
        for (const double overlap : {0.0, 0.01}) {
            strand::RopeParameters rope = strand::rope_of_seven(1.0, wire_lay, 14.6, 54.0, 0.02, overlap);
            rope.material = {200000.0, 0.3};
            CHECK(rope.wires() == 49);
            CHECK(std::abs(strand::detail::gap_inside(rope, 0, 1.0) + overlap) < 1e-5);  // of a wire's radius
            CHECK(std::abs(strand::detail::gap_beside(rope, 0, 1.0) - (0.02 - overlap)) < 1e-5);
            CHECK(strand::least_gap(rope) > -overlap - 1e-6);
            CHECK_NOTHROW(rope.validate());
            // Strands rest on each other where an outermost wire of the one crosses one of the other, and are as far apart as
            // round ones there.
            CHECK(rope.layers[0].helix_radius ==
                  test::near(strand::detail::thickness(rope.core) + strand::detail::thickness(rope.layers[0].strand) - overlap,
                             1e-5));
            const scene::Assembly assembly = strand::wires_of(rope);
            CHECK(core::count(assembly.fibres()) == 49);
            CHECK(core::count(assembly.groups()) == 7);
            rope.layers[0].helix_radius -= 0.05;
            CHECK(test::refusal([&] { rope.validate(); }).find("RopeParameters: least gap between wires = -0.0") == 0);
        }
    // Three wires in the place of three strands: circles that touch each other about the axis, at a lay that leaves them little
    // more room.
    strand::RopeParameters plain;
    plain.core.core_radius = 0.1, plain.length = 30.0, plain.material = {200000.0, 0.3};
    plain.layers = {{.strands = 3, .strand = {.core_radius = 1.0, .layers = {}}, .lay_angle_deg = 1.0}};
    strand::lay_up(plain);
    CHECK(plain.layers[0].helix_radius == test::near(2.0 / std::sqrt(3.0), 1e-3));
}

TEST_CASE("a rope of single wires is a strand") {
    strand::StrandParameters wires;  // strand_1_6.json, 15 degrees
    wires.core_radius = 0.022, wires.layers = {{.wires = 6, .radius = 0.0201, .lay_angle_deg = 15.0}};
    strand::RopeParameters rope;
    rope.core.core_radius = 0.022;
    rope.layers = {
        {.strands = 6, .strand = {.core_radius = 0.0201, .layers = {}}, .lay_angle_deg = 15.0, .helix_radius = 0.0421}};
    rope.material = wires.material = {7300.0, 0.3};
    rope.length = wires.length = 0.98720992227, rope.elements = wires.elements = 24;
    const scene::Assembly one = strand::straight_strand(wires), other = strand::straight_rope(rope);
    REQUIRE(one.fibres().size() == other.fibres().size());
    REQUIRE(one.holds().size() == other.holds().size());
    for (std::size_t k = 1; k < one.fibres().size(); ++k)
        for (double t = 0.0; t <= 1.0; t += 0.125) CHECK((one.fibres()[k].curve(t) - other.fibres()[k].curve(t)).norm() < 1e-12);
    for (std::size_t k = 0; k < one.holds().size(); ++k)
        CHECK((one.holds()[k].directions - other.holds()[k].directions).norm() < 1e-9);
    // What the reference, whose rods bend and twist, has more or less than tensions on their helices: 3e-4 in the force and 4e-3
    // in the torque of a wire that does not contract.
    const strand::RopeStiffness bound = strand::stiffness_bound(rope);
    const double c = std::cos(15.0 * degree), area = std::numbers::pi * 7300.0;
    CHECK(bound.force_by_strain == test::near(area * (0.022 * 0.022 + 6.0 * 0.0201 * 0.0201 * c * c * c), 1e-9));
    CHECK(bound.torque_by_strain == test::near(6.0 * area * 0.0201 * 0.0201 * c * c * std::sin(15.0 * degree) * 0.0421, 1e-9));
    CHECK(59.03860839 < bound.force_by_strain);  // k11: sections contract
}

TEST_CASE("a rope that has settled carries nearly what wires carry that keep their distance from its axis") {
    const test::Drawn lang = test::draw(test::three_strands(13.0, 12.0, 20.0, 7), 0.1);
    // The bound holds for small strains; St Venant-Kirchhoff's law has 1.5 times the strain in it at each strain, 3 times in a
    // difference.
    CHECK(lang.force < 1.0 + 3.0 * 0.0045 + 5e-3);
    CHECK(lang.force > 0.9);
    CHECK(std::abs(lang.torque / lang.bound_torque - 1.0) < 0.15);
}

}  // namespace rope_test

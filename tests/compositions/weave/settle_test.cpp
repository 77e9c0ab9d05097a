// SPDX-License-Identifier: MIT
// Settling small fabrics to their rest: what two fibres may be deep in each other holds anywhere along them.
#include "near.hpp"
#include "small_weave.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/simulation/audit.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

using namespace fibrant;

namespace settle_test {

namespace cloth = fibrant::compositions::weave;

using Model = test::SmallWeave;
using test::small_fabric;

TEST_CASE("a settled fabric's fibres cross as the pattern says and are nowhere deeper in each other than allowed") {
    const cloth::SettleParameters settle;
    simulation::Simulator<Model> simulator(cloth::flat_fabric(small_fabric(), settle.tension_strain),
                                           cloth::model_parameters<Model>(small_fabric(), settle));
    const simulation::Report report = simulator.run(cloth::settling<Model>(small_fabric(), settle));
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double r = cloth::smallest_radius(small_fabric());
    const cloth::Audit audit = cloth::audit(simulator.snapshot(), small_fabric(), proximity::GridSearch());
    std::printf("%td increments, %td Newton iterations, deepest contact %.5f, least gap %.5f radii, %.1f s\n",
                core::count(report.increments), report.counts.newton, report.contact.greatest_penetration / r,
                audit.least_gap.gap_over_radius, report.wall_seconds);
    CHECK(audit.crossings == 100);  // 10 warp fibres over or under 10 weft fibres
    CHECK(audit.clean(settle.allowed_penetration_over_radius * r));
    CHECK(audit.least_gap.gap < 0.0);  // fibres touch: the bound is one that could be broken
    // What rest ends with is an answer: it balances to what is stated, however loose the way was.
    CHECK(report.most_use.residual > 1.0);
    CHECK(report.use.greatest() <= 1.0);
}

TEST_CASE(
    "a fabric is at rest once forces balance and no two fibres are deeper in each other than allowed, whatever contact points "
    "say") {
    const cloth::SettleParameters settle;
    const double allowed = settle.allowed_penetration_over_radius * cloth::smallest_radius(small_fabric());
    const simulation::Loading<Model> loading = cloth::settling<Model>(small_fabric(), settle);
    const simulation::Stage<Model>& rest = loading.stages.back();
    REQUIRE(rest.deepest.has_value());
    CHECK(*rest.deepest == allowed);
    simulation::IncrementReport increment;  // moves nothing
    increment.contact.greatest_penetration = 1.5 * allowed;
    CHECK(rest.until(increment));
    increment.displacement = 2.0 * settle.rest_motion_over_radius * cloth::smallest_radius(small_fabric()),
    increment.damping = 2.0 * settle.rest_share;
    CHECK_FALSE(rest.until(increment));
}

TEST_CASE("tows part at no more tension than fibres of that many elements can turn under") {
    cloth::FabricParameters fabric = small_fabric();
    CHECK(cloth::parting_tension(fabric, 2e-3) == 1.0);
    // E I / T = f r^2 / (4 strain) of round fibres; a third of an element is 0.3 L / n.
    fabric.warp.inertia_factor = 1e-4;
    const double turn = 0.3 * fabric.fibre_length(cloth::Family::warp) / 12.0;
    CHECK(std::abs(cloth::parting_tension(fabric, 2e-3) / (1e-4 * 0.04 * 0.04 / (4.0 * 2e-3 * turn * turn)) - 1.0) < 1e-12);
    CHECK(std::abs(cloth::parting_tension(fabric, 4e-3) / cloth::parting_tension(fabric, 2e-3) - 0.5) < 1e-12);
}

TEST_CASE("contact on the way is as soft as allowed, but no softer than what parts tows") {
    cloth::SettleParameters settle;
    const double r = cloth::smallest_radius(small_fabric());
    const auto soft = [&] { return *cloth::settling<Model>(small_fabric(), settle).stages[1].allowed_penetration / r; };
    CHECK(std::abs(soft() / 0.05 - 1.0) < 1e-12);  // five times 0.01, which is a fifth of the gap limit
    settle.allowed_penetration_over_radius = 0.002;
    CHECK(std::abs(soft() / 0.01 - 1.0) < 1e-12);
    settle.allowed_penetration_over_radius = 0.04;
    CHECK(std::abs(soft() / 0.05 - 1.0) < 1e-12);
    settle.allowed_penetration_over_radius = 0.2;
    CHECK(std::abs(soft() / 0.2 - 1.0) < 1e-12);
}

TEST_CASE("ends that have no room to come back to the plane are held beside each other, as the last crossing asks") {
    cloth::FabricParameters fabric = small_fabric();
    for (const scene::FibreSpecification& fibre : cloth::flat_fabric(fabric, 2e-3).fibres()) CHECK_FALSE(fibre.start);
    fabric.warp.fibres = fabric.weft.fibres = 1;
    const double r = fabric.warp.fibre_radius;
    for (const double over_radius : {1.05, 1.2, 1.4}) {  // in the plane two ends of a corner would be less than 2 r apart
        fabric.overhang = over_radius * r;
        const auto fibres = cloth::flat_fabric(fabric, 2e-3).fibres();
        for (const double end : {0.0, 1.0}) {
            const auto& warp = end > 0.5 ? fibres[core::at(fabric.warp_tows - 1)] : fibres.front();
            const auto& weft = end > 0.5 ? fibres.back() : fibres[core::at(fabric.warp_tows)];
            const Vec3 a = warp.start(end), b = weft.start(end);
            CHECK((warp.start(1.0) - warp.start(0.0)).norm() == test::near(fabric.fibre_length(cloth::Family::warp), 1e-12));
            CHECK((a - b).head<2>().norm() < 2.0 * r);
            CHECK((a - b).norm() > 2.0 * r);
            const Index tow = end > 0.5 ? fabric.warp_tows - 1 : 0, across = end > 0.5 ? fabric.weft_tows - 1 : 0;
            CHECK((a.z() > b.z()) == fabric.pattern.over(tow, across));
        }
    }
}

TEST_CASE("what is far deeper than it is shown is parted in longer increments, as long as that goes with ease") {
    const cloth::SettleParameters settle;
    cloth::FabricParameters fabric = small_fabric();
    const double whole_radius = 1.0 / settle.gap_limit_over_radius;  // a radius an increment
    CHECK(cloth::settling<Model>(fabric, settle).stages[1].largest_fraction == test::near(whole_radius, 1e-12));
    fabric.weft.fibre_radius *= 0.1;
    const simulation::Stage<Model> separation = cloth::settling<Model>(fabric, settle).stages[1];
    CHECK(separation.largest_fraction == test::near(5.5, 1e-12));  // the mean of 1 and 10
    simulation::Position position;
    position.progress = 1.0;
    simulation::IncrementReport increment;
    increment.contact.greatest_penetration = 100.0 * *separation.gap_limit;
    const simulation::HalvedSteps steps;
    const auto easy = [&] {
        steps.grow(position, separation, increment, 1.5, 0.2), steps.grow(position, separation, increment, 1.5, 0.2);
    };
    easy();
    CHECK(position.stride() == test::near(1.5, 1e-12));
    for (int k = 0; k < 10; ++k) easy();
    CHECK(position.stride() == separation.largest_fraction);
    steps.give_way(position, separation, {}, 0.0, 1);
    CHECK(position.stride() == test::near(2.75, 1e-12));
    CHECK(position.damping == 1.0);
    for (int k = 0; k < 2; ++k) steps.grow(position, separation, increment, 1.5, 0.9);  // solved with effort
    CHECK(position.stride() == test::near(2.75, 1e-12));
    increment.contact.greatest_penetration = 6.0 * *separation.gap_limit;  // a quarter of what is left
    easy();
    CHECK(position.stride() == test::near(1.5, 1e-12));
}

TEST_CASE("fibres that hardly resist bending are given more iterations") {
    const cloth::SettleParameters settle;
    cloth::FabricParameters fabric = small_fabric();
    CHECK(cloth::settling<Model>(fabric, settle).stages[1].patience == 1.0);
    fabric.warp.inertia_factor *= 0.101 / (cloth::parting_tension(fabric, 2.0) * 1e3);  // just above a tenth of what is asked for
    CHECK(cloth::parting_tension(fabric, settle.tension_strain) == test::near(0.101, 1e-9));
    CHECK(cloth::settling<Model>(fabric, settle).stages[1].patience == 1.0);
    fabric.warp.inertia_factor *= 0.98;
    CHECK(cloth::settling<Model>(fabric, settle).stages[1].patience == 2.0);
}

// Two layers of three fibres, 0.3 of a radius deep in each other, ends held: nothing says which way they part but where they lie.
scene::Assembly two_layers(double radius, double spacing) {
    scene::Assembly assembly;
    for (const bool upper : {false, true})
        for (int k = -1; k <= 1; ++k) {
            const Vec3 along = upper ? Vec3(Vec3::UnitY()) : Vec3(Vec3::UnitX()),
                       across = upper ? Vec3(Vec3::UnitX()) : Vec3(Vec3::UnitY());
            const Vec3 middle = spacing * k * across + (upper ? 1.7 * radius : 0.0) * Vec3::UnitZ();
            scene::FibreSpecification fibre;
            fibre.from = middle - 1.5 * spacing * along, fibre.to = middle + 1.5 * spacing * along;
            fibre.section = scene::circular(radius), fibre.material = {7300.0, 0.3}, fibre.elements = 8;
            const Index f = assembly.add(fibre);
            assembly.hold_position(scene::first_end(f)), assembly.hold_position(scene::last_end(f));
            assembly.hold_axial_rotation(scene::first_end(f));
        }
    return assembly;
}

TEST_CASE("any assembly settles by numbers that it gives itself") {
    const double r = 0.04, spacing = 0.6, bending = 7300.0 * scene::circular(r).second_moment_1();
    const scene::Assembly layers = two_layers(r, spacing);
    const auto scales = simulation::scales_of(layers, {}, proximity::GridSearch());
    CHECK(scales.radius == r);
    CHECK(scales.slack ==
          test::near(48.0 * bending / std::pow(spacing, 3), 1e-12));  // three crossings on three spacings of length
    CHECK(scales.taut == scales.slack);                               // nothing pulls
    CHECK(scales.driven);
    const auto loading = simulation::settling<Model>(layers);
    CHECK(loading.stages.front().damping == test::near(0.1 / 0.25 * scales.slack, 1e-12));
    simulation::Simulator<Model> simulator(layers, simulation::settling_parameters<Model>(r, {}));
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    CHECK(report.converged);
    const simulation::Audit audit = simulation::audit(simulator, 0.01 * r);
    CHECK(audit.clean());
    CHECK(audit.least_gap.gap < 0.0);
}

TEST_CASE("fibres of a tow that crosses count once, and its pull is that of its ends") {
    const cloth::FabricParameters fabric = small_fabric();
    const double strain = 2e-3, length = fabric.fibre_length(cloth::Family::warp),
                 span = length / static_cast<double>(fabric.weft_tows);
    const auto scales =
        simulation::scales_of(cloth::flat_fabric(fabric, strain), {cloth::tension_channel, true}, proximity::GridSearch());
    const double area = std::numbers::pi * fabric.warp.fibre_radius * fabric.warp.fibre_radius,
                 pull = strain * fabric.warp.material.young_modulus * area;
    const double bending = fabric.warp.material.young_modulus * fabric.warp.inertia_factor * 0.25 * area *
                           fabric.warp.fibre_radius * fabric.warp.fibre_radius;
    CHECK(scales.slack == test::near(48.0 * bending / std::pow(span, 3), 1e-9));
    CHECK(scales.taut - scales.slack == test::near(4.0 * pull * static_cast<double>(fabric.elements) / length, 1e-9));
    CHECK(scales.ordered);
    CHECK(scales.over_softest.empty());
    cloth::FabricParameters mixed = fabric;  // wefts of a hundredth: springs on warps are as much stiffer as these are
    mixed.weft.material.young_modulus /= 100.0;
    const cloth::SettleParameters settle;
    const auto loading = cloth::settling<Model>(mixed, settle), equal = cloth::settling<Model>(fabric, settle);
    REQUIRE(core::count(loading.damping_of_fibres) == fabric.fibres());
    CHECK(loading.stages[1].damping == test::near(equal.stages[1].damping / 100.0, 1e-12));
    CHECK(loading.damping_of_fibres.front() == test::near(100.0, 1e-12));
    CHECK(loading.damping_of_fibres.back() == 1.0);
}

TEST_CASE("fibres that are held on the wrong side of their order are given up once 60 increments have parted nothing, by name") {
    // At a right angle, middles held half a radius apart, the first one below: nothing takes it above the second.
    constexpr double radius = 0.05;
    scene::Assembly assembly;
    const Index first = assembly.add_group("first"), second = assembly.add_group("second");
    for (const Index k : {0, 1}) {
        const Vec3 middle = 0.5 * radius * static_cast<double>(k) * Vec3::UnitZ(),
                   half = 20.0 * radius * (k == 0 ? Vec3::UnitX() : Vec3::UnitY());
        const Index fibre = assembly.add({.from = middle - half,
                                          .to = middle + half,
                                          .section = scene::circular(radius),
                                          .material = {1e4, 0.3},
                                          .elements = 10,
                                          .director = Vec3::UnitZ(),
                                          .group = k == 0 ? first : second});
        assembly.clamp(scene::first_end(fibre)), assembly.clamp(scene::last_end(fibre));
        assembly.hold_position({fibre, 0.5});
    }
    assembly.force_order({first, second, Vec3::UnitZ()});
    const simulation::SettleParameters settle;
    simulation::Simulator<Model> simulator(assembly, simulation::settling_parameters<Model>(radius, settle));
    const simulation::Report report = simulator.run(simulation::settling<Model>(assembly, settle));
    CAPTURE(report.reason);
    CHECK_FALSE(report.converged);
    CHECK(core::count(report.increments) < settle.separation_increments);
    CHECK(report.reason.find("stage separation did not reach its end in ") == 0);
    CHECK(report.reason.find(", the last 60 of which parted nothing: fibre 0 and fibre 1 are ") != std::string::npos);
}

}  // namespace settle_test

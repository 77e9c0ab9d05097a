// SPDX-License-Identifier: MIT
#include "refusal.hpp"

#include <fibrant/scene/assembly.hpp>

#include <doctest/doctest.h>

#include <numbers>

using namespace fibrant;

namespace assembly_test {

using test::refusal;

scene::FibreSpecification fibre() {
    scene::FibreSpecification f;
    f.from = Vec3::Zero(), f.to = Vec3::UnitX();
    f.section = scene::circular(0.02);
    f.material = {7300.0, 0.3};
    f.elements = 4;
    return f;
}
template <class Change>
std::string refused(const Change& change) {
    return refusal([&] {
        scene::Assembly assembly;
        scene::FibreSpecification f = fibre();
        change(f);
        assembly.add(f);
    });
}

TEST_CASE("fibres and groups are numbered in the order in which they are added") {
    scene::Assembly assembly;
    const Index all = assembly.add_group("all"), part = assembly.add_group("part", all);
    scene::FibreSpecification f = fibre();
    f.group = part;
    CHECK(assembly.add(f) == 0);
    CHECK(assembly.add(fibre()) == 1);
    CHECK(assembly.fibres()[0].group == part);
    CHECK(assembly.fibres()[1].group == -1);
    CHECK(assembly.groups()[1].parent == all);
    CHECK(assembly.groups()[1].name == "part");
}

TEST_CASE("a fibre that cannot be is refused before any work, by field, value and bound") {
    CHECK(refused([](auto& f) { f.section = {}; }).starts_with("CrossSection.semi_axis_1 = nan, but it must be"));
    CHECK(refused([](auto& f) { f.section.semi_axis_2 = -0.02; }) ==
          "CrossSection.semi_axis_2 = -0.02, but it must be finite and > 0 (fibre 0)");
    CHECK(refused([](auto& f) { f.material = {}; }).starts_with("ElasticMaterial.young_modulus = nan"));
    CHECK(refused([](auto& f) { f.elements = 0; }) == "fibre.elements = 0, but it must be >= 1 (fibre 0)");
    CHECK(refused([](auto& f) { f.to = Vec3(0, core::unset, 0); }) == "fibre.to = (0, nan, 0), but it must be finite (fibre 0)");
    CHECK(refused([](auto& f) { f.from = scene::FibreSpecification{}.from; }) ==
          "fibre.from = (nan, nan, nan), but it must be finite (fibre 0)");
    CHECK(refused([](auto& f) { f.group = 0; }) == "fibre.group = 0, but it must be -1 or a group of this assembly (fibre 0)");
    CHECK(refused([](auto& f) { f.group = -2; }).starts_with("fibre.group = -2"));
    CHECK(refused([](auto&) {}).empty());
}

TEST_CASE("groups, stations, loads and orders must name what the scene has") {
    scene::Assembly assembly;
    CHECK(refusal([&] { assembly.add_group("lost", 3); }) == "group.parent = 3, but it must be -1 or an earlier group");
    const Index f = assembly.add(fibre());
    CHECK(refusal([&] { assembly.hold_position({7, 0.0}); }) == "Station.fibre = 7, but it must be a fibre of this assembly");
    CHECK(refusal([&] { assembly.hold_position({f, 1.5}); }) == "Station.fraction = 1.5, but it must be in [0, 1] (fibre 0)");
    CHECK(refusal([&] { assembly.hold_position({f, core::unset}); }).starts_with("Station.fraction = nan"));
    CHECK(refusal([&] {
              assembly.apply(scene::DeadForce{scene::first_end(f), {}, Vec3(0, core::unset, 0), "load"});
          }) == "DeadForce.force = (0, nan, 0), but it must be finite (fibre 0, at 0 of its length)");
    CHECK(refusal([&] {
              assembly.apply(scene::Moment{scene::first_end(f), scene::NodeVector::position, Vec3::UnitX(), "load"});
          }) == "Moment.director = position, but it must be a director (fibre 0, at 0 of its length)");
    const Index group = assembly.add_group("one");
    CHECK(refusal([&] {
              assembly.force_order({group, group + 1, Vec3::UnitZ()});
          }) == "ForcedOrder.group = 1, but it must be a group of this assembly");
}

TEST_CASE("a clamp holds position and rotation of a section, and leaves it free to stretch") {
    scene::Assembly assembly;
    const Index f = assembly.add(fibre());
    assembly.clamp(scene::first_end(f));
    REQUIRE(assembly.holds().size() == 3);
    const scene::Hold &position = assembly.holds()[0], &first = assembly.holds()[1], &second = assembly.holds()[2];
    CHECK(position.directions == Mat3::Identity());
    CHECK(first.vector == scene::NodeVector::director_1);
    CHECK(first.directions.diagonal() == Vec3(0, 1, 1));
    CHECK(second.vector == scene::NodeVector::director_2);
    CHECK(second.directions.diagonal() == Vec3(1, 0, 1));
    CHECK(!position.rotation);
    assembly.clamp(scene::last_end(f), Vec3::Zero(), Vec3(0, 0, 0.5 * std::numbers::pi));
    const Mat3 half = assembly.holds()[3].rotation(0.5);  // a quarter turn, half way
    CHECK((half * Vec3::UnitX() - Vec3(1, 1, 0).normalized()).norm() < 1e-15);
}

}  // namespace assembly_test

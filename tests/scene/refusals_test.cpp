// SPDX-License-Identifier: MIT
// What a scene is refused for: a table of wrong values, each said by fibre or part, place, value and bound.
#include "refusal.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/mesh.hpp>
#include <fibrant/scene/assembly.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

using namespace fibrant;

namespace refusals_test {

constexpr double nan = core::unset, inf = std::numeric_limits<double>::infinity();
using Beam = beam::DirectorBeam<3>;

scene::FibreSpecification fibre() {
    return {
        .from = Vec3::Zero(), .to = Vec3(10, 0, 0), .section = scene::circular(0.1), .material = {1000.0, 0.3}, .elements = 10};
}

/// Two fibres, the second one named, two groups, a body and a cell.
scene::Assembly scene_of_two() {
    scene::Assembly assembly;
    assembly.add_group("lower"), assembly.add_group("upper");
    assembly.add(fibre());
    scene::FibreSpecification second = fibre();
    second.name = "core", second.group = 1;
    assembly.add(second);
    assembly.add(scene::RigidBody{.name = "grip"});
    assembly.add(scene::PeriodicCell{.name = "period"});
    return assembly;
}

struct Case {
    std::string what;
    std::function<void(scene::Assembly&)> wrong;
    std::vector<std::string> said;  ///< all of these are in the message
};

void check(const std::vector<Case>& cases) {
    for (const Case& one : cases) {
        CAPTURE(one.what);
        scene::Assembly assembly = scene_of_two();
        const std::string message = test::refusal([&] { one.wrong(assembly); });
        CHECK(!message.empty());
        for (const std::string& part : one.said) {
            CAPTURE(message);
            CAPTURE(part);
            CHECK(message.find(part) != std::string::npos);
        }
    }
}

auto fibre_with(const std::function<void(scene::FibreSpecification&)>& change) {
    return [change](scene::Assembly& assembly) {
        scene::FibreSpecification third = fibre();
        third.name = "third";
        change(third);
        assembly.add(third);
        const Beam beam;
        const beam::Mesh<Beam> mesh(assembly, beam);
    };
}
auto hold_with(const std::function<void(scene::Hold&)>& change) {
    return [change](scene::Assembly& assembly) {
        scene::Hold hold;
        hold.at = {1, 0.5};
        change(hold);
        assembly.hold(hold);
    };
}

/// Points joined by straight lines, each passed in the same part of the parameter.
scene::Curve through(std::vector<Vec3> points) {
    return [points](double t) {
        const double place = t * static_cast<double>(points.size() - 1);
        const std::size_t k = std::min(points.size() - 2, static_cast<std::size_t>(place));
        const double part = place - static_cast<double>(k);
        return Vec3((1.0 - part) * points[k] + part * points[k + 1]);
    };
}

TEST_CASE("a fibre that cannot be is refused by its number, its name, the value and the bound") {
    const std::string third = "(fibre 2 'third'";
    check({
        {"no section",
         fibre_with([](auto& f) { f.section = {}; }),
         {"CrossSection.semi_axis_1 = nan, but it must be finite and > 0", third}},
        {"a radius below zero",
         fibre_with([](auto& f) { f.section.semi_axis_2 = -0.1; }),
         {"CrossSection.semi_axis_2 = -0.1", third}},
        {"no radius", fibre_with([](auto& f) { f.section.semi_axis_1 = 0.0; }), {"CrossSection.semi_axis_1 = 0", third}},
        {"an endless radius",
         fibre_with([](auto& f) { f.section.semi_axis_1 = inf; }),
         {"CrossSection.semi_axis_1 = inf", third}},
        {"inertia", fibre_with([](auto& f) { f.section.inertia_factor = 0.0; }), {"CrossSection.inertia_factor = 0", third}},
        {"no modulus",
         fibre_with([](auto& f) { f.material.young_modulus = nan; }),
         {"ElasticMaterial.young_modulus = nan", third}},
        {"a modulus below zero",
         fibre_with([](auto& f) { f.material.young_modulus = -1.0; }),
         {"ElasticMaterial.young_modulus = -1", third}},
        {"an incompressible one",
         fibre_with([](auto& f) { f.material.poisson_ratio = 0.5; }),
         {"ElasticMaterial.poisson_ratio = 0.5", "> -1 and < 0.5", third}},
        {"no ratio", fibre_with([](auto& f) { f.material.poisson_ratio = nan; }), {"ElasticMaterial.poisson_ratio = nan", third}},
        {"no elements", fibre_with([](auto& f) { f.elements = 0; }), {"fibre.elements = 0, but it must be >= 1", third}},
        {"elements below zero", fibre_with([](auto& f) { f.elements = -3; }), {"fibre.elements = -3", third}},
        {"far too many elements",
         fibre_with([](auto& f) { f.elements = 2'000'000'000; }),
         {"fibre.elements = 2000000000", "<= 1000000", third}},
        {"an end that is nowhere",
         fibre_with([](auto& f) { f.to.y() = nan; }),
         {"fibre.to = (10, nan, 0), but it must be finite", third}},
        {"an end at infinity", fibre_with([](auto& f) { f.from.z() = -inf; }), {"fibre.from = (0, 0, -inf)", third}},
        {"ends in one place", fibre_with([](auto& f) { f.to = f.from; }), {"fibre.to: distance from fibre.from = 0", third}},
        {"a director that is none", fibre_with([](auto& f) { f.director.x() = nan; }), {"fibre.director = (nan, 0, 0)", third}},
        {"a group that is not there", fibre_with([](auto& f) { f.group = 7; }), {"fibre.group = 7", third}},
    });
}

TEST_CASE("a curve that is no fibre is refused with the parameter and the point") {
    const std::string third = "(fibre 2 'third'";
    const auto curved = [](const scene::Curve& curve) { return fibre_with([curve](auto& f) { f.curve = curve; }); };
    const auto started = [](const scene::Curve& start) { return fibre_with([start](auto& f) { f.start = start; }); };
    const auto line = [](double t) { return Vec3(10.0 * t, 0, 0); };
    check({
        {"a point that is nowhere",
         curved([](double t) { return Vec3(10.0 * t, t > 0.6 ? nan : 0.0, 0); }),
         {"fibre.curve: point = (", "nan", "at parameter 0.6", third}},
        {"points that repeat",
         curved(through({{0, 0, 0}, {3, 0, 0}, {3, 0, 0}, {6, 0, 0}, {10, 0, 0}})),
         {"fibre.curve: speed = 0", "> 0.0001 of its mean", "at parameter 0.25, point (3, 0, 0)", third}},
        {"points that repeat at the start",
         curved(through({{0, 0, 0}, {0, 0, 0}, {10, 0, 0}})),
         {"speed = 0", "at parameter 0, point (0, 0, 0)", third}},
        {"points that all but repeat",
         curved(through({{0, 0, 0}, {5, 0, 0}, {5 + 1e-5, 0, 0}, {10, 0, 0}})),
         {"speed = ", "at parameter 0.33", "point (5.0", third}},
        {"a start at rest",
         curved([](double t) { return Vec3(10.0 * t * t, 0, 0); }),
         {"speed = ", "at parameter 0, point (0, 0, 0)", third}},
        {"one point", curved([](double) { return Vec3(1, 2, 3); }), {"fibre.curve: length = 0", third}},
        {"a jump",
         curved([](double t) { return Vec3(10.0 * t + (t > 0.52 ? 2.0 : 0.0), 0, 0); }),
         {"fibre.curve: step = 2", "it jumps", "at parameter 0.52", third}},
        {"a corner that no element follows",
         curved(through({{0, 0, 0}, {5, 0, 0}, {2, 3, 0}})),
         {"fibre.curve: turn [degree] = 13", "<= 90 within an element", "element", "from (", third}},
        {"a bend that no section follows",
         curved([](double t) { return Vec3(0.09 * std::cos(3.0 * t), 0.09 * std::sin(3.0 * t), 0); }),
         {"fibre.curve: radius of the section times curvature = 1.1", "<= 1", "element 0", third}},
        {"a longer start",
         started([](double t) { return Vec3(11.0 * t, 0, 0); }),
         {"fibre.start: length over that at rest = 1.1", "within 0.01 of 1", third}},
        {"a shorter start",
         started([](double t) { return Vec3(9.8 * t, 0, 0); }),
         {"fibre.start: length over that at rest = 0.98", third}},
        {"a start that is nowhere",
         started([](double t) { return Vec3(10.0 * t, 0, t < 1.0 ? 0.0 : inf); }),
         {"fibre.start: point = (10, 0, inf)", "at parameter 1", third}},
        {"a start that stands still",
         started(through({{0, 0, 0}, {5, 0, 0}, {5, 0, 0}, {10, 0, 0}})),
         {"fibre.start: speed = 0", third}},
    });
    for (const scene::Curve& curve : {scene::Curve(line), scene::Curve([](double t) { return Vec3(0, 5.0 * (t + t * t), 0); })}) {
        scene::Assembly assembly;
        CHECK(test::refusal([&] { curved(curve)(assembly); }).empty());
    }
}

TEST_CASE("points of a curve may be a hundred times closer here than there, and nodes are equally far apart all the same") {
    std::vector<Vec3> points;
    for (const double x : {0.0, 1.0, 2.0, 2.02, 2.04, 5.0, 5.03, 9.0, 10.0}) points.emplace_back(x, 0, 0);
    scene::Assembly assembly;
    scene::FibreSpecification f = fibre();
    f.curve = through(points);
    assembly.add(f);
    const Beam beam;
    const beam::Mesh<Beam> mesh(assembly, beam);
    // A hundredth of the distance of two nodes is what is let pass.
    for (Index n = 0; n <= 20; ++n) CHECK(std::abs(mesh.frame(0, n).position.x() - 0.5 * static_cast<double>(n)) < 0.01);
    for (Index n = 0; n < 20; ++n)
        CHECK(std::abs((mesh.frame(0, n + 1).position - mesh.frame(0, n).position).norm() / 0.5 - 1.0) < 0.01);
}

TEST_CASE("holds that are no projector, or go nowhere, are refused by fibre and place") {
    const std::string core = "(fibre 1 'core', at 0.5 of its length)";
    check({
        {"no projector",
         hold_with([](auto& h) { h.directions = 2.0 * Mat3::Identity(); }),
         {"Hold.directions: P P^T - P = 2", core}},
        {"not symmetric",
         hold_with([](auto& h) { h.directions = Mat3::Zero(), h.directions(0, 0) = h.directions(0, 1) = 1.0; }),
         {"Hold.directions", core}},
        {"no number", hold_with([](auto& h) { h.directions(2, 1) = nan; }), {"Hold.directions: P P^T - P = nan", core}},
        {"nowhere", hold_with([](auto& h) { h.displacement.z() = nan; }), {"Hold.displacement = (0, 0, nan)", core}},
        {"about nothing", hold_with([](auto& h) { h.pivot.x() = inf; }), {"Hold.pivot = (inf, 0, 0)", core}},
        {"a path from nowhere",
         hold_with([](auto& h) { h.path = [](double a) { return Vec3(0, std::log(a), 0); }; }),
         {"Hold.path(0) = (0, -inf, 0)", core}},
        {"a stretching rotation",
         hold_with([](auto& h) { h.rotation = [](double) { return Mat3(1.1 * Mat3::Identity()); }; }),
         {"Hold.rotation(0): R^T R - 1 = 0.21", core}},
        {"a mirror",
         hold_with([](auto& h) { h.rotation = [](double) { return Mat3(-Mat3::Identity()); }; }),
         {"Hold.rotation(0): determinant = -1", core}},
        {"another vector", hold_with([](auto& h) { h.vector = static_cast<scene::NodeVector>(5); }), {"Hold.vector = 5", core}},
        {"off the fibre",
         hold_with([](auto& h) { h.at.fraction = 1.5; }),
         {"Station.fraction = 1.5, but it must be in [0, 1]", "fibre 1 'core'"}},
        {"a fibre that is not there", hold_with([](auto& h) { h.at.fibre = 7; }), {"Station.fibre = 7"}},
        {"a clamp",
         [](auto& a) {
             a.clamp({1, 0.5}, Vec3(0, nan, 0));
         },
         {"Hold.displacement = (0, nan, 0)", core}},
        {"a prescribed motion",
         [](auto& a) {
             a.prescribe({1, 0.5}, Vec3(inf, 0, 0));
         },
         {"Hold.displacement = (inf, 0, 0)", core}},
    });
}

TEST_CASE("loads, orders, rules, tools, bodies and cells are refused by what they are of") {
    const std::string core = "(fibre 1 'core', at 1 of its length)";
    const auto order = [](Index above, Index below, const Vec3& axis) {
        return [=](scene::Assembly& assembly) { assembly.force_order({above, below, axis}); };
    };
    const auto tool = [](const std::function<void(scene::Tool&)>& change) {
        return [change](scene::Assembly& assembly) {
            scene::Tool plate;
            plate.name = "plate";
            change(plate);
            assembly.add(plate);
        };
    };
    check({
        {"a force",
         [](auto& a) {
             a.apply(scene::DeadForce{scene::last_end(1), {}, Vec3(0, nan, 0), "load"});
         },
         {"DeadForce.force = (0, nan, 0)", core}},
        {"a moment",
         [](auto& a) {
             a.apply(scene::Moment{scene::last_end(1), scene::NodeVector::director_1, Vec3(0, 0, inf), "load"});
         },
         {"Moment.moment = (0, 0, inf)", core}},
        {"a moment on a position",
         [](auto& a) {
             a.apply(scene::Moment{scene::last_end(1), scene::NodeVector::position, Vec3::UnitX(), "load"});
         },
         {"Moment.director = position", core}},
        {"no axis",
         order(1, 0, Vec3::Zero()),
         {"ForcedOrder.axis: length = 0, but it must be 1", "(order 0, of group 1 'upper' above group 0 'lower')"}},
        {"an axis that is no number", order(1, 0, Vec3(0, 0, nan)), {"ForcedOrder.axis = (0, 0, nan)", "order 0"}},
        {"an axis that is too long", order(1, 0, Vec3(0, 0, 2)), {"ForcedOrder.axis: length = 2", "order 0"}},
        {"a group above itself",
         order(1, 1, Vec3::UnitZ()),
         {"ForcedOrder.above = 1, but it must be another group than below", "order 0"}},
        {"a group that is not there", order(1, 2, Vec3::UnitZ()), {"ForcedOrder.group = 2"}},
        {"each above the other",
         [](auto& a) {
             a.force_order({1, 0, Vec3::UnitZ()}), a.force_order({0, 1, Vec3::UnitZ()});
         },
         {"ForcedOrder.above = 0, but it must be below: order 0 says so", "order 1"}},
        {"a place on one of two groups",
         [](auto& a) {
             a.force_order({1, 0, Vec3::UnitZ(), 0.5});
         },
         {"ForcedOrder.at_below = nan", "order 0"}},
        {"places in one of two orders",
         [](auto& a) {
             a.force_order({1, 0, Vec3::UnitZ(), 0.5, 0.5}), a.force_order({0, 1, Vec3::UnitZ()});
         },
         {"ForcedOrder.at_above = unset, but it must be as in order 0", "order 1"}},
        {"axes that are not parallel",
         [](auto& a) {
             a.add_group("top"), a.force_order({1, 0, Vec3::UnitZ()}), a.force_order({2, 1, Vec3::UnitX()});
         },
         {"ForcedOrder.axis: sine of the angle to that of order 0 = 1", "order 1, of group 2 'top'"}},
        {"a rule",
         [](auto& a) {
             a.add(scene::PairRule{0, 1, 1.0, 0.0});
         },
         {"PairRule.penetration_factor = 0", "(group 0 'lower' and group 1 'upper')"}},
        {"a tool that is nowhere", tool([](auto& t) { t.origin.x() = nan; }), {"Tool.origin = (nan, 0, 0)", "(tool 0 'plate')"}},
        {"a tool without a direction",
         tool([](auto& t) { t.axis = Vec3::Zero(); }),
         {"Tool.axis: length = 0", "(tool 0 'plate')"}},
        {"a tool that goes nowhere",
         tool([](auto& t) { t.path = [](double) { return Vec3(0, 0, nan); }; }),
         {"Tool.path(0) = (0, 0, nan)", "(tool 0 'plate')"}},
        {"a tool without a radius",
         tool([](auto& t) { t.shape = scene::ToolShape::sphere; }),
         {"Tool.radius = nan", "(tool 0 'plate')"}},
        {"a body that is nowhere",
         [](auto& a) { a.add(scene::RigidBody{.name = "jaw", .position = Vec3(nan, 0, 0)}); },
         {"RigidBody.position = (nan, 0, 0)", "(body 1 'jaw')"}},
        {"a body's coordinate",
         [](auto& a) {
             scene::RigidBody b;
             b.translation[1].value = inf;
             a.add(b);
         },
         {"RigidBody.coordinate = inf", "(body 1)"}},
        {"a body of a body that is not there", [](auto& a) { a.add(scene::RigidBody{.parent = 4}); }, {"RigidBody.parent = 4"}},
        {"a tie to nothing",
         [](auto& a) { a.connect({.body = 0}); },
         {"AverageConnection.ends = none", "(connection 0 to body 0 'grip')"}},
        {"a tie of a fibre that is not there",
         [](auto& a) {
             a.connect({.ends = {{9, 0.0}}, .body = 0});
         },
         {"Station.fibre = 9", "(connection 0 to body 0 'grip')"}},
        {"a tie that goes nowhere",
         [](auto& a) {
             a.connect({.ends = {{0, 0.0}}, .body = 0, .displacement = Vec3(0, 0, nan)});
         },
         {"AverageConnection.displacement = (0, 0, nan)", "grip"}},
        {"a cell's gradient",
         [](auto& a) {
             scene::PeriodicCell c;
             c.component(0, 1).value = nan;
             a.add(c);
         },
         {"PeriodicCell.gradient = nan", "(cell 1)"}},
        {"a period",
         [](auto& a) {
             a.connect(scene::PeriodicPair{{0, 0.0}, {1, 1.0}, Vec3(nan, 0, 0), 0});
         },
         {"PeriodicPair.period = (nan, 0, 0)", "from fibre 0, at 0 of its length to fibre 1 'core', at 1"}},
    });
}

/// A beam that takes no rest shape beyond x = 5.
struct Choosy : Beam {
    using Beam::Beam;
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const ElementVector& shape) const {
        core::require(shape[0] < 5.0, "Choosy.rest", shape[0], "< 5");
        return Beam::rest(section, material, shape);
    }
};

TEST_CASE("an element or a node that is refused is named by fibre, number and place") {
    CHECK(test::refusal([] {
              scene::FibreSpecification far = fibre();
              far.name = "far", far.from = Vec3(-3, 0, 0), far.to = Vec3(7, 0, 0);
              scene::Assembly one;
              one.add(far);
              beam::Mesh<Choosy>(one, Choosy());
          }) == "Choosy.rest = 5, but it must be < 5 (fibre 0 'far', element 8, from (5, 0, 0) to (6, 0, 0))");
    scene::Assembly assembly = scene_of_two();
    const Beam beam;
    const beam::Mesh<Beam> mesh(assembly, beam);
    CHECK(mesh.element_label(1, 3) == "fibre 1 'core', element 3, from (3, 0, 0) to (4, 0, 0)");
    CHECK(mesh.node_label(0, 5) == "fibre 0, node 5 at (2.5, 0, 0)");
    CHECK(mesh.vector_label(mesh.node_vector(1, 2, 1)) == "fibre 1 'core', node 2 at (1, 0, 0)");
    Vector state = mesh.start_state();
    state[3 * mesh.node_vector(1, 4) + 1] = nan;
    assembly.begin_at(state);
    CHECK(test::refusal([&] { beam::Mesh<Beam>(assembly, beam); }) ==
          "Assembly.start = (2, nan, 0), but it must be finite (fibre 1 'core', node 4 at (2, 0, 0))");
}

}  // namespace refusals_test

// SPDX-License-Identifier: MIT
// Fibres that are driven through each other, through themselves and into tools, in too large increments: held back or refused,
// never behind.
#include "simulation/scenes.hpp"

#include <fibrant/contact/contacts_with_tools.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <type_traits>

using namespace fibrant;

namespace passage_test {

using Pressing = test::EveryDirector;
using test::Smooth;

const double r = 0.02, pi = std::numbers::pi;

struct Unchecked : Smooth {
    using Passage = contact::NoPassage;
};
// Left out, there is not a byte of it.
static_assert(std::is_empty_v<simulation::Simulator<Unchecked>::Passage> &&
              !core::Active<simulation::Simulator<Unchecked>::Passage>);
static_assert(core::Active<simulation::Simulator<Smooth>::Passage>);

struct Failures {
    std::vector<simulation::FailedAttempt> attempts{};
    void gave_up(const simulation::FailedAttempt& attempt) { attempts.push_back(attempt); }
    bool name(const std::string& words) const {
        for (const simulation::FailedAttempt& attempt : attempts)
            if (attempt.reason.find(words) != std::string::npos) return true;
        return false;
    }
};

scene::FibreSpecification fibre(const Vec3& from, const Vec3& to, double radius, Index elements) {
    return {.from = from, .to = to, .section = scene::circular(radius), .material = {7300.0, 0.3}, .elements = elements};
}
void clamp(scene::Assembly& assembly, Index of, const Vec3& displacement) {
    assembly.clamp(scene::first_end(of), displacement);
    assembly.clamp(scene::last_end(of), displacement);
}

/// Two crossed fibres, lengths in the smaller radius: the upper one goes down by `approach`, the lower one up by `rise`.
struct Crossed {
    double lower = 1.0, upper = 1.0, gap = 3.0, approach = 7.0, rise = 0.0, half_lower = 50.0, half_upper = 50.0;
    Index elements = 10;
    scene::Assembly assembly() const {
        const double height = (lower + upper + gap) * r;
        scene::Assembly scene;
        clamp(scene, scene.add(fibre({0, -half_lower * r, 0}, {0, half_lower * r, 0}, lower * r, elements)), {0, 0, rise * r});
        clamp(scene, scene.add(fibre({-half_upper * r, 0, height}, {half_upper * r, 0, height}, upper * r, elements)),
              {0, 0, -approach * r});
        return scene;
    }
    /// Of the middle of the upper one over the lower one, over the distance at which they touch.
    template <class Simulator>
    double height(const Simulator& simulator) const {
        return (simulator.value({1, 0.5}).z() - simulator.value({0, 0.5}).z()) / ((lower + upper) * r);
    }
};

template <class M>
double run(const Crossed& scene, simulation::Report& report, Failures& failures, Index increments = 1) {
    simulation::Simulator<M> simulator(scene.assembly(), test::model_parameters<M>(r));
    report = simulator.run({.increments = increments}, failures);
    return scene.height(simulator);
}

TEST_CASE("a fibre that is driven past another one in a single increment ends on it, not behind it") {
    for (const Crossed& scene :
         {Crossed{}, Crossed{.gap = 4.0, .approach = 12.0}, Crossed{.gap = 3.0, .approach = 3.5, .rise = 3.5},
          Crossed{.upper = 5.0, .gap = 3.0, .approach = 13.0, .half_upper = 250.0},
          Crossed{.upper = 10.0, .gap = 10.0, .approach = 30.0, .half_upper = 500.0},
          Crossed{.upper = 50.0, .gap = 60.0, .approach = 70.0, .half_lower = 500.0, .half_upper = 2500.0}}) {
        CAPTURE(scene.upper);
        CAPTURE(scene.gap);
        CAPTURE(scene.approach);
        simulation::Report report, finer;
        Failures failures;
        const double height = run<Smooth>(scene, report, failures), expected = run<Smooth>(scene, finer, failures, 20);
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        REQUIRE(finer.converged);
        CHECK(report.contact.reaction_sum > 0.0);
        // The penetration that twenty increments or one leave: the penalty adapts from one to the next.
        CHECK(std::abs(height - expected) < 0.02);
    }
}

TEST_CASE("without the check the same fibre ends behind the other one, converged and without a force between them") {
    simulation::Report report;
    Failures failures;
    Crossed scene;
    scene.gap = 0.0, scene.approach = 0.5;
    CHECK(run<Unchecked>(scene, report, failures) > 0.9);
    CHECK(report.converged);
    scene.gap = 3.0, scene.approach = 7.0;
    CHECK(run<Unchecked>(scene, report, failures) == test::near(-1.0, 1e-6));
    CHECK(report.converged);
    CHECK(report.contact.active == 0);
}

TEST_CASE("fifty radii at once are held back or cut, in steps that never change sides") {
    for (const double gap : {3.0, 10.0, 45.0}) {
        CAPTURE(gap);
        Crossed scene;
        scene.gap = gap, scene.approach = 50.0, scene.half_lower = scene.half_upper = 150.0, scene.elements = 20;
        simulation::Report report;
        Failures failures;
        const double height = run<Smooth>(scene, report, failures);
        CHECK((!report.converged || height > 0.0));
        CHECK(height > 0.0);
    }
}

TEST_CASE("parallel fibres do not pass through each other, in one plane or a little beside it, one driven or both") {
    for (const double beside : {0.0, 1e-6, 0.3}) {
        for (const double way : {9.0, 20.0}) {
            CAPTURE(beside);
            CAPTURE(way);
            scene::Assembly scene;
            clamp(scene, scene.add(fibre({0, -50 * r, 0}, {0, 50 * r, 0}, r, 10)), {-0.5 * way * r, 0, 0});
            clamp(scene, scene.add(fibre({-5 * r, -50 * r, beside * r}, {-5 * r, 50 * r, beside * r}, r, 10)),
                  {0.5 * way * r, 0, 0});
            simulation::Simulator<Smooth> simulator(scene, test::model_parameters<Smooth>(r));
            Failures failures;
            const simulation::Report report = simulator.run({.increments = 1}, failures);
            CHECK_FALSE(report.converged);  // their ends are driven through each other: there is no answer
            CHECK_FALSE(report.reason.empty());
            CHECK(simulator.value({0, 0.5}).x() > simulator.value({1, 0.5}).x());
        }
    }
}

TEST_CASE("what passes is named, with its place and its motion, and the attempt is cut") {
    // Ends that are driven through each other: no search can help.
    scene::Assembly scene;
    clamp(scene, scene.add(fibre({0, -50 * r, 0}, {0, 50 * r, 0}, r, 10)), Vec3::Zero());
    clamp(scene, scene.add(fibre({-5 * r, -50 * r, 0}, {-5 * r, 50 * r, 0}, r, 10)), {9 * r, 0, 0});
    simulation::Simulator<Unchecked> unchecked(scene, test::model_parameters<Unchecked>(r));
    const contact::Swept::Of<Smooth::Beam> swept(unchecked.mesh(), contact::Detection{});
    Vector moved = unchecked.state();
    for (Index a = 0; a < unchecked.mesh().node_count(1); ++a) moved[3 * unchecked.mesh().node_vector(1, a)] += 9 * r;
    const auto passed = swept.first(unchecked.state(), moved, unchecked.contacts(), false, true);
    REQUIRE(passed);
    CHECK(passed->fibre == 0);
    CHECK(passed->other == 1);
    CHECK(passed->time > 3.9 / 9.0);  // a radius apart, or a little more
    CHECK(passed->time < 4.0 / 9.0 + 1e-9);
    CHECK(std::abs(passed->touch - 3.0 / 9.0) < 0.01);
    CHECK(passed->motion == test::near(9 * r, 1e-12));
    CHECK(std::abs(passed->place.x() + 0.5 * r) < 0.05 * r);
    const std::string words = contact::text(*passed);
    CHECK(words.find("fibre 0 at 0.") != std::string::npos);
    CHECK(words.find("with fibre 1 at 0.") != std::string::npos);
    CHECK(words.find("0.18 against each other") != std::string::npos);
    // Nothing passes on the way back to where they are, nor where both go together.
    CHECK_FALSE(swept.first(unchecked.state(), unchecked.state(), unchecked.contacts(), false, true));
    Vector together = unchecked.state();
    for (Index f = 0; f < 2; ++f)
        for (Index a = 0; a < unchecked.mesh().node_count(f); ++a)
            together.segment<3>(3 * unchecked.mesh().node_vector(f, a)) += Vec3(100 * r, -70 * r, 3 * r);
    CHECK_FALSE(swept.first(unchecked.state(), together, unchecked.contacts(), false, true));
}

TEST_CASE(
    "a fibre that creeps through another one in many small motions is held up half way into it, unless it was there before") {
    Crossed scene;
    scene.gap = 0.0;
    simulation::Simulator<Unchecked> unchecked(scene.assembly(), test::model_parameters<Unchecked>(r));
    const contact::Swept::Of<Smooth::Beam> swept(unchecked.mesh(), contact::Detection{});
    const auto lowered = [&](double by) {  // in touching distances
        Vector state = unchecked.state();
        for (Index a = 0; a < unchecked.mesh().node_count(1); ++a)
            state[3 * unchecked.mesh().node_vector(1, a) + 2] -= 2.0 * r * by;
        return state;
    };
    // Steps of 0.03 come no closer on their way than half of what they leave.
    for (int step = 0; step < 33; ++step) {
        const double before = 1.0 - 0.03 * step, after = before - 0.03;
        CAPTURE(after);
        const auto passed = swept.first(lowered(1.0 - before), lowered(1.0 - after), unchecked.contacts(), false, true);
        CHECK(passed.has_value() == (before >= 0.5 && after < 0.5));
        if (!passed) continue;
        CHECK(passed->left == test::near(after, 1e-9));
        CHECK(contact::text(*passed).find("of touching apart") != std::string::npos);
    }
    CHECK_FALSE(swept.first(lowered(0.55), lowered(0.3), unchecked.contacts(), false, true));  // and out again it may go
}

TEST_CASE("a fibre that slips off past the end of another one is free to go") {
    // The upper one lies across, 3 radii before the end of the lower one, and is moved off it and down, in one increment.
    scene::Assembly scene;
    scene.clamp(scene::first_end(scene.add(fibre({0, -50 * r, 0}, {0, 0, 0}, r, 10))));
    clamp(scene, scene.add(fibre({-50 * r, -3 * r, 2.5 * r}, {50 * r, -3 * r, 2.5 * r}, r, 10)),
          {0, 6 * r, -4 * r});  // half a radius above the end
    simulation::Simulator<Smooth> simulator(scene, test::model_parameters<Smooth>(r));
    Failures failures;
    const simulation::Report report = simulator.run({.increments = 1}, failures);
    CHECK(report.converged);
    CHECK_FALSE(failures.name("changes sides"));
    CHECK(simulator.value({1, 0.5}).z() < 0.0);
}

TEST_CASE("a fibre does not pass through itself") {
    // Two straight spans, one across the other six radii above it, joined by three quarters of a circle; the end of the upper one
    // is driven down.
    const double span = 60.0 * r, half = 0.5 * span, arc = 1.5 * pi * half, total = 2.0 * span + arc, lift = 6.0 * r;
    const auto curve = [=](double t) {
        const double s = t * total;
        if (s <= span) return Vec3(s - half, 0.0, 0.0);
        if (s >= span + arc) return Vec3(0.0, half - (s - span - arc), lift);
        const double w = (s - span) / arc, angle = 1.5 * pi * w - 0.5 * pi, rise = w * w * (3.0 - 2.0 * w);
        return Vec3(half + half * std::cos(angle), half + half * std::sin(angle), lift * rise);
    };
    for (const double down : {16.0, 30.0}) {
        CAPTURE(down);
        scene::Assembly scene;
        scene::FibreSpecification loop = fibre(Vec3::Zero(), Vec3::Zero(), r, 52);
        loop.curve = curve;
        scene.add(loop);
        scene.clamp(scene::first_end(0));
        scene.clamp(scene::last_end(0), {0, 0, -down * r});
        auto parameters = test::model_parameters<Smooth>(r);
        parameters.contact.detection.self_contact = true;
        simulation::Simulator<Smooth> simulator(scene, parameters);
        // Of the span at the end over that at the beginning, where they cross in plan.
        const auto height = [&] {
            double least = 1e300, there = 0.0;
            for (double u = 0.5; u < 14.0; u += 0.02)
                for (double v = 38.0; v < 51.5; v += 0.02) {
                    const Vec3 apart =
                        simulator.mesh().position(simulator.state(), 0, v) - simulator.mesh().position(simulator.state(), 0, u);
                    if (apart.head<2>().norm() < least) least = apart.head<2>().norm(), there = apart.z();
                }
            REQUIRE(least < 0.1 * r);
            return there;
        };
        REQUIRE(std::abs(height() - lift) < 1e-4 * r);  // of places a hundredth of an element apart
        Failures failures;
        const simulation::Report report = simulator.run({.increments = 1}, failures);
        CAPTURE(report.reason);
        CHECK(height() > 1.8 * r);
    }
}

TEST_CASE("a tool that is too fast for a fibre is refused by name, and a slower one takes the fibre along") {
    for (const auto shape : {scene::ToolShape::cylinder, scene::ToolShape::sphere, scene::ToolShape::plane}) {
        CAPTURE(static_cast<int>(shape));
        for (const Index increments : {1, 40}) {
            CAPTURE(increments);
            scene::Assembly scene;
            clamp(scene, scene.add(fibre({-50 * r, 0, 0}, {50 * r, 0, 0}, r, 10)), Vec3::Zero());
            scene::Tool tool;
            tool.shape = shape, tool.radius = 1.5 * r, tool.channel = "motion";
            tool.origin = {0, 0, shape == scene::ToolShape::plane ? 2.0 * r : 4.0 * r};
            tool.axis = shape == scene::ToolShape::plane ? Vec3(0, 0, -1) : Vec3(0, 1, 0);
            tool.displacement = {0, 0, shape == scene::ToolShape::plane ? -5.0 * r : -12.0 * r};
            scene.add(tool);
            simulation::Simulator<Pressing> simulator(scene, test::model_parameters<Pressing>(r));
            Failures failures;
            const simulation::Report report = simulator.run({.increments = increments}, failures);
            const double z = simulator.value({0, 0.5}).z();
            CAPTURE(report.reason);
            if (shape == scene::ToolShape::plane) {  // clamped ends are pressed through it: there is no answer
                CHECK_FALSE(report.converged);
                CHECK(z < 0.5 * r);
                if (increments == 1) CHECK(failures.name("contact of fibre 0 with tool 0 is"));
                continue;
            }
            if (increments > 1) REQUIRE(report.converged);
            if (increments == 1) CHECK(failures.name("fibre 0 at 0.5 of its length changes sides with tool 0"));
            if (report.converged) CHECK(z == test::near(-10.5 * r, 2e-2));
            CHECK(z < 0.5 * r);
        }
    }
}

TEST_CASE("a thin plate that is too fast for a fibre is refused by name, and a slower one takes the fibre along") {
    for (const Index increments : {1, 40}) {
        CAPTURE(increments);
        scene::Assembly scene;
        clamp(scene, scene.add(fibre({-50 * r, 0, 0}, {50 * r, 0, 0}, r, 10)), Vec3::Zero());
        scene::Tool blade;
        blade.shape = scene::ToolShape::surface, blade.channel = "motion";
        blade.surface = std::make_shared<scene::Block>(scene::Block::Parameters{.half = {r, 4 * r, 0.5 * r}, .edge = 0.3 * r});
        blade.origin = {0, 0, 3.0 * r}, blade.displacement = {0, 0, -8.0 * r};
        scene.add(blade);
        simulation::Simulator<Pressing> simulator(scene, test::model_parameters<Pressing>(r));
        Failures failures;
        const simulation::Report report = simulator.run({.increments = increments}, failures);
        const double z = simulator.value({0, 0.5}).z();
        CAPTURE(report.reason);
        if (increments > 1) REQUIRE(report.converged);
        if (increments == 1) CHECK(failures.name("fibre 0 at 0.5 of its length changes sides with tool 0"));
        if (report.converged) CHECK(z == test::near(-6.5 * r, 2e-2));
        CHECK(z < 0.5 * r);
    }
}

}  // namespace passage_test

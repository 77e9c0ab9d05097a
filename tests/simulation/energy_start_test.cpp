// SPDX-License-Identifier: MIT
// What a run begins with is in its energy balance: fibres that are laid out of their rest shapes, and contacts that press.
#include "simulation/scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>

using namespace fibrant;

namespace energy_start_test {

using simulation::Report;
using simulation::Simulator;
using test::Crossing;
using test::Rod;
using test::Smooth;

/// A straight fibre laid in an arc of a quarter turn, both of its ends clamped as they lie; the last one is taken to where it
/// ends in an arc of (1 - a) of that.
struct Laid {
    Rod rod;
    Index fibre = 0;
    scene::Assembly assembly;
    double angle = 0.5 * std::numbers::pi;

    static Vec3 place(double length, double angle, double s) {
        if (std::abs(angle) < 1e-6) return {0.0, 0.0, s};
        const double radius = length / angle;
        return {radius * (1.0 - std::cos(s / radius)), 0.0, radius * std::sin(s / radius)};
    }
    /// @param curved  the other way round: an arc at rest, laid straight
    explicit Laid(bool curved = false) {
        rod.radius = 0.05;
        scene::FibreSpecification fibre = rod.specification();
        fibre.director = Vec3::UnitY();
        const double length = rod.length, all = angle;
        const scene::Curve arc = [=](double t) { return place(length, all, t * length); },
                           line = [=](double t) { return Vec3(0, 0, t * length); };
        fibre.curve = curved ? arc : line, fibre.start = curved ? line : arc;
        assembly.add(fibre);
        assembly.clamp(scene::first_end(0));
        const auto now = [=](double a) { return all * (curved ? a : 1.0 - a); };
        scene::Hold hold;
        hold.at = scene::last_end(0), hold.channel = "turn";
        hold.path = [=](double a) { return Vec3(place(length, now(a), length) - place(length, now(0.0), length)); };
        assembly.hold(hold);
        hold.path = {}, hold.axes = scene::Axes::section;
        hold.rotation = [=](double a) { return Mat3(Eigen::AngleAxisd(now(a) - now(0.0), Vec3::UnitY())); };
        hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 1).asDiagonal();
        assembly.hold(hold);
        hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 1).asDiagonal();
        assembly.hold(hold);
    }
    double stored() const { return 0.5 * rod.bending_stiffness() * angle * angle / rod.length; }
};

simulation::Loading<Smooth> to(const std::string& channel, double amplitude, Index increments) {
    simulation::Loading<Smooth> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{channel, amplitude}}, loading.stages[0].increments = increments;
    return loading;
}
double missing(const Report& report, double of) { return report.energy.error() / of; }

TEST_CASE("a straight fibre laid in an arc misses no energy, there or on its way back, nor does an arc that is laid straight") {
    for (const bool curved : {false, true}) {
        const Laid laid(curved);
        Simulator<Smooth> simulator(laid.assembly, test::tight_parameters<Smooth>(laid.rod.radius));
        const Report there = simulator.run(to("turn", 1e-9, 1));
        REQUIRE_MESSAGE(there.converged, there.reason);
        const double stored = laid.stored();
        std::printf("laid %s: stored %.6f of E I angle^2 / 2 L, missing %.1e", curved ? "straight" : "in an arc",
                    there.energy.elastic / stored, missing(there, stored));
        CHECK(std::abs(there.energy.elastic / stored - 1.0) < 1e-3);
        CHECK(std::abs(there.energy.external / stored - 1.0) < 1e-3);
        CHECK(std::abs(missing(there, stored)) < 1e-6);
        const Report back = simulator.run(to("turn", 1.0, 32));
        REQUIRE_MESSAGE(back.converged, back.reason);
        std::printf("; back at rest stored %.1e, missing %.1e\n", back.energy.elastic / stored, missing(back, stored));
        CHECK(std::abs(back.energy.elastic / stored) < 1e-6);
        CHECK(std::abs(missing(back, stored)) < 5e-5);  // of second order: 2e-4 with 8 increments, 6.3e-3 on chords
    }
}

TEST_CASE("an arc that is let go gives its energy to what held it, to the order of the rule") {
    // From a hundredth of a turn: the force is nearly linear on the way, so the trapezium is nearly exact.
    const double angle = 0.06;
    Rod rod;
    rod.radius = 0.05;
    scene::FibreSpecification fibre = rod.specification();
    const double length = rod.length;
    fibre.start = [=](double t) { return Laid::place(length, angle, t * length); };
    scene::Assembly assembly;
    assembly.clamp(scene::first_end(assembly.add(fibre)));
    Simulator<Smooth> simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
    const Report report = simulator.run({.increments = 1});
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double stored = 0.5 * rod.bending_stiffness() * angle * angle / length;
    std::printf("let go: stored %.1e, missing %.1e of what it had\n", report.energy.elastic / stored, missing(report, stored));
    CHECK(std::abs(report.energy.elastic / stored) < 1e-9);
    CHECK(std::abs(missing(report, stored)) < 1e-2);
}

/// Pressed by `approach`, from where an earlier run left it if there is one.
scene::Assembly pressed(double approach, const Vector& start, double young) {
    Crossing crossing;
    crossing.approach = approach, crossing.young = young;
    scene::Assembly assembly = crossing.assembly();
    if (start.size() > 0) assembly.begin_at(start);
    return assembly;
}

TEST_CASE("contacts and fibres that press when a run begins are in its balance, whichever way it begins") {
    const Crossing crossing;
    const double once = crossing.radius;
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_energy_start_test.bin").string();
    Simulator<Smooth> first(pressed(once, Vector(), crossing.young), test::tight_parameters<Smooth>(crossing.radius));
    simulation::Loading<Smooth> loading = to("approach", 1.0, 8);
    loading.checkpoint = file;
    const Report before = first.run(loading);
    REQUIRE_MESSAGE(before.converged, before.reason);
    const double stored = before.energy.elastic + before.energy.contact;
    std::printf("pressed: elastic %.3f of what is stored, missing %.1e\n", before.energy.elastic / stored,
                missing(before, stored));
    const auto go_on = [&](const char* name, Simulator<Smooth>& next, double factor) {
        double error[2];
        for (const Index increments : {1, 4}) {
            const Report report = next.run(to("approach", increments == 1 ? 0.02 : 0.3, increments));
            REQUIRE_MESSAGE(report.converged, report.reason);
            error[increments == 1 ? 0 : 1] = missing(report, factor * stored);
        }
        std::printf("%s: missing %.1e at once, %.1e later\n", name, error[0], error[1]);
        CHECK(std::abs(error[0]) < 2e-4);
        CHECK(std::abs(error[1]) < 2e-3);
    };
    const auto parameters = test::tight_parameters<Smooth>(crossing.radius);
    {
        Simulator<Smooth> next(pressed(once, first.state(), crossing.young), parameters);
        go_on("begins at its state", next, 1.0);
    }
    {
        Simulator<Smooth> next(pressed(once, first.state(), crossing.young), parameters);
        next.go_on_from(first);
        go_on("goes on from it", next, 1.0);
    }
    {
        // Conditions count from the rest shape: at amplitude 0.02 the ends would be back, so this one is driven on from 1.
        Crossing again;
        again.approach = once, again.young = 1.5 * crossing.young;
        Simulator<Smooth> next(again.assembly(), parameters);
        next.start_from(file);
        const Report report = next.run(to("approach", 1.02, 1));
        REQUIRE_MESSAGE(report.converged, report.reason);
        const double stiffer = report.energy.elastic + report.energy.contact;
        std::printf("starts from its file with stiffer fibres: missing %.1e\n", missing(report, stiffer));
        CHECK(std::abs(missing(report, stiffer)) < 1e-2);
    }
    std::filesystem::remove(file);
}

}  // namespace energy_start_test

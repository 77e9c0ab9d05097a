// SPDX-License-Identifier: MIT
// Friction of few contacts: a stuck pair turned as a whole, and a fibre drawn out from between two others.
#include <contact/contact_model.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace contact_stuck_pair_test {

using test::Rough;

const double r = 0.02, range = 0.02 * r;  // radius, reversible displacement [mm]

/// A motion in three parts: amplitude 0 to 1 presses, 1 to 2 slides, 2 to 3 turns everything by 90 degrees about a slanting axis.
struct Motion {
    Vec3 press = Vec3::Zero(), slide = Vec3::Zero(), axis = Vec3(1, 2, 3).normalized();

    Mat3 turn(double amplitude) const {
        return Eigen::AngleAxisd(0.5 * std::numbers::pi * std::clamp(amplitude - 2.0, 0.0, 1.0), axis).toRotationMatrix();
    }
    Vec3 displacement(double amplitude) const {
        return turn(amplitude) * (std::min(amplitude, 1.0) * press + std::clamp(amplitude - 1.0, 0.0, 1.0) * slide);
    }
    /// Clamps a section to it.
    void clamp(scene::Assembly& assembly, const scene::Station& at) const {
        scene::Hold hold;
        hold.at = at;
        hold.rotation = [self = *this](double amplitude) { return self.turn(amplitude); };
        hold.path = [self = *this](double amplitude) { return self.displacement(amplitude); };
        assembly.hold(hold);
        hold.path = nullptr;
        hold.axes = scene::Axes::section;
        hold.vector = scene::NodeVector::director_1;
        hold.directions = Vec3(0, 1, 1).asDiagonal();
        assembly.hold(hold);
        hold.vector = scene::NodeVector::director_2;
        hold.directions = Vec3(1, 0, 1).asDiagonal();
        assembly.hold(hold);
    }
};

struct Carried {
    Vec3 friction = Vec3::Zero(), reaction = Vec3::Zero();
    double size = 0.0, normal = 0.0;
    Index active = 0;
};

/// What the contacts carry from the first fibre to the second.
Carried carried(const simulation::Simulator<Rough>& simulator) {
    Carried sum;
    const auto& contacts = simulator.contacts();
    for (std::size_t k = 0; k < contacts.elements().size(); ++k) {
        const double reaction = contacts.responses()[k].reaction;
        if (reaction == 0.0) continue;
        ++sum.active;
        sum.friction += contacts.frictions()[k].force;
        sum.size += contacts.frictions()[k].force.norm();
        sum.reaction += reaction * contacts.elements()[k].normal;
        sum.normal += reaction;
    }
    return sum;
}

void check_turning_pair(double angle_deg, Index increments, contact::Places places = contact::Places::as_needed) {
    CAPTURE(angle_deg);
    CAPTURE(static_cast<int>(places));
    CAPTURE(increments);
    const double angle = angle_deg * std::numbers::pi / 180.0;
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    scene::Assembly assembly;
    const Vec3 centre(0.02, angle_deg > 30.0 ? 0.01 : 0.0, 2 * r);
    const Index lower = assembly.add(test::straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 11));
    const Index upper = assembly.add(test::straight_fibre(centre - 0.5 * along, centre + 0.5 * along, r, 11));
    Motion still, moving;
    moving.press = Vec3(0, 0, angle_deg > 30.0 ? -r : -0.01 * r);
    moving.slide = (angle_deg > 30.0 ? 3.0 : 0.5) * range * Vec3(0.8, 0.6, 0.0);
    for (const double end : {0.0, 1.0}) still.clamp(assembly, {lower, end}), moving.clamp(assembly, {upper, end});

    simulation::ModelParameters<Rough> parameters = test::pressed_parameters<Rough>(1e-2 * r);
    parameters.contact.places = places;
    parameters.friction = {.friction_coefficient = 0.3, .reversible_displacement = range};
    // As it is given, or the penetration would creep while the pair turns.
    parameters.contact.stiffness.initial_fraction = parameters.contact.stiffness.floor_fraction =
        parameters.contact.stiffness.cap_fraction = 0.01;
    parameters.iteration.step_tolerance = 1e-8;  // tolerances are in radii, and friction lives on a fiftieth of one
    parameters.iteration.residual_tolerance = 1e-9;
    parameters.iteration.normal_step_tolerance = 1e-7;
    parameters.iteration.contact_tolerance = 1e-6;
    simulation::Simulator<Rough> simulator(assembly, parameters);
    const simulation::Report pressed = simulator.run(test::stage<Rough>({{"motion", 1.0}}, 4));
    REQUIRE_MESSAGE(pressed.converged, pressed.reason);
    const simulation::Report slid = simulator.run(test::stage<Rough>({{"motion", 2.0}}, 4));
    REQUIRE_MESSAGE(slid.converged, slid.reason);
    const Carried before = carried(simulator);
    const double dissipated = slid.energy.dissipated;
    CHECK(before.size > 0.02 * before.normal);
    CHECK(dissipated == 0.0);
    const simulation::Report turned = simulator.run(test::stage<Rough>({{"motion", 3.0}}, increments));
    REQUIRE_MESSAGE(turned.converged, turned.reason);
    const Carried after = carried(simulator);
    const Mat3 turn = moving.turn(3.0);
    std::printf(
        "%2.0f degrees, %ld increments: R_T / R_N %.4f; turned: friction off by %.1e, its direction by %.1e, R_N by %.1e, "
        "dissipated %.1e, penetration %.1e r\n",
        angle_deg, static_cast<long>(increments), before.size / before.normal, after.size / before.size - 1.0,
        (after.friction - turn * before.friction).norm() / before.size, after.normal / before.normal - 1.0,
        turned.energy.dissipated - dissipated, turned.contact.greatest_penetration / r);
    CHECK(after.active == before.active);
    CHECK(std::abs(after.normal / before.normal - 1.0) < 1e-6);
    CHECK((after.reaction - turn * before.reaction).norm() < 1e-6 * before.normal);
    // Places slide by contact_tolerance, 1e-6 r, which is 5e-5 of what friction gives way by: as needed, attempts that are made
    // again go from places that are renewed to those that are followed and back, a little aside.
    const double aside = places == contact::Places::as_needed && angle_deg > 30.0 ? 5e-5 : 2e-6;
    CHECK(std::abs(after.size / before.size - 1.0) < aside);
    CHECK((after.friction - turn * before.friction).norm() < aside * before.size);
    CHECK(turned.energy.dissipated == dissipated);
}

TEST_CASE("a stuck crossing keeps its friction when it is turned as a whole") {
    for (const Index increments : {1, 6})
        for (const auto places : {contact::Places::renewed, contact::Places::followed, contact::Places::as_needed})
            check_turning_pair(70.0, increments, places);
}

TEST_CASE("a stuck line of contact keeps its friction when it is turned as a whole") {
    for (const Index increments : {1, 6}) check_turning_pair(0.0, increments);
}

TEST_CASE("a fibre between two others gives way elastically, slips at twice the friction of one and comes back with a loop") {
    // Two held fibres squeeze a third, which is drawn along by its end.
    const double mu = 0.2;
    scene::Assembly assembly;
    const Index drawn = assembly.add(test::straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 11));
    const Index below = assembly.add(test::straight_fibre({0.03, -0.3, -2 * r}, {0.03, 0.3, -2 * r}, r, 7));
    const Index above = assembly.add(test::straight_fibre({0.03, -0.3, 2 * r}, {0.03, 0.3, 2 * r}, r, 7));
    const Vec3 squeeze(0, 0, 0.5 * r);
    for (const double end : {0.0, 1.0}) {
        assembly.clamp({below, end}, squeeze, Vec3::Zero(), Vec3::Zero(), "squeeze");
        assembly.clamp({above, end}, -squeeze, Vec3::Zero(), Vec3::Zero(), "squeeze");
    }
    // The drawn fibre is held along itself at one end only, so that all that holds it back is friction.
    assembly.clamp(scene::first_end(drawn), Vec3(range, 0, 0), Vec3::Zero(), Vec3::Zero(), "draw");
    simulation::ModelParameters<Rough> parameters = test::pressed_parameters<Rough>(1e-2 * r);
    parameters.friction = {.friction_coefficient = mu, .reversible_displacement = range};
    simulation::Simulator<Rough> simulator(assembly, parameters);
    REQUIRE(simulator.run(test::stage<Rough>({{"squeeze", 1.0}}, 8)).converged);
    const double normal = 0.5 * carried(simulator).normal;  // of each contact
    CHECK(carried(simulator).active == 2);
    const auto draw = [&](double to, Index increments) {  // to, in reversible displacements; gives the last report
        const simulation::Report report = simulator.run(test::stage<Rough>({{"draw", to}}, increments));
        REQUIRE_MESSAGE(report.converged, report.reason);
        return report;
    };
    const auto pull = [&] { return simulator.reaction(scene::first_end(drawn)).x(); };
    const double start = pull();
    const simulation::Report still = draw(0.0, 1);
    const double lost = still.energy.dissipated;
    // reversible: there and back without a loss, and as stiff one way as the other
    const simulation::Report forth = draw(0.5, 2);
    const double half = pull() - start;
    draw(0.0, 2);
    const double rest = pull() - start;
    const simulation::Report back = draw(-0.5, 2);
    const double minus = pull() - start;
    std::printf("R_N %.5f, start %.1e, half way %.5f, back at %.1e, other way %.5f, 2 mu N %.5f\n", normal, start, half, rest,
                minus, 2 * mu * normal);
    CHECK(back.energy.dissipated == lost);
    CHECK(forth.energy.dissipated == lost);
    CHECK(std::abs(rest) < 1e-4 * 2 * mu * normal);
    CHECK(std::abs(half + minus) < 1e-3 * 2 * mu * normal);
    CHECK(half > 0.0);
    // slip
    double last = draw(0.0, 2).energy.dissipated;
    simulation::EnergyBalance loop_start, loop_end;
    for (const double to : {16.0, -16.0, 16.0}) {
        const simulation::Report report = draw(to, 8);
        if (last == lost) loop_start = report.energy;
        loop_end = report.energy;
        const double now = 0.5 * carried(simulator).normal;
        std::printf("drawn to %+.0f: pull %.6f, 2 mu N %.6f, dissipated %.3e\n", to, pull(), 2 * mu * now,
                    report.energy.dissipated);
        CHECK(std::abs(pull() / (std::copysign(2.0, to) * mu * now) - 1.0) < 1e-3);
        for (const simulation::IncrementReport& increment : report.increments) {
            CHECK(increment.energy.dissipated >= last);
            last = increment.energy.dissipated;
        }
    }
    // What the hand put into the closed loop is what sliding took; the trapezoidal rule over 16 increments is off by 1 %.
    const double work = loop_end.external - loop_start.external, heat = loop_end.dissipated - loop_start.dissipated;
    std::printf("loop: work %.4e, dissipated %.4e\n", work, heat);
    CHECK(heat > 0.0);
    CHECK(std::abs(work / heat - 1.0) < 0.03);
}

}  // namespace contact_stuck_pair_test

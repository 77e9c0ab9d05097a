// SPDX-License-Identifier: MIT
// Flat fibres pressed together askew and crossing at small angles come to rest where their surfaces touch. Reference: the least
// gap of the surfaces, which knows nothing of contact elements.
#include <contact/contact_model.hpp>

#include <fibrant/observe/least_gap.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace contact_flat_sections_test {

using test::Smooth;

const double b = 0.02;  // thickness / 2
const double allowed = 0.01 * b;

Vec3 heading(double degrees) {
    return {std::cos(degrees * std::numbers::pi / 180.0), std::sin(degrees * std::numbers::pi / 180.0), 0.0};
}

scene::FibreSpecification flat_fibre(double ratio, const Vec3& middle, const Vec3& along, double half, double tilt) {
    scene::FibreSpecification fibre = test::straight_fibre(middle - half * along, middle + half * along, b, 8);
    fibre.section = scene::elliptical(ratio * b, b);
    fibre.director = std::cos(tilt) * Vec3::UnitZ().cross(along) + std::sin(tilt) * Vec3::UnitZ();
    return fibre;
}

struct Outcome {
    bool converged = false;
    double contact_gap = 0.0, true_gap = 0.0;  ///< over b
    double push = 0.0;                         ///< of the lower fibre's supports, upwards [force]
};

/// The second fibre's ends are moved by a way towards the first one, whose ends are clamped.
Outcome pressed(const std::vector<scene::FibreSpecification>& fibres, const Vec3& way, Index increments) {
    scene::Assembly assembly;
    for (const scene::FibreSpecification& fibre : fibres) assembly.add(fibre);
    assembly.clamp(scene::first_end(0)), assembly.clamp(scene::last_end(0));
    assembly.clamp(scene::first_end(1), way), assembly.clamp(scene::last_end(1), way);
    simulation::Simulator<Smooth> simulator(assembly, test::pressed_parameters<Smooth>(allowed));
    const simulation::Report report = simulator.run(test::stage<Smooth>({{"motion", 1.0}}, increments));
    if (!report.converged) MESSAGE(report.reason);
    const observe::Snapshot snapshot = simulator.snapshot();
    Outcome outcome;
    outcome.converged = report.converged;
    for (const observe::ContactSnapshot& contact : snapshot.contacts)
        outcome.contact_gap = std::min(outcome.contact_gap, contact.gap / b);
    outcome.true_gap = observe::least_gap(snapshot, proximity::GridSearch{}).gap / b;
    outcome.push = simulator.reaction({0, 0.0}).z() + simulator.reaction({0, 1.0}).z();
    return outcome;
}

void check(const Outcome& outcome) {
    CHECK(outcome.converged);
    CHECK(outcome.push > 0.0);
    CHECK(outcome.true_gap < 0.0);
    CHECK(outcome.true_gap > -1.5 * allowed / b);
    CHECK(std::abs(outcome.true_gap - outcome.contact_gap) < 0.2 * allowed / b);  // what goes unseen between contact points
}

TEST_CASE("two parallel flat fibres that are pressed together askew come to rest where their surfaces touch") {
    const std::vector<scene::FibreSpecification> fibres{flat_fibre(2.0, Vec3::Zero(), heading(0), 20.0 * b, 0.0),
                                                        flat_fibre(2.0, b * Vec3(0.0, 2.0, 1.8), heading(0), 20.0 * b, 0.0)};
    // Apart by 0.065 b: 0.05 b nearer they do not touch yet, 0.2 b nearer they press.
    const Outcome apart = pressed(fibres, {0.0, 0.0, -0.05 * b}, 1);
    CHECK(apart.converged);
    CHECK(std::abs(apart.true_gap - 0.0172) < 2e-3);
    CHECK(std::abs(apart.push) < 1e-12);
    check(pressed(fibres, {0.0, 0.0, -0.2 * b}, 16));  // the stiffness follows the depth from increment to increment
}

TEST_CASE("flat fibres that cross at small angles come to rest where their surfaces touch") {
    for (const double degrees : {5.0, 10.0, 20.0})
        for (const double tilt : {0.0, 0.3}) {
            CAPTURE(degrees);
            CAPTURE(tilt);
            const double height = 2.0 * b * std::hypot(3.0 * std::sin(tilt), std::cos(tilt));
            const std::vector<scene::FibreSpecification> fibres{
                flat_fibre(3.0, Vec3::Zero(), heading(-0.5 * degrees), 40.0 * b, tilt),
                flat_fibre(3.0, {0.0, 0.0, height + 0.1 * b}, heading(0.5 * degrees), 40.0 * b, -tilt)};
            const Outcome apart = pressed(fibres, {0.0, 0.0, -0.05 * b}, 1);
            CHECK(apart.converged);
            CHECK(std::abs(apart.true_gap - 0.05) < 1e-6);
            CHECK(std::abs(apart.push) < 1e-12);
            check(pressed(fibres, {0.0, 0.0, -0.3 * b}, 4));
        }
}

}  // namespace contact_flat_sections_test

// SPDX-License-Identifier: MIT
// Laws of contact that see, in whole runs: lines of contact carry what their length says, however many elements they are cut
// into.
#include "simulation/scenes.hpp"
#include <near.hpp>

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/law/directed_friction.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/physical_normal.hpp>

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace seen_contact_test {

struct Seen {
    using Beam = beam::RigidSectionRod;
    using Proximity = proximity::GridSearch;
    using Normal = law::PowerNormal;
    using Friction = law::DirectedFriction;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Seen>);
// What laws do not see takes no place.
static_assert(sizeof(contact::ContactElement<beam::DirectorBeam<3>, law::RegularisedPenalty, law::RegularisedCoulomb>) ==
              sizeof(contact::ContactElement<beam::DirectorBeam<3>, law::LinearPenalty, law::RegularisedCoulomb>));

const double r = 0.05, length = 2.0, sink = 0.004, slide = 0.02;
const double K = 300.0, m = 2.4, a = 0.2, across = 0.4, n = 0.8;

simulation::ModelParameters<Seen> parameters(double points) {
    simulation::ModelParameters<Seen> all;
    all.normal = {.line_stiffness = K, .line_exponent = m, .crossing_stiffness = 50.0};
    all.friction = {.along = a,
                    .across = across,
                    .exponent = n,
                    .crossing_along = 0.15,
                    .crossing_across = 0.3,
                    .reversible_displacement = 1e-4};
    all.contact.spacing.points_per_element = points;
    all.contact.stiffness.allowed_penetration = r;  // no matter: nothing adapts
    all.iteration.residual_tolerance = 1e-9;
    return all;
}
simulation::Loading<Seen> loading() {
    simulation::Loading<Seen> all;
    all.stages.push_back({.name = "press", .increments = 2, .ramps = {{"press", 1.0}}});
    all.stages.push_back({.name = "slide", .increments = 2, .ramps = {{"slide", 1.0}}});
    return all;
}
/// A fibre all of whose nodes are led down and aside.
Index led(scene::Assembly& assembly, const Vec3& from, const Vec3& to, Index elements, bool moves, const Vec3& aside) {
    const Index fibre =
        assembly.add({.from = from, .to = to, .section = scene::circular(r), .material = {1000.0, 0.3}, .elements = elements});
    for (Index k = 0; k <= elements; ++k) {
        const scene::Station at{fibre, static_cast<double>(k) / static_cast<double>(elements)};
        scene::Hold hold;
        hold.at = at;
        hold.directions = Vec3::UnitY() * Vec3::UnitY().transpose(), hold.channel = "press",
        hold.displacement = moves ? Vec3(0, -sink, 0) : Vec3(0, 0, 0);
        assembly.hold(hold);
        hold.directions = Mat3::Identity() - hold.directions, hold.channel = "slide",
        hold.displacement = moves ? aside : Vec3(0, 0, 0);
        assembly.hold(hold);
        assembly.hold_rotation(at);
    }
    return fibre;
}
Vec3 force_on(const simulation::Simulator<Seen>& simulator, Index fibre, Index elements) {
    Vec3 sum = Vec3::Zero();
    for (Index k = 0; k <= elements; ++k)
        sum += simulator.reaction({fibre, static_cast<double>(k) / static_cast<double>(elements)});
    return sum;
}

TEST_CASE("rods side by side carry what a line of their length does, in twice the contact elements as well") {
    for (const bool sideways : {false, true})
        for (const double points : {1.0, 2.0}) {
            scene::Assembly assembly;
            led(assembly, {0, 0, 0}, {0, 0, length}, 8, false, Vec3::Zero());
            const Index upper =
                led(assembly, {0, 2.0 * r, 0}, {0, 2.0 * r, length}, 8, true, sideways ? Vec3(1e-3, 0, 0) : Vec3(0, 0, slide));
            simulation::Simulator<Seen> simulator(assembly, parameters(points));
            const simulation::Report report = simulator.run(loading());
            REQUIRE_MESSAGE(report.converged, report.reason);
            const Vec3 force = force_on(simulator, upper, 8);
            const double line = K * std::pow(sink, m);
            std::printf("%s, %g points: N/N0 %.6f, T %.6f %.6f\n", sideways ? "across" : "along", points,
                        -force.y() / (line * length), force.x(), force.z());
            // Slid by a hundredth of its length the line is shorter by that; slid aside, the normal leans by 0.01, and friction
            // with it.
            CHECK(-force.y() / (line * length) == test::near(sideways ? 1.0 : 0.99, sideways ? 0.02 : 1e-4));
            const double bound = (sideways ? across : a) * std::pow(line, n) * length;
            CHECK((sideways ? force.x() : force.z()) / bound == test::near(sideways ? 1.0 : 0.99, sideways ? 0.02 : 1e-3));
        }
}

TEST_CASE("a crossing sinks by the power law, and the pair's ellipse turns the force aside") {
    scene::Assembly assembly;
    led(assembly, {0, 0, -0.5}, {0, 0, 0.5}, 4, false, Vec3::Zero());
    const double angle = std::numbers::pi / 3.0;
    const Vec3 way(std::sin(angle), 0, std::cos(angle));
    const Index upper =
        led(assembly, Vec3(0, 2.0 * r, 0) - 0.5 * way, Vec3(0, 2.0 * r, 0) + 0.5 * way, 4, true, Vec3(0, 0, slide));
    simulation::Simulator<Seen> simulator(assembly, parameters(1.0));
    const simulation::Report report = simulator.run(loading());
    REQUIRE_MESSAGE(report.converged, report.reason);
    const Vec3 force = force_on(simulator, upper, 4);
    const double N = 50.0 * std::pow(sink, 1.5);
    CHECK(-force.y() / N == test::near(1.0, 1e-6));
    // M = mean of 0.15^2 and 0.3^2 along and across of both, slid along the first: M t / sqrt(t . M t).
    const double c = std::cos(angle), s = std::sin(angle), p = 0.0225, q = 0.09;
    const double along = 0.5 * (p + p * c * c + q * s * s), mixed = 0.5 * (p - q) * c * s;
    CHECK(force.z() / (N * std::sqrt(along)) == test::near(1.0, 1e-6));
    CHECK(force.x() / (N * mixed / std::sqrt(along)) == test::near(1.0, 1e-6));
}

}  // namespace seen_contact_test

// SPDX-License-Identifier: MIT
// A yarn of two plies is wound on a pin by half a turn, and drawn over it, with a friction law of one's own. How much harder the
// leading end is pulled than the trailing one is compared with Euler and Eytelwein.
#include "../own_parts/own_friction.hpp"

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

struct TwistedYarn {
    using Beam = beam::RigidSectionRod;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = SlippingSpring;
    using Solver = solver::SparseCholesky;
    using Tools = contact::RigidTools;
};
static_assert(simulation::Model<TwistedYarn>);

namespace {

constexpr double pi = std::numbers::pi, mu = 0.2;
constexpr double radius = 0.02, pin = 0.5, length = 3.0, turns = 6.0;  // lengths in mm, forces in N
constexpr double rho = pin + 2.0 * radius;                             // from the middle of the pin to that of the yarn

/// A ply: a helix about the line y = rho, which lies on the pin; the axis of the pin is z.
Vec3 ply(double side, double t) {
    const double angle = 2.0 * pi * turns * t;
    return {length * (t - 0.5), rho + side * radius * std::sin(angle), side * radius * std::cos(angle)};
}

/// Way of an end of the yarn, -1 or 1. To amplitude 1 it is wound on by a quarter of a turn, and stretched.
/// To 2 it is drawn on.
Vec3 way(double end, double amplitude) {
    const double wound = std::min(amplitude, 1.0), drawn = 0.1 * std::max(0.0, amplitude - 1.0);
    const double stretch = 0.01 * std::min(1.0, 20.0 * wound);  // taut from the start on
    const double angle = 0.5 * pi * wound, free = 0.5 * length * (1.0 + stretch) - rho * angle;
    return {end * (rho * std::sin(angle) + free * std::cos(angle) - 0.5 * length),
            rho * std::cos(angle) - free * std::sin(angle) - rho - end * drawn, 0.0};
}

}  // namespace

int main() {
    scene::Assembly assembly;
    for (const double side : {-1.0, 1.0})
        assembly.add({.curve = [=](double t) { return ply(side, t); },
                      .section = scene::circular(radius),
                      .material = {.young_modulus = 7300.0, .poisson_ratio = 0.3},
                      .elements = 96});
    assembly.add(scene::Tool{.name = "pin", .shape = scene::ToolShape::cylinder, .radius = pin});

    for (const Index fibre : {0, 1})
        for (const double end : {-1.0, 1.0}) {
            scene::Hold hold;
            hold.at = end < 0.0 ? scene::first_end(fibre) : scene::last_end(fibre);
            hold.channel = "draw";
            hold.path = [=](double amplitude) { return way(end, amplitude); };
            assembly.hold(hold);
            assembly.hold_axial_rotation(hold.at);
        }

    simulation::ModelParameters<TwistedYarn> parameters;
    parameters.normal.regularisation_depth = 1e-3 * radius;
    parameters.friction = {.friction_coefficient = mu, .stiffness = 1.0};
    parameters.contact.stiffness.allowed_penetration = 1e-2 * radius;

    simulation::Loading<TwistedYarn> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "wind", loading.stages[0].increments = 20, loading.stages[0].ramps = {{"draw", 1.0}};
    loading.stages[1].name = "draw", loading.stages[1].increments = 10, loading.stages[1].ramps = {{"draw", 2.0}};

    simulation::Simulator<TwistedYarn> simulator(assembly, parameters);
    const simulation::Report report = simulator.run(loading);
    if (!report.converged) std::printf("stopped: %s\n", report.reason.c_str());
    const simulation::Audit audit = simulation::audit(simulator);

    const auto pull = [&](auto end) { return (simulator.reaction(end(0)) + simulator.reaction(end(1))).norm(); };
    const double slack = pull(scene::first_end), tight = pull(scene::last_end), ratio = tight / slack;
    // It rubs on the skin of the pin, and pulls on the line of the yarn.
    const double expected = std::exp(mu * pi * pin / rho);
    std::printf("pulls %.4f and %.4f N, ratio %.4f, of a smooth yarn %.4f\n", slack, tight, ratio, expected);
    // That line is between 1 and 2 radii off the skin, for plies take turns to lie below: 2.5 % of the ratio.
    const bool close = std::abs(ratio - expected) < 0.03 * expected;
    return report.converged && audit.clean() && close ? 0 : 1;
}

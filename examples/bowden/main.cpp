// SPDX-License-Identifier: MIT
// A Bowden cable: a wire is pulled through a bent housing that is held at its two ends and gives way between them. The program
// fails where the forces at the wire's ends are not those of a rope on a capstan.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
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

namespace {

struct Bowden {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Bowden>);

// Lengths in mm, forces in N.
constexpr double radius = 60.0, angle = 0.5 * std::numbers::pi, arc = radius * angle, tail = 4.0;
constexpr double wire_radius = 0.75, bore = 1.0, outside = 2.5, friction = 0.1, weight = 30.0, travel = 2.0;
constexpr double slip = 0.01, depth = 0.005;  // reversible displacement, allowed penetration

/// At a length along the housing, and straight on beyond both of its ends.
Vec3 place(double s) {
    const double on = std::clamp(s, 0.0, arc), turn = on / radius, off = s - on;
    return {radius * std::sin(turn) + off * std::cos(turn), radius * (1.0 - std::cos(turn)) + off * std::sin(turn), 0.0};
}

scene::Assembly cable() {
    scene::FibreSpecification housing, wire;
    housing.curve = [](double t) { return place(t * arc); };
    housing.section = scene::hollow(outside, bore), housing.material = {2000.0, 0.3}, housing.elements = 16;
    wire.curve = [](double t) { return place(t * (arc + 2.0 * tail) - tail); };
    wire.section = scene::circular(wire_radius), wire.material = {20000.0, 0.3}, wire.elements = 18;
    scene::Assembly assembly;
    const Index outer = assembly.add(housing), inner = assembly.add(wire);
    assembly.add(scene::Tube{outer, {inner}});
    assembly.clamp(scene::first_end(outer)), assembly.clamp(scene::last_end(outer));
    // A load at one end of the wire, and the lever at the other one, which leaves it free across.
    assembly.apply(scene::DeadForce{.at = scene::first_end(inner), .force = {-weight, 0, 0}});
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    scene::Hold lever;
    lever.at = scene::last_end(inner), lever.directions = along * along.transpose(), lever.displacement = travel * along;
    lever.channel = "lever";
    assembly.hold(lever);
    assembly.hold_axial_rotation(scene::first_end(inner));
    return assembly;
}

}  // namespace

int main() {
    const scene::Assembly assembly = cable();
    simulation::ModelParameters<Bowden> parameters;
    parameters.normal.regularisation_depth = 0.1 * depth;
    parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = slip};
    parameters.contact.stiffness.allowed_penetration = depth;
    simulation::Simulator<Bowden> simulator(assembly, parameters);

    simulation::Loading<Bowden> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "load", loading.stages[0].increments = 4, loading.stages[0].ramps = {{"load", 1.0}};
    loading.stages[1].name = "pull", loading.stages[1].increments = 10, loading.stages[1].ramps = {{"lever", 1.0}};
    loading.stages[1].friction.emplace(law::RegularisedCoulomb::Parameters{friction, slip});
    const simulation::Report report = simulator.run(loading);
    if (!report.converged) return std::printf("stopped: %s\n", report.reason.c_str()), 1;

    const double pull = simulator.reaction(scene::last_end(1)).norm(), ratio = pull / weight,
                 moved = (simulator.value(scene::first_end(1)) - place(-tail)).norm();
    // Friction acts on the wire's skin, nearer to the middle of the bend than its axis.
    const double expected = std::exp(friction * angle * (1.0 - wire_radius / radius));
    std::printf("pull %.3f N against %.0f N: %.4f, by e^(mu theta (1 - r / R)) %.4f\n", pull, weight, ratio, expected);
    std::printf("lever %.3f mm, load %.3f mm; middle of the housing moves by %.3f mm\n", travel, moved,
                (simulator.value({0, 0.5}) - place(0.5 * arc)).norm());
    const simulation::Audit audit = simulation::audit(simulator);
    std::printf("least gap of wire and housing %.4f mm, allowed -%.4f mm\n", audit.bore_gap.gap, audit.allowed);
    // The housing gives way, and some straight wire is bent at its mouth.
    const bool good = std::abs(ratio / expected - 1.0) < 5e-3 && audit.clean();
    return good ? 0 : 1;
}

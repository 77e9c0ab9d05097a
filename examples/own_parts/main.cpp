// SPDX-License-Identifier: MIT
// A model of one's own parts: force, normal law, friction law with memory, search, observer; each is a header beside this file,
// and a row of a model. What they do is compared with closed forms; the program fails where it differs.
#include "own_force.hpp"
#include "own_friction.hpp"
#include "own_normal_law.hpp"
#include "own_observer.hpp"
#include "own_search.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/proximity/brute_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace fibrant;

struct OwnParts {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = SweepSearch;
    using Normal = PowerLaw;
    using Friction = SlippingSpring;
    using Solver = solver::SparseCholesky;
    using Acts = term::List<SoftBed>;
};
static_assert(simulation::Model<OwnParts>);

namespace {

constexpr double radius = 0.02;  // lengths in mm, forces in N
const scene::CrossSection section = scene::circular(radius);
const scene::ElasticMaterial material{.young_modulus = 7300.0, .poisson_ratio = 0.3};

simulation::ModelParameters<OwnParts> parameters(double bed) {
    simulation::ModelParameters<OwnParts> all;
    all.acts.bed.stiffness = bed;
    all.normal.depth = 1e-2 * radius;
    all.friction = {.friction_coefficient = 0.2, .stiffness = 1.0};
    all.contact.stiffness.allowed_penetration = 1e-2 * radius;
    return all;
}

bool close(const char* what, double value, double expected, double tolerance) {
    const bool good = std::abs(value - expected) <= tolerance * std::abs(expected);
    std::printf("%s: %.6g, expected %.6g%s\n", what, value, expected, good ? "" : "  <-- differs");
    return good;
}

/// A force across the end of a long beam in a bed moves it by 2 P b / k, b = (k / (4 E I))^(1/4) (Hetenyi).
bool beam_in_a_bed() {
    const double inertia = std::pow(radius, 4) * std::acos(-1.0) / 4.0, bed = 0.5, force = 1e-4;
    const double b = std::pow(bed / (4.0 * material.young_modulus * inertia), 0.25);
    scene::Assembly assembly;
    const Index fibre =
        assembly.add({.from = {0, 0, 0}, .to = {8.0 / b, 0, 0}, .section = section, .material = material, .elements = 40});
    assembly.hold_position(scene::last_end(fibre));  // eight lengths away: it feels nothing
    assembly.hold_axial_rotation(scene::last_end(fibre));
    assembly.apply(scene::DeadForce{.at = scene::first_end(fibre), .force = {0, 0, force}});
    simulation::Simulator<OwnParts> simulator(assembly, parameters(bed));
    const simulation::Report report = simulator.run({.increments = 2});
    if (!report.converged) return std::printf("stopped: %s\n", report.reason.c_str()), false;
    // Shear adds (r b)^2 of it, of the order of 1e-3; what was put in is stored in beam and bed.
    const double moved = 2.0 * force * b / bed;
    const bool end = close("end of a beam in a bed [mm]", simulator.value(scene::first_end(fibre)).z(), moved, 5e-3);
    return close("energy stored [N mm]", report.energy.elastic, 0.5 * force * moved, 1e-2) && end;
}

/// A fibre is pressed on another one, then drawn along it: all that touches slides, and is held by mu times what presses.
bool drawn_over_another() {
    scene::Assembly assembly;
    const Index lower =
        assembly.add({.from = {0, -0.5, 0}, .to = {0, 0.5, 0}, .section = section, .material = material, .elements = 16});
    const Index upper = assembly.add({.from = {-0.5, 0, 2.0 * radius},
                                      .to = {0.5, 0, 2.0 * radius},
                                      .section = section,
                                      .material = material,
                                      .elements = 16});
    for (const scene::Station at : {scene::first_end(lower), scene::last_end(lower)}) assembly.clamp(at);
    for (const scene::Station at : {scene::first_end(upper), scene::last_end(upper)}) {
        scene::Hold path;
        path.at = at, path.channel = "way";
        path.path = [](double way) { return Vec3(0, std::max(0.0, way - 1.0) * radius, -std::min(way, 1.0) * 0.4 * radius); };
        assembly.hold(path);
        assembly.hold_rotation(at);
    }
    simulation::Simulator<OwnParts> simulator(assembly, parameters(0.0));
    simulation::Loading<OwnParts> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "press", loading.stages[0].increments = 4, loading.stages[0].ramps = {{"way", 1.0}};
    loading.stages[1].name = "draw", loading.stages[1].increments = 10, loading.stages[1].ramps = {{"way", 2.0}};
    FrictionCarried carried;
    const simulation::Report report = simulator.run(loading, carried);
    if (!report.converged) return std::printf("stopped: %s\n", report.reason.c_str()), false;
    const Vec3 held = simulator.reaction(scene::first_end(upper)) + simulator.reaction(scene::last_end(upper));
    const bool bound = close("friction over reaction", carried.friction / carried.reaction, 0.2, 1e-3);
    return close("what supports carry [N]", held.norm(), std::hypot(carried.reaction, carried.friction), 1e-3) && bound;
}

/// The search finds what trying every pair of segments finds, of fibres in all directions.
bool search_is_complete() {
    std::vector<std::vector<Vec3>> points;
    std::vector<proximity::Centreline> fibres;
    for (int f = 0; f < 12; ++f) {
        points.emplace_back();
        for (int k = 0; k <= 20; ++k)  // waves of different slope and phase
            points.back().push_back({0.1 * k, 0.1 * f + 0.2 * std::sin(0.5 * k + f), 0.1 * std::cos(0.3 * k * f)});
    }
    for (const std::vector<Vec3>& line : points) fibres.push_back({.points = line, .radius = 0.03});
    const auto found = SweepSearch().pairs(fibres, 0.02), all = proximity::BruteSearch().pairs(fibres, 0.02);
    std::printf("search: %zu pairs, of all tried %zu\n", found.size(), all.size());
    return found == all && !all.empty();
}

}  // namespace

int main() {
    const bool bed = beam_in_a_bed(), drawn = drawn_over_another(), complete = search_is_complete();
    return bed && drawn && complete ? 0 : 1;
}

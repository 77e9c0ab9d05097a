// SPDX-License-Identifier: MIT
// How far are single fibres from closed forms at large deflection: a ring under two forces, a hanging fibre, a loop under
// tension, a fibre wound on a cylinder and drawn?
// usage: benchmark_validation_closed_forms_bench [ring] [hanging] [loop] [wound]; prints form,case,expected,computed,deviation
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/load/gravity.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

using namespace fibrant;

namespace {

constexpr double pi = std::numbers::pi;

struct Single {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
    using Tools = contact::RigidTools;
    using Acts = term::List<load::Gravity>;
};
using Simulator = simulation::Simulator<Single>;

void print(const char* form, const std::string& name, double expected, double computed) {
    std::printf("%s,%s,%.6g,%.6g,%.2e\n", form, name.c_str(), expected, computed, computed / expected - 1.0);
    std::fflush(stdout);
}

simulation::ModelParameters<Single> parameters(double radius) {
    simulation::ModelParameters<Single> p;
    p.normal.regularisation_depth = 1e-3 * radius;
    p.contact.stiffness.allowed_penetration = 1e-2 * radius;
    p.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * radius};
    p.acts.gravity.weight = Vec3::Zero();
    return p;
}

/// Material of unit bending stiffness.
scene::ElasticMaterial unit(double radius) { return {.young_modulus = 4.0 / (pi * std::pow(radius, 4)), .poisson_ratio = 0.3}; }

void run(Simulator& simulator, const std::vector<simulation::Stage<Single>>& stages) {
    const simulation::Report report = simulator.run(simulation::Loading<Single>{.stages = stages});
    if (!report.converged) throw std::runtime_error(report.reason);
}

/// Every node stays in the plane z = 0.
void keep_in_plane(scene::Assembly& assembly, Index intervals) {
    for (Index k = 0; k <= intervals; ++k)
        assembly.hold_position({0, static_cast<double>(k) / static_cast<double>(intervals)}, Vec3(0, 0, 1).asDiagonal());
}

/// A thin ring of unit radius under two opposite forces. Expected: plane elastica.
void ring() {
    struct Case {
        double force, along, across;
    };
    const double radius = 0.002;
    for (const Case& one : {Case{-1.0, 1.8330562, 2.1412203}, {-0.5, 1.921201, 2.0695799}, {0.5, 2.0702675, 1.9331297}}) {
        scene::Assembly assembly;
        assembly.add({.curve = [](double t) { return Vec3(std::cos(2.0 * pi * t), std::sin(2.0 * pi * t), 0.0); },
                      .section = scene::circular(radius),
                      .material = unit(radius),
                      .elements = 60,
                      .closed = true});
        assembly.hold_position({0, 0.75});
        assembly.hold_position({0, 0.25}, Vec3(1, 0, 1).asDiagonal());
        assembly.hold_position({0, 0.0}, Vec3(0, 0, 1).asDiagonal());
        assembly.apply(scene::DeadForce{.at = {0, 0.25}, .force = Vec3(0, one.force, 0)});
        Simulator simulator(assembly, parameters(radius));
        simulation::Stage<Single> stage;
        stage.increments = 4, stage.ramps = {{"load", 1.0}};
        run(simulator, {stage});
        const auto diameter = [&](double from, double to) {
            return (simulator.value(scene::Station{0, to}) - simulator.value(scene::Station{0, from})).norm();
        };
        const std::string name = "F R^2 / E I = " + core::text(one.force);
        print("ring", name + "; along the forces", one.along, diameter(0.75, 0.25));
        print("ring", name + "; across", one.across, diameter(0.5, 0.0));
    }
}

/// A fibre 1.1 spans long that hangs between two points. Expected: elastic catenary of w L / (E A) = 1e-3.
void hanging() {
    const double radius = 5e-4, length = 1.1, parabola = 0.2;
    const scene::ElasticMaterial material{.young_modulus = 1.0 / (pi * radius * radius), .poisson_ratio = 0.3};
    scene::Assembly assembly;
    constexpr Index elements = 60;
    // Nearly a parabola of that length, straight at rest.
    assembly.add({.from = {0, 0, 0},
                  .to = {length, 0, 0},
                  .start = [parabola](double t) { return Vec3(t, -4.0 * parabola * t * (1.0 - t), 0.0); },
                  .section = scene::circular(radius),
                  .material = material,
                  .elements = elements,
                  .director = Vec3::UnitZ()});
    assembly.prescribe(scene::first_end(0), Vec3::Zero()), assembly.hold_axial_rotation(scene::first_end(0));
    assembly.hold_position(scene::last_end(0));
    keep_in_plane(assembly, 2 * elements);
    auto p = parameters(radius);
    p.acts.gravity.weight = Vec3(0, -1e-3 / length / (pi * radius * radius), 0);
    Simulator simulator(assembly, p);
    simulation::Stage<Single> stage;
    stage.increments = 2, stage.ramps = {{"gravity", 1.0}}, stage.damping = 1e-3;
    simulation::Stage<Single> rest = stage;
    rest.name = "rest", rest.ramps.clear(), rest.damping_goes_on = true, rest.damping_decay = 0.1;
    rest.until = [](const simulation::IncrementReport& increment) { return increment.damping <= 1e-9; };
    run(simulator, {stage, rest});
    const Vec3 reaction = simulator.reaction(scene::last_end(0));
    print("hanging", "horizontal tension", 0.00059296895, reaction.x());
    print("hanging", "tension at the ends", 0.00077563663, reaction.norm());
    print("hanging", "sag", 0.20107194, -simulator.value(scene::Station{0, 0.5}).y());
}

/// A plane loop in a long fibre under tension. Expected: F (ends' way)^2 / E I = 16 (infinite fibre).
void loop() {
    const double radius = 0.005, half = 10.0;  // lengths sqrt(E I / F) as the loop is laid
    constexpr Index elements = 240;
    // Tangent angle 4 atan e^s; x = s - 2 tanh s, y = 2 sech s.
    scene::Assembly assembly;
    const auto shape = [half](double t) {
        const double s = half * (2.0 * t - 1.0);
        return Vec3(s - 2.0 * std::tanh(s), 2.0 / std::cosh(s), 0.0);
    };
    assembly.add({.from = {-half, 0, 0},
                  .to = {half, 0, 0},
                  .start = shape,
                  .section = scene::circular(radius),
                  .material = unit(radius),
                  .elements = elements,
                  .director = Vec3::UnitZ()});
    assembly.hold_position(scene::first_end(0)), assembly.hold_axial_rotation(scene::first_end(0));
    scene::Hold end;
    end.at = scene::last_end(0), end.channel = "draw", end.displacement = Vec3::UnitX();
    assembly.hold(end);
    keep_in_plane(assembly, 2 * elements);
    Simulator simulator(assembly, parameters(radius));
    for (const double drawn : {0.0, 1.0, 2.0}) {
        simulation::Stage<Single> stage;
        stage.increments = 10, stage.ramps = {{"draw", drawn}};
        run(simulator, {stage});
        const double force = simulator.reaction(scene::last_end(0)).x(),
                     way = 2.0 * half - (simulator.value(scene::last_end(0)) - simulator.value(scene::first_end(0))).x();
        print("loop", "ends' way " + core::text(4.0 - drawn) + "; F way^2 / E I", 16.0, force * way * way);
    }
}

/// A fibre wound on a cylinder by an angle theta over a length L of itself, and drawn. Expected without bending: tensions in
/// the ratio of e^(mu theta sin beta), sin beta = rho theta / L, so that the exponent is mu theta^2 rho / L.
void wound() {
    const double radius = 0.01, rho = 1.0, length = 20.0, tail = 1.0, strain = 0.003;
    for (const double mu : {0.3, 0.5})
        for (const double turns : {0.5, 1.0, 1.5, 2.0}) {
            const double theta = 2.0 * pi * turns, sine = rho * theta / length, cosine = std::sqrt(1.0 - sine * sine);
            const double whole = length + 2.0 * tail;
            const auto elements = static_cast<Index>(std::ceil(whole / (0.06 / std::max(sine, 0.3))));
            const auto shape = [=](double t) {
                const double s = whole * t - tail, on = std::clamp(s, 0.0, length), a = on * sine / rho, off = s - on;
                const Vec3 along(cosine, -sine * std::sin(a), sine * std::cos(a));
                return Vec3(Vec3(on * cosine, rho * std::cos(a), rho * std::sin(a)) + off * along);
            };
            scene::Assembly assembly;
            assembly.add({.from = {0, 0, 0},
                          .to = {whole, 0, 0},
                          .start = shape,
                          .section = scene::circular(radius),
                          .material = unit(radius),
                          .elements = elements});
            scene::Tool guide;
            guide.shape = scene::ToolShape::cylinder, guide.axis = Vec3::UnitX(), guide.radius = rho - radius,
            guide.channel = "ends";
            assembly.add(guide);
            const double stretch = 0.5 * strain * whole, drawn = 2.0 * stretch;  // beyond what friction holds along the way
            const Vec3 first(cosine, 0.0, sine), last(cosine, -sine * std::sin(theta), sine * std::cos(theta));
            for (const bool taut : {false, true}) {
                scene::Hold end;
                end.at = taut ? scene::last_end(0) : scene::first_end(0), end.channel = "ends";
                end.path = [=](double a) {
                    const double out = stretch * std::min(a, 1.0), on = drawn * std::max(0.0, a - 1.0);
                    return taut ? Vec3((out + on) * last) : Vec3((on - out) * first);
                };
                assembly.hold(end);
            }
            assembly.hold_axial_rotation(scene::first_end(0));
            Simulator simulator(assembly, parameters(radius));
            simulation::Stage<Single> tighten, draw;
            tighten.name = "tighten", tighten.increments = 4, tighten.ramps = {{"ends", 1.0}}, tighten.damping = 1e-3;
            draw.name = "draw", draw.increments = 20, draw.ramps = {{"ends", 2.0}};
            draw.friction.emplace(law::RegularisedCoulomb::Parameters{mu, 0.02 * radius});
            run(simulator, {tighten, draw});
            const double slack = simulator.reaction(scene::first_end(0)).norm(),
                         pull = simulator.reaction(scene::last_end(0)).norm();
            print("wound", "mu " + core::text(mu) + "; turns " + core::text(turns) + "; log of the ratio", mu * theta * sine,
                  std::log(pull / slack));
        }
}

}  // namespace

int main(int count, char** arguments) {
    const std::vector<std::string> chosen(arguments + 1, arguments + count);
    std::printf("form,case,expected,computed,deviation\n");
    int status = 0;
    const auto form = [&](const char* name, void (*solve)()) {
        if (!chosen.empty() && std::find(chosen.begin(), chosen.end(), name) == chosen.end()) return;
        try {
            solve();
        } catch (const std::exception& error) {
            std::fprintf(stderr, "%s: %s\n", name, error.what()), status = 1;
        }
    };
    form("ring", ring), form("hanging", hanging), form("loop", loop), form("wound", wound);
    return status;
}

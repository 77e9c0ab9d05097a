// SPDX-License-Identifier: MIT
// Loads that simulations move fibres with, against closed forms.
#include "load_scene.hpp"

#include <near.hpp>

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/load.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <doctest/doctest.h>

#include <refusal.hpp>

using namespace fibrant;

namespace loads_test {

using test::fibre;
using Cable = beam::KirchhoffCable;

struct Weighted {
    using Beam = Cable;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
    using Acts = term::List<load::Gravity, load::LineLoads>;
};
static_assert(simulation::Model<Weighted>);

simulation::ModelParameters<Weighted> parameters() {
    simulation::ModelParameters<Weighted> all;
    all.normal.regularisation_depth = 1e-5;
    all.contact.stiffness.allowed_penetration = 1e-4;
    all.acts.gravity.weight = Vec3::Zero();
    return all;
}

TEST_CASE("a fibre that hangs in a stream lies along weight and drag, and stretches by half of what both do at its end") {
    // Both are uniform by rest length: the tension at s is |q| (L - s), along q, and the stretch |q| L^2 / (2 E A).
    scene::Assembly assembly;
    const double length = 1.0, area = scene::circular(0.01).area(), stiffness = 1000.0 * area;
    assembly.add(fibre({0, 0, 0}, {0, 0, -length}, 8));
    assembly.hold_position(scene::first_end(0));
    simulation::ModelParameters<Weighted> all = parameters();
    const Vec3 weight(0, 0, -4e-3 * stiffness / length), drag(3e-3 * stiffness / length, 0, 0);
    all.acts.gravity.weight = weight / area;
    all.acts.lines.loads.push_back({.fibre = 0, .force = drag, .channel = "stream"});
    simulation::Simulator<Weighted> simulator(assembly, all);
    simulation::Loading<Weighted> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "weight", loading.stages[0].increments = 2, loading.stages[0].ramps = {{"gravity", 1.0}};
    loading.stages[1].name = "stream", loading.stages[1].increments = 8, loading.stages[1].ramps = {{"stream", 1.0}};
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const Vec3 q = weight + drag, end = simulator.value(scene::last_end(0)) - simulator.value(scene::first_end(0));
    // Green-Lagrange strains and bending at the support differ from the formula by the square of the strain, 2.5e-3.
    CHECK(end.normalized().cross(q.normalized()).norm() < 1e-3);
    CHECK(end.norm() - length == test::near(q.norm() * length * length / (2.0 * stiffness), 1e-2));
    CHECK((simulator.reaction(scene::first_end(0)) + length * q).norm() < 1e-3 * q.norm() * length);
    // What the weight does while it grows is stored: w^2 L^3 / (6 E A). Strains of 4e-3 are not small to their first order.
    const simulation::EnergyBalance& energy = report.increments[1].energy;
    const double stored = weight.squaredNorm() * length * length * length / (6.0 * stiffness);
    CHECK(energy.elastic == test::near(stored, 1e-2));
    CHECK(energy.external == test::near(stored, 1e-2));
}

TEST_CASE("a slack fibre that hangs between two points has the tension and the sag of the elastic catenary") {
    // 1.1 spans long, w L / (E A) = 1e-3. Bending takes a part of 1e-3, E I / (w span^3) = 6e-5.
    const double radius = 5e-4, length = 1.1, area = scene::circular(radius).area();
    scene::Assembly assembly;
    assembly.add({.from = {0, 0, 0},
                  .to = {length, 0, 0},
                  .start = [](double t) { return Vec3(t, -0.8 * t * (1.0 - t), 0.0); },
                  .section = scene::circular(radius),
                  .material = {1.0 / area, 0.3},
                  .elements = 40});
    for (const scene::Station& end : {scene::first_end(0), scene::last_end(0)}) assembly.hold_position(end);
    simulation::ModelParameters<Weighted> all = parameters();
    all.acts.gravity.weight = Vec3(0, -1e-3 / length / area, 0);
    simulation::Simulator<Weighted> simulator(assembly, all);
    simulation::Loading<Weighted> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "weight", loading.stages[0].increments = 2, loading.stages[0].ramps = {{"gravity", 1.0}};
    loading.stages[0].damping = 1e-3;  // nothing is taut to begin with
    loading.stages[1].name = "rest", loading.stages[1].damping_goes_on = true, loading.stages[1].damping_decay = 0.1;
    loading.stages[1].until = [](const simulation::IncrementReport& increment) { return increment.damping <= 1e-9; };
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const Vec3 held = simulator.reaction(scene::last_end(0));
    CHECK(held.x() == test::near(0.00059296895, 2e-3));
    CHECK(held.norm() == test::near(0.00077563663, 2e-3));
    CHECK(-simulator.value(scene::Station{0, 0.5}).y() == test::near(0.20107194, 1e-3));
}

TEST_CASE("loads that nothing carries are refused by name") {
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {1, 0, 0}, 2));
    const auto build = [&](auto change) {
        simulation::ModelParameters<Weighted> all = parameters();
        change(all);
        simulation::Simulator<Weighted> simulator(assembly, all);
    };
    CHECK(test::refusal([&] { build([](auto& all) { all.acts.gravity.weight[1] = core::unset; }); }).find("Gravity.weight") !=
          std::string::npos);
    CHECK(test::refusal([&] {
              build([](auto& all) { all.acts.lines.loads.push_back({.fibre = 1, .force = Vec3::UnitX()}); });
          }).find("LineLoads.Load.fibre = 1") != std::string::npos);
    CHECK(test::refusal([&] {
              build([](auto& all) {
                  all.acts.lines.loads.push_back({.fibre = 0, .force = Vec3::UnitX(), .from = 0.5, .to = 0.5});
              });
          }).find("LineLoads.Load.to = 0.5") != std::string::npos);
}

}  // namespace loads_test

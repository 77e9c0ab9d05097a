// SPDX-License-Identifier: MIT
// A knot is tied in a straight rod, comes to rest and is drawn tight; prints the pull beside that of loose knots.
//   knot SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/knot/overhand_knot.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;
namespace knot = compositions::knot;

struct Knot {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};

bool solve(example::TomlReader& file, const example::Output& output) {
    knot::KnotParameters parameters;
    Index crossings = 3, increments = 20;
    double drawn = 0.0, mu = 0.0;
    file.require("knot", "radius", parameters.radius);
    file.require("knot", "loop_radius", parameters.loop_radius);
    file.require("knot", "tail", parameters.tail);
    file.read("knot", "crossings", crossings);
    file.read("knot", "elements", parameters.elements);
    file.require("material", "young_modulus", parameters.material.young_modulus);
    file.require("material", "poisson_ratio", parameters.material.poisson_ratio);
    file.read("contact", "friction_coefficient", mu);
    file.read("loading", "draw", drawn);
    file.read("loading", "increments", increments);
    file.refuse_unknown();
    parameters.crossings = static_cast<int>(crossings);
    parameters.validate();

    const double radius = parameters.radius, R = parameters.loop_radius;
    const double bending = 0.25 * std::numbers::pi * parameters.material.young_modulus * std::pow(radius, 4);
    simulation::ModelParameters<Knot> model;
    model.normal = {.regularisation_depth = 1e-3 * radius};
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * radius};
    model.contact.stiffness.allowed_penetration = 1e-2 * radius;
    model.contact.stiffness.initial_fraction = knot::initial_stiffness_fraction(parameters);
    model.contact.stiffness.floor_fraction = 1e-6;
    model.contact.detection.self_contact = true;
    model.iteration.newton_limit = 30;
    simulation::Simulator<Knot> simulator(knot::tied_rod(parameters), model);
    const auto loose = [&](const knot::KnotState& state) { return 0.5 * bending * std::pow(2.0 * std::numbers::pi / state.shortening, 2); };
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const knot::KnotState state = knot::measure(simulator, parameters);
        return {{"shortening", state.shortening}, {"force", state.force}, {"force_of_loose_knots", loose(state)}, {"contact_force", state.contact_force}};
    });
    simulation::Loading<Knot> loading;
    loading.stages.resize(drawn > 0.0 ? 2 : 1);
    simulation::Stage<Knot>& settle = loading.stages[0];  // without friction: it would hold the knot as it is tied
    settle.name = "settle", settle.increments = 2, settle.most_increments = 80;
    settle.damping = 10.0 * bending / (R * R * R) / static_cast<double>(parameters.elements);
    settle.damping_decay = 0.5, settle.damping_share = 1e-3;
    settle.until = simulation::until_settled(0.05 * radius, 0.02 * radius);
    settle.friction.emplace(law::RegularisedCoulomb::Parameters{0.0, 0.02 * radius});
    if (drawn > 0.0) {
        simulation::Stage<Knot>& tighten = loading.stages[1];
        tighten.name = "draw", tighten.increments = increments, tighten.most_increments = 20 * increments;
        tighten.ramps = {{knot::draw, drawn}};
        tighten.friction.emplace(model.friction);
        tighten.damping = 0.1 * settle.damping;  // what slides along itself without friction has nothing else to hold it
    }
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const knot::KnotState state = knot::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -90.0, 60.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    example::write_summary(output, report, audit, radius, {{"force", state.force}, {"force_of_loose_knots", loose(state)}, {"shortening", state.shortening},
                           {"radius_over_loop_radius", 2.0 * std::numbers::pi * radius / state.shortening}, {"imbalance", state.imbalance}});
    return report.converged && audit.clean();
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "knot", "Ties a knot in a straight rod and draws it tight.", solve);
}

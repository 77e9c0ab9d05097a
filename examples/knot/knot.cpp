// SPDX-License-Identifier: MIT
// A knot is tied in a straight rod, comes to rest, is drawn tight and let back; prints the pull beside that of loose knots. A
// polymer's relaxes while it is held: [material.law] kind = "viscoelastic".
//   knot SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/compositions/knot/overhand_knot.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/material/viscoelastic.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <type_traits>

using namespace fibrant;
namespace knot = compositions::knot;

namespace {

/// @tparam Section  law of the rod
template <class Section>
struct KnotOf {
    using Beam = beam::With<beam::DirectorBeam<>, Section>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};

using Polymer = material::Viscoelastic<1>;

/// What the scene file asks for.
struct Asked {
    knot::KnotParameters parameters;
    Polymer::Parameters polymer;
    Index increments = 20;
    double drawn = 0.0, back = 0.0, mu = 0.0, duration = 0.0, hold = 0.0;
};

template <class Section>
bool tie(const Asked& asked, const example::SceneReader& file, example::Output& output);

bool solve(example::SceneReader& file, example::Output& output) {
    Asked asked;
    knot::KnotParameters& parameters = asked.parameters;
    Index crossings = 3, &increments = asked.increments;
    double &drawn = asked.drawn, &back = asked.back, &mu = asked.mu;
    std::string kind = "elastic";
    file.require("knot", "radius", parameters.radius, example::positive(), "length", "radius of the rod");
    file.require("knot", "loop_radius", parameters.loop_radius, example::positive(), "length",
                 "radius of the loop in which the knot is tied");
    file.require("knot", "tail", parameters.tail, example::positive(), "length",
                 "length of the rod beyond the knot, on each side");
    file.read("knot", "crossings", crossings,
              {.low = 3, .high = 15, .said = "an odd number from 3 to 15", .values = {3, 5, 7, 9, 11, 13, 15}},
              "crossings of the knot: 3 overhand, 5 double overhand");
    file.read("knot", "elements", parameters.elements, example::between(16, 100000), "elements along the rod");
    example::read_material(file, "material", parameters.material);
    file.read("material.law", "kind", kind, {"elastic", "viscoelastic"}, "how the rod behaves");
    const bool shared = file.read("material.law", "share", asked.polymer.share[0], example::inside(0.0, 1.0), "1",
                                  "part of the modulus that relaxes"),
               timed = file.read("material.law", "time", asked.polymer.time[0], example::positive(), "time",
                                 "time in which it falls by 1/e");
    example::read_friction(file, mu, "coefficient of friction of the rod on itself");
    file.read("loading", "draw", drawn, example::not_negative(), "length", "length by which one end is drawn out");
    file.read("loading", "back", back, example::not_negative(), "length", "length by which it is let back then");
    file.read("loading", "increments", increments, example::increments(),
              "increments of the drawing, of the way back and of the holding");
    file.read("loading", "duration", asked.duration, example::not_negative(), "time",
              "how long tying takes, and drawing likewise, for a rod that is viscoelastic");
    file.read("loading", "hold", asked.hold, example::not_negative(), "time",
              "how long the ends are held after that, for a rod that is viscoelastic");
    file.complete();
    parameters.crossings = static_cast<int>(crossings);
    const double least = parameters.least_loop_radius();
    file.check(parameters.loop_radius > least, "knot", "loop_radius",
               "> " + core::text(least / parameters.radius) + " knot.radius = " + core::text(least) +
                   ", for knot.crossings = " + std::to_string(crossings));
    file.check(parameters.loop_radius <= 1e5 * parameters.radius, "knot", "loop_radius",
               "<= 100000 knot.radius = " + core::text(1e5 * parameters.radius));
    file.check(parameters.tail <= 1000.0 * parameters.loop_radius, "knot", "tail",
               "<= 1000 knot.loop_radius = " + core::text(1000.0 * parameters.loop_radius));
    const double around = 2.0 * std::numbers::pi * parameters.loop_radius;
    file.check(drawn < around, "loading", "draw", "< the length of the loop, " + core::text(around));
    file.check(back <= drawn, "loading", "back", "<= loading.draw = " + core::text(drawn));
    const double length = 2.0 * parameters.tail + around, element = length / static_cast<double>(parameters.elements);
    file.check(element >= parameters.radius, "knot", "elements",
               "<= " + core::text(std::floor(length / parameters.radius)) + ", or elements are shorter than a radius");
    example::require_room(file, "knot", "elements", example::unknowns_of(1, parameters.elements), 20000.0);
    file.names({{"KnotParameters.", "knot."}, {"fibre.start: turn", "knot.elements is too small: turn"}});
    parameters.validate();
    const Index fewest = knot::TiedShape(parameters).least_elements();
    file.check(parameters.elements >= fewest, "knot", "elements",
               ">= " + std::to_string(fewest) + ", or an element of the braid goes round by more than half a turn");
    const bool flows = kind == "viscoelastic";
    const std::string when = flows ? "given, for kind = \"viscoelastic\"" : "left out, for kind = \"elastic\"";
    file.check(shared == flows, "material.law", "share", when);
    file.check(timed == flows, "material.law", "time", when);
    file.check((asked.duration > 0.0) == flows, "loading", "duration", flows ? "> 0, for kind = \"viscoelastic\"" : when);
    file.check(flows || asked.hold == 0.0, "loading", "hold", when);
    if constexpr (example::has_own_laws)
        if (flows) return tie<Polymer>(asked, file, output);
    file.check(!flows, "material.law", "kind", example::no_own_laws);
    return tie<beam::Isotropic>(asked, file, output);
}

template <class Section>
bool tie(const Asked& asked, const example::SceneReader& file, example::Output& output) {
    using Knot = KnotOf<Section>;
    const knot::KnotParameters& parameters = asked.parameters;
    const Index increments = asked.increments;
    const double drawn = asked.drawn, back = asked.back, mu = asked.mu;

    const double radius = parameters.radius, R = parameters.loop_radius;
    const double bending = 0.25 * std::numbers::pi * parameters.material.young_modulus * std::pow(radius, 4);
    simulation::ModelParameters<Knot> model;
    if constexpr (std::is_same_v<Section, Polymer>) model.beam.laws = {asked.polymer};
    model.normal = {.regularisation_depth = 1e-3 * radius};
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * radius};
    model.contact.stiffness.allowed_penetration = 1e-2 * radius;
    model.contact.stiffness.initial_fraction = knot::initial_stiffness_fraction(parameters);
    model.contact.stiffness.floor_fraction = 1e-6;
    model.contact.detection.self_contact = true;
    model.iteration.newton_limit = 30;
    simulation::Simulator<Knot> simulator(knot::tied_rod(parameters), model);
    const auto loose = [&](const knot::KnotState& state) {
        return 0.5 * bending * std::pow(2.0 * std::numbers::pi / state.shortening, 2);
    };
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const knot::KnotState state = knot::measure(simulator, parameters);
        return {{"shortening", state.shortening},
                {"force", state.force},
                {"force_of_loose_knots", loose(state)},
                {"contact_force", state.contact_force}};
    });
    simulation::Loading<Knot> loading;
    loading.stages.resize(drawn > 0.0 ? 2 : 1);
    simulation::Stage<Knot>& settle = loading.stages[0];  // without friction: it would hold the knot as it is tied
    settle.name = "settle", settle.increments = 2, settle.most_increments = 200;
    const double damping = 10.0 * bending / (R * R * R) / static_cast<double>(parameters.elements);
    // A braid of more turns springs open over its own length, the root of 2 r R times a number, and not over that of the loop.
    settle.damping = parameters.crossings > 3 ? damping * std::pow(R / (2.0 * radius), 1.5) : damping;
    settle.damping_decay = 0.5, settle.damping_share = 1e-3;
    settle.until = simulation::until_settled(0.05 * radius, 0.02 * radius);
    settle.friction.emplace(law::RegularisedCoulomb::Parameters{0.0, 0.02 * radius});
    if (drawn > 0.0) {
        simulation::Stage<Knot>& tighten = loading.stages[1];
        tighten.name = "draw", tighten.increments = increments, tighten.most_increments = 20 * increments;
        tighten.ramps = {{knot::draw, drawn}};
        tighten.friction.emplace(model.friction);
        tighten.damping = 0.1 * damping;  // what slides along itself without friction has nothing else to hold it
    }
    if (back > 0.0) {
        simulation::Stage<Knot> loosen = loading.stages.back();
        loosen.name = "back", loosen.ramps = {{knot::draw, drawn - back}};
        loading.stages.push_back(loosen);
    }
    for (auto& stage : loading.stages) stage.duration = asked.duration;
    if (asked.hold > 0.0) {
        simulation::Stage<Knot> hold;
        hold.name = "hold", hold.increments = increments, hold.most_increments = 20 * increments, hold.duration = asked.hold;
        loading.stages.push_back(hold);
    }
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const knot::KnotState state = knot::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -90.0, 60.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary =
        example::write_summary(output, report, audit, radius,
                               {{"force", state.force},
                                {"contact_force", state.contact_force},
                                {"force_of_loose_knots", loose(state)},
                                {"shortening", state.shortening},
                                {"radius_over_loop_radius", 2.0 * std::numbers::pi * radius / state.shortening},
                                {"imbalance", state.imbalance}});
    example::write_report(output, "knot", summary, simulator.snapshot());
    // What is tied presses on itself. An end that was drawn through, or strands that went through each other, leave a rod.
    const bool tied = state.contact_force > 0.0;
    if (report.converged && !tied)
        std::fprintf(stderr,
                     "knot: nothing of the rod presses on itself, so the knot came undone: take a longer knot.tail, more "
                     "knot.elements or a larger knot.loop_radius\n");
    return report.converged && audit.clean() && tied;
}

}  // namespace

example::Program knot_program() { return {"knot", "Ties a knot in a straight rod and draws it tight.", solve}; }

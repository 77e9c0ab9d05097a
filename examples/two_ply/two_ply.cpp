// SPDX-License-Identifier: MIT
// Two straight rods side by side are pulled and wound around each other; prints the torque beside that of Kirchhoff's helices.
//   two_ply SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/two_ply/two_ply.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace fibrant;
namespace two_ply = compositions::two_ply;

namespace {

struct TwoPly {
    using Beam = beam::DirectorBeam<3, beam::DirectorBeamOptions{.twist = beam::TwistStrain::turn}>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};

bool solve(example::SceneReader& file, example::Output& output) {
    two_ply::TwoPlyParameters parameters;
    double turns = core::unset, mu = 0.0;
    Index per_turn = 12;
    file.require("rods", "radius", parameters.radius, example::positive(), "length", "radius of a rod");
    file.require("rods", "length", parameters.length, example::positive(), "length", "length of a rod");
    file.read("rods", "elements", parameters.elements, example::between(2, 10000), "elements along a rod");
    example::read_material(file, "material", parameters.material);
    example::read_friction(file, mu, "coefficient of friction of the rods on each other");
    file.require("loading", "force", parameters.force, example::not_negative(), "force", "force that pulls both rods together");
    file.require("loading", "turns", turns, example::between(-1000.0, 1000.0), "1", "turns of one end against the other");
    file.read("loading", "increments_per_turn", per_turn, example::between(1, 1000), "increments for each turn");
    file.complete();
    file.check(turns != 0.0, "loading", "turns", "other than 0: nothing would be wound");
    file.check(parameters.length >= 4.0 * parameters.radius, "rods", "length",
               ">= 4 rods.radius = " + core::text(4.0 * parameters.radius));
    file.check(parameters.length <= 1e6 * parameters.radius, "rods", "length",
               "<= 1000000 rods.radius = " + core::text(1e6 * parameters.radius));
    const double stiffness = 2.0 * std::numbers::pi * parameters.radius * parameters.radius * parameters.material.young_modulus;
    file.check(parameters.force <= stiffness, "loading", "force", "<= E A of both rods = " + core::text(stiffness));
    file.check(std::abs(turns) <= 2.0 * static_cast<double>(parameters.elements), "loading", "turns",
               "at most 2 rods.elements = " + core::text(2.0 * static_cast<double>(parameters.elements)) +
                   ", for an element may not turn by more than half a turn");
    const double around = parameters.length * (1.0 + parameters.force / stiffness) / (2.0 * std::numbers::pi * parameters.radius);
    file.check(std::abs(turns) <= around, "loading", "turns",
               "at most " + core::text(around) + ", or rods are shorter than what goes around each other");
    example::require_element(file, "rods", parameters.elements, parameters.length, parameters.radius);
    example::require_room(file, "rods", "elements", example::unknowns_of(2, parameters.elements), 20000.0);
    file.names({{"TwoPlyParameters.force", "loading.force"}, {"TwoPlyParameters.", "rods."}});
    parameters.validate();

    const double radius = parameters.radius;
    simulation::ModelParameters<TwoPly> model;
    model.normal = {.law = {.regularisation_depth = 1e-3 * radius}, .largest_penetration = 1e-4 * radius};
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * radius};
    model.contact.stiffness.allowed_penetration = 1e-2 * radius;
    model.iteration.contact_tolerance = 1e-3;
    simulation::Simulator<TwoPly> simulator(two_ply::straight_rods(parameters), model);
    const auto theory = [&](const two_ply::TwoPlyState& state) {
        return two_ply::HelixTheory(parameters, state.helix_angle, state.radius, state.twist);
    };
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const two_ply::TwoPlyState state = two_ply::measure(simulator, parameters);
        return {{"turns", simulator.amplitude(two_ply::turn)},
                {"helix_angle_deg", state.helix_angle * 180.0 / std::numbers::pi},
                {"torque", state.torque},
                {"torque_of_helices", theory(state).torque},
                {"line_load", state.line_load}};
    });
    simulation::Loading<TwoPly> loading;
    loading.stages.resize(2);
    loading.stages[0].name = "pull", loading.stages[0].ramps = {{two_ply::pull, 1.0}}, loading.stages[0].increments = 2;
    loading.stages[1].name = "turn", loading.stages[1].ramps = {{two_ply::turn, turns}};
    loading.stages[1].increments =
        std::max<Index>(1, static_cast<Index>(std::ceil(std::abs(turns) * static_cast<double>(per_turn))));
    loading.stages[1].most_increments = 10 * loading.stages[1].increments;
    output.tell(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const two_ply::TwoPlyState state = two_ply::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 15.0, std::pair{Index{2}, 0.5 * parameters.length});
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius,
                                                               {{"torque", state.torque},
                                                                {"torque_of_helices", theory(state).torque},
                                                                {"helix_angle_deg", state.helix_angle * 180.0 / std::numbers::pi},
                                                                {"line_load", state.line_load},
                                                                {"line_load_of_helices", theory(state).line_load}});
    example::write_report(output, "two_ply", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

}  // namespace

example::Program two_ply_program() { return {"two_ply", "Winds two rods around each other.", solve}; }

// SPDX-License-Identifier: MIT
// A strand of 7 to 91 wires with friction is bent to an arc; prints the moment between its bounds, and the time.
//   strand_bending SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <limits>

using namespace fibrant;
namespace strand = compositions::strand;

struct Strand {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
};

bool solve(example::TomlReader& file, const example::Output& output) {
    Index wires = 7, elements = 20, increments = 30;
    double radius = core::unset, lay = core::unset, length = core::unset, angle = 90.0, mu = 0.1, depth = 0.02, reversible = 0.1;
    double damping = 0.0, rest_share = 1e-4, overshoot = std::numeric_limits<double>::infinity();
    double young_modulus = core::unset, poisson_ratio = core::unset;
    bool alternate = true;
    file.require("strand", "wires", wires);
    file.require("strand", "radius", radius);
    file.require("strand", "lay_angle_deg", lay);
    file.require("strand", "length", length);
    file.read("strand", "alternate", alternate);
    file.read("strand", "elements", elements);
    file.require("material", "young_modulus", young_modulus);
    file.require("material", "poisson_ratio", poisson_ratio);
    file.read("contact", "friction_coefficient", mu);
    file.read("contact", "reversible_displacement_over_radius", reversible);
    file.read("contact", "allowed_penetration_over_radius", depth);
    file.read("loading", "angle_deg", angle);
    file.read("loading", "increments", increments);
    file.read("loading", "damping", damping);
    file.read("loading", "rest_share", rest_share);
    file.read("solver", "overshoot", overshoot);
    file.refuse_unknown();
    strand::StrandParameters parameters = strand::regular_strand(wires, radius, lay, alternate);
    parameters.length = length, parameters.elements = elements, parameters.material = {young_modulus, poisson_ratio};

    simulation::ModelParameters<Strand> model;
    model.normal.regularisation_depth = 0.5 * depth * radius;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = reversible * radius};
    model.contact.stiffness.allowed_penetration = depth * radius;
    model.iteration.newton_limit = 30, model.iteration.overshoot = overshoot;
    model.iteration.margin = 4.0, model.iteration.largest_margin = 8.0;  // ends swing far
    simulation::Simulator<Strand> simulator(strand::bent_strand(parameters), model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::BendingState state = strand::measure_bending(simulator, parameters);
        return {{"angle_deg", state.angle * 180.0 / std::numbers::pi}, {"moment", state.moment}, {"tension", state.tension}};
    });
    simulation::Loading<Strand> loading;
    loading.stages.resize(1);
    const double full = angle * std::numbers::pi / 180.0;
    loading.stages[0].ramps = {{strand::bend, full}};
    loading.stages[0].increments = increments;
    loading.stages[0].most_increments = 20 * increments;
    if (damping > 0.0) {  // wires that buckle creep instead of leaping; at the end nothing is held any more
        loading.stages[0].damping = damping, loading.stages[0].damping_decay = 0.5;
        loading.stages.push_back(loading.stages[0]);
        loading.stages[1].name = "rest", loading.stages[1].ramps = {}, loading.stages[1].increments = 1;
        loading.stages[1].damping_share = rest_share, loading.stages[1].damping_goes_on = true;
        loading.stages[1].until = simulation::until_settled(1e-3 * radius, 2.0 * depth * radius, rest_share);
    }
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::BendingState state = strand::measure_bending(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -90.0, 10.0);
    example::write_summary(output, report, radius, {{"wires", static_cast<double>(wires)}, {"dofs", static_cast<double>(simulator.mesh().layout().unknowns())},
                           {"angle_deg", state.angle * 180.0 / std::numbers::pi}, {"moment", state.moment},
                           {"moment_of_loose_wires", strand::loose_stiffness(parameters) * full / length},
                           {"moment_of_a_solid", strand::solid_stiffness(parameters) * full / length},
                           {"dissipated", report.energy.dissipated}, {"external_work", report.energy.external}, {"energy_error", report.energy.error()}});
    return report.converged;
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "strand_bending", "Bends a strand of helical wires with friction to an arc.", solve);
}

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

#include <algorithm>
#include <cmath>

using namespace fibrant;
namespace strand = compositions::strand;

struct Strand {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
};

strand::Anchor anchor_of(const std::string& name) {
    if (name == "near_plate") return strand::Anchor::near_plate;
    if (name != "both_plates") core::refuse("loading.anchor", name, "near_plate or both_plates");
    return strand::Anchor::both_plates;
}

strand::Lay lay_of(const std::string& name) {
    if (name == "equal_angle") return strand::Lay::equal_angle;
    if (name != "equal_pitch") core::refuse("strand.lay", name, "equal_angle or equal_pitch");
    return strand::Lay::equal_pitch;
}

bool solve(example::TomlReader& file, const example::Output& output) {
    Index wires = 7, elements = 0, increments = 30;
    double radius = core::unset, lay_angle = core::unset, turns = 1.0, length = 0.0, angle = 90.0, mu = 0.1, depth = 0.02, reversible = 0.1;
    double young_modulus = core::unset, poisson_ratio = core::unset;
    bool alternate = true;
    std::string anchor = "both_plates", lay = "equal_pitch";
    strand::Bending bending;
    file.require("strand", "wires", wires);
    file.require("strand", "radius", radius);
    file.require("strand", "lay_angle_deg", lay_angle);
    file.read("strand", "lay", lay);
    file.read("strand", "alternate", alternate);
    file.read("strand", "turns", turns);
    file.read("strand", "length", length);
    file.read("strand", "elements", elements);
    file.require("material", "young_modulus", young_modulus);
    file.require("material", "poisson_ratio", poisson_ratio);
    file.read("contact", "friction_coefficient", mu);
    file.read("contact", "reversible_displacement_over_radius", reversible);
    file.read("contact", "allowed_penetration_over_radius", depth);
    file.read("loading", "anchor", anchor);
    file.read("loading", "strain", bending.strain);
    file.read("loading", "angle_deg", angle);
    file.read("loading", "increments", increments);
    file.refuse_unknown();
    bending.anchor = anchor_of(anchor);
    strand::StrandParameters parameters = strand::regular_strand(wires, radius, lay_angle, alternate, lay_of(lay));
    parameters.material = {young_modulus, poisson_ratio};
    parameters.length = length > 0.0 ? length : turns * parameters.pitch(parameters.layers.size() - 1);
    // Sixteen a turn follow a helix; wires of opposite hands cross each other every two diameters, and hardly bend in between.
    parameters.elements = elements > 0 ? elements : static_cast<Index>(std::ceil(std::max(16.0 * turns, parameters.length / (7.0 * radius))));

    simulation::ModelParameters<Strand> model;
    model.normal.regularisation_depth = 0.5 * depth * radius;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = reversible * radius};
    model.contact.stiffness.allowed_penetration = depth * radius;
    model.iteration.newton_limit = 30;
    model.iteration.margin = 1.0;  // an increment moves the ends of a long strand by more than a radius
    simulation::Simulator<Strand> simulator(strand::bent_strand(parameters, bending), model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::BendingState state = strand::measure_bending(simulator, parameters, bending);
        return {{"angle_deg", state.angle * 180.0 / std::numbers::pi}, {"moment", state.moment}, {"moment_at_plate", state.at_plate}, {"tension", state.tension},
                {"furthest_from_layer_over_radius", strand::furthest_from_layer(simulator, parameters) / radius}, {"processor_seconds", example::cpu_seconds()}};
    });
    simulation::Loading<Strand> loading;
    const double full = angle * std::numbers::pi / 180.0;
    if (bending.strain != 0.0) {
        loading.stages.emplace_back();
        loading.stages.back().name = "drawing";
    }
    loading.stages.emplace_back();
    loading.stages.back().ramps = {{strand::bend, full}};
    loading.stages.back().increments = increments, loading.stages.back().most_increments = 20 * increments;
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::BendingState state = strand::measure_bending(simulator, parameters, bending);
    example::write_pictures(output, simulator.snapshot(), -90.0, 10.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    example::write_summary(output, report, audit, radius, {{"wires", static_cast<double>(wires)}, {"dofs", static_cast<double>(simulator.mesh().layout().unknowns())},
                           {"length_over_radius", parameters.length / radius}, {"angle_deg", state.angle * 180.0 / std::numbers::pi},
                           {"moment", state.moment}, {"moment_at_plate", state.at_plate},
                           {"moment_of_loose_wires", strand::loose_stiffness(parameters) * full / parameters.length},
                           {"moment_of_a_solid", strand::solid_stiffness(parameters) * full / parameters.length},
                           {"furthest_from_layer_over_radius", strand::furthest_from_layer(simulator, parameters) / radius},
                           {"dissipated", report.energy.dissipated}, {"external_work", report.energy.external}, {"energy_error", report.energy.error()}});
    return report.converged && audit.clean();
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "strand_bending", "Bends a strand of helical wires with friction to an arc.", solve);
}

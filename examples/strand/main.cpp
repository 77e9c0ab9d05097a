// SPDX-License-Identifier: MIT
// A strand of helical wires around a core, or a rope of seven such strands, is stretched and turned between two plates; prints force and torque.
//   strand SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/rope.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <algorithm>

using namespace fibrant;
namespace strand = compositions::strand;

struct Strand {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
};

/// What is the same for a strand and a rope.
struct Scene {
    double radius = core::unset, lay = core::unset, length = core::unset, strain = 0.0, rotation = 0.0, mu = 0.0, sinking = 1e-5, allowed = 1e-3, depth = 0.1, tolerance = 1e-4, reversible = 0.01;
    Index elements = 40, increments = 4;
    scene::ElasticMaterial material;
};

template <class Parameters>
bool draw(const Scene& given, const scene::Assembly& assembly, const Parameters& parameters, const example::Output& output, std::vector<std::pair<std::string, double>> figures) {
    const double radius = given.radius;
    simulation::ModelParameters<Strand> model;
    model.normal = {.law = {.regularisation_depth = given.depth * given.allowed * radius}, .largest_penetration = given.sinking * radius};
    model.friction = {.friction_coefficient = given.mu, .reversible_displacement = given.reversible * radius};
    model.contact.stiffness.allowed_penetration = given.allowed * radius;
    model.contact.stiffness.initial_fraction = 0.2;
    model.iteration.step_tolerance = model.iteration.residual_tolerance = std::min(0.01 * given.tolerance, 1e-5);
    model.iteration.normal_step_tolerance = model.iteration.normal_tolerance = 0.1 * given.tolerance;
    model.iteration.contact_tolerance = given.tolerance, model.iteration.newton_limit = 30;
    simulation::Simulator<Strand> simulator(assembly, model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::StrandState state = strand::measure(simulator, parameters);
        return {{"strain", simulator.amplitude(strand::stretch)}, {"rotation", simulator.amplitude(strand::twist)}, {"force", state.force}, {"torque", state.torque}};
    });
    simulation::Loading<Strand> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{strand::stretch, given.strain}, {strand::twist, given.rotation}};
    loading.stages[0].increments = given.increments;
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::StrandState state = strand::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 20.0, std::pair{Index{2}, 0.5 * given.length});
    figures.insert(figures.begin(), {{"force", state.force}, {"torque", state.torque}, {"metal_stiffness", parameters.metal_stiffness()},
                                     {"force_over_metal_stiffness_and_strain", state.force / (parameters.metal_stiffness() * given.strain)}});
    figures.insert(figures.end(), {{"external_work", report.energy.external}, {"dissipated", report.energy.dissipated}, {"energy_error", report.energy.error()}});
    const simulation::Audit audit = example::audit(output, simulator, radius);
    example::write_summary(output, report, audit, radius, figures);
    return report.converged && audit.clean();
}

bool solve(example::TomlReader& file, const example::Output& output) {
    Scene given;
    Index wires = 7;
    double core_radius = 0.0, rope_lay = 0.0, apart = 0.0, overlap = 0.0;
    bool alternate = true;
    file.require("strand", "wires", wires);
    file.require("strand", "radius", given.radius);
    file.require("strand", "lay_angle_deg", given.lay);
    file.require("strand", "length", given.length);
    file.read("strand", "alternate", alternate);
    file.read("strand", "core_radius", core_radius);
    file.read("strand", "elements", given.elements);
    file.read("rope", "lay_angle_deg", rope_lay);
    file.read("rope", "apart_over_radius", apart);
    file.read("rope", "overlap_over_radius", overlap);
    file.require("material", "young_modulus", given.material.young_modulus);
    file.require("material", "poisson_ratio", given.material.poisson_ratio);
    file.read("contact", "friction_coefficient", given.mu);
    file.read("contact", "reversible_displacement_over_radius", given.reversible);
    file.read("contact", "largest_penetration_over_radius", given.sinking);
    file.read("contact", "allowed_penetration_over_radius", given.allowed);
    file.read("contact", "regularisation_over_allowed", given.depth);
    file.read("contact", "tolerance_over_radius", given.tolerance);
    file.read("loading", "strain", given.strain);
    file.read("loading", "rotation", given.rotation);
    file.read("loading", "increments", given.increments);
    file.refuse_unknown();
    if (rope_lay == 0.0) {
        strand::StrandParameters parameters = strand::regular_strand(wires, given.radius, given.lay, alternate);
        if (core_radius > 0.0) parameters.core_radius = core_radius;
        parameters.length = given.length, parameters.elements = given.elements, parameters.material = given.material;
        return draw(given, strand::straight_strand(parameters), parameters, output, {});
    }
    if (wires != 7) core::refuse("strand.wires", std::to_string(wires), "7 in a rope");
    strand::RopeParameters rope = strand::rope_of_seven(given.radius, given.lay, rope_lay, given.length, apart * given.radius, overlap * given.radius);
    rope.elements = given.elements, rope.material = given.material;
    const strand::RopeStiffness sliding = strand::stiffness_bound(rope), stuck = strand::stiffness_bound(rope, true);
    return draw(given, strand::straight_rope(rope), rope, output,
                {{"least_gap_at_the_start_over_radius", strand::least_gap(rope) / given.radius}, {"helix_radius_over_radius", rope.layers[0].helix_radius / given.radius},
                 {"core_strand_wires_over_radius", rope.core.layers[0].radius / given.radius}, {"greatest_force", given.strain * sliding.force_by_strain + given.rotation * sliding.torque_by_strain},
                 {"torque_of_sliding_wires", given.strain * sliding.torque_by_strain + given.rotation * sliding.torque_by_rotation},
                 {"greatest_force_if_stuck", given.strain * stuck.force_by_strain + given.rotation * stuck.torque_by_strain},
                 {"torque_of_stuck_wires", given.strain * stuck.torque_by_strain + given.rotation * stuck.torque_by_rotation}});
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "strand", "Stretches and turns a strand of helical wires around a core, or a rope of seven strands.", solve);
}

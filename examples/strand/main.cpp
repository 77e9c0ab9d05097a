// SPDX-License-Identifier: MIT
// A strand of helical wires around a core is stretched and turned between two plates; prints force and torque.
//   strand SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/strand.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

using namespace fibrant;
namespace strand = compositions::strand;

struct Strand {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};

bool solve(example::TomlReader& file, const example::Output& output) {
    Index wires = 7, increments = 4;
    double radius = core::unset, lay = core::unset, core_radius = 0.0, length = core::unset, strain = 0.0, rotation = 0.0, mu = 0.0;
    double sinking = 1e-5;
    bool alternate = true;
    file.require("strand", "wires", wires);
    file.require("strand", "radius", radius);
    file.require("strand", "lay_angle_deg", lay);
    file.require("strand", "length", length);
    file.read("strand", "alternate", alternate);
    file.read("strand", "core_radius", core_radius);
    strand::StrandParameters parameters = strand::regular_strand(wires, radius, lay, alternate);
    if (core_radius > 0.0) parameters.core_radius = core_radius;
    parameters.length = length;
    file.read("strand", "elements", parameters.elements);
    file.require("material", "young_modulus", parameters.material.young_modulus);
    file.require("material", "poisson_ratio", parameters.material.poisson_ratio);
    file.read("contact", "friction_coefficient", mu);
    file.read("contact", "largest_penetration_over_radius", sinking);
    file.read("loading", "strain", strain);
    file.read("loading", "rotation", rotation);
    file.read("loading", "increments", increments);
    file.refuse_unknown();

    simulation::ModelParameters<Strand> model;
    model.normal = {.law = {.regularisation_depth = 1e-4 * radius}, .largest_penetration = sinking * radius};
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.01 * radius};
    model.contact.stiffness.allowed_penetration = 1e-3 * radius;
    model.contact.stiffness.initial_fraction = 0.2;
    model.iteration.step_tolerance = model.iteration.residual_tolerance = 1e-6;
    model.iteration.normal_step_tolerance = model.iteration.normal_tolerance = 1e-5;
    model.iteration.contact_tolerance = 1e-4;
    simulation::Simulator<Strand> simulator(strand::straight_strand(parameters), model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const strand::StrandState state = strand::measure(simulator, parameters);
        return {{"strain", simulator.amplitude(strand::stretch)}, {"rotation", simulator.amplitude(strand::twist)}, {"force", state.force}, {"torque", state.torque}};
    });
    simulation::Loading<Strand> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{strand::stretch, strain}, {strand::twist, rotation}};
    loading.stages[0].increments = increments;
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const strand::StrandState state = strand::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 20.0, std::pair{Index{2}, 0.5 * length});
    example::write_summary(output, report, radius, {{"force", state.force}, {"torque", state.torque}, {"metal_stiffness", parameters.metal_stiffness()},
                           {"force_over_metal_stiffness_and_strain", state.force / (parameters.metal_stiffness() * strain)}});
    return report.converged;
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "strand", "Stretches and turns a strand of helical wires around a core.", solve);
}

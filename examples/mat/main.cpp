// SPDX-License-Identifier: MIT
// Random fibres in a box are compacted by a plate; prints pressure and contacts by volume fraction, beside those of theory.
//   mat SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/mat/compaction.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

using namespace fibrant;
namespace mat = compositions::mat;

struct Mat {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

bool solve(example::TomlReader& file, const example::Output& output) {
    mat::MatParameters parameters;
    Index seed = 1, increments = 40;
    double last_height = core::unset, mu = 0.2;
    file.require("mat", "radius", parameters.radius);
    file.require("mat", "length", parameters.length);
    file.require("mat", "width", parameters.width);
    file.require("mat", "height", parameters.height);
    file.require("mat", "fibres", parameters.fibres);
    file.read("mat", "bend_deg", parameters.bend_deg);
    file.read("mat", "tilt_deg", parameters.tilt_deg);
    file.read("mat", "elements", parameters.elements);
    file.read("mat", "seed", seed);
    file.require("material", "young_modulus", parameters.material.young_modulus);
    file.require("material", "poisson_ratio", parameters.material.poisson_ratio);
    file.read("contact", "friction_coefficient", mu);
    file.require("loading", "height", last_height);
    file.read("loading", "increments", increments);
    file.refuse_unknown();
    parameters.seed = static_cast<std::uint64_t>(seed);
    core::require(last_height > 0.0 && last_height < parameters.height, "loading.height", last_height, "> 0 and below the mat's own");

    const double radius = parameters.radius;
    simulation::ModelParameters<Mat> model;
    model.normal.regularisation_depth = 5e-3 * radius;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.05 * radius};
    model.contact.stiffness.allowed_penetration = 2e-2 * radius;
    model.contact.stiffness.initial_fraction = 1e-3, model.contact.stiffness.floor_fraction = 1e-6;  // fibres bend long before sections give way
    model.iteration.newton_limit = 30;
    simulation::Simulator<Mat> simulator(mat::boxed_mat(parameters, mat::random_fibres(parameters)), model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const mat::MatState state = mat::measure(simulator, parameters);
        return {{"height", state.height}, {"volume_fraction", state.volume_fraction}, {"pressure_over_modulus", state.pressure / parameters.material.young_modulus},
                {"lower_pressure_over_modulus", state.lower_pressure / parameters.material.young_modulus}, {"contacts_per_fibre", state.contacts_per_fibre},
                {"contacts_without_bulk", state.contacts_without_bulk}, {"elastic_energy", state.elastic_energy}};
    });
    simulation::Loading<Mat> loading;
    loading.stages.resize(1);
    simulation::Stage<Mat>& press = loading.stages[0];
    press.name = "press", press.ramps = {{mat::press, parameters.height - last_height}};
    press.increments = increments, press.most_increments = 20 * increments;
    press.damping = mat::slack_damping(parameters);
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const mat::MatState state = mat::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 25.0);
    example::write_summary(output, report, radius, {{"volume_fraction", state.volume_fraction}, {"pressure", state.pressure}, {"lower_pressure", state.lower_pressure},
                           {"contacts_per_fibre", state.contacts_per_fibre}, {"contacts_without_bulk", state.contacts_without_bulk}});
    return report.converged;
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "mat", "Compacts a mat of random fibres in a box.", solve);
}

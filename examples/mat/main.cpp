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
    mat::PressParameters press;
    Index seed = 1;
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
    file.read("contact", "friction_coefficient", press.friction_coefficient);
    file.read("contact", "allowed_penetration_over_radius", press.allowed_penetration);
    file.require("loading", "height", press.height);
    file.read("loading", "increments", press.increments);
    file.read("loading", "damping", press.damping);
    file.read("loading", "looseness", press.looseness);
    file.read("solver", "overshoot", press.overshoot);
    file.refuse_unknown();
    parameters.seed = static_cast<std::uint64_t>(seed);

    const double radius = parameters.radius;
    const auto model = mat::model_parameters<Mat>(parameters, press);
    simulation::Simulator<Mat> simulator(mat::boxed_mat(parameters, mat::random_fibres(parameters)), model);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const mat::MatState state = mat::measure(simulator, parameters);
        return {{"height", state.height}, {"volume_fraction", state.volume_fraction}, {"pressure_over_modulus", state.pressure / parameters.material.young_modulus},
                {"lower_pressure_over_modulus", state.lower_pressure / parameters.material.young_modulus}, {"contacts_per_fibre", state.contacts_per_fibre},
                {"contacts_without_bulk", state.contacts_without_bulk}, {"sine", state.sine}, {"elastic_energy", state.elastic_energy}};
    });
    simulation::Loading<Mat> loading = mat::pressing<Mat>(parameters, press);
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    const simulation::Report report = simulator.run(loading, recorder);
    const mat::MatState state = mat::measure(simulator, parameters);
    example::write_pictures(output, simulator.snapshot(), -60.0, 25.0);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    example::write_summary(output, report, audit, radius, {{"volume_fraction", state.volume_fraction}, {"pressure", state.pressure}, {"lower_pressure", state.lower_pressure},
                           {"contacts_per_fibre", state.contacts_per_fibre}, {"contacts_without_bulk", state.contacts_without_bulk}});
    return report.converged && audit.clean();
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "mat", "Compacts a mat of random fibres in a box.", solve);
}

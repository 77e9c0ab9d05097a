// SPDX-License-Identifier: MIT
// A dense mat of random fibres is pressed from level to level, of one seed or of several; prints pressure and contacts of each at rest.
//   dense_mat SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--quiet]
#include "../support/example.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/compositions/mat/levels.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

using namespace fibrant;
namespace mat = compositions::mat;

struct Mat {
    using Beam = beam::KirchhoffCable;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

/// A row a level. @returns its pressures over volume fractions, of levels at rest
observe::PlotLine write_levels(observe::CsvWriter& table, std::uint64_t seed, const std::vector<mat::LevelState>& levels) {
    observe::PlotLine line{"seed " + std::to_string(seed), {}};
    for (const mat::LevelState& level : levels) {
        table.row({{"seed", seed}, {"volume_fraction", level.mat.volume_fraction}, {"pressure_over_modulus", level.mat.pressure}, {"lower_pressure_over_modulus", level.mat.lower_pressure},
                   {"contacts_per_fibre", level.mat.contacts_per_fibre}, {"contacts_without_bulk", level.mat.contacts_without_bulk}, {"sine", level.mat.sine},
                   {"elastic_energy", level.mat.elastic_energy}, {"springs", level.springs}, {"at_rest", level.at_rest()}});
        if (level.at_rest()) line.points.emplace_back(level.mat.volume_fraction, level.mat.pressure);
    }
    return line;
}

bool solve(example::TomlReader& file, const example::Output& output) {
    mat::MatParameters parameters{.radius = 1.0, .cut = true, .clearance = -2.0, .material = {1.0, 0.2}};  // fibres may lie in each other
    mat::LevelParameters levels;
    double fraction = core::unset;
    Index seed = 1, seeds = 1;
    file.require("mat", "length", parameters.length), file.require("mat", "width", parameters.width), file.require("mat", "fibres", parameters.fibres);
    file.require("mat", "volume_fraction", fraction);
    file.read("mat", "tilt_deg", parameters.tilt_deg), file.read("mat", "elements", parameters.elements);
    file.read("mat", "seed", seed), file.read("mat", "seeds", seeds);
    file.read("contact", "friction_coefficient", levels.friction_coefficient);
    file.read("contact", "allowed_penetration_over_radius", levels.allowed_penetration);
    file.read("contact", "softest_over_section", levels.softest);
    file.require("levels", "last", levels.last);
    file.read("levels", "ratio", levels.ratio), file.read("levels", "step", levels.step), file.read("levels", "damping", levels.damping);
    file.read("levels", "rest_share", levels.rest_share), file.read("levels", "rest_increments", levels.rest_increments);
    file.refuse_unknown();
    core::require_positive("mat.volume_fraction", fraction);
    parameters.height = parameters.volume_fraction(1.0) / fraction;

    observe::CsvWriter table(output.folder / "levels.csv");
    observe::LogLogPlot plot{"pressure on the plates", "volume fraction", "pressure over modulus", {}};
    bool converged = true;
    for (Index k = 0; k < seeds; ++k) {
        parameters.seed = static_cast<std::uint64_t>(seed + k);
        example::Output own = output;
        if (seeds > 1) own.folder /= "seed_" + std::to_string(seed + k), std::filesystem::create_directories(own.folder);
        simulation::Simulator<Mat> simulator(mat::boxed_mat(parameters, mat::random_fibres(parameters)), mat::model_parameters<Mat>(parameters, levels));
        example::Recorder recorder(own, 1.0, [&]() -> std::vector<observe::Column> {
            const mat::MatState state = mat::measure(simulator, parameters);
            return {{"volume_fraction", state.volume_fraction}, {"pressure_over_modulus", state.pressure}, {"lower_pressure_over_modulus", state.lower_pressure},
                    {"contacts_per_fibre", state.contacts_per_fibre}, {"contacts_without_bulk", state.contacts_without_bulk}, {"elastic_energy", state.elastic_energy}};
        });
        mat::LevelRecord<Mat> record(simulator, parameters);
        const simulation::Report report = simulator.run(mat::pressing_by_levels<Mat>(parameters, levels), recorder, record);
        const simulation::Audit audit = example::audit(own, simulator, 1.0);
        converged = converged && report.converged && audit.clean();
        plot.lines.push_back(write_levels(table, parameters.seed, record.levels()));
        if (!plot.lines.back().points.empty()) observe::write_file(output.folder / "pressure.svg", observe::log_log_svg(plot));
        example::write_pictures(own, simulator.snapshot(), -60.0, 25.0);
        example::write_summary(own, report, audit, 1.0, {{"exponent", observe::fitted_order(plot.lines.back().points)}});
    }
    return converged;
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "dense_mat", "Presses a dense mat of random fibres from level to level.", solve);
}

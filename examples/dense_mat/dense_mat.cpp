// SPDX-License-Identifier: MIT
// A dense mat of random fibres is pressed from level to level, of one seed or of several; prints pressure and contacts of each at
// rest.
//   dense_mat SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/table.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/compositions/mat/levels.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/limited_gap.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <cmath>
#include <filesystem>

using namespace fibrant;
namespace mat = compositions::mat;

namespace {

struct Mat {
    using Beam = beam::KirchhoffCable;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::FloatBlockCholesky;
    using Tools = contact::RigidTools;
};

/// A row a level: the last increment of each in the table of increments, which a run that was resumed has whole.
/// @returns its pressures over volume fractions, of levels at rest that carry any
observe::PlotLine write_levels(observe::CsvWriter& table, std::uint64_t seed, const example::Table& increments) {
    observe::PlotLine line{"seed " + std::to_string(seed), {}};
    const std::size_t stage = increments.column("stage");
    for (std::size_t k = 0; k < increments.rows(); ++k) {
        if (increments.cell(k, stage) != "level" || (k + 1 < increments.rows() && increments.cell(k + 1, stage) == "level"))
            continue;
        const auto figure = [&](const char* name) { return example::number_of(increments.cell(k, increments.column(name))); };
        const mat::LevelState level{{.volume_fraction = figure("volume_fraction"),
                                     .pressure = figure("pressure_over_modulus"),
                                     .lower_pressure = figure("lower_pressure_over_modulus")},
                                    figure("damping_share")};
        std::vector<observe::Column> columns{{"seed", seed}};
        for (const char* name : {"volume_fraction", "pressure_over_modulus", "lower_pressure_over_modulus", "contacts_per_fibre",
                                 "contacts_without_bulk", "sine", "elastic_energy"})
            columns.push_back({name, figure(name)});
        columns.push_back({"springs", level.springs}), columns.push_back({"at_rest", level.at_rest()});
        table.row(columns);
        if (level.at_rest() && level.mat.pressure > 0.0) line.points.emplace_back(level.mat.volume_fraction, level.mat.pressure);
    }
    return line;
}

bool solve(example::SceneReader& file, example::Output& output) {
    mat::MatParameters parameters{
        .radius = 1.0, .cut = true, .clearance = -2.0, .material = {1.0, 0.2}};  // fibres may lie in each other
    mat::LevelParameters levels;
    double fraction = core::unset;
    Index seed = 1, seeds = 1;
    file.require("mat", "length", parameters.length, example::between(2.0, 1e5), "radius", "length of a fibre");
    file.require("mat", "width", parameters.width, example::between(3.0, 1e5), "radius", "width of the box along x and y");
    file.require("mat", "fibres", parameters.fibres, example::between(1, 1000000), "how many lengths of a fibre are in the box");
    file.require("mat", "volume_fraction", fraction, example::inside(0.0, 0.9), "1",
                 "volume fraction of fibres in the box at the start");
    example::read_random_fibres(file, parameters.tilt_deg, parameters.elements, "elements along a length of fibre");
    file.read("mat", "spread_deg", parameters.spread_deg, example::between(0.0, 90.0), "degree",
              "greatest angle of a fibre to the plane of x and z, seen from above; 90: all directions");
    example::read_seed(file, seed);
    file.read("mat", "seeds", seeds, example::between(1, 1000),
              "number of mats, one after the other; more than one: each has a folder of its own");
    example::read_friction(file, levels.friction_coefficient,
                           "coefficient of friction of fibres on each other, once they are parted");
    example::read_allowed_penetration(file, levels.allowed_penetration);
    file.read("contact", "softest_over_section", levels.softest, example::above(0.0, 1.0), "1",
              "least stiffness of a contact, over that of a section");
    file.require("levels", "last", levels.last, example::inside(0.0, 0.9), "1", "volume fraction that no level exceeds");
    file.read("levels", "ratio", levels.ratio, {.low = 1.001, .high = 10.0}, "1",
              "volume fraction of a level over that of the one before");
    file.read("levels", "step", levels.step, example::between(1e-4, 1e3), "radius", "motion of the plate in an increment");
    file.read("levels", "damping", levels.damping, example::above(0.0, 1e6), "1",
              "stiffness of the damping, over what bends a tenth of a fibre, or a diameter of it; it moves on with the mean "
              "motion of the mat");
    file.read("levels", "rest_share", levels.rest_share, example::above(0.0, 0.01), "1",
              "a level is at rest when damping holds less than this part of the forces,");
    file.read("levels", "rest_increments", levels.rest_increments, example::between(1, 100000),
              "or so many increments have gone by");
    file.complete();
    file.check(levels.last >= fraction * levels.ratio, "levels", "last",
               ">= levels.ratio mat.volume_fraction = " + core::text(fraction * levels.ratio) + ", or there is no level");
    parameters.height = parameters.volume_fraction(1.0) / fraction;
    file.check(parameters.height > 2.0, "mat", "fibres",
               ">= " + core::text(std::ceil(2.0 * static_cast<double>(parameters.fibres) / parameters.height)) +
                   ", or the box is no higher than a fibre");
    file.check(parameters.height <= 1e5 * static_cast<double>(parameters.fibres), "mat", "volume_fraction",
               ">= " + core::text(parameters.volume_fraction(1e5) / static_cast<double>(parameters.fibres)) +
                   ", or the box is higher than 100000 radii with a single fibre");
    file.check(parameters.height <= 1e5, "mat", "fibres",
               "<= " + core::text(std::floor(1e5 * static_cast<double>(parameters.fibres) / parameters.height)) +
                   ", or the box is higher than 100000 radii");
    mat::MatParameters shorter = parameters;  // until a piece of it that is not left out fits into its box
    while (shorter.length > (1.0 + 1e-9) * mat::longest_piece(shorter) / mat::shortest_piece) {
        shorter.length = mat::longest_piece(shorter) / mat::shortest_piece;
        shorter.height = shorter.volume_fraction(1.0) / fraction;
    }
    file.check(
        shorter.length == parameters.length, "mat", "length",
        "<= " + core::text(shorter.length) + ", or the sides of the box leave less than a tenth of a fibre, which is left out");
    example::require_element(file, "mat", parameters.elements, parameters.length, 1.0);
    example::require_room(file, "mat", "fibres",
                          3.0 * static_cast<double>(parameters.fibres) * (2.0 * static_cast<double>(parameters.elements) + 1.0),
                          6000.0);
    file.names({{"MatParameters.height", "mat.volume_fraction is too large: the height of the box"},
                {"MatParameters.", "mat."},
                {"LevelParameters.", "levels."}});
    const auto folder_of = [&](Index k) {
        return seeds > 1 ? output.folder / ("seed_" + std::to_string(seed + k)) : output.folder;
    };
    for (Index k = 0; seeds > 1 && k < seeds; ++k) output.parts.push_back(folder_of(k));
    // Each mat is drawn once before anything is written: what cannot be drawn is told here.
    constexpr Index draws_a_fibre = 1000;  // that of fibres ten times as long as the box is wide one in some hundred is in it
    parameters.draws = std::max(parameters.draws, draws_a_fibre * parameters.fibres);
    const auto seeded = [&](Index k) {
        parameters.seed = static_cast<std::uint64_t>(seed + k);
        return mat::random_fibres(parameters);
    };
    for (Index k = 0; k < seeds; ++k) seeded(k);
    output.open(file);

    observe::CsvWriter table(output.folder / "levels.csv");
    observe::LogLogPlot plot{"pressure on the plates", "volume fraction", "pressure over modulus", {}};
    bool converged = true;
    for (Index k = 0; k < seeds && !example::stopped(); ++k) {
        example::Output own = output;
        own.folder = folder_of(k);
        std::filesystem::create_directories(own.folder);
        const scene::Assembly boxed = mat::boxed_mat(parameters, seeded(k));
        simulation::Simulator<Mat> simulator(boxed, mat::model_parameters<Mat>(parameters, levels));
        example::Recorder recorder(own, 1.0, [&]() -> std::vector<observe::Column> {
            const mat::MatState state = mat::measure(simulator, parameters);
            return {{"volume_fraction", state.volume_fraction},
                    {"pressure_over_modulus", state.pressure},
                    {"lower_pressure_over_modulus", state.lower_pressure},
                    {"contacts_per_fibre", state.contacts_per_fibre},
                    {"contacts_without_bulk", state.contacts_without_bulk},
                    {"sine", state.sine}};
        });
        simulation::Loading<Mat> loading = mat::pressing_by_levels<Mat>(parameters, levels, boxed);
        own.tell(loading);
        const simulation::Report report = simulator.run(loading, recorder);
        const simulation::Audit audit = example::audit(own, simulator, 1.0);
        converged = converged && report.converged && audit.clean();
        plot.lines.push_back(write_levels(table, parameters.seed, example::Table(own.folder / "increments.csv")));
        if (!plot.lines.back().points.empty()) observe::write_file(output.folder / "pressure.svg", observe::log_log_svg(plot));
        example::write_pictures(own, simulator.snapshot(), -60.0, 25.0);
        const observe::JsonObject summary =
            example::write_summary(own, report, audit, 1.0, {{"exponent", observe::fitted_order(plot.lines.back().points)}});
        example::write_report(own, "dense_mat", summary, simulator.snapshot());
    }
    return converged;
}

}  // namespace

example::Program dense_mat_program() { return {"dense_mat", "Presses a dense mat of random fibres from level to level.", solve}; }

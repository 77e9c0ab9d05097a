// SPDX-License-Identifier: MIT
#pragma once
/// @file A load case of the settled textile: its programme, its curve, and what it comes to.

#include "../support/example.hpp"
#include "../support/report_page.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <fibrant/compositions/textile/audit.hpp>
#include <fibrant/compositions/textile/cell_prestress.hpp>
#include <fibrant/compositions/textile/load_cases.hpp>
#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/simulation/programme.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace textile {

namespace observe = fibrant::observe;

/// Lets the sample come to rest in its grips, and takes it to the amount and, in cycles, back.
inline fibrant::simulation::LoadProgramme programme_of(const Scene& scene, const cloth::Assembled& assembled) {
    namespace simulation = fibrant::simulation;
    const double r = scene.textile.smallest_radius(), allowed = scene.settle.allowed_penetration_over_radius * r;
    const simulation::SettlingScales scales = cloth::scales_of(scene.textile, assembled);
    simulation::LoadProgramme programme;
    programme.damping = scales.slack;
    programme.rest_motion = scene.settle.rest_motion_over_radius * r, programme.rest_share = scene.settle.rest_share;
    programme.rest_penetration = 2.0 * allowed;
    programme.largest_displacement = r, programme.calm = 0.15 * r;  // a fabric's, by trial
    programme.reversible_displacement = simulation::reversible_displacement(r, scene.settle.friction_coefficient, allowed);
    programme.friction_shape = scene.settle.friction_shape;
    simulation::ProgrammeStage grip, load;
    grip.name = "grip", grip.increments = 1, grip.rest = true, grip.damping = scene.load.rest_damping,
    grip.friction = scene.settle.friction_coefficient;
    load.name = "load", load.increments = scene.load.increments, load.cycles = scene.load.cycles,
    load.damping = scene.load.damping;
    load.ramps = {{cloth::load_channel, 1.0, false}};
    programme.stages = {grip, load};
    return programme;
}

/// Tells an observer of several runs as of one: numbers of increments go on.
template <class Observer>
struct CountedOn {
    Observer& observer;
    Index before = 0;  ///< increments of the runs that have ended
    void reported(fibrant::simulation::IncrementReport increment) { increment.number += before, observer.reported(increment); }
    void gave_up(fibrant::simulation::FailedAttempt attempt) { attempt.number += before, observer.gave_up(attempt); }
    void accepted(observe::Snapshot shot) { shot.increment += before, observer.accepted(shot); }
};

/// Adds a further run to what several ones tell together: it has converged if all have.
inline void add_run(fibrant::simulation::Report& whole, fibrant::simulation::Report run) {
    whole.converged = run.converged, whole.reason = std::move(run.reason), whole.solver = std::move(run.solver);
    const Index before = fibrant::core::count(whole.increments);
    for (fibrant::simulation::IncrementReport& increment : run.increments) {
        increment.number += before;
        whole.increments.push_back(std::move(increment));
    }
    whole.rejected_increments += run.rejected_increments, whole.counts += run.counts, whole.energy = run.energy;
    for (std::size_t k = 0; k < whole.seconds.size(); ++k) whole.seconds[k] += run.seconds[k];
    whole.wall_seconds += run.wall_seconds;
    whole.sum_up();
}

/// Six small strains of a cell that repeats, one by one, in the folder "loading" of the results: stiffness.csv.
///
/// Friction at rest depends on the pressure of its contact, and creeps as normals turn: the cell rests without, and no contact
/// bears any until it is strained. Then friction is as stiff as it was, and never slips.
/// @returns whether it is sound
template <class Model>
bool run_cell(const example::Output& whole, const Scene& scene, const cloth::Assembled& assembled,
              const fibrant::simulation::Simulator<Model>& settled_by) {
    namespace simulation = fibrant::simulation;
    using Simulator = simulation::Simulator<Model>;
    const double radius = scene.textile.smallest_radius();
    auto parameters = cloth::model_parameters<Model>(scene.textile, scene.settle);
    example::choose_solver(parameters, scene.linear_solver);
    // Efforts are differences: what iterations leave has to be a small part of what a strain changes.
    parameters.iteration.residual_tolerance = 1e-9, parameters.iteration.step_tolerance = 1e-7,
    parameters.iteration.linear_tolerance = 1e-9, parameters.iteration.normal_step_tolerance = 1e-7,
    parameters.iteration.normal_limit = 40, parameters.iteration.inexact = 0.0;
    // Forces of contacts that slide have to be those of an energy, or the stiffness is not symmetric: places and normals of
    // crossings are followed.
    parameters.contact.places = fibrant::contact::Places::followed;
    const auto cell_of = [&](const Simulator& from, bool kept_along, bool kept_spin) {
        fibrant::scene::Assembly cell =
            cloth::assemble(scene.textile, scene.fineness,
                            {true, cloth::images_of(scene.textile, assembled, from.snapshot()), kept_along, kept_spin})
                .assembly;
        cell.begin_at(from.state());  // where it is kept
        return cell;
    };
    example::Output output = whole;
    output.folder = whole.folder / "loading";
    output.resume = false;
    std::filesystem::create_directories(output.folder);
    simulation::LoadProgramme programme = programme_of(scene, assembled);
    constexpr double hold = 100.0;  // on friction and on the slip that it takes
    programme.reversible_displacement *= hold;
    programme.rest_share = 1e-6, programme.rest_motion = 1e-9 * radius;  // until nothing moves by itself
    programme.stages.resize(1);
    programme.stages[0].friction = 0.0;
    Simulator resting(cell_of(settled_by, true, true), parameters);
    resting.start_from(whole.checkpoint());
    simulation::Loading<Model> rest = simulation::loading_of<Model>(programme);
    output.tell(rest, 20.0);
    if (const simulation::Report report = resting.run(rest); !report.converged) {
        std::fprintf(stderr, "textile: the cell does not rest without friction: %s\n", report.reason.c_str());
        return false;
    }
    // Strains count from where it rests.
    const std::vector<fibrant::Vec3> periods =
        cloth::periods_of(scene.textile, cloth::images_of(scene.textile, assembled, resting.snapshot()));
    const double area = periods[0].cross(periods[1]).norm();
    // Sections that contact presses flat stand where they are while a strain grows: to take them anew where a place has slid to
    // does work that no strain does.
    parameters.iteration.normal_limit = 1;
    const bool smooth = scene.settle.friction_coefficient == 0.0;
    cloth::CellPrestress prestress(resting);
    fibrant::scene::Assembly cell = cell_of(resting, false, smooth);
    prestress.apply(cell);
    if (smooth) prestress.keep_along(cell);
    simulation::ProgrammeStage stage;
    stage.increments = 1, stage.looseness = 1.0, stage.friction = hold * scene.settle.friction_coefficient;
    std::unique_ptr<Simulator> simulator;
    const auto efforts_now = [&] { return cloth::cell_efforts(*simulator, area, prestress); };
    const std::array<const char*, 6> names{"n_x", "n_y", "n_xy", "m_x", "m_y", "m_xy"};
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        std::vector<observe::Column> row;
        for (const std::string& name : cloth::cell_channels()) row.push_back({name, simulator->amplitude(name)});
        const cloth::CellVector efforts = efforts_now();
        for (std::size_t c = 0; c < 6; ++c) row.push_back({names[c], efforts[static_cast<Index>(c)]});
        return row;
    });
    CountedOn<decltype(recorder)> counted{recorder};
    simulation::Report report;
    // Each strain starts where the cell rests, and not where another one has left it: sections that an increment takes anew where
    // places have slid to may drive these on, by more in each, where crossings are near each other.
    const auto strain = [&](const std::string& name, double amount, std::size_t increments = 1) -> cloth::CellVector {
        simulator = std::make_unique<Simulator>(cell, parameters);
        simulator->start_from(output.checkpoint());
        stage.name = name, stage.ramps.clear();
        if (amount != 0.0) stage.ramps = {{name, amount, false}};
        programme.stages.assign(increments, stage);
        simulation::Loading<Model> loading = simulation::loading_of<Model>(programme);
        output.tell(loading);
        loading.checkpoint.clear();  // that of the rest stays
        add_run(report, simulator->run(loading, counted));
        counted.before = fibrant::core::count(report.increments);
        return efforts_now();
    };
    cloth::CellStiffness stiffness;
    stiffness.unstrained = strain("hold", 0.0);
    if (report.converged) stiffness.later = strain("hold", 0.0, 2);
    for (std::size_t c = 0; c < 6; ++c) {
        stiffness.amount[c] = scene.load.parameters.amount / (c < 3 ? 1.0 : radius);
        for (const double side : {1.0, -1.0})
            if (report.converged) stiffness.efforts.push_back(strain(cloth::cell_channels()[c], side * stiffness.amount[c]));
    }
    const simulation::Audit audit = example::audit(output, *simulator, radius);
    observe::JsonObject json;
    json.add("case", "cell").add("area", area);
    bool symmetric = false, stable = false;
    if (report.converged) {
        stiffness.evaluate();
        // Yarns that leap as they slide by themselves, or normals in the kinks between long elements, make it differ by more.
        constexpr double allowed = 1e-3;
        symmetric = stiffness.asymmetry <= allowed;
        stable = (stiffness.matrix.diagonal().array() > 0.0).all();
        observe::CsvWriter table(output.folder / "stiffness.csv");
        for (Index c = 0; c < 6; ++c) {
            std::vector<observe::Column> row{{"strain", cloth::cell_channels()[static_cast<std::size_t>(c)]}};
            for (Index k = 0; k < 6; ++k) row.push_back({names[static_cast<std::size_t>(k)], stiffness.matrix(k, c)});
            table.row(row);
        }
        json.add("asymmetry", stiffness.asymmetry).add("creep", stiffness.creep);
        json.add("tension", std::vector<double>{stiffness.unstrained[0], stiffness.unstrained[1]})
            .add("symmetric", symmetric)
            .add("stable", stable);
    }
    example::write_summary(output, report, audit, radius, {}, json);
    // Where the tangent is indefinite in each iteration Newton creeps, and stops short of the accuracy that six strains ask for.
    constexpr const char* gives_way =
        "Threads that are straight at rest and pressed into a deep crimp give way: fewer to a length, or ends.straight_at_rest = "
        "false";
    if (!report.converged && !example::stopped())
        std::fprintf(stderr, "textile: the cell does not bear its six strains. %s\n", gives_way);
    if (report.converged && !symmetric)
        std::fprintf(stderr,
                     "textile: the stiffness of the cell is not symmetric, by %.3g: elements are too long, or it is not at rest "
                     "without friction\n",
                     stiffness.asymmetry);
    for (Index c = 0; report.converged && c < 6; ++c)
        if (stiffness.matrix(c, c) <= 0.0)
            std::fprintf(stderr, "textile: the cell is not stable: its stiffness against %s is %.3g. %s\n",
                         cloth::cell_channels()[static_cast<std::size_t>(c)].c_str(), stiffness.matrix(c, c), gives_way);
    return report.converged && audit.clean() && symmetric && stable;
}

/// Runs it in the folder "loading" of the results.
/// @returns what summary.json is told, and whether it is sound
template <class Model>
std::pair<fibrant::observe::JsonObject, bool> run_load_case(const example::Output& whole, const Scene& scene,
                                                            const cloth::Assembled& assembled,
                                                            const fibrant::simulation::Simulator<Model>& settled_by) {
    namespace simulation = fibrant::simulation;
    const observe::Snapshot settled = settled_by.snapshot();
    const double radius = scene.textile.smallest_radius();
    const cloth::LoadCase load = cloth::load_case(scene.textile, assembled, settled, settled_by.state(), scene.load.parameters);
    auto parameters = cloth::model_parameters<Model>(scene.textile, scene.settle);
    example::choose_solver(parameters, scene.linear_solver);
    simulation::Simulator<Model> simulator(load.assembly, parameters);
    simulator.start_from(whole.checkpoint());
    example::Output output = whole;
    output.folder = whole.folder / "loading";
    output.resume = false;   // it begins at the settled state, which a run that resumes has
    output.ended = nullptr;  // told of the settled state already
    std::filesystem::create_directories(output.folder);
    std::vector<std::pair<double, double>> forth;
    const auto names = cloth::figure_names(load.parameters.name);
    double stretch = 0.0;
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const cloth::LoadFigures figures = cloth::load_figures(load, simulator);
        const double amplitude = simulator.amplitude(cloth::load_channel);
        if (amplitude == 0.0 && stretch == 0.0) forth.clear();  // at rest in the grips, and not on the way there
        if (forth.empty() || amplitude > stretch) forth.emplace_back(figures.measure, figures.effort), stretch = amplitude;
        return {{"load", amplitude}, {names.first, figures.measure}, {names.second, figures.effort}};
    });
    simulation::Loading<Model> loading = simulation::loading_of<Model>(programme_of(scene, assembled));
    output.tell(loading, 20.0);
    example::stop_together(loading);
    const simulation::Report report = simulator.run(loading, recorder);
    const observe::Snapshot after = simulator.snapshot();
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const cloth::TopologyAudit topology =
        cloth::audit_topology(scene.textile, assembled, cloth::lines_of(settled), cloth::lines_of(after));
    tell(scene.textile, topology);
    std::vector<std::pair<double, double>> curve = forth;
    if (load.parameters.name == "compaction")  // over the approach of the plates
        for (auto& [x, y] : curve) x = load.length - x;
    const cloth::CurveFit fit = cloth::fit_curve(curve, 3);
    observe::JsonObject json;
    json.add("case", load.parameters.name).add("length", load.length).add("width", load.width).add("thickness", load.thickness);
    json.add("gripped_low", load.gripped[0]).add("gripped_high", load.gripped[1]);
    json.add(names.first, curve.empty() ? 0.0 : forth.back().first).add(names.second, curve.empty() ? 0.0 : forth.back().second);
    json.add("initial_stiffness", curve.empty() ? 0.0 : cloth::initial_slope(curve))
        .add("fit", fit.coefficients)
        .add("fit_misfit", fit.misfit);
    // Since the sample was at rest in its grips: the account goes on from that of the settling.
    simulation::EnergyBalance before = report.energy;
    for (const simulation::IncrementReport& increment : report.increments) {
        if (increment.stage != "grip") break;
        before = increment.energy;
    }
    const double work = report.energy.external - before.external, damped = report.energy.damped - before.damped;
    json.add("topology_clean", topology.clean())
        .add("work", work)
        .add("lost_to_friction", report.energy.dissipated - before.dissipated);
    json.add("lost_to_damping", damped).add("missing_energy", report.energy.error() - before.error());
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius, {}, json);
    if (output.pictures) {
        observe::PlotLine line{names.second, forth};
        observe::write_file(output.folder / "curve.svg",
                            observe::curves_svg({.title = load.parameters.name,
                                                 .x_label = example::axis_label(names.first, output.unit),
                                                 .y_label = example::axis_label(names.second, output.unit),
                                                 .lines = {line}}));
    }
    observe::write_file(output.folder / "centrelines.csv", fibrant::exchange::csv_of(cloth::curves_of(after, assembled.path_of)));
    example::write_report(output, "textile", summary, by_family(scene.textile, assembled, after));
    return {json, report.converged && audit.clean() && topology.clean()};
}

}  // namespace textile

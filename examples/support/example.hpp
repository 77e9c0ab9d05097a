// SPDX-License-Identifier: MIT
#pragma once
/// @file What the examples that read a scene file have in common: the command line, progress, tables, pictures and a summary.

#include "process.hpp"
#include "progress.hpp"
#include "toml_reader.hpp"

#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/report.hpp>

#include <CLI/CLI.hpp>
#if defined(_OPENMP)
#include <omp.h>
#endif

#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace example {

namespace observe = fibrant::observe;

/// Where results go, and whether to speak.
struct Output {
    std::filesystem::path folder, scene;  ///< of the results; the scene file
    bool quiet = false, paraview = true, pictures = true;
    bool resume = false;      ///< go on from the last accepted increment in the folder
    observe::Start start() const noexcept { return resume ? observe::Start::resumed : observe::Start::anew; }
    std::string checkpoint() const { return (folder / "checkpoint.bin").string(); }
    std::string unit = "mm";  ///< of lengths, for the pictures
    /// How deep fibres may be in each other at the end, anywhere, over the radius of the thinnest; unset: as deep as contact is allowed to be, and
    /// what contact points may leave unseen.
    double deepest_over_radius = fibrant::core::unset;
};

/// Runs solve(reader, output) with the command line NAME SCENE.toml --output DIR [--set section.key=value]... [--threads N]
/// [--resume] [--quiet]. @returns 0 if it says so, 1 if not, 2 if the scene is refused
template <class Solve>
int run(int argc, char** argv, const char* name, const char* description, const Solve& solve) {
    std::string scene, folder;
    std::vector<std::string> set;
    int threads = 0;
    Output output;
    CLI::App app{description};
    app.set_version_flag("--version", FIBRANT_VERSION);
    app.add_option("scene", scene, "scene file (TOML)")->required();
    app.add_option("--output", folder, "folder for the results, made if need be")->required();
    app.add_option("--set", set, "section.key=value, in the place of what the file says")->allow_extra_args(false);
    app.add_option("--threads", threads, "0: as many as the machine has")->check(CLI::NonNegativeNumber);
    app.add_flag("--resume", output.resume, "go on from the last accepted increment in the folder");
    app.add_flag("--quiet", output.quiet, "print nothing but errors");
    CLI11_PARSE(app, argc, argv);
    keep_freed_memory();
    try {
        TomlReader reader(scene, set);
        reader.read("output", "paraview", output.paraview);
        reader.read("output", "pictures", output.pictures);
        reader.read("output", "unit", output.unit);
        reader.read("output", "deepest_over_radius", output.deepest_over_radius);
        output.folder = folder, output.scene = scene;
        std::filesystem::create_directories(output.folder);
#if defined(_OPENMP)
        if (threads > 0) omp_set_num_threads(threads);
#endif
        return solve(reader, output) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "%s: %s\n", name, error.what());
        return 2;
    }
}

/// The ParaView series, a row of increments.csv and a line of progress after each increment. `more()` gives columns of its own, the first
/// three of which are told in the line of progress, too.
template <class More>
class Recorder {
public:
    Recorder(const Output& output, double radius, const More& more)
        : table_{output.folder / "increments.csv", output.start()}, printer_{progress_printer(radius, 3, output.quiet)}, radius_{radius}, more_{more} {
        if (output.paraview) series_.emplace(output.folder / "paraview", output.start());
    }
    void reported(const fibrant::simulation::IncrementReport& increment) {
        std::vector<observe::Column> columns{{"increment", increment.number}, {"stage", increment.stage}, {"progress", increment.progress}};
        const std::vector<observe::Column> figures = more_();
        columns.insert(columns.end(), figures.begin(), figures.end());
        for (const observe::Column& column : std::vector<observe::Column>{{"newton_iterations", increment.counts.newton},
                                                                           {"linear_iterations", increment.counts.linear_iterations},
                                                                           {"contact_passes", increment.counts.contact_passes},
                                                                           {"cuts", increment.cuts},
                                                                           {"active_contacts", increment.contact.active},
                                                                           {"greatest_penetration_over_radius", increment.contact.greatest_penetration / radius_},
                                                                           {"residual", increment.residual},
                                                                           {"damping_share", increment.damping},
                                                                           {"springs", increment.springs},
                                                                           {"hardest_springs", increment.hardest_springs},
                                                                           {"elastic_energy", increment.energy.elastic},
                                                                           {"contact_energy", increment.energy.contact},
                                                                           {"external_work", increment.energy.external},
                                                                           {"dissipated", increment.energy.dissipated},
                                                                           {"damped", increment.energy.damped},
                                                                           {"rearranged", increment.energy.rearranged},
                                                                           {"energy_error", increment.energy.error()},
                                                                           {"seconds", increment.seconds}})
            columns.push_back(column);
        table_.row(columns);
        printer_.reported(increment, figures);
    }
    void gave_up(const fibrant::simulation::FailedAttempt& attempt) const { printer_.gave_up(attempt); }
    void accepted(const observe::Snapshot& snapshot) {
        if (series_) series_->accepted(snapshot);
    }

private:
    observe::CsvWriter table_;
    std::optional<observe::VtkWriter> series_;
    observe::ProgressPrinter printer_;
    double radius_;
    More more_;
};

/// view.svg and, across an axis at a place, section.svg.
inline void write_pictures(const Output& output, const observe::Snapshot& snapshot, double azimuth, double elevation,
                           std::optional<std::pair<fibrant::Index, double>> cut = {}) {
    if (!output.pictures) return;
    observe::ViewParameters view;
    view.azimuth = azimuth, view.elevation = elevation, view.unit = output.unit;
    observe::write_file(output.folder / "view.svg", observe::svg_view(snapshot, view));
    if (!cut) return;
    observe::SliceParameters slice;
    slice.axis = cut->first, slice.position = cut->second, slice.unit = output.unit;
    observe::write_file(output.folder / "section.svg", observe::svg_slice(snapshot, slice));
}

/// Audits the state that a run has come to, and says what is wrong with it. What it finds decides the exit status.
/// @param radius  of the thinnest fibre [length]
template <class Simulator>
fibrant::simulation::Audit audit(const Output& output, const Simulator& simulator, double radius) {
    const fibrant::simulation::Audit answer = fibrant::simulation::audit(simulator, output.deepest_over_radius * radius);
    const observe::LeastGap& least = answer.least_gap;
    if (answer.inside_out) std::fprintf(stderr, "audit: %s\n", fibrant::beam::text(*answer.inside_out).c_str());
    if (least.gap < -answer.allowed)
        std::fprintf(stderr, "audit: fibres %td and %td are %.4f radii deep in each other at (%g, %g, %g), and may be %.4f\n", least.fibre_i, least.fibre_j, -least.gap / radius,
                     least.position.x(), least.position.y(), least.position.z(), answer.allowed / radius);
    return answer;
}

/// summary.json: what every run says, and what `figures` adds.
inline void write_summary(const Output& output, const fibrant::simulation::Report& report, const fibrant::simulation::Audit& audit, double radius,
                          const std::vector<std::pair<std::string, double>>& figures) {
    observe::JsonObject json;
    json.add("converged", report.converged).add("audit_clean", audit.clean()).add("reason", report.reason);
    json.add("least_gap_over_radius", audit.least_gap.gap_over_radius).add("deepest_allowed_over_radius", audit.allowed / radius);
    // Of the last increment, then the most of any, over what is stated: 1 or less where that was kept.
    json.add("residual_over_tolerance", report.use.residual).add("penetration_over_allowed", report.use.penetration);
    json.add("most_residual_over_tolerance", report.most_use.residual).add("most_penetration_over_allowed", report.most_use.penetration);
    for (const auto& [name, value] : figures) json.add(name, value);
    json.add("increments", report.increments.empty() ? fibrant::Index{0} : report.increments.back().number)
        .add("rejected_increments", report.rejected_increments)
        .add("newton_iterations", report.counts.newton)
        .add("linear_solves", report.counts.linear_solves)
        .add("contact_elements", report.contact.elements)
        .add("active_contacts", report.contact.active)
        .add("greatest_penetration_over_radius", report.contact.greatest_penetration / radius)
        .add("linear_iterations", report.counts.linear_iterations)
        .add("solver", report.solver)
        .add("wall_seconds", report.wall_seconds)
        .add("cpu_seconds", cpu_seconds())
        .add("peak_memory_bytes", peak_memory_bytes())
        .add("version", FIBRANT_VERSION);
    observe::write_file(output.folder / "summary.json", json.text() + "\n");
    if (!output.quiet) std::printf("%s\n", json.text().c_str());
}

}  // namespace example

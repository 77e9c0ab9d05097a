// SPDX-License-Identifier: MIT
#pragma once
/// @file What the examples that read a scene file have in common: the command line, progress, tables, pictures and a summary.

#include "increment_columns.hpp"
#include "process.hpp"
#include "progress.hpp"
#include "remedies.hpp"
#include "results_folder.hpp"
#include "room.hpp"
#include "same_scene.hpp"
#include "scene_reader.hpp"
#include "stopping.hpp"

#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/svg_slice.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/report.hpp>
#ifdef FIBRANT_EXAMPLE_SOLVERS  // compiled once for several programs
#include <fibrant/compiled/solvers.hpp>
#endif

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace example {

namespace observe = fibrant::observe;

/// Where results go, and whether to speak.
struct Output {
    std::filesystem::path folder, scene;  ///< of the results; the scene file
    bool quiet = false, paraview = true, pictures = true;
    bool resume = false;       ///< go on from the last accepted increment in the folder
    bool overwrite = false;    ///< begin anew, whatever is in the folder
    bool other_scene = false;  ///< go on from increments of another scene as well
    observe::Start start() const noexcept { return resume ? observe::Start::resumed : observe::Start::anew; }
    std::string checkpoint() const { return (folder / "checkpoint.bin").string(); }
    std::string unit = "mm";  ///< of lengths, for the pictures
    /// How deep fibres may be in each other at the end, anywhere, over the radius of the thinnest; unset: as deep as contact is
    /// allowed to be, and what contact points may leave unseen.
    double deepest_over_radius = fibrant::core::unset;
    std::string told;                             ///< what the scene is, line by line: kept in checkpoints
    std::vector<std::filesystem::path> parts{};   ///< folders in it that results go to as well
    std::shared_ptr<const ResultsFolder> locked;  ///< the folder, from `open` on
    /// Is shown the end of the run and its summary, once all files are written; empty: nobody is.
    std::function<void(const observe::Snapshot&, const observe::JsonObject&)> ended{};

    /// Takes the folder, once the scene is known to be sound, and writes parameters.toml. Results of an earlier run that are
    /// neither resumed nor overwritten on purpose are left, as is a checkpoint of another scene. A run that was ended before its
    /// first checkpoint, and one that never began, begin.
    /// @param more  of what the scene is, beside what the file says
    /// @throws std::invalid_argument
    void open(const SceneReader& file, const std::string& more = {}) {
        told = file.scene() + more;
        locked = std::make_shared<const ResultsFolder>(folder);
        require_free_names(folder, parts);
        const std::string found = earlier_results(folder), name = "--output " + folder.string();
        const auto anywhere = [&](const char* file_name) {
            return std::filesystem::exists(folder / file_name) || std::any_of(parts.begin(), parts.end(), [&](const auto& part) {
                       return std::filesystem::exists(part / file_name);
                   });
        };
        const bool goes_on = anywhere("checkpoint.bin") || std::filesystem::exists(folder / "settled.bin");
        if (!found.empty() && !resume && !overwrite)
            throw std::invalid_argument(name + ": holds results of an earlier run (" + found +
                                        "): " + (goes_on ? "--resume goes on from its last increment, " : "") +
                                        "--overwrite begins anew, or name another folder");
        const bool begins = resume && !goes_on;
        if (begins) {
            if (anywhere("summary.json"))
                throw std::invalid_argument(name + ": holds results (" + found +
                                            ") but no checkpoint.bin to resume from: --overwrite begins anew");
            if (!quiet)
                std::fprintf(stderr, "%s: there is nothing to resume from%s, so the run begins\n", name.c_str(),
                             found.empty() ? "" : (", for a run was ended before its first checkpoint (" + found + ")").c_str());
            resume = false;
        }
        std::vector<std::filesystem::path> resumed = parts;
        resumed.push_back(folder);
        for (const std::filesystem::path& part : resumed) {  // also of those that are come to later
            const std::string left = (part / "checkpoint.bin").string();
            if (!resume || !std::filesystem::exists(left)) continue;
            if (other_scene)
                scene_of(left, "--resume");  // a damaged one is told before any work
            else
                require_scene_of(left, told, "--resume");
        }
        if (overwrite || begins)  // what is left of an earlier run would be taken for this one's where it is stopped
            for (const char* left : {"checkpoint.bin", "checkpoint.bin.before", "settled.bin", "settled.bin.before",
                                     "summary.json", "increments.csv", "levels.csv"}) {
                std::filesystem::remove(folder / left);
                for (const std::filesystem::path& part : parts) std::filesystem::remove(part / left);
            }
        observe::write_file(folder / "parameters.toml", file.echo());
    }
    /// Refuses a run whose input is what it would write over.
    void keep(const SceneReader& file, const std::string& section, const std::string& key, const std::string& input) const {
        std::error_code ignored;
        for (const std::filesystem::path& own : {folder / "checkpoint.bin", folder / "settled.bin"})
            if (std::filesystem::equivalent(input, own, ignored))
                file.refuse(section, key, "in another folder than --output, where it would be written over");
    }
    /// What every loading is told: where its checkpoint is, what it is of, and when to stop.
    template <class Loading>
    void tell(Loading& loading, double seconds = 0.0) const {
        loading.checkpoint = checkpoint(), loading.checkpoint_seconds = seconds, loading.resume = resume;
        loading.resume_before_end = true, loading.scene = told, loading.other_scene = other_scene, loading.stop = stopped;
        loading.audited = true, loading.deepest_over_radius = deepest_over_radius;
    }
};

/// The ParaView series, a row of increments.csv and a line of progress after each increment. `more()` gives columns of its own,
/// the first three of which are told in the line of progress, too.
template <class More>
class Recorder {
public:
    Recorder(const Output& output, double radius, const More& more)
        : table_{output.folder / "increments.csv", output.start()},
          printer_{progress_printer(radius, 3, output.quiet)},
          radius_{radius},
          more_{more} {
        if (output.paraview) series_.emplace(output.folder / "paraview", output.start());
    }
    void reported(const fibrant::simulation::IncrementReport& increment) {
        const std::vector<observe::Column> figures = more_();
        table_.row(increment_columns(increment, radius_, figures));
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

/// Says where sections swell and shrink in turn, if fibres come nearer to each other by that than is allowed [length].
inline void tell(const observe::Swelling& swelling, double allowed) {
    if (swelling.exceeds(allowed)) std::fprintf(stderr, "warning: %s\n", observe::text(swelling).c_str());
}

/// Audits the state that a run has come to, and says what is wrong with it. What it finds decides the exit status.
/// @param radius  of the thinnest fibre [length]
template <class Simulator>
fibrant::simulation::Audit audit(const Output& output, const Simulator& simulator, double radius) {
    const fibrant::simulation::Audit answer = fibrant::simulation::audit(simulator, output.deepest_over_radius * radius);
    const observe::LeastGap& least = answer.least_gap;
    if (answer.inside_out) std::fprintf(stderr, "audit: %s\n", fibrant::beam::text(*answer.inside_out).c_str());
    if (least.gap < -answer.allowed)
        std::fprintf(stderr, "audit: fibres %td and %td are %.4f radii deep in each other at (%g, %g, %g), and may be %.4f\n",
                     least.fibre_i, least.fibre_j, -least.gap / radius, least.position.x(), least.position.y(),
                     least.position.z(), answer.allowed / radius);
    const observe::ToolGap& tool = answer.tool_gap;
    if (tool.gap < -answer.allowed)
        std::fprintf(stderr, "audit: fibre %td is %.4f radii deep in tool %td at (%g, %g, %g), and may be %.4f\n", tool.fibre,
                     -tool.gap / radius, tool.tool, tool.position.x(), tool.position.y(), tool.position.z(),
                     answer.allowed / radius);
    tell(answer.swelling, answer.allowed);
    return answer;
}

/// summary.json: what every run says, and what `figures` adds.
/// @param begin  what stands before it
/// @returns what it wrote
inline observe::JsonObject write_summary(const Output& output, const fibrant::simulation::Report& report,
                                         const fibrant::simulation::Audit& audit, double radius,
                                         const std::vector<std::pair<std::string, double>>& figures,
                                         observe::JsonObject begin = {}) {
    observe::JsonObject& json = begin;
    json.add("converged", report.converged).add("audit_clean", audit.clean()).add("reason", report.reason);
    if (!report.converged && !stopped()) {  // also if quiet
        std::fprintf(stderr, "the run stopped: %s\n", report.reason.c_str());
        tell_remedy(report.reason);
    }
    json.add("least_gap_over_radius", audit.least_gap.gap_over_radius).add("deepest_allowed_over_radius", audit.allowed / radius);
    if (audit.tool_gap.tool >= 0) json.add("least_tool_gap_over_radius", audit.tool_gap.gap / radius);
    json.add("swelling_in_turn", audit.swelling.strain);
    // Of the last increment, then the most of any, over what is stated: 1 or less where that was kept.
    json.add("residual_over_tolerance", report.use.residual).add("penetration_over_allowed", report.use.penetration);
    json.add("most_residual_over_tolerance", report.most_use.residual)
        .add("most_penetration_over_allowed", report.most_use.penetration);
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
    return json;
}

}  // namespace example

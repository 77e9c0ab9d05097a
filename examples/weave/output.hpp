// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run of the weave prints and writes: progress, the table of increments, measures, pictures, the summary.

#include "../support/increment_columns.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/compositions/weave/slices.hpp>
#include <fibrant/compositions/weave/tow_section.hpp>
#include <fibrant/observe/csv_writer.hpp>
#include <fibrant/observe/json.hpp>
#include <fibrant/observe/progress_printer.hpp>
#include <fibrant/observe/svg_view.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/simulation/report.hpp>

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>

namespace weave {

namespace cloth = fibrant::compositions::weave;
namespace observe = fibrant::observe;
using fibrant::Index;

/// A row of increments.csv after each increment.
class IncrementTable {
public:
    IncrementTable(const std::filesystem::path& folder, double radius, observe::Start start)
        : table_{folder / "increments.csv", start}, radius_{radius} {}

    void reported(const fibrant::simulation::IncrementReport& increment) {
        table_.row(example::increment_columns(increment, radius_));
    }

private:
    observe::CsvWriter table_;
    double radius_;
};

/// fibres.csv (crimp and curvature of each fibre), tows.csv (crimp and curvature of each tow) and sections.csv (shape of
/// each tow at each of its crossings and half way between them).
inline void write_measures(const std::filesystem::path& folder, const observe::Snapshot& snapshot,
                           const cloth::FabricParameters& fabric, const cloth::CrimpMeasures& crimp) {
    using cloth::Family;
    observe::CsvWriter fibres(folder / "fibres.csv"), tows(folder / "tows.csv"), sections(folder / "sections.csv");
    for (Index number = 0; number < fabric.fibres(); ++number) {
        const cloth::FibrePlace place = fabric.place(number);
        const auto curvature = cloth::curvature_statistics(snapshot, {&number, 1});
        fibres.row({{"fibre", number},
                    {"family", name_of(place.family)},
                    {"tow", place.tow},
                    {"crimp", crimp.fibres[fibrant::core::at(number)]},
                    {"mean_curvature", curvature.mean},
                    {"greatest_curvature", curvature.greatest}});
    }
    for (const Family family : {Family::warp, Family::weft}) {
        const std::string name = name_of(family);
        for (Index tow = 0; tow < fabric.tows(family); ++tow) {
            const auto curvature = cloth::curvature_statistics(snapshot, fabric, family, tow);
            tows.row({{"family", name},
                      {"tow", tow},
                      {"crimp", (family == Family::warp ? crimp.warp_tows : crimp.weft_tows)[fibrant::core::at(tow)]},
                      {"mean_curvature", curvature.mean},
                      {"root_mean_square_curvature", curvature.root_mean_square},
                      {"greatest_curvature", curvature.greatest}});
            const std::vector<fibrant::Vec3> centre = cloth::tow_centreline(snapshot, fabric, family, tow);
            const std::vector<double> places = cloth::crossing_parameters(snapshot, fabric, family, tow);
            for (std::size_t k = 0; k + 1 < 2 * places.size(); ++k) {
                const double t = 0.5 * (places[k / 2] + places[(k + 1) / 2]);
                const cloth::TowSection section = cloth::tow_section(snapshot, fabric, family, tow, t);
                sections.row({{"family", name},
                              {"tow", tow},
                              {"crossing", 0.5 * static_cast<double>(k)},
                              {"along", fibrant::observe::NodalCurve{centre}.position(t)[cloth::axis_of(family)]},
                              {"area", section.area},
                              {"fibre_volume_fraction", section.fibre_volume_fraction},
                              {"width", section.width},
                              {"thickness", section.thickness},
                              {"aspect", section.aspect},
                              {"second_moment_across", section.second_moments(0, 0)},
                              {"second_moment_up", section.second_moments(1, 1)},
                              {"second_moment_mixed", section.second_moments(0, 1)}});
            }
        }
    }
}

/// view.svg, top.svg, and slice_warp_0.svg, ... along every tow.
inline void write_pictures(const std::filesystem::path& folder, const observe::Snapshot& snapshot,
                           const cloth::FabricParameters& fabric, const std::string& unit) {
    observe::ViewParameters view;
    view.palette = cloth::fabric_palette(fabric);
    view.unit = unit;
    view.pieces = 120000;  // of which a fabric hides most: with fewer, 16 tows are cut to facets
    observe::write_file(folder / "view.svg", observe::svg_view(snapshot, view));
    view.azimuth = -90.0;
    view.elevation = 90.0;
    observe::write_file(folder / "top.svg", observe::svg_view(snapshot, view));
    for (const cloth::TowSlice& slice : cloth::tow_slices(snapshot, fabric, unit))
        observe::write_file(folder / ("slice_" + slice.name + ".svg"), slice.svg);
}

/// The ParaView series, of every so many increments.
class Series {
public:
    /// @param every  increments between two files; 0: none at all
    Series(const std::filesystem::path& folder, observe::Start start, Index every) : every_{every} {
        if (every > 0) writer_.emplace(folder, start);
    }
    bool due(Index increment) const noexcept { return writer_ && increment % every_ == 0; }
    void accepted(const observe::Snapshot& snapshot) { writer_->accepted(snapshot); }

private:
    Index every_;
    std::optional<observe::VtkWriter> writer_;
};

/// What summary.json holds; scripts rely on the names.
struct Summary {
    bool converged = false;
    bool clean = false;  ///< the audit: all crossings right, no two fibres deeper in each other than allowed
    std::string reason;  ///< why not converged; empty if it did
    Index fibres = 0, nodes = 0, dofs = 0, contact_elements = 0;
    Index increments = 0, rejected_increments = 0, newton_iterations = 0, linear_solves = 0, linear_iterations = 0;
    Index crossings = 0, wrong_crossings = 0, missing_crossings = 0;
    double greatest_penetration_over_radius = fibrant::core::unset;  ///< of all contact elements [1]
    double least_gap_over_radius = fibrant::core::unset;             ///< true, between any two fibres [1]
    Index least_gap_fibre_i = -1, least_gap_fibre_j = -1;            ///< which these are,
    fibrant::Vec3 least_gap_place = fibrant::Vec3::Zero();           ///< and where [length]
    observe::Swelling swelling;                                      ///< of sections in turn from node to node
    double crimp_warp = fibrant::core::unset, crimp_weft = fibrant::core::unset;
    double thickness = fibrant::core::unset;
    double energy_error_over_work = fibrant::core::unset;              ///< of the report's energy balance [1]
    double residual_over_tolerance = 0, penetration_over_allowed = 0;  ///< of the last increment, at most 1 of an answer [1]
    double wall_seconds = 0, cpu_seconds = 0;
    std::int64_t peak_memory_bytes = 0;
    std::array<double, fibrant::core::part_count> seconds_by_stage{};  ///< by core::Part
    std::string solver;                                                ///< chosen, and what the automatic one used and why
    Index threads = 1;
};

/// Takes over what the report, the audit and the measures say; the rest is for the caller.
inline void fill(Summary& summary, const fibrant::simulation::Report& report, const cloth::Audit& audit,
                 const cloth::CrimpMeasures& crimp, double radius, double allowed_penetration) {
    summary.converged = report.converged;
    summary.reason = report.reason;
    summary.solver = report.solver;
    summary.contact_elements = report.contact.elements;
    summary.increments = report.increments.empty() ? 0 : report.increments.back().number;
    summary.rejected_increments = report.rejected_increments;
    summary.residual_over_tolerance = report.use.residual;
    summary.penetration_over_allowed = report.use.penetration;
    summary.newton_iterations = report.counts.newton;
    summary.linear_solves = report.counts.linear_solves;
    summary.linear_iterations = report.counts.linear_iterations;
    summary.greatest_penetration_over_radius = report.contact.greatest_penetration / radius;
    summary.wall_seconds = report.wall_seconds;
    summary.seconds_by_stage = report.seconds;
    summary.clean = audit.clean(allowed_penetration);
    const fibrant::simulation::EnergyBalance& energy = report.energy;
    const double turned_over = std::abs(energy.external) + energy.elastic + energy.contact;
    summary.energy_error_over_work = turned_over > 0.0 ? energy.error() / turned_over : 0.0;
    summary.crossings = audit.crossings;
    summary.wrong_crossings = audit.wrong_crossings;
    summary.missing_crossings = audit.missing_crossings;
    summary.least_gap_over_radius = audit.least_gap.gap / radius;
    summary.least_gap_fibre_i = audit.least_gap.fibre_i, summary.least_gap_fibre_j = audit.least_gap.fibre_j;
    summary.least_gap_place = audit.least_gap.position;
    summary.swelling = audit.swelling;
    summary.crimp_warp = crimp.warp;
    summary.crimp_weft = crimp.weft;
}

/// @returns what it wrote
inline observe::JsonObject write_summary(const std::filesystem::path& folder, const Summary& summary) {
    observe::JsonObject seconds;
    for (std::size_t part = 0; part < fibrant::core::part_count; ++part)
        seconds.add(fibrant::core::part_names[part], summary.seconds_by_stage[part]);
    observe::JsonObject json;
    json.add("converged", summary.converged)
        .add("audit_clean", summary.clean)
        .add("reason", summary.reason)
        .add("fibres", summary.fibres)
        .add("nodes", summary.nodes)
        .add("dofs", summary.dofs)
        .add("contact_elements", summary.contact_elements)
        .add("increments", summary.increments)
        .add("rejected_increments", summary.rejected_increments)
        .add("newton_iterations", summary.newton_iterations)
        .add("linear_solves", summary.linear_solves)
        .add("linear_iterations", summary.linear_iterations)
        .add("crossings", summary.crossings)
        .add("wrong_crossings", summary.wrong_crossings)
        .add("missing_crossings", summary.missing_crossings)
        .add("greatest_penetration_over_radius", summary.greatest_penetration_over_radius)
        .add("least_gap_over_radius", summary.least_gap_over_radius)
        .add("least_gap_fibre_i", summary.least_gap_fibre_i)
        .add("least_gap_fibre_j", summary.least_gap_fibre_j)
        .add("least_gap_x", summary.least_gap_place.x())
        .add("least_gap_y", summary.least_gap_place.y())
        .add("least_gap_z", summary.least_gap_place.z())
        .add("swelling_in_turn", summary.swelling.strain)
        .add("crimp_warp", summary.crimp_warp)
        .add("crimp_weft", summary.crimp_weft)
        .add("thickness", summary.thickness)
        .add("energy_error_over_work", summary.energy_error_over_work)
        .add("residual_over_tolerance", summary.residual_over_tolerance)
        .add("penetration_over_allowed", summary.penetration_over_allowed)
        .add("wall_seconds", summary.wall_seconds)
        .add("cpu_seconds", summary.cpu_seconds)
        .add("peak_memory_bytes", summary.peak_memory_bytes)
        .add("seconds_by_stage", seconds)
        .add("solver", summary.solver)
        .add("threads", summary.threads)
        .add("version", FIBRANT_VERSION);
    observe::write_file(folder / "summary.json", json.text() + "\n");
    return json;
}

/// The result in a few lines.
inline void print(const Summary& summary, const std::string& folder) {
    std::printf("\n%s after %td increments (%td rejected), %td Newton iterations, %s\n",
                summary.converged ? "settled" : "NOT settled", summary.increments, summary.rejected_increments,
                summary.newton_iterations, observe::clock_text(summary.wall_seconds).c_str());
    if (!summary.converged)
        std::printf("  %s\n", summary.reason.c_str());
    else if (!summary.clean)
        std::printf("  the audit is NOT clean: a crossing is wrong, or two fibres are too deep in each other\n");
    std::printf("  crossings  %td, against the pattern %td, missing %td\n", summary.crossings, summary.wrong_crossings,
                summary.missing_crossings);
    std::printf("  crimp      warp %.4f  weft %.4f;  thickness %.4f\n", summary.crimp_warp, summary.crimp_weft,
                summary.thickness);
    std::printf("  depth / r  %.4f;  least gap / r %.4f, fibres %td and %td at (%.3f, %.3f, %.3f);  energy balance %.1e\n",
                summary.greatest_penetration_over_radius, summary.least_gap_over_radius, summary.least_gap_fibre_i,
                summary.least_gap_fibre_j, summary.least_gap_place.x(), summary.least_gap_place.y(), summary.least_gap_place.z(),
                summary.energy_error_over_work);
    std::printf("  results    %s (report.html, view.svg, slice_*.svg, summary.json, paraview/fibres.pvd)\n", folder.c_str());
}

}  // namespace weave

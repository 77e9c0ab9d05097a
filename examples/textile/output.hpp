// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run of a textile writes: summary, tables of yarns and crossings, pictures.

#include "../support/example.hpp"
#include "../support/room.hpp"

#include <fibrant/compositions/textile/audit.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/periodic.hpp>
#include <fibrant/compositions/textile/yarn_contacts.hpp>
#include <fibrant/exchange/files.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

namespace textile {

using fibrant::Index;
namespace cloth = fibrant::compositions::textile;
namespace observe = fibrant::observe;

/// Files that a scene asks for beside the usual ones.
struct Wanted {
    bool surfaces = false;       ///< yarns as bodies
    double voxel_spacing = 0.0;  ///< [length]; 0: no voxels
    std::string unit = "mm";
};

/// Greatest distance of a node from where it began [length].
inline double greatest_move(const observe::Snapshot& from, const observe::Snapshot& to) {
    double most = 0.0;
    for (std::size_t f = 0; f < from.fibres.size(); ++f)
        for (std::size_t k = 0; k < from.fibres[f].position.size(); ++k)
            most = std::max(most, (to.fibres[f].position[k] - from.fibres[f].position[k]).norm());
    return most;
}

/// moves.csv: how far each fibre is from where it was drawn, and from the points of the file that it is of.
/// @param file  curves as the file has them, of fibres one by one; or none
inline void write_moves(const std::filesystem::path& folder, const cloth::Assembled& assembled, const observe::Snapshot& drawn,
                        const observe::Snapshot& settled, const std::vector<fibrant::exchange::FileCurve>& file) {
    observe::CsvWriter table(folder / "moves.csv");
    const std::vector<cloth::Moves> moves = cloth::moves_between(drawn, settled);
    for (std::size_t f = 0; f < moves.size(); ++f) {
        const double radius = settled.fibres[f].section.radius();
        std::vector<observe::Column> row{{"fibre", f},
                                         {"yarn", assembled.path_of[f]},
                                         {"mean_move_over_radius", moves[f].mean / radius},
                                         {"rms_move_over_radius", moves[f].root_mean_square / radius},
                                         {"greatest_move_over_radius", moves[f].greatest / radius}};
        if (file.size() == moves.size()) {  // a curve of a file may be a yarn of several fibres, which nobody has measured
            const cloth::Moves own = cloth::moves_from(file[f].points, settled.fibres[f]);
            row.push_back({"mean_from_file_over_radius", own.mean / radius});
            row.push_back({"rms_from_file_over_radius", own.root_mean_square / radius});
            row.push_back({"greatest_from_file_over_radius", own.greatest / radius});
        }
        table.row(row);
    }
}

/// Of what repeats the least gap counts across seams too, which contact does not see; images have numbers beyond those of fibres.
inline void see_images(const cloth::Textile& textile, const cloth::Assembled& assembled, const observe::Snapshot& settled,
                       double radius, fibrant::simulation::Audit& audit) {
    const observe::LeastGap least = cloth::image_gap(textile, assembled, settled, fibrant::proximity::GridSearch{});
    if (!(least.gap < audit.least_gap.gap)) return;
    if (least.gap < -audit.allowed)
        std::fprintf(
            stderr, "audit: with images of the cell, fibres %td and %td are %.4f radii deep in each other at (%g, %g, %g)\n",
            least.fibre_i, least.fibre_j, -least.gap / radius, least.position.x(), least.position.y(), least.position.z());
    audit.least_gap = least;
}

/// Says what is wrong with the topology.
inline void tell(const cloth::Textile& textile, const cloth::TopologyAudit& audit) {
    if (audit.clean()) return;
    std::fprintf(stderr,
                 "audit: crossings %td right, %td wrong, %td missing, %td more than asked for; links changed %td, linking "
                 "integral by %.3f at most; first %s and %s\n",
                 audit.crossings.right, audit.crossings.wrong, audit.crossings.missing, audit.crossings.extra,
                 audit.links_changed, audit.greatest_linking_change,
                 audit.first_yarn < 0 ? "-" : textile.label(audit.first_yarn).c_str(),
                 audit.second_yarn < 0 ? "-" : textile.label(audit.second_yarn).c_str());
}

/// Refuses voxels that there is no memory for, or that are larger than the sample.
/// @param spacing  of them [length], > 0
/// @param drawn    before it is settled
inline void require_voxels(const example::SceneReader& file, double spacing,
                           const std::vector<fibrant::exchange::FileCurve>& drawn) {
    constexpr double bytes_a_cell = 600.0;  // measured, with the files of them
    const fibrant::exchange::VoxelGrid grid = fibrant::exchange::grid_around(drawn, spacing);
    const fibrant::Index most = *std::max_element(grid.counts.begin(), grid.counts.end());
    file.check(most > 1, "output", "voxel_spacing", "less than the sample is long");
    const double bytes = bytes_a_cell * static_cast<double>(grid.cells());
    const example::Room room = example::memory_room();
    file.check(bytes <= room.bytes, "output", "voxel_spacing",
               "larger: " + std::to_string(grid.cells()) + " voxels take some " + example::memory_text(bytes) +
                   " of memory, and " + room.text());
}

/// yarns.csv, pairs.csv and crossings.csv, and the fibres as centrelines.csv and fibres.glb; yarns as bodies where they are asked
/// for.
inline void write_tables(const std::filesystem::path& folder, const cloth::Textile& textile, const cloth::Assembled& assembled,
                         const observe::Snapshot& settled, const Wanted& wanted) {
    namespace exchange = fibrant::exchange;
    const std::vector<exchange::FileCurve> curves = cloth::curves_of(settled, assembled.path_of);
    observe::write_file(folder / "centrelines.csv", exchange::csv_of(curves));
    observe::write_file(folder / "fibres.glb", exchange::glb_of(curves));
    const std::vector<exchange::FileYarn> bodies = exchange::yarns_of(curves);
    if (wanted.surfaces)
        for (const std::string& kind : exchange::yarn_kinds())
            observe::write_file(folder / ("tows." + kind), exchange::yarn_file_of(bodies, kind));
    if (wanted.voxel_spacing > 0.0) {
        const exchange::Voxels voxels = exchange::voxels_of(curves, exchange::grid_around(curves, wanted.voxel_spacing));
        for (const std::string& kind : exchange::voxel_kinds())
            observe::write_file(folder / ("cells." + kind), exchange::voxel_file_of(voxels, kind, 2, wanted.unit));
        observe::write_file(folder / "cells.raw.json", exchange::raw_head_of(voxels));
    }
    observe::CsvWriter yarns(folder / "yarns.csv");
    const std::vector<cloth::YarnFigures> figures = cloth::yarn_figures(textile, assembled, settled);
    const cloth::YarnContacts contacts = cloth::yarn_contacts(textile, assembled, settled);
    for (Index p = 0; p < fibrant::core::count(textile.paths); ++p) {
        const cloth::Path& path = textile.paths[fibrant::core::at(p)];
        const cloth::YarnFigures& yarn = figures[fibrant::core::at(p)];
        double pressing = 0.0;
        for (const cloth::YarnPair& pair : contacts.pairs)
            if (pair.first == p || pair.second == p) pressing += pair.normal_force;
        yarns.row({{"yarn", p},
                   {"name", path.name},
                   {"family", path.family},
                   {"fibres", textile.type_of(p).fibres},
                   {"length", yarn.length},
                   {"crimp", yarn.crimp},
                   {"strain", yarn.strain},
                   {"greatest_curvature", yarn.greatest_curvature},
                   {"mean_angle_deg", yarn.mean_angle * 180.0 / std::numbers::pi},
                   {"twist", exchange::turns_of(bodies[fibrant::core::at(p)])},
                   {"contact_length", contacts.length[fibrant::core::at(p)]},
                   {"normal_force", pressing}});
    }
    observe::CsvWriter pairs(folder / "pairs.csv");
    for (const cloth::YarnPair& pair : contacts.pairs)
        pairs.row({{"first", pair.first},
                   {"second", pair.second},
                   {"contact_length", pair.length},
                   {"contacts", pair.contacts},
                   {"normal_force", pair.normal_force},
                   {"friction_force", pair.friction_force}});
    if (textile.crossings.empty()) return;
    observe::CsvWriter crossings(folder / "crossings.csv");
    for (const cloth::Crossing& crossing : textile.crossings)
        crossings.row({{"above", crossing.above},
                       {"below", crossing.below},
                       {"at_above", crossing.at_above},
                       {"at_below", crossing.at_below},
                       {"axis_x", crossing.axis.x()},
                       {"axis_y", crossing.axis.y()},
                       {"axis_z", crossing.axis.z()}});
}

/// The same with families of yarns in the place of groups, for their colours.
inline observe::Snapshot by_family(const cloth::Textile& textile, const cloth::Assembled& assembled, observe::Snapshot settled) {
    for (std::size_t f = 0; f < settled.fibres.size(); ++f)
        settled.fibres[f].group = textile.paths[fibrant::core::at(assembled.path_of[f])].family;
    return settled;
}

/// view.svg and top.svg, a colour a family of yarns.
inline void write_pictures(const example::Output& output, const cloth::Textile& textile, const observe::Snapshot& coloured) {
    if (!output.pictures) return;
    observe::ViewParameters view;
    view.unit = output.unit, view.pieces = 60000;
    if (textile.view.radial) view.elevation = 15.0;
    observe::write_file(output.folder / "view.svg", observe::svg_view(coloured, view));
    view.azimuth = -90.0, view.elevation = textile.view.radial ? 0.0 : 90.0;
    observe::write_file(output.folder / "top.svg", observe::svg_view(coloured, view));
}

/// @returns what it wrote
inline observe::JsonObject write_summary(const example::Output& output, const fibrant::simulation::Report& report,
                                         const fibrant::simulation::Audit& audit, const cloth::TopologyAudit& topology,
                                         const cloth::Textile& textile, const cloth::Assembled& assembled,
                                         const observe::Snapshot& drawn, const observe::Snapshot& settled, Index unknowns) {
    const double radius = textile.smallest_radius();
    const std::vector<cloth::YarnFigures> figures = cloth::yarn_figures(textile, assembled, settled);
    std::vector<Index> families;
    for (const cloth::Path& path : textile.paths) families.push_back(path.family);
    std::sort(families.begin(), families.end());
    families.erase(std::unique(families.begin(), families.end()), families.end());
    std::vector<observe::JsonObject> list;
    for (const Index family : families) {
        double length = 0.0, crimp = 0.0, count = 0.0;
        for (std::size_t p = 0; p < figures.size(); ++p)
            if (textile.paths[p].family == family) length += figures[p].length, crimp += figures[p].crimp, count += 1.0;
        observe::JsonObject one;
        one.add("family", family)
            .add("yarns", static_cast<Index>(count))
            .add("mean_length", length / count)
            .add("mean_crimp", crimp / count);
        list.push_back(one);
    }
    observe::JsonObject json;
    json.add("textile", textile.name).add("topology_clean", topology.clean());
    json.add("yarns", fibrant::core::count(textile.paths))
        .add("fibres", fibrant::core::count(settled.fibres))
        .add("dofs", unknowns);
    json.add("greatest_move_over_radius", greatest_move(drawn, settled) / radius);
    double mean = 0.0, square = 0.0;
    for (const cloth::Moves& move : cloth::moves_between(drawn, settled))
        mean += move.mean, square += move.root_mean_square * move.root_mean_square;
    const auto fibres = static_cast<double>(settled.fibres.size());
    json.add("mean_move_over_radius", mean / fibres / radius).add("rms_move_over_radius", std::sqrt(square / fibres) / radius);
    json.add("crossings", topology.crossings.right + topology.crossings.wrong).add("right_crossings", topology.crossings.right);
    json.add("wrong_crossings", topology.crossings.wrong)
        .add("missing_crossings", topology.crossings.missing)
        .add("extra_crossings", topology.crossings.extra);
    json.add("linked_pairs", topology.linked)
        .add("links_changed", topology.links_changed)
        .add("greatest_linking_change", topology.greatest_linking_change);
    json.add("families", list);
    return example::write_summary(output, report, audit, radius, {}, json);
}

}  // namespace textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file What a load case writes: its curve, the fabric before and after, contact statistics and histograms.

#include "../support/example.hpp"
#include "../support/report_page.hpp"
#include "../weave/output.hpp"

#include <fibrant/compositions/weave/fibre_figures.hpp>
#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/observe/contact_statistics.hpp>
#include <fibrant/observe/svg_curves.hpp>

#include <algorithm>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace fabric_loading {

namespace cloth = fibrant::compositions::weave;
namespace observe = fibrant::observe;
using fibrant::Index;

/// Columns of the table of increments: the figures of the case, of tows and of the solution.
inline std::vector<observe::Column> columns(const std::vector<cloth::Figure>& figures, const observe::Snapshot& snapshot,
                                            const cloth::FabricParameters& fabric) {
    std::vector<observe::Column> row;
    for (const auto& [name, value] : figures) row.push_back({name, value});
    for (const cloth::Family family : {cloth::Family::warp, cloth::Family::weft}) {
        const std::string name = name_of(family);
        const cloth::TowFigures tows = cloth::tow_figures(snapshot, fabric, family);
        row.push_back({name + "_width", tows.width}), row.push_back({name + "_thickness", tows.thickness});
        row.push_back({name + "_fibre_volume_fraction", tows.fibre_volume_fraction}), row.push_back({name + "_gap", tows.gap});
    }
    return row;
}

/// A histogram of equal bins: from, to, number.
inline void write_histogram(const std::filesystem::path& path, const std::vector<double>& values, Index bins = 40) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    std::vector<Index> counts(fibrant::core::at(bins), 0);
    const double width = std::max((*high - *low) / static_cast<double>(bins), 1e-300);
    for (const double value : values)
        ++counts[fibrant::core::at(std::clamp<Index>(static_cast<Index>((value - *low) / width), 0, bins - 1))];
    observe::CsvWriter file(path);
    for (Index k = 0; k < bins; ++k)
        file.row({{"from", *low + static_cast<double>(k) * width},
                  {"to", *low + static_cast<double>(k + 1) * width},
                  {"elements", counts[fibrant::core::at(k)]}});
}

/// Pictures and measures of a state, in a folder of their own.
inline void write_state(const std::filesystem::path& folder, const observe::Snapshot& snapshot, const weave::Scene& scene,
                        bool pictures) {
    std::filesystem::create_directories(folder);
    weave::write_measures(folder, snapshot, scene.fabric, cloth::crimp_measures(snapshot, scene.fabric));
    if (pictures) weave::write_pictures(folder, snapshot, scene.fabric, scene.unit);
    const cloth::ElementFigures elements = cloth::element_figures(snapshot);
    write_histogram(folder / "strain_histogram.csv", elements.strain);
    write_histogram(folder / "curvature_histogram.csv", elements.curvature);
    const observe::ContactStatistics contacts = observe::contact_statistics(snapshot);
    observe::JsonObject json;
    json.add("elements", contacts.elements)
        .add("active", contacts.active)
        .add("fibre_pairs", contacts.fibre_pairs)
        .add("least_gap", contacts.least_gap)
        .add("greatest_penetration_over_radius", contacts.greatest_penetration_over_radius)
        .add("sum_of_reactions", contacts.sum_of_reactions)
        .add("sum_of_friction", contacts.sum_of_friction);
    observe::write_file(folder / "contacts.json", json.text() + "\n");
}

/// curve.svg, the two first figures of the case and what damping holds, and gap.svg, the gaps between neighbouring tows over the
/// same abscissa, both from the table, which a run that was resumed has whole. Forces in N, as in the scene files.
inline void write_curves(const std::filesystem::path& folder, const std::string& title, const std::string& unit) {
    const example::Table table(folder / "increments.csv");
    const std::size_t x = table.column("progress") + 1;
    if (x + 1 >= table.names().size()) return;
    const std::string &x_name = table.names()[x], &y_name = table.names()[x + 1];
    const auto over_x = [&](const std::string& name, std::string_view column) {
        return table.line(name, x, table.column(column));
    };
    std::vector<observe::PlotLine> curve{over_x(y_name, y_name)};
    if (curve[0].points.empty()) return;
    if (y_name == "force") curve.push_back(over_x("held by damping", "damping_force"));
    const std::string x_label = example::axis_label(x_name, unit);
    observe::write_file(
        folder / "curve.svg",
        observe::curves_svg({.title = title, .x_label = x_label, .y_label = example::axis_label(y_name, unit), .lines = curve}));
    observe::write_file(folder / "gap.svg",
                        observe::curves_svg({.title = title,
                                             .x_label = x_label,
                                             .y_label = "gap between neighbouring tows [" + unit + "]",
                                             .lines = {over_x("warp", "warp_gap"), over_x("weft", "weft_gap")}}));
}

}  // namespace fabric_loading

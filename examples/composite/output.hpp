// SPDX-License-Identifier: MIT
#pragma once
/// @file What a run of a composite writes beside the table of increments: curve, pictures, summary.

#include "../support/example.hpp"
#include "../support/report_page.hpp"
#include "../weave/output.hpp"

#include <fibrant/compositions/composite/composite.hpp>
#include <fibrant/observe/solid_writer.hpp>
#include <fibrant/observe/svg_curves.hpp>
#include <fibrant/observe/svg_solid.hpp>

#include <algorithm>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace composite {

namespace cloth = fibrant::compositions::weave;
namespace parts = fibrant::compositions::composite;
namespace observe = fibrant::observe;
using fibrant::Index;

/// Name of what a load does, of what it takes, and both after an increment.
struct CurvePoint {
    std::string x_name, y_name, column;  ///< what is done and what it takes; the latter's column in the table of increments
    double x, y;
};
inline CurvePoint curve_point(const parts::LoadParameters& load, double amplitude, const fibrant::simulation::Wrench& edge) {
    switch (load.load) {
        case parts::LoadCase::bending:
            return {"angle_deg", "moment", "moment_y", amplitude * load.angle_deg, edge.moment.y()};
        case parts::LoadCase::twisting:
            return {"angle_deg", "torque", "moment_x", amplitude * load.angle_deg, edge.moment.x()};
        case parts::LoadCase::shear:
            return {"shear", "force", "force_y", amplitude * load.strain, edge.force.y()};
        default:
            return {"strain", "force", "force_x", amplitude * load.strain, edge.force.x()};
    }
}

/// The solid's ParaView files.
class Watch {
public:
    explicit Watch(const example::Output& output) {
        if (output.paraview) series_.emplace(output.folder / "paraview", output.start());
    }
    void accepted(const observe::Snapshot& snapshot) {
        if (series_) series_->accepted(snapshot);
    }

private:
    std::optional<observe::SolidWriter> series_;
};

/// Columns of the table of increments beside those of every run.
inline std::vector<observe::Column> columns(const CurvePoint& point, const fibrant::simulation::Wrench& edge) {
    return {{point.x_name, point.x},       {"moment_x", edge.moment.x()}, {"moment_y", edge.moment.y()},
            {"moment_z", edge.moment.z()}, {"force_x", edge.force.x()},   {"force_y", edge.force.y()},
            {"force_z", edge.force.z()}};
}

/// curve.svg of the load, from the table, which a run that was resumed has whole.
inline void write_curve(const example::Output& output, const CurvePoint& names) {
    const example::Table table(output.folder / "increments.csv");
    const observe::PlotLine line = table.line("", table.column(names.x_name), table.column(names.column), "stage", "load");
    if (line.points.empty()) return;
    observe::write_file(output.folder / "curve.svg",
                        observe::curves_svg({.title = output.scene.stem().string(),
                                             .x_label = example::axis_label(names.x_name, output.unit),
                                             .y_label = example::axis_label(names.y_name, output.unit),
                                             .lines = {line}}));
}

/// view.svg of the fibres, solid.svg of the matrix with stresses, slices through both.
inline void write_pictures(const example::Output& output, const observe::Snapshot& snapshot,
                           const cloth::FabricParameters& fabric) {
    if (!output.pictures) return;
    observe::ViewParameters view;
    view.palette = cloth::fabric_palette(fabric), view.unit = output.unit, view.azimuth = -65.0, view.elevation = 22.0;
    observe::write_file(output.folder / "view.svg", observe::svg_view(snapshot, view));
    std::vector<double> values;
    for (const fibrant::Mat3& stress : snapshot.solid.stress) values.push_back(observe::von_mises(stress));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    view.title = "von Mises stress";
    const double most = std::max(sorted[sorted.size() * 99 / 100], 1e-300);
    observe::write_file(output.folder / "solid.svg", observe::svg_solid(snapshot.solid, values, most, view));
    for (const Index axis : {Index{0}, Index{1}}) {
        observe::SliceParameters slice;
        slice.axis = axis, slice.unit = output.unit, slice.palette = view.palette;
        slice.position = fabric.tow_position(axis == 0 ? cloth::Family::weft : cloth::Family::warp,
                                             axis == 0 ? fabric.weft_tows / 2 : fabric.warp_tows / 2);
        observe::write_file(output.folder / (axis == 0 ? "slice_x.svg" : "slice_y.svg"), observe::svg_slice(snapshot, slice));
    }
}

/// summary.json
template <class Simulator>
observe::JsonObject write_summary(const example::Output& output, const Simulator& simulator,
                                  const fibrant::simulation::Report& report, const fibrant::simulation::Audit& audit,
                                  const CurvePoint& point, double radius) {
    const auto& solid = simulator.equilibrium().solid();
    const auto start = std::find_if(report.increments.begin(), report.increments.end(),
                                    [](const auto& increment) { return increment.stage == "load"; });
    const fibrant::simulation::EnergyBalance none,
        &before = start == report.increments.begin() || report.increments.empty() ? none : (start - 1)->energy;
    const auto number = [](auto value) { return static_cast<double>(value); };
    return example::write_summary(output, report, audit, radius,
                                  {{"fibres", number(simulator.mesh().fibre_count())},
                                   {"unknowns", number(simulator.state().size())},
                                   {"solid_unknowns", number(3 * solid.nodes())},
                                   {"cells", number(solid.cells())},
                                   {"bonds", number(solid.bonds().size())},
                                   {point.x_name, point.x},
                                   {point.y_name, point.y},
                                   {"search_seconds", report.seconds[0]},
                                   {"contact_seconds", report.seconds[1]},
                                   {"assembly_seconds", report.seconds[2]},
                                   {"preparation_seconds", report.seconds[3]},
                                   {"solution_seconds", report.seconds[4]},
                                   {"output_seconds", report.seconds[5]},
                                   {"elastic_before_load", before.elastic},
                                   {"external_before_load", before.external},
                                   {"dissipated_before_load", before.dissipated},
                                   {"elastic", report.energy.elastic},
                                   {"external", report.energy.external},
                                   {"dissipated", report.energy.dissipated},
                                   {"damped", report.energy.damped},
                                   {"energy_error", report.energy.error()}});
}

}  // namespace composite

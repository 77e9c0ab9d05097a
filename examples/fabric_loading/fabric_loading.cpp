// SPDX-License-Identifier: MIT
// Load cases of a dry woven fabric, from the settled state that `weave` has written.
//   fabric_loading CASE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/loaded_fibres.hpp"
#include "../support/program.hpp"
#include "load_file.hpp"
#include "output.hpp"

#include <fibrant/simulation/refined_state.hpp>

#include <optional>
#include <stdexcept>
#include <string>

using namespace fibrant;
namespace cloth = compositions::weave;

namespace {

template <simulation::Model LoadedWeave>
bool run(const fabric_loading::LoadFile& load, example::SceneReader& file, example::Output& output) {
    const cloth::FabricParameters& fabric = load.scene.fabric;
    const double radius = cloth::smallest_radius(fabric);

    // The settled fabric, and bodies at its edges.
    auto parameters = cloth::model_parameters<LoadedWeave>(fabric, load.scene.settle);
    const auto mesh_of = [&](const cloth::FabricParameters& of) {
        scene::Assembly fibres;
        cloth::add_flat_fibres(fibres, of);
        return beam::Mesh<typename LoadedWeave::Beam>(fibres, typename LoadedWeave::Beam(parameters.beam));
    };
    const auto mesh = mesh_of(fabric);
    output.keep(file, "settled", "checkpoint", load.checkpoint);
    if (!output.other_scene)
        example::require_scene_of(load.checkpoint, load.scene.told, file.file() + ": settled.checkpoint", weave::fabric_sections);
    const auto checkpoint = [&](const auto& read) {
        try {
            return read();
        } catch (const std::runtime_error& error) {
            file.refuse("settled", "checkpoint", std::string("what this fabric left, and ") + error.what());
        }
    };
    std::string start = load.checkpoint;
    std::optional<simulation::StoredState<LoadedWeave>> refined;
    if (load.parts > 1) {
        const auto coarse = mesh_of(load.settled_fabric);
        refined = simulation::refined(checkpoint([&] { return simulation::read_state<LoadedWeave>(load.checkpoint, coarse); }),
                                      coarse, mesh, load.parts);
    }
    const Vector state = refined ? refined->state : checkpoint([&] { return simulation::checkpoint_state(start, mesh); });
    const observe::Snapshot settled = simulation::snapshot_of(mesh, state);
    const cloth::LoadCase scene = cloth::load_case(load.name, settled, fabric, load.tow_ends, load.forming);
    fabric_loading::require_channels(file, load, connection::Channels(scene.assembly).names());
    parameters.iteration = load.scene.iteration;
    example::choose_solver(parameters, load.scene.linear_solver);
    const example::RankFolder own(output);
    if (load.points_per_element > 0) parameters.contact.spacing.points_per_element = static_cast<double>(load.points_per_element);
    simulation::Simulator<LoadedWeave> simulator(scene.assembly, parameters);
    output.parts = {output.folder / "before", output.folder / "after"};
    output.open(file, load.scene.told);
    if (refined) simulation::write_state<LoadedWeave>(start = (output.folder / "refined.bin").string(), mesh, *refined);
    simulator.start_from(start);
    fabric_loading::write_state(output.folder / "before", settled, load.scene, output.pictures);

    // The programme.
    example::Recorder recorder(output, radius, [&] {
        const observe::Snapshot now = simulator.snapshot();
        return fabric_loading::columns(cloth::load_figures(scene, simulator, now), now, fabric);
    });
    simulation::Loading<LoadedWeave> loading = simulation::loading_of<LoadedWeave>(load.programme);
    output.tell(loading, 20.0);
    example::stop_together(loading);
    const simulation::Report report = simulator.run(loading, recorder);

    const observe::Snapshot snapshot = simulator.snapshot();
    fabric_loading::write_state(output.folder / "after", snapshot, load.scene, output.pictures);
    fabric_loading::write_curves(output.folder, load.name, output.unit);
    const cloth::CrimpMeasures before = cloth::crimp_measures(settled, fabric), after = cloth::crimp_measures(snapshot, fabric);
    std::vector<std::pair<std::string, double>> figures{{"fibres", static_cast<double>(fabric.fibres())},
                                                        {"dofs", static_cast<double>(simulator.mesh().layout().unknowns())}};
    for (const auto& figure : cloth::load_figures(scene, simulator, snapshot)) figures.push_back(figure);
    for (const auto& [name, value] : std::vector<std::pair<std::string, double>>{{"crimp_before", before.warp},
                                                                                 {"crimp_after", after.warp},
                                                                                 {"dissipated", report.energy.dissipated},
                                                                                 {"damped", report.energy.damped},
                                                                                 {"external_work", report.energy.external},
                                                                                 {"energy_error", report.energy.error()}})
        figures.emplace_back(name, value);
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const observe::JsonObject summary = example::write_summary(output, report, audit, radius, figures);
    example::write_report(output, "fabric_loading", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

bool solve_fabric_loading(example::SceneReader& file, example::Output& output) {
    const fabric_loading::LoadFile load = fabric_loading::read_load_file(file, output.scene.parent_path());
    return load.scene.own_laws() ? run<example::LoadedFibres<true>>(load, file, output)
                                 : run<example::LoadedFibres<false>>(load, file, output);
}

}  // namespace

example::Program fabric_loading_program() {
    return {"fabric_loading", "Loads a settled woven fabric through bodies at its edges.", solve_fabric_loading};
}

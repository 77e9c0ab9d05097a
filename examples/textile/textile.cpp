// SPDX-License-Identifier: MIT
// Settles a textile of any kind, braid, weave, knit, rope, net or mail, from the paths of its yarns, audits what came of it, and
// loads it.
//   textile SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/loaded_fibres.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "loading.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <algorithm>
#include <cstdio>
#include <stdexcept>

using namespace fibrant;

namespace {

template <simulation::Model Yarns>
bool settle(const textile::Scene& scene, example::SceneReader& file, example::Output& output) {
    const double radius = scene.textile.smallest_radius();
    const textile::cloth::Assembled assembled = textile::cloth::assemble(scene.textile, scene.fineness);
    textile::cloth::require_ends_apart(scene.textile, assembled, 2.0 * scene.settle.allowed_penetration_over_radius * radius);
    auto parameters = textile::cloth::model_parameters<Yarns>(scene.textile, scene.settle);
    example::choose_solver(parameters, scene.linear_solver);
    const example::RankFolder own(output);
    simulation::Simulator<Yarns> simulator(assembled.assembly, parameters);
    const observe::Snapshot drawn = simulation::snapshot_of(simulator.mesh(), simulator.mesh().start_state());

    // What comes after the settling is refused before it.
    if (scene.voxel_spacing > 0.0)
        textile::require_voxels(file, scene.voxel_spacing, textile::cloth::curves_of(drawn, assembled.path_of));
    if (scene.load.wanted && !scene.load.cell)
        textile::cloth::load_case(scene.textile, assembled, drawn, simulator.mesh().start_state(), scene.load.parameters);

    if (scene.load.wanted) output.parts = {output.folder / "loading"};
    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        return {{"greatest_move_over_radius", textile::greatest_move(drawn, simulator.snapshot()) / radius}};
    });
    auto loading = textile::cloth::settling<Yarns>(scene.textile, assembled, scene.settle);
    output.tell(loading, 15.0);
    example::stop_together(loading);
    const simulation::Report report = simulator.run(loading, recorder);

    const observe::Snapshot settled = simulator.snapshot();
    simulation::Audit audit = example::audit(output, simulator, radius);
    if (!scene.textile.lattice.empty()) textile::see_images(scene.textile, assembled, settled, radius, audit);
    const textile::cloth::TopologyAudit topology = textile::cloth::audit_topology(
        scene.textile, assembled, textile::cloth::lines_of(drawn), textile::cloth::lines_of(settled));
    textile::tell(scene.textile, topology);
    textile::write_tables(output.folder, scene.textile, assembled, settled, {scene.surfaces, scene.voxel_spacing, output.unit});
    textile::write_moves(output.folder, assembled, drawn, settled, scene.file_curves);
    const observe::Snapshot coloured = textile::by_family(scene.textile, assembled, settled);
    textile::write_pictures(output, scene.textile, coloured);
    const observe::JsonObject summary = textile::write_summary(output, report, audit, topology, scene.textile, assembled, drawn,
                                                               settled, simulator.mesh().layout().unknowns());
    example::write_report(
        output,
        {"textile",
         output.unit,
         summary,
         {},
         {"textile", "converged", "audit_clean", "topology_clean", "yarns", "fibres", "crossings", "right_crossings",
          "greatest_move_over_radius", "least_gap_over_radius", "greatest_penetration_over_radius", "wall_seconds"}},
        coloured);
    const bool sound = report.converged && audit.clean() && topology.clean();
    if (!sound || !scene.load.wanted || example::stopped()) return sound;
    if (scene.load.cell) return textile::run_cell(output, scene, assembled, simulator);
    return textile::run_load_case(output, scene, assembled, simulator).second;
}

/// @throws std::invalid_argument for what ranks do not share yet
void require_open(const textile::Scene& scene, const example::SceneReader& file) {
    const auto& paths = scene.textile.paths;
    const auto rings = [](const auto& path) { return path.kind == textile::cloth::PathKind::closed; };
    if (!scene.textile.lattice.empty() || std::any_of(paths.begin(), paths.end(), rings))
        file.refuse("textile", "generator", "of open yarns that do not repeat: rings and cells are not shared among ranks");
}

bool solve_textile(example::SceneReader& file, example::Output& output) {
    const textile::Scene scene = textile::read_scene(file);
    if (example::run_by_ranks) require_open(scene, file);
    if (scene.generator == "file" && !scene.textile.crossings.empty()) {
        try {
            textile::cloth::require_holding(scene.textile);
        } catch (const std::invalid_argument& loose) {  // ends may hold it
            std::fprintf(stderr, "textile: note: %s; nothing but held ends and friction keeps it\n", loose.what());
        }
    }
    return scene.own_laws ? settle<example::LoadedFibres<true>>(scene, file, output)
                          : settle<example::LoadedFibres<false>>(scene, file, output);
}

}  // namespace

example::Program textile_program() {
    return {"textile", "Settles a textile of any kind from the paths of its yarns, and audits it.", solve_textile};
}

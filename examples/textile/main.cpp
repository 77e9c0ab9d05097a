// SPDX-License-Identifier: MIT
// Settles a textile of any kind, braid, weave, knit, rope, net or mail, from the paths of its yarns, and audits what came of it.
//   textile SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/report_page.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/any_solver.hpp>

using namespace fibrant;

/// @tparam Section  law of the sections of the fibres
template <class Section>
struct YarnsOf {
    using Beam = beam::With<beam::DirectorBeam<>, Section>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::AnySolver;
    using Connections = connection::RigidBodies;
};

template <simulation::Model Yarns>
bool settle(const textile::Scene& scene, example::SceneReader& file, example::Output& output) {
    const double radius = scene.textile.smallest_radius();
    const textile::cloth::Assembled assembled = textile::cloth::assemble(scene.textile, scene.fineness);
    auto parameters = textile::cloth::model_parameters<Yarns>(scene.textile, scene.settle);
    parameters.solver.strategy = scene.linear_solver;
    simulation::Simulator<Yarns> simulator(assembled.assembly, parameters);
    const observe::Snapshot drawn = simulation::snapshot_of(simulator.mesh(), simulator.mesh().start_state());

    output.open(file);
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        return {{"greatest_move_over_radius", textile::greatest_move(drawn, simulator.snapshot()) / radius}};
    });
    auto loading = textile::cloth::settling<Yarns>(scene.textile, assembled, scene.settle);
    output.tell(loading, 15.0);
    const simulation::Report report = simulator.run(loading, recorder);

    const observe::Snapshot settled = simulator.snapshot();
    const simulation::Audit audit = example::audit(output, simulator, radius);
    const textile::cloth::TopologyAudit topology = textile::cloth::audit_topology(
        scene.textile, assembled, textile::cloth::lines_of(drawn), textile::cloth::lines_of(settled));
    textile::tell(scene.textile, topology);
    textile::write_tables(output.folder, scene.textile, assembled, settled);
    const observe::Snapshot coloured = textile::by_family(scene.textile, assembled, settled);
    textile::write_pictures(output, scene.textile, coloured);
    const observe::JsonObject summary = textile::write_summary(output, report, audit, topology, scene.textile, assembled, drawn, settled,
                                                               simulator.mesh().layout().unknowns());
    example::write_report(output.folder, {"textile", output.unit, summary, {},
                                          {"textile", "converged", "audit_clean", "topology_clean", "yarns", "fibres", "crossings",
                                           "right_crossings", "greatest_move_over_radius", "least_gap_over_radius",
                                           "greatest_penetration_over_radius", "wall_seconds"}},
                          coloured);
    return report.converged && audit.clean() && topology.clean();
}

bool solve(example::SceneReader& file, example::Output& output) {
    const textile::Scene scene = textile::read_scene(file);
    return scene.transverse ? settle<YarnsOf<material::Elastic>>(scene, file, output)
                            : settle<YarnsOf<beam::Isotropic>>(scene, file, output);
}

int main(int argc, char** argv) {
    return example::run(argc, argv, "textile", "Settles a textile of any kind from the paths of its yarns, and audits it.",
                        solve);
}

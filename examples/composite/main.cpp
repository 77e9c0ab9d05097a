// SPDX-License-Identifier: MIT
// A woven fabric is settled, put between two layers of matrix, bonded to them, and bent, twisted, drawn or sheared.
//   composite SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "scene_file.hpp"

#include "../support/example.hpp"
#include "../weave/output.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/composite/composite.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/observe/solid_writer.hpp>
#include <fibrant/observe/svg_solid.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/solid_pcg.hpp>

using namespace fibrant;
namespace cloth = compositions::weave;
namespace parts = compositions::composite;

struct Dry {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::TwoLevelPcg;
};
struct Composite : Dry {
    using Solid = connection::BondedSolid<solid::Hexahedron<solid::EnhancedStrains, solid::NeoHookean>, connection::NeverDebonds>;
    using Solver = solver::SolidPcg;
};

/// Settles the fabric, or takes it from where an earlier run left it.
void settle(simulation::Simulator<Dry>& dry, const composite::Scene& scene, const example::Output& output) {
    auto loading = cloth::settling<Dry>(scene.weave.fabric, scene.weave.settle);
    loading.checkpoint = scene.settled.empty() ? (output.folder / "settled.bin").string() : scene.settled;
    loading.checkpoint_seconds = 1e9, loading.resume = true;
    weave::ProgressPrinter progress(cloth::smallest_radius(scene.weave.fabric), output.quiet);
    const simulation::Report report = dry.run(loading, progress);
    if (!report.converged) throw std::runtime_error("the fabric did not settle: " + report.reason);
}

void write_pictures(const example::Output& output, const observe::Snapshot& snapshot, const cloth::FabricParameters& fabric) {
    if (!output.pictures) return;
    observe::ViewParameters view;
    view.palette = cloth::fabric_palette(fabric), view.unit = output.unit, view.azimuth = -65.0, view.elevation = 22.0;
    observe::write_file(output.folder / "view.svg", observe::svg_view(snapshot, view));
    std::vector<double> values;
    for (const Mat3& stress : snapshot.solid.stress) values.push_back(observe::von_mises(stress));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    view.title = "von Mises stress";
    const double most = std::max(sorted[sorted.size() * 99 / 100], 1e-300);
    observe::write_file(output.folder / "solid.svg", observe::svg_solid(snapshot.solid, values, most, view));
    for (const Index axis : {Index{0}, Index{1}}) {
        observe::SliceParameters slice;
        slice.axis = axis, slice.unit = output.unit, slice.palette = view.palette;
        slice.position = fabric.tow_position(axis == 0 ? cloth::Family::weft : cloth::Family::warp, axis == 0 ? fabric.weft_tows / 2 : fabric.warp_tows / 2);
        observe::write_file(output.folder / (axis == 0 ? "slice_x.svg" : "slice_y.svg"), observe::svg_slice(snapshot, slice));
    }
}

bool solve(const composite::Scene& scene, const example::Output& output) {
    const cloth::FabricParameters& fabric = scene.weave.fabric;
    const double radius = cloth::smallest_radius(fabric);
    const scene::Assembly flat = cloth::flat_fabric(fabric, scene.weave.settle.tension_strain);
    auto dry_parameters = cloth::model_parameters<Dry>(fabric, scene.weave.settle);
    dry_parameters.iteration = scene.weave.iteration;
    simulation::Simulator<Dry> dry(flat, dry_parameters);
    settle(dry, scene, output);
    const solid::Layers layers = parts::layers_of(dry.snapshot(), fabric, scene.matrix);
    const parts::Composite composite = parts::composite_of(fabric, dry.state(), flat, layers, scene.load);

    auto parameters = cloth::model_parameters<Composite>(fabric, scene.weave.settle);
    parameters.friction.friction_coefficient = scene.weave.settle.friction_coefficient;
    parameters.iteration = scene.weave.iteration;
    parameters.iteration.margin = 1.0, parameters.iteration.largest_margin = 8.0;  // edges swing far
    parameters.solver.carried = scene.carried;
    parameters.solid.bonding_factor = scene.matrix.bonding_factor;
    simulation::Simulator<Composite> simulator(composite.assembly, parameters);
    simulator.go_on_from(dry);
    const auto& solid = simulator.equilibrium().solid();
    if (!output.quiet)
        std::printf("matrix: %td nodes, %td cells, %td bonds; grid columns %td, pores %td of %td, clipped %td\n", solid.nodes(), solid.cells(),
                    core::count(solid.bonds()), layers.columns, layers.filled, layers.met + layers.filled, layers.clipped);
    const simulation::IncrementReport* last = nullptr;
    struct Energies {
        const simulation::IncrementReport*& last;
        void reported(const simulation::IncrementReport& increment) { last = &increment; }
    } energies{last};
    example::Recorder recorder(output, radius, [&]() -> std::vector<observe::Column> {
        const simulation::Wrench edge = parts::edge_wrench(simulator, composite);
        const double a = simulator.amplitude(parts::load_channel);
        const bool turns = scene.load.load == parts::LoadCase::bending || scene.load.load == parts::LoadCase::twisting;
        return {{turns ? "angle_deg" : "strain", a * (turns ? scene.load.angle_deg : scene.load.strain)},
                {"moment_x", edge.moment.x()}, {"moment_y", edge.moment.y()}, {"moment_z", edge.moment.z()},
                {"force_x", edge.force.x()}, {"force_y", edge.force.y()}, {"force_z", edge.force.z()},
                {"linear_iterations", last->counts.linear_iterations}, {"linear_solves", last->counts.linear_solves},
                {"elastic", last->energy.elastic}, {"external", last->energy.external}, {"dissipated", last->energy.dissipated},
                {"damped", last->energy.damped}, {"rearranged", last->energy.rearranged}, {"energy_error", last->energy.error()}};
    });
    std::optional<observe::SolidWriter> series;
    struct Series {
        std::optional<observe::SolidWriter>& writer;
        void accepted(const observe::Snapshot& snapshot) {
            if (writer) writer->accepted(snapshot);
        }
    } solids{series};
    if (output.paraview) series.emplace(output.folder / "paraview", output.start());
    auto loading = parts::loading_of<Composite>(fabric, scene.load);
    loading.checkpoint = output.checkpoint(), loading.resume = output.resume;
    loading.checkpoint_seconds = 20.0;
    const simulation::Report report = simulator.run(loading, energies, recorder, solids);
    write_pictures(output, simulator.snapshot(), fabric);
    const simulation::Wrench edge = parts::edge_wrench(simulator, composite);
    const auto& start = report.increments.empty() ? simulation::IncrementReport{} : report.increments.front();
    example::write_summary(output, report, radius, {{"fibres", static_cast<double>(simulator.mesh().fibre_count())},
                           {"unknowns", static_cast<double>(simulator.state().size())}, {"solid_unknowns", static_cast<double>(3 * solid.nodes())},
                           {"cells", static_cast<double>(solid.cells())}, {"bonds", static_cast<double>(core::count(solid.bonds()))},
                           {"moment_x", edge.moment.x()}, {"moment_y", edge.moment.y()}, {"force_x", edge.force.x()}, {"force_y", edge.force.y()},
                           {"linear_iterations", static_cast<double>(report.counts.linear_iterations)},
                           {"search_seconds", report.seconds[0]}, {"contact_seconds", report.seconds[1]}, {"assembly_seconds", report.seconds[2]},
                           {"preparation_seconds", report.seconds[3]}, {"solution_seconds", report.seconds[4]}, {"output_seconds", report.seconds[5]},
                           {"first_increment_elastic", start.energy.elastic}, {"elastic", report.energy.elastic}, {"external", report.energy.external},
                           {"dissipated", report.energy.dissipated}, {"damped", report.energy.damped}, {"energy_error", report.energy.error()},
                           {"peak_memory_bytes", static_cast<double>(weave::peak_memory_bytes())}});
    return report.converged;
}

int main(int argc, char** argv) {
    std::string path;
    std::vector<std::string> set;
    std::string folder;
    int threads = 0;
    example::Output output;
    CLI::App app{"A woven fabric between two layers of matrix, bent, twisted, drawn or sheared."};
    app.set_version_flag("--version", FIBRANT_VERSION);
    app.add_option("scene", path, "scene file (TOML)")->required();
    app.add_option("--output", folder, "folder for the results, made if need be")->required();
    app.add_option("--set", set, "section.key=value, in the place of what the file says")->allow_extra_args(false);
    app.add_option("--threads", threads, "0: as many as the machine has")->check(CLI::NonNegativeNumber);
    app.add_flag("--resume", output.resume, "go on from the last accepted increment in the folder");
    app.add_flag("--quiet", output.quiet, "print nothing but errors");
    CLI11_PARSE(app, argc, argv);
    try {
        const composite::Scene scene = composite::read_scene(path, set);
        output.paraview = scene.weave.paraview, output.pictures = scene.weave.pictures, output.unit = scene.weave.unit;
        output.folder = folder;
        std::filesystem::create_directories(output.folder);
#if defined(_OPENMP)
        if (threads > 0) omp_set_num_threads(threads);
#endif
        return solve(scene, output) ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "composite: %s\n", error.what());
        return 2;
    }
}

// SPDX-License-Identifier: MIT
// The initial state of a woven fabric at the scale of its fibres, found from flat, interpenetrating tows.
//   weave SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume] [--quiet]
#include "../support/process.hpp"
#include "../support/progress.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/any_solver.hpp>

#include <CLI/CLI.hpp>
#if defined(_OPENMP)
#include <omp.h>
#endif

#include <thread>

using namespace fibrant;

template <law::FrictionLaw Law>
struct Weave {
    using Beam = beam::DirectorBeam<>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = Law;
    using Solver = solver::AnySolver;
};

struct Options {
    std::string scene, output;
    std::vector<std::string> set;
    Index threads = 0;
    bool resume = false, quiet = false;
};

template <simulation::Model M>
bool settle(const weave::Scene& scene, const Options& options, Index threads) {
    const double radius = weave::cloth::smallest_radius(scene.fabric);
    auto parameters = weave::cloth::model_parameters<M>(scene.fabric, scene.settle);
    parameters.iteration = scene.iteration;
    parameters.solver.strategy = scene.linear_solver;
    const scene::Assembly assembly = weave::cloth::flat_fabric(scene.fabric, scene.settle.tension_strain);
    simulation::Simulator<M> simulator(assembly, parameters);

    const std::filesystem::path folder = options.output;
    const observe::Start start = options.resume ? observe::Start::resumed : observe::Start::anew;
    auto progress = example::progress_printer(radius, 0, options.quiet);
    weave::IncrementTable table(folder, radius, start);
    weave::Series series(folder / "paraview", start, scene.paraview ? scene.paraview_every : 0);
    auto loading = weave::cloth::settling<M>(scene.fabric, scene.settle);
    loading.checkpoint = (folder / "checkpoint.bin").string();
    loading.checkpoint_seconds = 15.0;
    loading.resume = options.resume;
    const simulation::Report report = simulator.run(loading, progress, table, series);

    const observe::Snapshot snapshot = simulator.snapshot();
    const auto audit = weave::cloth::audit(snapshot, scene.fabric, proximity::GridSearch());
    const auto crimp = weave::cloth::crimp_measures(snapshot, scene.fabric);
    weave::Summary summary;
    weave::fill(summary, report, audit, crimp, radius, scene.settle.allowed_penetration_over_radius * radius);
    summary.fibres = simulator.mesh().fibre_count();
    summary.dofs = simulator.mesh().layout().unknowns();
    summary.nodes = summary.dofs / M::Beam::dofs_per_node;
    summary.thickness = weave::cloth::thickness(snapshot, scene.fabric);
    summary.threads = threads;
    weave::write_measures(folder, snapshot, scene.fabric, crimp);
    if (scene.pictures) weave::write_pictures(folder, snapshot, scene.fabric, scene.unit);
    summary.cpu_seconds = example::cpu_seconds();
    summary.peak_memory_bytes = example::peak_memory_bytes();
    weave::write_summary(folder, summary);
    if (!options.quiet) weave::print(summary, options.output);
    return summary.converged && summary.clean;
}

int main(int argc, char** argv) {
    Options options;
    CLI::App app{"Finds the initial state of a woven fabric from flat, interpenetrating tows."};
    app.set_version_flag("--version", FIBRANT_VERSION);
    app.add_option("scene", options.scene, "scene file (TOML)")->required();
    app.add_option("--output", options.output, "folder for the results, made if need be")->required();
    app.add_option("--set", options.set, "section.key=value, in the place of what the file says")->allow_extra_args(false);
    app.add_option("--threads", options.threads, "0: as many as the machine has")->check(CLI::NonNegativeNumber);
    app.add_flag("--resume", options.resume, "go on from the last accepted increment in the folder");
    app.add_flag("--quiet", options.quiet, "print nothing but errors");
    CLI11_PARSE(app, argc, argv);
    example::keep_freed_memory();
    try {
        const weave::Scene scene = weave::read_scene(options.scene, options.set);
        [[maybe_unused]] const Index wanted = options.threads > 0 ? options.threads : scene.threads;
#if defined(_OPENMP)
        if (wanted > 0) omp_set_num_threads(static_cast<int>(wanted));
#endif
        const Index threads = core::threads();
        std::filesystem::create_directories(options.output);
        const bool sliding = scene.settle.friction_coefficient > 0.0;
        const bool sound = sliding ? settle<Weave<law::RegularisedCoulomb>>(scene, options, threads)
                                   : settle<Weave<law::Frictionless>>(scene, options, threads);
        return sound ? 0 : 1;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "weave: %s\n", error.what());
        return 2;
    }
}

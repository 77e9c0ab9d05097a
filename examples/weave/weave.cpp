// SPDX-License-Identifier: MIT
// The initial state of a woven fabric at the scale of its fibres, found from flat, interpenetrating tows.
//   weave SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/example.hpp"
#include "../support/program.hpp"
#include "../support/report_page.hpp"
#include "../support/scene_solver.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/compositions/weave/fabric_limits.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

using namespace fibrant;

namespace {

/// @tparam Law, Section  of friction, and of the sections of the fibres
template <law::FrictionLaw Law, class Section = beam::Isotropic>
struct Weave {
    using Beam = beam::With<beam::DirectorBeam<>, Section>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = Law;
    using Solver = example::SceneSolver;
};

template <simulation::Model M>
bool settle(const weave::Scene& scene, const example::SceneReader& file, example::Output& output) {
    const double radius = weave::cloth::smallest_radius(scene.fabric);
    auto parameters = weave::cloth::model_parameters<M>(scene.fabric, scene.settle);
    parameters.iteration = scene.iteration;
    example::choose_solver(parameters, scene.linear_solver);
    const example::RankFolder own(output);
    const bool paraview = scene.paraview && own.shown(), pictures = scene.pictures && own.shown();
    const scene::Assembly assembly = weave::cloth::unsettled_fabric(scene.fabric, scene.settle);
    simulation::Simulator<M> simulator(assembly, parameters);

    output.open(file);
    const std::vector<std::string> doubts = weave::cloth::doubts(scene.fabric, scene.settle);
    for (const std::string& doubt : doubts) std::fprintf(stderr, "weave: %s\n", doubt.c_str());
    const std::filesystem::path& folder = output.folder;
    const observe::Start start = output.start();
    auto progress = example::progress_printer(radius, 0, output.quiet);
    weave::IncrementTable table(folder, radius, start);
    weave::Series series(folder / "paraview", start, paraview ? scene.paraview_every : 0);
    auto loading = weave::cloth::settling<M>(scene.fabric, scene.settle, weave::cloth::begins_waved(scene.fabric, scene.settle));
    output.tell(loading, 15.0);
    example::stop_together(loading);
    simulation::Report report = simulator.run(loading, progress, table, series);
    if (!report.converged)
        for (const std::string& doubt : doubts) report.reason += "; " + doubt;

    const observe::Snapshot snapshot = simulator.snapshot();
    const auto audit = weave::cloth::audit(snapshot, scene.fabric, proximity::GridSearch());
    const auto crimp = weave::cloth::crimp_measures(snapshot, scene.fabric);
    weave::Summary summary;
    const double deepest = radius * (std::isnan(output.deepest_over_radius) ? scene.settle.allowed_penetration_over_radius
                                                                            : output.deepest_over_radius);
    weave::fill(summary, report, audit, crimp, radius, deepest);
    example::tell(audit.swelling, deepest);
    summary.fibres = simulator.mesh().fibre_count();
    summary.dofs = simulator.mesh().layout().unknowns();
    summary.nodes = summary.dofs / M::Beam::dofs_per_node;
    summary.thickness = weave::cloth::thickness(snapshot, scene.fabric);
    summary.threads = core::threads();
    weave::write_measures(folder, snapshot, scene.fabric, crimp);
    if (pictures) weave::write_pictures(folder, snapshot, scene.fabric, scene.unit);
    summary.cpu_seconds = example::cpu_seconds();
    summary.peak_memory_bytes = example::peak_memory_bytes();
    example::write_report(
        output,
        {"weave",
         scene.unit,
         weave::write_summary(folder, summary),
         weave::cloth::fabric_palette(scene.fabric),
         {"converged", "audit_clean", "fibres", "crimp_warp", "crimp_weft", "thickness", "least_gap_over_radius",
          "greatest_penetration_over_radius", "wrong_crossings", "energy_error_over_work", "wall_seconds"}},
        snapshot);
    if (!output.quiet)
        weave::print(summary, folder.string());
    else if (!summary.converged)
        std::fprintf(stderr, "weave: not settled: %s\n", summary.reason.c_str());
    else if (!summary.clean)
        std::fprintf(stderr,
                     "weave: the audit is not clean: %td crossings against the pattern, %td missing, least gap %.4f radii\n",
                     summary.wrong_crossings, summary.missing_crossings, summary.least_gap_over_radius);
    if (!summary.converged && !example::stopped()) example::tell_remedy(summary.reason);
    return summary.converged && summary.clean;
}

bool solve_weave(example::SceneReader& file, example::Output& output) {
    const weave::Scene scene = weave::read_fabric(file, [] {});
    if (scene.own_laws()) return settle<Weave<law::ShapedFriction, material::Elastic>>(scene, file, output);
    return scene.settle.friction_coefficient > 0.0 ? settle<Weave<law::RegularisedCoulomb>>(scene, file, output)
                                                   : settle<Weave<law::Frictionless>>(scene, file, output);
}

}  // namespace

example::Program weave_program() {
    return {"weave", "Finds the initial state of a woven fabric from flat, interpenetrating tows.", solve_weave};
}

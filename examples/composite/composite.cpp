// SPDX-License-Identifier: MIT
// A woven fabric is settled, put between two layers of matrix, bonded to them, and bent, twisted, drawn or sheared.
//   composite SCENE.toml --output DIR [--set section.key=value]... [--threads N] [--resume | --overwrite] [--quiet]
#include "../support/program.hpp"
#include "../support/scene_solver.hpp"
#include "output.hpp"
#include "scene_file.hpp"

#include <fibrant/beam/with_law.hpp>
#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/law/shaped_friction.hpp>
#include <fibrant/material/elastic.hpp>
#include <fibrant/proximity/grid_search.hpp>
#ifdef FIBRANT_WITH_MPI
#include <fibrant/distributed/shared_fibres.hpp>
#else
#include <fibrant/solver/solid_pcg.hpp>
#endif

#include <filesystem>
#include <stdexcept>
#include <string>
#include <type_traits>

using namespace fibrant;
namespace cloth = compositions::weave;
namespace parts = compositions::composite;

namespace {

#ifdef FIBRANT_WITH_MPI
using BondedSolver = distributed::SharedSolidPcg<distributed::MpiExchange>;
void divide(BondedSolver::Parameters& parameters, const example::LinearSolver& how) {
    parameters.fibres.cut.parts = static_cast<int>(how.subdomains);
}
#else
using BondedSolver = solver::SolidPcg;
void divide(BondedSolver::Parameters&, const example::LinearSolver&) {}
#endif

/// @tparam Own  sections and friction obey laws of their own; else sections are isotropic and friction is Coulomb's
template <bool Own>
struct DryOf {
    using Beam = beam::With<beam::DirectorBeam<>, std::conditional_t<Own, material::Elastic, beam::Isotropic>>;
    using Proximity = proximity::GridSearch;
    using Normal = law::LimitedGap<law::RegularisedPenalty>;
    using Friction = std::conditional_t<Own, law::ShapedFriction, law::RegularisedCoulomb>;
    using Solver = example::SceneSolver;
};
template <bool Own>
struct CompositeOf : DryOf<Own> {
    using Solid = connection::BondedSolid<solid::Hexahedron<solid::EnhancedStrains, solid::NeoHookean>, connection::NeverDebonds>;
    using Connections = connection::RigidBodies;
    using Solver = BondedSolver;
};

/// File of the settled fabric.
std::string settled_of(const composite::Scene& scene, const example::Output& output) {
    return scene.settled.empty() ? (output.folder / "settled.bin").string() : scene.settled;
}

/// Settles the fabric, or takes it from where an earlier run left it.
template <simulation::Model Dry>
void settle(simulation::Simulator<Dry>& dry, const composite::Scene& scene, const example::Output& output) {
    auto loading =
        cloth::settling<Dry>(scene.weave.fabric, scene.weave.settle, cloth::begins_waved(scene.weave.fabric, scene.weave.settle));
    loading.checkpoint = settled_of(scene, output);
    loading.checkpoint_seconds = 1e9, loading.resume = output.resume || !scene.settled.empty();
    loading.scene = scene.weave.told, loading.other_scene = output.other_scene, loading.stop = example::stopped;
    example::stop_together(loading);
    loading.resume_before_end = scene.settled.empty();  // the account of energy goes on from contacts
    auto progress = example::progress_printer(cloth::smallest_radius(scene.weave.fabric), 0, output.quiet);
    const simulation::Report report = dry.run(loading, progress);
    if (!report.converged) throw std::runtime_error("the fabric did not settle: " + report.reason);
}

template <bool Own>
bool run(const composite::Scene& scene, const example::SceneReader& file, example::Output& output) {
    using Dry = DryOf<Own>;
    using Composite = CompositeOf<Own>;
    const cloth::FabricParameters& fabric = scene.weave.fabric;
    // The layers are made of the settled fabric: those of another scene go on from no other fabric than theirs.
    if (output.resume && output.other_scene && std::filesystem::exists(output.checkpoint()) &&
        !std::filesystem::exists(settled_of(scene, output)))
        throw std::invalid_argument("--other-scene: " + output.checkpoint() + " goes on from the settled fabric in " +
                                    settled_of(scene, output) + ", which is missing: --overwrite begins anew");
    const example::RankFolder own(output);
    output.open(file);
    const scene::Assembly flat = cloth::unsettled_fabric(fabric, scene.weave.settle);
    auto dry_parameters = cloth::model_parameters<Dry>(fabric, scene.weave.settle);
    dry_parameters.iteration = scene.weave.iteration;
    example::choose_solver(dry_parameters, scene.weave.linear_solver);
    simulation::Simulator<Dry> dry(flat, dry_parameters);
    settle(dry, scene, output);

    // The layers, and the edges that move.
    const solid::Layers layers = parts::layers_of(dry.snapshot(), fabric, scene.matrix);
    const parts::Composite composite = parts::composite_of(fabric, dry.state(), flat, layers, scene.matrix, scene.load);
    auto parameters = cloth::model_parameters<Composite>(fabric, scene.weave.settle);
    parameters.friction = law::friction_parameters<typename Composite::Friction>(
        scene.weave.settle.friction_coefficient, parameters.friction.reversible_displacement, scene.weave.settle.friction_shape);
    parameters.iteration = scene.weave.iteration, parameters.iteration.margin = 1.0,
    parameters.iteration.largest_margin = 8.0;  // edges swing far
    parameters.iteration.overshoot = scene.overshoot;
    parameters.solver.carried = scene.carried;
    divide(parameters.solver, scene.weave.linear_solver);
    parameters.solid.bonding_factor = scene.matrix.bonding_factor, parameters.solid.section_factor = scene.matrix.section_factor;
    simulation::Simulator<Composite> simulator(composite.assembly, parameters);
    simulator.go_on_from(dry);
    const auto& solid = simulator.equilibrium().solid();
    if (!output.quiet)
        std::printf("matrix: %td nodes, %td cells, %td bonds; grid columns %td, pores %td of %td, clipped %td\n", solid.nodes(),
                    solid.cells(), core::count(solid.bonds()), layers.columns, layers.filled, layers.met + layers.filled,
                    layers.clipped);

    composite::Watch watch(output);
    const auto point = [&](const simulation::Wrench& edge) {
        return composite::curve_point(scene.load, simulator.amplitude(parts::load_channel), edge);
    };
    example::Recorder recorder(output, cloth::smallest_radius(fabric), [&] {
        const simulation::Wrench edge = parts::edge_wrench(simulator, composite);
        return composite::columns(point(edge), edge);
    });
    auto loading = parts::loading_of<Composite>(fabric, scene.weave.settle, scene.load);
    output.tell(loading, 20.0);
    example::stop_together(loading);
    const simulation::Report report = simulator.run(loading, watch, recorder);
    const composite::CurvePoint end = point(parts::edge_wrench(simulator, composite));
    composite::write_curve(output, end);
    composite::write_pictures(output, simulator.snapshot(), fabric);
    const simulation::Audit audit = example::audit(output, simulator, cloth::smallest_radius(fabric));
    const observe::JsonObject summary =
        composite::write_summary(output, simulator, report, audit, end, cloth::smallest_radius(fabric));
    example::write_report(output, "composite", summary, simulator.snapshot());
    return report.converged && audit.clean();
}

bool solve(example::SceneReader& file, example::Output& output) {
    const composite::Scene scene = composite::read_scene(file);
    output.keep(file, "load", "settled", scene.settled);
    if constexpr (example::has_own_laws)
        if (scene.weave.own_laws()) return run<true>(scene, file, output);
    return run<false>(scene, file, output);
}

}  // namespace

example::Program composite_program() {
    return {"composite", "A woven fabric between two layers of matrix, bent, twisted, drawn or sheared.", solve};
}

// SPDX-License-Identifier: MIT
// What does one call of each part cost: an element of each beam, a law, a search, a contact element in each of its loops, a
// product with the tangent and its preconditioner? Google Benchmark; items are elements, contacts, segments or unknowns. usage:
// benchmark_micro_bench [--benchmark_filter=REGEX] [--benchmark_out=FILE.json] ... (its own options)
#include "../tests/support/fabric_system.hpp"
#include "chapter_fabric.hpp"
#include "search/scene_file.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/smooth_coulomb.hpp>
#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/kd_tree_search.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <benchmark/benchmark.h>

#include <cmath>
#include <vector>

using namespace fibrant;

namespace {

void count_items(benchmark::State& state, Index items) { state.SetItemsProcessed(state.iterations() * items); }

// ---- beams: a fibre of 256 elements, bent and stretched a little ----

template <beam::BeamElement B>
struct BentFibre {
    static constexpr Index elements = 256;
    B beam;
    beam::Mesh<B> mesh{assembly(), beam};
    Vector state = mesh.start_state();

    BentFibre() {
        for (Index k = 0; k < state.size(); ++k) state[k] += 1e-4 * std::sin(0.7 * static_cast<double>(k));
    }
    static scene::Assembly assembly() {
        scene::Assembly assembly;
        assembly.add({.from = {0, 0, 0},
                      .to = {25.6, 0, 0},
                      .section = scene::circular(0.0201),
                      .material = {7300.0, 0.3},
                      .elements = elements});
        return assembly;
    }
};

template <beam::BeamElement B>
void beam_energy(benchmark::State& state) {
    const BentFibre<B> fibre;
    for (auto _ : state) {
        double sum = 0.0;
        for (Index e = 0; e < fibre.elements; ++e)
            sum += fibre.beam.energy(fibre.mesh.rest(0, e), fibre.mesh.element(fibre.state, 0, e));
        benchmark::DoNotOptimize(sum);
    }
    count_items(state, fibre.elements);
}
template <beam::BeamElement B>
void beam_force(benchmark::State& state) {
    const BentFibre<B> fibre;
    for (auto _ : state)
        for (Index e = 0; e < fibre.elements; ++e)
            benchmark::DoNotOptimize(fibre.beam.internal_force(fibre.mesh.rest(0, e), fibre.mesh.element(fibre.state, 0, e)));
    count_items(state, fibre.elements);
}
template <beam::BeamElement B>
void beam_force_and_tangent(benchmark::State& state) {
    const BentFibre<B> fibre;
    std::vector<typename B::Stresses> stresses;
    for (Index e = 0; e < fibre.elements; ++e)
        stresses.push_back(fibre.beam.stresses(fibre.mesh.rest(0, e), fibre.mesh.element(fibre.state, 0, e)));
    beam::ElementVector<B> force;
    beam::ElementMatrix<B> tangent;
    for (auto _ : state)
        for (Index e = 0; e < fibre.elements; ++e) {
            fibre.beam.residual_and_tangent(fibre.mesh.rest(0, e), fibre.mesh.element(fibre.state, 0, e), stresses[core::at(e)],
                                            force, tangent);
            benchmark::DoNotOptimize(force);
            benchmark::DoNotOptimize(tangent);
        }
    count_items(state, fibre.elements);
}
#define FIBRANT_BENCHMARK_BEAM(...)      \
    BENCHMARK(beam_energy<__VA_ARGS__>); \
    BENCHMARK(beam_force<__VA_ARGS__>);  \
    BENCHMARK(beam_force_and_tangent<__VA_ARGS__>)
FIBRANT_BENCHMARK_BEAM(beam::DirectorBeam<3>);
FIBRANT_BENCHMARK_BEAM(beam::DirectorBeam<2>);
FIBRANT_BENCHMARK_BEAM(beam::RigidSectionRod);
FIBRANT_BENCHMARK_BEAM(beam::KirchhoffCable);

// ---- laws: 1,024 contacts, open and closed, sticking and sliding ----

constexpr Index contacts = 1024;

template <law::NormalLaw Law>
void normal_law(benchmark::State& state, const Law& law) {
    std::vector<double> gaps;
    for (Index k = 0; k < contacts; ++k) gaps.push_back(2e-4 * std::sin(0.37 * static_cast<double>(k)));
    for (auto _ : state)
        for (const double gap : gaps) benchmark::DoNotOptimize(law.response(gap, 50.0));
    count_items(state, contacts);
}
BENCHMARK_CAPTURE(normal_law, RegularisedPenalty, law::RegularisedPenalty({.regularisation_depth = 1e-4}));
BENCHMARK_CAPTURE(normal_law, LinearPenalty, law::LinearPenalty());
BENCHMARK_CAPTURE(normal_law, LimitedGap,
                  law::LimitedGap<law::RegularisedPenalty>({.law = {.regularisation_depth = 1e-4}, .limit = 5e-3}));

template <law::FrictionLaw Law>
void friction_law(benchmark::State& state, const Law& law) {
    std::vector<Vec3> slips;
    for (Index k = 0; k < contacts; ++k)
        slips.emplace_back(1e-3 * std::sin(0.37 * static_cast<double>(k)), 1e-3 * std::cos(0.21 * static_cast<double>(k)), 0.0);
    const typename Law::History history{};
    for (auto _ : state)
        for (const Vec3& slip : slips) benchmark::DoNotOptimize(law.response(slip, 0.01, history));
    count_items(state, contacts);
}
BENCHMARK_CAPTURE(friction_law, RegularisedCoulomb,
                  law::RegularisedCoulomb({.friction_coefficient = 0.15, .reversible_displacement = 4e-4}));
BENCHMARK_CAPTURE(friction_law, SmoothCoulomb,
                  law::SmoothCoulomb({.friction_coefficient = 0.15, .reversible_displacement = 4e-4}));
BENCHMARK_CAPTURE(friction_law, Frictionless, law::Frictionless());

// ---- searches: random mats ----

template <class Search>
void search(benchmark::State& state) {
    const benchmarks::Scene scene = benchmarks::random_mat(static_cast<std::size_t>(state.range(0)));
    const auto lines = scene.centrelines(false);
    Search search;
    for (auto _ : state) benchmark::DoNotOptimize(search.pairs(lines, scene.margin));
    count_items(state, static_cast<Index>(scene.segments()));
    state.SetComplexityN(state.range(0));
}
BENCHMARK(search<proximity::GridSearch>)
    ->RangeMultiplier(4)
    ->Range(1 << 12, 1 << 18)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oN);
BENCHMARK(search<proximity::BvhSearch>)
    ->RangeMultiplier(4)
    ->Range(1 << 12, 1 << 18)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);
BENCHMARK(search<proximity::KdTreeSearch>)
    ->RangeMultiplier(4)
    ->Range(1 << 12, 1 << 18)
    ->Unit(benchmark::kMillisecond)
    ->Complexity(benchmark::oNLogN);

// ---- contact elements and the tangent: a weave of 76 fibres whose tows are parting ----

using Weave = benchmarks::SettledWeave<solver::TwoLevelPcg>;

struct PartingTows {
    using Simulator = simulation::Simulator<Weave>;
    compositions::weave::FabricParameters fabric = benchmarks::chapter_fabric("plain", 2, 19);
    compositions::weave::SettleParameters settle;
    scene::Assembly assembly = compositions::weave::flat_fabric(fabric, settle.tension_strain);
    Simulator simulator{assembly, compositions::weave::model_parameters<Weave>(fabric, settle)};
    Simulator::Contacts contacts = run();
    connection::Channels channels{assembly};
    Simulator::Equilibrium equilibrium{assembly, simulator.mesh(), simulator.beam(), contacts, channels};

    const Simulator::Contacts& run() {
        simulation::Loading<Weave> loading = compositions::weave::settling<Weave>(fabric, settle);
        loading.stages.resize(2);
        loading.stages[1].until = [](const simulation::IncrementReport& increment) { return increment.number >= 8; };
        simulator.run(loading);
        return simulator.contacts();
    }
    Index elements() const { return core::count(contacts.elements()); }

    PartingTows() {
        const std::vector<double> amplitudes(channels.names().size(), 1.0);
        contacts.regenerate(simulator.state(), simulator.state());
        contacts.evaluate(simulator.state());
        contacts.hold_reactions();
        equilibrium.begin(amplitudes, simulator.state());
    }
};
PartingTows& parting_tows() {
    static PartingTows tows;
    return tows;
}

void contact_generate(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    for (auto _ : state) tows.contacts.regenerate(tows.simulator.state(), tows.simulator.state());
    count_items(state, tows.elements());
}
void contact_turn(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    for (auto _ : state) benchmark::DoNotOptimize(tows.contacts.refresh(tows.simulator.state(), tows.simulator.state()));
    count_items(state, tows.elements());
}
void contact_evaluate(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    for (auto _ : state) tows.contacts.evaluate(tows.simulator.state());
    count_items(state, tows.elements());
}
void contact_forces(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    Vector residual = Vector::Zero(tows.simulator.state().size());
    for (auto _ : state) tows.contacts.add_forces(residual);
    count_items(state, tows.elements());
}
void equilibrium_residual(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    Vector residual;
    for (auto _ : state) benchmark::DoNotOptimize(tows.equilibrium.residual(tows.simulator.state(), residual));
    count_items(state, tows.simulator.state().size());
}
void equilibrium_tangent(benchmark::State& state) {
    PartingTows& tows = parting_tows();
    for (auto _ : state) tows.equilibrium.linearise(tows.simulator.state(), false, 0.0);
    count_items(state, tows.simulator.state().size());
}
BENCHMARK(contact_generate)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_turn)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_evaluate)->Unit(benchmark::kMillisecond);
BENCHMARK(contact_forces)->Unit(benchmark::kMillisecond);
BENCHMARK(equilibrium_residual)->Unit(benchmark::kMillisecond);
BENCHMARK(equilibrium_tangent)->Unit(benchmark::kMillisecond);

// ---- linear systems: the synthetic weave of so many fibres ----

struct SyntheticSystem {
    assembly::ChainSystem<beam::DirectorBeam<>> system;
    Vector b = test::contact_load(system), x = Vector::Zero(b.size());
    explicit SyntheticSystem(Index fibres)
        : system{test::chain_system(test::FabricSystem(test::Fabric{.bundles = 2, .fibres = static_cast<int>(fibres / 4)}))} {}
};

void tangent_product(benchmark::State& state) {
    SyntheticSystem all(state.range(0));
    for (auto _ : state) {
        all.system.apply(all.b, all.x);
        benchmark::DoNotOptimize(all.x.data());
    }
    count_items(state, all.b.size());
}
void two_level_prepare(benchmark::State& state) {
    SyntheticSystem all(state.range(0));
    solver::TwoLevelPcg solver;
    solver.analyse(all.system);
    for (auto _ : state) benchmark::DoNotOptimize(solver.prepare(all.system));
    count_items(state, all.b.size());
}
void two_level_apply(benchmark::State& state) {
    SyntheticSystem all(state.range(0));
    solver::TwoLevelPcg solver;
    solver.analyse(all.system);
    solver.prepare(all.system);
    for (auto _ : state) {
        solver.precondition(all.system, all.b, all.x);
        benchmark::DoNotOptimize(all.x.data());
    }
    count_items(state, all.b.size());
}
BENCHMARK(tangent_product)->Arg(76)->Arg(304)->Unit(benchmark::kMillisecond);
BENCHMARK(two_level_prepare)->Arg(76)->Arg(304)->Unit(benchmark::kMillisecond);
BENCHMARK(two_level_apply)->Arg(76)->Arg(304)->Unit(benchmark::kMillisecond);

}  // namespace

BENCHMARK_MAIN();

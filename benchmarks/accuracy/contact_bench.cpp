// SPDX-License-Identifier: MIT
// Which element and which normal law reach a given error in a contact force soonest? Two scenes with a known answer: two fibres
// clamped at both ends that cross and are pressed together by two radii, and a strand of a core and six wires that is stretched.
// Each is run at smaller and smaller penetrations, with a penalty alone and with multipliers; the crossing also on finer and
// finer meshes, with multipliers. Prints CSV, a line a run, and writes log-log plots. usage: benchmark_accuracy_contact_bench
// [directory of the plots [repeats]]; default . and 3
#include "sweep.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <type_traits>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

/// 200 radii long, stretched by 0.002, the clamps two radii closer than where the fibres would touch (crossed_fibres.json).
template <simulation::Model M>
Sample crossing(double penetration, Index elements) {
    const double length = 4.02, approach = 2.0 * r;
    const double reference = std::is_same_v<typename M::Beam, beam::DirectorBeam<3>> ? 0.000488522645452 : 0.000487029211873;
    scene::Assembly assembly;
    for (const bool upper : {false, true}) {
        const Vec3 along = upper ? Vec3::UnitY() : Vec3::UnitX(), centre = upper ? Vec3(0, 0, 2.0 * r) : Vec3(Vec3::Zero());
        scene::FibreSpecification fibre = along_z(1.0, elements);
        fibre.from = centre - 0.5 * length * along, fibre.to = centre + 0.5 * length * along, fibre.director = Vec3::UnitZ();
        const Index f = assembly.add(fibre);
        for (const double end : {0.0, 1.0}) {
            scene::Hold axial;
            axial.at = {f, end}, axial.directions = along * along.transpose(), axial.channel = "stretch";
            axial.displacement = (end - 0.5) * 0.002 * length * along;
            assembly.hold(axial);
            axial.directions = Mat3::Identity() - axial.directions, axial.channel = "motion";
            axial.displacement = upper ? Vec3(0, 0, -approach) : Vec3(Vec3::Zero());
            assembly.hold(axial);
            assembly.hold_rotation({f, end});
        }
    }
    Sample sample;
    const double start = processor_time();
    simulation::Simulator<M> simulator(assembly, allowing<M>(penetration));
    simulation::Loading<M> loading;
    for (const char* channel : {"stretch", "motion"}) {
        simulation::Stage<M> stage;
        stage.ramps = {{channel, 1.0}}, stage.increments = 2;
        loading.stages.push_back(stage);
    }
    sample.report = simulator.run(loading);
    sample.seconds = processor_time() - start;
    sample.error = std::abs((simulator.reaction({0, 0.0}) + simulator.reaction({0, 1.0})).z() / reference - 1.0);
    return sample;
}

using Director = beam::DirectorBeam<3>;
using Rod = beam::RigidSectionRod;
using Cable = beam::KirchhoffCable;

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path directory = folder(argc > 1 ? argv[1] : ".");
    const int repeats = argc > 2 ? std::max(1, std::atoi(argv[2])) : 3;
    print_sweep_header();  // value: allowed penetration over the radius, or elements
    observe::LogLogPlot crossed, meshes, wires;
    crossed.title = "crossed fibres, less and less penetration",
    meshes.title = "crossed fibres, multipliers, finer and finer meshes", wires.title = "strand 1 + 6";
    const std::array penetrations{1e-1, 1e-2, 1e-3, 1e-4, 1e-5};
    const std::array<Index, 5> numbers{8, 16, 32, 64, 128};
    const auto cross = [&]<simulation::Model M>(const char* policy, Index elements) {
        sweep(
            "crossing", policy, penetrations, [&](double p) { return crossing<M>(p * r, elements); }, repeats, crossed);
    };
    const auto refine = [&]<simulation::Model M>(const char* policy) {
        sweep(
            "meshes", policy, numbers, [&](Index elements) { return crossing<M>(1e-5 * r, elements); }, repeats, meshes);
    };
    const auto stretch = [&]<simulation::Model M>(const char* policy) {
        sweep(
            "strand", policy, penetrations, [&](double p) { return stretched_strand<M>(p * r, 24); }, repeats, wires);
    };
    cross.operator()<Policy<Director>>("director, penalty", 32);
    cross.operator()<Held<Director>>("director, multipliers", 32);
    cross.operator()<Policy<Rod>>("rod, penalty", 64);
    cross.operator()<Held<Rod>>("rod, multipliers", 64);
    cross.operator()<Policy<Cable>>("cable, penalty", 64);
    cross.operator()<Held<Cable>>("cable, multipliers", 64);
    refine.operator()<Held<Director>>("director");
    refine.operator()<Held<Rod>>("rod");
    refine.operator()<Held<Cable>>("cable");
    stretch.operator()<Policy<Director>>("director, penalty");
    stretch.operator()<Held<Director>>("director, multipliers");
    for (observe::LogLogPlot* plot : {&crossed, &meshes, &wires}) plot->y_label = "error of the force";
    observe::write_file(directory / "accuracy_crossing.svg", observe::log_log_svg(crossed));
    observe::write_file(directory / "accuracy_crossing_meshes.svg", observe::log_log_svg(meshes));
    observe::write_file(directory / "accuracy_strand.svg", observe::log_log_svg(wires));
    return 0;
}

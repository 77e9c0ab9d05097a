// SPDX-License-Identifier: MIT
// How fast does the error of a scene in contact fall as it is refined, and which policy reaches a given error soonest? A fibre
// drawn half a turn around a cylinder with friction (finer and finer points) and one drawn to and fro between two others (smaller
// and smaller reversible displacements), both with two laws of friction, a strand of a core and six wires and two rods wound
// around each other (finer and finer meshes), and an overhand knot (meshes, and thinner rods). Prints CSV, a line a run and one
// with the orders of each policy, and writes log-log plots of error against CPU time. usage:
// benchmark_accuracy_contact_scenes_bench [directory of the plots [repeats [scene]]]; default ., 1 and all of capstan,
// stick_slip, strand, two_ply, knot
#include "drawn_fibres.hpp"
#include "sweep.hpp"

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/compositions/knot/overhand_knot.hpp>
#include <fibrant/compositions/two_ply/two_ply.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

using namespace fibrant;
using namespace fibrant::benchmarks;
namespace two_ply = compositions::two_ply;
namespace knot = compositions::knot;

namespace {

const double pi = std::numbers::pi;

using Director = beam::DirectorBeam<3>;
using Rod = beam::RigidSectionRod;

/// 100 radii long, pulled by 0.02 N, turned by one and a quarter turns: torque of Kirchhoff's helices of the angle, radius and
/// twist in the middle (two_ply.json).
template <simulation::Model M>
Sample wound(Index elements) {
    const two_ply::TwoPlyParameters parameters{
        .radius = r, .length = 2.0, .material = {young, 0.3}, .elements = elements, .force = 0.02};
    simulation::ModelParameters<M> all = sinking_by<M>(law::Augmenting<typename M::Normal> ? 1e-4 * r : 1e-3 * r);
    all.iteration.contact_tolerance = 1e-3;
    Sample sample;
    const double start = processor_time();
    simulation::Simulator<M> simulator(two_ply::straight_rods(parameters), all);
    sample.report = simulator.run(stage<M>({{two_ply::pull, 1.0}}, 2));
    if (sample.report.converged) sample.report = simulator.run(stage<M>({{two_ply::turn, 1.25}}, 15));
    sample.seconds = processor_time() - start;
    const two_ply::TwoPlyState state = two_ply::measure(simulator, parameters);
    sample.error =
        std::abs(state.torque / two_ply::HelixTheory(parameters, state.helix_angle, state.radius, state.twist).torque - 1.0);
    return sample;
}

enum class Of { pull, balance };
/// Tied and let go: its pull against F R^2 / E I = 1/2 + (3 sigma / pi) (r / R)^1/2, or what F e = W + 2 r P misses, which holds
/// at any r / R.
Sample settled_knot(double slenderness, Index elements, Of of) {
    using M = Policy<Director>;
    const knot::KnotParameters parameters{.radius = r,
                                          .loop_radius = r / slenderness,
                                          .tail = 3.0 * r / slenderness,
                                          .material = {young, 0.3},
                                          .elements = elements};
    simulation::ModelParameters<M> all;
    all.normal = {.regularisation_depth = 1e-3 * r};
    all.contact.stiffness.allowed_penetration = 1e-2 * r;
    all.contact.stiffness.initial_fraction = knot::initial_stiffness_fraction(parameters),
    all.contact.stiffness.floor_fraction = 1e-6;
    all.contact.detection.self_contact = true;
    all.iteration.newton_limit = 30;
    simulation::Loading<M> loading = stage<M>({}, 2);
    simulation::Stage<M>& settle = loading.stages[0];
    settle.damping = 10.0 * bending / std::pow(parameters.loop_radius, 3) / static_cast<double>(elements);
    settle.damping_decay = 0.5, settle.damping_share = 1e-4;
    settle.until = simulation::until_settled(0.05 * r, 0.02 * r);
    settle.most_increments = 80;
    Sample sample;
    const double start = processor_time();
    simulation::Simulator<M> simulator(knot::tied_rod(parameters), all);
    sample.report = simulator.run(loading);
    sample.seconds = processor_time() - start;
    const knot::KnotState state = knot::measure(simulator, parameters);
    const double R = state.shortening / (2.0 * pi);
    sample.error = std::abs(of == Of::balance ? state.virial : state.force * R * R / bending / knot::loose_force(3, r / R) - 1.0);
    return sample;
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path directory = folder(argc > 1 ? argv[1] : ".");
    const int repeats = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1;
    const std::string only = argc > 3 ? argv[3] : "";
    print_sweep_header();  // value: points a half turn; reversible displacement over the radius; elements a wire, a rod;
                           // elements, R / r
    const auto wanted = [&](const char* scene) { return only.empty() || only == scene; };
    const auto write = [&](observe::LogLogPlot& plot, const char* title, const char* error, const char* file) {
        plot.title = title, plot.y_label = error;
        observe::write_file(directory / file, observe::log_log_svg(plot));
    };
    if (wanted("capstan")) {
        observe::LogLogPlot plot;
        const std::array<Index, 4> points{18, 36, 72, 144};
        sweep(
            "capstan", "director", points, [](Index n) { return capstan<Drawn<Director>>(n); }, repeats, plot);
        sweep(
            "capstan", "rod", points, [](Index n) { return capstan<Drawn<Rod>>(n); }, repeats, plot);
        sweep(
            "capstan", "director, smooth law", points, [](Index n) { return capstan<Drawn<Director, law::SmoothCoulomb>>(n); },
            repeats, plot);
        sweep(
            "capstan", "rod, smooth law", points, [](Index n) { return capstan<Drawn<Rod, law::SmoothCoulomb>>(n); }, repeats,
            plot);
        write(plot, "drawn half a turn around a cylinder, mu = 0.15", "error of the tension ratio", "accuracy_capstan.svg");
    }
    if (wanted("stick_slip")) {
        observe::LogLogPlot plot;
        const std::array ranges{0.1, 0.05, 0.02, 0.01, 0.005, 0.002};
        const auto refine = [&]<simulation::Model M>(const char* policy, Index increments) {
            sweep(
                "stick_slip", policy, ranges, [&](double range) { return drawn_to_and_fro<M>(range * r, increments); }, repeats,
                plot);
        };
        refine.operator()<Policy<Director, law::RegularisedCoulomb>>("regularised, 8", 8);
        refine.operator()<Policy<Director, law::SmoothCoulomb>>("smooth, 8", 8);
        refine.operator()<Policy<Director, law::RegularisedCoulomb>>("regularised, 32", 32);
        refine.operator()<Policy<Director, law::SmoothCoulomb>>("smooth, 32", 32);
        write(plot, "drawn to and fro between two fibres, in 8 and in 32 steps", "error of a loop's work",
              "accuracy_stick_slip.svg");
    }
    if (wanted("strand")) {
        observe::LogLogPlot plot;
        const std::array<Index, 4> coarse{6, 12, 24, 48}, fine{12, 24, 48, 96};
        sweep(
            "strand", "director", coarse, [](Index elements) { return stretched_strand<Held<Director>>(1e-5 * r, elements); },
            repeats, plot);
        sweep(
            "strand", "director, 2 nodes", fine,
            [](Index elements) { return stretched_strand<Held<beam::DirectorBeam<2>>>(1e-5 * r, elements); }, repeats, plot);
        write(plot, "strand 1 + 6, multipliers, finer and finer meshes", "error of the force", "accuracy_strand_meshes.svg");
    }
    if (wanted("two_ply")) {
        observe::LogLogPlot plot;
        const std::array<Index, 4> coarse{20, 40, 80, 160}, fine{40, 80, 160, 320};
        sweep("two_ply", "director, multipliers", coarse, wound<Held<Director>>, repeats, plot);
        sweep("two_ply", "director, penalty", coarse, wound<Policy<Director>>, repeats, plot);
        sweep("two_ply", "2 nodes, multipliers", fine, wound<Held<beam::DirectorBeam<2>>>, repeats, plot);
        write(plot, "two rods wound around each other", "error of the torque", "accuracy_two_ply.svg");
    }
    if (wanted("knot")) {
        observe::LogLogPlot plot;
        sweep(
            "knot", "balance, meshes", std::array<Index, 4>{80, 120, 240, 480},
            [](Index elements) { return settled_knot(0.01, elements, Of::balance); }, repeats, plot);
        sweep(
            "knot", "pull, thinner rods", std::array{50.0, 100.0, 200.0, 400.0},
            [](double R) { return settled_knot(1.0 / R, static_cast<Index>(24.0 * std::sqrt(R)), Of::pull); }, repeats, plot);
        write(plot, "overhand knot", "error", "accuracy_knot.svg");
    }
    return 0;
}

// SPDX-License-Identifier: MIT
// What does a result depend on that it should not? Scenes with a known answer, one number of which goes over decades: the
// slenderness of crossed fibres, how much stiffer one is than the other, the penetration that is allowed, a penalty that stays as
// it is (alone and with multipliers, crossed fibres and a strand), and the number of load steps. Prints CSV, a line a run, and
// writes log-log plots of the error. usage: benchmark_accuracy_sweeps_bench [directory of the plots [sweep]]; default . and all
// of slenderness, stiffness, penetration, penalty, increments
#include "../../tests/stability/sweeps.hpp"
#include "drawn_fibres.hpp"
#include "sweep.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

using Director = beam::DirectorBeam<3>;
using Line = std::vector<std::pair<double, double>>;

/// Prints a line of CSV. @returns the point of a plot; nowhere if the run stopped, whose reason is printed
std::pair<double, double> show(const char* scene, const char* policy, double value, double error, double seconds,
                               const simulation::Report& report) {
    std::printf("%s,%s,%g,%.3e,%.3e,%ld,%ld,%ld,%.2e,%d%s%s\n", scene, policy, value, error, seconds,
                static_cast<long>(report.counts.newton), static_cast<long>(report.counts.contact_passes),
                static_cast<long>(report.rejected_increments), report.contact.greatest_penetration / r, report.converged ? 1 : 0,
                report.converged ? "" : ",", report.reason.c_str());
    std::fflush(stdout);
    return report.converged ? std::pair(value, std::abs(error)) : std::pair(0.0, 0.0);
}
/// Runs a small scene for each value.
/// @param scene  scene(value)
/// @param error  error(scene, result)
template <simulation::Model M = test::StableModel, class Values, class Scene, class Error>
Line small(const char* name, const char* policy, const Values& values, const Scene& scene, const Error& error) {
    Line line;
    for (const double value : values) {
        const test::SmallScene one = scene(value);
        const double start = processor_time();
        const test::SmallResult result = test::run<M>(one);
        const double seconds = processor_time() - start;
        line.push_back(show(name, policy, value, error(one, result), seconds, result.report));
    }
    return line;
}

/// The strand of the other benchmarks, at a penalty that stays as it is.
/// @param softest  multipliers take ever more passes the softer it is
template <simulation::Model M>
Line strand_at_penalties(const char* policy, double softest) {
    Line line;
    for (const double penalty : test::penalties) {
        if (penalty < softest) continue;
        const Sample sample = stretched_strand<M>(1e-5 * r, 24, penalty);
        line.push_back(show("strand", policy, penalty, sample.error, sample.seconds, sample.report));
    }
    return line;
}

/// A slender cantilever bent in so many steps, against the reference of its own model (end_force.json, director).
Line bent_in_steps(const std::vector<Index>& numbers) {
    using M = Policy<Director>;
    Line line;
    for (const Index increments : numbers) {
        const double start = processor_time();
        simulation::Simulator<M> simulator(cantilever(1000.0, 16), parameters<M>());
        const simulation::Report report = simulator.run({.increments = increments});
        const double seconds = processor_time() - start;
        const double error =
            (simulator.value(scene::last_end(0)) - Vec3(14.347255281111, 0, 12.308643485742)).norm() / (1000.0 * r);
        line.push_back(show("cantilever", "director", static_cast<double>(increments), error, seconds, report));
    }
    return line;
}

/// Three fibres, one dragged across the others with friction: force and dissipation, against 256 increments.
void dragged_in_steps(const std::vector<Index>& numbers, std::vector<observe::PlotLine>& lines) {
    const auto dragged = [](Index increments) {
        test::SmallScene scene = test::dragged_three();
        scene.increments = increments, scene.tight = true;
        for (test::SmallFibre& fibre : scene.fibres) fibre.elements = 16;
        return scene;
    };
    const test::SmallResult finest = test::run(dragged(256));
    Line force, lost;
    for (const Index increments : numbers) {
        const double start = processor_time(), value = static_cast<double>(increments);
        const test::SmallResult result = test::run(dragged(increments));
        const double seconds = processor_time() - start;
        force.push_back(show("dragged", "force", value, (result.support[1] - finest.support[1]).norm() / finest.support[1].norm(),
                             seconds, result.report));
        lost.push_back(show("dragged", "dissipated", value,
                            result.report.energy.dissipated / finest.report.energy.dissipated - 1.0, seconds, result.report));
    }
    std::printf("dragged,order of force and dissipation,%.2f,%.2f\n", observe::fitted_order(force), observe::fitted_order(lost));
    lines.push_back({"dragged: force", force}), lines.push_back({"dragged: dissipation", lost});
}

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path directory = folder(argc > 1 ? argv[1] : ".");
    const std::string only = argc > 2 ? argv[2] : "";
    std::printf("scene,policy,value,error,seconds,newton,contact passes,rejected,penetration over radius,converged,reason\n");
    const auto write = [&](std::vector<observe::PlotLine> lines, const char* title, const char* value, const char* error,
                           const char* file) {
        observe::LogLogPlot plot;
        plot.title = title, plot.x_label = value, plot.y_label = error, plot.lines = std::move(lines);
        observe::write_file(directory / file, observe::log_log_svg(plot));
    };
    const auto wanted = [&](const char* sweep) { return only.empty() || only == sweep; };
    const auto theory = [](const test::SmallScene& scene, const test::SmallResult& result) {
        return test::force_over_theory(scene, result) - 1.0;
    };
    const auto hard = [](const test::SmallScene& scene, const test::SmallResult& result) {
        return result.support[0].z() / test::theory_force(scene, test::small_approach) - 1.0;
    };
    if (wanted("slenderness")) {
        const Line line = small(
            "slenderness", "director", test::slendernesses, [](double value) { return test::pressed(value); }, theory);
        write({{"director", line}}, "two crossed fibres, pressed", "length over radius", "error of the force",
              "stability_slenderness.svg");
    }
    if (wanted("stiffness")) {
        const Line line = small(
            "stiffness", "director", test::stiffness_ratios, [](double value) { return test::pressed(200.0, value); }, theory);
        write({{"director", line}}, "one of two crossed fibres is stiffer", "modulus of one over the other's",
              "error of the force", "stability_stiffness.svg");
    }
    if (wanted("penetration")) {
        // Pressed by a whole radius, where tension counts and theory is of no use: against the least penetration with
        // multipliers.
        const double exact = test::run<test::Multiplied>(test::sinking(1e-6)).support[0].z();
        const auto error = [exact](const test::SmallScene&, const test::SmallResult& result) {
            return result.support[0].z() / exact - 1.0;
        };
        const Line alone = small("penetration", "penalty", test::allowed_penetrations, test::sinking, error);
        const auto at_once = [](double allowed) {  // at rest multipliers would go on to rounding
            test::SmallScene scene = test::sinking(allowed);
            scene.cycle = {1.0};
            return scene;
        };
        const Line held = small<test::Multiplied>("penetration", "multipliers", test::allowed_penetrations, at_once, error);
        write({{"penalty", alone}, {"multipliers", held}}, "two crossed fibres, pressed by a radius",
              "allowed penetration over the radius", "error of the force", "stability_penetration.svg");
    }
    if (wanted("penalty")) {
        const Line alone = small("penalty", "penalty", test::penalties, test::held_at, hard),
                   held = small<test::Multiplied>("penalty", "multipliers", test::penalties, test::held_at, hard);
        const Line strand_alone = strand_at_penalties<Policy<Director>>("penalty", 0.0),
                   strand_held = strand_at_penalties<benchmarks::Held<Director>>("multipliers", 1e-2);
        write({{"crossed, penalty", alone},
               {"crossed, multipliers", held},
               {"strand, penalty", strand_alone},
               {"strand, multipliers", strand_held}},
              "a penalty that stays as it is", "penalty over the stiffness of a section", "error of the force",
              "stability_penalty.svg");
    }
    if (wanted("increments")) {
        const std::vector<Index> numbers{1, 2, 4, 8, 16, 32, 64};
        std::vector<observe::PlotLine> lines{{"cantilever: tip", bent_in_steps(numbers)}};
        Line drawn;
        for (const Index increments : numbers) {
            const Sample sample = capstan<Drawn<Director>>(72, increments);
            drawn.push_back(
                show("capstan", "director", static_cast<double>(increments), sample.error, sample.seconds, sample.report));
        }
        lines.push_back({"capstan: ratio", drawn});
        dragged_in_steps(numbers, lines);
        write(std::move(lines), "the same way in more load steps", "load steps", "error", "stability_increments.svg");
    }
    return 0;
}

// SPDX-License-Identifier: MIT
// Which beam element reaches a given error soonest? Prints CSV, a line a mesh: the error in the figure that the reference gives,
// CPU time of the whole run and unknowns; then the fitted orders, and what each element costs in one and the same scene of
// touching fibres. Writes a log-log plot of each case. usage: benchmark_accuracy_elements_bench [directory of the plots [repeats
// [cost]]]; default . and 5; `cost` leaves meshes and plots out, the name of a policy all others too, so that its instructions
// can be counted (valgrind --tool=callgrind)
#include "rods.hpp"

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/on_centreline.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/smooth_coulomb.hpp>
#include <fibrant/observe/svg_plot.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;

namespace {

/// A problem of one rod: the scene, the figures that are compared, and their size.
struct Problem {
    std::string name;
    scene::Assembly (*assembly)(Index elements);
    std::vector<std::vector<simulation::Ramp>> stages;
    bool (*reaction)();                     ///< compare the force at mid-span, not the place of the tip
    double size;                            ///< errors are divided by [length or force]
    std::map<std::string, Vec3> reference;  ///< by model
};

template <int Slenderness>
scene::Assembly cantilever_of(Index elements) {
    return cantilever(Slenderness, elements);
}
template <int Slenderness, int Thousandths>
scene::Assembly stretched(Index elements) {
    const double length = Slenderness * r;
    scene::Assembly assembly;
    assembly.add(along_z(length, elements));
    assembly.clamp(scene::first_end(0));
    assembly.clamp(scene::last_end(0), Vec3(0, 0, 1e-3 * Thousandths * length), Vec3::Zero(), Vec3::Zero(), "stretch");
    scene::Hold push;
    push.at = {0, 0.5}, push.directions = Vec3(1, 0, 0).asDiagonal(), push.displacement = Vec3(2.0 * r, 0, 0),
    push.channel = "push";
    assembly.hold(push);
    return assembly;
}
scene::Assembly arc(Index elements) {
    const double quarter = 0.25 * std::numbers::pi;
    scene::FibreSpecification fibre;
    fibre.curve = [=](double t) { return Vec3(100.0 * std::sin(t * quarter), 100.0 * (1.0 - std::cos(t * quarter)), 0.0); };
    fibre.section = scene::circular(0.1 / std::sqrt(std::numbers::pi));
    fibre.section.inertia_factor = std::numbers::pi / 3.0;
    fibre.material = {1e7, 0.0}, fibre.elements = elements, fibre.director = Vec3::UnitY();
    scene::Assembly assembly;
    assembly.add(fibre);
    assembly.clamp(scene::first_end(0));
    assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(0, 0, 0.06), "load"});
    return assembly;
}
bool yes() { return true; }
bool no() { return false; }

std::vector<Problem> problems() {
    return {
        {"cantilever_1000",
         cantilever_of<1000>,
         {{{"load", 1.0}}},
         no,
         20.1,
         {{"kirchhoff", {14.347209624599, 0, 12.308669949439}},
          {"reissner", {14.347246478717, 0, 12.308662682769}},
          {"director", {14.347255281111, 0, 12.308643485742}}}},
        {"arc45_slender",
         arc,
         {{{"load", 1.0}}},
         no,
         100.0,
         {{"reissner", {47.151285842085, 15.685075385944, 53.468661045426}},
          {"director", {47.151285842085, 15.685075385944, 53.468661045426}}}},
        {"stretched_100_w2",
         stretched<100, 0>,
         {{{"stretch", 1.0}}, {{"push", 1.0}}},
         yes,
         0.0017,
         {{"reissner", {0.0017101073583669, 0, 0}}, {"director", {0.00171357790723, 0, 0}}}},
        {"stretched_1000_eps0.01",
         stretched<1000, 10>,
         {{{"stretch", 1.0}}, {{"push", 1.0}}},
         yes,
         0.00075,
         {{"reissner", {0.00074918537055306, 0, 0}}, {"director", {0.000760462464506, 0, 0}}}},
    };
}

struct Sample {
    double error = 0.0, seconds = 0.0;
    Index unknowns = 0;
    bool converged = false;
};

template <simulation::Model M>
Sample measure(const Problem& problem, const Vec3& reference, Index elements, int repeats) {
    Sample sample;
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const double start = processor_time();
        simulation::Simulator<M> simulator(problem.assembly(elements), parameters<M>());
        simulation::Loading<M> loading;
        for (const auto& ramps : problem.stages) {
            simulation::Stage<M> stage;
            stage.ramps = ramps, stage.increments = 1;
            loading.stages.push_back(stage);
        }
        sample.converged = simulator.run(loading).converged;
        times.push_back(processor_time() - start);
        const Vec3 value =
            problem.reaction() ? Vec3(simulator.reaction({0, 0.5}).x(), 0, 0) : simulator.value(scene::last_end(0));
        sample.error = (value - reference).norm() / problem.size;
        sample.unknowns = simulator.state().size();
    }
    sample.seconds = median(times);
    return sample;
}

using Plots = std::map<std::string, observe::LogLogPlot>;

/// @param models  whose references the element is measured against: the first of them that a problem has
template <simulation::Model M>
void sweep(const char* policy, const std::vector<std::string>& models, int first, bool curved, int repeats, Plots& plots) {
    for (const Problem& problem : problems()) {
        if (problem.name.starts_with("arc") && !curved) continue;
        const auto model =
            std::find_if(models.begin(), models.end(), [&](const std::string& m) { return problem.reference.contains(m); });
        std::vector<std::pair<double, double>> by_time, by_unknowns;
        for (Index elements = first; elements <= 64 * first; elements *= 2) {
            const Sample sample = measure<M>(problem, problem.reference.at(*model), elements, repeats);
            std::printf("%s,%s,%s,%ld,%ld,%.3e,%.3e,%d\n", problem.name.c_str(), policy, model->c_str(),
                        static_cast<long>(elements), static_cast<long>(sample.unknowns), sample.error, sample.seconds,
                        sample.converged ? 1 : 0);
            if (!sample.converged) continue;
            by_time.emplace_back(sample.seconds, sample.error);
            by_unknowns.emplace_back(static_cast<double>(sample.unknowns), sample.error);
        }
        // The order of the range in which refinement helps: up to the least error.
        const auto least = std::min_element(by_unknowns.begin(), by_unknowns.end(),
                                            [](const auto& a, const auto& b) { return a.second < b.second; });
        const std::vector<std::pair<double, double>> falling(by_unknowns.begin(), least == by_unknowns.end() ? least : least + 1);
        std::printf("# order,%s,%s,%.2f,least error %.1e\n", problem.name.c_str(), policy, -observe::fitted_order(falling),
                    least == by_unknowns.end() ? NAN : least->second);
        observe::LogLogPlot& plot = plots[problem.name];
        plot.title = problem.name, plot.x_label = "CPU time [s]", plot.y_label = "error";
        plot.lines.push_back({policy, by_time});
    }
}

/// Two layers of eight fibres, each clamped at its ends, pressed into each other: 64 crossings.
scene::Assembly layers() {
    scene::Assembly assembly;
    const double length = 1.2, pitch = 0.12;
    const Index group = assembly.add_group("all");
    for (const bool upper : {false, true})
        for (int k = 0; k < 8; ++k) {
            const double aside = (k - 3.5) * pitch, z = upper ? 2.0 * r : 0.0;
            scene::FibreSpecification fibre = along_z(1.0, 20);
            fibre.from = upper ? Vec3(-0.5 * length, aside, z) : Vec3(aside, -0.5 * length, z),
            fibre.to = upper ? Vec3(0.5 * length, aside, z) : Vec3(aside, 0.5 * length, z);
            fibre.director = Vec3::UnitZ(), fibre.group = group;
            const Index f = assembly.add(fibre);
            for (const double end : {0.0, 1.0}) assembly.clamp({f, end}, upper ? Vec3(0, 0, -r) : Vec3(Vec3::Zero()));
        }
    return assembly;
}
/// What the scene has besides, which most scenes do without.
enum class With { nothing, itself, rule, checkpoint };
template <simulation::Model M>
void cost(const char* policy, int repeats, const std::string& only, With with = With::nothing) {
    if (!only.empty() && only != policy) return;
    using B = typename M::Beam;
    using Element = contact::ContactElement<B, typename M::Normal, typename M::Friction>;
    std::vector<double> times;
    Index unknowns = 0, active = 0, newton = 0;
    double force = 0.0;
    bool converged = true;
    for (int k = 0; k < repeats; ++k) {
        const double start = processor_time();
        simulation::ModelParameters<M> all = [] {
            if constexpr (law::Augmenting<typename M::Normal>) {
                simulation::ModelParameters<M> held;
                const auto plain = parameters<Policy<B, typename M::Friction>>();
                held.normal = {.law = plain.normal, .largest_penetration = 1e-4 * r};
                held.contact = plain.contact, held.iteration = plain.iteration;
                return held;
            } else {
                return parameters<M>();
            }
        }();
        all.contact.detection.self_contact = with == With::itself;
        scene::Assembly scene = layers();
        if (with == With::rule) scene.add(scene::PairRule{0, 0, 1.0, 1.0});
        simulation::Simulator<M> simulator(scene, all);
        simulation::Loading<M> loading;
        loading.increments = 4;
        const std::filesystem::path file = std::filesystem::temp_directory_path() / "fibrant_elements_bench.bin";
        if (with == With::checkpoint) loading.checkpoint = file.string();
        const simulation::Report report = simulator.run(loading);
        times.push_back(processor_time() - start);
        if (with == With::checkpoint) std::filesystem::remove(file);
        converged = converged && report.converged;
        unknowns = simulator.state().size(), active = report.contact.active, newton = report.counts.newton,
        force = report.contact.reaction_sum;
    }
    const double seconds = median(times);
    std::printf("%s,%ld,%zu,%zu,%zu,%zu,%zu,%ld,%ld,%.6e,%.3f,%.3e,%d\n", policy, static_cast<long>(unknowns),
                sizeof(typename B::Rest) + sizeof(typename B::Stresses), sizeof(typename assembly::ChainSystem<B>::Row),
                sizeof(Element), sizeof(contact::ContactRecord<typename M::Normal, typename M::Friction>),
                sizeof(typename assembly::ChainSystem<B>::Point), static_cast<long>(active), static_cast<long>(newton), force,
                seconds, seconds / static_cast<double>(newton), converged ? 1 : 0);
    std::fflush(stdout);
}

using Director = Policy<beam::DirectorBeam<3>>;
using Director2 = Policy<beam::DirectorBeam<2>>;
using Rod = Policy<beam::RigidSectionRod>;
using Centred = Policy<beam::OnCentreline<beam::DirectorBeam<3>>>;
using Cable = Policy<beam::KirchhoffCable>;
using Rough = Policy<beam::DirectorBeam<3>, law::RegularisedCoulomb>;
using Smooth = Policy<beam::DirectorBeam<3>, law::SmoothCoulomb>;
struct Multiplied : Director {
    using Normal = law::Augmented<law::RegularisedPenalty>;
};
struct WithTools : Director {
    using Tools = contact::RigidTools;
};

}  // namespace

int main(int argc, char** argv) {
    const std::filesystem::path directory = folder(argc > 1 ? argv[1] : ".");
    const int repeats = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    Plots plots;
    std::printf("problem,policy,reference,elements,unknowns,error,seconds,converged\n");
    if (argc <= 3) {
        sweep<Director>("director 3", {"director"}, 2, true, repeats, plots);
        sweep<Director2>("director 2", {"director"}, 4, true, repeats, plots);
        sweep<Rod>("rod", {"reissner"}, 4, true, repeats, plots);
        sweep<Cable>("cable", {"kirchhoff", "reissner"}, 2, false, repeats, plots);
        for (const auto& [name, plot] : plots)
            observe::write_file(directory / ("accuracy_" + name + ".svg"), observe::log_log_svg(plot));
    }
    const std::string only = argc > 3 && std::string(argv[3]) != "cost" ? argv[3] : "";
    std::printf(
        "policy,unknowns,bytes an element,bytes a row,bytes a contact,bytes of its record,bytes a "
        "point,active,newton,reactions,seconds,seconds an iteration,converged\n");
    cost<Director>("director", repeats, only);
    cost<Rough>("director with friction", repeats, only);
    cost<Smooth>("director with smooth friction", repeats, only);
    cost<Multiplied>("director with multipliers", repeats, only);
    cost<Director>("director that may touch itself", repeats, only, With::itself);
    cost<WithTools>("director with tools", repeats, only);
    cost<Director>("director with a rule for pairs", repeats, only, With::rule);
    cost<Director>("director with checkpoints", repeats, only, With::checkpoint);
    cost<Centred>("director touched on its centreline", repeats, only);
    cost<Director2>("director with 2 nodes", repeats, only);
    cost<Rod>("rod", repeats, only);
    cost<Cable>("cable", repeats, only);
    return 0;
}

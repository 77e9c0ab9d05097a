// SPDX-License-Identifier: MIT
// What does a scene save that leaves out what it does not need? One small weave is settled as it is, and with one thing
// more at a time that it could do without. The answer has to be the same. Prints CSV; medians of several runs, one thread.
// usage: benchmark_skips_bench [fibres a tow [repeats]]; default 7 and 5
#include "chapter_fabric.hpp"
#include "timing.hpp"

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/observe/vtk_writer.hpp>
#include <fibrant/proximity/verlet_search.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

using namespace fibrant;
namespace cloth = compositions::weave;

namespace {

/// Finds the graph of contact elements anew whenever it forms the values.
struct AnalysingPcg : solver::TwoLevelPcg {
    using solver::TwoLevelPcg::TwoLevelPcg;
    template <class System>
    solver::SolveStatus prepare(const System& system) {
        analyse(system);
        return solver::TwoLevelPcg::prepare(system);
    }
};

using Weave = benchmarks::SettledWeave<solver::TwoLevelPcg>;
struct Analysing : Weave {
    using Solver = AnalysingPcg;
};
struct WithTools : Weave {
    using Tools = contact::RigidTools;
};
struct Listing : Weave {
    using Proximity = proximity::VerletSearch<proximity::GridSearch>;
};
struct Quadratic : Weave {
    using Beam = beam::DirectorBeam<3, beam::DirectorBeamOptions{.quadratic = beam::QuadraticStrain::complete}>;
};
struct WithoutFriction : Weave {
    using Friction = law::Frictionless;
};

struct Scene {
    cloth::FabricParameters fabric;
    cloth::SettleParameters settle;
    int repeats;
    double seconds = 0.0, crimp = 0.0;  ///< of the weave as it is
};

template <class M, class... Observers>
void measure(const char* name, Scene& scene, bool self_contact, Observers&... observers) {
    std::vector<double> seconds;
    double crimp = 0.0;
    Index newton = 0, elements = 0;
    for (int k = 0; k < scene.repeats; ++k) {
        auto parameters = cloth::model_parameters<M>(scene.fabric, scene.settle);
        parameters.contact.detection.self_contact = self_contact;
        simulation::Simulator<M> simulator(cloth::flat_fabric(scene.fabric, scene.settle.tension_strain), parameters);
        const simulation::Report report = simulator.run(cloth::settling<M>(scene.fabric, scene.settle), observers...);
        seconds.push_back(report.wall_seconds);
        newton = report.counts.newton, elements = report.contact.elements;
        crimp = cloth::crimp_measures(simulator.snapshot(), scene.fabric).warp;
    }
    const double median = benchmarks::median(seconds);
    if (scene.seconds == 0.0) scene.seconds = median, scene.crimp = crimp;
    std::printf("%s,%.3f,%.3f,%td,%td,%.6f,%.1e,%zu\n", name, median, median / scene.seconds, newton, elements, crimp,
                std::abs(crimp / scene.crimp - 1.0), sizeof(typename simulation::Simulator<M>::Contacts::Element));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    Scene scene{benchmarks::chapter_fabric("plain", 2, argc > 1 ? std::atol(argv[1]) : 7),
                {},
                argc > 2 ? std::max(1, std::atoi(argv[2])) : 5};
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / "fibrant_skips_bench";
    std::printf("with,seconds,ratio,newton,contact_elements,crimp,crimp_differs_by,bytes_of_a_contact_element\n");
    measure<Weave>("nothing more", scene, false);
    measure<Analysing>("contact graph analysed in every iteration", scene, false);
    measure<Weave>("search of each fibre against itself", scene, true);
    measure<WithTools>("rigid tools though there are none", scene, false);
    measure<Quadratic>("quadratic strains across the section", scene, false);
    measure<Listing>("list of near pairs", scene, false);
    observe::VtkWriter writer(folder);
    measure<Weave>("a ParaView file of every increment", scene, false, writer);
    measure<WithoutFriction>("no friction", scene, false);
    std::filesystem::remove_all(folder);
    return 0;
}

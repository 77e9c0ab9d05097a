// SPDX-License-Identifier: MIT
// Writes linear systems of a settling weave to files, for benchmark_solver_bench.
// usage: benchmark_record_systems FOLDER EVERY [pattern [tows a family [fibres a tow [most]]]]; defaults: plain 4 76, all
//   EVERY  each n-th solve is written; with `most`, the run is stopped after that many increments

#include "chapter_fabric.hpp"

#include <fibrant/solver/recording_solver.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <cstdio>
#include <cstdlib>

using namespace fibrant;
namespace cloth = compositions::weave;

namespace {

struct Printer {
    Index most;
    Index solves = 0;
    void reported(const simulation::IncrementReport& increment) {
        solves += increment.counts.linear_solves;
        std::printf("%td,%s,%td,%td,%.3g\n", increment.number, increment.stage.c_str(), solves, increment.contact.active,
                    increment.residual);
        std::fflush(stdout);
        if (increment.number >= most) std::exit(0);
    }
};

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || std::atol(argv[2]) < 1) {
        std::fprintf(stderr, "usage: %s FOLDER EVERY [pattern [tows [fibres [most]]]]\n", argv[0]);
        return 2;
    }
    using Weave = benchmarks::SettledWeave<solver::RecordingSolver<solver::TwoLevelPcg>>;
    const cloth::FabricParameters fabric = benchmarks::chapter_fabric(
        argc > 3 ? argv[3] : "plain", argc > 4 ? std::atol(argv[4]) : 4, argc > 5 ? std::atol(argv[5]) : 76);
    const cloth::SettleParameters settle;
    auto parameters = cloth::model_parameters<Weave>(fabric, settle);
    parameters.solver.folder = argv[1];
    parameters.solver.every = std::atol(argv[2]);
    simulation::Simulator<Weave> simulator(cloth::flat_fabric(fabric, settle.tension_strain), parameters);
    Printer printer{argc > 6 ? std::atol(argv[6]) : 1000000};
    std::printf("increment,stage,solves,active_contacts,residual\n");
    return simulator.run(cloth::settling<Weave>(fabric, settle), printer).converged ? 0 : 1;
}

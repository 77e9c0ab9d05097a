// SPDX-License-Identifier: MIT
// How do time and memory of a settled weave grow with the number of fibres? Plain weaves with more and more tows of the
// same kind, from flat tows to rest. Prints CSV and, last, the exponents fitted over the unknowns.
// usage: benchmark_scaling_bench [fibres a tow [tows a family]...]; default 19 2 3 4 6
#include "chapter_fabric.hpp"
#include "timing.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/observe/svg_plot.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace fibrant;
namespace cloth = compositions::weave;

namespace {

using Weave = benchmarks::SettledWeave<solver::TwoLevelPcg>;

}  // namespace

int main(int argc, char** argv) {
    const Index fibres = argc > 1 ? std::atol(argv[1]) : 19;
    std::vector<Index> sizes;
    for (int k = 2; k < argc; ++k) sizes.push_back(std::atol(argv[k]));
    if (sizes.empty()) sizes = {2, 3, 4, 6};
    std::vector<std::pair<double, double>> seconds, each, linear, bytes;  // by unknowns
    std::printf(
        "tows,fibres,unknowns,contact_elements,converged,wrong_crossings,least_gap_over_radius,increments,rejected,"
        "newton,linear_iterations_a_solve,seconds,seconds_a_newton,peak_bytes\n");
    bool sound = true;
    for (const Index tows : sizes) {
        const cloth::FabricParameters fabric = benchmarks::chapter_fabric("plain", tows, fibres);
        const cloth::SettleParameters settle;
        simulation::Simulator<Weave> simulator(cloth::flat_fabric(fabric, settle.tension_strain),
                                               cloth::model_parameters<Weave>(fabric, settle));
        const simulation::Report report = simulator.run(cloth::settling<Weave>(fabric, settle));
        const cloth::Audit audit = cloth::audit(simulator.snapshot(), fabric, proximity::GridSearch());
        const auto solves = static_cast<double>(report.counts.linear_solves);
        const auto unknowns = static_cast<double>(simulator.mesh().layout().unknowns());
        seconds.emplace_back(unknowns, report.wall_seconds);
        each.emplace_back(unknowns, report.wall_seconds / static_cast<double>(report.counts.newton));
        linear.emplace_back(unknowns, static_cast<double>(report.counts.linear_iterations) / solves);
        bytes.emplace_back(unknowns, benchmarks::peak_bytes());
        std::printf("%td,%td,%.0f,%td,%d,%td,%.4f,%zu,%td,%td,%.1f,%.2f,%.4f,%.0f\n", tows, fabric.fibres(), unknowns,
                    report.contact.elements, report.converged ? 1 : 0, audit.wrong_crossings + audit.missing_crossings,
                    audit.least_gap.gap_over_radius, report.increments.size(), report.rejected_increments, report.counts.newton,
                    linear.back().second, seconds.back().second, each.back().second, bytes.back().second);
        std::fflush(stdout);
        sound = sound && report.converged;
    }
    if (seconds.size() > 1)
        std::printf(
            "# exponents over unknowns: seconds %.2f, seconds a Newton iteration %.2f, iterations a solve %.2f, bytes %.2f\n",
            observe::fitted_order(seconds), observe::fitted_order(each), observe::fitted_order(linear),
            observe::fitted_order(bytes));
    return sound ? 0 : 1;
}

// SPDX-License-Identifier: MIT
// How do time and memory of a settled weave grow with the number of fibres? Plain weaves with more and more tows of the
// same kind, from flat tows to rest. Prints CSV and, last, the exponents fitted over the unknowns.
// usage: benchmark_scaling_bench [fibres a tow [tows a family]...]; default 19 2 3 4 6
#include "chapter_fabric.hpp"
#include "timing.hpp"

#include <fibrant/compositions/weave/audit.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <vector>

using namespace fibrant;
namespace cloth = compositions::weave;

namespace {

using Weave = benchmarks::SettledWeave<solver::TwoLevelPcg>;

/// Slope of log y over log x.
double exponent(const std::vector<double>& x, const std::vector<double>& y) {
    double sx = 0, sy = 0, sxx = 0, sxy = 0;
    for (std::size_t k = 0; k < x.size(); ++k) {
        const double a = std::log(x[k]), b = std::log(y[k]);
        sx += a, sy += b, sxx += a * a, sxy += a * b;
    }
    const auto n = static_cast<double>(x.size());
    return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

}  // namespace

int main(int argc, char** argv) {
    const Index fibres = argc > 1 ? std::atol(argv[1]) : 19;
    std::vector<Index> sizes;
    for (int k = 2; k < argc; ++k) sizes.push_back(std::atol(argv[k]));
    if (sizes.empty()) sizes = {2, 3, 4, 6};
    std::vector<double> unknowns, seconds, each, linear, bytes;
    std::printf("tows,fibres,unknowns,contact_elements,converged,wrong_crossings,least_gap_over_radius,increments,rejected,"
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
        unknowns.push_back(static_cast<double>(simulator.mesh().layout().unknowns()));
        seconds.push_back(report.wall_seconds);
        each.push_back(report.wall_seconds / static_cast<double>(report.counts.newton));
        linear.push_back(static_cast<double>(report.counts.linear_iterations) / solves);
        bytes.push_back(benchmarks::peak_bytes());
        std::printf("%td,%td,%.0f,%td,%d,%td,%.4f,%zu,%td,%td,%.1f,%.2f,%.4f,%.0f\n", tows, fabric.fibres(), unknowns.back(),
                    report.contact.elements, report.converged ? 1 : 0, audit.wrong_crossings + audit.missing_crossings,
                    audit.least_gap.gap_over_radius, report.increments.size(), report.rejected_increments, report.counts.newton,
                    linear.back(), seconds.back(), each.back(), bytes.back());
        std::fflush(stdout);
        sound = sound && report.converged;
    }
    if (unknowns.size() > 1)
        std::printf("# exponents over unknowns: seconds %.2f, seconds a Newton iteration %.2f, iterations a solve %.2f, bytes %.2f\n",
                    exponent(unknowns, seconds), exponent(unknowns, each), exponent(unknowns, linear), exponent(unknowns, bytes));
    return sound ? 0 : 1;
}

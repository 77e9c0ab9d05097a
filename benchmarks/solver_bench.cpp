// SPDX-License-Identifier: MIT
// How many iterations, and how much time, does each linear solver need on fabrics of growing size?
// usage: benchmark_solver_bench [bundles in each direction]... ; prints CSV.

#include "../tests/support/fabric_system.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

using namespace fibrant;

namespace {

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Solver>
void measure(const char* scene, const char* name, Solver solver, const test::FabricSystem& system, std::initializer_list<double> tolerances) {
    const double start = seconds();
    solver.analyse(system);
    const double analysed = seconds();
    solver.prepare(system);
    const double prepared = seconds();
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    Vector b(system.layout().unknowns()), x;
    for (Index k = 0; k < b.size(); ++k) b[k] = normal(generator) * system.layout().length[core::at(k / 3)];
    for (const double tolerance : tolerances) {
        const double begin = seconds();
        const solver::SolveReport report = solver.solve(system, b, tolerance, x);
        const double end = seconds();
        std::printf("%s,%s,%td,%td,%td,%.0e,%d,%.2e,%.1e,%.3f,%.3f,%.3f\n", scene, name, core::count(system.layout().chains), b.size(),
                    system.contacts(), tolerance, report.iterations, report.residual, report.curvature, analysed - start,
                    prepared - analysed, end - begin);
        std::fflush(stdout);
    }
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("scene,solver,fibres,unknowns,contacts,tolerance,iterations,residual,curvature,analyse_s,prepare_s,solve_s\n");
    const auto tolerances = {1e-2, 1e-4, 1e-6, 1e-8};
    for (int k = 1; k < std::max(argc, 2); ++k) {
        const int bundles = argc > 1 ? std::atoi(argv[k]) : 1;
        test::Fabric fabric{.bundles = bundles};
        const test::FabricSystem system(fabric);
        measure("base", "TwoLevelPcg", solver::TwoLevelPcg{}, system, tolerances);
    }
}

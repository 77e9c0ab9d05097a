// SPDX-License-Identifier: MIT
// How many iterations, and how much time, does each linear solver need on fabrics of growing size and stiffness?
// usage: benchmark_solver_bench [bundles of 76 fibres in each of two directions]... ; default 1 and 2. Prints CSV.

#include "../tests/support/fabric_system.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <vector>

using namespace fibrant;

namespace {

double seconds() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Forces of random size and direction between the particles of every contact element.
Vector contact_load(const test::FabricSystem& system) {
    struct Load {
        Vector b;
        std::mt19937 generator{3};
        std::normal_distribution<double> normal{};
        void dense(const assembly::DenseTerm&) const {}
        void point(const assembly::PointTerm& term) {
            const Vec3 gap(normal(generator), normal(generator), normal(generator));
            const Vec3 force = term.stiffness * gap;
            for (std::size_t i = 0; i < term.vectors.size(); ++i) b.segment<3>(3 * term.vectors[i]) += term.weights[i] * force;
        }
    } load{Vector::Zero(system.layout().unknowns())};
    system.visit(load);
    return load.b;
}

/// Forces on every vector, independent of one another: rougher than a contact gives.
Vector noise(const scene::DofLayout& layout) {
    std::mt19937 generator(3);
    std::normal_distribution<double> normal;
    Vector b(layout.unknowns());
    for (Index k = 0; k < b.size(); ++k) b[k] = normal(generator) * layout.length[core::at(k / 3)];
    return b;
}

template <class Solver>
void measure(const char* scene, const char* name, Solver solver, const test::FabricSystem& system, const std::vector<double>& tolerances) {
    const double start = seconds();
    solver.analyse(system);
    const double analysed = seconds();
    const solver::SolveStatus status = solver.prepare(system);
    const double prepared = seconds();
    const std::vector<Vector> loads{contact_load(system), noise(system.layout())};
    Vector x;
    for (std::size_t load = 0; load < loads.size(); ++load)
        for (const double tolerance : tolerances) {
            const double begin = seconds();
            const solver::SolveReport report = solver.solve(system, loads[load], tolerance, x);
            const double end = seconds();
            std::printf("%s,%s,%td,%td,%td,%s,%.0e,%d,%d,%d,%.1e,%.1e,%.3f,%.3f,%.3f\n", scene, name, core::count(system.layout().chains),
                        x.size(), system.contacts(), load == 0 ? "contact" : "noise", tolerance, static_cast<int>(status),
                        static_cast<int>(report.status), report.iterations, report.residual, report.curvature, analysed - start,
                        prepared - analysed, end - begin);
            std::fflush(stdout);
        }
}

}  // namespace

int main(int argc, char** argv) {
    std::printf("scene,solver,fibres,unknowns,contacts,load,tolerance,prepared,status,iterations,residual,curvature,analyse_s,prepare_s,solve_s\n");
    std::vector<int> sizes;
    for (int k = 1; k < argc; ++k) sizes.push_back(std::max(1, std::atoi(argv[k])));
    if (sizes.empty()) sizes = {1, 2};
    for (const int bundles : sizes) {
        const test::Fabric base{.bundles = bundles};
        const test::FabricSystem system(base);
        measure("base", "TwoLevelPcg", solver::TwoLevelPcg{}, system, {1e-2, 1e-4, 1e-6, 1e-8});
        if (bundles <= 2) measure("base", "FibreBlockPcg", solver::FibreBlockPcg{}, system, {1e-4});

        struct Variant {
            const char* name;
            test::Fabric fabric;
        };
        std::vector<Variant> variants(7, {"", base});
        variants[0].name = "stiffness x 10", variants[0].fabric.contact_stiffness *= 10.0;
        variants[1].name = "stiffness x 100", variants[1].fabric.contact_stiffness *= 100.0;
        variants[2].name = "half active", variants[2].fabric.active = 0.5;
        variants[3].name = "fifth active", variants[3].fabric.active = 0.2;
        variants[4].name = "no friction", variants[4].fabric.sticking = 0.0;
        variants[5].name = "misaligned", variants[5].fabric.misalignment = 1.0;
        variants[6].name = "no groups", variants[6].fabric.grouped = false;
        for (const Variant& variant : variants) {
            measure(variant.name, "TwoLevelPcg", solver::TwoLevelPcg{}, test::FabricSystem(variant.fabric), {1e-4, 1e-8});
        }
    }
    const test::FabricSystem small(test::Fabric{.bundles = 1, .parallel = true, .fibres = 19});
    measure("19 fibres", "SparseCholesky", solver::SparseCholesky{}, small, {1e-8});
    measure("19 fibres", "TwoLevelPcg", solver::TwoLevelPcg{}, small, {1e-8});
}

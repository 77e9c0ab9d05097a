// SPDX-License-Identifier: MIT
// How long does each linear solver take to reach a tolerance, with what true error and memory, over the direct baseline?
//
// usage: benchmark_solver_bench [--strategies a,b,...] [--variants] [--threads n] [scene]...
//   scene       a file that solver::write_system wrote, or a number of fibres of the synthetic weave: 76 (one bundle),
//               152 (crossing bundles), 304, 608, ... (multiples of 152; of 1216, 1.28 million unknowns). Default: 76 152
//   --variants  each synthetic scene also with stiffer and fewer contact elements, without friction, misaligned, ungrouped
// Prints CSV, a line a tolerance. `error` is |x - x*| / |x*| in the energy norm, x* from two levels to 1e-13. `bytes` is
// the peak of memory beyond the system's. `prepare_s` is that of a second preparation. Seconds are processor time on one
// thread, which other programs hardly change, and wall time on more. `ratio` is time of the baseline
// (prepare + solve) over time: of CHOLMOD if built with FIBRANT_WITH_CHOLMOD, else of the block Cholesky in double. Lines
// "product" compare A x with a scalar CSR product.

#include "../tests/support/fabric_system.hpp"
#include "timing.hpp"

#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/solver/automatic_solver.hpp>
#include <fibrant/solver/saved_system.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>
#if defined(FIBRANT_WITH_CHOLMOD)
#include <fibrant/solver/cholmod_cholesky.hpp>
#endif

#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

using namespace fibrant;
using namespace fibrant::benchmarks;
using System = assembly::ChainSystem<beam::DirectorBeam<>>;

namespace {

constexpr std::array tolerances{1e-2, 1e-4, 1e-6, 1e-8};

void set_threads([[maybe_unused]] int threads) {
#if defined(_OPENMP)
    omp_set_num_threads(threads);
#endif
}

/// Resident memory now [bytes].
double resident() {
    std::ifstream file("/proc/self/statm");
    double all = 0.0, pages = 0.0;
    file >> all >> pages;
    return pages * static_cast<double>(sysconf(_SC_PAGESIZE));
}
struct Row {
    double analyse, prepare, solve, residual, error, bytes;
    int status, iterations;
};
using Rows = std::array<Row, tolerances.size()>;

/// Runs work(rows) in a process of its own, so that memory is counted for it alone; false if that ended early.
template <class Work>
bool in_own_process(int threads, const Work& work, Rows& rows) {
    std::array<int, 2> ends{};
    if (pipe(ends.data()) != 0) return false;
    std::fflush(stdout);
    const pid_t child = fork();
    if (child == 0) {
        set_threads(threads);
        work(rows);
        const bool sent = write(ends[1], rows.data(), sizeof(Rows)) == static_cast<ssize_t>(sizeof(Rows));
        _exit(sent ? 0 : 1);
    }
    close(ends[1]);
    const bool whole = child > 0 && read(ends[0], rows.data(), sizeof(Rows)) == static_cast<ssize_t>(sizeof(Rows));
    close(ends[0]);
    int status = 0;
    if (child > 0) waitpid(child, &status, 0);
    return whole;
}

template <class Solver>
void measure(Solver solver, const System& system, const Vector& b, const Vector& reference, Rows& rows) {
#if defined(__GLIBC__)
    malloc_trim(0);  // what the system's making has left free would hide what is taken now
#endif
    const double before = resident();
    const double start = time_now();
    solver.analyse(system);
    const double first = time_now();
    solver.prepare(system);
    const double analysed = time_now();
    solver.prepare(system);  // again, as in each iteration of Newton's method: memory is at hand
    const double prepared = time_now();
    Vector x, energy(b.size());
    system.apply(reference, energy);
    const double size = reference.dot(energy);
    for (std::size_t k = 0; k < tolerances.size(); ++k) {
        const double begin = time_now();
        const solver::SolveReport report = solver.solve(system, b, tolerances[k], x);
        const double end = time_now();
        const Vector difference = x - reference;
        system.apply(difference, energy);
        rows[k] = {first - start,
                   prepared - analysed,
                   end - begin,
                   report.residual,
                   std::sqrt(std::abs(difference.dot(energy)) / size),
                   peak_bytes() - before,
                   static_cast<int>(report.status),
                   report.iterations};
    }
}

const std::vector<std::string>& known_strategies() {
    static const std::vector<std::string> names {
#if defined(FIBRANT_WITH_CHOLMOD)
        "CholmodCholesky",
#endif
            "DoubleBlockCholesky", "FloatBlockCholesky", "TwoLevelPcg", "AutomaticSolver", "FibreBlockPcg", "SparseCholesky"
    };
    return names;
}
void measure(const std::string& name, const System& system, const Vector& b, const Vector& reference, Rows& rows) {
#if defined(FIBRANT_WITH_CHOLMOD)
    if (name == "CholmodCholesky") measure(solver::CholmodCholesky{}, system, b, reference, rows);
#endif
    if (name == "DoubleBlockCholesky") measure(solver::DoubleBlockCholesky{}, system, b, reference, rows);
    if (name == "FloatBlockCholesky") measure(solver::FloatBlockCholesky{}, system, b, reference, rows);
    if (name == "TwoLevelPcg") measure(solver::TwoLevelPcg{}, system, b, reference, rows);
    if (name == "AutomaticSolver") measure(solver::AutomaticSolver{}, system, b, reference, rows);
    if (name == "FibreBlockPcg") measure(solver::FibreBlockPcg{}, system, b, reference, rows);
    if (name == "SparseCholesky") measure(solver::SparseCholesky{}, system, b, reference, rows);
}

void print(const std::string& scene, const System& system, const std::string& strategy, double tolerance, const Row& row,
           double baseline) {
    std::printf("%s,%td,%td,%zu,%s,%.0e,%d,%d,%.2e,%.2e,%.4f,%.4f,%.5f,%.3g,%.2f\n", scene.c_str(),
                core::count(system.layout().chains), system.layout().unknowns(), system.points().size(), strategy.c_str(),
                tolerance, row.status, row.iterations, row.residual, row.error, row.analyse, row.prepare, row.solve, row.bytes,
                baseline / (row.prepare + row.solve));
    std::fflush(stdout);
}

/// A x against the same product of a scalar matrix in compressed rows.
void measure_product(const std::string& scene, const System& system, const Vector& b, int threads) {
    Rows rows{};
    const bool done = in_own_process(
        threads,
        [&](Rows& to) {
            Vector y(b.size()), z(b.size());
            SparseMatrix a;
            assembly::assemble_from_terms(system, a);
            const Eigen::SparseMatrix<double, Eigen::RowMajor> rows_of_a = a;
            a.resize(0, 0);
            const double own = median_seconds(9, [&] { system.apply(b, y); });
            const double csr = median_seconds(9, [&] { z.noalias() = rows_of_a * b; });
            const double error = (y - z).norm() / z.norm();
            to[0] = {0.0, 0.0, csr, 0.0, 0.0, static_cast<double>(rows_of_a.nonZeros()) * 12.0, 0, 1};
            to[1] = {0.0, 0.0, own, 0.0, error, 0.0, 0, 1};
        },
        rows);
    if (!done) return;
    print(scene, system, "product CSR", 0.0, rows[0], rows[0].solve);
    print(scene, system, "product", 0.0, rows[1], rows[0].solve);
}

void compare(const std::string& scene, const System& system, const Vector& b, const std::vector<std::string>& strategies,
             int threads) {
    Vector reference;
    solver::TwoLevelPcg exact{{.iteration_limit = 20000}};
    exact.analyse(system);
    exact.prepare(system);
    exact.solve(system, b, 1e-13, reference);
    measure_product(scene, system, b, threads);
    Rows baseline{};
    for (Row& row : baseline) row.solve = std::numeric_limits<double>::quiet_NaN();
    for (const std::string& strategy : strategies) {
        Rows rows{};
        if (!in_own_process(
                threads, [&](Rows& to) { measure(strategy, system, b, reference, to); }, rows)) {
            std::fprintf(stderr, "%s: %s ended early\n", scene.c_str(), strategy.c_str());
            continue;
        }
        if (strategy == known_strategies().front()) baseline = rows;
        for (std::size_t k = 0; k < tolerances.size(); ++k)
            print(scene, system, strategy, tolerances[k], rows[k], baseline[k].prepare + baseline[k].solve);
    }
}

/// The documented scene: an even number of bundles, half in each direction, of 76 fibres.
test::Fabric fabric(int fibres) {
    if (fibres < 152) return {.bundles = 1, .parallel = true, .fibres = fibres};
    const int bundles = std::max(1, fibres / 152), elements = bundles > 4 ? 29 * bundles / 4 : 32;
    return {.bundles = bundles, .elements = elements, .length = 4.4 * elements / 32.0};
}

std::vector<std::string> split(const std::string& list) {
    std::vector<std::string> names(1);
    for (const char c : list) {
        if (c == ',')
            names.emplace_back();
        else
            names.back() += c;
    }
    return names;
}

}  // namespace

int main(int argc, char** argv) try {
    std::vector<std::string> strategies, scenes;
    bool variants = false;
    int threads = 1;
    for (int k = 1; k < argc; ++k) {
        const std::string argument = argv[k];
        if (argument == "--variants")
            variants = true;
        else if (argument == "--strategies" && k + 1 < argc)
            strategies = split(argv[++k]);
        else if (argument == "--threads" && k + 1 < argc)
            threads = std::max(1, std::atoi(argv[++k]));
        else
            scenes.push_back(argument);
    }
    if (scenes.empty()) scenes = {"76", "152"};
    for (const std::string& name : strategies) {
        if (std::find(known_strategies().begin(), known_strategies().end(), name) != known_strategies().end()) continue;
        std::fprintf(stderr, "no strategy %s in this build\n", name.c_str());
        return 1;
    }
    set_threads(1);  // in this process, which is to have none when it forks
    std::printf(
        "scene,fibres,dofs,contacts,strategy,tolerance,status,iterations,residual,error,analyse_s,prepare_s,solve_s,bytes,"
        "ratio\n");
    for (const std::string& scene : scenes) {
        const int fibres = std::atoi(scene.c_str());
        std::vector<std::string> chosen = strategies;
        if (chosen.empty()) {
            chosen = known_strategies();
            chosen.pop_back();  // Eigen's factor takes hours beyond a bundle
            if (fibres > 0 && fibres <= 38) chosen.push_back("SparseCholesky");
        }
        if (fibres == 0 || std::to_string(fibres) != scene) {
            const solver::SavedSystem saved{std::filesystem::path(scene)};
            const System system = test::chain_system(saved);
            compare(std::filesystem::path(scene).stem().string(), system, saved.right_hand_side(), chosen, threads);
            continue;
        }
        const test::Fabric base = fabric(fibres);
        std::vector<std::pair<std::string, test::Fabric>> all{{"base", base}};
        if (variants) {
            for (const char* name :
                 {"stiffness x 10", "stiffness x 100", "half active", "fifth active", "no friction", "misaligned", "no groups"})
                all.emplace_back(name, base);
            all[1].second.contact_stiffness *= 10.0, all[2].second.contact_stiffness *= 100.0;
            all[3].second.active = 0.5, all[4].second.active = 0.2;
            all[5].second.sticking = 0.0, all[6].second.misalignment = 1.0, all[7].second.grouped = false;
        }
        for (const auto& [name, fabric] : all) {
            const System system = test::chain_system(test::FabricSystem(fabric));
            compare(name, system, test::contact_load(system), chosen, threads);
        }
    }
} catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
}

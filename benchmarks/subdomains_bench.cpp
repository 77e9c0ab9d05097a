// SPDX-License-Identifier: MIT
// What does it cost to cut a recorded system into subdomains, and does the number of ranks change its bits?
// usage: benchmark_subdomains_bench SYSTEM TOLERANCE PARTS,RANKS ...
//   RANKS  threads that are ranks; 0: one rank without exchange; -1: the ranks of mpirun, where it is built with MPI

#include <fibrant/distributed/cut_report.hpp>
#include <fibrant/distributed/subdomain_pcg.hpp>
#include <fibrant/distributed/thread_ranks.hpp>
#include <fibrant/solver/saved_system.hpp>
#ifdef FIBRANT_WITH_MPI
#include <fibrant/distributed/mpi_exchange.hpp>
#endif

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>

using namespace fibrant;

namespace {

/// A number that tells two vectors of different bits apart (Fowler, Noll and Vo, FNV-1a).
std::uint64_t fingerprint(const Vector& x) {
    std::uint64_t sum = 14695981039346656037u;
    for (Index k = 0; k < x.size(); ++k) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x[k], 8);
        sum = (sum ^ bits) * 1099511628211u;
    }
    return sum;
}

template <class E>
void solve(const solver::SavedSystem& system, double tolerance, const distributed::Subdomains::Parameters& cut,
           const typename E::Parameters& exchange) {
    typename distributed::SubdomainPcg<E>::Parameters parameters;
    parameters.levels.cut = cut, parameters.levels.exchange = exchange;
    distributed::SubdomainPcg<E> pcg(parameters);
    pcg.analyse(system);
    pcg.prepare(system);
    Vector x;
    const solver::SolveReport report = pcg.solve(system, system.right_hand_side(), tolerance, x);
    if (pcg.exchange().rank() != 0) return;
    const distributed::CutReport cost = distributed::report_cut(system, pcg.cut());
    const distributed::RankUse& use = pcg.use();
    const auto each = [&](Index sum) { return static_cast<double>(sum) / static_cast<double>(std::max(report.iterations, 1)); };
    std::printf(
        "%td,%d,%d,%td,%td,%td,%td,%td,%td,%td,%td,%.3f,%d,%.2e,%.1f,%.0f,%.1f,%.0f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%.3f,%"
        "016llx\n",
        cost.parts, pcg.exchange().ranks(), core::threads(), cost.terms, cost.cut_terms, cost.cut_elements, cost.most_nodes,
        cost.most_halo_nodes, cost.most_terms, cost.most_halo_terms, cost.most_neighbours, cost.imbalance,
        report.status == solver::SolveStatus::converged ? report.iterations : -1, report.residual, each(use.traffic.messages),
        each(use.traffic.bytes), each(use.traffic.gatherings), each(use.traffic.gathered_bytes), use.prepare_seconds,
        use.whole_seconds, use.sweep_seconds, use.joint_seconds, use.product_seconds, use.coarse_seconds, use.waiting_seconds,
        static_cast<unsigned long long>(fingerprint(x)));
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
#ifdef FIBRANT_WITH_MPI
    const distributed::MpiSession session(argc, argv);
    const bool first = distributed::MpiExchange().rank() == 0;
#else
    const bool first = true;
#endif
    if (argc < 4) {
        std::fprintf(stderr, "usage: %s SYSTEM TOLERANCE PARTS,RANKS ...\n", argv[0]);
        return 2;
    }
    const solver::SavedSystem system{std::filesystem::path(argv[1])};
    const double tolerance = std::atof(argv[2]);
    if (first)
        std::printf(
            "parts,ranks,threads,terms,cut_terms,cut_elements,nodes,halo_nodes,own_terms,halo_terms,neighbours,"
            "imbalance,iterations,residual,messages,bytes,gatherings,gathered_bytes,prepare_seconds,solve_seconds,"
            "sweep_seconds,joint_seconds,product_seconds,coarse_seconds,waiting_seconds,bits\n");
    for (int k = 3; k < argc; ++k) {
        distributed::Subdomains::Parameters cut;
        int ranks = 0;
        if (std::sscanf(argv[k], "%d,%d", &cut.parts, &ranks) != 2) return 2;
        if (ranks > 0)
            distributed::run_on_threads(ranks, [&](const distributed::ThreadRank::Parameters& own) {
                solve<distributed::ThreadRank>(system, tolerance, cut, own);
            });
        else if (ranks == 0)
            solve<distributed::OneRank>(system, tolerance, cut, {});
#ifdef FIBRANT_WITH_MPI
        else
            solve<distributed::MpiExchange>(system, tolerance, cut, {});
#endif
    }
#ifdef FIBRANT_WITH_MPI
    return session.end(0);
#endif
}

// SPDX-License-Identifier: MIT
#include "distributed/exchange_contract.hpp"
#include "refusal.hpp"
#include "support/fabric_system.hpp"
#include "support/least_view.hpp"
#include "support/synthetic_system.hpp"

#include <fibrant/distributed/cut_report.hpp>
#include <fibrant/distributed/subdomain_pcg.hpp>
#include <fibrant/distributed/thread_ranks.hpp>

#if defined(_OPENMP)
#include <omp.h>
#endif

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

using namespace fibrant;

namespace subdomain_pcg_test {

const test::Fabric fabric{.bundles = 2, .fibres = 7, .elements = 16, .length = 2.2};

struct Solved {
    Vector x;
    solver::SolveReport report;
};
template <class E>
Solved solve(const test::FabricSystem& system, const distributed::Subdomains::Parameters& cut, double tolerance,
             const typename E::Parameters& exchange = {}) {
    typename distributed::SubdomainPcg<E>::Parameters parameters;
    parameters.levels.cut = cut, parameters.levels.exchange = exchange;
    distributed::SubdomainPcg<E> pcg(parameters);
    pcg.analyse(test::least(system));
    Solved solved;
    if (pcg.prepare(test::least(system)) != solver::SolveStatus::converged) return solved;
    solved.report = pcg.solve(test::least(system), test::pulled_middles(system.layout()), tolerance, solved.x);
    return solved;
}

TEST_CASE("ranks get what the others send, and their sums have one order") {
    test::check_exchange(distributed::OneRank());
    test::check_exchange(distributed::ThreadRank());
    for (const int ranks : {1, 2, 3, 4})
        distributed::run_on_threads(ranks, [](const auto& own) { test::check_exchange(distributed::ThreadRank(own)); });
}

TEST_CASE("a rank that fails ends all of them, and says why") {
    CHECK_THROWS_WITH_AS(distributed::run_on_threads(3,
                                                     [](const auto& own) {
                                                         const distributed::ThreadRank rank(own);
                                                         if (rank.rank() == 1) throw std::domain_error("no more room");
                                                         std::vector<double> all(3);
                                                         const double value = 1.0;
                                                         rank.gather({&value, 1}, std::vector<Index>(3, 1), all);
                                                     }),
                         "no more room", std::domain_error);
}

TEST_CASE("parts share the work evenly, and every node has one owner, who works on it or joins it to another part") {
    const test::FabricSystem system(fabric);
    const scene::DofLayout& layout = system.layout();
    for (const int parts : {1, 7, 32}) {
        const distributed::Subdomains cut(system, {.parts = parts});
        CHECK(cut.parts() == parts);
        std::vector<int> owners(core::at(layout.vectors()), 0);
        for (const auto& own : cut.owned())
            for (const Index v : own) ++owners[core::at(v)];
        CHECK(std::all_of(owners.begin(), owners.end(), [](int n) { return n == 1; }));
        const std::vector<Index> work = cut.work();
        CHECK(10 * *std::max_element(work.begin(), work.end()) <= 13 * *std::min_element(work.begin(), work.end()));
        std::vector<int> worked_on(core::at(layout.vectors()), 0);
        for (const distributed::Piece& piece : cut.pieces()) {
            const scene::Chain& chain = layout.chains[core::at(piece.chain)];
            for (Index a = piece.first_node; a < piece.first_node + piece.nodes; ++a) {
                const Index v = chain.first_vector + a * chain.vectors_per_node;
                CHECK(cut.owner()[core::at(v)] == piece.part);
                ++worked_on[core::at(v)];
            }
        }
        Index joints = 0;  // once each, and what is in no piece is where two parts meet
        for (const scene::Chain& chain : layout.chains)
            for (Index a = 0; a < chain.nodes; ++a) {
                const int times = worked_on[core::at(chain.first_vector + a * chain.vectors_per_node)];
                CHECK(times <= 1);
                joints += times == 0;
            }
        CHECK(joints == cut.cut_elements(layout));
        const distributed::CutReport report = distributed::report_cut(system, cut);
        CHECK(report.terms == system.contacts());
        CHECK((parts > 1) == (report.cut_terms > 0));
        CHECK((parts > 1) == (report.most_neighbours > 0));
    }
    CHECK(distributed::Subdomains(test::FabricSystem({.bundles = 1, .parallel = true, .fibres = 2, .elements = 3}), {4096})
              .parts() == 6);  // no more than there are elements
}

TEST_CASE("the bits of a solution depend on the subdomains, not on ranks or threads") {
    const test::FabricSystem system(fabric);
    const distributed::Subdomains::Parameters cut{.parts = 8};
    const Solved alone = solve<distributed::OneRank>(system, cut, 1e-6);
    REQUIRE(alone.report.status == solver::SolveStatus::converged);
    for (const int ranks : {1, 2, 3, 4}) {
        distributed::run_on_threads(ranks, [&](const auto& own) {
#if defined(_OPENMP)
            omp_set_num_threads(own.rank % 2 + 1);
#endif
            const Solved shared = solve<distributed::ThreadRank>(system, cut, 1e-6, own);
            CHECK(shared.x == alone.x);
            CHECK(shared.report.iterations == alone.report.iterations);
            CHECK(shared.report.curvature == alone.report.curvature);
        });
    }
    CHECK(solve<distributed::OneRank>(system, {.parts = 9}, 1e-6).x != alone.x);
}

TEST_CASE("the solution is that of the whole system, however many subdomains, with less than twice the iterations") {
    const test::FabricSystem system(fabric);
    const Vector b = test::pulled_middles(system.layout());
    Vector left(b.size());
    int whole = 0;
    for (const int parts : {1, 4, 32}) {
        const Solved solved = solve<distributed::OneRank>(system, {.parts = parts}, 1e-8);
        REQUIRE(solved.report.status == solver::SolveStatus::converged);
        system.apply(solved.x, left);
        left = b - left;
        CHECK(solver::scaled_norm(system.layout(), left) <= 1.001e-8 * solver::scaled_norm(system.layout(), b));
        if (parts == 1) whole = solved.report.iterations;
        CHECK(solved.report.iterations < 2 * whole);  // 1.74 times at most; what is added up and not swept costs twice at worst
    }
}

TEST_CASE("where nothing touches fibres are solved exactly, however often they are cut") {
    test::Fabric apart = fabric;
    apart.active = 0.0;
    const test::FabricSystem system(apart);
    for (const int parts : {1, 5, 150}) {
        const Solved solved = solve<distributed::OneRank>(system, {.parts = parts}, 1e-8);
        CHECK(solved.report.status == solver::SolveStatus::converged);
        CHECK(solved.report.iterations <= 3);  // factors are floats: each iteration gives five digits or more
    }
}

/// Chains that touch each other and themselves, and places that slide: stiffness of rank two that reaches over four nodes of each
/// of two chains, which is beyond what their bands hold. Means of five vectors are tied, of which some move together against a
/// spring.
test::SyntheticSystem coupled_chains(unsigned seed) {
    test::SyntheticSystem system =
        test::random_system({.chains = std::vector<scene::Chain>(12, {.nodes = 9, .vectors_per_node = 3, .reach = 2}),
                             .points = 30,
                             .held = 9,
                             .ties = 3,
                             .seed = seed});
    for (Index k = 0; k < 8; ++k) {
        test::SyntheticSystem::Dense slide;
        for (const Index c : {k, k + 1 + k % 3})
            for (Index node = 0; node < 4; ++node)
                slide.vectors.push_back(system.layout().chains[core::at(c)].first_vector + 3 * ((2 * k) % 6 + node));
        const Index size = 3 * core::count(slide.vectors);
        Matrix rows(2, size);
        for (Index j = 0; j < rows.size(); ++j) rows.data()[j] = 0.001 * static_cast<double>((7919 * (j + 31 * k)) % 2000) - 1.0;
        slide.stiffness = 3.0 * rows.transpose() * rows;
        system.dense.push_back(std::move(slide));
    }
    system.description.motions.front().stiffness = Matrix::Constant(1, 1, 40.0);
    for (scene::Tie& tie : system.description.ties) tie.support = 3.0;
    system.finish();
    return system;
}

/// The system whose bands have springs in the place of its ties, as those of beams do.
struct Supported {
    const test::SyntheticSystem* of;
    const scene::DofLayout& layout() const { return of->layout(); }
    void apply(const Vector& x, Vector& y) const { of->apply(x, y); }
    void chain_band(Index c, Matrix& blocks) const {
        of->chain_band(c, blocks);
        const scene::Chain& chain = layout().chains[core::at(c)];
        for (const scene::Tie& tie : layout().ties)
            for (const Index v : tie.vectors) {
                const Index own = v - chain.first_vector, per_node = chain.vectors_per_node;
                if (own < 0 || own >= chain.nodes * per_node) continue;
                const double length = layout().length[core::at(v)];
                blocks.block<3, 3>(3 * own, 3 * (own % per_node)).diagonal().array() += tie.support * length * length;
            }
    }
    void node_blocks(Index c, Matrix& blocks) const {
        chain_band(c, blocks);
        blocks = blocks.leftCols(3 * layout().chains[core::at(c)].vectors_per_node).eval();
    }
    template <class Visitor>
    void visit(Visitor& visitor) const {
        of->visit(visitor);
    }
};

TEST_CASE("chains that touch themselves, places that slide, vectors that are held and averages: on any number of ranks") {
    Index on_themselves = 0;
    for (const unsigned seed : {1u, 2u, 3u}) {
        const test::SyntheticSystem synthetic = coupled_chains(seed);
        const Supported system{&synthetic};
        const assembly::VectorPlaces places(system.layout());
        on_themselves += std::count_if(synthetic.points.begin(), synthetic.points.end(), [&](const auto& point) {
            return places.chain(point.vectors.front()) == places.chain(point.vectors.back());
        });
        Vector b(system.layout().unknowns()), left(b.size());
        for (Index k = 0; k < b.size(); ++k) b[k] = 0.001 * static_cast<double>((7919 * k) % 1000) - 0.5;
        distributed::SubdomainPcg<> alone({.levels = {.cut = {.parts = 6}}});
        alone.analyse(test::least(system));
        alone.prepare(test::least(system));
        Vector x;
        const solver::SolveReport report = alone.solve(test::least(system), b, 1e-8, x);
        CHECK(report.status == solver::SolveStatus::converged);
        system.apply(x, left);
        Vector free = x, together = Vector::Zero(b.size());
        scene::project_free(system.layout(), free);
        scene::add_motion_stiffness(system.layout(), free, together);
        scene::project_free(system.layout(), together);
        CHECK(together.norm() > 1e-3 * b.norm());  // the spring has a part in it
        left = b - left - together;
        CHECK(solver::scaled_norm(system.layout(), left) <= 1.001e-8 * solver::scaled_norm(system.layout(), b));
        distributed::run_on_threads(3, [&](const auto& own) {
            distributed::SubdomainPcg<distributed::ThreadRank> shared({.levels = {.cut = {.parts = 6}, .exchange = own}});
            Vector same;
            shared.analyse(test::least(system));
            shared.prepare(test::least(system));
            shared.solve(test::least(system), b, 1e-8, same);
            CHECK(same == x);
        });
    }
    CHECK(on_themselves > 0);
}

/// The system with a layout of its own.
struct OtherLayout {
    scene::DofLayout own;
    const test::FabricSystem* of;
    const scene::DofLayout& layout() const { return own; }
    void apply(const Vector& x, Vector& y) const { of->apply(x, y); }
    void node_blocks(Index c, Matrix& blocks) const { of->node_blocks(c, blocks); }
    void chain_band(Index c, Matrix& blocks) const { of->chain_band(c, blocks); }
    template <class Terms>
    void visit(Terms& terms) const {
        of->visit(terms);
    }
};

TEST_CASE("what ranks cannot share yet is refused by name") {
    using Pcg = distributed::SubdomainPcg<>;
    const test::FabricSystem system(fabric);
    OtherLayout closed{system.layout(), &system};
    closed.own.chains[1].closed = true;
    CHECK(test::refusal([&] { Pcg().analyse(test::least(closed)); }).starts_with("SubdomainLevels.system"));
    closed.own = system.layout();
    closed.own.images.push_back({});
    CHECK(test::refusal([&] { Pcg().analyse(test::least(closed)); }).starts_with("SubdomainLevels.system"));
    CHECK(test::refusal([] { Pcg({.levels = {.cut = {.parts = 0}}}); }).starts_with("Subdomains.parts"));
    CHECK(test::refusal([] { Pcg({.levels = {.cut = {.parts = 4097}}}); }).starts_with("Subdomains.parts"));
}

TEST_CASE("ranks that have come to other last bits end with a message, and do not wait for each other") {
    const test::FabricSystem system(fabric);
    const Vector b = test::pulled_middles(system.layout());
    const Index last = b.size() - 1;
    for (const double factor : {1.0, 1.0 + std::numeric_limits<double>::epsilon()}) {
        const std::string message = [&]() -> std::string {
            try {
                distributed::run_on_threads(3, [&](const auto& own) {
                    Vector mine = b, x;
                    mine[last] = 0.1;
                    if (own.rank == 2) mine[last] *= factor;
                    distributed::SubdomainPcg<distributed::ThreadRank> pcg({.levels = {.cut = {.parts = 6}, .exchange = own}});
                    pcg.analyse(test::least(system));
                    pcg.prepare(test::least(system));
                    pcg.solve(test::least(system), mine, 1e-6, x);
                });
            } catch (const std::runtime_error& error) {
                return error.what();
            }
            return {};
        }();
        CHECK(message.empty() == (factor == 1.0));
        if (factor != 1.0) CHECK(message.starts_with("rank 2 has come to other last digits than rank 0"));
    }
    CHECK(distributed::fingerprint(std::vector{0.0}) != distributed::fingerprint(std::vector{-0.0}));
    CHECK(distributed::fingerprint(std::vector{1.0, 2.0}) != distributed::fingerprint(std::vector{2.0, 1.0}));
}

TEST_CASE("what is sent arrives where it is wanted, and is told in bytes") {
    distributed::run_on_threads(2, [](const auto& own) {
        const distributed::ThreadRank rank(own);
        const bool first = rank.rank() == 0;
        distributed::Traffic traffic;
        distributed::Routes routes(rank.rank(), {{0, 1, 1, 0, 3}, {1, 0, 0, 2, 2}, {0, 0, 3, 0, 1}});
        const std::vector<double> from{1.0, 2.0, 3.0, first ? 4.0 : 5.0};
        std::vector<double> to(4, 0.0);
        routes.move(rank, from, to, traffic);
        CHECK(to == (first ? std::vector<double>{4, 0, 1, 2} : std::vector<double>{2, 3, 4, 0}));
        CHECK(traffic.messages == 1);
        CHECK(traffic.bytes == (first ? 24 : 16));
        // Vector 0 is of the first rank and read by the second, vector 2 the other way round.
        distributed::Halo halo(rank.rank(), distributed::BlockRuns(2, 2), {0, 0, 1}, {{1, 0}, {0, 2}, {0, 1}});
        Vector x = Vector::Constant(9, first ? 1.0 : 2.0);
        halo.refresh(rank, x, traffic);
        CHECK(x[0] == 1.0);
        CHECK(x[8] == 2.0);
        CHECK(x[3] == (first ? 1.0 : 2.0));
        CHECK(traffic.bytes == (first ? 48 : 40));
    });
}

}  // namespace subdomain_pcg_test

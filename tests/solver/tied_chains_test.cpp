// SPDX-License-Identifier: MIT
// Ties in the preconditioner: exact for chains that nothing but ties joins, and as good as held ends for a bundle.
#include "solver/linear_solver_contract.hpp"
#include "support/fabric_system.hpp"

#include <fibrant/solver/two_level_pcg.hpp>

using namespace fibrant;

namespace tied_chains_test {

/// Bundles as a simulation has them, the ends of each tied on the mean at both ends, or each fibre held on its own.
assembly::ChainSystem<beam::DirectorBeam<>> bundles(const test::Fabric& fabric, bool tied) {
    auto system = test::chain_system(test::FabricSystem(fabric));
    scene::DofLayout& layout = system.layout();
    for (Index first = 0; first < core::count(layout.chains); first += fabric.fibres)
        for (const bool last : {false, true}) {
            scene::Tie tie;
            tie.support = fabric.young_modulus * std::numbers::pi * fabric.radius * fabric.radius / fabric.length;
            tie.first = scene::tied_scalars(layout);
            for (Index c = first; c < first + fabric.fibres; ++c) {
                const scene::Chain& chain = layout.chains[core::at(c)];
                const Index vector = chain.first_vector + (last ? 3 * (chain.nodes - 1) : 0);
                if (!tied) layout.held.push_back({vector, Mat3::Zero()});
                tie.vectors.push_back(vector), tie.weights.push_back(1.0 / std::sqrt(static_cast<double>(fabric.fibres)));
            }
            if (tied) layout.ties.push_back(tie);
        }
    std::ranges::sort(layout.held, {}, &scene::HeldVector::vector);
    system.index_points();
    return system;
}

int iterations(const assembly::ChainSystem<beam::DirectorBeam<>>& system, const Vector& load, double tolerance) {
    solver::TwoLevelPcg solver;
    Vector b = load, x;
    scene::project_free(system.layout(), b);
    solver.analyse(assembly::seen(system));
    REQUIRE(solver.prepare(assembly::seen(system)) == solver::SolveStatus::converged);
    const solver::SolveReport report = solver.solve(assembly::seen(system), b, tolerance, x);
    CHECK(report.status == solver::SolveStatus::converged);
    return report.iterations;
}

TEST_CASE("chains that nothing but ties joins are solved at once, whatever moves together with them") {
    for (const int ties : {1, 4}) {  // of four, the first two move together
        CAPTURE(ties);
        const test::SyntheticSystem system = test::random_system(
            {.chains = std::vector<scene::Chain>(6, {.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0}),
             .held = 3,
             .ties = ties,
             .seed = 8});
        const Vector b = test::random_load(system.layout(), 3);
        Vector x;
        solver::TwoLevelPcg solver;
        // One step would be exact, but for the single precision of the factors and for the coarse space.
        const solver::SolveReport report = test::solve(solver, system, b, 1e-4, x);
        CHECK(report.status == solver::SolveStatus::converged);
        CHECK(report.iterations <= 8);  // 3 and 4
    }
}

TEST_CASE("fibre ends that are tied on the mean take hardly more iterations than ends that are held one by one") {
    for (const int fibres : {7, 38}) {
        CAPTURE(fibres);
        const test::Fabric fabric{
            .bundles = 2, .parallel = true, .fibres = fibres, .elements = 16, .length = 2.2, .end_stiffness = 1e-6};
        const Vector load = test::contact_load(test::FabricSystem(fabric));
        const int held = iterations(bundles(fabric, false), load, 1e-4), tied = iterations(bundles(fabric, true), load, 1e-4);
        CAPTURE(held);
        CHECK(tied <= held + 20);  // 60 of 42, 33 of 17; 84 of 61 and 46 of 29 with the coarse space beside the sweeps, 105 of 90
                                   // and 55 of 41 without sweeps
    }
}

}  // namespace tied_chains_test

// SPDX-License-Identifier: MIT
#include "support/fabric_system.hpp"
#include "support/synthetic_system.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>

#include <doctest/doctest.h>

#include <Eigen/Cholesky>

using namespace fibrant;

namespace chain_factors_test {

template <assembly::LinearSystem System>
Vector preconditioned(const System& system, const Vector& r) {
    solver::ChainFactors factors;
    factors.analyse(system.layout());
    CHECK(factors.prepare(system) == solver::SolveStatus::converged);
    Vector z(r.size());
    factors.apply(system.layout(), r, z);
    return z;
}

TEST_CASE("factors of chains solve chains of every shape, in every lane, to the rounding of float") {
    for (const Index vectors : {1, 2, 3, 4, 5})
        for (const Index reach : {0, 1, 2, 3})
            for (const std::size_t number : {1u, 2u, 3u, 8u, 9u, 20u}) {
                const auto system = test::random_system({.chains = std::vector<scene::Chain>(number, {.nodes = 7, .vectors_per_node = vectors, .reach = reach}),
                                                         .held = 4, .radius = 0.1});
                const Vector b = test::random_load(system.layout(), 2), z = preconditioned(system, b);
                Vector r(b.size());
                system.apply(z, r);
                const Vector left = b - r;
                // Rounding of float, 6e-8, of some hundred operations, with condition numbers below 1e3.
                CHECK(solver::scaled_norm(system.layout(), left) < 1e-4 * solver::scaled_norm(system.layout(), b));
                CHECK(solver::scaled_norm(system.layout(), left) > 0.0);
            }
}

TEST_CASE("while nothing touches a few iterations solve fibres of any slenderness, held at both ends") {
    // The condition number grows to 1e11: the residual of 1e-8 is below the rounding of A x for the most slender one.
    struct Case {
        double slenderness, tolerance;
    };
    for (const Case c : {Case{20.0, 1e-8}, Case{200.0, 1e-8}, Case{1000.0, 1e-8}, Case{10000.0, 1e-5}}) {
        CAPTURE(c.slenderness);
        test::Fabric fabric{.bundles = 1, .parallel = true, .fibres = 3, .elements = 16, .radius = 0.02, .tension = 0.0, .active = 0.0};
        fabric.length = c.slenderness * fabric.radius;
        fabric.spacing = 1e3 * fabric.length;  // straight
        fabric.inertia_factor = 1.0;
        const test::FabricSystem system(fabric);
        solver::FibreBlockPcg solver;
        Vector x, b = test::random_load(system.layout(), 1);
        solver.analyse(system);
        REQUIRE(solver.prepare(system) == solver::SolveStatus::converged);
        const solver::SolveReport report = solver.solve(system, b, c.tolerance, x);
        CHECK(report.status == solver::SolveStatus::converged);
        CHECK(report.iterations <= 8);
    }
}

TEST_CASE("a chain that nothing holds is shifted a little, and does not count as indefinite") {
    // Director beams in space, without springs at their ends: six rigid motions each.
    test::Fabric fabric{.bundles = 1, .parallel = true, .fibres = 9, .elements = 8, .length = 1.0, .tension = 0.0, .active = 0.0, .end_stiffness = 0.0};
    const test::FabricSystem system(fabric);
    const Vector b = test::random_load(system.layout(), 2), z = preconditioned(system, b);
    CHECK(z.allFinite());
    CHECK(b.dot(z) > 0.0);
}

TEST_CASE("a chain with negative stiffness is told, and what stands for it is positive definite") {
    for (const double share : {1e-3, 0.1, 1.0, 10.0}) {
        auto system = test::random_system({.chains = std::vector<scene::Chain>(10, {.nodes = 7, .vectors_per_node = 3, .reach = 2}), .held = 3});
        for (const Index vector : {5, 6, 100}) {
            const double length = system.layout().length[core::at(vector)];
            system.dense.push_back({{vector}, -length * length * Mat3::Identity() * (10.0 + share)});
        }
        system.finish();
        solver::ChainFactors factors;
        factors.analyse(system.layout());
        CHECK(factors.prepare(system) == solver::SolveStatus::indefinite);
        for (const unsigned seed : {1u, 2u, 3u}) {
            const Vector b = test::random_load(system.layout(), seed);
            Vector z(b.size());
            factors.apply(system.layout(), b, z);
            CHECK(z.allFinite());
            CHECK(b.dot(z) > 0.0);
        }
    }
}

}  // namespace chain_factors_test

// SPDX-License-Identifier: MIT
#include "support/fabric_system.hpp"
#include "support/least_view.hpp"
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
                const auto system = test::random_system(
                    {.chains = std::vector<scene::Chain>(number, {.nodes = 7, .vectors_per_node = vectors, .reach = reach}),
                     .held = 4,
                     .radius = 0.1});
                const Vector b = test::random_load(system.layout(), 2), z = preconditioned(system, b);
                Vector r(b.size());
                system.apply(z, r);
                const Vector left = b - r;
                // Rounding of float, 6e-8, of some hundred operations, with condition numbers below 1e3.
                CHECK(solver::scaled_norm(system.layout(), left) < 1e-4 * solver::scaled_norm(system.layout(), b));
                CHECK(solver::scaled_norm(system.layout(), left) > 0.0);
            }
}

TEST_CASE("blocks that are nothing are not kept: middle nodes couple with their element alone, whichever lane they are in") {
    const int nodes = 9, m = 3, reach = 2, lanes = 8;
    // Bands whose odd nodes couple with the node before only; `full`: one chain that couples them over two nodes.
    const auto bands = [&](int full) {
        std::array<Matrix, core::at(lanes)> all;
        for (int lane = 0; lane < lanes; ++lane) {
            Matrix& band = all[core::at(lane)];
            band.setZero(nodes * m, (reach + 1) * m);
            for (int a = 0; a < nodes; ++a) {
                band.block(a * m, 0, m, m) = (10.0 + lane) * Mat3::Identity();
                for (int d = 1; d <= std::min(a, a % 2 == 0 || lane == full ? 2 : 1); ++d)
                    band.block(a * m, d * m, m, m) << 1, 0.5, 0.2 * a, -0.3, d, 0.1, 0.4, -0.2 * lane, 0.7;
            }
        }
        return all;
    };
    solver::BlockBandCholesky<3, lanes> factor({nodes, m, reach});
    const std::size_t block = 9 * sizeof(float) * lanes, triangle = 6 * sizeof(float) * lanes;
    for (const int full : {-1, 5, -1}) {  // and back again
        const auto all = bands(full);
        for (const bool accepted : factor.factor(all, 1e-12)) CHECK(accepted);
        CHECK(factor.bytes() == nodes * triangle + (full < 0 ? 4 + 8 : 7 + 8) * block);
        std::vector<Eigen::Array<float, lanes, 1>> x(core::at(nodes * m));
        for (int k = 0; k < nodes * m; ++k) x[core::at(k)] = static_cast<float>(k % 5 - 1);
        factor.solve(x.data());
        for (int lane = 0; lane < lanes; ++lane) {
            Matrix dense = Matrix::Zero(nodes * m, nodes * m);
            for (int a = 0; a < nodes; ++a)
                for (int d = 0; d <= std::min(a, reach); ++d) {
                    dense.block(a * m, (a - d) * m, m, m) = all[core::at(lane)].block(a * m, d * m, m, m);
                    dense.block((a - d) * m, a * m, m, m) = dense.block(a * m, (a - d) * m, m, m).transpose().eval();
                }
            Vector b(nodes * m), z(nodes * m);
            for (int k = 0; k < nodes * m; ++k) b[k] = k % 5 - 1, z[k] = static_cast<double>(x[core::at(k)][lane]);
            CHECK((dense * z - b).norm() < 1e-5 * b.norm());  // rounding of float; the condition number is below 10
        }
    }
}

TEST_CASE("while nothing touches a few iterations solve fibres of any slenderness, held at both ends") {
    // The condition number grows to 1e11: the residual of 1e-8 is below the rounding of A x for the most slender one.
    struct Case {
        double slenderness, tolerance;
    };
    for (const Case c : {Case{20.0, 1e-8}, Case{200.0, 1e-8}, Case{1000.0, 1e-8}, Case{10000.0, 1e-5}}) {
        CAPTURE(c.slenderness);
        test::Fabric fabric{
            .bundles = 1, .parallel = true, .fibres = 3, .elements = 16, .radius = 0.02, .tension = 0.0, .active = 0.0};
        fabric.length = c.slenderness * fabric.radius;
        fabric.spacing = 1e3 * fabric.length;  // straight
        fabric.inertia_factor = 1.0;
        const test::FabricSystem system(fabric);
        solver::FibreBlockPcg solver;
        Vector x, b = test::random_load(system.layout(), 1);
        solver.analyse(test::least(system));
        REQUIRE(solver.prepare(test::least(system)) == solver::SolveStatus::converged);
        const solver::SolveReport report = solver.solve(test::least(system), b, c.tolerance, x);
        CHECK(report.status == solver::SolveStatus::converged);
        CHECK(report.iterations <= 8);
    }
}

TEST_CASE("a chain that nothing holds is shifted a little, and does not count as indefinite") {
    // Director beams in space, without springs at their ends: six rigid motions each.
    test::Fabric fabric{.bundles = 1,
                        .parallel = true,
                        .fibres = 9,
                        .elements = 8,
                        .length = 1.0,
                        .tension = 0.0,
                        .active = 0.0,
                        .end_stiffness = 0.0};
    const test::FabricSystem system(fabric);
    const Vector b = test::random_load(system.layout(), 2), z = preconditioned(system, b);
    CHECK(z.allFinite());
    CHECK(b.dot(z) > 0.0);
}

TEST_CASE("a chain with negative stiffness is told, and what stands for it is positive definite") {
    for (const double share : {1e-3, 0.1, 1.0, 10.0}) {
        auto system = test::random_system(
            {.chains = std::vector<scene::Chain>(10, {.nodes = 7, .vectors_per_node = 3, .reach = 2}), .held = 3});
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

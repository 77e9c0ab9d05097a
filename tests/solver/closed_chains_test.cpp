// SPDX-License-Identifier: MIT
// The system of closed chains: its blocks go around, and factors of chains solve it.
#include <fibrant/assembly/chain_system.hpp>
#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

using namespace fibrant;

namespace closed_chains_test {

/// Rings of a few sizes, the first ones as many as share a pack; some vectors are held, on first and last nodes too.
template <beam::BeamElement B>
assembly::ChainSystem<B> rings(Index count, bool held) {
    scene::Assembly scene;
    for (Index k = 0; k < count; ++k) {
        const Vec3 middle(3.0 * static_cast<double>(k), 0, 0);
        scene.add({.curve =
                       [middle](double t) {
                           return Vec3(middle + Vec3(std::cos(2 * std::numbers::pi * t), std::sin(2 * std::numbers::pi * t), 0));
                       },
                   .section = scene::circular(0.05),
                   .material = {.young_modulus = 1e4, .poisson_ratio = 0.3},
                   .elements = k < 6 ? 12 : 9,
                   .closed = true});
    }
    const B beam{typename B::Parameters{}};
    const beam::Mesh<B> mesh(scene, beam);
    assembly::ChainSystem<B> system(mesh);
    for (Index f = 0; f < count; ++f)
        for (Index e = 0; e < mesh.fibre(f).elements; ++e)
            system.add(f, e, beam.tangent_stiffness(mesh.rest(f, e), mesh.element(mesh.rest_state(), f, e)));
    auto& list = system.layout().held;
    for (Index f = 0; f < count; ++f) {
        const Index first = mesh.node_vector(f, 0), last = mesh.node_vector(f, mesh.own_nodes(f) - 1);
        if (held) list.push_back({first, f % 2 == 0 ? Mat3(Mat3::Zero()) : Mat3(Vec3(1, 0, 0).asDiagonal())});
        if (held) list.push_back({last, Mat3(Vec3(0, 0, 1).asDiagonal())});
        for (Index v = 0; v < B::vectors_per_node; ++v)
            list.push_back({mesh.fibre(f).first_vector + mesh.own_nodes(f) * B::vectors_per_node + v, Mat3::Zero()});
    }
    for (Index v = 0; v < system.layout().vectors(); ++v)  // so that nothing floats
        system.add_diagonal(v, (held ? 0.01 : 0.1) * std::pow(system.layout().length[core::at(v)], 2) * Mat3::Identity());
    system.index_points();
    return system;
}

Vector random(Index size, unsigned seed) {
    std::mt19937 generator(seed);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    Vector x(size);
    for (double& value : x) value = uniform(generator);
    return x;
}

TEST_CASE_TEMPLATE("products of a closed chain are those of its assembled matrix, which is symmetric and goes around", B,
                   beam::DirectorBeam<3>, beam::RigidSectionRod) {
    const auto system = rings<B>(2, true);
    SparseMatrix a;
    assembly::assemble_from_terms(system, a);
    const Matrix dense = a;
    CHECK((dense - dense.transpose()).cwiseAbs().maxCoeff() < 1e-12 * dense.cwiseAbs().maxCoeff());
    Vector x = random(system.layout().unknowns(), 3), y(x.size());
    system.apply(x, y);
    CHECK((y - dense * x).norm() < 1e-12 * y.norm());
}

TEST_CASE_TEMPLATE("factors of chains solve closed ones, in every lane", B, beam::DirectorBeam<3>, beam::RigidSectionRod) {
    for (const bool held : {true, false})
        for (const Index count : {1, 2, 9}) {
            const auto system = rings<B>(count, held);
            solver::FibreBlockPcg blocks;
            solver::TwoLevelPcg levels;
            Vector b = random(system.layout().unknowns(), 5), x;
            scene::project_free(system.layout(), b);
            const auto iterations = [&](auto& strategy) {
                strategy.analyse(assembly::seen(system));
                REQUIRE(strategy.prepare(assembly::seen(system)) == solver::SolveStatus::converged);
                const solver::SolveReport report = strategy.solve(assembly::seen(system), b, 1e-10, x);
                CHECK(report.status == solver::SolveStatus::converged);
                Vector product(b.size());
                system.apply(x, product);
                CHECK(solver::scaled_norm(system.layout(), Vector(product - b)) <=
                      1.1e-10 * solver::scaled_norm(system.layout(), b));
                return report.iterations;
            };
            const int by_blocks = iterations(blocks), by_levels = iterations(levels);
            std::printf("%td rings, %s: %d iterations by fibre blocks, %d by two levels\n", count, held ? "held" : "springs",
                        by_blocks, by_levels);
            CHECK(by_blocks <= 8);  // what float leaves over; with the corner left out some thirty
        }
}

}  // namespace closed_chains_test

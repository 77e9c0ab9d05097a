// SPDX-License-Identifier: MIT
#include "refusal.hpp"
#include "solver/linear_solver_contract.hpp"
#include "support/fabric_system.hpp"
#include "support/synthetic_system.hpp"

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

using namespace fibrant;

namespace two_level_pcg_test {

using test::contact_load;

template <class Solver>
int iterations(Solver solver, const test::FabricSystem& system, double tolerance) {
    const Vector b = contact_load(system);
    Vector x, ax(b.size());
    solver.analyse(test::least(system));
    REQUIRE(solver.prepare(test::least(system)) == solver::SolveStatus::converged);
    const solver::SolveReport report = solver.solve(test::least(system), b, tolerance, x);
    CHECK(report.status == solver::SolveStatus::converged);
    system.apply(x, ax);
    CHECK(solver::scaled_norm(system.layout(), Vector(b - ax)) <= 1.001 * tolerance * solver::scaled_norm(system.layout(), b));
    return report.iterations;
}

const test::Fabric bundle{.bundles = 1, .parallel = true, .fibres = 38, .elements = 16, .length = 2.2};

TEST_CASE("the coarse space takes the bending of a bundle: several times fewer iterations than fibres alone") {
    const test::FabricSystem system(bundle);
    const int two = iterations(solver::TwoLevelPcg{}, system, 1e-4);
    const int one = iterations(solver::FibreBlockPcg{}, system, 1e-4);
    CHECK(two <= 60);  // about 45 are expected of any number of fibres, a third more is allowed for
    CHECK(one >= 3 * two);
}

TEST_CASE("more fibres do not take more iterations, crossing bundles neither") {
    test::Fabric larger = bundle, crossing = bundle;
    larger.fibres = 76;
    crossing.parallel = false;
    const int base = iterations(solver::TwoLevelPcg{}, test::FabricSystem(bundle), 1e-4);
    CHECK(iterations(solver::TwoLevelPcg{}, test::FabricSystem(larger), 1e-4) <= base * 3 / 2);
    CHECK(iterations(solver::TwoLevelPcg{}, test::FabricSystem(crossing), 1e-4) <= base * 3 / 2);
}

TEST_CASE("neighbours are found without groups, and fibres that are shifted along themselves do no harm") {
    test::Fabric lone = bundle, shifted = bundle;
    lone.grouped = false;
    shifted.misalignment = 1.0;
    const int base = iterations(solver::TwoLevelPcg{}, test::FabricSystem(bundle), 1e-4);
    CHECK(iterations(solver::TwoLevelPcg{}, test::FabricSystem(lone), 1e-4) == base);
    CHECK(iterations(solver::TwoLevelPcg{}, test::FabricSystem(shifted), 1e-4) <= base * 4 / 3);  // 21 of 16
}

TEST_CASE("contact a hundred times stiffer is still solved, and agrees with the direct solution") {
    test::Fabric stiff = bundle;
    stiff.contact_stiffness *= 100.0;
    stiff.fibres = 19;
    const test::FabricSystem system(stiff);
    CHECK(iterations(solver::TwoLevelPcg{}, system, 1e-4) <= 150);
    const Vector b = contact_load(system);
    Vector x, y;
    solver::TwoLevelPcg two;
    solver::DoubleBlockCholesky direct;
    two.analyse(test::least(system)), direct.analyse(test::least(system));
    two.prepare(test::least(system)), direct.prepare(test::least(system));
    two.solve(test::least(system), b, 1e-9, x), direct.solve(test::least(system), b, 1e-12, y);
    Vector energy(b.size()), error = x - y;
    system.apply(error, energy);
    // The documented experience: residual and energy-norm error agree within a factor of two; ten are allowed.
    CHECK(std::sqrt(error.dot(energy)) < 1e-8 * std::sqrt(b.dot(y)));
}

TEST_CASE("a cycle of two levels is symmetric, as conjugate gradients need it, where contact is beside held vectors too") {
    const auto system =
        test::random_system({.chains = std::vector<scene::Chain>(24, {.nodes = 5, .vectors_per_node = 3, .reach = 4}),
                             .points = 40,
                             .held = 12,
                             .radius = 0.1});
    solver::TwoLevelPcg two{{.fibres_per_cluster = 4, .elements_per_station = 1}};
    two.analyse(test::least(system));
    REQUIRE(two.prepare(test::least(system)) == solver::SolveStatus::converged);
    const auto free_load = [&](unsigned seed) {
        Vector load = test::random_load(system.layout(), seed);
        scene::project_free(system.layout(), load);
        return load;
    };
    for (unsigned seed = 1; seed < 20; seed += 2) {
        const Vector a = free_load(seed), b = free_load(seed + 1);
        Vector ma(a.size()), mb(b.size());
        two.precondition(test::least(system), a, ma), two.precondition(test::least(system), b, mb);
        CHECK(std::abs(b.dot(ma) - a.dot(mb)) <
              1e-5 * std::sqrt(a.dot(ma) * b.dot(mb)));  // float, and condition numbers below 1e3
    }
}

TEST_CASE("a solve that takes long goes on with a finer space, which takes fewer iterations and is nothing to the next solve") {
    test::Fabric stiff = bundle;
    stiff.contact_stiffness *= 100.0;
    const test::FabricSystem system(stiff);
    const Vector b = contact_load(system);
    Vector first, refined, again;
    solver::TwoLevelPcg never{{.refine_after = 2000}}, late{{.refine_after = 40}};
    never.analyse(test::least(system)), late.analyse(test::least(system));
    never.prepare(test::least(system)), late.prepare(test::least(system));
    const solver::SolveReport coarse = never.solve(test::least(system), b, 1e-8, first);
    REQUIRE(coarse.iterations > 80);
    CHECK(never.fine_unknowns() == 0);
    late.solve(test::least(system), b, 1e-2, first);  // done before it comes to that
    const solver::SolveReport fine = late.solve(test::least(system), b, 1e-8, refined);
    CHECK(fine.status == solver::SolveStatus::converged);
    CHECK(fine.iterations < coarse.iterations);
    CHECK(late.fine_unknowns() > 2 * late.coarse_unknowns());
    late.solve(test::least(system), b, 1e-2, again);  // begins with the coarse space, as the first did
    CHECK(first == again);
    late.solve(test::least(system), b, 1e-8, again);
    CHECK(refined == again);
    late.prepare(test::least(system));
    CHECK(late.fine_unknowns() == 0);
}

TEST_CASE("a coarse space is kept while contacts open one by one, and formed anew where solves take longer, or at an analysis") {
    auto system = test::chain_system(test::FabricSystem(bundle));
    const Vector b = contact_load(system);
    const double tolerance = 1e-6;
    solver::TwoLevelPcg kept, fresh{{.systems_per_space = 1}};
    Vector x, ax(b.size());
    const auto solved = [&](solver::TwoLevelPcg& solver) {
        REQUIRE(solver.prepare(assembly::seen(system)) == solver::SolveStatus::converged);
        const solver::SolveReport report = solver.solve(assembly::seen(system), b, tolerance, x);
        REQUIRE(report.status == solver::SolveStatus::converged);
        system.apply(x, ax);
        CHECK(solver::scaled_norm(system.layout(), Vector(b - ax)) <=
              1.001 * tolerance * solver::scaled_norm(system.layout(), b));
        return report.iterations;
    };
    const auto every = [&](Index nth, double factor) {
        for (Index k = 0; k < core::count(system.points()); k += nth) system.points()[core::at(k)].stiffness *= factor;
    };
    kept.analyse(assembly::seen(system)), fresh.analyse(assembly::seen(system));
    const int first = solved(kept);
    CHECK(solved(fresh) == first);
    every(20, 0.99);
    const int other = solved(kept);
    CHECK(kept.spaces_formed() == 1);
    CHECK(other <= 1.3 * solved(fresh));
    CHECK(fresh.spaces_formed() == 2);
    // Contacts that are gone leave fibres held where they were: bundles bend otherwise than the space was formed for.
    every(20, 1e-3), solved(kept);
    CHECK(kept.spaces_formed() == 1);
    solved(kept);
    CHECK(kept.spaces_formed() == 2);
    kept.analyse(assembly::seen(system)), fresh.analyse(assembly::seen(system));
    solved(fresh);
    const Vector alone = x;
    solved(kept);
    CHECK(kept.spaces_formed() == 1);
    CHECK(x == alone);
}

TEST_CASE_TEMPLATE("two threads give the bits of one on systems large enough for both", Solver, solver::TwoLevelPcg,
                   solver::FibreBlockPcg, solver::FloatBlockCholesky) {
    const test::FabricSystem system(bundle);
    REQUIRE(system.layout().unknowns() > 8192);  // smaller ones stay on one thread
    const Vector b = contact_load(system);
    std::vector<Vector> x(3);
    for (std::size_t k = 0; k < 3; ++k) {
        test::with_threads(k == 1 ? 2 : 1, [&] {
            Solver solver;
            solver.analyse(test::least(system));
            solver.prepare(test::least(system));
            solver.solve(test::least(system), b, 1e-3, x[k]);
        });
    }
    CHECK(x[0] == x[1]);
    CHECK(x[0] == x[2]);
}

TEST_CASE("a tangent whose friction follows the reaction is solved by BiCGStab, as symmetric parts alone do not solve it") {
    auto system = test::chain_system(test::FabricSystem(bundle));
    const Vector b = contact_load(system);
    for (Index k = 0; k < core::count(system.points()); k += 2) {  // half of the contacts slide at a coefficient of 0.5
        const Mat3& stiffness = system.points()[core::at(k)].stiffness;
        Index axis = 0;
        stiffness.diagonal().maxCoeff(&axis);
        const Vec3 normal = stiffness.col(axis).normalized(), across = normal.unitOrthogonal();
        system.skews().push_back({static_cast<std::int32_t>(k), -0.5 * stiffness(axis, axis) * across, normal});
    }
    solver::TwoLevelPcg both, symmetric({.unsymmetric = false});
    Vector x, ax(b.size());
    const auto residual = [&](auto& solver) {
        solver.analyse(assembly::seen(system));
        REQUIRE(solver.prepare(assembly::seen(system)) == solver::SolveStatus::converged);
        const solver::SolveReport report = solver.solve(assembly::seen(system), b, 1e-6, x);
        CHECK(report.status == solver::SolveStatus::converged);
        system.apply(x, ax);
        system.apply_skews(x, ax);
        return solver::scaled_norm(system.layout(), Vector(b - ax)) / solver::scaled_norm(system.layout(), b);
    };
    CHECK(residual(both) <= 2e-6);  // the recursive residual is kept, which rounding parts from the true one
    CHECK(residual(symmetric) > 1e-2);
}

TEST_CASE("parameters of two levels that mean nothing are refused by name") {
    using Solver = solver::TwoLevelPcg;
    CHECK(test::refusal([] { Solver{{.fibres_per_cluster = 0}}; }).starts_with("TwoLevelPcg.fibres_per_cluster = 0"));
    CHECK(test::refusal([] { Solver{{.elements_per_station = 0}}; }).starts_with("TwoLevelPcg.elements_per_station = 0"));
    CHECK(test::refusal([] { Solver{{.refine_after = -1}}; }).starts_with("TwoLevelPcg.refine_after = -1"));
    CHECK(test::refusal([] { Solver{{.iteration_limit = 0}}; }).starts_with("TwoLevelPcg.iteration_limit = 0"));
    CHECK(test::refusal([] { Solver{{.systems_per_space = 0}}; }).starts_with("TwoLevelPcg.systems_per_space = 0"));
}

TEST_CASE(
    "the least curvature that conjugate gradients tell is that of their directions over what these are to the preconditioner") {
    const test::SyntheticSystem system = test::solvable_systems()[1];
    const Vector b = test::random_load(system.layout(), 2);
    const auto double_it = [](const Vector& r, Vector& z) { z = 0.5 * r; };  // of a preconditioner 2
    double least = std::numeric_limits<double>::infinity();
    for (int limit = 1; limit <= 6; ++limit) {
        solver::ConjugateGradientVectors cg;
        Vector x;
        const solver::SolveReport report = solver::conjugate_gradient(system, double_it, b, 1e-14, limit, cg, x);
        REQUIRE(report.iterations == limit);
        least = std::min(least, cg.p.dot(cg.product) / (2.0 * cg.p.squaredNorm()));
        CHECK(report.curvature == test::near(least, 1e-8));  // directions lose their right angles to rounding
    }
}

}  // namespace two_level_pcg_test

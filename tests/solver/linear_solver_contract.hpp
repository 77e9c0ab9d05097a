// SPDX-License-Identifier: MIT
#pragma once
/// @file What every linear solver owes, as functions.

#include "support/least_view.hpp"
#include "support/synthetic_system.hpp"

#include <fibrant/solver/linear_solver.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <Eigen/Cholesky>

#if defined(_OPENMP)
#include <omp.h>
#endif

#include <cmath>
#include <initializer_list>
#include <limits>
#include <vector>

namespace fibrant::test {

/// Runs `work` with a number of threads, if there are any.
template <class Work>
void with_threads([[maybe_unused]] int threads, const Work& work) {
#if defined(_OPENMP)
    const int before = omp_get_max_threads();
    omp_set_num_threads(threads);
    work();
    omp_set_num_threads(before);
#else
    work();
#endif
}

/// Systems every solver must be able to solve: several shapes of chains, free and held, apart and in contact.
inline std::vector<SyntheticSystem> solvable_systems() {
    std::vector<SyntheticSystem> systems;
    systems.push_back(random_system({.chains = {{.nodes = 9, .vectors_per_node = 3, .reach = 2}}, .held = 2}));
    systems.push_back(
        random_system({.chains = std::vector<scene::Chain>(11, {.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0}),
                       .points = 120,
                       .held = 9,
                       .seed = 2}));
    systems.push_back(random_system({.chains = {{.nodes = 7, .vectors_per_node = 3, .reach = 2},
                                                {.nodes = 12, .vectors_per_node = 2, .reach = 1},
                                                {.nodes = 12, .vectors_per_node = 1, .reach = 1},
                                                {.nodes = 9, .vectors_per_node = 1, .reach = 2},
                                                {.nodes = 3, .vectors_per_node = 4, .reach = 2},
                                                {.nodes = 1, .vectors_per_node = 3, .reach = 0}},
                                     .points = 60,
                                     .held = 5,
                                     .seed = 3}));
    systems.push_back(
        random_system({.chains = std::vector<scene::Chain>(5, {.nodes = 7, .vectors_per_node = 3, .reach = 2, .group = 0}),
                       .points = 60,
                       .held = 3,
                       .ties = 3,
                       .seed = 4}));
    return systems;
}

/// |b - A x| / |b|, each vector divided by its length; written out.
inline double residual_of(const SyntheticSystem& system, const Vector& b, const Vector& x) {
    const Vector r = b - dense_matrix(system) * x;
    double above = 0.0, below = 0.0;
    for (Index k = 0; k < b.size(); ++k) {
        const double length = system.layout().length[core::at(k / 3)];
        above += r[k] * r[k] / length / length;
        below += b[k] * b[k] / length / length;
    }
    return std::sqrt(above / below);
}

template <solver::LinearSolver<LeastView> Solver>
solver::SolveReport solve(Solver& solver, const SyntheticSystem& system, const Vector& b, double tolerance, Vector& x) {
    solver.analyse(least(system));
    solver.prepare(least(system));
    return solver.solve(least(system), b, tolerance, x);
}

template <solver::LinearSolver<LeastView> Solver>
void check_reaches_solution(Solver solver) {
    for (const SyntheticSystem& system : solvable_systems()) {
        const Matrix a = dense_matrix(system);
        const Vector b = random_load(system.layout(), 7);
        const Vector exact = a.llt().solve(b);
        for (const double tolerance : {1e-2, 1e-6, 1e-10}) {
            CAPTURE(tolerance);
            Vector x = Vector::Constant(3, 1e30);  // neither size nor content of x matters
            solver.analyse(least(system));
            REQUIRE(solver.prepare(least(system)) == solver::SolveStatus::converged);
            const solver::SolveReport report = solver.solve(least(system), b, tolerance, x);
            REQUIRE(report.status == solver::SolveStatus::converged);
            REQUIRE(x.size() == b.size());
            CHECK(report.residual <= tolerance);
            // The report's residual is that of x, to the rounding of A x.
            const double residual = residual_of(system, b, x);
            CHECK(std::abs(report.residual - residual) <= 1e-2 * residual + 1e-13);
            // |x - x*|_A = |r|_A^-1 <= |r| / sqrt(least eigenvalue): these matrices have condition numbers below 1e8
            // once scaled, so 1e4 is no less than the square root.
            const Vector error = x - exact;
            CHECK(std::sqrt(error.dot(a * error)) < 1e4 * tolerance * std::sqrt(exact.dot(b)));
            CHECK(report.curvature > 0.0);
        }
        Vector x;
        const solver::SolveReport nothing = solver.solve(least(system), Vector::Zero(b.size()), 1e-6, x);
        CHECK(nothing.status == solver::SolveStatus::converged);
        CHECK(nothing.residual == 0.0);
        CHECK(x.norm() == 0.0);
        CHECK(x.size() == b.size());
    }
}

/// Held components of x are those of b, over the stiffness that A has there.
template <solver::LinearSolver<LeastView> Solver>
void check_held(Solver solver) {
    for (const SyntheticSystem& system : solvable_systems()) {
        const Vector b = random_load(system.layout(), 5);
        Vector x;
        solve(solver, system, b, 1e-3, x);
        for (const scene::HeldVector& held : system.layout().held) {
            const Vec3 difference =
                x.segment<3>(3 * held.vector) - b.segment<3>(3 * held.vector) / system.layout().held_stiffness(held.vector);
            // To the rounding of a projection of x, or of a factor that mixes its components.
            CHECK((difference - held.free * difference).norm() <= 1e-13 * x.segment<3>(3 * held.vector).norm());
        }
    }
}

template <solver::LinearSolver<LeastView> Solver>
void check_indefinite(Solver solver) {
    // A compressed chain among sound ones, a system that is negative altogether, and one where only the coupling is wrong.
    const std::vector<scene::Chain> chains(3, {.nodes = 9, .vectors_per_node = 3, .reach = 2, .group = 0});
    std::vector<SyntheticSystem> systems;
    systems.push_back(random_system({.chains = chains, .points = 30, .held = 3}));
    for (std::size_t k = 0; k < 4; ++k) systems.back().dense[k].stiffness *= -1.0;
    systems.push_back(random_system({.chains = chains, .points = 30, .held = 3, .curvature = -1.0}));
    systems.push_back(random_system({.chains = chains, .curvature = -1.0}));  // nothing held: descent is all there is
    systems.push_back(random_system({.chains = chains, .points = 30, .held = 3}));
    for (auto& point : systems.back().points) point.stiffness *= -0.5;
    systems.push_back(random_system({.chains = chains, .held = 3}));
    systems.back().points.push_back({{3, 40}, {1.0, 1.0}, 1e3 * Mat3::Identity()});
    systems.back().points.push_back({{3}, {1.0}, -1e3 * Mat3::Identity()});
    systems.back().points.push_back({{40}, {1.0}, -1e3 * Mat3::Identity()});
    for (SyntheticSystem& system : systems) {
        system.finish();
        REQUIRE(Eigen::LDLT<Matrix>(dense_matrix(system)).vectorD().minCoeff() < 0.0);
        for (const unsigned seed : {1u, 2u, 3u}) {
            const Vector b = random_load(system.layout(), seed);
            Vector x;
            solver.analyse(least(system));
            CHECK(solver.prepare(least(system)) != solver::SolveStatus::not_finite);
            const solver::SolveReport report = solver.solve(least(system), b, 1e-10, x);
            CHECK(report.status == solver::SolveStatus::indefinite);
            CHECK(report.curvature <= 0.0);
            REQUIRE(x.allFinite());
            CHECK(b.dot(x) > 0.0);
            CHECK(report.residual == test::near(residual_of(system, b, x), 1e-6));
        }
    }
}

template <solver::LinearSolver<LeastView> Solver>
void check_not_finite(Solver solver) {
    SyntheticSystem system = solvable_systems()[1];
    Vector b = random_load(system.layout(), 1), x;
    b[5] = std::numeric_limits<double>::quiet_NaN();
    CHECK(solve(solver, system, b, 1e-6, x).status == solver::SolveStatus::not_finite);
    CHECK(x.allFinite());
    b[5] = 1.0;
    system.dense[2].stiffness(1, 1) = std::numeric_limits<double>::infinity();
    system.finish();
    solver.analyse(least(system));
    CHECK(solver.prepare(least(system)) == solver::SolveStatus::not_finite);
    CHECK(solver.solve(least(system), b, 1e-6, x).status == solver::SolveStatus::not_finite);
    CHECK(x.allFinite());
}

template <solver::LinearSolver<LeastView> Solver>
void check_same_bits(const Solver& solver) {
    const std::vector<SyntheticSystem> systems = solvable_systems();
    const SyntheticSystem& system = systems[1];
    const Vector b = random_load(system.layout(), 4);
    Vector one, two, after, again;
    Solver fresh = solver, used = solver;
    with_threads(1, [&] { solve(fresh, system, b, 1e-8, one); });
    with_threads(2, [&] { solve(fresh, system, b, 1e-8, two); });
    solve(used, systems[2], random_load(systems[2].layout(), 4), 1e-8, after);
    solve(used, system, b, 1e-8, after);
    used.solve(least(system), 2.0 * b, 1e-8, again);
    used.solve(least(system), b, 1e-8, again);
    CHECK(one == two);
    CHECK(one == after);
    CHECK(one == again);
    Solver copy = used;  // a copy analyses for itself
    solve(copy, system, b, 1e-8, again);
    CHECK(one == again);
}

/// Contact elements come to carry force, or cease to, between two preparations.
template <solver::LinearSolver<LeastView> Solver>
void check_changed_terms(Solver solver) {
    const SyntheticSystem all = solvable_systems()[1];
    SyntheticSystem few = all;
    few.points.resize(few.points.size() / 4);
    few.finish();
    solver.analyse(least(few));
    const Vector b = random_load(all.layout(), 2);
    for (const SyntheticSystem* system : std::initializer_list<const SyntheticSystem*>{&few, &all, &few}) {
        Vector x;
        CHECK(solver.prepare(least(*system)) == solver::SolveStatus::converged);
        CHECK(solver.solve(least(*system), b, 1e-8, x).status == solver::SolveStatus::converged);
        CHECK(residual_of(*system, b, x) < 2e-8);
    }
}

/// All that a linear solver owes.
template <solver::LinearSolver<LeastView> Solver>
void check_linear_solver(const Solver& solver) {
    check_reaches_solution(solver);
    check_held(solver);
    check_indefinite(solver);
    check_not_finite(solver);
    check_changed_terms(solver);
    check_same_bits(solver);
}

}  // namespace fibrant::test

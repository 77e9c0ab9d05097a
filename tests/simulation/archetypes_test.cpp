// SPDX-License-Identifier: MIT
// The least type of each contract, which has nothing that the contract does not ask for: generic code compiles and runs
// with it, so it uses nothing more either.
#include <near.hpp>
#include <refusal.hpp>
#include <support/synthetic_system.hpp>

#include <fibrant/assembly/term_assembly.hpp>
#include <fibrant/observe/observer.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace archetypes_test {

/// A bar of two nodes with Green-Lagrange strain and no other unknowns than positions.
struct LeastBeam {
    using Parameters = core::NoParameters;
    static constexpr int nodes = 2, vectors_per_node = 1, dofs_per_node = 3, reach = 1;
    static constexpr std::array<scene::VectorKind, 1> kinds{scene::VectorKind::position};
    struct Rest {
        double stiffness, length;  // E A, L
    };
    struct Stresses {
        double force = 0.0;
    };
    using V = Eigen::Matrix<double, 6, 1>;
    using K = Eigen::Matrix<double, 6, 6>;
    using W = std::array<double, 2>;

    explicit LeastBeam(const Parameters&) {}
    static std::array<Vec3, 1> nodal_vectors(const scene::NodeFrame& frame) { return {frame.position}; }
    static Vec3 axis(const V& y) { return y.tail<3>() - y.head<3>(); }
    static double strain(const Rest& rest, const V& y) {
        return 0.5 * (axis(y).squaredNorm() / (rest.length * rest.length) - 1.0);
    }
    Rest rest(const scene::CrossSection& section, const scene::ElasticMaterial& material, const V& y) const {
        return {material.young_modulus * section.area(), axis(y).norm()};
    }
    double energy(const Rest& rest, const V& y) const {
        return 0.5 * rest.stiffness * rest.length * strain(rest, y) * strain(rest, y);
    }
    V internal_force(const Rest& rest, const V& y) const {
        const Vec3 f = rest.stiffness * strain(rest, y) / rest.length * axis(y);
        V force;
        force << -f, f;
        return force;
    }
    K tangent_stiffness(const Rest& rest, const V& y) const { return tangent_stiffness(rest, y, stresses(rest, y)); }
    K tangent_stiffness(const Rest& rest, const V& y, const Stresses& geometric) const {
        const Mat3 k = rest.stiffness / std::pow(rest.length, 3) * axis(y) * axis(y).transpose() +
                       geometric.force / rest.length * Mat3::Identity();
        K all;
        all << k, -k, -k, k;
        return all;
    }
    void residual_and_tangent(const Rest& rest, const V& y, const Stresses& geometric, V& force, K& tangent) const {
        force = internal_force(rest, y), tangent = tangent_stiffness(rest, y, geometric);
    }
    Stresses stresses(const Rest& rest, const V& y) const { return {rest.stiffness * strain(rest, y)}; }
    Stresses predicted_stresses(const Rest& rest, const V& y, const V& step) const {
        return {rest.stiffness * (strain(rest, y) + axis(y).dot(axis(step)) / (rest.length * rest.length))};
    }
    static Stresses without_compression(const Stresses& s) { return {std::max(0.0, s.force)}; }
    static W shape(double xi) { return {0.5 - 0.5 * xi, 0.5 + 0.5 * xi}; }
    static W shape_derivative(double) { return {-0.5, 0.5}; }
    static W centreline_weights(double xi) { return shape(xi); }
    static W centreline_derivative_weights(double xi) { return shape_derivative(xi); }
    static W particle_weights(double xi, double, double) { return shape(xi); }
};

struct LeastSearch {
    using Parameters = core::NoParameters;
    explicit LeastSearch(const Parameters&) {}
    std::vector<proximity::ProximityZone> find(std::span<const proximity::Centreline> fibres, double reach) {
        proximity::ProximityZone all;  // the first two fibres along their first segments, if they are close there
        all.fibre_i = 0, all.fibre_j = 1, all.b_i = all.b_j = 1.0, all.closest_i = all.closest_j = 0.5;
        if (fibres.size() < 2) return {};
        all.distance = (fibres[0].points[0] - fibres[1].points[0]).norm();
        return all.distance < fibres[0].radius + fibres[1].radius + reach ? std::vector{all}
                                                                          : std::vector<proximity::ProximityZone>{};
    }
    std::vector<proximity::SegmentPair> pairs(std::span<const proximity::Centreline>, double) { return {}; }
};

struct LeastNormal {
    using Parameters = core::NoParameters;
    explicit LeastNormal(const Parameters&) {}
    law::NormalResponse response(double gap, double stiffness) const {
        return gap < 0.0 ? law::NormalResponse{-stiffness * gap, -stiffness} : law::NormalResponse{0.0, 0.0};
    }
    double energy(double gap, double stiffness) const { return gap < 0.0 ? 0.5 * stiffness * gap * gap : 0.0; }
};

/// Active, and never resists.
struct LeastFriction {
    using Parameters = core::NoParameters;
    struct History {
        Vec3 reversible = Vec3::Zero();
    };
    explicit LeastFriction(const Parameters&) {}
    law::FrictionResponse<History> response(const Vec3&, double, const History&) const { return {}; }
};

/// Conjugate gradients without a preconditioner: a product is all that it needs.
struct LeastSolver {
    using Parameters = core::NoParameters;
    explicit LeastSolver(const Parameters&) {}
    template <assembly::LinearSystem T>
    void analyse(const T&) {}
    template <assembly::LinearSystem T>
    solver::SolveStatus prepare(const T&) {
        return solver::SolveStatus::converged;
    }
    template <assembly::LinearSystem T>
    solver::SolveReport solve(const T& system, const Vector& b, double tolerance, Vector& x) {
        Vector r = b, p = b, q(b.size());
        x.setZero(b.size());
        solver::SolveReport report{solver::SolveStatus::converged, 0, 0.0, 1.0};
        for (double old = r.squaredNorm(), first = old; old > tolerance * tolerance * first; ++report.iterations) {
            system.apply(p, q);
            const double alpha = old / p.dot(q);
            x += alpha * p, r -= alpha * q;
            const double now = r.squaredNorm();
            p = (r + now / old * p).eval(), old = now;
        }
        return report;
    }
};

struct LeastObserver {
    Index increments = 0;
    void accepted(const observe::Snapshot& snapshot) { increments = snapshot.increment; }
};
static_assert(observe::Observer<LeastObserver>);

struct LeastModel {
    using Beam = LeastBeam;
    using Proximity = LeastSearch;
    using Normal = LeastNormal;
    using Friction = LeastFriction;
    using Solver = LeastSolver;
};
static_assert(simulation::Model<LeastModel>);

/// The first increment is as it is said, all others are a quarter of that.
struct LeastSteps {
    void give_way(simulation::Position& position, const auto&, const std::vector<double>&, double, Index) const {
        position.fraction *= 0.5;
    }
    void grow(simulation::Position& position, const auto&, const simulation::IncrementReport&, double, double) const {
        position.fraction = 0.25;
    }
    void adapt_damping(simulation::Position&, const auto&, const simulation::IncrementReport&, double) const {}
};
struct WithDirect : LeastModel {
    using Solver = solver::SparseCholesky;
    using Steps = LeastSteps;
};
struct WithBlocks : LeastModel {
    using Solver = solver::FibreBlockPcg;
};

/// Bars along x at the height z, held on their axis.
Index add_bar(scene::Assembly& assembly, double z) {
    const Index bar = assembly.add(
        {.from = {0, 0, z}, .to = {2, 0, z}, .section = scene::circular(0.1), .material = {1000.0, 0.3}, .elements = 4});
    for (int node = 0; node <= 4; ++node) {
        const Vec3 held = node == 0 ? Vec3(1, 1, 1) : Vec3(0, 1, 1);
        assembly.hold_position({bar, 0.25 * node}, held.asDiagonal());
    }
    return bar;
}

simulation::ModelParameters<LeastModel> parameters() {
    simulation::ModelParameters<LeastModel> all;
    all.contact.stiffness.allowed_penetration = 1e-3;
    all.iteration.step_tolerance = 1e-9, all.iteration.residual_tolerance = 1e-9;
    return all;
}

TEST_CASE("the least model stretches two bars by the closed form") {
    scene::Assembly assembly;
    const Index lower = add_bar(assembly, 0.0), upper = add_bar(assembly, 0.05);
    const double stretch = 1.1, area = std::numbers::pi * 0.01;
    const double force = 1000.0 * area * 0.5 * (stretch * stretch - 1.0) * stretch;  // N = E A (l^2 - 1) l / 2
    for (const Index bar : {lower, upper})
        assembly.apply(scene::DeadForce{scene::last_end(bar), scene::NodeVector::position, Vec3(force, 0, 0), "load"});
    simulation::Simulator<LeastModel> simulator(assembly, parameters());
    LeastObserver observer;
    const simulation::Report report = simulator.run({.increments = 2}, observer);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(observer.increments == 2);
    CHECK(report.contact.elements > 0);
    CHECK(simulator.value(scene::last_end(lower)).x() == test::near(2.0 * stretch, 1e-8));
    CHECK(simulator.value(scene::last_end(upper)).x() == test::near(2.0 * stretch, 1e-8));
    CHECK(simulator.reaction(scene::first_end(lower)).x() == test::near(-force, 1e-8));
}

TEST_CASE_TEMPLATE("other solvers work with the least beam, search and laws", M, WithDirect, WithBlocks) {
    scene::Assembly assembly;
    const Index bar = add_bar(assembly, 0.0);
    assembly.apply(scene::DeadForce{scene::last_end(bar), scene::NodeVector::position, Vec3(1.0, 0, 0), "load"});
    simulation::ModelParameters<M> all;
    all.contact.stiffness.allowed_penetration = 1e-3;
    simulation::Simulator<M> simulator(assembly, all);
    CHECK(simulator.run({.increments = 1}).converged);
    CHECK(simulator.value(scene::last_end(bar)).x() > 2.0);
}

TEST_CASE("a model's own steps say how far increments go") {
    scene::Assembly assembly;
    const Index bar = add_bar(assembly, 0.0);
    assembly.apply(scene::DeadForce{scene::last_end(bar), scene::NodeVector::position, Vec3(1.0, 0, 0), "load"});
    simulation::ModelParameters<WithDirect> all;
    all.contact.stiffness.allowed_penetration = 1e-3;
    simulation::Simulator<WithDirect> simulator(assembly, all);
    const simulation::Report report = simulator.run({.increments = 4});
    CHECK(report.converged);
    CHECK(report.increments.size() == 13);  // a quarter of the way, and twelve sixteenths
}

TEST_CASE("what a node does not have is neither held nor loaded: refused by name") {
    scene::Assembly clamped, turned, pushed;
    for (scene::Assembly* assembly : {&clamped, &turned, &pushed}) add_bar(*assembly, 0.0);
    clamped.clamp(scene::first_end(0));
    turned.apply(scene::Moment{scene::last_end(0), scene::NodeVector::director_1, Vec3(0, 1, 0), "load"});
    pushed.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::director_2, Vec3(0, 1, 0), "load"});
    const auto refused = [](const scene::Assembly& assembly) {
        return test::refusal([&] { simulation::Simulator<LeastModel>(assembly, parameters()); });
    };
    CHECK(refused(clamped).starts_with("Hold.vector = 1, but it must be a vector of the beam's nodes (fibre 0, node 0 at ("));
    CHECK(refused(turned) == "load.vector = 1, but it must be a vector of the beam's nodes");
    CHECK(refused(pushed) == "load.vector = 2, but it must be a vector of the beam's nodes");
}

TEST_CASE("solvers and assembly take a system that has no more than its terms") {
    static_assert(assembly::LinearSystem<test::SyntheticSystem>);
    static_assert(solver::LinearSolver<LeastSolver, test::SyntheticSystem>);
    static_assert(solver::LinearSolver<solver::SparseCholesky, test::SyntheticSystem>);
    static_assert(solver::LinearSolver<solver::FibreBlockPcg, test::SyntheticSystem>);
    test::SyntheticSystem system;
    system.add_chain(2, 1, 1, -1, 1.0);
    system.dense.push_back({{0, 1}, 2.0 * Matrix::Identity(6, 6)});
    system.finish();
    LeastSolver solver{{}};
    Vector x;
    CHECK(solver.solve(system, Vector::Ones(6), 1e-12, x).iterations == 1);
    CHECK((x - 0.5 * Vector::Ones(6)).norm() < 1e-15);
}

}  // namespace archetypes_test

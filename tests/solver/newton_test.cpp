// SPDX-License-Identifier: MIT
// Newton's method alone, on energies whose minimum is known.
#include <fibrant/solver/newton.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace newton_test {

/// One node whose energy is x atan x - log(1 + x^2) / 2 in each component: convex, and its force goes to a bound as that of contacts
/// that let go. Beyond |x| = 1.3917 Newton's method goes further out with each step.
struct Bounded {
    struct System {
        scene::DofLayout own;
        const scene::DofLayout& layout() const { return own; }
        double coupling = 0.0;  // of the held node, which is the second one, to the first
        void apply_unheld(const Vector& x, Vector& y) const {
            y = x;
            if (x.size() > 3) y.head<3>() -= coupling * x.tail<3>();
        }
        Matrix row(Index, Index) const { return Matrix::Identity(3, 3); }
    };
    struct Mesh {
        Index fibre_count() const { return 0; }
        Index node_count(Index) const { return 0; }
    };
    System own{{.chains = {{.nodes = 1, .vectors_per_node = 1}}, .kind = {scene::VectorKind::position}, .value = {Vec3::Zero()}, .length = {1.0}, .held = {}, .ties = {}, .motions = {}}, 0.0};
    Mesh fibres;
    Vector stiffness;
    const System& system() const { return own; }
    const Mesh& mesh() const { return fibres; }
    void prescribed_step(const Vector& x, Vector& step) const {
        step = Vector::Zero(x.size());
        if (x.size() > 3) step[3] = 1.0 - x[3];
    }
    void linearise(const Vector& x, bool, double) { stiffness = (1.0 + x.array().square()).inverse(); }
    assembly::ResidualFigures residual(const Vector& x, Vector& r) const {
        r = x.array().atan();
        if (x.size() > 3) r.tail<3>().setZero();
        return {r.norm(), 1.0, 0.0};
    }
    void predict_stresses(const Vector&, const Vector&) {}
    void reset_stresses(const Vector&) {}
    double greatest(const Vector& step) const { return step.norm(); }
    double norm(const Vector& forces) const { return forces.norm(); }
};
struct Untouched {
    struct Element {
        Vec3 normal;
        Vec3 motion(const Vector&) const { return Vec3::Zero(); }
    };
    std::vector<Element> none;
    const std::vector<Element>& elements() const { return none; }
    bool forced(const Element&) const { return false; }
    void evaluate(const Vector&) {}
};
struct Exact {
    const Bounded* problem;
    std::vector<double> tolerances{};
    solver::SolveStatus prepare(const Bounded::System&) const { return solver::SolveStatus::converged; }
    solver::SolveReport solve(const Bounded::System&, const Vector& b, double tolerance, Vector& x) {
        tolerances.push_back(tolerance);
        x = b.cwiseQuotient(problem->stiffness);
        return {solver::SolveStatus::converged, 1, 0.0, 1.0};
    }
};

TEST_CASE("a step that ends where the energy rises is cut, and Newton's method gets to a minimum that it would leave behind") {
    for (const double overshoot : {std::numeric_limits<double>::infinity(), 0.5}) {
        CAPTURE(overshoot);
        Bounded problem;
        Untouched contacts;
        Exact linear{&problem};
        solver::IterationParameters parameters;
        parameters.mixed = false, parameters.overshoot = overshoot;
        core::StageClock clock;
        solver::Newton<Bounded, Untouched, Exact> newton(problem, contacts, linear, parameters, 1.0, clock);
        solver::IterationCounts counts;
        Vector x = Vec3(3.0, 0.5, -2.0);
        const solver::NewtonReport report = newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
        const bool cut = std::isfinite(overshoot);
        CHECK((report.status == solver::NewtonStatus::converged) == cut);
        if (cut) CHECK(x.norm() < 1e-6);  // the last step is below 1e-4, and Newton's method converges quadratically, here cubically
    }
}

TEST_CASE("what the first step of a prescribed motion may leave over is a part of the forces, not of what the motion does to an end alone") {
    Bounded problem;
    scene::DofLayout& layout = problem.own.own;
    layout.chains[0].nodes = 2;
    layout.kind.push_back(scene::VectorKind::position), layout.value.push_back(Vec3::Zero()), layout.length.push_back(1.0);
    layout.held.push_back({1, Mat3::Zero()});
    problem.own.coupling = 100.0;  // times the force that residuals are measured by
    Untouched contacts;
    Exact linear{&problem};
    solver::IterationParameters parameters;
    parameters.mixed = false, parameters.newton_limit = 2;
    core::StageClock clock;
    solver::Newton<Bounded, Untouched, Exact> newton(problem, contacts, linear, parameters, 1.0, clock);
    solver::IterationCounts counts;
    Vector x = Vector::Zero(6);
    newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
    REQUIRE(linear.tolerances.size() == 2);
    CHECK(linear.tolerances[0] * problem.own.coupling == doctest::Approx(1e-2));  // the first solution is to 1e-2
    CHECK(linear.tolerances[1] >= 1e-4);
}

}  // namespace newton_test

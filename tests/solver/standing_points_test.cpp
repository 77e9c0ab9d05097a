// SPDX-License-Identifier: MIT
// Contact points that are made anew and carry what they hold to and fro, however small the increment.
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/passage.hpp>
#include <fibrant/solver/nested_loops.hpp>

#include <near.hpp>
#include <solver/one_node.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <limits>

using namespace fibrant;

namespace standing_points_test {

/// Points that hold one node aside of where it was when they were made, to the other side each time.
struct Aside : test::Untouched {
    explicit Aside(double aside) : by{aside} {}
    double by;  // [length]
    Vec3 held = Vec3::Zero();
    int made = 0;
    contact::ContactParameters own{};
    struct Law {
        static double largest_penetration() { return 1.0; }
    };

    contact::ContactParameters& parameters() { return own; }
    void detect(const Vector& state, const Vector& accepted, double, bool) { regenerate(state, accepted); }
    void regenerate(const Vector&, const Vector&) { held = Vec3(made++ % 2 == 0 ? by : 0.0, 0.0, 0.0); }
    double refresh(const Vector&, const Vector&) const { return 0.0; }
    void hold_reactions() {}
    double misfit() const { return 0.0; }
    Law normal_law() const { return {}; }
};

/// One node on a spring to where points hold it.
struct Sprung : test::OneNode {
    explicit Sprung(const Aside& aside) : points{&aside} {}
    struct Most {
        Index chain = -1;
        double along = 0.0;
    };
    const Aside* points;

    void detect(const Vector&, const Vector&, double) {}
    double refresh(const Vector&, const Vector&, double turn) { return turn; }
    void outline(const Vector&) const {}
    void close_ties(Vector&) const {}
    void prescribed_step(const Vector& x, Vector& step) const { step = Vector::Zero(x.size()); }
    void linearise(const Vector&, bool, double) {}
    assembly::ResidualFigures residual(const Vector& x, Vector& r) const {
        r = x - points->held;
        return {r.norm(), 1.0, 0.0};
    }
    Most moves_most(const Vector&) const { return {}; }
};
struct Exact {
    void analyse(const Sprung::System&) {}
    solver::SolveStatus prepare(const Sprung::System&) const { return solver::SolveStatus::converged; }
    solver::SolveReport solve(const Sprung::System&, const Vector& b, double, Vector& x) {
        x = b;
        return {solver::SolveStatus::converged, 1, 0.0, 1.0};
    }
};

solver::AttemptReport attempt(Aside& points, Vector& state) {
    Sprung problem(points);
    Exact linear;
    contact::NoPassage passage;
    solver::IterationParameters parameters;
    parameters.mixed = false;
    core::StageClock clock;
    solver::NestedLoops<Sprung, Aside, Exact, contact::NoPassage> loops(problem, points, linear, passage, parameters, 1.0, true,
                                                                        clock);
    const Vector accepted = state;
    return loops.solve(state, accepted, 0.0, false);
}

TEST_CASE("points that carry a node to and fro stand as they were made close by, in balance, and say by how much") {
    for (const double by : {0.05, 0.1, 0.2}) {
        CAPTURE(by);
        Aside points{by};
        Vector state = Vec3::Zero();
        const solver::AttemptReport report = attempt(points, state);
        REQUIRE_MESSAGE(report.converged, report.reason);
        CHECK(points.made == 6);                     // of eight passes that there may be
        CHECK((state - points.held).norm() < 1e-3);  // radii: ten times the last step
        CHECK(report.residual < 1e-3);
        CHECK(report.use.travel == test::near(by / 0.25, 1e-2));  // of what points may stand aside by
    }
}

TEST_CASE("points that carry a node further are made anew until the attempt is given up") {
    Aside points{0.3};
    Vector state = Vec3::Zero();
    const solver::AttemptReport report = attempt(points, state);
    CHECK(!report.converged);
    CHECK(points.made > 6);
    CHECK(report.reason.find("contact passes do not settle") != std::string::npos);
}

TEST_CASE("what is accepted stands aside by no more than it may") {
    int accepted = 0, refused = 0;
    for (int k = 1; k <= 50; ++k) {
        Aside points{0.01 * k};
        Vector state = Vec3::Zero();
        const solver::AttemptReport report = attempt(points, state);
        CAPTURE(points.by);
        ++(report.converged ? accepted : refused);
        if (report.converged) CHECK(report.use.travel <= 1.0);
    }
    CHECK(accepted > 20);
    CHECK(refused > 10);
}

TEST_CASE("points that hold a node where it is are made anew in each pass") {
    Aside points{0.0};
    Vector state = Vec3::Zero();
    const solver::AttemptReport report = attempt(points, state);
    REQUIRE(report.converged);
    CHECK(points.made == 1);
    CHECK(report.use.travel < 1.0);
}

}  // namespace standing_points_test

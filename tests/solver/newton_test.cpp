// SPDX-License-Identifier: MIT
// Newton's method alone, on energies whose minimum is known.
#include <fibrant/solver/newton.hpp>

#include <near.hpp>
#include <solver/one_node.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace newton_test {

/// One node whose energy is x atan x - log(1 + x^2) / 2 in each component: convex, and its force goes to a bound as that of
/// contacts that let go. Beyond |x| = 1.3917 Newton's method goes further out with each step.
struct Bounded : test::OneNode {
    Vector stiffness;
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
};
using test::Untouched;
struct Exact {
    const Bounded* problem;
    std::vector<double> tolerances{};
    void analyse(const Bounded::System&) {}
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
        if (cut)
            CHECK(x.norm() < 1e-6);  // the last step is below 1e-4, and Newton's method converges quadratically, here cubically
    }
}

TEST_CASE(
    "a step is cut until the energy rises at its end by no more than half of the slope at which it fell, and what was "
    "cut is no end") {
    const auto solved = [](Vector& x, double tolerance, Index limit) {
        Bounded problem;
        Untouched contacts;
        Exact linear{&problem};
        solver::IterationParameters parameters;
        parameters.mixed = false, parameters.overshoot = 0.5, parameters.newton_limit = limit;
        core::StageClock clock;
        solver::Newton<Bounded, Untouched, Exact> newton(problem, contacts, linear, parameters, 1.0, clock);
        solver::IterationCounts counts;
        return newton.solve(x, tolerance, x, std::numeric_limits<double>::infinity(), counts);
    };
    // From 4 the step is 22 long, and has to be cut three times.
    Vector x = Vec3(4.0, 0.0, 0.0);
    solved(x, 1e-4, 1);
    const double step = x[0] - 4.0;
    CHECK(step < 0.0);
    CHECK(std::atan(x[0]) * step <= -0.5 * std::atan(4.0) * step);
    // Where any step is good enough, one that was cut is not the last.
    CHECK(std::abs(step) < 10.0);
    for (const double tolerance : {10.0, 1e9}) {
        Vector far = Vec3(4.0, 0.0, 0.0), near = Vec3(0.1, 0.0, 0.0);
        CHECK(solved(far, tolerance, 50).iterations > 1);
        CHECK(solved(near, tolerance, 50).iterations == 1);
    }
}

/// Two wells: (x^2 - 1)^2 / 4 in each component, whose tangent is negative between them.
struct Wells : Bounded {
    struct Mesh : Bounded::Mesh {
        Index fibre_count() const { return 1; }
        Index node_count(Index) const { return 1; }
    };
    Mesh one;
    struct Asked {
        bool without_compression;
        double shift;
    };
    std::vector<std::vector<Asked>> asked{};  ///< of each iteration
    const Mesh& mesh() const { return one; }
    void linearise(const Vector& x, bool without_compression, double shift) {
        asked.back().push_back({without_compression, shift});
        stiffness = 3.0 * x.array().square() - 1.0 + shift;
    }
    void prescribed_step(const Vector& x, Vector& step) {
        asked.emplace_back();
        step = Vector::Zero(x.size());
    }
    assembly::ResidualFigures residual(const Vector& x, Vector& r) const {
        r = x.array().cube() - x.array();
        return {r.norm(), 1.0, 0.0};
    }
};
struct Definite {
    const Wells* problem;
    void analyse(const Bounded::System&) {}
    solver::SolveStatus prepare(const Bounded::System&) const {
        return problem->stiffness.minCoeff() > 0.0 ? solver::SolveStatus::converged : solver::SolveStatus::indefinite;
    }
    solver::SolveReport solve(const Bounded::System&, const Vector& b, double, Vector& x) {
        x = b.cwiseQuotient(problem->stiffness);
        return {solver::SolveStatus::converged, 1, 0.0, 1.0};
    }
};

/// Newton's method from x, which comes to where it ends.
solver::NewtonReport descend(Wells& problem, Vector& x, double tolerance, Index most) {
    Untouched contacts;
    Definite linear{&problem};
    solver::IterationParameters parameters;
    parameters.mixed = false, parameters.newton_limit = most;
    core::StageClock clock;
    solver::Newton<Wells, Untouched, Definite> newton(problem, contacts, linear, parameters, 1.0, clock);
    solver::IterationCounts counts;
    return newton.solve(x, tolerance, x, std::numeric_limits<double>::infinity(), counts);
}

TEST_CASE(
    "an indefinite tangent is met without compression, then by shifts that are four times the last, and the next one "
    "begins a step below") {
    Wells problem;
    Vector x = Vec3(0.1, 0.1, 0.1);
    REQUIRE(descend(problem, x, 1e-4, 100).status == solver::NewtonStatus::converged);
    CHECK((x - Vec3::Ones()).norm() < 1e-5);
    const std::vector<Wells::Asked>& first = problem.asked.front();
    REQUIRE(first.size() == 10);  // the tangent is -0.97 of the mean stiffness, and the last shift 1.64 of it
    for (std::size_t k = 0; k < first.size(); ++k) {
        CHECK(first[k].without_compression == (k > 0));
        CHECK(first[k].shift == (k < 2 ? 0.0 : 1e-4 * std::pow(4.0, static_cast<double>(k) - 2.0)));
    }
    for (std::size_t n = 1; n < problem.asked.size(); ++n) {
        const double before = problem.asked[n - 1].back().shift;
        CHECK(problem.asked[n].front().shift == (before > 1e-4 ? 0.25 * before : 0.0));
    }
    CHECK(problem.asked.back().back().shift < 0.1);
}

TEST_CASE("of iterations that did not come to an end, it is told how many had a tangent that was not positive definite") {
    const auto few = [](const Vec3& from) {
        Wells problem;
        Vector x = from;
        return descend(problem, x, 1e-12, 2);
    };
    const solver::NewtonReport between = few({0.01, 0.01, 0.01}), within = few({2.0, 2.0, 2.0});
    REQUIRE(between.status == solver::NewtonStatus::too_many);
    CHECK(between.indefinite == 2);
    REQUIRE(within.status == solver::NewtonStatus::too_many);
    CHECK(within.indefinite == 0);
}

TEST_CASE(
    "what the first step of a prescribed motion may leave over is a part of the forces, not of what the motion does to an end "
    "alone") {
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
    CHECK(linear.tolerances[0] * problem.own.coupling == test::near(1e-2, 1e-5));  // the first solution is to 1e-2
    CHECK(linear.tolerances[1] >= 1e-4);
}

/// Nodes on soft springs along x, each pushed at its own wall, of which some are so near that a step goes far into them.
struct Walls {
    Untouched::Places places() const { return {}; }
    static constexpr double spring = 1.0, wall = 1e4, push = 1.0;
    struct Element {
        Index node;
        Vec3 normal = Vec3::UnitX();  // of the wall from the node
        Index fibre_i = 0, fibre_j = 1;
        Vec3 motion(const Vector& step) const { return -step.segment<3>(3 * node); }
    };
    std::vector<double> place;
    std::vector<Element> all;
    Vector state;

    explicit Walls(Index nodes) : state{Vector::Zero(3 * nodes)} {
        for (Index k = 0; k < nodes; ++k) place.push_back(0.9 - 0.05 * static_cast<double>(k)), all.push_back({k});
    }
    double depth(Index k) const { return state[3 * k] - place[core::at(k)]; }
    const std::vector<Element>& elements() const { return all; }
    bool forced(const Element&) const { return false; }
    double stiffness(const Element&) const { return wall; }
    std::vector<contact::ContactResponse> states;
    const std::vector<contact::ContactResponse>& responses() const { return states; }
    void evaluate(const Vector& x) {
        state = x;
        states.clear();
        for (Index k = 0; k < core::count(place); ++k)
            states.push_back({-depth(k), wall * std::max(0.0, depth(k)), depth(k) > 0.0 ? -wall : 0.0});
    }
    Vec3 force(Index k) const { return Vec3(-wall * std::max(0.0, depth(k)), 0.0, 0.0); }
    Mat3 tangent(Index k) const { return Vec3(depth(k) > 0.0 ? wall : 0.0, 0.0, 0.0).asDiagonal(); }
    Vector internal() const {
        Vector sum = spring * state;
        for (Index k = 0; k < core::count(place); ++k) sum[3 * k] += -force(k).x() - push;
        return sum;
    }
};
template <bool learns>
struct Pushed : Bounded {
    Walls* walls;
    explicit Pushed(Walls& of) : walls{&of} { own.own.chains[0].nodes = core::count(of.place); }
    void prescribed_step(const Vector& x, Vector& step) const { step = Vector::Zero(x.size()); }
    void linearise(const Vector&, bool, double) {
        stiffness = Vector::Constant(walls->state.size(), Walls::spring);
        for (Index k = 0; k < core::count(walls->place); ++k)
            stiffness.segment<3>(3 * k) +=
                (walls->tangent(k) + (memory.empty() || !learns ? Mat3(Mat3::Zero()) : memory.stiffness(*walls, k))).diagonal();
    }
    void add_learned(Vector& right) const {
        if (learns && !memory.empty())
            for (Index k = 0; k < core::count(walls->place); ++k) right[3 * k] += memory.force(*walls, k).x();
    }
    assembly::ResidualFigures residual(const Vector&, Vector& r) const {
        r = walls->internal();
        return {r.norm(), 1.0, 0.0};
    }
};

template <bool learns>
Index iterations(Index nodes) {
    Walls walls(nodes);
    Pushed<learns> problem(walls);
    Exact linear{&problem};
    solver::IterationParameters parameters;
    parameters.mixed = false, parameters.overshoot = 0.5, parameters.newton_limit = 200, parameters.residual_tolerance = 1e-10;
    core::StageClock clock;
    solver::Newton<Pushed<learns>, Walls, Exact> newton(problem, walls, linear, parameters, 1e3, clock);
    solver::IterationCounts counts;
    Vector x = Vector::Zero(3 * nodes);
    const solver::NewtonReport report = newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
    REQUIRE(report.status == solver::NewtonStatus::converged);
    for (Index k = 0; k < nodes; ++k) {  // push - spring x = wall (x - place)
        const double at = (Walls::push + Walls::wall * walls.place[core::at(k)]) / (Walls::spring + Walls::wall);
        CHECK(std::abs(x[3 * k] - at) < 1e-9);
    }
    CHECK(problem.memory.empty());
    return report.iterations;
}

TEST_CASE("walls that drew back a little are met as they were, and one that is gone for good is left") {
    constexpr Index nodes = 8;
    constexpr double back = 2e-5;  // more than half of the nodes were in their walls, and less than the deepest
    struct End {
        double furthest_off = 0.0;  // of nodes from where they balance with walls that drew back
        double at_none = 0.0;       // of the node whose wall is gone
    };
    const auto after = [&](Index iterations, bool remembers, double overshoot = 0.5) {
        Walls walls(nodes);
        walls.place.front() = 1.0 - 0.5 * back;  // and after it, beyond where the spring of its node ends
        Pushed<true> problem(walls);
        Exact linear{&problem};
        solver::IterationParameters parameters;
        parameters.mixed = false, parameters.overshoot = overshoot, parameters.residual_tolerance = 1e-10;
        parameters.newton_limit = iterations;
        core::StageClock clock;
        solver::Newton<Pushed<true>, Walls, Exact> newton(problem, walls, linear, parameters, 1e3, clock);
        solver::IterationCounts counts;
        const auto balance = [&](Index k) {
            return (Walls::push + Walls::wall * walls.place[core::at(k)]) / (Walls::spring + Walls::wall);
        };
        Vector x = Vector::Zero(3 * nodes);
        for (Index k = 0; k < nodes; ++k) x[3 * k] = balance(k);
        walls.evaluate(x);
        if (remembers) problem.memory.remember(walls);
        for (double& place : walls.place) place += back;
        newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
        End end;
        for (Index k = 1; k < nodes; ++k) end.furthest_off = std::max(end.furthest_off, std::abs(x[3 * k] - balance(k)));
        end.at_none = x[0];
        return end;
    };
    CHECK(after(1, true).furthest_off < 1e-9 * back);
    CHECK(after(1, false).furthest_off > 0.9 * back);                                // the step is cut
    for (const double overshoot : {0.5, std::numeric_limits<double>::infinity()}) {  // for one step, watched or not
        const End end = after(15, true, overshoot);
        CHECK(end.furthest_off < 1e-9 * back);
        CHECK(end.at_none == test::near(Walls::push / Walls::spring, 1e-9));
    }
}

TEST_CASE(
    "a step that would go far into many contacts is solved again with what they turned out to be, and not cut for each of them") {
    // The first step is cut for all of them at once, the second finds all walls, whatever their number, and the third has only
    // rounding left. Else every wall takes steps of its own.
    CHECK(iterations<true>(16) <= 4);
    CHECK(iterations<false>(16) > 16);
}

TEST_CASE(
    "a contact that closed is linear about where the step went, one that slid back has the secant, one that its tangent "
    "describes has nothing") {
    struct Pairs {
        struct Element {
            Vec3 normal = Vec3::UnitZ();
            Vec3 by;
            Vec3 motion(const Vector&) const { return by; }
        };
        std::vector<Element> all;
        std::vector<Vec3> forces;
        std::vector<Mat3> tangents;
        std::vector<contact::ContactResponse> states;
        const std::vector<Element>& elements() const { return all; }
        static double stiffness(const Element&) { return 0.0; }
        const std::vector<contact::ContactResponse>& responses() const { return states; }
        Vec3 force(Index k) const { return forces[core::at(k)]; }
        Mat3 tangent(Index k) const { return tangents[core::at(k)]; }
    };
    const double stiffness = 50.0, gap = 0.3, depth = 0.1, bound = 2.0, slip = 0.4;
    const Mat3 across = Vec3::UnitZ() * Vec3::UnitZ().transpose(), along = Vec3::UnitX() * Vec3::UnitX().transpose();
    Pairs pairs;
    // One closes by a gap and a penetration; one slid to its bound and slides back to the other; one is pressed as its tangent
    // says.
    pairs.all = {{.by = {0, 0, -(gap + depth)}}, {.by = {-slip, 0, 0}}, {.by = {0, 0, -depth}}};
    const Pairs start = [&] {
        Pairs at = pairs;
        at.forces = {Vec3::Zero(), Vec3(bound, 0, 0), Vec3::Zero()};
        at.tangents = {Mat3::Zero(), Mat3::Zero(), stiffness * across};
        at.states = {{gap, 0.0, 0.0}, {gap, 0.0, 0.0}, {0.0, 0.0, -stiffness}};
        return at;
    }();
    contact::LearnedContacts learned;
    learned.begin_step(start);
    CHECK(learned.empty());
    pairs.forces = {Vec3(0, 0, -stiffness * depth), Vec3(-bound, 0, 0), Vec3(0, 0, -stiffness * depth)};
    pairs.states = {{-depth, stiffness * depth, -stiffness}, {gap, 0.0, 0.0}, {-depth, stiffness * depth, -stiffness}};
    learned.learn(pairs, Vector::Zero(3));
    // Seen from the start the one that closes pulls its gap to nothing: what the next step finds is the wall.
    CHECK((learned.stiffness(start, 0) - stiffness * across).norm() < 1e-12);
    CHECK((learned.force(start, 0) - stiffness * gap * Vec3::UnitZ()).norm() < 1e-12);
    CHECK((learned.stiffness(start, 1) - 2.0 * bound / slip * along).norm() < 1e-12);
    CHECK(learned.force(start, 1).norm() == 0.0);
    CHECK(learned.stiffness(start, 2).norm() + learned.force(start, 2).norm() < 1e-12);
    learned.begin_step(start);
    CHECK((learned.stiffness(start, 1) - contact::LearnedContacts::kept * 2.0 * bound / slip * along).norm() < 1e-12);
    CHECK(learned.stiffness(start, 0).norm() == 0.0);
}

TEST_CASE("after a step that is cut to a small part, slack fibres are held to those beside them, in tangents alone") {
    struct Beside {
        struct Element {
            Vec3 normal = Vec3::UnitZ();
        };
        std::vector<Element> all{{}, {}, {}};
        std::vector<contact::ContactResponse> states;
        const std::vector<Element>& elements() const { return all; }
        const std::vector<contact::ContactResponse>& responses() const { return states; }
        double stiffness(const Element&) const { return 50.0; }
    };
    const double radius = 2.0, near = contact::LearnedContacts::near * radius;
    Beside pairs;  // open and near, open and further, closed
    pairs.states = {{0.5 * near, 0.0, 0.0}, {2.0 * near, 0.0, 0.0}, {-0.1, 5.0, -50.0}};
    contact::LearnedContacts learned;
    CHECK(learned.empty());
    learned.hold_near(radius);
    CHECK_FALSE(learned.empty());
    CHECK((learned.stiffness(pairs, 0) - contact::LearnedContacts::held * 50.0 * Mat3::Identity()).norm() < 1e-12);
    CHECK(learned.stiffness(pairs, 1).norm() + learned.stiffness(pairs, 2).norm() == 0.0);
    for (const Index k : {0, 1, 2}) CHECK(learned.force(pairs, k).norm() == 0.0);
    learned.let_go();  // after a step that was not: pairs that are to slide past each other are not held for ever
    const double left = contact::LearnedContacts::held * contact::LearnedContacts::kept;
    CHECK((learned.stiffness(pairs, 0) - left * 50.0 * Mat3::Identity()).norm() < 1e-12);
    for (int k = 0; k < 5; ++k) learned.let_go();
    CHECK(learned.empty());
    learned.hold_near(radius);
    learned.clear();
    CHECK(learned.empty());

    // Three nodes that a push sends a thousand times as far as their walls are: the next tangent holds the fourth to its wall,
    // which no step met.
    const auto steps = [](double overshoot) {
        Walls walls(4);
        Pushed<true> problem(walls);
        Exact linear{&problem};
        solver::IterationParameters parameters;
        parameters.mixed = false, parameters.overshoot = overshoot, parameters.newton_limit = 2;
        core::StageClock clock;
        solver::Newton<Pushed<true>, Walls, Exact> newton(problem, walls, linear, parameters, 1e3, clock);
        solver::IterationCounts counts;
        Vector x = Vector::Zero(12);
        for (const Index k : {0, 1, 2}) walls.place[core::at(k)] *= 1e-3;
        walls.place[3] = 50.0;
        newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
        return problem.stiffness[9];  // towards the wall that no step met
    };
    CHECK(steps(0.5) == test::near(Walls::spring + contact::LearnedContacts::held * Walls::wall));
    CHECK(steps(std::numeric_limits<double>::infinity()) == Walls::spring);
}

struct Touched : Untouched {
    struct Element {
        Vec3 normal = Vec3::UnitX();
        Index fibre_i = 0, fibre_j = 1;
        Vec3 motion(const Vector& step) const { return step.head<3>(); }
    };
    std::vector<Element> one{{}};
    const std::vector<Element>& elements() const { return one; }
    bool forced(const Element&) const { return false; }
};

TEST_CASE("a step brings two fibres nearer by half of their own radius, not of the smallest in the scene") {
    Bounded problem;
    problem.fibres.only.section.semi_axis_1 = problem.fibres.only.section.semi_axis_2 = 4.0;
    Touched contacts;
    Exact linear{&problem};
    solver::IterationParameters parameters;
    parameters.mixed = false, parameters.newton_limit = 1, parameters.largest_approach = 0.5;
    core::StageClock clock;
    solver::Newton<Bounded, Touched, Exact> newton(problem, contacts, linear, parameters, 1.0, clock);
    solver::IterationCounts counts;
    Vector x = Vec3(4.0, 0.0, 0.0);  // from where a whole step is 22 long
    newton.solve(x, 1e-4, x, std::numeric_limits<double>::infinity(), counts);
    CHECK(x[0] == test::near(2.0));
}

}  // namespace newton_test

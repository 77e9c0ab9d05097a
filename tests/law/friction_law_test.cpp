// SPDX-License-Identifier: MIT
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/smooth_coulomb.hpp>

#include <near.hpp>
#include <refusal.hpp>

#include <Eigen/Geometry>
#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <random>
#include <type_traits>
#include <vector>

using namespace fibrant;

namespace friction_law_test {

using law::Frictionless;
using law::RegularisedCoulomb;
using History = RegularisedCoulomb::History;
using Response = law::FrictionResponse<History>;

const double mu = 0.15, range = 1e-3, reaction = 40.0;
const double bound = mu * reaction;
const RegularisedCoulomb coulomb{{.friction_coefficient = mu, .reversible_displacement = range}};

/// Derivative of the force by the slip, column by column.
Mat3 differences(const Vec3& slip, const History& history) {
    const double step = 1e-6 * range;
    Mat3 slope;
    for (int k = 0; k < 3; ++k) {
        const Vec3 aside = step * Vec3::Unit(k);
        slope.col(k) =
            (coulomb.response(slip + aside, reaction, history).force - coulomb.response(slip - aside, reaction, history).force) /
            (2.0 * step);
    }
    return slope;
}

/// Work of the friction on a path of total displacements along x, followed in accepted steps.
struct Path {
    double work = 0.0;        // trapezium rule on the force
    double dissipated = 0.0;  // as the law counts it
    double force = 0.0;
};
Path follow(const std::vector<double>& turns, int steps) {
    Path path;
    History history;
    for (std::size_t k = 1; k < turns.size(); ++k) {
        const double step = (turns[k] - turns[k - 1]) / steps;
        for (int n = 0; n < steps; ++n) {
            const Response answer = coulomb.response({step, 0.0, 0.0}, reaction, history);
            path.work += 0.5 * (path.force + answer.force.x()) * step;
            path.dissipated += answer.dissipated;
            path.force = answer.force.x();
            history = answer.history;
        }
    }
    return path;
}

TEST_CASE("a slip within the reversible displacement is resisted like a spring and given back") {
    const Vec3 slip{0.3 * range, -0.4 * range, 0.0};  // half the range
    const Response answer = coulomb.response(slip, reaction, {});
    CHECK(!answer.sliding);
    CHECK(answer.dissipated == 0.0);
    CHECK((answer.force - bound / range * slip).norm() <= 1e-15 * bound);
    CHECK((answer.history.reversible - slip).norm() <= 1e-15 * range);
    const Response back = coulomb.response(-slip, reaction, answer.history);
    CHECK(back.force.norm() == 0.0);
    CHECK(back.dissipated == 0.0);
}

TEST_CASE("a slip beyond the reversible displacement slides at the Coulomb bound, along the slip") {
    const Vec3 slip{6.0 * range, 8.0 * range, 0.0};  // ten times the range
    const Response answer = coulomb.response(slip, reaction, {});
    CHECK(answer.sliding);
    CHECK(answer.force.norm() == test::near(bound, 1e-14));
    CHECK((answer.force - bound * Vec3(0.6, 0.8, 0.0)).norm() <= 1e-14 * bound);
    CHECK((answer.history.reversible - range * Vec3(0.6, 0.8, 0.0)).norm() <= 1e-14 * range);
    CHECK(answer.dissipated == test::near(bound * 9.0 * range, 1e-14));
}

TEST_CASE("the force is continuous where sticking turns into sliding") {
    const Response stuck = coulomb.response({range * (1.0 - 1e-12), 0.0, 0.0}, reaction, {});
    const Response slid = coulomb.response({range * (1.0 + 1e-12), 0.0, 0.0}, reaction, {});
    CHECK(!stuck.sliding);
    CHECK(slid.sliding);
    CHECK((stuck.force - slid.force).norm() <= 1e-11 * bound);  // ten times the distance of the two slips
}

TEST_CASE("what slid begins the next increment with the stiffness of what sticks, whichever way it is rounded") {
    // Histories that slid lie on the bound but for rounding: turned by any angle they are a little within or beyond it.
    Index within = 0, beyond = 0;
    for (int k = 0; k < 100; ++k) {
        const Vec3 way(std::cos(0.1 * k), std::sin(0.1 * k), 0.0);
        const History history = coulomb.response(5.0 * range * way, reaction, {}).history;
        (history.reversible.norm() <= range ? within : beyond) += 1;
        for (const double slip : {-1e-12, 0.0, 1e-12}) {
            const Response answer = coulomb.response(slip * range * way, reaction, history);
            CHECK((answer.tangent - bound / range * Mat3::Identity()).norm() <= 1e-12 * bound / range);
            CHECK(answer.force.norm() <= bound * (1.0 + 1e-15));
        }
        const Response on = coulomb.response(1e-6 * range * way, reaction, history);
        CHECK((on.tangent * way).norm() <= 1e-12 * bound / range);  // it slides on
    }
    CHECK(within > 10);  // both of them are there
    CHECK(beyond > 10);
}

TEST_CASE("a reversal first unloads the spring, crosses zero and slides the other way after twice the range") {
    const History history = coulomb.response({5.0 * range, 0.0, 0.0}, reaction, {}).history;
    const Response unloaded = coulomb.response({-range, 0.0, 0.0}, reaction, history);
    CHECK(!unloaded.sliding);
    CHECK(unloaded.force.norm() <= 1e-15 * bound);
    const Response pulled = coulomb.response({-1.5 * range, 0.0, 0.0}, reaction, history);
    CHECK(!pulled.sliding);
    CHECK(pulled.force.x() == test::near(-0.5 * bound, 1e-14));
    const Response slid = coulomb.response({-3.0 * range, 0.0, 0.0}, reaction, history);
    CHECK(slid.sliding);
    CHECK(slid.force.x() == test::near(-bound, 1e-14));
    CHECK(slid.dissipated == test::near(bound * range, 1e-13));  // 3 - 2 ranges slid
}

TEST_CASE("a turn of the slip turns the force towards it within the range of memory") {
    const History history{.reversible = {range, 0.0, 0.0}};
    const Response answer = coulomb.response({0.0, range, 0.0}, reaction, history);
    CHECK(answer.sliding);
    CHECK(answer.force.x() == test::near(bound / std::sqrt(2.0), 1e-14));
    CHECK(answer.force.y() == test::near(bound / std::sqrt(2.0), 1e-14));
    const Response later = coulomb.response({0.0, 100.0 * range, 0.0}, reaction, answer.history);
    CHECK(later.force.y() == test::near(bound, 1e-4));  // 1 - (1/100)^2 / 2 of it
}

TEST_CASE("without a reaction there is neither force nor stiffness nor loss, and the memory goes on") {
    for (const double length : {0.5 * range, 20.0 * range}) {
        const Response answer = coulomb.response({length, 0.0, 0.0}, 0.0, {});
        CHECK(answer.force == Vec3::Zero());
        CHECK(answer.tangent == Mat3::Zero());
        CHECK(answer.dissipated == 0.0);
        CHECK(answer.history.reversible.x() == test::near(std::min(length, range), 1e-15));
    }
    const Response none = coulomb.response(Vec3::Zero(), reaction, {});
    CHECK(none.force == Vec3::Zero());
    CHECK(!none.sliding);
}

TEST_CASE("a zero coefficient of friction is no friction") {
    const RegularisedCoulomb smooth{{.friction_coefficient = 0.0, .reversible_displacement = range}};
    const Response answer = smooth.response({3.0 * range, 0.0, 0.0}, reaction, {});
    CHECK(answer.force == Vec3::Zero());
    CHECK(answer.dissipated == 0.0);
}

TEST_CASE("on random slips: bound, symmetry, tangent, memory and dissipation hold together") {
    std::mt19937 random(20261121);
    std::normal_distribution<double> normal;
    int stuck = 0, slid = 0;
    for (int n = 0; n < 400; ++n) {
        const auto vector = [&](double size) {
            return Vec3(size * normal(random), size * normal(random), size * normal(random));
        };
        History history{.reversible = vector(0.5 * range)};
        if (history.reversible.norm() > range) history.reversible *= range / history.reversible.norm();
        const Vec3 slip = vector(n % 2 == 0 ? 0.3 * range : 3.0 * range);
        const Vec3 trial = history.reversible + slip;
        if (std::abs(trial.norm() - range) < 1e-4 * range) continue;  // the tangent jumps there
        const Response answer = coulomb.response(slip, reaction, history);
        CAPTURE(n);
        (answer.sliding ? slid : stuck) += 1;
        CHECK(answer.force.norm() <= bound * (1.0 + 1e-14));
        CHECK(answer.history.reversible.norm() <= range * (1.0 + 1e-14));
        CHECK(answer.dissipated >= 0.0);
        CHECK(answer.tangent == answer.tangent.transpose());
        // Central differences with a step of 1e-6 range: truncation about 1e-12, round-off 1e-16 / 1e-6.
        CHECK((answer.tangent - differences(slip, history)).norm() <= 1e-8 * bound / range);
        // Positive semidefinite: x' K x for a random x.
        const Vec3 x = vector(1.0);
        CHECK(x.dot(answer.tangent * x) >= -1e-14 * bound / range * x.squaredNorm());
        // Sliding passes no work on: what is dissipated is at most the force's work on the slip plus what was stored.
        const double stored_before = 0.5 * bound / range * history.reversible.squaredNorm();
        const double stored_after = 0.5 * bound / range * answer.history.reversible.squaredNorm();
        CHECK(answer.dissipated + stored_after <= answer.force.dot(slip) + stored_before + 1e-12 * bound * range);
    }
    CHECK(stuck > 100);
    CHECK(slid > 100);
}

TEST_CASE("turning slip and memory together turns the force: the law has no direction of its own") {
    const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1.0, -2.0, 0.5).normalized()).toRotationMatrix();
    for (const double size : {0.2, 4.0}) {
        const Vec3 slip = size * range * Vec3(0.6, 0.0, 0.8);
        const History history{.reversible = range * Vec3(0.0, 0.5, 0.0)};
        const History turned{.reversible = turn * history.reversible};
        const Response here = coulomb.response(slip, reaction, history);
        const Response there = coulomb.response(turn * slip, reaction, turned);
        CHECK((there.force - turn * here.force).norm() <= 1e-14 * bound);
        CHECK((there.tangent - turn * here.tangent * turn.transpose()).norm() <= 1e-14 * bound / range);
    }
}

TEST_CASE("a cycle of slip dissipates the area of its hysteresis loop") {
    // From -A to A and back the loop is a parallelogram: force +-mu R, sides of slope mu R / u_max, so its area is
    // 4 mu R (A - u_max). One cycle to reach it, then one that is counted.
    const double amplitude = 5.0 * range;
    const double area = 4.0 * bound * (amplitude - range);
    const std::vector<double> once{0.0, amplitude, -amplitude, amplitude};
    std::vector<double> twice = once;
    twice.insert(twice.end(), {-amplitude, amplitude});
    // 20 steps of half the range on each way: the corners of the loop fall on ends of steps, where the trapezium rule
    // is exact for a force that is piecewise linear.
    const int steps = 20;
    const double dissipated = follow(twice, steps).dissipated - follow(once, steps).dissipated;
    const double work = follow(twice, steps).work - follow(once, steps).work;
    CHECK(dissipated == test::near(area, 1e-12));
    CHECK(work == test::near(area, 1e-12));
    // The loss does not depend on the number of increments, down to one for each way.
    const double coarse = follow(twice, 1).dissipated - follow(once, 1).dissipated;
    CHECK(coarse == test::near(area, 1e-12));
}

TEST_CASE("a cycle within the reversible displacement loses nothing") {
    const Path path = follow({0.0, 0.9 * range, -0.9 * range, 0.9 * range, 0.0}, 18);
    CHECK(path.dissipated == 0.0);
    CHECK(std::abs(path.force) <= 1e-14 * bound);
    CHECK(std::abs(path.work) <= 1e-14 * bound * range);
}

TEST_CASE("no friction is nothing: no memory, no force, no size") {
    static_assert(std::is_empty_v<Frictionless> && std::is_empty_v<Frictionless::History>);
    static_assert(!core::Active<Frictionless> && core::Active<RegularisedCoulomb>);
    struct Kept {
        double gap;
        [[no_unique_address]] Frictionless::History history;
    };
    static_assert(sizeof(Kept) == sizeof(double));
    const law::FrictionResponse<Frictionless::History> answer = Frictionless{}.response({1.0, 2.0, 3.0}, 10.0, {});
    CHECK(answer.force == Vec3::Zero());
    CHECK(answer.tangent == Mat3::Zero());
    CHECK(answer.dissipated == 0.0);
    CHECK(!answer.sliding);
}

TEST_CASE("parameters that cannot hold are refused with field, value and bound") {
    const auto build = [](double coefficient, double displacement) {
        return test::refusal(
            [&] { RegularisedCoulomb{{.friction_coefficient = coefficient, .reversible_displacement = displacement}}; });
    };
    const double infinity = std::numeric_limits<double>::infinity();
    CHECK(build(-0.1, range) == "RegularisedCoulomb.friction_coefficient = -0.1, but it must be finite and >= 0");
    CHECK(build(core::unset, range) == "RegularisedCoulomb.friction_coefficient = nan, but it must be finite and >= 0");
    CHECK(build(infinity, range) == "RegularisedCoulomb.friction_coefficient = inf, but it must be finite and >= 0");
    CHECK(build(mu, 0.0) == "RegularisedCoulomb.reversible_displacement = 0, but it must be finite and > 0");
    CHECK(build(mu, core::unset) == "RegularisedCoulomb.reversible_displacement = nan, but it must be finite and > 0");
    CHECK(build(0.0, range).empty());
}

TEST_CASE("smooth friction owes what regularised friction owes, and its stiffness has no jump") {
    const law::SmoothCoulomb smooth{{.friction_coefficient = mu, .reversible_displacement = range}};
    using Memory = law::SmoothCoulomb::History;
    const auto stored = [](double u) { return bound * (u * u / range - u * u * u / (3.0 * range * range)); };
    std::mt19937 random(20261122);
    std::normal_distribution<double> normal;
    for (int n = 0; n < 400; ++n) {
        const auto vector = [&](double size) {
            return Vec3(size * normal(random), size * normal(random), size * normal(random));
        };
        Memory history{.reversible = vector(0.5 * range)};
        if (history.reversible.norm() > range) history.reversible *= range / history.reversible.norm();
        const Vec3 slip = vector(n % 2 == 0 ? 0.3 * range : 3.0 * range);
        const auto answer = smooth.response(slip, reaction, history);
        CAPTURE(n);
        CHECK(answer.force.norm() <= bound * (1.0 + 1e-14));
        CHECK(answer.history.reversible.norm() <= range * (1.0 + 1e-14));
        CHECK(answer.dissipated >= 0.0);
        CHECK((answer.tangent - answer.tangent.transpose()).norm() <= 1e-14 * answer.tangent.norm());
        const double step = 1e-6 * range;
        Mat3 slope;
        for (int k = 0; k < 3; ++k)
            slope.col(k) = (smooth.response(slip + step * Vec3::Unit(k), reaction, history).force -
                            smooth.response(slip - step * Vec3::Unit(k), reaction, history).force) /
                           (2.0 * step);
        // Everywhere, where sliding begins too: there the second derivative jumps by 2 bound / range^2.
        CHECK((answer.tangent - slope).norm() <= 4e-6 * bound / range);
        const Vec3 x = vector(1.0);
        CHECK(x.dot(answer.tangent * x) >= -1e-14 * bound / range * x.squaredNorm());
        CHECK(answer.dissipated + stored(answer.history.reversible.norm()) <=
              answer.force.dot(slip) + stored(history.reversible.norm()) + 1e-12 * bound * range);
    }
    CHECK(smooth.response(Vec3(range, 0, 0), reaction, {}).force.x() == test::near(bound, 1e-12));
    CHECK(smooth.response(Vec3(1e-6 * range, 0, 0), reaction, {}).force.x() ==
          test::near(2e-6 * bound, 1e-6));  // but for x / 2 of it
    CHECK(smooth.response(Vec3(5.0 * range, 0, 0), reaction, {}).dissipated == test::near(4.0 * range * bound, 1e-12));
    CHECK(smooth.response(Vec3(0.9 * range, 0, 0), reaction, {}).dissipated == 0.0);
    CHECK(smooth.response(Vec3(range, 0, 0), 0.0, {}).force == Vec3::Zero());
    CHECK(test::refusal([] { law::SmoothCoulomb{{.friction_coefficient = -1.0, .reversible_displacement = 1.0}}; }) ==
          "SmoothCoulomb.friction_coefficient = -1, but it must be finite and >= 0");
}

TEST_CASE_TEMPLATE("what friction does not dissipate of the work along its slip, it stores", Law, RegularisedCoulomb,
                   law::SmoothCoulomb) {
    const Law friction{{.friction_coefficient = mu, .reversible_displacement = range}};
    typename Law::History history;
    double work = 0.0, dissipated = 0.0, force = 0.0;
    const int steps = 4000;  // so many that trapezia miss less than a millionth where the force bends
    for (const double way : {3.0, -1.4, 0.6, -5.0, 2.2}) {
        const double step = way * range / steps;
        for (int n = 0; n < steps; ++n) {
            const auto answer = friction.response({step, 0.0, 0.0}, reaction, history);
            work += 0.5 * (force + answer.force.x()) * step;
            dissipated += answer.dissipated, force = answer.force.x(), history = answer.history;
        }
        const double stored = friction.response(Vec3::Zero(), reaction, history).stored;
        CHECK(work == test::near(dissipated + stored, 1e-6));
        CHECK(stored > 0.0);
    }
    CHECK(friction.response({3.0 * range, 0.0, 0.0}, 0.0, {}).stored == 0.0);
}

}  // namespace friction_law_test

// SPDX-License-Identifier: MIT
// What a result must not depend on, degenerate geometries, and random small scenes: what is asserted is physics, measured without
// the code of contact.
#include <stability/cycles.hpp>
#include <stability/random_scenes.hpp>
#include <stability/small_scenes.hpp>
#include <stability/sweeps.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <Eigen/Geometry>

#include <cstdio>

using namespace fibrant;

namespace stability_test {

using namespace fibrant::test;

const double r = 0.0201;

/// Distance of two results whose fibres and stations correspond by `fibre` and `back`, after Q and shift, over the radius.
double apart(const SmallResult& a, const SmallResult& b, const Mat3& Q, const Vec3& shift, double length = 1.0,
             const std::vector<std::size_t>& order = {}, bool back = false) {
    double most = 0.0;
    for (std::size_t f = 0; f < b.centreline.size(); ++f) {
        const auto& from = a.centreline[order.empty() ? f : order[f]];
        const auto& to = b.centreline[f];
        for (std::size_t k = 0; k < to.size(); ++k)
            most = std::max(most, (length * (Q * from[back ? to.size() - 1 - k : k] + shift) - to[k]).norm() / (length * r));
    }
    return most;
}
const Mat3 same = Mat3::Identity();

SmallScene tight_three() {
    SmallScene scene = dragged_three();
    scene.tight = true;
    return scene;
}
/// Run once for all comparisons.
const SmallResult& three() {
    static const SmallResult result = run(tight_three());
    return result;
}

TEST_CASE("three fibres that are pressed and dragged: converged, in balance, not in each other") {
    const SmallScene scene = tight_three();
    REQUIRE(three().report.converged);
    CHECK(three().report.contact.active >= 2);
    CHECK(three().report.energy.dissipated > 0.0);
    CHECK((three().support[0] + three().support[1] + three().support[2]).norm() < 1e-9 * three().support[1].norm());
    CHECK(deepest(scene, three()) < 2e-2);  // twice the allowed penetration, and what sections give way
}

TEST_CASE("the units of length and force change nothing: metres, micrometres, newtons, micronewtons") {
    for (const auto& [length, force] : {std::pair(1e-3, 1.0), std::pair(1e3, 1e6), std::pair(1e3, 1.0)}) {
        const SmallResult other = run(scaled(tight_three(), length, force));
        REQUIRE(other.report.converged);
        CHECK(apart(three(), other, same, Vec3::Zero(), length) < 1e-9);
        CHECK((other.support[1] / force - three().support[1]).norm() < 1e-9 * three().support[1].norm());
    }
}

TEST_CASE("a rigid motion of the whole scene, far from the origin too, moves the result with it") {
    const Mat3 turn = Eigen::AngleAxisd(2.1, Vec3(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
    for (const Vec3& shift : {Vec3(Vec3::Zero()), Vec3(3.0, -2.0, 1.0), Vec3(300.0, -200.0, 100.0)}) {
        const SmallResult other = run(moved(tight_three(), turn, shift));
        REQUIRE(other.report.converged);
        // Coordinates of the size |shift| keep 1e-16 |shift| of a strain over an element; bending turns it to 1e3 of that in
        // radii.
        const double tolerance = 1e-9 + 1e-9 * shift.norm();
        CHECK(apart(three(), other, turn, shift) < tolerance);
        CHECK((other.support[1] - turn * three().support[1]).norm() < tolerance * three().support[1].norm());
    }
}

TEST_CASE("a mirror image of the scene is a mirror image of the result") {
    const Mat3 mirror = Mat3::Identity() - 2.0 * Vec3(1, 2, -1).normalized() * Vec3(1, 2, -1).normalized().transpose();
    const SmallResult other = run(moved(tight_three(), mirror, Vec3::Zero()));
    REQUIRE(other.report.converged);
    CHECK(apart(three(), other, mirror, Vec3::Zero()) < 1e-9);
}

TEST_CASE("neither the order of the fibres nor their directions matter") {
    const std::vector<std::size_t> order{2, 0, 1};
    const SmallResult renamed = run(permuted(tight_three(), order)), back = run(reversed(tight_three()));
    REQUIRE(renamed.report.converged);
    REQUIRE(back.report.converged);
    CHECK(apart(three(), renamed, same, Vec3::Zero(), 1.0, order) < 1e-9);
    CHECK(apart(three(), back, same, Vec3::Zero(), 1.0, {}, true) < 1e-9);
}

TEST_CASE("a penalty of any stiffness over six decades is a spring in a row with the fibres; with multipliers it is none") {
    std::printf(
        "penalty over a section's stiffness,force over theory without it,over three springs,newton,with "
        "multipliers,newton,contact passes,deepest in radii\n");
    for (const double penalty : penalties) {
        CAPTURE(penalty);
        const SmallScene scene = held_at(penalty);
        const SmallResult alone = run(scene), multiplied = run<Multiplied>(scene);
        CAPTURE(alone.report.reason);
        CAPTURE(multiplied.report.reason);
        CHECK(alone.report.converged);
        CHECK(multiplied.report.converged);
        const double hard = theory_force(scene, small_approach), spring = theory_force_on_penalty(scene);
        std::printf("%g,%.6f,%.6f,%ld,%.6f,%ld,%ld,%.1e\n", penalty, alone.support[0].z() / hard, alone.support[0].z() / spring,
                    static_cast<long>(alone.report.counts.newton), multiplied.support[0].z() / hard,
                    static_cast<long>(multiplied.report.counts.newton),
                    static_cast<long>(multiplied.report.counts.contact_passes),
                    multiplied.report.contact.greatest_penetration / r);
        CHECK(std::abs(alone.support[0].z() / spring - 1.0) < 3e-4);  // tension is 5e-5 of it
        CHECK(std::abs(multiplied.support[0].z() / hard - 1.0) < 3e-4);
        CHECK(multiplied.report.contact.greatest_penetration < 1e-6 * r);
    }
}

TEST_CASE("degenerate geometries converge without a fibre in another one, or say why not") {
    struct Case {
        const char* name;
        SmallScene scene;
        bool must = true;  ///< converge
    };
    const auto pair = [](const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& press,
                         const Vec3& push = Vec3::Zero()) {
        SmallScene scene;
        SmallFibre lower{a, b}, upper{c, d};
        upper.move_from = upper.move_to = press, upper.push = push;
        scene.fibres = {lower, upper};
        return scene;
    };
    const double h = 2.0 * r, L = 0.4;
    std::vector<Case> cases;
    for (const double angle : {0.0, 1e-12, 1e-6, 1e-3, 0.05})
        cases.push_back({"near-parallel", pair({-L, 0, 0}, {L, 0, 0}, {-L * std::cos(angle), -L * std::sin(angle), h},
                                               {L * std::cos(angle), L * std::sin(angle), h}, Vec3::Zero(), {0, 0, -3e-3})});
    cases.push_back({"exactly perpendicular", pair({-L, 0, 0}, {L, 0, 0}, {0, -L, h}, {0, L, h}, {0, 0, -r})});
    cases.push_back({"end to end", pair({-L, 0, 0}, {-r, 0, 0}, {r, 0, 0}, {L, 0, 0}, {-0.02 * r, 0, 0})});
    cases.back().scene.fibres[0].held_to = cases.back().scene.fibres[1].held_from = Held::free;
    cases.push_back({"end against side", pair({-L, 0, 0}, {L, 0, 0}, {0, 0, h}, {0, 0, h + L}, {0, 0, -0.5 * r})});
    cases.back().scene.fibres[1].held_from = Held::free;
    cases.push_back(
        {"very short fibre on a long one", pair({-L, 0, 0}, {L, 0, 0}, {-0.5 * r, 0, h}, {0.5 * r, 0, h}, {0, 0, -0.5 * r})});
    cases.back().scene.fibres[1].elements = 1;
    cases.push_back({"very short fibres", pair({-r, 0, 0}, {r, 0, 0}, {0, -r, h}, {0, r, h}, {0, 0, -0.02 * r})});
    cases.back().scene.fibres[0].elements = cases.back().scene.fibres[1].elements = 1;
    {
        SmallScene star = pair({-L, 0, 0}, {L, 0, 0}, {0, -L, h}, {0, L, h}, {0, 0, -r});
        SmallFibre third{Vec3(-0.7 * L, -0.7 * L, 2.0 * h), Vec3(0.7 * L, 0.7 * L, 2.0 * h)};
        third.move_from = third.move_to = Vec3(0, 0, -2.0 * r);
        star.fibres.push_back(third);
        cases.push_back({"three stacked over one point", star});
        for (SmallFibre& f : star.fibres) f.from.z() = f.to.z() = 0.0, f.move_from = f.move_to = Vec3::Zero();
        cases.push_back({"three through one point", star, false});
    }
    cases.push_back({"coincident centrelines", pair({-L, 0, 0}, {L, 0, 0}, {-L, 0, 0}, {L, 0, 0}, {0, 0, 0}), false});
    for (const Case& c : cases) {
        CAPTURE(c.name);
        const SmallResult result = run(c.scene);
        std::printf("%s: %s, %ld of %ld contacts, deepest %.1e r %s\n", c.name, result.report.converged ? "converged" : "stopped",
                    static_cast<long>(result.report.contact.active), static_cast<long>(result.report.contact.elements),
                    deepest(c.scene, result), result.report.reason.c_str());
        CHECK(result.finite());
        if (c.must) REQUIRE(result.report.converged);
        if (!result.report.converged) {
            CHECK(!result.report.reason.empty());
        } else if (c.must) {
            CHECK(result.report.contact.active > 0);
            CHECK(deepest(c.scene, result) < 0.05);
        } else {
            // Nothing can be asked of where fibres go from inside each other, but it must not go unsaid.
            CHECK(result.report.contact.greatest_penetration > 0.9 * r * (deepest(c.scene, result) - 0.05));
        }
    }
}

TEST_CASE("random small scenes neither crash nor leave a fibre in another one without saying so") { check_random_scenes(1, 40); }

TEST_CASE("slack fibres under a load they cannot carry yet find their shape, or the run says why") {
    SmallScene scene;  // a fibre that is longer than its span, pushed aside, above a straight one
    SmallFibre straight{Vec3(-0.5, 0, 0), Vec3(0.5, 0, 0)}, slack{Vec3(0.0, -0.5, 3.0 * r), Vec3(0.0, 0.5, 3.0 * r)};
    slack.move_from = Vec3(0, 0.05, 0), slack.move_to = Vec3(0, -0.05, 0), slack.push = Vec3(1e-4, 0, -2e-3);
    slack.elements = straight.elements = 12;
    slack.held_from = slack.held_to = Held::pinned;
    scene.fibres = {straight, slack};
    scene.increments = 20;
    scene.damping = 1e-3;  // over a node; the middle of a fibre has 0.18 a length
    const SmallResult result = run(scene);
    CAPTURE(result.report.reason);
    REQUIRE(result.report.converged);  // the column buckles on its way, and comes down on the straight fibre
    CHECK(result.report.contact.active > 0);
    CHECK(deepest(scene, result) < 0.05);
    double arc = 0.0;
    for (std::size_t k = 1; k < result.centreline[1].size(); ++k)
        arc += (result.centreline[1][k] - result.centreline[1][k - 1]).norm();
    CHECK(arc == test::near(1.0, 2e-3));  // it bends rather than being squeezed by a tenth
}

TEST_CASE("a fibre that goes there and back with friction closes its loop, and no work is lost") {
    // Work is counted by trapezia: what is missed is the bend of the force where sliding begins, of second order.
    double before = 1.0;
    for (const Index increments : {20, 40, 80}) {
        const Cycle cycle = second_cycle(1e-2, increments, 0);
        CHECK(cycle.loop <
              (increments < 40 ? 1e-6 : 1e-8));  // the stiffness adapts an increment at a time, and is not done in the first
        CHECK(cycle.dissipated > 0.0);
        CHECK(std::abs(cycle.error) < 0.5 * before);
        before = std::abs(cycle.error);
    }
    CHECK(before < 3e-4);
    // With that bend resolved the balance closes to a millionth.
    check_resolved_cycle(1e-4, 1e-6);
}

}  // namespace stability_test

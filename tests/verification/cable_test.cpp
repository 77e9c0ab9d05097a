// SPDX-License-Identifier: MIT
// The Kirchhoff cable in the reference problems of a fibre that is straight at rest, and in contact. Its model lies between the
// two of the references: inextensible, and extensible and shearable; they are (r/L)^2 apart in bending.
#include <verification/elements.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace cable_test {

using Model = test::EveryCable;

/// What shear, which the cable leaves out, takes off the force on the middle of a clamped fibre at most: 24 (1 + nu) (r/L)^2 of
/// bending, and N / (G A) of the tension along the four bending layers of the length r / (2 strain^(1/2)).
static double shear_share(double slenderness, double strain) {
    return 24.0 * 1.3 / (slenderness * slenderness) + 5.2 * std::sqrt(strain) / slenderness;
}

TEST_CASE("a slender cantilever of cables converges with the fourth order") {
    const Eigen::Vector2d kirchhoff(14.347209624599, 12.308669949439);  // end_force.json, force_5_slender_1000
    double error[3];
    for (int k = 0; k < 3; ++k) error[k] = (test::pushed_tip<Model>(1000.0, 5.0, 4 << k) - kirchhoff).norm() / 20.1;
    std::printf("P L^2 / EI = 5: %.2e %.2e %.2e of L, order %.2f %.2f\n", error[0], error[1], error[2],
                test::order(error[0], error[1]), test::order(error[1], error[2]));
    CHECK(error[0] < 3e-4);
    CHECK(test::order(error[0], error[1]) > 3.7);
    CHECK(error[2] < 2.6e-6);  // what the models are apart
}

TEST_CASE("a thick cantilever of cables is between the two models of the reference") {
    const Eigen::Vector2d kirchhoff(0.28694419249199, 0.24617339898878),
        reissner(0.28878815435132, 0.24580979130175);  // slender_20
    const Eigen::Vector2d tip = test::pushed_tip<Model>(20.0, 5.0, 16);
    const double apart = (kirchhoff - reissner).norm();
    CHECK((tip - kirchhoff).norm() < apart);
    CHECK((tip - reissner).norm() < 1.6 * apart);
}

TEST_CASE("a moment rolls a cable to the arc of a circle") {
    // end_moment.json; 16 elements of a half circle turn by 11 degrees each
    CHECK((test::rolled_tip<Model>(0.25, 16, 2) - Eigen::Vector2d(1.2796057424588, 1.2796057424588)).norm() < 1e-6 * 2.01);
    CHECK((test::rolled_tip<Model>(0.5, 16, 4) - Eigen::Vector2d(1.2796057424588, 0.0)).norm() < 1e-5 * 2.01);
}

TEST_CASE("a stretched cable between clamps has no membrane locking, and converges where elements resolve the bending layer") {
    // prestretched.json, reissner
    const struct {
        double slenderness, strain, depth, force;
    } cases[] = {{100.0, 0.0, 2.0, 0.0017101073583669},
                 {100.0, 0.01, 2.0, 0.0098088809558458},
                 {1000.0, 0.0, 10.0, 9.1576461780316e-05},
                 {1000.0, 0.01, 2.0, 0.00074918537055306}};
    for (const auto& c : cases) {
        CAPTURE(c.slenderness);
        CAPTURE(c.strain);
        double error[3];
        for (int k = 0; k < 3; ++k)
            error[k] = std::abs(test::sideways_force<Model>(c.slenderness, c.strain, c.depth, 8 << (2 * k)) / c.force - 1.0);
        std::printf("L/r %g, stretch %g: %.2e %.2e %.2e with 8, 32, 128 elements\n", c.slenderness, c.strain, error[0], error[1],
                    error[2]);
        CHECK(error[0] < 0.1);
        CHECK(error[2] < shear_share(c.slenderness, c.strain) + 2e-4);
    }
}

TEST_CASE("a column of cables buckles and bends as the elastica does") {
    const Eigen::Vector2d column = test::buckled_column<Model>(0.10177219073636, 32);  // postbuckling_clamped_clamped_w0.1
    CHECK(column[0] == test::near(0.0023142991053129, 2e-3));
    CHECK(std::abs(column[1]) == test::near(0.402, 1e-3));
}

TEST_CASE("two crossed cables push each other apart as the rods of the reference do") {
    const struct {
        double length, strain, u, force;  // crossed_fibres.json, reissner
    } cases[] = {
        {4.02, 0.0, 0.0402, 6.8765287357e-05}, {4.02, 0.002, 0.1608, 0.00260312107061}, {1.005, 0.0, 0.1608, 0.0618080596752}};
    for (const auto& c : cases)
        for (const double angle : {90.0, 35.0}) {
            CAPTURE(c.u);
            CAPTURE(angle);
            const test::Pressed pressed = test::pressed_fibres<Model>(c.length, c.strain, c.u, angle, 32);
            std::printf("crossed, L %g, stretch %g, u %g, %g degrees: error %+.2e, lost %.2e r\n", c.length, c.strain, c.u, angle,
                        pressed.force / c.force - 1.0, pressed.lost / 0.0201);
            const double strain = c.strain + 0.5 * std::pow(c.u / c.length, 2);  // half of u each, over half of the length
            CHECK(std::abs(pressed.force / c.force - 1.0) < shear_share(c.length / 0.0201, strain) + 5e-4);
            CHECK(pressed.unbalance < 1e-6);
            CHECK(pressed.active == 1);
        }
}

TEST_CASE("two parallel cables pressed along their length lie on each other without an edge") {
    // A fibre on a straight one that is held, both in contact along all their length: the force per length is the same
    // everywhere.
    const double r = 0.0201, length = 1.0, load = 1e-3;
    scene::Assembly assembly;
    for (const double height : {0.0, 2.0 * r}) {
        scene::FibreSpecification fibre = test::ReferenceRod{length, 16}.specification();
        fibre.from = Vec3(0, 0, height), fibre.to = Vec3(length, 0, height), fibre.director = Vec3::UnitY();
        assembly.add(fibre);
    }
    for (int node = 0; node <= 16; ++node) {
        assembly.hold_position({0, node / 16.0});
        assembly.hold_position({1, node / 16.0}, Vec3(1, 1, 0).asDiagonal());
        const double share = node == 0 || node == 16 ? 0.5 : 1.0;
        assembly.apply(scene::DeadForce{{1, node / 16.0}, scene::NodeVector::position, Vec3(0, 0, -share * load / 16.0), "load"});
    }
    test::Solved<Model> solved(assembly);
    REQUIRE(solved.run({{"load", 1.0}}, 2));
    CHECK(solved.report.contact.reaction_sum == test::near(load, 1e-6));
    CHECK(solved.report.contact.active >= 31);
    const double high = solved.simulator.value({1, 0.5}).z(), end = solved.simulator.value({1, 0.0}).z();
    CHECK(std::abs(high - end) < 0.2 * (2.0 * r - high));  // an end's point stands for less of the length
}

}  // namespace cable_test

// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"

#include <fibrant/contact/normal_direction.hpp>

#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace fibrant;

namespace normal_direction_test {

using contact::normal_direction;
using contact::NormalRule;

constexpr double rounding = 1e-14;
const NormalRule rule;
const Vec3 new_contact = Vec3::Zero();

/// Unit vector in the xy plane.
Vec3 heading(double degrees) {
    const double angle = degrees * std::numbers::pi / 180.0;
    return {std::cos(angle), std::sin(angle), 0.0};
}

/// Largest turn of the normal between neighbours while the angle goes from 0 to 60 degrees.
double largest_turn(int steps, const Vec3& centres) {
    double most = 0.0;
    Vec3 last = normal_direction(rule, centres, heading(0), heading(0), new_contact);
    for (int k = 1; k <= steps; ++k) {
        const Vec3 next = normal_direction(rule, centres, heading(0), heading(60.0 * k / steps), new_contact);
        most = std::max(most, (next - last).norm());
        last = next;
    }
    return most;
}

TEST_CASE("the normal of crossing fibres is across both of them and points from the first to the second") {
    for (const double degrees : {30.0, 60.0, 90.0, 135.0}) {
        const Vec3 centres(0.3, -0.2, 0.5);
        for (const double sense : {-1.0, 1.0}) {
            const Vec3 normal = normal_direction(rule, centres, heading(10), sense * heading(10 + degrees), new_contact);
            CHECK((normal - Vec3::UnitZ()).norm() < rounding);
            CHECK((normal_direction(rule, -centres, heading(10), heading(10 + degrees), new_contact) + normal).norm() < rounding);
        }
    }
}

TEST_CASE("the normal of parallel fibres joins their centres across them") {
    const Vec3 centres(0.7, 0.3, 0.4);  // 0.7 of it along the fibres
    for (const double sense : {-1.0, 1.0})
        CHECK((normal_direction(rule, centres, heading(0), sense * heading(0), new_contact) - Vec3(0, 0.6, 0.8)).norm() <
              rounding);
    // 8 degrees apart: across the mean of the two tangents
    const Vec3 along = heading(4), across = (centres - centres.dot(along) * along).normalized();
    CHECK((normal_direction(rule, centres, heading(0), heading(8), new_contact) - across).norm() < rounding);
}

TEST_CASE("half way between the two angles the normal is half way between the two rules") {
    const Vec3 centres(0.0, 0.3, 0.4), along = heading(10);
    const Vec3 parallel = (centres - centres.dot(along) * along).normalized();
    const Vec3 middle = (parallel + Vec3::UnitZ()).normalized();  // the smooth step is 1/2 at 20 degrees
    CHECK((normal_direction(rule, centres, heading(0), heading(20), new_contact) - middle).norm() < rounding);
}

TEST_CASE("the normal turns continuously with the angle between the fibres") {
    // A jump would not shrink with the steps; a continuous turn halves with them.
    for (const Vec3& centres : {Vec3(0.0, 0.9, 0.3), Vec3(0.2, -0.6, -0.2)}) {
        const double coarse = largest_turn(3000, centres), fine = largest_turn(6000, centres);
        CHECK(fine < 0.55 * coarse);
        CHECK(coarse < 0.01);
    }
}

TEST_CASE("fibres that have passed through each other are pushed back the way they came") {
    for (const double degrees : {0.0, 5.0, 15.0, 20.0, 28.0, 45.0, 90.0, 120.0}) {
        Vec3 remembered = new_contact;
        for (int k = 20; k >= -20; --k) {  // the second fibre sinks through the first
            const Vec3 centres(0.0, 0.0, 0.05 * k);
            const Vec3 normal = normal_direction(rule, centres, heading(0), heading(degrees), remembered);
            CHECK((normal - Vec3::UnitZ()).norm() < rounding);
            remembered = normal;
        }
    }
}

TEST_CASE("parallel fibres that pass beside each other keep the side they came from") {
    Vec3 remembered = new_contact;
    for (int k = 20; k >= -20; --k) {
        const Vec3 centres(0.0, 0.01, 0.05 * k);
        const Vec3 normal = normal_direction(rule, centres, heading(0), heading(3), remembered);
        CHECK(normal.norm() == test::near(1.0, 1e-12));
        if (!remembered.isZero()) CHECK(normal.dot(remembered) >= 0.0);
        remembered = normal;
    }
}

TEST_CASE("a crossing that turns through 90 degrees keeps its side") {
    Vec3 remembered = new_contact;
    for (double degrees = 31.0; degrees < 149.0; degrees += 0.5) {
        remembered =
            normal_direction(rule, {0.0, 0.0, remembered.isZero() ? 0.1 : -0.1}, heading(0), heading(degrees), remembered);
        CHECK((remembered - Vec3::UnitZ()).norm() < rounding);
    }
}

TEST_CASE("the normal is a unit vector, changes sign with the order of the fibres and turns with the scene") {
    std::mt19937 generator(1);
    for (int n = 0; n < 500; ++n) {
        const Vec3 centres = test::normal_vector(generator), t_i = test::normal_vector(generator).normalized();
        const Vec3 t_j = n % 2 == 0 ? test::normal_vector(generator).normalized()
                                    : Vec3((t_i + 0.2 * test::normal_vector(generator)).normalized());
        const Vec3 remembered = n % 3 == 0 ? new_contact : Vec3(test::normal_vector(generator).normalized());
        const Vec3 normal = normal_direction(rule, centres, t_i, t_j, remembered);
        CHECK(std::abs(normal.norm() - 1.0) < rounding);
        // across the mean of the tangents; the cross product loses digits where the fibres are nearly parallel
        CHECK(std::abs(normal.dot(contact::mean_tangent(t_i, t_j))) < 1e-13);
        CHECK((normal_direction(rule, -centres, t_j, t_i, -remembered) + normal).norm() < 1e-13);
        const Mat3 turn = Eigen::AngleAxisd(1.0 + n, test::normal_vector(generator).normalized()).toRotationMatrix();
        CHECK((normal_direction(rule, turn * centres, turn * t_i, turn * t_j, turn * remembered) - turn * normal).norm() < 1e-12);
    }
}

TEST_CASE("coincident parallel fibres without a memory part to a fixed side") {
    const Vec3 normal = normal_direction(rule, Vec3::Zero(), heading(25), heading(25), new_contact);
    CHECK(std::abs(normal.norm() - 1.0) < rounding);
    CHECK(std::abs(normal.dot(heading(25))) < rounding);
    CHECK(normal == normal_direction(rule, Vec3::Zero(), heading(25), heading(25), new_contact));
}

TEST_CASE("fibres that part in one plane are pushed apart in that plane, not across it") {
    const double touching = 0.1;
    for (const double degrees : {5.0, 20.0, 40.0, 80.0}) {
        const Vec3 aside =
            0.6 * touching *
            Vec3(-std::sin(0.5 * degrees * std::numbers::pi / 180.0), std::cos(0.5 * degrees * std::numbers::pi / 180.0), 0.0);
        for (const double height : {0.0, 1e-3 * touching}) {
            const Vec3 centres = aside + height * Vec3::UnitZ();
            CHECK((normal_direction(rule, centres, heading(0), heading(degrees), new_contact, touching) - centres.normalized())
                      .norm() < rounding);
            // and where they pass over each other, across both, with the blend of any other crossing
            const Vec3 over = height * Vec3::UnitZ() + 0.4 * aside;
            CHECK((normal_direction(rule, over, heading(0), heading(degrees), new_contact, touching) -
                   normal_direction(rule, over, heading(0), heading(degrees), new_contact))
                      .norm() < rounding);
        }
    }
    Vec3 last = Vec3::UnitZ();
    for (int k = 0; k <= 4000; ++k) {  // between them it turns continuously
        const Vec3 normal = normal_direction(rule, 0.3 * touching * Vec3::UnitZ() + touching * k / 4000.0 * heading(115),
                                             heading(0), heading(50), last, touching);
        CHECK((normal - last).norm() < 2e-3);
        last = normal;
    }
    CHECK(last.z() < 0.3);
}

TEST_CASE("angles in the wrong order are refused") {
    CHECK(test::refusal([] {
              core::validated(NormalRule{40.0, 30.0});
          }).find("NormalRule.crossing_angle_deg") != std::string::npos);
    CHECK(test::refusal([] {
              core::validated(NormalRule{-1.0, 30.0});
          }).find("NormalRule.parallel_angle_deg") != std::string::npos);
}

TEST_CASE("the least turn takes one direction to the other and leaves what is across both of them") {
    std::mt19937 generator(5);
    for (int k = 0; k < 200; ++k) {
        const Vec3 before = test::normal_vector(generator).normalized();
        const Vec3 after = k == 0 ? Vec3(-before) : k == 1 ? before : test::normal_vector(generator).normalized();
        const Vec3 vector = test::normal_vector(generator), image = contact::turned(vector, before, after);
        const double amplified =
            1e-15 / std::max(1e-14, 1.0 + before.dot(after));  // the axis is a difference of rounded products
        CHECK((contact::turned(before, before, after) - after).norm() < rounding + amplified);
        CHECK(std::abs(image.norm() - vector.norm()) < vector.norm() * (rounding + amplified));
        const Vec3 axis = before.cross(after);
        if (k > 1) CHECK((contact::turned(axis, before, after) - axis).norm() < rounding);
    }
}

}  // namespace normal_direction_test

// SPDX-License-Identifier: MIT
// Cantilever rolled up by a moment at its end. Reference: the closed form of the director rod, uniform along its
// length.
#include <beam/round_rod.hpp>

using namespace fibrant;

namespace verification_end_moment_test {

using namespace fibrant::test;

struct Rolled {
    double tip_x = 0, tip_z = 0, mid_x = 0, mid_z = 0, rotation = 0, norm_1 = 0, norm_2 = 0;
    RodSolution solution;
};

/// Moment 2 pi turns EI/L about +y; it turns with the end section, about g_2, which stays on y.
Rolled roll(const RoundRod& rod, double turns, int intervals) {
    Rod<> mesh = rod.mesh(intervals);
    mesh.place(0, straight(0.0), false);
    const double moment = 2.0 * std::numbers::pi * turns * rod.EI() / rod.length;
    const int steps = std::max(1, static_cast<int>(std::ceil(8.0 * turns)));
    Rolled r;
    r.solution = mesh.follow(steps, [&](double t) { mesh.body_moment(intervals) = Vec3(0, t * moment, 0); });
    const Vec3 tip = mesh.position(intervals), mid = mesh.position(intervals / 2), g1 = mesh.director(intervals, 1);
    const double angle = std::atan2(-g1[2], g1[0]), turn = 2.0 * std::numbers::pi;
    r.tip_x = tip[0], r.tip_z = tip[2], r.mid_x = mid[0], r.mid_z = mid[2];
    r.rotation = angle + turn * std::round((turns * turn - angle) / turn);
    r.norm_1 = mesh.director(intervals / 2, 1).norm(), r.norm_2 = mesh.director(intervals / 2, 2).norm();
    return r;
}

struct Case {
    double turns;
    Rolled expected;  ///< results.director of end_moment.json
};
const Case cases[] = {
    {0.25,
     {1.2796766482683,
      1.2793293778327,
      0.37482968350853,
      0.90474526540749,
      1.5710677372018,
      0.99995680835633,
      1.0000370199241,
      {}}},
    {0.5,
     {1.2784983165705,
      -0.00138961314202,
      0.63994472045916,
      0.63924953588138,
      3.1437664735734,
      0.99982708767464,
      1.0001481867712,
      {}}},
    {1.0,
     {4.865978569204e-05,
      0.0055697776239427,
      0.63757367934751,
      -0.0027849950877388,
      6.3006576556481,
      0.999306003096,
      1.0005944713774,
      {}}},
};

TEST_CASE("an end moment rolls a fibre up into the uniform curve of the director rod, with the fourth order") {
    const RoundRod rod;
    std::printf("distance of the tip over L, n = 16 32 64 128\n");
    for (const Case& c : cases) {
        CAPTURE(c.turns);
        std::vector<double> error;
        Rolled finest;
        for (const int n : {16, 32, 64, 128}) {
            finest = roll(rod, c.turns, n);
            REQUIRE(finest.solution.converged);
            error.push_back(std::hypot(finest.tip_x - c.expected.tip_x, finest.tip_z - c.expected.tip_z) / rod.length);
        }
        char name[64];
        std::snprintf(name, sizeof name, "%g turns", c.turns);
        print_row(name, error);
        // The published trial of this element: 1.2e-3, 5.4e-5, 3.2e-6, 2.0e-7 for the full circle.
        CHECK(error[0] < 2e-3);
        CHECK(error[1] < 8e-5);
        CHECK(error[2] < 5e-6);
        CHECK(error[3] < 3e-7);
        CHECK(order(error[2], error[3]) > 3.7);
        CHECK(std::hypot(finest.mid_x - c.expected.mid_x, finest.mid_z - c.expected.mid_z) < 1e-6 * rod.length);
        CHECK(std::abs(finest.rotation - c.expected.rotation) < 2e-7 * c.expected.rotation);  // the mesh error above
        CHECK(std::abs(finest.norm_1 - c.expected.norm_1) < 1e-6);
        CHECK(std::abs(finest.norm_2 - c.expected.norm_2) < 1e-6);
    }
}

}  // namespace verification_end_moment_test

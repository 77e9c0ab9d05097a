// SPDX-License-Identifier: MIT
// Yarns whose ends nothing holds: which are kept by friction, and by how much of it.
#include <near.hpp>

#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/free_ends.hpp>
#include <fibrant/compositions/textile/weaves.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <string>
#include <vector>

namespace textile_free_ends_test {

using namespace fibrant;
using namespace fibrant::compositions::textile;

YarnType yarn(double radius = 0.05) {
    YarnType type;
    type.radius = radius;
    type.material = {3000.0, 0.3};
    return type;
}
Textile ending(Textile textile, Ends ends = Ends::free) {
    for (Path& path : textile.paths) path.ends = ends, path.tension_strain = 1e-3;
    return textile;
}
Textile weave(const std::vector<std::string>& levels, double spacing, const YarnType& type = yarn()) {
    LevelPlan plan;
    plan.levels = levels_of(levels), plan.warp = plan.weft = plan.binder = type;
    plan.column_spacing = plan.warp_spacing = spacing;
    return ending(woven(plan));
}

TEST_CASE("outermost yarns of three by three stay where friction is 3 d / 2 p: that is how far those across them lean there") {
    // Forces are as 1, 2, 1 along a yarn, deflections of outer and middle yarns 2 d / 3 and 4 d / 3, slopes at their ends
    // 3 / 2 p of these, and the push on an outer yarn 6 d / p of forces that are 4 in all. What is left is the penalty.
    const double d = 0.1;
    for (const double spacing : {0.5, 1.0, 1.5}) {
        CAPTURE(spacing);
        const FrictionNeeded needed = friction_that_holds(weave({"010", "101", "010"}, spacing));
        CHECK(needed.coefficient == test::near(1.5 * d / spacing, 1e-3));
        CHECK(needed.path != 1);  // a middle yarn is pushed to both sides alike
        CHECK(needed.path != 4);
    }
    // The same in metres.
    CHECK(friction_that_holds(weave({"010", "101", "010"}, 1e-3, yarn(5e-5))).coefficient == test::near(0.15, 1e-3));
}

TEST_CASE("yarns that interlace on straight lines need no friction, however many: two warps, and a twill of four") {
    CHECK(friction_that_holds(weave({"010101", "101010"}, 0.6)).path == -1);
    CHECK(friction_that_holds(weave({"0011", "0110", "1100", "1001"}, 0.6)).path == -1);
    CHECK(friction_that_holds(weave({"0101", "1010", "0101", "1010"}, 0.6)).coefficient > 0.3);  // four plain ones cannot
}

TEST_CASE("braids that are straight at rest are held by no friction; ends that are held, and yarns at rest as drawn, need none") {
    const Textile flat = ending(
        flat_braid({.yarns = 3, .half_width = 0.18, .period = 1.8, .periods = 2.0, .type = yarn(), .height_over_radius = 0.3}));
    CHECK(friction_that_holds(flat).coefficient > 10.0);
    const Textile tube = ending(tubular_braid({.carriers = 4, .radius = 0.4, .pitch = 2.5, .turns = 1.0, .type = yarn()}));
    CHECK(std::isinf(friction_that_holds(tube).coefficient));
    CHECK(friction_that_holds(ending(flat, Ends::held)).path == -1);
    CHECK(friction_that_holds(ending(flat, Ends::pulled)).path == -1);
    Textile drawn = flat;
    for (Path& path : drawn.paths) path.straight = false;
    CHECK(friction_that_holds(drawn).path == -1);
}

}  // namespace textile_free_ends_test

// SPDX-License-Identifier: MIT
// Forty random scenes whose fibres are driven far at once: none passes through another one, by brute force.
#include <stability/tangled_scenes.hpp>

using namespace fibrant;

namespace passage_random_test {

TEST_CASE("forty random scenes driven far in few increments: no accepted increment takes a fibre through another one") {
    test::check_passages(1, 40);
}

// Two that touch along a line bend around each other until they cross: the line goes on beyond the stations that a crossing
// begins with.
TEST_CASE("a line of contact that becomes a crossing goes on to hold all along") { test::check_passages(16, 1, true); }

TEST_CASE("a hook in a straight fibre, rings through each other and around a fibre, flat fibres: held, and none passes") {
    CHECK(test::check_tangles(1, 4).converged == 4);
}

}  // namespace passage_random_test

// SPDX-License-Identifier: MIT
// Forty random scenes whose fibres are driven far at once: none passes through another one, by brute force.
#include <stability/passage_scenes.hpp>

using namespace fibrant;

namespace passage_random_test {

TEST_CASE("forty random scenes driven far in few increments: no accepted increment takes a fibre through another one") { test::check_passages(1, 40); }

// Two that touch along a line bend around each other until they cross: the line goes on beyond the stations that a crossing begins with.
TEST_CASE("a line of contact that becomes a crossing goes on to hold all along") { test::check_passages(16, 1, true); }

}  // namespace passage_random_test

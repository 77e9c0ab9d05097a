// SPDX-License-Identifier: MIT
// Forty random scenes whose fibres are driven far at once: none passes through another one, by brute force.
#include <stability/passage_scenes.hpp>

using namespace fibrant;

namespace passage_random_test {

TEST_CASE("forty random scenes driven far in few increments: no accepted increment takes a fibre through another one") { test::check_passages(1, 40); }

}  // namespace passage_random_test

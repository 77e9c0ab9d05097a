// SPDX-License-Identifier: MIT
// Four hundred random scenes whose fibres are driven far at once: none passes through another one, by brute force.
#include <stability/passage_scenes.hpp>

using namespace fibrant;

namespace passage_long_test {

TEST_CASE("four hundred random scenes driven far in few increments: no accepted increment takes a fibre through another one") {
    test::check_passages(1001, 400);
}

}  // namespace passage_long_test

// SPDX-License-Identifier: MIT
// Two hundred random scenes of hooks, rings and flat fibres, driven far in few increments: nothing passes through anything, by
// brute force.
#include <stability/tangled_scenes.hpp>

using namespace fibrant;

namespace tangled_long_test {

TEST_CASE(
    "two hundred random hooks, rings and flat fibres driven far: no accepted increment takes a fibre through another one, and "
    "what stops says why") {
    const test::TangledCount sum = test::check_tangles(1, 200, true);
    std::printf("%llu of %llu converged, closest on the way %.3f of touching\n", static_cast<unsigned long long>(sum.converged),
                static_cast<unsigned long long>(sum.scenes), sum.closest);
    CHECK(2 * sum.converged > sum.scenes);
}

}  // namespace tangled_long_test

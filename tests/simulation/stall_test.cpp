// SPDX-License-Identifier: MIT
// A separation that gets on no more is told from one that does.
#include <fibrant/simulation/stall.hpp>

#include <doctest/doctest.h>

#include <vector>

namespace stall_test {

using namespace fibrant;

std::vector<simulation::IncrementReport> figures(Index count, Index (*limited)(Index), double (*deepest)(Index)) {
    std::vector<simulation::IncrementReport> increments(core::at(count));
    for (Index k = 0; k < count; ++k)
        increments[core::at(k)].contact.shifted = limited(k), increments[core::at(k)].contact.greatest_penetration = deepest(k);
    return increments;
}

TEST_CASE("what goes to and fro between two states stands still; what gets fewer or less deep gets on, be it by turns") {
    const auto to_and_fro = figures(
        40, [](Index) -> Index { return 1; }, [](Index k) { return k % 2 == 0 ? 0.16 : 0.2; });
    CHECK(simulation::stalled(to_and_fro, 40, 30));
    CHECK_FALSE(simulation::stalled(to_and_fro, 30, 30));  // too early to say
    CHECK_FALSE(simulation::stalled(to_and_fro, 20, 30));  // the others are of the stage before
    const auto fewer = figures(
        40, [](Index k) { return 40 - k; }, [](Index) { return 2.0; });
    CHECK_FALSE(simulation::stalled(fewer, 40, 30));
    const auto less_deep = figures(
        40, [](Index) -> Index { return 2; }, [](Index k) { return 4.0 - 0.1 * double(k); });
    CHECK_FALSE(simulation::stalled(less_deep, 40, 30));
    const auto creeping = figures(
        40, [](Index) -> Index { return 2; }, [](Index k) { return 4.0 - 1e-3 * double(k); });
    CHECK(simulation::stalled(creeping, 40, 30));  // by 0.03 of 4 in 30 increments
}

}  // namespace stall_test

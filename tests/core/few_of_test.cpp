// SPDX-License-Identifier: MIT
#include "support/threads.hpp"

#include <fibrant/core/few_of.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace few_of_test {

TEST_CASE("items that have a value give it, all others nothing, and only the former take memory, on any number of threads") {
    for (const int threads : {1, 2, 3})
        test::with_threads(threads, [] {
            core::FewOf<double> few;
            CHECK(few.empty());
            for (const Index size : {0, 1, 255, 256, 257, 3000, 700}) {
                const auto has = [&](Index k) { return (k * k) % 7 == 1 || k == size - 1; };
                few.fill(core::at(size), [&](Index k, double& value) {
                    value = static_cast<double>(k) + 0.5;
                    return has(k);
                });
                CHECK(few.size() == core::at(size));
                std::size_t expected = 0;
                for (Index k = 0; k < size; ++k) {
                    REQUIRE(few[core::at(k)] == (has(k) ? static_cast<double>(k) + 0.5 : 0.0));
                    expected += has(k) ? 1 : 0;
                }
                CHECK(few.values() == expected);
            }
            few.change([](double& value) { value = -value; });
            CHECK(few[1] == -1.5);
            CHECK(few[2] == 0.0);
            few.clear();
            CHECK(few.empty());
            CHECK(few.values() == 0);
        });
}

}  // namespace few_of_test

// SPDX-License-Identifier: MIT
#include <fibrant/core/large_array.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <utility>

using namespace fibrant;

namespace large_array_test {

TEST_CASE("a large array is aligned for vectors, in large pages from 4 MiB on, and stays where it is as long as its size does") {
    for (const Index size : {Index{1}, Index{1000}, Index{1} << 20}) {
        core::LargeArray<double> a;
        CHECK(a.size() == 0);
        a.resize(size);
        CHECK(a.size() == size);
        const auto place = reinterpret_cast<std::uintptr_t>(a.data());
        CHECK(place % (size * 8 >= 4 << 20 ? std::uintptr_t{1} << 21 : 64) == 0);
        a.data()[0] = 1.0, a.data()[size - 1] = 2.0;
        a.resize(size);
        CHECK(a.data()[size - 1] == 2.0);
        const core::LargeArray<double> b = std::move(a);
        CHECK(reinterpret_cast<std::uintptr_t>(b.data()) == place);
    }
    core::LargeArray<float> none;
    none.resize(0);
    CHECK(none.size() == 0);
}

}  // namespace large_array_test

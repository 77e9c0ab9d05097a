// SPDX-License-Identifier: MIT
#include <fibrant/core/blocks.hpp>
#include <fibrant/core/large_array.hpp>

#include <doctest/doctest.h>

#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

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

TEST_CASE("a vector that is made larger a little at a time has room for an eighth more, not for as many again") {
    std::vector<Index> written, added;
    for (std::size_t size = 1000; size < 100'000; size += size / 20) {
        core::resize_anew(written, size);
        CHECK(written.size() == size);
        CHECK(written.capacity() <= size + size / 8);
        for (auto k = static_cast<Index>(added.size()); k < static_cast<Index>(size); ++k) {
            core::reserve_for(added, added.size() + 1);
            added.push_back(k);
        }
        CHECK(added.capacity() <= size + size / 8);
    }
    for (std::size_t k = 0; k < added.size(); ++k) REQUIRE(added[k] == static_cast<Index>(k));
    core::release(added);
    CHECK(added.capacity() == 0);
}

TEST_CASE("blocks hold what is put behind, stay where they are as they grow, and give back what is far beyond their size") {
    using Blocks = core::Blocks<Index>;
    Blocks all;
    CHECK(all.empty());
    Index sum = 0;
    const Index* first = nullptr;
    for (Index turn = 0; turn < 20; ++turn) {
        std::vector<std::vector<Index>> parts(7);
        for (Index p = 0; p < 7; ++p)
            for (Index k = 0; k < 100 * p + turn; ++k) parts[core::at(p)].push_back(sum++);
        all.append(parts);
        if (turn == 0) first = &all[0];
        CHECK(first == &all[0]);
    }
    REQUIRE(all.size() == core::at(sum));
    Index k = 0;
    for (Index& value : all) REQUIRE(value == k++);
    CHECK(k == sum);
    k = 0;
    for (const Index& value : std::as_const(all)) REQUIRE(value == k++);
    CHECK(all.front() == 0);
    CHECK(all.back() == sum - 1);
    const auto part = std::as_const(all).part(1000, 3000);
    CHECK(*part.begin() == 1000);
    CHECK(std::distance(part.begin(), part.end()) == 2000);
    const Blocks copy = all;
    CHECK(copy[copy.size() - 1] == sum - 1);
    CHECK(all.room() < all.size() + Blocks::block);
    all.clear();
    CHECK(all.empty());
    CHECK(all.room() >= core::at(sum));
    all.append({std::vector<Index>(100, 5)});
    all.trim();
    CHECK(all.size() == 100);
    CHECK(all[99] == 5);
    CHECK(all.room() == Blocks::block);
}

}  // namespace large_array_test

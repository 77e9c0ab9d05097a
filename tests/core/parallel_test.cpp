// SPDX-License-Identifier: MIT
#include "support/threads.hpp"

#include <fibrant/core/parallel.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cstring>
#include <random>
#include <stdexcept>

using namespace fibrant;

namespace parallel_test {

Vector random_vector(Index n, unsigned seed) {
    std::mt19937 random(seed);
    Vector v(n);
    for (Index k = 0; k < n; ++k) v[k] = std::ldexp(static_cast<double>(random()), static_cast<int>(random() % 60) - 30);
    return v;
}

TEST_CASE("a loop visits every item once, whatever the number of threads") {
    for (const int threads : {1, 2, 3}) {
        test::with_threads(threads, [] {
            std::vector<int> visits(1001, 0);
            core::parallel_for(1001, [&](Index k) { ++visits[core::at(k)]; });
            CHECK(std::count(visits.begin(), visits.end(), 1) == 1001);
            core::parallel_for<core::Share::turns>(1001, [&](Index k) { ++visits[core::at(k)]; });
            CHECK(std::count(visits.begin(), visits.end(), 2) == 1001);
            core::parallel_for(0, [&](Index) { FAIL("no items"); });
        });
    }
}

TEST_CASE("an exception leaves the loop that threw it, with its own type and message") {
    for (const int threads : {1, 2}) {
        test::with_threads(threads, [] {
            CHECK_THROWS_WITH_AS(core::parallel_for(100,
                                                    [](Index k) {
                                                        if (k == 73) throw std::domain_error("item 73");
                                                    }),
                                 "item 73", std::domain_error);
            CHECK_THROWS_WITH_AS(core::parallel_for<core::Share::turns>(100,
                                                                        [](Index k) {
                                                                            if (k == 73) throw std::domain_error("item 73");
                                                                        }),
                                 "item 73", std::domain_error);
        });
    }
}

TEST_CASE("parts are joined in their order, and what the whole held before is gone") {
    for (const int threads : {1, 2, 3}) {
        test::with_threads(threads, [] {
            std::vector<std::vector<Index>> parts(100);
            std::vector<Index> expected, whole(10'000, -1);
            for (Index p = 0; p < 100; ++p)
                for (Index k = 0; k < (p * p) % 7; ++k)
                    parts[core::at(p)].push_back(1000 * p + k), expected.push_back(1000 * p + k);
            core::join(parts, whole);
            CHECK(whole == expected);
            core::join(std::vector<std::vector<Index>>{}, whole);
            CHECK(whole.empty());
        });
    }
}

TEST_CASE("a loop within a loop runs on its own thread and still visits everything") {
    test::with_threads(2, [] {
        std::vector<Index> sum(8, 0);
        core::parallel_for(8, [&](Index k) { core::parallel_for(100, [&](Index m) { sum[core::at(k)] += m; }); });
        for (const Index value : sum) CHECK(value == 4950);
    });
}

TEST_CASE("a sum has the same bits for one thread and for several") {
    // Terms that span 60 binary orders, so that any other order of summation shows.
    const Vector v = random_vector(100'003, 7);
    const auto total = [&](int threads) {
        return test::with_threads(threads, [&] {
            return core::ordered_sum(v.size(), 0.0, [&](Index first, Index last) {
                double sum = 0.0;
                for (Index k = first; k < last; ++k) sum += v[k];
                return sum;
            });
        });
    };
    const double one = total(1);
    for (const int threads : {2, 3, 5}) {
        const double several = total(threads);
        CHECK(std::memcmp(&one, &several, sizeof one) == 0);
    }
    CHECK(one == test::near(v.sum(), 1e-12));
}

TEST_CASE("a dot product has the same bits for one thread and for several, and its value is right") {
    const Vector a = random_vector(70'000, 1), b = random_vector(70'000, 2);
    const double one = test::with_threads(1, [&] { return core::dot(a, b); });
    const double two = test::with_threads(2, [&] { return core::dot(a, b); });
    CHECK(std::memcmp(&one, &two, sizeof one) == 0);
    CHECK(one == test::near(a.dot(b), 1e-12));  // all terms are positive: no cancellation
}

TEST_CASE("a sum over nothing is its zero") {
    CHECK(core::ordered_sum(0, 3.5, [](Index, Index) { return 1.0; }) == 3.5);
    CHECK(core::ordered_sum(1, 3.5, [](Index, Index) { return 1.0; }) == 4.5);
}

}  // namespace parallel_test

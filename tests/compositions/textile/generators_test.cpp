// SPDX-License-Identifier: MIT
// Generators: crossings counted against closed forms, and who alternates how.
#include "../../refusal.hpp"

#include <fibrant/compositions/textile/braids.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>
#include <string>

namespace textile_generators_test {

using namespace fibrant;
using namespace fibrant::compositions::textile;
using fibrant::test::refusal;

YarnType yarn(double radius = 0.05) {
    YarnType type;
    type.radius = radius;
    type.material = {3000.0, 0.3};
    return type;
}
/// Letters come in runs of `run`, but for the first and the last run, which ends may have cut.
bool in_runs_of(const std::string& word, std::size_t run) {
    std::size_t start = 0;
    for (std::size_t k = 1; k <= word.size(); ++k) {
        if (k < word.size() && word[k] == word[start]) continue;
        const std::size_t size = k - start;
        if (size > run || (size < run && start > 0 && k < word.size())) return false;
        start = k;
    }
    return true;
}

TEST_CASE("a flat braid of N yarns has N (N - 1) crossings a period, and each yarn alternates across its turns") {
    for (const Index n : {3, 4, 5, 7, 8}) {
        const double r = 0.05;
        const Textile braid = flat_braid({.yarns = n, .half_width = 1.6 * static_cast<double>(n) * r, .period = 16.0 * static_cast<double>(n) * r, .periods = 3.0, .type = yarn(r)});
        CHECK(core::count(braid.crossings) == 3 * n * (n - 1));
        for (const std::string& word : order_words(braid.crossings, n)) {
            CHECK(core::count(word) == 3 * 2 * (n - 1));
            CHECK(in_runs_of(word, 1));
        }
        CHECK(refusal([&] { validate(braid); }).empty());
        CHECK(refusal([&] { require_holding(braid); }).empty());
    }
}

TEST_CASE("a tubular braid of n and n carriers has 2 n^2 crossings a turn, in runs of one or two, at the angle of its pitch") {
    for (const Index over : {1, 2})
        for (const Index n : {4, 6, 8}) {
            const double r = 0.05, radius = 2.0 * static_cast<double>(n) * r, pitch = 2.0 * std::numbers::pi * radius;
            const TubularBraid parameters{.carriers = n, .radius = radius, .pitch = pitch, .turns = 1.0, .over = over, .type = yarn(r)};
            const Textile braid = tubular_braid(parameters);
            CHECK(core::count(braid.crossings) == 2 * n * n);
            for (const std::string& word : order_words(braid.crossings, 2 * n)) {
                CHECK(core::count(word) == 2 * n);
                CHECK(in_runs_of(word, static_cast<std::size_t>(over)));
            }
            CHECK(parameters.angle() == doctest::Approx(std::numbers::pi / 4.0).epsilon(1e-12));
            // The mean of a carrier's slope over a whole turn is that of the helix: heights only go to and fro.
            const Path& path = braid.paths.front();
            const double rise = path.curve(1.0).z() - path.curve(0.0).z();
            CHECK(std::tan(parameters.angle()) == doctest::Approx(2.0 * std::numbers::pi * radius / rise).epsilon(1e-12));
            CHECK(refusal([&] { require_holding(braid); }).empty());
        }
    CHECK(refusal([] { tubular_braid({.carriers = 5, .radius = 1.0, .pitch = 1.0, .over = 2, .type = yarn()}); }).find("TubularBraid.over = 2") == 0);
}

TEST_CASE("axial yarns of a triaxial tube pass between the two that meet on them: two orders a passage") {
    const Index n = 6;
    const double r = 0.05, radius = 3.0 * static_cast<double>(n) * r;
    const Textile braid = tubular_braid({.carriers = n, .radius = radius, .pitch = 2.0 * std::numbers::pi * radius, .turns = 1.0, .axials = true, .type = yarn(r)});
    // An axial line meets each carrier of each way once a turn.
    CHECK(core::count(braid.crossings) == 2 * n * n + 2 * n * n);
    for (const Crossing& crossing : braid.crossings) {
        if (crossing.below >= 2 * n) CHECK(crossing.above >= n);
        if (crossing.above >= 2 * n) CHECK(crossing.below < n);
    }
}

}  // namespace textile_generators_test

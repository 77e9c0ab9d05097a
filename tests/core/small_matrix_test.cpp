// SPDX-License-Identifier: MIT
#include <fibrant/core/small_matrix.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace small_matrix_test {
using namespace fibrant;

TEST_CASE("the inverse of two rows times the matrix is one") {
    const core::TwoByTwo m{core::Two{2.0, 1.0}, core::Two{-3.0, 4.0}};
    CHECK(std::abs(core::determinant(m) - 11.0) <= 1e-15 * 11.0);
    const core::TwoByTwo one = core::times_transposed(core::inverse(m), core::transposed(m));
    CHECK(core::norm(core::TwoByTwo{core::Two{one[0][0] - 1.0, one[0][1]}, core::Two{one[1][0], one[1][1] - 1.0}}) < 1e-15);
    const double row = std::sqrt(5.0);
    CHECK(std::abs(core::norm(core::times(core::transposed(m), {1.0, 0.0})) - row) <= 1e-15 * row);
}

TEST_CASE("four equations are solved whatever the order of their rows") {
    std::mt19937 random(5);
    std::normal_distribution<double> normal;
    for (int k = 0; k < 100; ++k) {
        core::FourByFour m{};
        core::Four wanted{}, b{};
        for (core::Four& row : m)
            for (double& entry : row) entry = normal(random);
        if (k % 2 == 0) m[0][0] = m[1][1] = 0.0;
        for (double& entry : wanted) entry = normal(random);
        for (std::size_t r = 0; r < 4; ++r)
            for (std::size_t c = 0; c < 4; ++c) b[r] += m[r][c] * wanted[c];
        const core::Four found = core::solve(m, b);
        for (std::size_t r = 0; r < 4; ++r) CHECK(std::abs(found[r] - wanted[r]) < 1e-9);
    }
}

TEST_CASE("what singular equations say nothing of is zero") {
    core::FourByFour m{};
    m[0] = {1.0, 0.0, 0.0, 0.0}, m[2] = {0.0, 0.0, 4.0, 0.0};
    CHECK(core::solve(m, {3.0, 0.0, 8.0, 0.0}) == core::Four{3.0, 0.0, 2.0, 0.0});
    CHECK(core::solve({}, {3.0, 0.0, 8.0, 0.0}) == core::Four{});
}

}  // namespace small_matrix_test

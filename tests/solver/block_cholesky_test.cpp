// SPDX-License-Identifier: MIT
#include <fibrant/solver/block_cholesky.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace fibrant;

namespace block_cholesky_test {

// Two sets of vectors that are coupled to all of a hub and among themselves, but not to each other: one of them leaves a wide
// square to the wide front that the rest is, more than any strip of a product.
struct Pair {
    static constexpr int set = 130, all = 2 * set + 540;
    std::vector<solver::Supernodes::Pair> pairs;
    Pair() {
        for (int i = 0; i < all; ++i)
            for (int j = 0; j < i; ++j)
                if (!(j < set && i >= set && i < 2 * set)) pairs.emplace_back(i, j);
    }
    static Mat3 block(int i, int j) {
        Mat3 b;
        for (int r = 0; r < 3; ++r)
            for (int c = 0; c < 3; ++c) b(r, c) = std::cos(1.7 * i + 0.31 * j * j + 2.3 * r + 0.9 * c) / (3.0 * all);
        return b;
    }
    // Off the diagonal a row sums to less than 1, so the eigenvalues are between 1 and 3.
    template <class Real>
    void fill(solver::BlockCholesky<Real>& a, double scale) const {
        a.clear();
        for (int k = 0; k < all; ++k) a.add(k, k, Mat3(2.0 * scale * Mat3::Identity()));
        for (const auto& [i, j] : pairs) a.add(i, j, Mat3(scale * block(i, j)));
    }
    Vector product(const Vector& x) const {
        Vector y = 2.0 * x;
        for (const auto& [i, j] : pairs) {
            y.segment<3>(3 * i) += block(i, j) * x.segment<3>(3 * j);
            y.segment<3>(3 * j) += block(i, j).transpose() * x.segment<3>(3 * i);
        }
        return y;
    }
};

TEST_CASE_TEMPLATE("wide fronts are factored as exactly as narrow ones, and again in the memory of the first time", Real, float,
                   double) {
    const Pair both;
    solver::BlockCholesky<Real> a;
    a.analyse(std::vector<int>(Pair::all, 3), both.pairs);
    CHECK(a.fill() < 9 * Pair::all * Pair::all);  // in two fronts
    const Vector known = Vector::LinSpaced(3 * Pair::all, -1.0, 2.0), b = both.product(known);
    const double rounding = sizeof(Real) == 4 ? 1e-5 : 1e-13;  // 2400 terms a sum, condition number below 3
    for (const double scale : {1.0, 4.0}) {
        both.fill(a, scale);
        const auto pivots = a.factor();
        CHECK(pivots.dropped == 0);
        Vector x = scale * b;
        a.solve(x);
        CHECK((x - known).norm() < rounding * known.norm());
    }
}

}  // namespace block_cholesky_test

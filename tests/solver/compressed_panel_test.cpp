// SPDX-License-Identifier: MIT
#include <fibrant/solver/float_block_cholesky.hpp>

#include "linear_solver_contract.hpp"
#include "support/fabric_system.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <vector>

using namespace fibrant;

namespace compressed_panel_test {

using Block = solver::LowRankBlock<double>;

Matrix matrix_of(const Block& block) { return block.whole ? Matrix(block.left) : Matrix(block.left * block.right.transpose()); }

TEST_CASE("a block keeps what its rows can feel: of a smooth kernel little, of one that is as rough as can be all") {
    Matrix smooth(120, 90), rough(60, 60);
    for (Index i = 0; i < smooth.rows(); ++i)
        for (Index j = 0; j < smooth.cols(); ++j)
            smooth(i, j) = 1.0 / (2.0 + static_cast<double>(i) / 120.0 + static_cast<double>(j) / 90.0);
    for (Index i = 0; i < 60; ++i)
        for (Index j = 0; j < 60; ++j)
            rough(i, j) = std::sqrt(2.0 / 60.0) *
                          std::cos(std::acos(-1.0) * (static_cast<double>(i) + 0.5) * (static_cast<double>(j) + 0.5) / 60.0);
    Block block;
    for (const double tolerance : {1e-2, 1e-4, 1e-8}) {
        block.compress(smooth, Vector::Ones(120), tolerance);
        CHECK_FALSE(block.whole);
        CHECK(block.rank() <= 8);  // a kernel of the sum of two variables in [0, 1], 2 from its pole: a digit a term and more
        CHECK((matrix_of(block) - smooth).cwiseAbs().maxCoeff() <= tolerance);
    }
    // Rows are measured by their own scale, and come back in it.
    Vector scale = Vector::Ones(120);
    scale.head(60).setConstant(1e3);
    const Matrix scaled = scale.asDiagonal() * smooth;
    block.compress(scaled, scale, 1e-4);
    CHECK((matrix_of(block) - scaled).topRows(60).cwiseAbs().maxCoeff() <= 0.1);
    CHECK((matrix_of(block) - scaled).bottomRows(60).cwiseAbs().maxCoeff() <= 1e-4);
    CHECK((matrix_of(block) - scaled).topRows(60).cwiseAbs().maxCoeff() > 1e-4);
    // An orthogonal matrix has no rank to leave out.
    block.compress(rough, Vector::Ones(60), 1e-2);
    CHECK(block.whole);
    CHECK(block.left == rough);
    block.compress(rough, Vector::Ones(60), 1.0);
    CHECK(block.rank() == 0);
}

// An elastic cube of springs along the axes and the diagonals of its faces, held by weak ones.
struct Cube {
    int n;
    std::vector<Vec3> places;
    std::vector<solver::Supernodes::Pair> pairs;
    explicit Cube(int points) : n{points} {
        for (int k = 0; k < n * n * n; ++k) places.emplace_back(k / (n * n), k / n % n, k % n);
        for (int k = 0; k < n * n * n; ++k)
            for (int x = 0; x <= 1; ++x)
                for (int y = -1; y <= 1; ++y)
                    for (int z = -1; z <= 1; ++z) {
                        const int a = k / (n * n) + x, b = k / n % n + y, c = k % n + z, other = (a * n + b) * n + c;
                        const int axes = x * x + y * y + z * z;
                        if (a < n && b >= 0 && b < n && c >= 0 && c < n && other > k && axes > 0 && axes < 3)
                            pairs.emplace_back(k, other);
                    }
    }
    Index unknowns() const { return 3 * core::count(places); }
    template <class Body>
    void springs(const Body& body) const {
        for (const auto& [i, j] : pairs) {
            const Vec3 along = (places[core::at(j)] - places[core::at(i)]).normalized();
            body(i, j, Mat3(along * along.transpose()));
        }
    }
    template <class Real>
    solver::BlockCholesky<Real> matrix(double ground) const {
        solver::BlockCholesky<Real> a{solver::SmallPivot::magnitude};
        a.analyse(std::vector<int>(places.size(), 3), pairs, places);
        for (int k = 0; k < core::count(places); ++k) a.add(k, k, Mat3(ground * Mat3::Identity()));
        springs([&](int i, int j, const Mat3& spring) {
            a.add(i, i, spring), a.add(j, j, spring);
            a.add(i, j, Mat3(-spring));
        });
        return a;
    }
    Vector product(double ground, const Vector& x) const {
        Vector y = ground * x;
        springs([&](int i, int j, const Mat3& spring) {
            const Vec3 force = spring * (x.segment<3>(3 * i) - x.segment<3>(3 * j));
            y.segment<3>(3 * i) += force, y.segment<3>(3 * j) -= force;
        });
        return y;
    }
};

TEST_CASE("a compressed factor is nearly the inverse, in less memory, with the same bits on two threads") {
    const Cube cube(18);
    constexpr double ground = 1.0;
    solver::BlockCholesky<float> a = cube.matrix<float>(ground);
    const Vector known = Vector::LinSpaced(cube.unknowns(), -1.0, 2.0).array().sin(), b = cube.product(ground, known);
    const auto error = [&](float left_out) {
        CHECK(a.factor(left_out).dropped == 0);
        Vector x = b;
        a.solve(x);
        return (x - known).norm() / known.norm();
    };
    const double exact = error(0.0F);
    const Index all = a.entries();
    CHECK(all == a.fill());
    CHECK(exact < 1e-5);  // rounding 6e-8 by a condition number below 20
    double before = 1.0;
    for (const float left_out : {1e-2F, 1e-3F, 1e-4F}) {
        const double now = error(left_out);
        CHECK(now < 20.0 * left_out);  // of a diagonal of 1, by a condition number below 20
        CHECK(now < 0.5 * before);
        CHECK(now > exact);  // something is left out
        CHECK(a.entries() < 0.95 * static_cast<double>(all));
        before = now;
    }
    CHECK(error(0.0F) == exact);  // and all of it again
    Vector one = b, two = b;
    test::with_threads(1, [&] { a.factor(1e-3F), a.solve(one); });
    test::with_threads(2, [&] { a.factor(1e-3F), a.solve(two); });
    CHECK(one == two);
    test::with_threads(1, [&] { a.factor(), a.solve(one); });
    test::with_threads(2, [&] { a.factor(), a.solve(two); });
    CHECK(one == two);
}

TEST_CASE("without places nothing is compressed") {
    const Cube cube(12);
    solver::BlockCholesky<float> a;
    a.analyse(std::vector<int>(cube.places.size(), 3), cube.pairs);
    for (int k = 0; k < core::count(cube.places); ++k) a.add(k, k, Mat3(Mat3::Identity()));
    a.factor(1e-2F);
    CHECK(a.entries() == a.fill());
}

TEST_CASE("fibres are solved with a compressed factor, and with the whole one should that not do") {
    const test::FabricSystem system(test::Fabric{.bundles = 1, .fibres = 38, .elements = 16, .length = 2.2});
    const Vector b = test::contact_load(system);
    const auto solve = [&](double left_out, Vector& x, Index least_fill = 0) {
        solver::FloatBlockCholesky factor{{.left_out = left_out, .least_fill = least_fill}};
        factor.analyse(test::least(system));
        CHECK(factor.prepare(test::least(system)) == solver::SolveStatus::converged);
        const Index kept = factor.entries();
        Vector again;
        const solver::SolveReport report = factor.solve(test::least(system), b, 1e-8, x);
        CHECK(report.status == solver::SolveStatus::converged);
        CHECK(factor.solve(test::least(system), b, 1e-8, again).iterations == report.iterations);
        CHECK(x == again);  // what was solved before does not matter, fallen back or not
        return std::pair{kept == factor.fill(), report.iterations};
    };
    Vector exact, compressed, hardly, nothing;
    const auto all = solve(0.0, exact);
    CHECK(all.second <= 3);
    const auto [whole, iterations] = solve(3e-4, compressed);
    CHECK_FALSE(whole);
    CHECK(iterations > 2);
    CHECK(iterations < 15);
    CHECK(solve(3e-4, hardly, 200'000'000) == all);  // too small a factor to gain
    CHECK(hardly == exact);
    const auto fallen_back = solve(0.05, hardly);  // pivots turned negative
    CHECK(fallen_back.first);
    CHECK(fallen_back.second == 2);
    const auto changed =
        solve(1.0, nothing);  // what columns of pieces are to each other was left out, and iterations did not end
    CHECK_FALSE(changed.first);
    CHECK(changed.second > 50);
    for (const Vector& x : {compressed, hardly, nothing}) CHECK((x - exact).norm() < 1e-4 * exact.norm());  // residual 1e-8
}

}  // namespace compressed_panel_test

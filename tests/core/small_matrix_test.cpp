// SPDX-License-Identifier: MIT
#include <fibrant/core/ordering.hpp>
#include <fibrant/core/rotation.hpp>
#include <fibrant/core/small_matrix.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>
#include <vector>

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

/// The largest difference of the entries of two matrices.
template <class A, class B>
double apart(const A& a, const B& b) {
    double most = 0.0;
    for (Index r = 0; r < a.rows(); ++r)
        for (Index c = 0; c < a.cols(); ++c) most = std::max(most, std::abs(a(r, c) - b(r, c)));
    return most;
}

TEST_CASE("sums and products of small matrices are those of their entries") {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    Vector many(9);
    Mat3 a, b;
    for (Index k = 0; k < 9; ++k) many[k] = number(random), a.data()[k] = number(random), b.data()[k] = number(random);
    Eigen::Matrix2d p;
    Eigen::Matrix<double, 2, 4> q;
    for (Index k = 0; k < 4; ++k) p.data()[k] = number(random);
    for (Index k = 0; k < 8; ++k) q.data()[k] = number(random);
    const Vec3 v = many.segment<3>(0), w = b.col(1);
    const auto product = [](const auto& left, const auto& right) {
        Matrix sum = Matrix::Zero(left.rows(), right.cols());
        for (Index r = 0; r < left.rows(); ++r)
            for (Index c = 0; c < right.cols(); ++c)
                for (Index k = 0; k < left.cols(); ++k) sum(r, c) += left(r, k) * right(k, c);
        return sum;
    };
    const double rounding = 3e-16;  // of three products of numbers below 1
    for (Index k = 0; k < 3; ++k) {
        CHECK((many.segment<3>(0) + b.col(1))[k] == v[k] + w[k]);
        CHECK((many.segment<3>(0) - w)[k] == v[k] - w[k]);
        CHECK((-(2 * v) / 4.0 * 2.0)[k] == -v[k]);
    }
    CHECK(apart(a * v, product(a, v)) < rounding);
    CHECK(apart(a.transpose() * b.col(2), product(Mat3(a.transpose()), Vec3(b.col(2)))) < rounding);
    CHECK(apart(a * b, product(a, b)) < rounding);
    CHECK(apart(a.transpose() * b, product(Mat3(a.transpose()), b)) < rounding);
    CHECK(apart(a * b.transpose(), product(a, Mat3(b.transpose()))) < rounding);
    CHECK(apart(v * w.transpose(), product(v, Eigen::RowVector3d(w.transpose()))) == 0.0);
    CHECK(apart(p * q, product(p, q)) < rounding);
    CHECK(apart(q.transpose() * p, product(Matrix(q.transpose()), p)) < rounding);
    CHECK(apart((a + b) - 2.0 * b, Mat3(Mat3::Identity() - (Mat3::Identity() - (a - b)))) < 2.0 * rounding);
    CHECK(apart(-(p / 2.0), p * -0.5) == 0.0);
    CHECK(apart(core::columns(v, w, v).transpose() * w, product(Mat3(core::columns(v, w, v).transpose()), w)) < rounding);
}

TEST_CASE("a turn about an axis leaves the axis, and takes what is across it around by the angle") {
    const Vec3 axis = Vec3(1.0, -2.0, 0.5).normalized(), across = axis.unitOrthogonal();
    const Mat3 turn = core::turn_about(axis, 0.7);
    CHECK((turn * axis - axis).norm() < 1e-15);
    CHECK((turn * across - (std::cos(0.7) * across + std::sin(0.7) * axis.cross(across))).norm() < 1e-15);
}

TEST_CASE("what a moment stiffens a turn by is the derivative of its part along the turn's own coordinates, made symmetric") {
    const Vec3 moment(0.7, -1.3, 0.4);
    for (const double size : {1e-3, 0.5, 0.99, 1.01, 2.5, 6.0}) {  // on both sides of where the series ends
        const Vec3 psi = size * Vec3(1.0, -2.0, 0.5).normalized();
        const double step = 1e-4;
        Mat3 slope;
        for (Index c = 0; c < 3; ++c) {
            const auto part = [&](double by) {
                return Vec3(core::spin_matrix(Vec3(psi + by * step * Vec3::Unit(c))).transpose() * moment);
            };
            slope.col(c) = (8.0 * (part(1.0) - part(-1.0)) - (part(2.0) - part(-2.0))) / (12.0 * step);
        }
        // Differences lose 1e-16 over the step, and have an error of its fourth power.
        CHECK((core::spin_slope(psi, moment) - 0.5 * (slope + slope.transpose())).norm() < 1e-10 * moment.norm());
    }
}

TEST_CASE("values are sorted, and equal ones stay in their order") {
    std::mt19937 random(11);
    for (std::size_t count = 0; count < 40; ++count) {
        std::vector<std::pair<unsigned, std::size_t>> values;
        for (std::size_t k = 0; k < count; ++k) values.emplace_back(random() % 5, k);
        auto expected = values;
        std::sort(expected.begin(), expected.end());  // by the place too
        core::stable_sort(values, [](const auto& a, const auto& b) { return a.first < b.first; });
        CHECK(values == expected);
    }
}

}  // namespace small_matrix_test

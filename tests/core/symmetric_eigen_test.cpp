// SPDX-License-Identifier: MIT
#include <fibrant/core/symmetric_eigen.hpp>

#include <Eigen/Eigenvalues>
#include <doctest/doctest.h>

#include <cmath>
#include <random>

namespace symmetric_eigen_test {
using namespace fibrant;

template <int n>
void check(const Eigen::Matrix<double, n, n>& matrix) {
    const core::SymmetricEigen<n> own(matrix);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, n, n>> other(matrix);
    const double size = matrix.cwiseAbs().maxCoeff(), rounding = 1e-14;
    CHECK((own.values() - other.eigenvalues()).cwiseAbs().maxCoeff() <= rounding * size);
    CHECK((own.vectors().transpose() * own.vectors() - Eigen::Matrix<double, n, n>::Identity()).norm() < rounding);
    CHECK((matrix * own.vectors() - own.vectors() * own.values().asDiagonal()).norm() <= 4.0 * rounding * size);
    for (int k = 1; k < n; ++k) CHECK(own.values()[k - 1] <= own.values()[k]);
    const Eigen::Matrix<double, n, n> raised =
        other.eigenvectors() * other.eigenvalues().cwiseMax(0.0).asDiagonal() * other.eigenvectors().transpose();
    CHECK((own.raised(0.0) - raised).norm() <= 20.0 * rounding * size);
}

template <int n>
void check_kinds() {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    using Square = Eigen::Matrix<double, n, n>;
    const auto any = [&] { return Square(Square::NullaryExpr([&] { return normal(random); })); };
    for (int k = 0; k < 200; ++k) {
        const Square m = any();
        check<n>(m + m.transpose());
        check<n>(m.col(0) * m.col(0).transpose());  // of rank one
        check<n>(Square(m.diagonal().asDiagonal()));
        check<n>(Square::Identity() + 1e-16 * (m + m.transpose()));  // all but equal
        check<n>(1e-170 * (m + m.transpose()));
    }
    check<n>(Square::Zero());
}

TEST_CASE("eigenvalues are those of a general solver, least first, and eigenvectors are unit and across each other") {
    check_kinds<2>();
    check_kinds<3>();
    check_kinds<4>();
    check_kinds<8>();
}

}  // namespace symmetric_eigen_test

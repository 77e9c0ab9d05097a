// SPDX-License-Identifier: MIT
#include <fibrant/beam/lagrange.hpp>

#include <doctest/doctest.h>

#include <cmath>

using namespace fibrant;

namespace lagrange_test {

using namespace fibrant::beam;

template <int Nodes>
double interpolated(const std::array<double, Nodes>& weights, int power) {
    double sum = 0.0;
    for (int I = 0; I < Nodes; ++I) {
        sum += weights[static_cast<std::size_t>(I)] * std::pow(Lagrange<Nodes>::node(I), power);
    }
    return sum;
}
template <int Nodes>
void check_interpolation() {
    // A polynomial of degree Nodes - 1 is reproduced with its derivatives, to round-off.
    for (const double xi : {-1.0, -0.6, 0.0, 0.3, 1.0}) {
        for (int power = 0; power < Nodes; ++power) {
            const double slope = power == 0 ? 0.0 : power * std::pow(xi, power - 1);
            const double second = power == 2 ? 2.0 : 0.0;
            CHECK(std::abs(interpolated<Nodes>(Lagrange<Nodes>::shape(xi), power) - std::pow(xi, power)) < 1e-15);
            CHECK(std::abs(interpolated<Nodes>(Lagrange<Nodes>::shape_derivative(xi), power) - slope) < 1e-15);
            CHECK(std::abs(interpolated<Nodes>(Lagrange<Nodes>::shape_second_derivative(), power) - second) < 1e-15);
        }
    }
}
template <int Points>
void check_quadrature() {
    for (int power = 0; power < 2 * Points; ++power) {
        double sum = 0.0;
        for (const QuadraturePoint& point : gauss_points<Points>()) sum += point.weight * std::pow(point.xi, power);
        CHECK(std::abs(sum - (power % 2 == 0 ? 2.0 / (power + 1) : 0.0)) < 1e-15);
    }
}
TEST_CASE("nodes of an element carry every polynomial of their degree") {
    check_interpolation<2>();
    check_interpolation<3>();
}

TEST_CASE("Gauss points integrate polynomials of degree 2 n - 1 exactly") {
    check_quadrature<1>();
    check_quadrature<2>();
    check_quadrature<3>();
}

}  // namespace lagrange_test

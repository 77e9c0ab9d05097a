// SPDX-License-Identifier: MIT
#pragma once
/// @file Lagrange polynomials of an element with equally spaced nodes on xi in [-1, 1], and Gauss points.

#include <array>

namespace fibrant::beam {

/// Interpolation through 2 nodes (xi = -1, 1) or 3 nodes (xi = -1, 0, 1).
template <int Nodes>
    requires(Nodes == 2 || Nodes == 3)
struct Lagrange {
    using Values = std::array<double, Nodes>;  ///< one number a node

    /// N_I(xi) [1].
    static constexpr Values shape(double xi) noexcept {
        if constexpr (Nodes == 2) {
            return {0.5 * (1.0 - xi), 0.5 * (1.0 + xi)};
        } else {
            return {0.5 * xi * (xi - 1.0), (1.0 - xi) * (1.0 + xi), 0.5 * xi * (xi + 1.0)};
        }
    }
    /// dN_I/dxi [1].
    static constexpr Values shape_derivative(double xi) noexcept {
        if constexpr (Nodes == 2) {
            return {-0.5, 0.5};
        } else {
            return {xi - 0.5, -2.0 * xi, xi + 0.5};
        }
    }
    /// d^2 N_I/dxi^2 [1], the same everywhere.
    static constexpr Values shape_second_derivative() noexcept {
        if constexpr (Nodes == 2) {
            return {0.0, 0.0};
        } else {
            return {1.0, -2.0, 1.0};
        }
    }
    /// xi of node I [1].
    static constexpr double node(int I) noexcept { return 2.0 * I / (Nodes - 1) - 1.0; }
};

/// Point and weight of a quadrature on [-1, 1].
struct QuadraturePoint {
    double xi;      ///< in (-1, 1)
    double weight;  ///< > 0; all weights add up to 2
};

/// Gauss points, exact for polynomials of degree 2 Points - 1.
template <int Points>
    requires(Points >= 1 && Points <= 3)
constexpr std::array<QuadraturePoint, Points> gauss_points() noexcept {
    if constexpr (Points == 1) {
        return {{{0.0, 2.0}}};
    } else if constexpr (Points == 2) {
        return {{{-0.57735026918962576451, 1.0}, {0.57735026918962576451, 1.0}}};
    } else {
        return {{{-0.77459666924148337704, 5.0 / 9.0}, {0.0, 8.0 / 9.0}, {0.77459666924148337704, 5.0 / 9.0}}};
    }
}

}  // namespace fibrant::beam

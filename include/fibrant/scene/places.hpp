// SPDX-License-Identifier: MIT
#pragma once
/// @file What refusals call fibres and places, and checks of vectors and matrices that a scene is given.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

namespace fibrant::scene {

/// What the entries of matrices that are projectors or rotations may miss [1]: they may have been written with nine digits.
inline constexpr double matrix_rounding = 1e-8;

/// "(1, 2, 3)".
inline std::string text(const Vec3& value) {
    return "(" + core::text(value.x()) + ", " + core::text(value.y()) + ", " + core::text(value.z()) + ")";
}

/// "tool 3", or "tool 3 'plate'" where it has a name.
inline std::string label(std::string_view kind, Index number, const std::string& name = {}) {
    return std::string(kind) + " " + std::to_string(number) + (name.empty() ? "" : " '" + name + "'");
}

/// Throws unless all coordinates are finite.
inline void require_finite(std::string_view field, const Vec3& value) {
    if (!value.allFinite()) core::refuse(field, text(value), "finite");
}

/// Greatest entry of a b^T - c; not a number where one of them is not.
inline double greatest_miss(const Mat3& a, const Mat3& b, const Mat3& c) noexcept {
    double most = 0.0;
    for (Index column = 0; column < 3; ++column)
        for (Index row = 0; row < 3; ++row) {
            double sum = -c(row, column);
            for (Index k = 0; k < 3; ++k) sum += a(row, k) * b(column, k);
            if (!std::isfinite(sum)) return core::unset;
            most = std::max(most, std::abs(sum));
        }
    return most;
}

/// Throws unless a matrix is symmetric and its own square.
inline void require_projector(std::string_view field, const Mat3& value) {
    const double error = greatest_miss(value, value, value);
    core::require(error <= matrix_rounding, std::string(field) + ": P P^T - P", error, "0: a symmetric projector");
}

/// Throws unless the columns of a matrix are orthonormal.
inline void require_orthonormal(std::string_view field, const Mat3& value) {
    const Mat3 transposed = value.transpose();
    const double error = greatest_miss(transposed, transposed, Mat3::Identity());
    core::require(error <= matrix_rounding, std::string(field) + ": R^T R - 1", error, "0: orthonormal");
}

/// Throws unless a matrix turns and neither stretches nor mirrors.
inline void require_rotation(std::string_view field, const Mat3& value) {
    require_orthonormal(field, value);
    const double determinant = value.col(0).dot(value.col(1).cross(value.col(2)));
    core::require(determinant > 0.0, std::string(field) + ": determinant", determinant, "1: right-handed");
}

}  // namespace fibrant::scene

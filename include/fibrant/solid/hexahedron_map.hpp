// SPDX-License-Identifier: MIT
#pragma once
/// @file The trilinear map of a hexahedron, and its inverse.

#include <fibrant/core/types.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace fibrant::solid {

/// Places of the nodes, a row each. Node k stands at natural coordinates `corner(k)`: round the lower face, then the upper.
using CellNodes = Eigen::Matrix<double, 8, 3>;
/// A row a node: derivatives of its shape function.
using ShapeGradient = Eigen::Matrix<double, 8, 3>;
/// A number a node.
using CellWeights = Eigen::Matrix<double, 8, 1>;

/// Corner k of the cell from -1 to 1, k in [0, 8) [1].
inline Vec3 corner(int k) noexcept {
    static constexpr std::array<std::array<double, 3>, 8> corners{
        {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
    const auto& c = corners[core::at(k)];
    return {c[0], c[1], c[2]};
}

/// Shape functions; they sum to 1.
inline CellWeights shape(const Vec3& xi) noexcept {
    CellWeights n;
    for (int k = 0; k < 8; ++k) {
        const Vec3 c = corner(k);
        n[k] = 0.125 * (1.0 + c.x() * xi.x()) * (1.0 + c.y() * xi.y()) * (1.0 + c.z() * xi.z());
    }
    return n;
}
inline ShapeGradient shape_derivatives(const Vec3& xi) noexcept {
    ShapeGradient d;
    for (int k = 0; k < 8; ++k) {
        const Vec3 c = corner(k);
        const Vec3 f(1.0 + c.x() * xi.x(), 1.0 + c.y() * xi.y(), 1.0 + c.z() * xi.z());
        d.row(k) << 0.125 * c.x() * f.y() * f.z(), 0.125 * f.x() * c.y() * f.z(), 0.125 * f.x() * f.y() * c.z();
    }
    return d;
}
/// d x / d xi.
inline Mat3 jacobian(const CellNodes& nodes, const Vec3& xi) noexcept { return nodes.transpose() * shape_derivatives(xi); }

/// Least Jacobian at the corners and the middle over the volume of the box around the nodes [1]: <= 0 of a cell that is not
/// valid.
inline double least_jacobian(const CellNodes& nodes) noexcept {
    const Vec3 extent = nodes.colwise().maxCoeff() - nodes.colwise().minCoeff();
    const double box = extent.prod();
    double least = jacobian(nodes, Vec3::Zero()).determinant();
    for (int k = 0; k < 8; ++k) least = std::min(least, jacobian(nodes, corner(k)).determinant());
    return box > 0.0 ? 8.0 * least / box : -1.0;
}

/// Where a point lies, or why it cannot be told.
enum class MapStatus : std::uint8_t {
    inside,  ///< on faces, edges and corners too
    outside,
    degenerate,  ///< the cell's map cannot be inverted there
};

/// Natural coordinates of a point.
struct MapResult {
    MapStatus status = MapStatus::outside;
    Vec3 xi = Vec3::Zero();
    int iterations = 0;
};

/// How far beyond its faces a point still counts as inside, in natural coordinates [1]: rounding.
inline constexpr double map_tolerance = 1e-8;

/// Finds xi with sum N_k(xi) x_k = x by Newton's method from the middle, with steps kept in reach of the cell.
///
/// A valid cell (Jacobian positive throughout) has one root inside at most. Coordinates within `map_tolerance` beyond a face
/// count as on it and are left as they are: the weights reproduce the point.
inline MapResult inverse_map(const CellNodes& nodes, const Vec3& x) noexcept {
    MapResult result;
    const double size = (nodes.colwise().maxCoeff() - nodes.colwise().minCoeff()).maxCoeff();
    const Vec3 middle = nodes.colwise().mean();
    if (!(size > 0.0)) {
        result.status = MapStatus::degenerate;
        return result;
    }
    // About the middle: a cell far from the origin keeps its digits.
    const CellNodes own = nodes.rowwise() - middle.transpose();
    const Vec3 wanted = x - middle;
    Vec3 xi = Vec3::Zero(), step = Vec3::Zero();
    double last = std::numeric_limits<double>::infinity();
    int retreats = 0;
    for (; result.iterations < 60; ++result.iterations) {
        const Mat3 j = jacobian(own, xi);
        if (!(std::abs(j.determinant()) > 1e-14 * size * size * size)) {
            // A step may have ended on a fold beyond the cell: half of it does not.
            if (step.isZero(0.0) || ++retreats > 5) {
                result.status = MapStatus::degenerate;
                result.xi = xi;
                return result;
            }
            step *= 0.5;
            xi -= step;
            continue;
        }
        step = j.inverse() * (wanted - own.transpose() * shape(xi));
        const double length = step.cwiseAbs().maxCoeff();
        if (!std::isfinite(length)) break;
        if (length > 1.0) step /= length;
        xi += step;
        if (xi.cwiseAbs().maxCoeff() > 20.0) break;
        if (length <= 1e-15 || (length < 1e-10 && length >= 0.5 * last)) break;
        last = length;
    }
    result.xi = xi;
    if (!xi.allFinite() || xi.cwiseAbs().maxCoeff() > 1.0 + map_tolerance) return result;
    const double miss = (wanted - own.transpose() * shape(xi)).norm();
    result.status = miss <= 1e-10 * size ? MapStatus::inside : MapStatus::outside;
    return result;
}

}  // namespace fibrant::solid

// SPDX-License-Identifier: MIT
#pragma once
/// @file The terms that a tangent stiffness is the sum of.

#include <fibrant/core/types.hpp>

#include <span>

namespace fibrant::assembly {

/// (w w^T) (x) stiffness: a contact element, a bonding element, an average connection.
struct PointTerm {
    std::span<const Index> vectors;   ///< 3-vectors of unknowns, each at most once
    std::span<const double> weights;  ///< w, one for each of the vectors [1, or length for a direction]
    Mat3 stiffness;                   ///< symmetric [force / length]
};

/// Symmetric stiffness on the vectors listed: a beam element, a hexahedron.
struct DenseTerm {
    std::span<const Index> vectors;            ///< 3-vectors of unknowns, each at most once
    const Eigen::Ref<const Matrix> stiffness;  ///< 3 vectors.size() square, both triangles
};

/// Visits and does nothing: the least visitor, which concepts ask with.
struct IgnoredTerms {
    void point(const PointTerm&) const noexcept {}
    void dense(const DenseTerm&) const noexcept {}
};

}  // namespace fibrant::assembly

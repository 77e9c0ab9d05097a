// SPDX-License-Identifier: MIT
#pragma once
/// @file The two doors by which a term's stiffness comes into the tangent: all that a term knows of it.

#include <fibrant/term/site.hpp>

#include <cassert>

namespace fibrant::term {

/// Stiffness within elements, which the bands of the fibres hold. What is added is minus the derivative of external forces, or
/// the derivative of internal ones, and symmetric.
class Bands {
public:
    /// @param to  has add_diagonal(vector, stiffness) and add_element(fibre, element, first entry, column by column); outlives
    /// this
    template <class To>
    explicit Bands(To& to) noexcept
        : to_{&to},
          diagonal_{[](void* target, Index vector, const Mat3& stiffness) {
              static_cast<To*>(target)->add_diagonal(vector, stiffness);
          }},
          element_{[](void* target, Index fibre, Index element, const double* entries) {
              static_cast<To*>(target)->add_element(fibre, element, entries);
          }} {}

    /// Of a nodal vector with itself [force / length].
    void diagonal(Index vector, const Mat3& stiffness) { diagonal_(to_, vector, stiffness); }
    /// Of all nodal vectors of an element; a square matrix of 3 rows a vector, a column at a time in memory.
    void element(Index fibre, Index element, const auto& stiffness) {
        assert(stiffness.rows() == stiffness.cols());
        element_(to_, fibre, element, stiffness.data());
    }

private:
    void* to_;
    void (*diagonal_)(void*, Index, const Mat3&);
    void (*element_)(void*, Index, Index, const double*);
};

/// Stiffness between particles of two elements. What couples what stands from one search or refresh of normals to the next.
class Couplings {
public:
    /// @param to  has add_coupling(point, point, stiffness); outlives this
    template <class To>
    explicit Couplings(To& to) noexcept
        : to_{&to}, between_{[](void* target, const CentrePoint& i, const CentrePoint& j, const Mat3& stiffness) {
              static_cast<To*>(target)->add_coupling(i, j, stiffness);
          }} {}

    /// Of a force that depends on the place of j less that of i, symmetric and positive semidefinite [force / length].
    void between(const CentrePoint& i, const CentrePoint& j, const Mat3& stiffness) { between_(to_, i, j, stiffness); }

private:
    void* to_;
    void (*between_)(void*, const CentrePoint&, const CentrePoint&, const Mat3&);
};

}  // namespace fibrant::term

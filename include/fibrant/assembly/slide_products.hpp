// SPDX-License-Identifier: MIT
#pragma once
/// @file Products with the stiffness of crossings whose places slide, in plain loops: few scenes have any.

#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/core/small_matrix.hpp>

#include <cstddef>

namespace fibrant::assembly {

/// y += rows^T stiffness rows x
inline void add_slide(const contact::SlidingStiffness& slide, const Vector& x, Vector& y) {
    Vector motion(slide.rows.cols());
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) motion[3 * static_cast<Index>(k) + c] = x[3 * slide.vectors[k] + c];
    const Vector force = core::transposed_times(slide.rows, core::times(slide.stiffness, core::times(slide.rows, motion)));
    for (std::size_t k = 0; k < slide.vectors.size(); ++k)
        for (Index c = 0; c < 3; ++c) y[3 * slide.vectors[k] + c] += force[3 * static_cast<Index>(k) + c];
}

/// rows^T stiffness rows
inline Matrix whole_slide(const contact::SlidingStiffness& slide) {
    const Index rows = slide.rows.rows(), columns = slide.rows.cols();
    Matrix half = Matrix::Zero(columns, rows), whole = Matrix::Zero(columns, columns);
    for (Index c = 0; c < rows; ++c)
        for (Index r = 0; r < columns; ++r)
            for (Index k = 0; k < rows; ++k) half(r, c) += slide.rows(k, r) * slide.stiffness(k, c);
    for (Index c = 0; c < columns; ++c)
        for (Index k = 0; k < rows; ++k)
            for (Index r = 0; r < columns; ++r) whole(r, c) += half(r, k) * slide.rows(k, c);
    return whole;
}

}  // namespace fibrant::assembly

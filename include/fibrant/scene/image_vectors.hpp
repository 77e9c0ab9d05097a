// SPDX-License-Identifier: MIT
#pragma once
/// @file Closed chains: their last nodes in memory are images of the first ones.

#include <fibrant/scene/dof_layout.hpp>

namespace fibrant::scene {

/// Gives images the values of their sources.
inline void copy_to_images(const DofLayout& layout, Vector& x) noexcept {
    for (const ImageVector& one : layout.images) x.segment<3>(3 * one.image) = x.segment<3>(3 * one.source);
}

/// Takes forces on images to their sources.
inline void fold_images(const DofLayout& layout, Vector& forces) noexcept {
    for (const ImageVector& one : layout.images) {
        forces.segment<3>(3 * one.source) += forces.segment<3>(3 * one.image);
        forces.segment<3>(3 * one.image).setZero();
    }
}

}  // namespace fibrant::scene

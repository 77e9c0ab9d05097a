// SPDX-License-Identifier: MIT
#pragma once
/// @file Closed chains: their last nodes in memory are images of the first ones.

#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <utility>
#include <vector>

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

/// Holds images, behind what holds and ties hold; where they go their sources say.
/// @param targets  of what is held, and becomes that of images too
inline void hold_images(DofLayout& layout, std::vector<Vec3>& targets) {
    if (layout.images.empty()) return;
    std::vector<std::pair<HeldVector, Vec3>> all;
    for (std::size_t k = 0; k < layout.held.size(); ++k) all.emplace_back(layout.held[k], targets[k]);
    for (const ImageVector& one : layout.images) all.emplace_back(HeldVector{one.image, Mat3::Zero()}, Vec3::Zero());
    std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.first.vector < b.first.vector; });
    layout.held.clear(), targets.clear();
    for (const auto& [one, target] : all) layout.held.push_back(one), targets.push_back(target);
}

}  // namespace fibrant::scene

// SPDX-License-Identifier: MIT
#pragma once
/// @file Closed chains: their last nodes in memory are images of the first ones.

#include <fibrant/core/ordering.hpp>
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

/// What is held, and where it goes.
struct HeldTarget {
    HeldVector held;
    Vec3 target;
};
/// Adds what is held to others, whose order by vector is kept.
inline void hold_more(std::vector<HeldVector>& held, std::vector<Vec3>& targets, const std::vector<HeldTarget>& more) {
    std::vector<HeldTarget> all;
    for (std::size_t k = 0; k < held.size(); ++k) all.push_back({held[k], targets[k]});
    core::append(all, more);
    core::stable_sort(all, [](const HeldTarget& a, const HeldTarget& b) { return a.held.vector < b.held.vector; });
    held.clear(), targets.clear();
    for (const HeldTarget& one : all) held.push_back(one.held), targets.push_back(one.target);
}

/// Holds images, behind what holds and ties hold; where they go their sources say.
/// @param targets  of what is held, and becomes that of images too
inline void hold_images(DofLayout& layout, std::vector<Vec3>& targets) {
    if (layout.images.empty()) return;
    std::vector<HeldTarget> more;
    for (const ImageVector& one : layout.images) more.push_back({{one.image, Mat3::Zero()}, Vec3::Zero()});
    hold_more(layout.held, targets, more);
}

}  // namespace fibrant::scene

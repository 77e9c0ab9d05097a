// SPDX-License-Identifier: MIT
#pragma once
/// @file Images: the last nodes of closed chains in memory, and fibres that are seen once more beside their cell.

#include <fibrant/core/ordering.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace fibrant::scene {

/// Gives images the values of their sources, moved by their shifts: of a state, or of a step.
inline void copy_to_images(const DofLayout& layout, Vector& x) {
    std::vector<Vec3> moved;
    for (const ImageShift& shift : layout.shifts) moved.push_back(shift.of(x));
    for (const ImageVector& one : layout.images) {
        x.segment<3>(3 * one.image) = x.segment<3>(3 * one.source);
        if (one.shift >= 0) x.segment<3>(3 * one.image) += moved[core::at(one.shift)];
    }
}

/// Adds to a step what takes images of fibres from where they are in a state to where they belong.
inline void add_image_misses(const DofLayout& layout, const Vector& state, Vector& step) {
    if (layout.shifts.empty()) return;
    Vector placed = state;
    copy_to_images(layout, placed);
    for (const ImageVector& one : layout.images)
        step.segment<3>(3 * one.image) += placed.segment<3>(3 * one.image) + one.more - state.segment<3>(3 * one.image);
}

/// Takes forces on images to their sources, and to what shifts them.
inline void fold_images(const DofLayout& layout, Vector& forces) {
    std::vector<Vec3> sums(layout.shifts.size(), Vec3::Zero());
    for (const ImageVector& one : layout.images) {
        forces.segment<3>(3 * one.source) += forces.segment<3>(3 * one.image);
        if (one.shift >= 0) sums[core::at(one.shift)] += forces.segment<3>(3 * one.image);
        forces.segment<3>(3 * one.image).setZero();
    }
    for (std::size_t s = 0; s < sums.size(); ++s)
        for (const ImageShift::Pair& pair : layout.shifts[s].pairs)
            forces.segment<3>(3 * pair.last) += pair.times * sums[s], forces.segment<3>(3 * pair.first) -= pair.times * sums[s];
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

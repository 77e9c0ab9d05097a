// SPDX-License-Identifier: MIT
#pragma once
/// @file What held vectors and ties leave of a vector of unknowns: products with a few sparse rows, never a part of a matrix.

#include <fibrant/core/small_matrix.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <Eigen/Core>

namespace fibrant::scene {

/// Number of tied scalars.
inline Index tied_scalars(const std::vector<Tie>& ties) noexcept {
    return ties.empty() ? 0 : ties.back().first + ties.back().count;
}
inline Index tied_scalars(const DofLayout& layout) noexcept { return tied_scalars(layout.ties); }

/// B x: the tied scalars of a vector.
inline Vector tied_part(const std::vector<Tie>& ties, const Vector& x) {
    Vector scalars(tied_scalars(ties));
    for (const Tie& tie : ties) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < tie.vectors.size(); ++k) sum += tie.weights[k] * x.segment<3>(3 * tie.vectors[k]);
        for (Index a = 0; a < tie.count; ++a) scalars[tie.first + a] = tie.axes.col(a).dot(sum);
    }
    return scalars;
}
inline Vector tied_part(const DofLayout& layout, const Vector& x) { return tied_part(layout.ties, x); }

/// x += B^T scalars
inline void add_tied(const DofLayout& layout, const Vector& scalars, Vector& x) {
    for (const Tie& tie : layout.ties) {
        Vec3 sum = Vec3::Zero();
        for (Index a = 0; a < tie.count; ++a) sum += scalars[tie.first + a] * tie.axes.col(a);
        for (std::size_t k = 0; k < tie.vectors.size(); ++k) x.segment<3>(3 * tie.vectors[k]) += tie.weights[k] * sum;
    }
}

/// Leaves of tied scalars what cannot move: s <- (I - U U^T) s.
inline void remove_motions(const DofLayout& layout, Vector& scalars) {
    for (const TiedMotion& motion : layout.motions) {
        const Index n = core::count(motion.scalars);
        Vector own(n);
        for (Index k = 0; k < n; ++k) own[k] = scalars[motion.scalars[core::at(k)]];
        own -= core::times(motion.modes, core::transposed_times(motion.modes, own));
        for (Index k = 0; k < n; ++k) scalars[motion.scalars[core::at(k)]] = own[k];
    }
}

/// x <- x - B^T (I - U U^T) B x: the orthogonal projector of what ties leave free.
inline void project_ties(const DofLayout& layout, Vector& x) {
    if (layout.ties.empty()) return;
    Vector scalars = tied_part(layout, x);
    remove_motions(layout, scalars);
    add_tied(layout, Vector(-scalars), x);
}

/// y <- F y + (I - F) H (I - F) x for the projector F of project_ties, H the stiffness of what is held.
inline void complete_ties(const DofLayout& layout, const Vector& x, Vector& y) {
    if (layout.ties.empty()) return;
    Vector scalars = tied_part(layout, x);
    remove_motions(layout, scalars);
    for (const Tie& tie : layout.ties) scalars.segment(tie.first, tie.count) *= layout.held_stiffness(tie.vectors.front());
    scalars -= tied_part(layout, y);
    remove_motions(layout, scalars);
    add_tied(layout, scalars, y);
}

/// Adds to x what the right side b of a system holds outside the free directions, over the stiffness there.
/// @param free  F b
inline void add_held(const DofLayout& layout, const Vector& b, const Vector& free, Vector& x) {
    const auto add = [&](Index vector, double stiffness) {
        x.segment<3>(3 * vector) += (b.segment<3>(3 * vector) - free.segment<3>(3 * vector)) / stiffness;
    };
    for (const HeldVector& held : layout.held) add(held.vector, layout.held_stiffness(held.vector));
    for (const Tie& tie : layout.ties)
        for (const Index vector : tie.vectors) add(vector, layout.held_stiffness(tie.vectors.front()));
}

/// x <- x within the free directions of held vectors, whatever is tied.
inline void project_held(const DofLayout& layout, Vector& x) {
    for (const HeldVector& held : layout.held) {
        const Vec3 v = x.segment<3>(3 * held.vector);
        x.segment<3>(3 * held.vector) = held.free * v;
    }
}

/// x <- F x: what held vectors and ties leave free of a vector of unknowns.
inline void project_free(const DofLayout& layout, Vector& x) {
    project_held(layout, x);
    project_ties(layout, x);
}

/// y += B^T U S U^T B x: stiffness of what moves together.
inline void add_motion_stiffness(const DofLayout& layout, const Vector& x, Vector& y) {
    bool any = false;
    for (const TiedMotion& motion : layout.motions) any = any || motion.stiffness.size() > 0;
    if (!any) return;
    const Vector scalars = tied_part(layout, x);
    Vector force = Vector::Zero(scalars.size());
    for (const TiedMotion& motion : layout.motions) {
        if (motion.stiffness.size() == 0) continue;
        const Index n = core::count(motion.scalars);
        Vector own(n);
        for (Index k = 0; k < n; ++k) own[k] = scalars[motion.scalars[core::at(k)]];
        own = core::times(motion.modes, core::times(motion.stiffness, core::transposed_times(motion.modes, own)));
        for (Index k = 0; k < n; ++k) force[motion.scalars[core::at(k)]] += own[k];
    }
    add_tied(layout, force, y);
}

}  // namespace fibrant::scene

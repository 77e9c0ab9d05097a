// SPDX-License-Identifier: MIT
#pragma once
/// @file How large forces and displacements are, where vectors are of different kinds.

#include <fibrant/core/parallel.hpp>
#include <fibrant/scene/dof_layout.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fibrant::assembly {

/// Norm with forces on directors divided by the radius [force].
inline double norm_of(const scene::DofLayout& layout, const Vector& forces) {
    const std::vector<double>& length = layout.length;
    return std::sqrt(core::ordered_sum(core::count(length), 0.0, [&](Index first, Index last) {
        double sum = 0.0;
        for (Index v = first; v < last; ++v)
            sum += forces.segment<3>(3 * v).squaredNorm() / (length[core::at(v)] * length[core::at(v)]);
        return sum;
    }));
}
/// Greatest displacement of a step, directors counted at the surface [length].
inline double greatest_of(const scene::DofLayout& layout, const Vector& step) {
    const std::vector<double>& length = layout.length;
    return std::sqrt(core::largest(core::count(length), 0.0, [&](Index v) {
        return step.segment<3>(3 * v).squaredNorm() * length[core::at(v)] * length[core::at(v)];
    }));
}
/// Scalar product of the displacements of two steps, directors counted at the surface [length^2].
inline double product_of(const scene::DofLayout& layout, const Vector& a, const Vector& b) {
    const std::vector<double>& length = layout.length;
    return core::ordered_sum(core::count(length), 0.0, [&](Index first, Index last) {
        double sum = 0.0;
        for (Index v = first; v < last; ++v)
            sum += a.segment<3>(3 * v).dot(b.segment<3>(3 * v)) * length[core::at(v)] * length[core::at(v)];
        return sum;
    });
}

/// Of each of the first chains the greatest displacement of a step, directors counted at the surface [length]; empty if the step
/// is not finite.
inline std::vector<double> greatest_of_chains(const scene::DofLayout& layout, Index chains, const Vector& step) {
    std::vector<double> greatest(step.size() > 0 && step.allFinite() ? core::at(chains) : 0, 0.0);
    for (Index f = 0; f < core::count(greatest); ++f)
        scene::for_own_vectors(layout, f, [&](Index v, double length) {
            greatest[core::at(f)] = std::max(greatest[core::at(f)], length * step.segment<3>(3 * v).norm());
        });
    return greatest;
}

/// Where some chain moves most in a step.
struct MovesMost {
    Index chain = -1;    ///< -1 where nothing moves, or no one knows
    double along = 0.0;  ///< node over the last one, in [0, 1]
};
/// Of the first chains.
inline MovesMost moves_most(const scene::DofLayout& layout, Index chains, const Vector& step) {
    MovesMost found;
    const std::vector<double> greatest = greatest_of_chains(layout, chains, step);
    const auto chain = std::max_element(greatest.begin(), greatest.end());
    if (chain == greatest.end() || !(*chain > 0.0)) return found;
    found.chain = chain - greatest.begin();
    const scene::Chain& one = layout.chains[core::at(found.chain)];
    double most = 0.0;
    scene::for_own_vectors(layout, found.chain, [&](Index v, double length) {
        const double moved = length * step.segment<3>(3 * v).norm();
        if (moved <= most) return;
        most = moved;
        found.along = static_cast<double>((v - one.first_vector) / one.vectors_per_node) /
                      static_cast<double>(std::max<Index>(1, one.nodes - 1));
    });
    return found;
}

}  // namespace fibrant::assembly

// SPDX-License-Identifier: MIT
#pragma once
/// @file How the unknowns are laid out: all of them in 3-vectors, in chains of consecutive nodes.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fibrant::scene {

/// Consecutive nodes with equally many unknown 3-vectors: a fibre, a rigid body, a line of solid nodes.
struct Chain {
    Index first_vector = 0;      ///< of the chain's first node
    Index nodes = 0;             ///< in the chain, >= 1
    Index vectors_per_node = 3;  ///< director beam 3, Hermite cable 2, bar 1
    Index reach = 0;             ///< furthest node coupled along the chain: quadratic element 2, linear 1, none 0
    Index group = -1;            ///< innermost group of the scene; -1 where it names none
    bool closed = false;         ///< its last node is the image of its first one
};

/// A vector that is the same unknown as another one: the end of a closed chain in memory, or a node of a fibre's image beside its
/// cell. It has the value of its source, moved by its shift, wherever values are read, forces on it act on its source, and a
/// system holds it as if it were prescribed altogether.
struct ImageVector {
    Index image = -1, source = -1;
    Index shift = -1;          ///< of the layout: what moves it; -1: nothing
    Vec3 more = Vec3::Zero();  ///< beside its shift [of the vector]
};

/// By how much images of fibres are moved: sum of times (last - first) over pairs of vectors.
struct ImageShift {
    struct Pair {
        Index first = -1, last = -1;
        double times = 1.0;
    };
    std::vector<Pair> pairs;
    Vec3 of(const Vector& x) const noexcept {
        Vec3 sum = Vec3::Zero();
        for (const Pair& pair : pairs) sum += pair.times * (x.segment<3>(3 * pair.last) - x.segment<3>(3 * pair.first));
        return sum;
    }
};

/// A rigid translation moves positions only; a rotation turns directions, and changes rotation vectors by its spin.
enum class VectorKind : std::uint8_t { position, direction, rotation };

/// The system is the identity outside `free`, a symmetric projector: prescribed components.
struct HeldVector {
    Index vector = -1;
    Mat3 free = Mat3::Zero();
};

/// A combination sum w v of vectors that is tied in some directions: it is one scalar unknown for each of them. Ties share no
/// vector with another one and none that is held.
struct Tie {
    std::vector<Index> vectors;
    std::vector<double> weights;   ///< w, of squares that sum to 1 [1]
    Mat3 axes = Mat3::Identity();  ///< orthonormal columns, of which the first `count` are tied
    Index count = 3;
    Index first = 0;       ///< number of the first of its scalars among those of all ties
    double support = 0.0;  ///< what a preconditioner holds each vector by in the place of the tie [force / length]
};

/// Ways in which tied scalars may move together, as the free motions of a rigid body move them.
struct TiedMotion {
    std::vector<Index> scalars;  ///< numbers of tied scalars
    Matrix modes;                ///< a row a scalar, columns orthonormal
    Matrix stiffness;            ///< symmetric, of the modes [force / length]; or empty
};

/// Layout of a system: unknown k is component k % 3 of vector k / 3.
struct DofLayout {
    std::vector<Chain> chains;
    std::vector<VectorKind> kind;     ///< of each vector
    std::vector<Vec3> value;          ///< of each vector: current position [length] or director [1]
    std::vector<double> length;       ///< makes a vector a displacement: 1 for a position, the radius for a director
    std::vector<HeldVector> held;     ///< sorted by vector, each vector at most once
    std::vector<ImageVector> images;  ///< of closed chains and of images of fibres, sorted; each is among `held` too
    std::vector<ImageShift> shifts;   ///< of images
    std::vector<Tie> ties;            ///< none, but for averages and periodic cells
    std::vector<TiedMotion> motions;  ///< of ties, that share no scalar
    /// Of the scene, powers of two, so that to measure by them changes no bit: a radius [length], and a stiffness of positions.
    /// What a solver compares, or keeps in few bits, it measures by them: no number of its own depends on the units of a scene.
    double unit_length = 1.0, unit_stiffness = 1.0;

    Index vectors() const noexcept { return core::count(kind); }
    Index unknowns() const noexcept { return 3 * vectors(); }
    /// Stiffness that a vector has where it is held, as the others have theirs [force / length times length^2].
    double held_stiffness(Index vector) const noexcept {
        const double own = length[static_cast<std::size_t>(vector)];
        return unit_stiffness * own * own;
    }
};

/// body(vector, its length) of each nodal vector of a chain but images.
template <class Body>
void for_own_vectors(const DofLayout& layout, Index chain, const Body& body) {
    const Chain& one = layout.chains[core::at(chain)];
    const Index end = one.first_vector + (one.nodes - (one.closed ? 1 : 0)) * one.vectors_per_node;
    for (Index v = one.first_vector; v < end; ++v) body(v, layout.length[core::at(v)]);
}

/// The power of two next to a number, by its logarithm. @param value > 0
inline double power_of_two(double value) noexcept { return std::exp2(std::round(std::log2(value))); }

/// Largest coordinate of a state's positions [length]; vectors beyond the layout are positions.
inline double extent_of(const DofLayout& layout, const Vector& state) noexcept {
    double extent = 0.0;
    for (Index v = 0; v < state.size() / 3; ++v)
        if (v >= layout.vectors() || layout.kind[core::at(v)] == VectorKind::position)
            extent = std::max(extent, state.segment<3>(3 * v).cwiseAbs().maxCoeff());
    return extent;
}

/// Grain of a parallel loop over `items` that share a system: below some thousand unknowns threads cost more than they save.
inline Index grain(const DofLayout& layout, Index items) noexcept { return layout.unknowns() < 8192 ? items : 1; }

}  // namespace fibrant::scene

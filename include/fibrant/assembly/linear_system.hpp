// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of a linear system that may never be formed, and the projector of its held vectors.

#include <fibrant/assembly/terms.hpp>
#include <fibrant/scene/dof_layout.hpp>
#include <fibrant/scene/tied_vectors.hpp>

#include <cassert>
#include <concepts>
#include <vector>

namespace fibrant::assembly {

/// The symmetric tangent A of one iteration, known by what it does.
///
/// With K the sum of all terms and F the projector of the held vectors (the identity elsewhere), A = F K F + (I - F) H, H the
/// layout's stiffness of held vectors.
/// m = 3 vectors_per_node is the size of a chain's node block.
/// - apply(x, y): y = A x. Both have layout().unknowns() entries, x and y are different vectors.
/// - node_blocks(chain, blocks): nodes m x m, the diagonal block of node a at row a m.
/// - chain_band(chain, blocks): nodes m x (reach + 1) m, the lower block band of the chain: A(a, a - d) (row node a,
///   column node a - d) at row a m and column d m; zero where a < d. Contact elements within the chain included.
/// - visit(visitor): visitor.point(PointTerm) or visitor.dense(DenseTerm) once for each term of K, in a fixed order,
///   not projected: the visitor applies F.
/// Where the layout has ties, F leaves out what they tie as well, and K has the stiffness of their motions. node_blocks,
/// chain_band and visit know nothing of that: they have the ties' supports in its place, so that no term couples all ends of a
/// tie. What they give makes preconditioners, and only `apply` is A.
/// `blocks` is resized by the system. node_blocks and chain_band may be called from several threads at once, for
/// different chains. Every vector belongs to exactly one chain.
template <class T>
concept LinearSystem = requires(const T system, const Vector& x, Vector& y, Index chain, Matrix& blocks, IgnoredTerms& terms) {
    { system.layout() } -> std::same_as<const scene::DofLayout&>;
    system.apply(x, y);
    system.node_blocks(chain, blocks);
    system.chain_band(chain, blocks);
    system.visit(terms);
};

/// Visits the terms that may couple what lies beyond the bands of chains: a system that knows them has a member of this name,
/// else they are among all of its terms.
template <class T, class Visitor>
void visit_couplings(const T& system, Visitor& visitor) {
    if constexpr (requires { system.visit_couplings(visitor); })
        system.visit_couplings(visitor);
    else
        system.visit(visitor);
}

/// A system whose couplings are numbered, so that parts of them are visited, from several threads at once.
template <class T>
concept DivisibleCouplings = requires(const T system, IgnoredTerms& terms, Index k) {
    { system.couplings() } -> std::same_as<Index>;
    system.visit_couplings(terms, k, k);
};

/// A system that forms its matrix: all of A, both triangles, F included. The pattern depends on the terms' vectors only.
template <class T>
concept AssembledSystem = LinearSystem<T> && requires(const T system, SparseMatrix& a) {
    system.assemble(a);
};

/// The projector F of a layout's held vectors. A view: the layout must outlive it.
class HeldProjector {
public:
    explicit HeldProjector(const scene::DofLayout& layout) : layout_{&layout}, slot_(core::at(layout.vectors()), -1) {
        for (Index k = 0; k < core::count(layout.held); ++k) {
            slot_[core::at(layout.held[core::at(k)].vector)] = static_cast<int>(k);
        }
    }

    /// Projector of a vector; null where it is the identity.
    const Mat3* free(Index vector) const noexcept {
        const int k = slot_[core::at(vector)];
        return k < 0 ? nullptr : &layout_->held[core::at(k)].free;
    }
    /// x <- F x
    void project(Vector& x) const { scene::project_free(*layout_, x); }
    /// y <- F y + (I - F) H x: makes A x of y = K F x.
    void complete(const Vector& x, Vector& y) const {
        for (const scene::HeldVector& held : layout_->held) {
            const Vec3 whole = layout_->held_stiffness(held.vector) * x.segment<3>(3 * held.vector);
            const Vec3 difference = y.segment<3>(3 * held.vector) - whole;
            y.segment<3>(3 * held.vector) = whole + held.free * difference;
        }
        scene::complete_ties(*layout_, x, y);
    }
    /// (I - F) H of a held vector.
    Mat3 held_part(const scene::HeldVector& held) const {
        return layout_->held_stiffness(held.vector) * (Mat3::Identity() - held.free);
    }
    /// block <- F_i block F_j, for a 3 x 3 block of K between the vectors i and j. (I - F) H is left to the caller.
    void project(Index i, Index j, Mat3& block) const noexcept {
        if (const Mat3* left = free(i)) block = (*left * block).eval();
        if (const Mat3* right = free(j)) block = (block * *right).eval();
    }

private:
    const scene::DofLayout* layout_;
    std::vector<int> slot_;  // of each vector in `held`, or -1
};

}  // namespace fibrant::assembly

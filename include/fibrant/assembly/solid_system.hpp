// SPDX-License-Identifier: MIT
#pragma once
/// @file The tangent of fibres and the solids that they are bonded to.

#include <fibrant/assembly/chain_system.hpp>
#include <fibrant/solid/no_solid.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace fibrant::assembly {

/// The fibres' own system, whose diagonal has the bonds' share, then the solids: a chain whose nodes its band does not couple.
///
/// Strategies that know solids (solver::SolidPcg) take the two parts apart; to all others this is a system like any.
template <beam::BeamElement B, class Solid>
class SolidSystem {
public:
    using Fibres = ChainSystem<B>;
    using Row = typename Fibres::Row;

    /// @param solid  must outlive the system
    SolidSystem(const beam::Mesh<B>& mesh, const Solid& solid) : fibres_{mesh}, solid_{&solid}, layout_{mesh.layout()} {
        solid.add_to(layout_);
    }
    SolidSystem(const SolidSystem&) = delete;  // it looks at a solid
    SolidSystem& operator=(const SolidSystem&) = delete;

    const scene::DofLayout& layout() const noexcept { return layout_; }
    scene::DofLayout& layout() noexcept { return layout_; }
    const Fibres& fibres() const noexcept { return fibres_; }
    const Solid& solid() const noexcept { return *solid_; }

    /// To be called when what is held has changed.
    void share_held() {
        const auto end = std::partition_point(layout_.held.begin(), layout_.held.end(),
                                              [&](const scene::HeldVector& h) { return h.vector < solid_->first_vector(); });
        fibres_.layout().held.assign(layout_.held.begin(), end);
    }
    void place(const Vector& state) {
        for (Index v = 0; v < layout_.vectors(); ++v) layout_.value[core::at(v)] = state.segment<3>(3 * v);
        fibres_.place(state);
        if (fibres_.layout().ties.size() != layout_.ties.size()) share_ties();
        // Bodies turn: what a solver is told depends on the state, not on the one where ties were shared.
        for (std::size_t k = 0; k < layout_.ties.size(); ++k) fibres_.layout().ties[k].axes = layout_.ties[k].axes;
    }

    // The fibres' bands and points.
    auto& points() noexcept { return fibres_.points(); }
    auto& slides() noexcept { return fibres_.slides(); }
    auto& skews() noexcept { return fibres_.skews(); }
    bool unsymmetric() const noexcept { return fibres_.unsymmetric(); }
    void clear(Index fibre) { fibres_.clear(fibre); }
    void close(Index fibre) { fibres_.close(fibre); }
    void add(Index fibre, Index element, const beam::ElementMatrix<B>& stiffness) { fibres_.add(fibre, element, stiffness); }
    template <class Weights>
    void add_rank_one(Index fibre, Index first_unknown, const Weights& weights, const Mat3& stiffness) {
        fibres_.add_rank_one(fibre, first_unknown, weights, stiffness);
    }
    void add_diagonal(Index vector, const Mat3& stiffness) { fibres_.add_diagonal(vector, stiffness); }
    const Row row(Index fibre, Index node) const { return fibres_.row(fibre, node); }
    void index_points() { fibres_.index_points(); }
    void fill_bands() noexcept { fibres_.fill_bands(); }

    /// y = A x
    void apply(const Vector& x, Vector& y) const {
        const auto is_free = [&](const scene::HeldVector& held) {
            return Vec3(held.free * x.segment<3>(3 * held.vector)) == x.segment<3>(3 * held.vector);
        };
        if (layout_.ties.empty() && std::all_of(layout_.held.begin(), layout_.held.end(), is_free)) {
            apply_unheld(x, y);
        } else {
            free_ = x;
            scene::project_free(layout_, free_);
            apply_unheld(free_, y);
            scene::add_motion_stiffness(layout_, free_, y);
            scene::complete_ties(layout_, x, y);
        }
        for (const scene::HeldVector& held : layout_.held) {
            const Vec3 whole = layout_.held_stiffness(held.vector) * x.segment<3>(3 * held.vector);
            y.segment<3>(3 * held.vector) = held.free * y.segment<3>(3 * held.vector) + whole - held.free * whole;
        }
    }
    /// y = K x, as if nothing were held.
    void apply_unheld(const Vector& x, Vector& y) const {
        fibres_.apply_unheld(x, y);
        solid_->apply(x, y);
    }
    void apply_skews(const Vector& x, Vector& y) const { fibres_.apply_skews(x, y); }

    void chain_band(Index chain, Matrix& blocks) const {
        if (chain < core::count(fibres_.layout().chains)) return fibres_.chain_band(chain, blocks);
        blocks.resize(3 * solid_->nodes(), 3);
        for (Index n = 0; n < solid_->nodes(); ++n)
            blocks.block<3, 3>(3 * n, 0) = solid_->diagonal(n) + support(n) * Mat3::Identity();
        for (const scene::HeldVector& held : layout_.held) {
            const Index n = held.vector - solid_->first_vector();
            if (n < 0) continue;
            blocks.block<3, 3>(3 * n, 0) = (held.free * blocks.block<3, 3>(3 * n, 0) * held.free +
                                            layout_.held_stiffness(held.vector) * (Mat3::Identity() - held.free))
                                               .eval();
        }
    }
    void chain_corner(Index chain, Matrix& corner) const { fibres_.chain_corner(chain, corner); }
    void node_blocks(Index chain, Matrix& blocks) const {
        if (chain < core::count(fibres_.layout().chains)) return fibres_.node_blocks(chain, blocks);
        chain_band(chain, blocks);
    }

    /// see(i, j, block) of the solids' nodes, j <= i, in order, with what stands for their ties.
    template <class See>
    void visit_solid_blocks(const See& see) const {
        if (supports_.empty()) return solid_->visit_blocks(see);
        solid_->visit_blocks([&](Index i, Index j, const Mat3& stiffness) {
            if (i == j)
                see(i, j, Mat3(stiffness + support(i) * Mat3::Identity()));
            else
                see(i, j, stiffness);
        });
    }

    template <class Terms>
    void visit(Terms& terms) const {
        fibres_.visit(terms);
        visit_solid(terms, 0);
    }
    template <class Terms>
    void visit_couplings(Terms& terms) const {
        fibres_.visit_couplings(terms);
        visit_solid(terms, 1);
    }

private:
    double support(Index node) const noexcept { return supports_.empty() ? 0.0 : supports_[core::at(node)]; }
    /// The fibres' part of ties, as supports only: projections are those of the whole.
    void share_ties() {
        supports_.assign(core::at(solid_->nodes()), 0.0);
        fibres_.layout().ties = layout_.ties;
        for (scene::Tie& tie : fibres_.layout().ties) {
            for (const Index vector : tie.vectors)
                if (vector >= solid_->first_vector()) supports_[core::at(vector - solid_->first_vector())] += tie.support;
            std::erase_if(tie.vectors, [&](Index vector) { return vector >= solid_->first_vector(); });
            tie.weights.resize(tie.vectors.size());  // ends of fibres come first
        }
    }
    /// Blocks of the solid, from node n with node n - `apart` or one before it on; then what bonds couple.
    template <class Terms>
    void visit_solid(Terms& terms, Index apart) const {
        const Index first = solid_->first_vector();
        Matrix block = Matrix::Zero(6, 6), own = Matrix::Zero(3, 3);
        visit_solid_blocks([&](Index i, Index j, const Mat3& stiffness) {
            if (i - j < apart) return;
            if (i == j) {
                const std::array<Index, 1> vector{first + i};
                own = stiffness;
                terms.dense(DenseTerm{vector, own});
                return;
            }
            const std::array<Index, 2> vectors{first + i, first + j};
            block.topRightCorner<3, 3>() = stiffness, block.bottomLeftCorner<3, 3>() = stiffness.transpose();
            terms.dense(DenseTerm{vectors, block});
        });
        Matrix tie = Matrix::Zero(27, 27);
        std::array<Index, 9> vectors{};
        for (std::size_t b = 0; b < solid_->bonds().size(); ++b) {
            if (!solid_->holds(b)) continue;
            const auto& bond = solid_->bonds()[b];
            vectors[8] = bond.vector;
            for (int k = 0; k < 8; ++k) {
                vectors[core::at(k)] = first + bond.nodes[core::at(k)];
                const double value = -bond.stiffness * bond.weights[k];
                for (int d = 0; d < 3; ++d) tie(3 * k + d, 24 + d) = tie(24 + d, 3 * k + d) = value;
            }
            terms.dense(DenseTerm{vectors, tie});
        }
    }

    Fibres fibres_;
    const Solid* solid_;
    scene::DofLayout layout_;
    std::vector<double> supports_;  // of tied nodes of the solid; empty if there are no ties
    mutable Vector free_;           // scratch of a product: one system serves one thread at a time
};

/// The system of a model: fibres alone where it has no solid.
template <beam::BeamElement B, class Solid>
struct SystemOf {
    using Type = SolidSystem<B, Solid>;
};
template <beam::BeamElement B>
struct SystemOf<B, solid::NoSolid> {
    using Type = ChainSystem<B>;
};

}  // namespace fibrant::assembly

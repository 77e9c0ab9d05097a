// SPDX-License-Identifier: MIT
#pragma once
/// @file The pieces of chains that some parts hold, as a system of chains of its own.

#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// The pieces of parts [first, last) as chains, with the terms that lie within one part as couplings. Nodes that pieces of
/// several parts share are there several times: their vectors have numbers of their own, `slots`. The band of a piece is that of
/// its chain, so what it is coupled with beyond it counts as held.
class PieceSystem {
public:
    /// Numbers the slots; takes no values.
    void analyse(const scene::DofLayout& whole, const Subdomains& cut, Index first_part, Index last_part) {
        pieces_.assign(cut.pieces().begin() + cut.first_piece()[core::at(first_part)],
                       cut.pieces().begin() + cut.first_piece()[core::at(last_part)]);
        layout_ = {};
        layout_.unit_length = whole.unit_length, layout_.unit_stiffness = whole.unit_stiffness;
        vector_.clear();
        first_slot_.assign(1, 0);
        for (const Piece& piece : pieces_) {
            const scene::Chain& chain = whole.chains[core::at(piece.chain)];
            while (core::count(first_slot_) <= piece.part - first_part) first_slot_.push_back(core::count(vector_));
            layout_.chains.push_back({core::count(vector_), piece.nodes, chain.vectors_per_node,
                                      std::min(chain.reach, piece.nodes - 1), piece.part, false});
            const Index first = chain.first_vector + piece.first_node * chain.vectors_per_node;
            for (Index v = first; v < first + piece.nodes * chain.vectors_per_node; ++v) vector_.push_back(v);
        }
        while (core::count(first_slot_) <= last_part - first_part) first_slot_.push_back(core::count(vector_));
        for (const Index v : vector_) {
            layout_.kind.push_back(whole.kind[core::at(v)]);
            layout_.value.push_back(whole.value[core::at(v)]);
            layout_.length.push_back(whole.length[core::at(v)]);
        }
        std::vector<std::pair<Index, Index>> order;  // vector, slot
        for (Index s = 0; s < core::count(vector_); ++s) order.emplace_back(vector_[core::at(s)], s);
        std::sort(order.begin(), order.end());
        first_of_.assign(core::at(whole.vectors() + 1), 0);
        slot_of_.clear();
        for (const auto& [vector, slot] : order) ++first_of_[core::at(vector + 1)], slot_of_.push_back(slot);
        for (std::size_t v = 1; v < first_of_.size(); ++v) first_of_[v] += first_of_[v - 1];
    }

    /// Takes the values: bands of all chains that have pieces here, and the terms within parts.
    /// @param bands  of each chain of the whole system; those without a piece here may be empty
    /// @param terms  of the whole system; those that have no vector here may be missing
    void take(const scene::DofLayout& whole, const std::vector<Matrix>& bands, const PairTerms& terms) {
        bands_ = &bands;
        layout_.held.clear();
        for (const scene::HeldVector& held : whole.held)
            for (const Index slot : slots(held.vector)) layout_.held.push_back({slot, held.free});
        std::sort(layout_.held.begin(), layout_.held.end(), [](const auto& a, const auto& b) { return a.vector < b.vector; });
        terms_ = &terms;
        local_.clear(), slots_.clear();
        for (Index k = 0; k < terms.size(); ++k)
            for (const Index slot : slots(terms[k].vectors.front())) add(k, terms[k].vectors, part_of(slot));
        std::stable_sort(local_.begin(), local_.end(), [](const Local& a, const Local& b) { return a.part < b.part; });
    }

    Index slots() const noexcept { return core::count(vector_); }
    /// Slots of a part of this system, from 0.
    std::pair<Index, Index> slots_of_part(Index part) const noexcept {
        return {first_slot_[core::at(part)], first_slot_[core::at(part + 1)]};
    }
    /// Vector of each slot.
    const std::vector<Index>& vector() const noexcept { return vector_; }
    /// Slots of a vector, rising by part.
    std::span<const Index> slots(Index vector) const noexcept {
        return std::span(slot_of_).subspan(core::at(first_of_[core::at(vector)]),
                                           core::at(first_of_[core::at(vector + 1)] - first_of_[core::at(vector)]));
    }
    const std::vector<Piece>& pieces() const noexcept { return pieces_; }

    const scene::DofLayout& layout() const noexcept { return layout_; }
    void chain_band(Index piece, Matrix& blocks) const {
        const Piece& own = pieces_[core::at(piece)];
        const scene::Chain& chain = layout_.chains[core::at(piece)];
        const Index m = 3 * chain.vectors_per_node;
        blocks = (*bands_)[core::at(own.chain)].block(own.first_node * m, 0, own.nodes * m, (chain.reach + 1) * m);
        for (Index a = 0; a < std::min(chain.reach, own.nodes); ++a)  // what is coupled with nodes before the piece
            blocks.block(a * m, (a + 1) * m, m, (chain.reach - a) * m).setZero();
    }
    void node_blocks(Index piece, Matrix& blocks) const {
        Matrix band;
        chain_band(piece, band);
        blocks = band.leftCols(3 * layout_.chains[core::at(piece)].vectors_per_node);
    }
    Index couplings() const noexcept { return core::count(local_); }
    template <class Terms>
    void visit_couplings(Terms& terms, Index first, Index last) const {
        for (Index k = first; k < last; ++k) {
            const PairTerms::Term term = (*terms_)[local_[core::at(k)].term];
            terms.point(assembly::PointTerm{std::span(slots_).subspan(local_[core::at(k)].first, term.vectors.size()),
                                            term.weights, term.stiffness});
        }
    }
    template <class Terms>
    void visit_couplings(Terms& terms) const {
        visit_couplings(terms, 0, couplings());
    }
    template <class Terms>
    void visit(Terms& terms) const {
        visit_couplings(terms);
    }
    /// Of a preconditioner's system alone: there is no product.
    void apply(const Vector&, Vector&) const {}

private:
    struct Local {
        Index part, term;
        std::size_t first;  // of its slots
    };
    Index part_of(Index slot) const noexcept {
        return std::upper_bound(first_slot_.begin(), first_slot_.end(), slot) - first_slot_.begin() - 1;
    }
    /// Keeps a term of a part that has all of its vectors.
    void add(Index term, std::span<const std::int32_t> vectors, Index part) {
        const std::size_t begin = slots_.size();
        const Index first = first_slot_[core::at(part)], last = first_slot_[core::at(part + 1)];
        for (const std::int32_t v : vectors) {
            const auto of = slots(v);
            const auto own = std::find_if(of.begin(), of.end(), [&](Index slot) { return slot >= first && slot < last; });
            if (own == of.end()) return slots_.resize(begin);
            slots_.push_back(*own);
        }
        local_.push_back({part, term, begin});
    }

    std::vector<Piece> pieces_;
    scene::DofLayout layout_;
    std::vector<Index> vector_, first_slot_, first_of_, slot_of_;
    const std::vector<Matrix>* bands_ = nullptr;
    const PairTerms* terms_ = nullptr;
    std::vector<Local> local_;
    std::vector<Index> slots_;
};
static_assert(assembly::LinearSystem<PieceSystem>);

}  // namespace fibrant::distributed

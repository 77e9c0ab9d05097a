// SPDX-License-Identifier: MIT
#pragma once
/// @file The pieces of chains that some parts hold, as a system of chains of its own.

#include <fibrant/distributed/pair_terms.hpp>
#include <fibrant/distributed/subdomains.hpp>

#include <fibrant/core/parallel.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace fibrant::distributed {

/// The pieces of parts [first, last) as chains, with the terms between two pieces of a part as couplings. Vectors have numbers of
/// their own, `slots`. The band of a piece is that of its chain, so what it is coupled with beyond it counts as held; of a
/// particle that stands on a joint, too, a piece has its share.
class PieceSystem {
public:
    /// Numbers the slots; takes no values.
    void analyse(const scene::DofLayout& whole, const Subdomains& cut, Index first_part, Index last_part) {
        pieces_.assign(cut.pieces().begin() + cut.first_piece()[core::at(first_part)],
                       cut.pieces().begin() + cut.first_piece()[core::at(last_part)]);
        layout_ = {};
        layout_.unit_length = whole.unit_length, layout_.unit_stiffness = whole.unit_stiffness;
        vector_.clear();
        for (const Piece& piece : pieces_) {
            const scene::Chain& chain = whole.chains[core::at(piece.chain)];
            layout_.chains.push_back({core::count(vector_), piece.nodes, chain.vectors_per_node,
                                      std::min(chain.reach, piece.nodes - 1), piece.part, false});
            const Index first = chain.first_vector + piece.first_node * chain.vectors_per_node;
            for (Index v = first; v < first + piece.nodes * chain.vectors_per_node; ++v) vector_.push_back(v);
        }
        for (const Index v : vector_) {
            layout_.kind.push_back(whole.kind[core::at(v)]);
            layout_.value.push_back(whole.value[core::at(v)]);
            layout_.length.push_back(whole.length[core::at(v)]);
        }
        slot_of_.assign(core::at(whole.vectors()), -1);
        for (Index s = 0; s < core::count(vector_); ++s) slot_of_[core::at(vector_[core::at(s)])] = s;
        in_piece_.assign(core::at(whole.vectors()), 0);
        for (const Piece& piece : cut.pieces()) {
            const scene::Chain& chain = whole.chains[core::at(piece.chain)];
            const auto first = in_piece_.begin() + chain.first_vector + piece.first_node * chain.vectors_per_node;
            std::fill(first, first + piece.nodes * chain.vectors_per_node, 1);
        }
        piece_of_.clear();
        for (Index p = 0; p < core::count(pieces_); ++p)
            piece_of_.insert(piece_of_.end(),
                             core::at(layout_.chains[core::at(p)].nodes * layout_.chains[core::at(p)].vectors_per_node), p);
    }

    /// Takes the values: bands of all chains that have pieces here, and the terms within parts.
    /// @param bands  of each chain of the whole system; those without a piece here may be empty
    /// @param terms  of the whole system; those that have no vector here may be missing
    void take(const scene::DofLayout& whole, const std::vector<Matrix>& bands, const PairTerms& terms) {
        bands_ = &bands;
        layout_.held.clear();
        for (const scene::HeldVector& held : whole.held)
            if (slot_of_[core::at(held.vector)] >= 0) layout_.held.push_back({slot_of_[core::at(held.vector)], held.free});
        std::sort(layout_.held.begin(), layout_.held.end(), [](const auto& a, const auto& b) { return a.vector < b.vector; });
        terms_ = &terms;
        local_.clear(), slots_.clear(), weights_.clear();
        for (Index k = 0; k < terms.size(); ++k) add(k);
        std::stable_sort(local_.begin(), local_.end(), [](const Local& a, const Local& b) { return a.part < b.part; });
    }

    Index slots() const noexcept { return core::count(vector_); }
    /// Vector of each slot.
    const std::vector<Index>& vector() const noexcept { return vector_; }
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
            const std::size_t begin = local_[core::at(k)].first, count = term.vectors.size();
            terms.point(assembly::PointTerm{std::span(slots_).subspan(begin, count), std::span(weights_).subspan(begin, count),
                                            term.stiffness});
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
        int part;
        Index term;
        std::size_t first;  // of its slots
    };
    /// Keeps a term between two pieces of a part: of each particle the first of all pieces that it lies in, whoever has it, or
    /// what is kept would depend on the ranks. Vectors of a particle that its piece does not have are replaced by others of the
    /// piece, without weight: all terms have as many.
    void add(Index k) {
        const PairTerms::Term term = (*terms_)[k];
        if (!terms_->usual(term)) return;  // ChainCouplings leaves them out as well, but by those that come first here
        const std::size_t begin = slots_.size();
        const Index count = terms_->usual_count(), stride = terms_->usual_stride();
        int part = -1;
        for (std::size_t side = 0; side < 2; ++side) {
            const auto vectors = term.side(side);
            const auto weights = term.weights_of(side);
            const auto known =
                std::find_if(vectors.begin(), vectors.end(), [&](std::int32_t v) { return in_piece_[core::at(v)] != 0; });
            const auto drop = [&] { slots_.resize(begin), weights_.resize(begin); };
            if (known == vectors.end() || slot_of_[core::at(*known)] < 0) return drop();
            const Index piece = piece_of_[core::at(slot_of_[core::at(*known)])];
            const scene::Chain& chain = layout_.chains[core::at(piece)];
            const Index end = chain.first_vector + chain.nodes * chain.vectors_per_node;
            if (part >= 0 && part != pieces_[core::at(piece)].part) return drop();
            part = pieces_[core::at(piece)].part;
            // Where the particle would begin, moved by whole nodes to where the piece has all of its vectors.
            Index first = slot_of_[core::at(*known)] - (known - vectors.begin()) * stride;
            while (first < chain.first_vector) first += chain.vectors_per_node;
            while (first + (count - 1) * stride >= end) first -= chain.vectors_per_node;
            if (first < chain.first_vector) return drop();
            const std::size_t at = slots_.size();
            for (Index i = 0; i < count; ++i) slots_.push_back(first + i * stride), weights_.push_back(0.0);
            for (std::size_t i = 0; i < vectors.size(); ++i) {
                const Index slot = slot_of_[core::at(vectors[i])];
                if (slot < 0 || piece_of_[core::at(slot)] != piece) continue;
                if ((slot - first) % stride != 0) return drop();
                weights_[at + core::at((slot - first) / stride)] = weights[i];
            }
        }
        local_.push_back({part, k, begin});
    }

    std::vector<Piece> pieces_;
    scene::DofLayout layout_;
    std::vector<Index> vector_, slot_of_, piece_of_;  // of each slot; of each vector, or -1; of each slot
    std::vector<char> in_piece_;                      // of each vector: whether a piece has it, here or elsewhere
    const std::vector<Matrix>* bands_ = nullptr;
    const PairTerms* terms_ = nullptr;
    std::vector<Local> local_;
    std::vector<Index> slots_;
    std::vector<double> weights_;
};
static_assert(assembly::LinearSystem<PieceSystem>);

}  // namespace fibrant::distributed

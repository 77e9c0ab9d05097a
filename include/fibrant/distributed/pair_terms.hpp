// SPDX-License-Identifier: MIT
#pragma once
/// @file The terms that couple what no band of a chain does, in flat lists: what ranks keep of a system beside its bands.

#include <fibrant/assembly/visited_system.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// Terms (w w^T) (x) stiffness of the particles of two chains. What each particle is coupled with itself by is in the band of its
/// chain; here it is what couples the two. Others, of places that slide and of a fibre that touches itself, are few and whole:
/// they may reach beyond a band, and what lies within one is left out of them.
class PairTerms {
public:
    struct Term {
        std::span<const std::int32_t> vectors;  ///< of both particles, one behind the other
        std::span<const double> weights;
        std::size_t split;  ///< number of the first vector of the second particle
        const Mat3& stiffness;
        std::span<const std::int32_t> side(std::size_t k) const noexcept {
            return k == 0 ? vectors.first(split) : vectors.subspan(split);
        }
        std::span<const double> weights_of(std::size_t k) const noexcept {
            return k == 0 ? weights.first(split) : weights.subspan(split);
        }
    };

    /// Not of pairs: the blocks that no band has.
    struct Whole {
        std::vector<Index> vectors;
        Matrix stiffness;  ///< 3 a vector, zero where both of a block lie within the band of a chain
    };

    Index size() const noexcept { return core::count(stiffness_); }
    const std::vector<Whole>& wholes() const noexcept { return wholes_; }
    Term operator[](Index k) const noexcept {
        const auto first = core::at(first_[core::at(k)]), count = core::at(first_[core::at(k + 1)]) - first;
        return {std::span(vectors_).subspan(first, count), std::span(weights_).subspan(first, count), split_[core::at(k)],
                stiffness_[core::at(k)]};
    }
    void clear() {
        first_.assign(1, 0);
        usual_count_ = 0, usual_stride_ = 1;
        vectors_.clear(), weights_.clear(), split_.clear(), stiffness_.clear(), wholes_.clear();
    }

    /// Vectors of a particle of the first term of the system, whether it is kept or not, and the step from one to the next: as
    /// those of most terms. 0 if there is none.
    Index usual_count() const noexcept { return usual_count_; }
    Index usual_stride() const noexcept { return usual_stride_; }
    /// Whether both particles of a term have as many vectors, with such steps.
    bool usual(const Term& term) const noexcept {
        if (core::count(term.vectors) != 2 * usual_count_ || core::count(term.side(0)) != usual_count_) return false;
        for (std::size_t side = 0; side < 2; ++side)
            for (std::size_t k = 1; k < term.side(side).size(); ++k)
                if (term.side(side)[k] - term.side(side)[k - 1] != usual_stride_) return false;
        return true;
    }

    /// Takes the terms of a system in their order: all, or those that `wanted(vectors)` is true of. Bands have to have all that
    /// lies within them (solver::ReadsWholeBands).
    template <assembly::VisitedSystem System, class Wanted>
    void take(const System& system, const Wanted& wanted) {
        clear();
        struct Taker {
            PairTerms& own;
            const scene::DofLayout& layout;
            assembly::VectorPlaces places;
            const Wanted& wanted;

            /// Whether the band of a chain has what couples two vectors.
            bool in_band(Index v, Index w) const {
                const Index c = places.chain(v);
                if (c != places.chain(w)) return false;
                const scene::Chain& chain = layout.chains[core::at(c)];
                return std::abs(places.number(v) / chain.vectors_per_node - places.number(w) / chain.vectors_per_node) <=
                       chain.reach;
            }
            bool in_band(std::span<const Index> vectors) const {
                return std::all_of(vectors.begin(), vectors.end(), [&](Index v) {
                    return std::all_of(vectors.begin(), vectors.end(), [&](Index w) { return in_band(v, w); });
                });
            }
            void dense(const assembly::DenseTerm& term) const {
                if (!in_band(term.vectors) && wanted(term.vectors)) keep(term.vectors, term.stiffness);
            }
            void keep(std::span<const Index> vectors, const Matrix& stiffness) const {
                Whole whole{{vectors.begin(), vectors.end()}, stiffness};
                for (std::size_t i = 0; i < vectors.size(); ++i)
                    for (std::size_t j = 0; j < vectors.size(); ++j)
                        if (in_band(vectors[i], vectors[j]))
                            whole.stiffness.block<3, 3>(3 * static_cast<Index>(i), 3 * static_cast<Index>(j)).setZero();
                own.wholes_.push_back(std::move(whole));
            }
            void point(const assembly::PointTerm& term) const {
                const auto begin = term.vectors.begin(), end = term.vectors.end();
                const Index first = places.chain(term.vectors.front());
                const auto split = std::find_if(begin, end, [&](Index v) { return places.chain(v) != first; });
                const bool pair = split != end && in_band({begin, split}) && in_band({split, end});
                if (!pair && in_band(term.vectors)) return;
                if (pair && own.usual_count_ == 0) {
                    own.usual_count_ = split - begin;
                    own.usual_stride_ = own.usual_count_ > 1 ? term.vectors[1] - term.vectors[0] : 1;
                }
                if (!wanted(term.vectors)) return;
                if (!pair) {
                    const Index count = core::count(term.vectors);
                    Matrix whole(3 * count, 3 * count);
                    for (Index i = 0; i < count; ++i)
                        for (Index j = 0; j < count; ++j)
                            whole.block<3, 3>(3 * i, 3 * j) =
                                term.weights[core::at(i)] * term.weights[core::at(j)] * term.stiffness;
                    return keep(term.vectors, whole);
                }
                for (const Index v : term.vectors) own.vectors_.push_back(static_cast<std::int32_t>(v));
                own.weights_.insert(own.weights_.end(), term.weights.begin(), term.weights.end());
                own.split_.push_back(static_cast<std::size_t>(split - begin));
                own.stiffness_.push_back(term.stiffness);
                own.first_.push_back(core::count(own.vectors_));
            }
        } taker{*this, system.layout(), assembly::VectorPlaces(system.layout()), wanted};
        assembly::visit_couplings(system, taker);
    }

private:
    Index usual_count_ = 0, usual_stride_ = 1;
    std::vector<Index> first_{0};
    std::vector<std::int32_t> vectors_;
    std::vector<double> weights_;
    std::vector<std::size_t> split_;
    std::vector<Mat3> stiffness_;
    std::vector<Whole> wholes_;
};

}  // namespace fibrant::distributed

// SPDX-License-Identifier: MIT
#pragma once
/// @file The point terms that couple two chains, in flat lists: what ranks keep of a system beside its bands.

#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/core/parameters.hpp>

#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace fibrant::distributed {

/// Terms (w w^T) (x) stiffness of the particles of two chains. What each particle is coupled with itself by is in the band of its
/// chain; here it is what couples the two.
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

    Index size() const noexcept { return core::count(stiffness_); }
    Term operator[](Index k) const noexcept {
        const auto first = core::at(first_[core::at(k)]), count = core::at(first_[core::at(k + 1)]) - first;
        return {std::span(vectors_).subspan(first, count), std::span(weights_).subspan(first, count), split_[core::at(k)],
                stiffness_[core::at(k)]};
    }
    void clear() {
        first_.assign(1, 0);
        usual_count_ = 0, usual_stride_ = 1;
        vectors_.clear(), weights_.clear(), split_.clear(), stiffness_.clear();
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

    /// Takes the terms of a system in their order: all, or those that `wanted(vectors)` is true of.
    /// @throws std::invalid_argument where a system couples chains by more than pairs of particles
    template <assembly::VisitedSystem System, class Wanted>
    void take(const System& system, const Wanted& wanted) {
        clear();
        struct Taker {
            PairTerms& own;
            const scene::DofLayout& layout;
            assembly::VectorPlaces places;
            const Wanted& wanted;

            bool in_band(std::span<const Index> vectors) const {
                const Index c = places.chain(vectors.front());
                const scene::Chain& chain = layout.chains[core::at(c)];
                Index low = chain.nodes, high = 0;
                for (const Index v : vectors) {
                    if (places.chain(v) != c) return false;
                    const Index node = places.number(v) / chain.vectors_per_node;
                    low = std::min(low, node), high = std::max(high, node);
                }
                return high - low <= chain.reach;
            }
            void dense(const assembly::DenseTerm& term) const {
                if (!in_band(term.vectors))
                    core::refuse("PairTerms.system", "a system with dense terms between chains",
                                 "one of chains and contacts between two of them: solids and sliding places are not shared "
                                 "among ranks yet");
            }
            void point(const assembly::PointTerm& term) const {
                const auto begin = term.vectors.begin(), end = term.vectors.end();
                const Index first = places.chain(term.vectors.front());
                const auto split = std::find_if(begin, end, [&](Index v) { return places.chain(v) != first; });
                const bool pair = split != end && in_band({begin, split}) && in_band({split, end});
                if (!pair && !in_band(term.vectors))
                    core::refuse("PairTerms.system", "a system with terms of one chain far apart, or of three",
                                 "one of contacts between two chains: a fibre that touches itself is not shared among ranks yet");
                if (pair && own.usual_count_ == 0) {
                    own.usual_count_ = split - begin;
                    own.usual_stride_ = own.usual_count_ > 1 ? term.vectors[1] - term.vectors[0] : 1;
                }
                if (!pair || !wanted(term.vectors)) return;
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
};

}  // namespace fibrant::distributed

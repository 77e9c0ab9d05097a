// SPDX-License-Identifier: MIT
#pragma once
/// @file What point terms couple chains by, sorted for sweeps over chains: classes of chains that nothing couples, and who comes
/// first.

#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/solver/linear_solver.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// L + L^T, the part of A between different chains that (w w^T) (x) K of two particles makes, in float and in the units of the
/// layout; L couples a chain with those of earlier classes.
///
/// What else couples chains, dense
/// terms and points of more than two chains, is left out: sweeps are positive definite with any L.
class ChainCouplings {
public:
    using Value = Eigen::Array4f;
    /// Values of a chain among those of a pack.
    template <class Real>
    struct Line {
        Real* first;
        std::size_t stride;
        Real unit =
            1;  ///< what the values are in units of the couplings: forces that are taken off them, or displacements that are kept
        Real& operator[](std::size_t unknown) const noexcept { return first[stride * unknown]; }
    };

    /// Takes over the terms of a system, and sorts its chains into classes.
    template <assembly::LinearSystem System>
    void find(const System& system) {
        const scene::DofLayout& layout = system.layout();
        core::release(sides_), core::release(motion_), core::release(weights_);  // before there are others
        collect(system);
        sort_by_chain(core::count(layout.chains));
        colour();
        arrange();
        core::release(pairs_), core::release(pair_weights_), core::release(order_);  // sweeps have what they read in their order
        find_held(layout);
    }

    bool empty() const noexcept { return sides_.empty(); }
    /// Classes, numbered in the order of a sweep.
    int classes() const noexcept { return classes_; }
    /// Class of each chain.
    const std::vector<int>& class_of() const noexcept { return class_; }
    bool couples(Index chain) const noexcept { return first_[core::at(chain)] < first_[core::at(chain) + 1]; }

    /// line -= L z, line -= L^T z and both of a chain, z being what was kept of the chains that it is coupled with.
    template <class Real>
    void subtract_earlier(Index chain, Line<Real> line) const {
        subtract(chain, first_[core::at(chain)], middle_[core::at(chain)], line);
    }
    template <class Real>
    void subtract_later(Index chain, Line<Real> line) const {
        subtract(chain, middle_[core::at(chain)], first_[core::at(chain) + 1], line);
    }
    template <class Real>
    void subtract(Index chain, Line<Real> line) const {
        subtract(chain, first_[core::at(chain)], first_[core::at(chain) + 1], line);
    }
    /// Keeps of a chain's z what its later chains, its earlier ones, or all will ask for.
    template <class Real>
    void keep_for_later(Index chain, Line<Real> line) {
        keep(middle_[core::at(chain)], first_[core::at(chain) + 1], line);
    }
    template <class Real>
    void keep_for_earlier(Index chain, Line<Real> line) {
        keep(first_[core::at(chain)], middle_[core::at(chain)], line);
    }
    template <class Real>
    void keep(Index chain, Line<Real> line) {
        keep(first_[core::at(chain)], first_[core::at(chain) + 1], line);
    }

private:
    /// Two particles of different chains; `first` is the number of the first vector in its chain.
    struct Pair {
        std::array<std::int32_t, 2> chain{}, first{};
        std::array<float, 9> stiffness{};  // columns
    };
    struct Side {
        std::int32_t first = 0, partner = 0;  // vector in the chain; side of the other particle
        std::array<Value, 3> stiffness;       // columns
    };
    struct Part {
        std::vector<Pair> pairs;
        std::vector<float> weights;  // of both particles of each pair
    };

    /// Finds the pairs among the terms. All have as many weights, and the same stride between their vectors.
    struct Collector {
        const assembly::VectorPlaces& places;
        double over_stiffness;
        std::size_t& count;
        Index& stride;
        Part& part;
        void dense(const assembly::DenseTerm&) const noexcept {}
        void point(const assembly::PointTerm& term) const {
            const std::size_t half = term.vectors.size() / 2;
            if (half == 0 || term.vectors.size() != 2 * half) return;
            const Index step = half > 1 ? term.vectors[1] - term.vectors[0] : 1;
            if (step < 1 || (count != 0 && (half != count || step != stride))) return;
            Pair pair;
            for (std::size_t side = 0; side < 2; ++side) {
                const auto vectors = term.vectors.subspan(side * half, half);
                pair.chain[side] = static_cast<std::int32_t>(places.chain(vectors.front()));
                pair.first[side] = static_cast<std::int32_t>(places.number(vectors.front()));
                for (std::size_t k = 1; k < half; ++k)
                    if (vectors[k] - vectors[k - 1] != step || places.chain(vectors[k]) != pair.chain[side]) return;
            }
            if (pair.chain[0] == pair.chain[1]) return;
            if (count == 0) count = half, stride = step;
            for (Index k = 0; k < 9; ++k)
                pair.stiffness[core::at(k)] = static_cast<float>(over_stiffness * term.stiffness.data()[k]);
            part.pairs.push_back(pair);
            for (const double weight : term.weights) part.weights.push_back(static_cast<float>(weight));
        }
    };

    template <class System>
    void collect(const System& system) {
        const assembly::VectorPlaces places(system.layout());
        const double over_stiffness = 1.0 / system.layout().unit_stiffness;
        weights_each_ = 0, stride_ = 1;
        Part all;
        if constexpr (assembly::DivisibleCouplings<System>) {
            constexpr Index block = 2048;
            const Index terms = system.couplings();
            const auto take = [&](Index first, Index last, Part& part) {
                Collector collector{places, over_stiffness, weights_each_, stride_, part};
                system.visit_couplings(collector, first, last);
            };
            Index seen = 0;  // until it is known how many weights there are
            while (seen < terms && weights_each_ == 0) take(seen, seen + 1, all), ++seen;
            std::vector<std::vector<Pair>> pairs(core::at((terms - seen + block - 1) / block + 1));
            std::vector<std::vector<float>> weights(pairs.size());
            pairs[0] = std::move(all.pairs), weights[0] = std::move(all.weights);
            core::parallel_for(core::count(pairs) - 1, [&](Index b) {
                Part part;
                part.pairs.reserve(block), part.weights.reserve(2 * weights_each_ * block);
                take(seen + block * b, std::min(terms, seen + block * (b + 1)), part);
                pairs[core::at(b + 1)] = std::move(part.pairs), weights[core::at(b + 1)] = std::move(part.weights);
            });
            core::join(pairs, pairs_), core::join(weights, pair_weights_);
        } else {
            Collector collector{places, over_stiffness, weights_each_, stride_, all};
            assembly::visit_couplings(system, collector);
            pairs_ = std::move(all.pairs), pair_weights_ = std::move(all.weights);
        }
    }

    /// Sides of each chain, 2 pair + side, along the chain.
    void sort_by_chain(Index chains) {
        first_.assign(core::at(chains) + 1, 0);
        for (const Pair& pair : pairs_)
            for (const std::int32_t chain : pair.chain) ++first_[core::at(chain) + 1];
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        core::resize_anew(order_, 2 * pairs_.size());
        std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
        for (std::int32_t k = 0; k < static_cast<std::int32_t>(pairs_.size()); ++k)
            for (std::int32_t side = 0; side < 2; ++side)
                order_[core::at(next[core::at(pairs_[core::at(k)].chain[core::at(side)])]++)] = 2 * k + side;
    }
    std::int32_t own_chain(std::int32_t side) const noexcept { return pairs_[core::at(side / 2)].chain[core::at(side % 2)]; }
    std::int32_t other_chain(std::int32_t side) const noexcept {
        return pairs_[core::at(side / 2)].chain[core::at(1 - side % 2)];
    }

    /// Chain after chain takes the first class that none of its neighbours has; the first class, as a rule the largest, is swept
    /// last, for its chains have nothing to solve on the way back.
    void colour() {
        const Index chains = core::count(first_) - 1;
        class_.assign(core::at(chains), -1);
        std::vector<Index> taken_by;  // chain that last found a class taken
        for (Index c = 0; c < chains; ++c) {
            for (std::int32_t s = first_[core::at(c)]; s < first_[core::at(c) + 1]; ++s) {
                const int neighbour = class_[core::at(other_chain(order_[core::at(s)]))];
                if (neighbour >= 0) taken_by[core::at(neighbour)] = c;
            }
            const auto free = std::find_if(taken_by.begin(), taken_by.end(), [c](Index by) { return by != c; });
            class_[core::at(c)] = static_cast<int>(free - taken_by.begin());
            if (free == taken_by.end()) taken_by.push_back(-1);
        }
        classes_ = static_cast<int>(taken_by.size());
        for (int& own : class_) own = classes_ - 1 - own;
    }

    /// Earlier sides of each chain first, both along the chain.
    void arrange() {
        const Index chains = core::count(first_) - 1;
        middle_.resize(core::at(chains));
        std::vector<std::int32_t> slot(order_.size());
        core::parallel_for(
            chains,
            [&](Index c) {
                const auto begin = order_.begin() + first_[core::at(c)], end = order_.begin() + first_[core::at(c) + 1];
                const auto key = [&](std::int32_t side) {
                    return std::tuple(class_[core::at(other_chain(side))] > class_[core::at(c)],
                                      pairs_[core::at(side / 2)].first[core::at(side % 2)], side);
                };
                std::sort(begin, end, [&](std::int32_t a, std::int32_t b) { return key(a) < key(b); });
                const auto later = std::find_if(begin, end, [&](std::int32_t side) { return std::get<0>(key(side)); });
                middle_[core::at(c)] = static_cast<std::int32_t>(later - order_.begin());
                for (auto side = begin; side != end; ++side)
                    slot[core::at(*side)] = static_cast<std::int32_t>(side - order_.begin());
            },
            core::light_items / 8);
        core::resize_anew(sides_, order_.size());
        core::resize_anew(motion_, order_.size());
        core::resize_anew(weights_, pair_weights_.size());
        core::parallel_for(
            core::count(order_),
            [&](Index s) {
                const std::int32_t side = order_[core::at(s)];
                const Pair& pair = pairs_[core::at(side / 2)];
                Side& own = sides_[core::at(s)];
                own.first = pair.first[core::at(side % 2)];
                own.partner = slot[core::at(side ^ 1)];
                for (std::size_t k = 0; k < 3; ++k)
                    own.stiffness[k] = Value(pair.stiffness[3 * k], pair.stiffness[3 * k + 1], pair.stiffness[3 * k + 2], 0.0f);
                std::copy_n(pair_weights_.begin() + static_cast<std::ptrdiff_t>(weights_each_) * side, weights_each_,
                            weights_.begin() + static_cast<std::ptrdiff_t>(weights_each_) * s);
            },
            core::light_items);
    }

    void find_held(const scene::DofLayout& layout) {
        held_.assign(layout.chains.size(), {});
        for (const scene::HeldVector& held : layout.held) {
            const auto chain =
                std::upper_bound(layout.chains.begin(), layout.chains.end(), held.vector,
                                 [](Index vector, const scene::Chain& other) { return vector < other.first_vector; }) -
                1;
            held_[core::at(chain - layout.chains.begin())].emplace_back(held.vector - chain->first_vector,
                                                                        held.free.cast<float>());
        }
    }

    template <class Real>
    void subtract(Index chain, std::int32_t first, std::int32_t last, Line<Real> line) const {
        with_particle([&](auto fixed, Value* forces) {
            for (std::int32_t s = first; s < last;) {
                const std::int32_t start = sides_[core::at(s)].first;
                for (std::size_t k = 0; k < fixed.count; ++k) forces[k] = Value::Zero();
                for (; s < last && sides_[core::at(s)].first == start; ++s) {
                    const Side& side = sides_[core::at(s)];
                    // The other side of a pair may be anywhere.
                    core::prefetch(&motion_[core::at(sides_[core::at(std::min(s + 12, last - 1))].partner)]);
                    const Value& motion = motion_[core::at(side.partner)];
                    const Value force =
                        side.stiffness[0] * motion[0] + side.stiffness[1] * motion[1] + side.stiffness[2] * motion[2];
                    const float* weights = weights_.data() + fixed.count * static_cast<std::size_t>(s);
                    for (std::size_t k = 0; k < fixed.count; ++k) forces[k] += weights[k] * force;
                }
                for (std::size_t k = 0; k < fixed.count; ++k)
                    for (std::size_t i = 0; i < 3; ++i)
                        line[3 * (core::at(start) + k * fixed.stride) + i] -=
                            line.unit * static_cast<Real>(forces[k][static_cast<Index>(i)]);
            }
        });
        if (first == last) return;
        for (const auto& [vector, free] : held_[core::at(chain)]) {
            const std::size_t v = 3 * core::at(vector);
            const Eigen::Matrix<Real, 3, 1> value =
                free.template cast<Real>() * Eigen::Matrix<Real, 3, 1>(line[v], line[v + 1], line[v + 2]);
            for (std::size_t i = 0; i < 3; ++i) line[v + i] = value[static_cast<Index>(i)];
        }
    }
    template <class Real>
    void keep(std::int32_t first, std::int32_t last, Line<Real> line) {
        const Real over = 1 / line.unit;
        with_particle([&](auto fixed, Value* values) {
            for (std::int32_t s = first; s < last;) {
                const std::int32_t start = sides_[core::at(s)].first;
                for (std::size_t k = 0; k < fixed.count; ++k) {
                    const std::size_t v = 3 * (core::at(start) + k * fixed.stride);
                    values[k] = Value(static_cast<float>(over * line[v]), static_cast<float>(over * line[v + 1]),
                                      static_cast<float>(over * line[v + 2]), 0.0f);
                }
                for (; s < last && sides_[core::at(s)].first == start; ++s) {
                    const float* weights = weights_.data() + fixed.count * static_cast<std::size_t>(s);
                    Value sum = Value::Zero();
                    for (std::size_t k = 0; k < fixed.count; ++k) sum += weights[k] * values[k];
                    motion_[core::at(s)] = sum;
                }
            }
        });
    }
    struct Nine {
        static constexpr std::size_t count = 9, stride = 1;
    };
    struct Any {
        std::size_t count, stride;
    };
    /// body(count and stride of a particle's vectors, room for as many values); with three nodes of three vectors loops are
    /// unrolled.
    template <class Body>
    void with_particle(const Body& body) const {
        std::array<Value, Nine::count> few;
        if (weights_each_ == Nine::count && stride_ == Index{Nine::stride}) return body(Nine{}, few.data());
        std::vector<Value> many(weights_each_ > few.size() ? weights_each_ : 0);
        body(Any{weights_each_, core::at(stride_)}, many.empty() ? few.data() : many.data());
    }

    std::vector<Pair> pairs_;
    std::vector<float> pair_weights_, weights_;
    std::vector<std::int32_t> first_, middle_, order_;  // of each chain: its sides, and the first of those with a later chain
    std::vector<Side> sides_;
    std::vector<Value> motion_;                                         // of the particle of each side, as it was kept
    std::vector<std::vector<std::pair<Index, Eigen::Matrix3f>>> held_;  // of each chain: number and projector
    std::vector<int> class_;
    int classes_ = 0;
    std::size_t weights_each_ = 0;
    Index stride_ = 1;
};

}  // namespace fibrant::solver

// SPDX-License-Identifier: MIT
#pragma once
/// @file Subdomains of a scene: chains cut into pieces by place, so that parts of equal work touch few others.

#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace fibrant::distributed {

/// Consecutive nodes of a chain that a part works on.
struct Piece {
    int part = 0;
    Index chain = 0, first_node = 0, nodes = 0;
    friend bool operator==(const Piece&, const Piece&) = default;
};

/// Cut of a system into parts by recursive bisection of its elements (Berger and Bokhari, IEEE Transactions on Computers 36,
/// 1987), across the axis along which they are spread most.
///
/// An element is a run of `reach` nodes of a chain and the next one; a chain without reach has an element a node. Elements weigh
/// what their own stiffness costs and what the contacts on them cost. A node belongs to the lowest part among its elements; a
/// term to the part that owns its first vector. Where two parts meet in a chain its node is a joint, and the pieces of a part are
/// the nodes of its elements but joints. The cut depends on the system alone, not on who works on the parts.
class Subdomains {
public:
    struct Parameters {
        int parts = 64;  ///< subdomains, in [1, 4096]; no more than there are elements are made
        void validate() const { core::require(parts >= 1 && parts <= 4096, "Subdomains.parts", parts, "in [1, 4096]"); }
    };

    Subdomains() = default;
    /// @param system  of chains that do not close
    template <assembly::VisitedSystem System>
    Subdomains(const System& system, const Parameters& parameters) {
        core::validated(parameters);
        const scene::DofLayout& layout = system.layout();
        for (const scene::Chain& chain : layout.chains) {
            first_element_.push_back(core::count(weight_));
            weight_.resize(weight_.size() + core::at(elements(chain)), element_weight);
        }
        first_element_.push_back(core::count(weight_));
        weigh_terms(system);
        cut(layout, parameters.parts);
        own(layout);
        make_pieces(layout);
    }

    Index parts() const noexcept { return parts_; }
    /// Part of each vector.
    const std::vector<int>& owner() const noexcept { return owner_; }
    /// All pieces, part by part and along the chains, and where those of each part begin.
    const std::vector<Piece>& pieces() const noexcept { return pieces_; }
    const std::vector<Index>& first_piece() const noexcept { return first_piece_; }
    /// Vectors that each part owns, rising.
    const std::vector<std::vector<Index>>& owned() const noexcept { return owned_; }
    /// Elements of a chain that are of one part, one behind another.
    struct Run {
        int part;
        Index first_node, last_node;    ///< of the elements: neighbours share a node, unless the chain has no reach
        Index first_element, elements;  ///< within the chain
    };
    std::vector<Run> runs(const scene::DofLayout& layout, Index c) const {
        const scene::Chain& chain = layout.chains[core::at(c)];
        std::vector<Run> own;
        for (Index e = 0; e < elements(chain); ++e) {
            const int part = part_[core::at(first_element_[core::at(c)] + e)];
            const auto [first, last] = nodes_of(chain, e, e);
            if (own.empty() || own.back().part != part) own.push_back({part, first, last, e, 0});
            own.back().last_node = last, ++own.back().elements;
        }
        return own;
    }
    /// Work of each part, by weight of its elements.
    std::vector<Index> work() const {
        std::vector<Index> sum(core::at(parts_), 0);
        for (std::size_t e = 0; e < weight_.size(); ++e) sum[core::at(part_[e])] += weight_[e];
        return sum;
    }
    /// Elements of beams whose nodes have more than one owner.
    Index cut_elements(const scene::DofLayout& layout) const {
        Index sum = 0;
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const Index last = first_element_[core::at(c + 1)];
            for (Index e = first_element_[core::at(c)] + 1; e < last; ++e) sum += part_[core::at(e)] != part_[core::at(e - 1)];
        }
        return sum;
    }

    /// First part of each of `ranks` runs of parts, and their number: equal counts as nearly as may be.
    static Index first_part(Index parts, int ranks, int rank) noexcept { return parts * rank / ranks; }

private:
    // A contact costs each of its sides about a sixth of what an element costs.
    static constexpr Index element_weight = 6, side_weight = 1;

    static Index elements(const scene::Chain& chain) noexcept {
        return chain.reach == 0 ? chain.nodes : std::max<Index>(1, (chain.nodes - 1 + chain.reach - 1) / chain.reach);
    }
    static Index element_of(const scene::Chain& chain, Index node) noexcept {
        return std::min(node / std::max<Index>(chain.reach, 1), elements(chain) - 1);
    }
    /// First and last node of elements [first, last] of a chain.
    static std::pair<Index, Index> nodes_of(const scene::Chain& chain, Index first, Index last) noexcept {
        if (chain.reach == 0) return {std::max<Index>(first, 0), std::min(last, chain.nodes - 1)};
        return {std::max<Index>(first, 0) * chain.reach, std::min((last + 1) * chain.reach, chain.nodes - 1)};
    }

    template <class System>
    void weigh_terms(const System& system) {
        struct Weigh {
            const scene::DofLayout& layout;
            assembly::VectorPlaces places;
            const std::vector<Index>& first_element;
            std::vector<Index>& weight;
            void dense(const assembly::DenseTerm&) const noexcept {}
            void point(const assembly::PointTerm& term) {
                Index before = -1;
                for (const Index v : term.vectors) {  // the first vector of each chain tells the element
                    const Index c = places.chain(v);
                    if (c == before) continue;
                    before = c;
                    const scene::Chain& chain = layout.chains[core::at(c)];
                    weight[core::at(first_element[core::at(c)] + element_of(chain, places.number(v) / chain.vectors_per_node))] +=
                        side_weight;
                }
            }
        } weigh{system.layout(), assembly::VectorPlaces(system.layout()), first_element_, weight_};
        assembly::visit_couplings(system, weigh);
    }

    void cut(const scene::DofLayout& layout, Index parts) {
        std::vector<Vec3> middle;
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index e = 0; e < elements(chain); ++e) {
                const auto [first, last] = nodes_of(chain, e, e);
                middle.push_back(layout.value[core::at(chain.first_vector + (first + last) / 2 * chain.vectors_per_node)]);
            }
        }
        parts_ = std::clamp<Index>(core::count(middle), 1, parts);
        part_.assign(middle.size(), 0);
        std::vector<Index> members(middle.size());
        std::iota(members.begin(), members.end(), Index{0});
        bisect(middle, members.begin(), members.end(), 0, parts_);
    }
    using Members = std::vector<Index>::iterator;
    void bisect(const std::vector<Vec3>& middle, Members first, Members last, Index part, Index parts) {
        if (parts == 1) {
            for (auto it = first; it != last; ++it) part_[core::at(*it)] = static_cast<int>(part);
            return;
        }
        Vec3 mean = Vec3::Zero();
        for (auto it = first; it != last; ++it) mean += middle[core::at(*it)] / static_cast<double>(last - first);
        Mat3 spread = Mat3::Zero();
        Index whole = 0;
        for (auto it = first; it != last; ++it) {
            const Vec3 arm = middle[core::at(*it)] - mean;
            spread += arm * arm.transpose();
            whole += weight_[core::at(*it)];
        }
        Vec3 axis = core::SymmetricEigen<3>(spread).vectors().col(2);
        if (axis.dot(middle[core::at(*std::min_element(first, last))] - mean) < 0.0) axis = -axis;  // frames do not matter
        // Rounded: what ought to be level is told apart by number, and not by the last bit of a position.
        const double unit = 1e-9 * std::sqrt(spread.trace());
        std::vector<std::pair<double, Index>> order;
        for (auto it = first; it != last; ++it)
            order.emplace_back(unit > 0.0 ? std::round(axis.dot(middle[core::at(*it)] - mean) / unit) : 0.0, *it);
        std::sort(order.begin(), order.end());
        const Index half = parts / 2;
        Index sum = 0;
        auto split = first;
        for (std::size_t k = 0; k < order.size(); ++k) {
            *(first + static_cast<std::ptrdiff_t>(k)) = order[k].second;
            const Index own = weight_[core::at(order[k].second)];
            // Each side needs an element a part at least.
            const Index taken = static_cast<Index>(k);
            if (taken < half || (parts * (2 * sum + own) < 2 * half * whole && core::count(order) - taken > parts - half))
                ++split;
            sum += own;
        }
        bisect(middle, first, split, part, half);
        bisect(middle, split, last, part + half, parts - half);
    }

    void own(const scene::DofLayout& layout) {
        owner_.assign(core::at(layout.vectors()), static_cast<int>(parts_));
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (Index e = 0; e < elements(chain); ++e) {
                const auto [first, last] = nodes_of(chain, e, e);
                const int part = part_[core::at(first_element_[core::at(c)] + e)];
                for (Index k = first * chain.vectors_per_node; k < (last + 1) * chain.vectors_per_node; ++k) {
                    int& own = owner_[core::at(chain.first_vector + k)];
                    own = std::min(own, part);
                }
            }
        }
        owned_.assign(core::at(parts_), {});
        for (Index v = 0; v < layout.vectors(); ++v) owned_[core::at(owner_[core::at(v)])].push_back(v);
    }
    void make_pieces(const scene::DofLayout& layout) {
        for (Index c = 0; c < core::count(layout.chains); ++c) {
            const scene::Chain& chain = layout.chains[core::at(c)];
            for (const Run& run : runs(layout, c)) {
                const bool left = chain.reach > 0 && run.first_element > 0;
                const bool right = chain.reach > 0 && run.first_element + run.elements < elements(chain);
                const Index first = run.first_node + (left ? 1 : 0), nodes = run.last_node - (right ? 1 : 0) - first + 1;
                if (nodes > 0) pieces_.push_back({run.part, c, first, nodes});
            }
        }
        std::stable_sort(pieces_.begin(), pieces_.end(), [](const Piece& a, const Piece& b) { return a.part < b.part; });
        first_piece_.assign(core::at(parts_ + 1), 0);
        for (const Piece& piece : pieces_) ++first_piece_[core::at(piece.part + 1)];
        std::partial_sum(first_piece_.begin(), first_piece_.end(), first_piece_.begin());
    }

    Index parts_ = 0;
    std::vector<Index> first_element_, weight_;  // of each chain; of each element
    std::vector<int> part_, owner_;              // of each element; of each vector
    std::vector<Piece> pieces_;
    std::vector<Index> first_piece_;
    std::vector<std::vector<Index>> owned_;
};

}  // namespace fibrant::distributed

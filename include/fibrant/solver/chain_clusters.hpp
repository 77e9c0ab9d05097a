// SPDX-License-Identifier: MIT
#pragma once
/// @file Chains that move together, for coarse spaces: groups cut across their section, and neighbours without a group.

#include <fibrant/assembly/visited_system.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

namespace fibrant::solver {

/// Chains that run side by side.
struct ChainCluster {
    std::vector<Index> chains;   ///< rising
    std::vector<bool> reversed;  ///< of each: it runs against the first
};

namespace detail {

/// Middle and direction of a chain, from its positions.
struct ChainLine {
    Vec3 middle = Vec3::Zero();
    Vec3 direction = Vec3::Zero();  ///< unit from end to end; zero for a single node or a closed loop
};

/// Chord of a chain, by which chains are gathered into clusters.
inline ChainLine line_of(const scene::DofLayout& layout, Index c) {
    const scene::Chain& chain = layout.chains[core::at(c)];
    const auto position = [&](Index node) { return layout.value[core::at(chain.first_vector + node * chain.vectors_per_node)]; };
    const Vec3 chord = position(chain.nodes - 1) - position(0);
    const double length = chord.norm();
    return {position(chain.nodes / 2), length > 0.0 ? Vec3(chord / length) : Vec3(Vec3::Zero())};
}

/// Cuts [first, last) of `members` into parts of nearly equal number, each time across the longer side of the section.
template <class Emit>
void bisect(const std::vector<ChainLine>& lines, const Vec3& direction, std::vector<Index>::iterator first,
            std::vector<Index>::iterator last, Index parts, const Emit& emit) {
    if (parts <= 1) return emit(first, last);
    const auto across = [&](Index c) {
        const Vec3& middle = lines[core::at(c)].middle;
        return Vec3(middle - direction * direction.dot(middle));
    };
    Vec3 mean = Vec3::Zero();
    for (auto it = first; it != last; ++it) mean += across(*it) / static_cast<double>(last - first);
    Mat3 spread = Mat3::Zero();
    for (auto it = first; it != last; ++it) {
        const Vec3 arm = across(*it) - mean;
        spread += arm * arm.transpose();
    }
    const core::SymmetricEigen<3> eigen(spread);
    Vec3 axis = eigen.vectors().col(2);
    if (axis.dot(across(*std::min_element(first, last)) - mean) < 0.0) axis = -axis;  // so that frames do not matter
    const Index half = parts / 2;
    const auto middle = first + (last - first) * half / parts;
    // Rounded, so that sites that ought to be level are told apart by number and not by the last bit of a position.
    const double unit = 1e-9 * std::sqrt(spread.trace());
    const auto place = [&](Index c) { return unit > 0.0 ? std::round(axis.dot(across(c) - mean) / unit) : 0.0; };
    std::sort(first, last,
              [&](Index a, Index b) { return std::pair<double, Index>(place(a), a) < std::pair<double, Index>(place(b), b); });
    bisect(lines, direction, first, middle, half, emit);
    bisect(lines, direction, middle, last, parts - half, emit);
}

/// Representative of each set of a union-find, the least member.
inline Index representative(std::vector<Index>& parent, Index c) {
    while (parent[core::at(c)] != c) c = parent[core::at(c)] = parent[core::at(parent[core::at(c)])];
    return c;
}

/// Joins chains without a group that touch along at least a quarter of their nodes: neighbours, not chains that cross.
template <assembly::VisitedSystem System>
std::vector<Index> join_neighbours(const System& system) {
    const scene::DofLayout& layout = system.layout();
    struct Pairs {
        const scene::DofLayout& layout;
        assembly::VectorPlaces places;
        std::vector<std::pair<Index, Index>> list;
        void add(std::span<const Index> vectors) {
            const Index c = places.chain(vectors.front());
            if (layout.chains[core::at(c)].group >= 0) return;
            for (const Index v : vectors) {
                const Index d = places.chain(v);
                if (d == c || layout.chains[core::at(d)].group >= 0) continue;
                list.emplace_back(std::min(c, d), std::max(c, d));
                break;
            }
        }
        void point(const assembly::PointTerm& term) { add(term.vectors); }
        void dense(const assembly::DenseTerm& term) { add(term.vectors); }
    } pairs{layout, assembly::VectorPlaces(layout), {}};
    assembly::visit_couplings(system, pairs);
    std::sort(pairs.list.begin(), pairs.list.end());
    std::vector<Index> parent(layout.chains.size());
    std::iota(parent.begin(), parent.end(), Index{0});
    for (auto first = pairs.list.begin(); first != pairs.list.end();) {
        const auto last = std::upper_bound(first, pairs.list.end(), *first);
        const Index nodes = std::max(layout.chains[core::at(first->first)].nodes, layout.chains[core::at(first->second)].nodes);
        if (nodes > 1 && 4 * (last - first) >= nodes) {
            const Index a = representative(parent, first->first), b = representative(parent, first->second);
            parent[core::at(std::max(a, b))] = std::min(a, b);
        }
        first = last;
    }
    return parent;
}

}  // namespace detail

/// Clusters of about `size` chains, each chain in one.
///
/// The chains of a group, or without a group those connected through neighbours, are cut across their section in the
/// middle of their length. Chains that are not within 45 degrees of the first of their set form sets of their own; a
/// single node is a cluster of its own.
template <assembly::VisitedSystem System>
std::vector<ChainCluster> cluster_chains(const System& system, Index size) {
    const scene::DofLayout& layout = system.layout();
    const Index n = core::count(layout.chains);
    std::vector<Index> parent = detail::join_neighbours(system);
    std::vector<std::pair<Index, Index>> key;  // of a chain: its group, or after all groups its set; and itself
    Index groups = 0;
    for (const scene::Chain& chain : layout.chains) groups = std::max(groups, chain.group + 1);
    std::vector<detail::ChainLine> lines;
    for (Index c = 0; c < n; ++c) {
        const Index group = layout.chains[core::at(c)].group;
        key.emplace_back(group >= 0 ? group : groups + detail::representative(parent, c), c);
        lines.push_back(detail::line_of(layout, c));
    }
    std::sort(key.begin(), key.end());

    std::vector<ChainCluster> clusters;
    const auto emit = [&](auto first, auto last) {
        ChainCluster cluster{{first, last}, {}};
        std::sort(cluster.chains.begin(), cluster.chains.end());
        const Vec3 direction = lines[core::at(cluster.chains.front())].direction;
        for (const Index c : cluster.chains) cluster.reversed.push_back(direction.dot(lines[core::at(c)].direction) < 0.0);
        clusters.push_back(std::move(cluster));
    };
    for (std::size_t first = 0; first < key.size();) {
        std::size_t last = first;
        std::vector<Index> rest;
        for (; last < key.size() && key[last].first == key[first].first; ++last) {
            std::vector<Index> one{key[last].second};
            if (lines[core::at(one.front())].direction.isZero()) {
                emit(one.begin(), one.end());
            } else {
                rest.push_back(one.front());
            }
        }
        first = last;
        while (!rest.empty()) {
            const Vec3 direction = lines[core::at(rest.front())].direction;
            const auto beside = std::stable_partition(rest.begin(), rest.end(), [&](Index c) {
                return c == rest.front() || std::abs(direction.dot(lines[core::at(c)].direction)) > 0.7;
            });
            const Index parts = std::max<Index>(1, ((beside - rest.begin()) + size / 2) / size);
            detail::bisect(lines, direction, rest.begin(), beside, parts, emit);
            rest.erase(rest.begin(), beside);
        }
    }
    return clusters;
}

}  // namespace fibrant::solver

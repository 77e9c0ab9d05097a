// SPDX-License-Identifier: MIT
#pragma once
/// @file What is told of a settled textile's yarns: how far they moved, where they touch each other, and with what forces.

#include <fibrant/compositions/textile/assemble.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Two yarns that touch, first < second.
struct YarnPair {
    Index first = -1, second = -1;
    /// Of the fibres of the first one, where a fibre of the second one is near; or, if that is more, the other way round
    /// [length].
    double length = 0.0;
    Index contacts = 0;                               ///< contact elements that press
    double normal_force = 0.0, friction_force = 0.0;  ///< sums of their sizes [force]
};

/// Contacts of yarns with each other.
struct YarnContacts {
    std::vector<double> length;   ///< of each yarn: of its fibres, where a fibre of any other yarn is near [length]
    std::vector<YarnPair> pairs;  ///< in order
};

/// How far a fibre is from where it was [length].
struct Moves {
    double mean = 0.0, root_mean_square = 0.0, greatest = 0.0;
    /// @param distances  at places along it
    static Moves of(const std::vector<double>& distances) {
        Moves moves;
        const double share = 1.0 / static_cast<double>(std::max<std::size_t>(distances.size(), 1));
        for (const double distance : distances) {
            moves.mean += share * distance, moves.root_mean_square += share * distance * distance;
            moves.greatest = std::max(moves.greatest, distance);
        }
        moves.root_mean_square = std::sqrt(moves.root_mean_square);
        return moves;
    }
};

namespace detail {
/// Distance of a point from a piece of a curve between two nodes, from a first guess.
inline double distance_to(const observe::NodalCurve& curve, std::size_t piece, const Vec3& point) {
    const double low = static_cast<double>(piece), high = low + 1.0 - 1e-12;  // a node belongs to the element that follows
    const Vec3 chord = curve.nodes()[piece + 1] - curve.nodes()[piece];
    double t = low + std::clamp((point - curve.nodes()[piece]).dot(chord) / chord.squaredNorm(), 0.0, 1.0 - 1e-12);
    constexpr int steps = 3;  // of Newton's method; a piece bends little
    for (int k = 0; k < steps; ++k) {
        const Vec3 apart = curve.position(t) - point, slope = curve.tangent(t);
        const double second = slope.squaredNorm() + std::max(0.0, apart.dot(curve.second(t)));
        t = std::clamp(t - apart.dot(slope) / second, low, high);
    }
    return (curve.position(t) - point).norm();
}
}  // namespace detail

/// Moves of each fibre's nodes between two states.
inline std::vector<Moves> moves_between(const observe::Snapshot& from, const observe::Snapshot& to) {
    std::vector<Moves> all;
    for (std::size_t f = 0; f < from.fibres.size(); ++f) {
        std::vector<double> distances;
        for (std::size_t k = 0; k < from.fibres[f].position.size(); ++k)
            distances.push_back((to.fibres[f].position[k] - from.fibres[f].position[k]).norm());
        all.push_back(Moves::of(distances));
    }
    return all;
}

/// Distances of points that a file has from the fibre that was made of them. Time points times nodes of a fibre.
inline Moves moves_from(const std::vector<Vec3>& points, const observe::FibreSnapshot& fibre) {
    const observe::NodalCurve curve(fibre);
    std::vector<double> distances;
    for (const Vec3& point : points) {
        double least = std::numeric_limits<double>::infinity();
        for (std::size_t piece = 0; piece + 1 < fibre.position.size(); ++piece) {
            const Vec3 middle = 0.5 * (fibre.position[piece] + fibre.position[piece + 1]);
            const double size = (fibre.position[piece + 1] - fibre.position[piece]).norm();
            if ((middle - point).norm() - size < least) least = std::min(least, detail::distance_to(curve, piece, point));
        }
        distances.push_back(least);
    }
    return Moves::of(distances);
}

/// Lengths along which fibres of different yarns are nearer to each other than a gap, whatever contact says, and what contacts
/// say of forces. Two straight fibres of radius r at a right angle are so over 2 sqrt((2 r + g)^2 - 4 r^2) of each.
/// @param near_over_radius  gap of surfaces over the radius of the thinner fibre [1], > 0
/// Time linear in pieces that are near.
inline YarnContacts yarn_contacts(const Textile& textile, const Assembled& assembled, const observe::Snapshot& snapshot,
                                  double near_over_radius = 0.05) {
    core::require_positive("yarn_contacts.near_over_radius", near_over_radius);
    constexpr Index samples = 8;  // of a piece between two nodes
    std::vector<proximity::Centreline> lines;
    std::vector<std::vector<double>> inflation(snapshot.fibres.size());
    std::vector<Index> owner, first{0};
    double thickest = 0.0;
    for (std::size_t f = 0; f < snapshot.fibres.size(); ++f) {
        const observe::FibreSnapshot& fibre = snapshot.fibres[f];
        const observe::NodalCurve curve(fibre);
        for (std::size_t piece = 0; piece + 1 < fibre.position.size(); ++piece) {
            inflation[f].push_back(curve.second(static_cast<double>(piece)).norm() / 8.0);  // of half an element from its chord
            owner.push_back(static_cast<Index>(f));
        }
        first.push_back(core::count(owner));
        thickest = std::max(thickest, fibre.section.radius());
        lines.push_back({fibre.position, fibre.section.radius(), inflation[f], -1});
        lines.back().closed = fibre.closed;
    }
    // A sample of a fibre, and the yarn that is near there.
    std::vector<std::tuple<Index, Index, Index>> near;
    proximity::GridSearch search;
    for (const proximity::SegmentPair& pair : search.pairs(lines, 2.0 * near_over_radius * thickest))
        for (const bool turned : {false, true}) {
            const Index i = turned ? pair.j : pair.i, j = turned ? pair.i : pair.j;
            const Index a = owner[core::at(i)], b = owner[core::at(j)];
            const Index p = assembled.path_of[core::at(a)], q = assembled.path_of[core::at(b)];
            if (p == q) continue;
            const observe::FibreSnapshot &one = snapshot.fibres[core::at(a)], &two = snapshot.fibres[core::at(b)];
            const observe::NodalCurve curve(one), other(two);
            const double least = std::min(one.section.radius(), two.section.radius());
            const double reach = one.section.radius() + two.section.radius() + near_over_radius * least;
            for (Index k = 0; k < samples; ++k) {
                const double t =
                    static_cast<double>(i - first[core::at(a)]) + (static_cast<double>(k) + 0.5) / static_cast<double>(samples);
                if (detail::distance_to(other, core::at(j - first[core::at(b)]), curve.position(t)) <= reach)
                    near.emplace_back(p, samples * i + k, q);
            }
        }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    YarnContacts answer;
    answer.length.assign(textile.paths.size(), 0.0);
    std::vector<std::tuple<Index, Index, double>> lengths;  // of a yarn near another
    for (std::size_t n = 0; n < near.size(); ++n) {
        const auto& [p, sample, q] = near[n];
        const Index piece = sample / samples, f = owner[core::at(piece)];
        const observe::NodalCurve curve(snapshot.fibres[core::at(f)]);
        const double t = static_cast<double>(piece - first[core::at(f)]) +
                         (static_cast<double>(sample % samples) + 0.5) / static_cast<double>(samples);
        const double size = curve.tangent(t).norm() / static_cast<double>(samples);
        if (n == 0 || std::get<0>(near[n - 1]) != p || std::get<1>(near[n - 1]) != sample) answer.length[core::at(p)] += size;
        lengths.emplace_back(p, q, size);
    }
    const auto pair_of = [](const auto& x) { return std::minmax(std::get<0>(x), std::get<1>(x)); };
    std::stable_sort(lengths.begin(), lengths.end(), [&](const auto& a, const auto& b) {
        return std::pair<Index, Index>(pair_of(a)) < std::pair<Index, Index>(pair_of(b));
    });
    std::vector<YarnPair> pairs;
    double forth = 0.0, back = 0.0;
    for (std::size_t n = 0; n < lengths.size(); ++n) {
        const auto& [p, q, size] = lengths[n];
        const std::pair<Index, Index> pair = std::minmax(p, q);
        (p < q ? forth : back) += size;
        if (n + 1 < lengths.size() && pair == std::pair<Index, Index>(pair_of(lengths[n + 1]))) continue;
        pairs.push_back({pair.first, pair.second, std::max(forth, back)});
        forth = back = 0.0;
    }
    for (const observe::ContactSnapshot& contact : snapshot.contacts) {
        const Index p = assembled.path_of[core::at(contact.fibre_i)], q = assembled.path_of[core::at(contact.fibre_j)];
        if (p != q && contact.reaction > 0.0)
            pairs.push_back({std::min(p, q), std::max(p, q), 0.0, 1, contact.reaction, contact.friction.norm()});
    }
    std::stable_sort(pairs.begin(), pairs.end(), [](const YarnPair& a, const YarnPair& b) {
        return std::pair(a.first, a.second) < std::pair(b.first, b.second);
    });
    for (const YarnPair& pair : pairs) {
        if (answer.pairs.empty() || answer.pairs.back().first != pair.first || answer.pairs.back().second != pair.second) {
            answer.pairs.push_back(pair);
            continue;
        }
        YarnPair& sum = answer.pairs.back();
        sum.length += pair.length, sum.contacts += pair.contacts;
        sum.normal_force += pair.normal_force, sum.friction_force += pair.friction_force;
    }
    return answer;
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file How many contacts there are, how deep and how strong, and which way they face.

#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/observer.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// Counts in equal bins of [0, high]; the last bin includes its upper end.
struct Histogram {
    double high = 0;
    std::vector<Index> counts;

    void add(double value) noexcept {
        const auto bins = static_cast<double>(counts.size());
        const double bin = high > 0.0 ? std::clamp(std::floor(value / high * bins), 0.0, bins - 1.0) : 0.0;
        ++counts[core::at(static_cast<Index>(bin))];
    }
};

/// Figures of the contact elements of a snapshot; active ones have a reaction.
struct ContactStatistics {
    Index elements = 0, active = 0;
    Index crossings = 0;                                         ///< active elements that stand for a whole zone
    Index fibre_pairs = 0;                                       ///< with an active element
    double least_gap = std::numeric_limits<double>::infinity();  ///< of all elements [length]
    double greatest_penetration = 0;                             ///< [length], >= 0
    double greatest_penetration_over_radius = 0;                 ///< over the smaller circumscribed radius of the pair [1]
    double sum_of_reactions = 0;                                 ///< [force]
    double sum_of_friction = 0;                                  ///< of the lengths of R_T [force]
    Histogram reaction;                                          ///< of active elements [force]
    Histogram penetration;                                       ///< of active elements [length]
    Mat3 orientation = Mat3::Zero();  ///< mean of N N^T over active elements, trace 1; zero if there are none
};

/// Number, forces, depths and directions of the contacts of a snapshot.
/// @param bins  of each histogram, >= 1
inline ContactStatistics contact_statistics(const Snapshot& snapshot, Index bins = 20) {
    core::require_at_least("contact_statistics.bins", bins, 1);
    ContactStatistics answer;
    std::vector<std::pair<Index, Index>> pairs;
    for (const ContactSnapshot& contact : snapshot.contacts) {
        ++answer.elements;
        answer.least_gap = std::min(answer.least_gap, contact.gap);
        const double penetration = std::max(0.0, -contact.gap);
        const double radius = std::min(snapshot.fibres[core::at(contact.fibre_i)].section.radius(),
                                       snapshot.fibres[core::at(contact.fibre_j)].section.radius());
        answer.greatest_penetration = std::max(answer.greatest_penetration, penetration);
        answer.greatest_penetration_over_radius = std::max(answer.greatest_penetration_over_radius, penetration / radius);
        if (!(contact.reaction > 0.0)) continue;
        ++answer.active;
        if (contact.crossing) ++answer.crossings;
        pairs.emplace_back(contact.fibre_i, contact.fibre_j);
        answer.sum_of_reactions += contact.reaction;
        answer.sum_of_friction += contact.friction.norm();
        answer.orientation += contact.normal * contact.normal.transpose();
        answer.reaction.high = std::max(answer.reaction.high, contact.reaction);
        answer.penetration.high = std::max(answer.penetration.high, penetration);
    }
    std::sort(pairs.begin(), pairs.end());
    answer.fibre_pairs = static_cast<Index>(std::unique(pairs.begin(), pairs.end()) - pairs.begin());
    if (answer.active > 0) answer.orientation /= static_cast<double>(answer.active);
    answer.reaction.counts.assign(core::at(bins), 0);
    answer.penetration.counts.assign(core::at(bins), 0);
    for (const ContactSnapshot& contact : snapshot.contacts) {
        if (!(contact.reaction > 0.0)) continue;
        answer.reaction.add(contact.reaction);
        answer.penetration.add(std::max(0.0, -contact.gap));
    }
    return answer;
}

}  // namespace fibrant::observe

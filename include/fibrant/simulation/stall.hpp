// SPDX-License-Identifier: MIT
#pragma once
/// @file Whether fibres that are parted still get out of each other.

#include <fibrant/simulation/report.hpp>

#include <algorithm>
#include <limits>
#include <vector>

namespace fibrant::simulation {

/// Whether the last increments of a stage have brought nothing: as many gaps are limited as before, and what is deepest is as
/// deep, but for a twentieth. What goes to and fro between two states is no nearer to its end after a hundred increments.
/// @param in_stage  increments of the stage, the last ones of all
/// @param window    that count as the last ones, >= 1
inline bool stalled(const std::vector<IncrementReport>& increments, Index in_stage, Index window) {
    constexpr double better = 0.95;  // of what was deepest
    const Index all = core::count(increments), first = all - std::min(all, in_stage);
    if (all - first <= window) return false;
    struct Least {
        Index limited = std::numeric_limits<Index>::max();
        double deepest = std::numeric_limits<double>::infinity();
    };
    const auto least = [&](Index from, Index to) {
        Least found;
        for (Index k = from; k < to; ++k) {
            const contact::ContactFigures& contact = increments[core::at(k)].contact;
            found.limited = std::min<Index>(found.limited, contact.shifted);
            found.deepest = std::min(found.deepest, contact.greatest_penetration);
        }
        return found;
    };
    const Least before = least(first, all - window), lately = least(all - window, all);
    return lately.limited >= before.limited && lately.deepest > better * before.deepest;
}

}  // namespace fibrant::simulation

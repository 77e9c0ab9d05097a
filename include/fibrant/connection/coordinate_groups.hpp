// SPDX-License-Identifier: MIT
#pragma once
/// @file Which free coordinates of bodies share conditions: each group is fitted to its tied vectors for itself.

#include <fibrant/core/types.hpp>

#include <algorithm>
#include <numeric>
#include <vector>

namespace fibrant::connection {

/// Free coordinates that share conditions, and these.
struct CoordinateGroup {
    std::vector<Index> coordinates, conditions, scalars;
    Matrix modes, pull;  ///< change of coordinates = pull modes^T change of scalars
};

/// Groups in the order of their first conditions; a condition on which no coordinate has a part is in none.
/// @param depends  (condition, coordinate) -> whether the condition changes with the coordinate
template <class Depends>
std::vector<CoordinateGroup> coordinate_groups(Index coordinates, Index conditions, const Depends& depends) {
    std::vector<Index> root(core::at(coordinates));
    std::iota(root.begin(), root.end(), Index{0});
    const auto find = [&](Index k) {
        while (root[core::at(k)] != k) k = root[core::at(k)];
        return k;
    };
    const auto first_of = [&](Index condition) {  // and all of a condition have one root from then on
        Index first = -1;
        for (Index k = 0; k < coordinates; ++k) {
            if (!depends(condition, k)) continue;
            const Index other = find(k);
            if (first >= 0) root[core::at(std::max(first, other))] = std::min(first, other);
            first = first < 0 ? other : std::min(first, other);
        }
        return first;
    };
    for (Index c = 0; c < conditions; ++c) first_of(c);
    std::vector<CoordinateGroup> groups;
    std::vector<Index> number(root.size(), -1);
    for (Index c = 0; c < conditions; ++c) {
        const Index first = first_of(c);
        if (first < 0) continue;
        Index& group = number[core::at(first)];
        if (group < 0) {
            group = core::count(groups);
            groups.emplace_back();
            for (Index k = 0; k < coordinates; ++k)
                if (find(k) == first) groups.back().coordinates.push_back(k);
        }
        groups[core::at(group)].conditions.push_back(c);
    }
    return groups;
}

}  // namespace fibrant::connection

// SPDX-License-Identifier: MIT
#pragma once
/// @file Compact packing of the fibres of a flat tow.

#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fibrant::compositions::weave {

/// Centres of the fibres in a tow's cross-section: across the tow, and along its thickness.
struct Packing {
    std::vector<Eigen::Vector2d> centres;  ///< [length], sum zero, by rows from below, each from left to right
    double width = 0;                      ///< between outer surfaces [length]
    double thickness = 0;                  ///< between outer surfaces [length]
};

/// Hexagonal lattice of pitch 2 r (1 + gap), rows along the width: the sites nearest to the centre in the metric
/// (x / aspect)^2 + y^2.
///
/// The centre is a site for an odd count and the middle of two neighbours for an even one, and sites are taken in
/// opposite pairs, so the section is symmetric about its centre however ties fall: 7, 19, 37 and 61 fibres at aspect 1
/// are full hexagons.
///
/// @param fibres  >= 1
/// @param radius  of a fibre [length], > 0
/// @param aspect  width over thickness of the outline [1], >= 1
/// @param gap     free distance between neighbours over their diameter [1], >= 0
inline Packing compact_packing(Index fibres, double radius, double aspect, double gap) {
    core::require_at_least("compact_packing.fibres", fibres, 1);
    core::require_positive("compact_packing.radius", radius);
    core::require(std::isfinite(aspect) && aspect >= 1.0, "compact_packing.aspect", aspect, "finite and >= 1");
    core::require_not_negative("compact_packing.gap", gap);

    struct Site {
        long long key;  ///< metric on a fine grid, so that equal distances compare equal whatever the rounding
        Index across, row;
    };
    // Half the plane, each site standing for itself and its opposite. x = across * pitch / 2, y = row * sqrt(3) pitch /
    // 2; across and row have equal parity about a site, opposite parity about the middle of two neighbours in a row.
    const Index odd = fibres % 2;
    const double pairs = 0.5 * static_cast<double>(fibres);
    const auto rows = static_cast<Index>(std::ceil(std::sqrt(pairs / aspect))) + 2;
    const double reach = 2.0 * std::sqrt(pairs * aspect) + 4.0 * aspect + 4.0;
    const auto columns = static_cast<Index>(std::min(reach, static_cast<double>(fibres) + 1.0));  // one row is enough
    std::vector<Site> sites;
    for (Index row = 0; row <= rows; ++row) {
        for (Index across = -columns; across <= columns; ++across) {
            if ((across + row + odd) % 2 == 0 || (row == 0 && across <= 0)) continue;
            const double x = static_cast<double>(across) / aspect, y = static_cast<double>(row);
            sites.push_back({std::llround((x * x + 3.0 * y * y) * 1e9), across, row});
        }
    }
    std::sort(sites.begin(), sites.end(), [](const Site& a, const Site& b) {
        if (a.key != b.key) return a.key < b.key;
        if (a.row != b.row) return a.row < b.row;
        return a.across > b.across;
    });
    sites.resize(core::at(fibres / 2));

    std::vector<Site> chosen;
    if (odd == 1) chosen.push_back({0, 0, 0});
    for (const Site& site : sites) {
        chosen.push_back(site);
        chosen.push_back({site.key, -site.across, -site.row});
    }
    std::sort(chosen.begin(), chosen.end(),
              [](const Site& a, const Site& b) { return a.row != b.row ? a.row < b.row : a.across < b.across; });
    const double half_pitch = radius * (1.0 + gap);
    Packing packing;
    double half_width = 0.0, half_thickness = 0.0;
    for (const Site& site : chosen) {
        const Eigen::Vector2d centre{static_cast<double>(site.across) * half_pitch,
                                     static_cast<double>(site.row) * half_pitch * std::sqrt(3.0)};
        packing.centres.push_back(centre);
        half_width = std::max(half_width, centre.x());
        half_thickness = std::max(half_thickness, centre.y());
    }
    packing.width = 2.0 * (half_width + radius);
    packing.thickness = 2.0 * (half_thickness + radius);
    return packing;
}

}  // namespace fibrant::compositions::weave

// SPDX-License-Identifier: MIT
#pragma once
/// @file Sections that swell at one node and shrink at the next: what elements that are too long make of fibres that are pressed.

#include <fibrant/core/parallel.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::observe {

/// Where sections swell and shrink in turn by most.
struct Swelling {
    double strain = 0.0;  ///< at the ends of the element, in the direction in which it is most against that across; half of it in
                          ///< the middle, the other way [1]
    Index fibre = -1, element = -1;
    double radius = 0.0;  ///< of that fibre [length]

    /// By how much nearer two such fibres lie on average, with no force: sections of strains e and -e are higher by sqrt(1 + 2 e)
    /// and lower by sqrt(1 - 2 e), and their mean is 1 - e^2 / 2 [length].
    double approach() const noexcept { return strain * strain * radius; }
    /// That is more than fibres may be deep in each other [length]: they bear less than they should.
    bool exceeds(double allowed) const noexcept { return approach() > allowed; }
};

/// What is said of it.
inline std::string text(const Swelling& found) {
    return "sections of fibre " + std::to_string(found.fibre) + " swell and shrink in turn from node to node, by " +
           core::text(found.strain) + " of their width at element " + std::to_string(found.element) +
           ": elements are too long for what presses them, take twice as many, or less tension and pressure";
}

/// Greatest swelling in turn of a state.
///
/// Section strains at the three nodes of a director beam's element are taken at two Gauss points, which do not see (2, -1, 2)
/// times any strain: only shear along the fibre resists, less the longer an element is. Of the strains of a state this is the
/// part of that kind, by the difference of its principal values: fibres that are twisted narrow all round instead.
/// Fibres without sections that stretch, and those of two nodes an element, have none.
inline Swelling greatest_swelling(const Snapshot& shot) {
    std::vector<Swelling> most(shot.fibres.size());
    core::parallel_for(
        core::count(shot.fibres),
        [&](Index f) {
            const FibreSnapshot& fibre = shot.fibres[core::at(f)];
            if (fibre.interpolation != Interpolation::quadratic || fibre.director_1.size() != fibre.position.size()) return;
            for (std::size_t a = 0; a + 2 < fibre.position.size(); a += 2) {
                // Second differences over the element of g_1.g_1 - g_2.g_2 and 2 g_1.g_2, whose strains are half of them.
                double even = 0.0, odd = 0.0;
                for (const auto& [node, weight] : {std::pair{a, 1.0}, {a + 1, -2.0}, {a + 2, 1.0}}) {
                    const Vec3 &one = fibre.director_1[node], &two = fibre.director_2[node];
                    even += weight * (one.squaredNorm() - two.squaredNorm()), odd += weight * 2.0 * one.dot(two);
                }
                constexpr double of_second_difference = 1.0 / 3.0;  // (2, -1, 2) has one of 6 and stands for 2
                const double strain = of_second_difference * 0.5 * std::hypot(even, odd);
                if (strain > most[core::at(f)].strain)
                    most[core::at(f)] = {strain, f, static_cast<Index>(a / 2), fibre.section.radius()};
            }
        },
        1);
    Swelling all;
    for (const Swelling& one : most)
        if (one.strain > all.strain) all = one;
    return all;
}

}  // namespace fibrant::observe

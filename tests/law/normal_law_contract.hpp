// SPDX-License-Identifier: MIT
#pragma once
/// @file What every normal law owes, as one function.

#include <fibrant/law/normal_law.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace fibrant::test {

/// Gaps from open to deep, with both sides of first touch and of the threshold at `depth`.
inline std::vector<double> gaps_around(double depth) {
    std::vector<double> gaps{0.0, -depth};
    for (const double fraction : {-20.0, -5.0, -2.0, -1.5, -0.99, -0.5, -0.1, -1e-3, 1e-3, 0.1, 1.0, 20.0})
        gaps.push_back(fraction * depth);
    for (const double threshold : {0.0, -depth})
        for (const double aside : {-1e-9, 1e-9}) gaps.push_back(threshold + aside * depth);
    std::ranges::sort(gaps, std::greater<>{});
    return gaps;
}

/// Checks what a normal law owes beyond its syntax.
///
/// @param depth        at which the law changes branch, or any depth of interest [length], > 0
/// @param slope_jumps  whether the slope may jump at first touch
template <law::NormalLaw Law>
void check_normal_law(const Law& law, double stiffness, double depth, bool slope_jumps = false) {
    const double force = stiffness * depth;  // scale of the reactions
    double previous = 0.0;
    for (const double gap : gaps_around(depth)) {  // from open to deep
        CAPTURE(gap);
        const law::NormalResponse here = law.response(gap, stiffness);
        CHECK(here.reaction >= 0.0);
        CHECK(here.slope <= 0.0);
        CHECK(here.reaction >= previous);
        CHECK(law.energy(gap, stiffness) >= 0.0);
        if (gap >= 0.0) {
            CHECK(here.reaction == 0.0);
            CHECK(here.slope == 0.0);
            CHECK(law.energy(gap, stiffness) == 0.0);
        } else {
            CHECK(here.reaction > 0.0);
        }
        // The stiffness is a factor of everything, exactly for a power of two.
        CHECK(law.response(gap, 2.0 * stiffness).reaction == 2.0 * here.reaction);
        CHECK(law.energy(gap, 2.0 * stiffness) == 2.0 * law.energy(gap, stiffness));
        previous = here.reaction;

        // Central differences; the reaction is piecewise quadratic, so they are exact inside a branch and err by at
        // most step * jump of the second derivative / 4 (here stiffness / depth) across a threshold. The energy is one
        // order smoother. Round-off is 1e-16 * 20 forces / step.
        const double step = 1e-6 * depth;
        if (slope_jumps && std::abs(gap) <= step) continue;
        const double reaction_rate =
            (law.response(gap + step, stiffness).reaction - law.response(gap - step, stiffness).reaction) / (2.0 * step);
        CHECK(std::abs(reaction_rate - here.slope) <= 1e-6 * stiffness);
        const double energy_rate = (law.energy(gap + step, stiffness) - law.energy(gap - step, stiffness)) / (2.0 * step);
        CHECK(std::abs(energy_rate + here.reaction) <= 1e-6 * force);
    }

    // The energy is the work of the reaction from first touch: Simpson's rule, exact on each branch (cubic or lower).
    double work = 0.0;
    const int slices = 64;  // a multiple of 4, so that the threshold at `depth` falls between two of them
    const double width = 4.0 * depth / slices;
    for (int k = 0; k < slices; ++k) {
        const double shallow = -width * k, deep = -width * (k + 1);
        work += width / 6.0 *
                (law.response(shallow, stiffness).reaction + 4.0 * law.response(0.5 * (shallow + deep), stiffness).reaction +
                 law.response(deep, stiffness).reaction);
    }
    CHECK(std::abs(law.energy(-4.0 * depth, stiffness) - work) <= 1e-12 * force * depth);
}

}  // namespace fibrant::test

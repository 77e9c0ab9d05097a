// SPDX-License-Identifier: MIT
#pragma once
/// @file What every law of a section owes, as one function.

#include <fibrant/beam/element_memory.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace fibrant::test {

/// Tangent against differences of the stress, stress against those of stored + dissipated where the law has no rate, on a random
/// path of accepted increments; nothing negative is dissipated.
/// @param size      of the strains [1], those of a gradient over `radius` [length]
/// @param duration  of an increment
template <beam::SectionMaterial M>
void check_section_material(const M& law, const typename M::Section& section, double size, double radius, double duration = 0.0,
                            double amplitude = 0.0) {
    using beam::SectionStrains;
    std::mt19937_64 generator(7);
    std::normal_distribution<double> normal;
    const auto random = [&] {
        SectionStrains e;
        for (std::size_t c = 0; c < e.size(); ++c) e[c] = size * normal(generator) / (c < 6 ? 1.0 : radius);
        return e;
    };
    typename M::History memory = law.fresh(section, {0, 0, 1.0});
    const auto rest = law.response(section, {}, memory, {});
    CHECK(rest.stored == 0.0);
    CHECK(rest.dissipated == 0.0);
    for (const double s : rest.stress) CHECK(s == 0.0);
    double worst_tangent = 0.0, worst_stress = 0.0;
    for (int increment = 0; increment < 30; ++increment) {
        const beam::Drive drive{duration, amplitude * increment / 30.0};
        const SectionStrains e = random();
        const auto now = law.response(section, e, memory, drive);
        CHECK(now.dissipated >= 0.0);
        const Eigen::Matrix<double, 12, 12> C = beam::full_tangent<M>(now.tangent);
        // Strains and stresses over those of the surface, so that all entries are compared with one another.
        const auto scale = [&](std::size_t c) { return c < 6 ? 1.0 : 1.0 / radius; };
        double largest = 0.0, force = 0.0;
        for (std::size_t c = 0; c < 12; ++c) {
            largest = std::max(largest, scale(c) * scale(c) * std::abs(C(static_cast<Index>(c), static_cast<Index>(c))));
            force = std::max(force, scale(c) * std::abs(now.stress[c]));
        }
        for (std::size_t c = 0; c < 12; ++c) {
            const double h = 1e-6 * size * scale(c);
            SectionStrains ahead = e, behind = e;
            ahead[c] += h, behind[c] -= h;
            const auto a = law.response(section, ahead, memory, drive), b = law.response(section, behind, memory, drive);
            for (std::size_t r = 0; r < 12; ++r) {
                const double slope = (a.stress[r] - b.stress[r]) / (2.0 * h);
                worst_tangent =
                    std::max(worst_tangent,
                             scale(r) * scale(c) * std::abs(slope - C(static_cast<Index>(r), static_cast<Index>(c))) / largest);
            }
            if constexpr (!M::has_rate)
                worst_stress = std::max(
                    worst_stress,
                    scale(c) * std::abs((a.stored + a.dissipated - b.stored - b.dissipated) / (2.0 * h) - now.stress[c]) / force);
        }
        memory = now.history;
    }
    // Central differences at 1e-6 of the strains: their square, and rounding 1e-16/1e-6; a point of many that begins to yield
    // within the step is a kink, of the order of the step.
    CHECK(worst_tangent < 1e-6);
    CHECK(worst_stress < 1e-6);
}

}  // namespace fibrant::test

// SPDX-License-Identifier: MIT
#pragma once
/// @file Gap of two ellipses in a plane, searched over the directions of the plane.

#include <fibrant/core/small_matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace fibrant::observe {

/// An ellipse by two half axes that need not be square to each other: p cos(a) + q sin(a), about its centre [length].
struct FlatSection {
    core::Two p, q;

    /// Half extent along a unit direction [length].
    double extent(const core::Two& n) const noexcept { return std::hypot(core::dot(p, n), core::dot(q, n)); }
};

/// The greatest over directions n of apart.n less the half extents of both: < 0 in penetration [length].
struct FlatGap {
    double gap = -std::numeric_limits<double>::infinity();
    core::Two normal{};  ///< unit, from the first to the second
};

namespace detail {

/// Of sections that are nearly round for how far they are apart: no direction is as good as the line of centres but those near
/// to it, where the gap is concave in the angle, so that Newton's method finds the one peak.
/// @returns whether they are, and it did
inline bool find_one_peak(const std::array<FlatSection, 2>& sections, const core::Two& apart, FlatGap& found) noexcept {
    const double distance = core::norm(apart);
    if (!(distance > 0.0)) return false;
    const core::Two centres{apart[0] / distance, apart[1] / distance};
    double above_least = 0.0, flattening = 0.0;  // of extents; of what these may lose in the second derivative
    for (const FlatSection& s : sections) {
        const double xx = s.p[0] * s.p[0] + s.q[0] * s.q[0], yy = s.p[1] * s.p[1] + s.q[1] * s.q[1],
                     xy = s.p[0] * s.p[1] + s.q[0] * s.q[1];
        const double mean = 0.5 * (xx + yy), off = std::sqrt(0.25 * (xx - yy) * (xx - yy) + xy * xy);
        above_least += s.extent(centres) - std::sqrt(std::max(0.0, mean - off));
        flattening += 2.0 * off / std::sqrt(mean + off);
    }
    const double nearest = 1.0 - above_least / distance, certain = 1.5;  // cosine of the angle to the line of centres
    if (!(nearest * distance > certain * flattening)) return false;
    core::Two n = centres;
    for (int iteration = 0; iteration < 12 && core::dot(n, centres) >= nearest; ++iteration) {
        const core::Two across{-n[1], n[0]};
        const double along = core::dot(apart, n);
        double gap = along, slope = core::dot(apart, across), curved = -along;
        for (const FlatSection& s : sections) {
            const double p = core::dot(s.p, n), q = core::dot(s.q, n), p_a = core::dot(s.p, across), q_a = core::dot(s.q, across);
            const double h = std::sqrt(p * p + q * q), turned = (p * p_a + q * q_a) / h;
            gap -= h, slope -= turned, curved -= (p_a * p_a + q_a * q_a - turned * turned) / h - h;
        }
        const double step = -slope / curved, settled = 1e-9;  // the gap is level: its error is of second order
        if (!(std::abs(step) < 1.0)) return false;
        if (std::abs(step) < settled) {
            found = {gap, n};
            return true;
        }
        const double over = 1.0 / std::sqrt(1.0 + step * step);
        n = {(n[0] + step * across[0]) * over, (n[1] + step * across[1]) * over};
    }
    return false;
}

}  // namespace detail

/// Greatest gap of two sections in a plane among all its directions.
/// @param apart  from the centre of the first to that of the second [length]
inline FlatGap greatest_gap(const std::array<FlatSection, 2>& sections, const core::Two& apart) {
    FlatGap best;
    if (detail::find_one_peak(sections, apart, best)) return best;
    const auto slope = [&](double angle, double& gap) {
        const core::Two n{std::cos(angle), std::sin(angle)}, across{-n[1], n[0]};
        gap = core::dot(apart, n);
        double sum = core::dot(apart, across);
        for (const FlatSection& s : sections) {
            const double p = core::dot(s.p, n), q = core::dot(s.q, n), h = std::hypot(p, q);
            gap -= h;
            if (h > 0.0) sum -= (p * core::dot(s.p, across) + q * core::dot(s.q, across)) / h;
        }
        return sum;
    };
    // All round, and at the thinnest and widest directions: between two of these no peak is hidden.
    constexpr int around = 24;
    std::array<double, around + 8> angles{};
    for (int k = 0; k < around; ++k) angles[core::at(k)] = 2.0 * std::numbers::pi * k / around;
    for (std::size_t s = 0; s < 2; ++s) {
        const core::Two &p = sections[s].p, &q = sections[s].q;
        const double wide =
            0.5 * std::atan2(2.0 * (p[0] * p[1] + q[0] * q[1]), p[0] * p[0] + q[0] * q[0] - p[1] * p[1] - q[1] * q[1]);
        for (std::size_t k = 0; k < 4; ++k) {
            const double angle = wide + 0.5 * std::numbers::pi * static_cast<double>(k);
            angles[around + 4 * s + k] = angle - 2.0 * std::numbers::pi * std::floor(angle / (2.0 * std::numbers::pi));
        }
    }
    std::sort(angles.begin(), angles.end());
    double at_best = 0.0;
    for (std::size_t k = 0; k < angles.size(); ++k) {
        double low = angles[k], high = k + 1 < angles.size() ? angles[k + 1] : angles[0] + 2.0 * std::numbers::pi, gap = 0.0;
        if (!(slope(low, gap) >= 0.0)) continue;
        if (gap > best.gap) best.gap = gap, at_best = low;
        if (!(slope(high, gap) <= 0.0)) continue;
        for (int halving = 0; halving < 50 && high - low > 1e-9; ++halving) {
            const double middle = 0.5 * (low + high);
            (slope(middle, gap) > 0.0 ? low : high) = middle;
        }
        slope(0.5 * (low + high), gap);
        if (gap > best.gap) best.gap = gap, at_best = 0.5 * (low + high);
    }
    best.normal = {std::cos(at_best), std::sin(at_best)};
    return best;
}

}  // namespace fibrant::observe

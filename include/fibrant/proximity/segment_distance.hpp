// SPDX-License-Identifier: MIT
#pragma once
/// @file Distance of two segments, right for parallel, crossing and degenerate ones.

#include <fibrant/core/types.hpp>

#include <cmath>

namespace fibrant::proximity {

/// Closest points of two segments: start + s chord and start' + t chord'.
struct SegmentDistance {
    double squared = 0;   ///< [length^2]
    double s = 0, t = 0;  ///< in [0, 1]; not unique where the segments are parallel
};

namespace detail {

// What a loop over lanes calls is inlined whatever the options of that loop are.
struct Plain3 {
    double x, y, z;
    [[gnu::always_inline]] friend constexpr Plain3 operator-(const Plain3& a, const Plain3& b) noexcept {
        return {a.x - b.x, a.y - b.y, a.z - b.z};
    }
};
/// Sums of three numbers that a compiler unfolds.
[[gnu::always_inline]] inline constexpr double dot(const Plain3& a, const Plain3& b) noexcept {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline Plain3 plain(const Vec3& v) noexcept { return {v[0], v[1], v[2]}; }

/// To [0, 1], and not a number to 0.
[[gnu::always_inline]] inline constexpr double unit_clamped(double x) noexcept {
    x = x > 0.0 ? x : 0.0;
    return x < 1.0 ? x : 1.0;
}

/// Squared distance of the points at s and t of two segments whose starts are w apart [length^2].
[[gnu::always_inline]] inline constexpr double squared_between(const Plain3& w, const Plain3& u, const Plain3& v, double s,
                                                               double t) noexcept {
    const Plain3 difference{w.x + s * u.x - t * v.x, w.y + s * u.y - t * v.y, w.z + s * u.z - t * v.z};
    return dot(difference, difference);
}

/// Parameters of the five candidates of which one is closest: the clamped solution of the two lines, and each of the four
/// ends against the other segment.
///
/// The usual routine (solve, clamp, clamp again) trusts the solution of the two lines, which is noise for angles of
/// 1e-7 and below, and is then wrong by 4e-6; here the noise only adds a candidate that is not needed.
struct ClosestCandidates {
    double s[5], t[5];

    /// @param w  start - start'   @param u  chord   @param v  chord'
    [[gnu::always_inline]] constexpr ClosestCandidates(const Plain3& w, const Plain3& u, const Plain3& v) noexcept : s{}, t{} {
        constexpr double tiny = 1.0e-300;  // in place of the square of a segment without length
        const double uu = dot(u, u), vv = dot(v, v), uv = dot(u, v), uw = dot(u, w), vw = dot(v, w);
        const double per_uu = 1.0 / (uu > tiny ? uu : tiny), per_vv = 1.0 / (vv > tiny ? vv : tiny);
        const double area = uu * vv - uv * uv;
        s[0] = unit_clamped((uv * vw - vv * uw) / (area > tiny ? area : tiny));
        t[0] = unit_clamped((uv * s[0] + vw) * per_vv);
        s[1] = 0.0;
        t[1] = unit_clamped(vw * per_vv);
        s[2] = 1.0;
        t[2] = unit_clamped((vw + uv) * per_vv);
        s[3] = unit_clamped(-uw * per_uu);
        t[3] = 0.0;
        s[4] = unit_clamped((uv - uw) * per_uu);
        t[4] = 1.0;
    }
};

/// Squared distance alone, without a branch: for loops over lanes.
[[gnu::always_inline]] inline constexpr double least_squared(const Plain3& w, const Plain3& u, const Plain3& v) noexcept {
    const ClosestCandidates c(w, u, v);
    double least = squared_between(w, u, v, c.s[0], c.t[0]);
    for (int k = 1; k < 5; ++k) {
        const double squared = squared_between(w, u, v, c.s[k], c.t[k]);
        least = squared < least ? squared : least;
    }
    return least;
}

[[gnu::always_inline]] inline constexpr SegmentDistance segment_distance(const Plain3& w, const Plain3& u,
                                                                         const Plain3& v) noexcept {
    const ClosestCandidates c(w, u, v);
    SegmentDistance least{squared_between(w, u, v, c.s[0], c.t[0]), c.s[0], c.t[0]};
    for (int k = 1; k < 5; ++k) {
        const double squared = squared_between(w, u, v, c.s[k], c.t[k]);
        const bool closer = squared < least.squared;
        least = {closer ? squared : least.squared, closer ? c.s[k] : least.s, closer ? c.t[k] : least.t};
    }
    return least;
}

}  // namespace detail

/// Closest points of the segments from a to a + chord and from b to b + other_chord. Relative error of the distance
/// below 2e-12 for angles down to 0, lengths within a factor of 200 and offsets of 1e6 lengths.
inline SegmentDistance segment_distance(const Vec3& a, const Vec3& chord, const Vec3& b, const Vec3& other_chord) {
    return detail::segment_distance(detail::plain(a) - detail::plain(b), detail::plain(chord), detail::plain(other_chord));
}

}  // namespace fibrant::proximity

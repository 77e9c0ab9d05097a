// SPDX-License-Identifier: MIT
#pragma once
/// @file The part of a segment that is near another one, in closed form.

#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fibrant::proximity::detail {

/// Part [from, to] of a segment in [0, 1]; none where `to` is below `from`.
struct Part {
    double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();

    /// Widens [a, b] by it, as numbered from `first` on.
    void add_to(double first, double& a, double& b) const noexcept { a = std::min(a, first + from), b = std::max(b, first + to); }
};

/// A line and what is around another segment: where |x + s d| <= threshold. Without a branch, for loops over lanes.
struct NearQuadratic {
    double a, b, c;

    /// @param square  of the threshold
    [[gnu::always_inline]] static constexpr NearQuadratic of(const Plain3& x, const Plain3& d, double square) noexcept {
        return {dot(d, d), dot(x, d), dot(x, x) - square};
    }
    [[gnu::always_inline]] constexpr double below_root() const noexcept { return b * b - a * c; }

    /// What of [low, high] is near. The lesser of two roots far apart is that of the other one: no digits are lost.
    /// @param root  < 0 where there is none
    [[gnu::always_inline]] constexpr Part within(double root, double low, double high) const noexcept {
        constexpr Part none;
        const double sum = b > 0.0 ? -b - root : -b + root, first = sum / (a > tiny ? a : 1.0),
                     other = c / (sum != 0.0 ? sum : 1.0), second = sum != 0.0 ? other : first,
                     least = first < second ? first : second, most = first < second ? second : first;
        double begin = least > low ? least : low, end = most < high ? most : high;
        begin = root >= 0.0 ? begin : none.from;
        const double from = begin <= end ? begin : none.from, to = begin <= end ? end : none.to;
        const double all_from = c <= 0.0 ? low : none.from, all_to = c <= 0.0 ? high : none.to;
        return {a > tiny ? from : all_from, a > tiny ? to : all_to};
    }

    static constexpr double tiny = 1.0e-300;  // as of ClosestCandidates
};

/// Part of a segment that is no further than a threshold from another one.
///
/// What is so near to a segment is a cylinder between two balls, and a line meets each of the three in an interval; being
/// convex, they make one together.
struct NearPart {
    double uu, vv, along, slope;  ///< the last two: foot on the other one, in its lengths
    NearQuadratic start, end, side;

    /// @param w  start - start'   @param u  chord   @param v  chord'   @param square  of the threshold
    [[gnu::always_inline]] static constexpr NearPart of(const Plain3& w, const Plain3& u, const Plain3& v,
                                                        double square) noexcept {
        const double vv = dot(v, v), per = vv > NearQuadratic::tiny ? vv : 1.0, along = dot(w, v) / per, slope = dot(u, v) / per;
        return {dot(u, u),
                vv,
                along,
                slope,
                NearQuadratic::of(w, u, square),
                NearQuadratic::of(w - v, u, square),
                NearQuadratic::of({w.x - along * v.x, w.y - along * v.y, w.z - along * v.z},
                                  {u.x - slope * v.x, u.y - slope * v.y, u.z - slope * v.z}, square)};
    }
    /// @param start_root, end_root, side_root  of the three quadratics
    [[gnu::always_inline]] constexpr Part part(double start_root, double end_root, double side_root) const noexcept {
        constexpr double tiny = NearQuadratic::tiny;
        constexpr Part none;
        // Where the foot on the other one is between its ends.
        const double size = slope > 0.0 ? slope : -slope, per = size > tiny ? slope : 1.0, a = -along / per,
                     b = (1.0 - along) / per, least = a < b ? a : b, most = a < b ? b : a;
        double low = least > 0.0 ? least : 0.0, high = most < 1.0 ? most : 1.0;
        const double inside = along < 0.0 ? none.from : along > 1.0 ? none.from : 0.0;  // 0 where it is
        low = size > tiny ? low : inside, high = size > tiny ? high : 1.0 - inside;
        low = vv > tiny ? low : none.from, high = vv > tiny ? high : none.to;
        const Part p = start.within(start_root, 0.0, 1.0), q = end.within(end_root, 0.0, 1.0),
                   r = side.within(side_root, low, high);
        double from = p.from < q.from ? p.from : q.from, to = p.to > q.to ? p.to : q.to;
        from = from < r.from ? from : r.from, to = to > r.to ? to : r.to;
        return {uu > tiny ? from : 0.0, uu > tiny ? to : 1.0};
    }
};

/// The root, and -1 where there is none.
inline double root_or_none(double below) noexcept { return below >= 0.0 ? std::sqrt(below) : -1.0; }

/// Part of a segment that is no further than `threshold` from another one.
inline Part near_part(const SegmentRecord& of, const SegmentRecord& other, double threshold) noexcept {
    const NearPart near = NearPart::of(of.start - other.start, of.chord, other.chord, threshold * threshold);
    return near.part(root_or_none(near.start.below_root()), root_or_none(near.end.below_root()),
                     root_or_none(near.side.below_root()));
}

/// Roots of eight: compilers leave them scalar, as they may set errno.
inline void roots_or_none(double* below) noexcept {
#if defined(FIBRANT_FILTER_AVX512)
    const __m512d x = _mm512_load_pd(below);
    const __mmask8 some = _mm512_cmp_pd_mask(x, _mm512_setzero_pd(), _CMP_GE_OQ);
    _mm512_store_pd(below, _mm512_mask_sqrt_pd(_mm512_set1_pd(-1.0), some, x));
#elif defined(__AVX2__)
    for (int l = 0; l < FilterLanes::size; l += 4) {
        const __m256d x = _mm256_load_pd(below + l), some = _mm256_cmp_pd(x, _mm256_setzero_pd(), _CMP_GE_OQ);
        _mm256_store_pd(below + l, _mm256_blendv_pd(_mm256_set1_pd(-1.0), _mm256_sqrt_pd(x), some));
    }
#else
    for (int l = 0; l < FilterLanes::size; ++l) below[l] = root_or_none(below[l]);
#endif
}

/// The same for eight at once: loaded lanes, whose s and t become the ends of the parts.
#if defined(__GNUC__) && !defined(__clang__)
__attribute__((optimize("no-trapping-math")))
#endif
inline void
near_parts(FilterLanes& lanes) noexcept {
    constexpr int size = FilterLanes::size;
    alignas(64) double ways[4][size], start[4][size], end[4][size], side[4][size];  // the last of each: roots
    for (int l = 0; l < size; ++l) {
        const NearPart near =
            NearPart::of({lanes.w[0][l], lanes.w[1][l], lanes.w[2][l]}, {lanes.u[0][l], lanes.u[1][l], lanes.u[2][l]},
                         {lanes.v[0][l], lanes.v[1][l], lanes.v[2][l]}, lanes.threshold[l] * lanes.threshold[l]);
        ways[0][l] = near.uu, ways[1][l] = near.vv, ways[2][l] = near.along, ways[3][l] = near.slope;
        start[0][l] = near.start.a, start[1][l] = near.start.b, start[2][l] = near.start.c, start[3][l] = near.start.below_root();
        end[0][l] = near.end.a, end[1][l] = near.end.b, end[2][l] = near.end.c, end[3][l] = near.end.below_root();
        side[0][l] = near.side.a, side[1][l] = near.side.b, side[2][l] = near.side.c, side[3][l] = near.side.below_root();
    }
    roots_or_none(start[3]), roots_or_none(end[3]), roots_or_none(side[3]);
    for (int l = 0; l < size; ++l) {
        const NearPart near{ways[0][l],
                            ways[1][l],
                            ways[2][l],
                            ways[3][l],
                            {start[0][l], start[1][l], start[2][l]},
                            {end[0][l], end[1][l], end[2][l]},
                            {side[0][l], side[1][l], side[2][l]}};
        const Part part = near.part(start[3][l], end[3][l], side[3][l]);
        lanes.s[l] = part.from, lanes.t[l] = part.to;
    }
}

}  // namespace fibrant::proximity::detail

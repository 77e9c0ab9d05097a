// SPDX-License-Identifier: MIT
#pragma once
/// @file The exact filter that all searches share, eight candidates at once.

#include <fibrant/core/vector_units.hpp>
#include <fibrant/proximity/segment_table.hpp>

#include <algorithm>
#include <bit>
#include <cmath>

#if defined(__AVX512F__) && defined(__AVX512DQ__)
#define FIBRANT_FILTER_AVX512 1
#endif

namespace fibrant::proximity::detail {

/// Two positions in a list of records that may be close.
struct Candidate {
    std::int32_t a, b;
};

#if defined(FIBRANT_FILTER_AVX512)
/// Steps of a transposition.
inline __m512d even(__m512d a, __m512d b) noexcept { return __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14); }
inline __m512d odd(__m512d a, __m512d b) noexcept { return __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15); }
inline __m512d low_pairs(__m512d a, __m512d b) noexcept { return __builtin_shufflevector(a, b, 0, 1, 8, 9, 4, 5, 12, 13); }
inline __m512d high_pairs(__m512d a, __m512d b) noexcept { return __builtin_shufflevector(a, b, 2, 3, 10, 11, 6, 7, 14, 15); }
#endif

/// Eight pairs laid out for the vector units: one lane a pair.
struct FilterLanes {
    static constexpr int size = 8;
    alignas(64) double w[3][size], u[3][size], v[3][size], threshold[size], squared[size];
    alignas(64) double s[size], t[size], sense[size];  // written by `locate` alone
    alignas(64) SegmentPair pair[size];

    /// @param i, j  of each lane, i the first segment of the two
    void load(const SegmentRecord* const* i, const SegmentRecord* const* j, double reach) noexcept {
#if defined(FIBRANT_FILTER_AVX512)
        // Whole records, combined and then transposed: start - start', chord, half + half', numbers; and chord', numbers.
        static_assert(sizeof(SegmentPair) == 8 && std::endian::native == std::endian::little);
        __m512d x[size], y[size], s[size];
        for (int l = 0; l < size; ++l) {
            const __m512d a = _mm512_load_pd(i[l]), b = _mm512_load_pd(j[l]);
            x[l] = _mm512_mask_add_pd(_mm512_mask_sub_pd(a, 0x07, a, b), 0x40, a, b);
            y[l] = b;
        }
        for (int l = 0; l < size; l += 4) {
            const __m512d t0 = even(x[l], x[l + 1]), t1 = odd(x[l], x[l + 1]), t2 = even(x[l + 2], x[l + 3]),
                          t3 = odd(x[l + 2], x[l + 3]);
            s[l] = low_pairs(t0, t2);       // columns 0 and 4
            s[l + 1] = low_pairs(t1, t3);   // 1 and 5
            s[l + 2] = high_pairs(t0, t2);  // 2 and 6
            s[l + 3] = high_pairs(t1, t3);  // 3 and 7
        }
        const auto lower = [&s](int c) { return __builtin_shufflevector(s[c], s[c + 4], 0, 1, 2, 3, 8, 9, 10, 11); };
        const auto upper = [&s](int c) { return __builtin_shufflevector(s[c], s[c + 4], 4, 5, 6, 7, 12, 13, 14, 15); };
        for (int axis = 0; axis < 3; ++axis) _mm512_store_pd(w[axis], lower(axis));
        _mm512_store_pd(u[0], lower(3));
        _mm512_store_pd(u[1], upper(0));
        _mm512_store_pd(u[2], upper(1));
        _mm512_store_pd(threshold, upper(2) + reach);
        for (int l = 0; l < 4; ++l) y[l] = __builtin_shufflevector(y[l], y[l + 4], 3, 4, 5, 7, 11, 12, 13, 15);
        const __m512d t0 = even(y[0], y[1]), t1 = odd(y[0], y[1]), t2 = even(y[2], y[3]), t3 = odd(y[2], y[3]);
        _mm512_store_pd(v[0], low_pairs(t0, t2));
        _mm512_store_pd(v[1], low_pairs(t1, t3));
        _mm512_store_pd(v[2], high_pairs(t0, t2));
        const __m512i first = _mm512_castpd_si512(upper(3)), second = _mm512_castpd_si512(high_pairs(t1, t3));
        _mm512_store_si512(pair, (first & _mm512_set1_epi64(0xffffffffLL)) | (second << 32));
#else
        for (int l = 0; l < size; ++l) {
            const Plain3 difference = i[l]->start - j[l]->start;
            w[0][l] = difference.x, w[1][l] = difference.y, w[2][l] = difference.z;
            u[0][l] = i[l]->chord.x, u[1][l] = i[l]->chord.y, u[2][l] = i[l]->chord.z;
            v[0][l] = j[l]->chord.x, v[1][l] = j[l]->chord.y, v[2][l] = j[l]->chord.z;
            threshold[l] = i[l]->half + j[l]->half + reach;
            pair[l] = {i[l]->segment, j[l]->segment};
        }
#endif
    }

    // Without masked instructions g++ keeps this scalar, twice as slow, unless told that no operation traps; the values are the
    // same.
#if defined(__GNUC__) && !defined(__clang__)
    __attribute__((optimize("no-trapping-math")))
#endif
    void
    measure() noexcept {
        for (int l = 0; l < size; ++l)
            squared[l] = least_squared({w[0][l], w[1][l], w[2][l]}, {u[0][l], u[1][l], u[2][l]}, {v[0][l], v[1][l], v[2][l]});
    }

    /// Closest points and the cosine of the two chords, 0 where one has no length.
#if defined(__GNUC__) && !defined(__clang__)
    __attribute__((optimize("no-trapping-math")))
#endif
    void
    locate() noexcept {
        alignas(64) double lengths[size];  // product of their squares
        for (int l = 0; l < size; ++l) {
            const Plain3 a{u[0][l], u[1][l], u[2][l]}, b{v[0][l], v[1][l], v[2][l]};
            const SegmentDistance closest = segment_distance(Plain3{w[0][l], w[1][l], w[2][l]}, a, b);
            squared[l] = closest.squared, s[l] = closest.s, t[l] = closest.t;
            lengths[l] = dot(a, a) * dot(b, b), sense[l] = dot(a, b);
        }
        for (int l = 0; l < size; ++l) sense[l] /= lengths[l] > 0.0 ? std::sqrt(lengths[l]) : 1.0;  // apart: it may set errno
    }

    /// Writes the pairs of the first n lanes that are close; room for eight. @return the end of them
    SegmentPair* take(int n, SegmentPair* out) const noexcept {
#if defined(FIBRANT_FILTER_AVX512)
        const __m512d bound = _mm512_load_pd(threshold);
        const auto close = static_cast<__mmask8>(
            _mm512_cmp_pd_mask(_mm512_load_pd(squared), _mm512_mul_pd(bound, bound), _CMP_LT_OQ) & ((1U << n) - 1U));
        _mm512_storeu_si512(out, _mm512_maskz_compress_epi64(close, _mm512_load_si512(pair)));
        return out + std::popcount(static_cast<unsigned>(close));
#else
        for (int l = 0; l < n; ++l) {
            *out = pair[l];
            out += squared[l] < threshold[l] * threshold[l] ? 1 : 0;
        }
        return out;
#endif
    }
};

/// Appends the pairs of the candidates that are close. The one filter of all searches: it takes each pair in the order
/// of its segments, in whole vectors only, and is compiled once (never inlined), so that a pair on the very threshold is
/// decided alike by all.
#if defined(__GNUC__)
__attribute__((noinline))
#endif
inline void
keep_close(const SegmentTable& table, const SegmentRecord* records, std::span<const Candidate> candidates,
           std::vector<SegmentPair>& close) {
    constexpr std::size_t ahead = 12;  // candidates to ask memory for in advance
    constexpr int room = 512;
    FilterLanes lanes;
    const SegmentRecord *i[FilterLanes::size], *j[FilterLanes::size];
    SegmentPair found[room + FilterLanes::size];
    SegmentPair* end = found;
    int filled = 0;
    const auto flush = [&] {
        for (int l = filled; l < FilterLanes::size; ++l) i[l] = i[0], j[l] = j[0];  // no lane is ever read unset
        lanes.load(i, j, table.reach());
        lanes.measure();
        end = lanes.take(filled, end);
        filled = 0;
        if (end - found < room) return;
        close.insert(close.end(), found, end);
        end = found;
    };
    for (std::size_t k = 0; k < candidates.size(); ++k) {
        const Candidate candidate = candidates[k];
        if (k + ahead < candidates.size()) core::prefetch(records + candidates[k + ahead].b);
        // No branch on what is as good as random: which of the two is first, and whether both are of one fibre.
        const SegmentRecord* two[2] = {records + candidate.a, records + candidate.b};
        const std::size_t second = two[0]->segment < two[1]->segment ? 1 : 0;
        i[filled] = two[1 - second];
        j[filled] = two[second];
        int keep = two[0]->group != two[1]->group ? 1 : 0;
        if (table.selfish() && keep == 0) keep = table.may_pair_in_group(i[filled]->segment, j[filled]->segment) ? 1 : 0;
        filled += keep;
        if (filled == FilterLanes::size) flush();
    }
    if (filled > 0) flush();
    close.insert(close.end(), found, end);
}

/// Closest points of a close pair, and how its segments run.
struct PairPlace {
    double squared, s, t;  ///< as of SegmentDistance
    double sense;          ///< cosine of the two chords
};

/// Places of pairs, eight at once; compiled once, as the filter is.
/// @param records  of all segments in order
/// @param places   one a pair
#if defined(__GNUC__)
__attribute__((noinline))
#endif
inline void
locate(const SegmentRecord* records, std::span<const SegmentPair> pairs, double reach, PairPlace* places) {
    constexpr std::size_t ahead = 2 * FilterLanes::size;  // pairs to ask memory for in advance
    FilterLanes lanes;
    const SegmentRecord *i[FilterLanes::size], *j[FilterLanes::size];
    for (std::size_t k = 0; k < pairs.size(); k += FilterLanes::size) {
        const std::size_t filled = std::min(pairs.size() - k, std::size_t{FilterLanes::size});
        for (std::size_t l = k + ahead; l < std::min(k + ahead + FilterLanes::size, pairs.size()); ++l)
            core::prefetch(records + pairs[l].j);
        for (std::size_t l = 0; l < FilterLanes::size; ++l) {
            const SegmentPair& pair = pairs[k + (l < filled ? l : 0)];
            i[l] = records + pair.i, j[l] = records + pair.j;
        }
        lanes.load(i, j, reach);
        lanes.locate();
        for (std::size_t l = 0; l < filled; ++l) places[k + l] = {lanes.squared[l], lanes.s[l], lanes.t[l], lanes.sense[l]};
    }
}

}  // namespace fibrant::proximity::detail

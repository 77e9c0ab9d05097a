// SPDX-License-Identifier: MIT
#pragma once
/// @file Sixteen boxes compared at once: the inner loop of the grid.

#include <fibrant/core/vector_units.hpp>
#include <fibrant/proximity/boxes.hpp>

#include <bit>
#include <cstring>

namespace fibrant::proximity::detail {

/// Boxes as seven columns, which end with some more values so that whole vectors may be read from any place.
class BoxColumns {
public:
    static constexpr std::int32_t width = 16;

    void resize(std::int32_t n) {
        for (auto& column : column_) {
            column.resize(core::at(n + width));
            std::fill(column.end() - width, column.end(), 0.0F);
        }
        group_.resize(core::at(n + width));
    }
    std::int32_t size() const noexcept { return std::max(0, static_cast<std::int32_t>(group_.size()) - width); }
    std::size_t bytes() const noexcept { return 7 * group_.capacity() * sizeof(float); }
    void set(std::int32_t k, const Box& box) noexcept {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            column_[2 * axis][core::at(k)] = box.low[axis];
            column_[2 * axis + 1][core::at(k)] = box.high[axis];
        }
        group_[core::at(k)] = box.group;
    }
    Box operator[](std::int32_t k) const noexcept {
        Box box;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            box.low[axis] = column_[2 * axis][core::at(k)];
            box.high[axis] = column_[2 * axis + 1][core::at(k)];
        }
        box.group = group_[core::at(k)];
        return box;
    }

    /// Least box around those in [first, last), of the group of the first.
    Box around(std::int32_t first, std::int32_t last) const noexcept {
        Box all = (*this)[first];
        for (std::int32_t k = first + 1; k < last; ++k)
            for (std::size_t axis = 0; axis < 3; ++axis) {
                all.low[axis] = std::min(all.low[axis], column_[2 * axis][core::at(k)]);
                all.high[axis] = std::max(all.high[axis], column_[2 * axis + 1][core::at(k)]);
            }
        return all;
    }

    /// Writes {of, k} for each box k in [first, last) of another group that overlaps `box`, in order.
    /// @param out  room for last - first + width
    /// @return the end of what was written
    Candidate* overlaps(const Box& box, std::int32_t first, std::int32_t last, std::int32_t of, Candidate* out) const noexcept {
        for (std::int32_t k = first; k < last; k += width) {
            std::uint32_t bits = mask(box, k);
            if (last - k < width) bits &= (1U << (last - k)) - 1U;
            out = append(of, k, bits, out);
        }
        return out;
    }

private:
    /// Writes {of, k + l} for each bit l.
    static Candidate* append(std::int32_t of, std::int32_t k, std::uint32_t bits, Candidate* out) noexcept {
#if defined(__AVX512F__)
        // Whole vectors without a branch, as the number of bits is as good as random. A candidate is 64 bits, `of` the lower.
        const __m512i lanes = _mm512_setr_epi64(0, 1LL << 32, 2LL << 32, 3LL << 32, 4LL << 32, 5LL << 32, 6LL << 32, 7LL << 32);
        const auto put = [&](std::uint32_t mask, std::int32_t first) {
            const __m512i all = _mm512_add_epi64(lanes, _mm512_set1_epi64(std::bit_cast<std::int64_t>(Candidate{of, first})));
            _mm512_storeu_si512(out, _mm512_maskz_compress_epi64(static_cast<__mmask8>(mask), all));
            out += std::popcount(mask);
        };
        put(bits & 0xffU, k);
        put(bits >> 8, k + 8);
        return out;
#else
        for (; bits != 0; bits &= bits - 1U) *out++ = {of, k + std::countr_zero(bits)};
        return out;
#endif
    }

    /// Bit l says that box k + l overlaps and is of another group. Comparisons are exact, so every form gives the same bits.
    std::uint32_t mask(const Box& box, std::int32_t k) const noexcept {
        const float *x0 = column_[0].data() + k, *x1 = column_[1].data() + k, *y0 = column_[2].data() + k,
                    *y1 = column_[3].data() + k, *z0 = column_[4].data() + k, *z1 = column_[5].data() + k;
        const std::int32_t* group = group_.data() + k;
#if defined(__AVX512F__)
        __mmask16 m = _mm512_cmp_ps_mask(_mm512_loadu_ps(x0), _mm512_set1_ps(box.high[0]), _CMP_LE_OQ);
        m = _mm512_mask_cmp_ps_mask(m, _mm512_loadu_ps(x1), _mm512_set1_ps(box.low[0]), _CMP_GE_OQ);
        m = _mm512_mask_cmp_ps_mask(m, _mm512_loadu_ps(y0), _mm512_set1_ps(box.high[1]), _CMP_LE_OQ);
        m = _mm512_mask_cmp_ps_mask(m, _mm512_loadu_ps(y1), _mm512_set1_ps(box.low[1]), _CMP_GE_OQ);
        m = _mm512_mask_cmp_ps_mask(m, _mm512_loadu_ps(z0), _mm512_set1_ps(box.high[2]), _CMP_LE_OQ);
        m = _mm512_mask_cmp_ps_mask(m, _mm512_loadu_ps(z1), _mm512_set1_ps(box.low[2]), _CMP_GE_OQ);
        return _mm512_mask_cmpneq_epi32_mask(m, _mm512_loadu_si512(group), _mm512_set1_epi32(box.group));
#elif defined(__AVX2__)
        const auto eight = [&](std::int32_t l) {
            const auto below = [l](const float* low, float high) {
                return _mm256_cmp_ps(_mm256_loadu_ps(low + l), _mm256_set1_ps(high), _CMP_LE_OQ);
            };
            const auto above = [l](const float* high, float low) {
                return _mm256_cmp_ps(_mm256_loadu_ps(high + l), _mm256_set1_ps(low), _CMP_GE_OQ);
            };
            const __m256 x = _mm256_and_ps(below(x0, box.high[0]), above(x1, box.low[0]));
            const __m256 y = _mm256_and_ps(below(y0, box.high[1]), above(y1, box.low[1]));
            const __m256 z = _mm256_and_ps(below(z0, box.high[2]), above(z1, box.low[2]));
            const __m256 same = _mm256_castsi256_ps(_mm256_cmpeq_epi32(
                _mm256_loadu_si256(reinterpret_cast<const __m256i*>(group + l)), _mm256_set1_epi32(box.group)));
            return static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_andnot_ps(same, _mm256_and_ps(_mm256_and_ps(x, y), z))));
        };
        return eight(0) | eight(8) << 8;
#else
        // Sixteen independent comparisons into bytes, which compilers turn into vector instructions of any width.
        alignas(16) unsigned char hit[width];
        for (std::int32_t l = 0; l < width; ++l)
            hit[l] = static_cast<unsigned char>(static_cast<int>(x0[l] <= box.high[0]) & static_cast<int>(x1[l] >= box.low[0]) &
                                                static_cast<int>(y0[l] <= box.high[1]) & static_cast<int>(y1[l] >= box.low[1]) &
                                                static_cast<int>(z0[l] <= box.high[2]) & static_cast<int>(z1[l] >= box.low[2]) &
                                                static_cast<int>(group[l] != box.group));
        std::uint64_t half[2];
        std::memcpy(half, hit, sizeof half);
        if constexpr (std::endian::native == std::endian::little) {
            constexpr std::uint64_t gather = 0x0102040810204080U;  // bytes of 0 and 1 to the bits of the highest byte
            return static_cast<std::uint32_t>((half[0] * gather) >> 56 | ((half[1] * gather) >> 56) << 8);
        } else {
            std::uint32_t bits = 0;
            for (std::int32_t l = 0; l < width; ++l) bits |= static_cast<std::uint32_t>(hit[l]) << l;
            return bits;
        }
#endif
    }

    std::vector<float> column_[6];
    std::vector<std::int32_t> group_;
};

}  // namespace fibrant::proximity::detail

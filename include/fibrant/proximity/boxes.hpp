// SPDX-License-Identifier: MIT
#pragma once
/// @file Single-precision boxes of segments in a frame that suits them.

#include <fibrant/core/parallel.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace fibrant::proximity::detail {

/// Axis-aligned box, relative to the middle of the scene and widened so that single precision loses nothing.
struct Box {
    float low[3], high[3];
    std::int32_t group;  ///< boxes of one group do not pair
};

/// Orthonormal axes (rows) and middle of the scene, and means over its segments.
struct BoxFrame {
    Mat3 axes = Mat3::Identity();
    Vec3 middle = Vec3::Zero();
    double slack = 0.0;           ///< for rounding to single precision [length]
    double mean_length = 0.0;     ///< of a segment [length]
    double longest = 0.0;         ///< segment [length]
    double mean_thickness = 0.0;  ///< 2 (radius + inflation) + reach [length]
    bool selfish = false;         ///< groups pair too, and the filter decides; a segment never pairs with itself

    /// Axes of space, or the principal axes of the directions where one of them holds over 70 % of sum L t t^T: boxes of
    /// oblique bundles would else overlap many times more than their segments do.
    explicit BoxFrame(const SegmentTable& table) {
        struct Moments {
            Mat3 directions = Mat3::Zero();
            Vec3 low = Vec3::Constant(1.0e300), high = Vec3::Constant(-1.0e300);
            double length = 0.0, longest = 0.0, half = 0.0;
        };
        constexpr Index block = 4096;
        const Index n = table.size(), blocks = (n + block - 1) / block;
        std::vector<Moments> part(core::at(blocks));
        core::parallel_for(blocks, [&](Index b) {
            Moments sum;
            for (Index k = b * block; k < std::min(n, (b + 1) * block); ++k) {
                const SegmentRecord record = table.record(static_cast<std::int32_t>(k));
                const Vec3 start{record.start.x, record.start.y, record.start.z};
                const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
                const double length = chord.norm();
                if (length > 0.0) core::add_outer(chord, chord / length, sum.directions);
                sum.length += length;
                sum.longest = std::max(sum.longest, length);
                sum.half += record.half;
                for (Index axis = 0; axis < 3; ++axis) {
                    sum.low[axis] = std::min({sum.low[axis], start[axis], start[axis] + chord[axis]});
                    sum.high[axis] = std::max({sum.high[axis], start[axis], start[axis] + chord[axis]});
                }
            }
            part[core::at(b)] = sum;
        });
        Moments all;
        for (const Moments& sum : part) {
            all.directions += sum.directions;
            all.low = all.low.cwiseMin(sum.low);
            all.high = all.high.cwiseMax(sum.high);
            all.length += sum.length;
            longest = std::max(longest, sum.longest);
            all.half += sum.half;
        }
        const core::SymmetricEigen<3> principal(all.directions);
        if (principal.values()[2] > 0.7 * principal.values().sum()) axes = principal.vectors().transpose();
        mean_length = all.length / static_cast<double>(n);
        mean_thickness = 2.0 * all.half / static_cast<double>(n) + table.reach();
        selfish = table.selfish();
        middle = 0.5 * all.low + 0.5 * all.high;
        slack = rounding * 0.5 * (all.high - all.low).norm();
        if (slack > crude * mean_thickness) close_gaps(table);
    }

    /// Box of the part [from, to] of a segment, widened by `margin`.
    Box box(const SegmentRecord& record, double from, double to, double margin) const noexcept {
        const Vec3 start{record.start.x - middle[0], record.start.y - middle[1], record.start.z - middle[2]};
        const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
        const Vec3 first = start + from * chord, last = start + to * chord;
        Vec3 a = axes * first, b = axes * last;
        if (!intervals_[0].empty()) {
            const Vec3 taken = shift(axes * start, axes * (start + chord));
            a -= taken, b -= taken;
        }
        const double wide = margin * (1.0 + 1.0e-6) + slack;
        Box made;
        made.group = selfish ? record.segment : record.group;
        for (int axis = 0; axis < 3; ++axis) {
            made.low[axis] = static_cast<float>(std::min(a[axis], b[axis]) - wide);
            made.high[axis] = static_cast<float>(std::max(a[axis], b[axis]) + wide);
        }
        return made;
    }
    /// Box of a segment, widened by half its threshold.
    Box whole_box(const SegmentRecord& record, double reach) const noexcept {
        return box(record, 0.0, 1.0, record.half + 0.5 * reach);
    }

private:
    static constexpr double rounding = 3.0e-7;  // of single precision, five times
    static constexpr double crude = 0.1;        // slack over thickness beyond which boxes overlap that segments do not

    /// What stands far apart comes together: along each axis the empty spaces between the intervals that segments cover are taken
    /// out. Segments that may be close lie in one interval along every axis and move together. Without it one stray fibre costs
    /// all others their precision.
    void close_gaps(const SegmentTable& table) {
        Vec3 extent = Vec3::Zero();
        for (std::size_t axis = 0; axis < 3; ++axis) {
            std::vector<std::pair<double, double>> covered(core::at(table.size()));
            core::parallel_for(
                table.size(),
                [&](Index k) {
                    const SegmentRecord record = table.record(static_cast<std::int32_t>(k));
                    const Vec3 start{record.start.x - middle[0], record.start.y - middle[1], record.start.z - middle[2]};
                    const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
                    const auto row = static_cast<Index>(axis);
                    const double a = (axes * start)[row], b = (axes * (start + chord))[row],
                                 wide = (record.half + 0.5 * table.reach()) * (1.0 + 1.0e-6);
                    covered[core::at(k)] = {std::min(a, b) - wide, std::max(a, b) + wide};
                },
                core::light_items);
            std::sort(covered.begin(), covered.end());
            std::vector<Interval>& found = intervals_[axis];
            double high = covered.front().first, taken = high;
            for (const auto& [from, to] : covered) {
                if (found.empty() || from > high + mean_thickness) {
                    if (!found.empty()) taken += from - high - mean_thickness;
                    found.push_back({from, taken});
                }
                high = std::max(high, to);
            }
            extent[static_cast<Index>(axis)] = high - taken;
            for (Interval& interval : found) interval.taken += 0.5 * (high - taken);
        }
        slack = rounding * 0.5 * extent.norm();
    }
    /// Of a segment with these ends.
    Vec3 shift(const Vec3& a, const Vec3& b) const noexcept {
        Vec3 sum;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double low = std::min(a[static_cast<Index>(axis)], b[static_cast<Index>(axis)]);
            const auto next = std::upper_bound(intervals_[axis].begin(), intervals_[axis].end(), low,
                                               [](double x, const Interval& one) { return x < one.from; });
            sum[static_cast<Index>(axis)] = std::prev(next)->taken;
        }
        return sum;
    }

    struct Interval {
        double from, taken;  // where it begins, and what is taken off coordinates in it [length]
    };
    std::array<std::vector<Interval>, 3> intervals_;  // none: nothing is taken off
};

}  // namespace fibrant::proximity::detail

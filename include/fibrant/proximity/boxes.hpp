// SPDX-License-Identifier: MIT
#pragma once
/// @file Single-precision boxes of segments in a frame that suits them.

#include <fibrant/core/parallel.hpp>
#include <fibrant/core/small_matrix.hpp>
#include <fibrant/core/symmetric_eigen.hpp>
#include <fibrant/proximity/exact_filter.hpp>

#include <algorithm>
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
        const double span = (all.high - all.low).norm();
        slack = rounding * 0.5 * span;
        table_ = &table;
        if (slack > crude * mean_thickness) close_gaps(span);
    }

    /// Box of the part [from, to] of a segment, widened by `margin`.
    Box box(const SegmentRecord& record, double from, double to, double margin) const noexcept {
        const Vec3& origin = origin_.empty() ? middle : origin_[core::at(table_->fibre(record.segment))];
        const Vec3 start{record.start.x - origin[0], record.start.y - origin[1], record.start.z - origin[2]};
        const Vec3 chord{record.chord.x, record.chord.y, record.chord.z};
        const Vec3 first = start + from * chord, last = start + to * chord;
        const Vec3 a = axes * first, b = axes * last;
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

    /// What stands far apart comes together: along each axis the empty spaces between the intervals that fibres cover are taken
    /// out. Fibres that may be close lie in one interval along every axis: they get the same origin, to the last bit, and lose
    /// nothing to rounding however far others are. Without it one stray fibre costs all others their precision.
    void close_gaps(double span) {
        const Index fibres = table_->fibres();
        std::vector<Vec3> low(core::at(fibres)), high(low.size()), taken(low.size());
        core::parallel_for(
            fibres,
            [&](Index f) {
                const Centreline& line = table_->centreline(static_cast<std::int32_t>(f));
                const double thick =
                                 line.inflation.empty() ? 0.0 : *std::max_element(line.inflation.begin(), line.inflation.end()),
                             wide = (line.radius + thick + 0.5 * table_->reach()) * (1.0 + 1.0e-6);
                Vec3 least = Vec3::Constant(1.0e300), most = -least;
                for (const Vec3& point : line.points) {
                    const Vec3 x = axes * (point - middle);
                    least = least.cwiseMin(x), most = most.cwiseMax(x);
                }
                low[core::at(f)] = least.array() - wide, high[core::at(f)] = most.array() + wide;
            },
            core::light_items);
        const double apart = mean_thickness + 1.0e-15 * span;  // the second: of double precision, ten times
        Vec3 extent = Vec3::Zero();
        std::vector<std::size_t> order(low.size());
        for (Index axis = 0; axis < 3; ++axis) {
            for (std::size_t f = 0; f < order.size(); ++f) order[f] = f;
            std::sort(order.begin(), order.end(), [&](std::size_t f, std::size_t g) { return low[f][axis] < low[g][axis]; });
            const double begin = low[order.front()][axis];
            double end = begin, gaps = begin;
            for (const std::size_t f : order) {
                if (low[f][axis] > end + apart) gaps += low[f][axis] - end - apart;
                end = std::max(end, high[f][axis]);
                taken[f][axis] = gaps;
            }
            extent[axis] = end - gaps;
        }
        origin_.resize(low.size());
        for (std::size_t f = 0; f < low.size(); ++f) origin_[f] = middle + axes.transpose() * (taken[f] + 0.5 * extent);
        slack = rounding * 0.5 * extent.norm();
    }

    const SegmentTable* table_ = nullptr;
    std::vector<Vec3> origin_;  // of each fibre, where gaps are closed; else the middle
};

}  // namespace fibrant::proximity::detail

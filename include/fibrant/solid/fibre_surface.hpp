// SPDX-License-Identifier: MIT
#pragma once
/// @file The upper and the lower envelope of a set of fibres with deformed, elliptic sections.

#include <fibrant/core/types.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace fibrant::solid {

/// A section of a fibre: its contour is centre + cos(phi) half_1 + sin(phi) half_2.
struct SectionPlace {
    Vec3 centre, half_1, half_2;  ///< half axes are semi-axes times directors [length]
};

/// Heights at which lines along z first meet fibres, from above or from below.
///
/// Between two sections a fibre is a straight elliptic cylinder of their mean section. Segments are kept in buckets of the plane.
class FibreSurface {
public:
    explicit FibreSurface(const std::vector<std::vector<SectionPlace>>& fibres) {
        for (const std::vector<SectionPlace>& fibre : fibres)
            for (std::size_t k = 0; k + 1 < fibre.size(); ++k) {
                const SectionPlace &a = fibre[k], &b = fibre[k + 1];
                Segment segment;
                segment.from = a.centre;
                Mat3 axes;
                axes << b.centre - a.centre, 0.5 * (a.half_1 + b.half_1), 0.5 * (a.half_2 + b.half_2);
                if (!(std::abs(axes.determinant()) > 0.0)) continue;  // flat sections hide nothing
                segment.inverse = axes.inverse();
                for (int axis = 0; axis < 2; ++axis) {
                    const double reach = std::hypot(axes(axis, 1), axes(axis, 2)) + slack * std::abs(axes(axis, 0));
                    segment.low[core::at(axis)] = std::min(a.centre[axis], b.centre[axis]) - reach;
                    segment.high[core::at(axis)] = std::max(a.centre[axis], b.centre[axis]) + reach;
                }
                segments_.push_back(segment);
            }
        if (segments_.empty()) return;
        std::array<double, 2> size{};
        low_ = segments_[0].low, high_ = segments_[0].high;
        for (const Segment& s : segments_)
            for (std::size_t axis = 0; axis < 2; ++axis) {
                low_[axis] = std::min(low_[axis], s.low[axis]), high_[axis] = std::max(high_[axis], s.high[axis]);
                size[axis] += s.high[axis] - s.low[axis];
            }
        for (std::size_t axis = 0; axis < 2; ++axis) {
            size_[axis] = std::max(size[axis] / static_cast<double>(segments_.size()), (high_[axis] - low_[axis]) / 1024.0);
            count_[axis] = static_cast<Index>((high_[axis] - low_[axis]) / size_[axis]) + 1;
        }
        start_.assign(core::at(count_[0] * count_[1] + 1), 0);
        for (const Segment& s : segments_) each_bucket(s, [&](Index b) { ++start_[core::at(b + 1)]; });
        for (std::size_t b = 1; b < start_.size(); ++b) start_[b] += start_[b - 1];
        list_.resize(core::at(start_.back()));
        std::vector<Index> next(start_.begin(), start_.end() - 1);
        for (Index k = 0; k < core::count(segments_); ++k)
            each_bucket(segments_[core::at(k)], [&](Index b) { list_[core::at(next[core::at(b)]++)] = k; });
    }

    /// Height of the surface that is seen from above (sign 1) or from below (sign -1); none in a pore.
    std::optional<double> height(double x, double y, double sign) const {
        if (segments_.empty() || x < low_[0] || y < low_[1] || x > high_[0] || y > high_[1]) return {};
        const Index b = bucket(place(x, 0), place(y, 1));
        std::optional<double> best;
        for (Index n = start_[core::at(b)]; n < start_[core::at(b + 1)]; ++n) {
            const Segment& s = segments_[core::at(list_[core::at(n)])];
            if (x < s.low[0] || y < s.low[1] || x > s.high[0] || y > s.high[1]) continue;
            // p - from = t axis + a half_1 + b half_2, linear in the height; a^2 + b^2 = 1 on the contour.
            const Vec3 base = s.inverse * (Vec3(x, y, 0.0) - s.from), rise = s.inverse.col(2);
            const double square = rise[1] * rise[1] + rise[2] * rise[2], mixed = base[1] * rise[1] + base[2] * rise[2];
            const double rest = base[1] * base[1] + base[2] * base[2] - 1.0, root = mixed * mixed - square * rest;
            if (!(square > 0.0) || root < 0.0) continue;
            const double z = (-mixed + sign * std::sqrt(root)) / square;
            const double along = base[0] + z * rise[0];
            if (along < -slack || along > 1.0 + slack) continue;
            if (!best || sign * z > sign * *best) best = z;
        }
        return best;
    }
    bool empty() const noexcept { return segments_.empty(); }

private:
    static constexpr double slack = 0.1;  ///< of its length that a segment reaches beyond its ends, so that bends have no cracks
    struct Segment {
        Vec3 from;
        Mat3 inverse;
        std::array<double, 2> low, high;
    };
    Index place(double x, std::size_t axis) const noexcept {
        return std::clamp<Index>(static_cast<Index>((x - low_[axis]) / size_[axis]), 0, count_[axis] - 1);
    }
    Index bucket(Index i, Index j) const noexcept { return j * count_[0] + i; }
    template <class Body>
    void each_bucket(const Segment& s, const Body& body) const {
        for (Index j = place(s.low[1], 1); j <= place(s.high[1], 1); ++j)
            for (Index i = place(s.low[0], 0); i <= place(s.high[0], 0); ++i) body(bucket(i, j));
    }

    std::vector<Segment> segments_;
    std::array<double, 2> low_{}, high_{}, size_{1.0, 1.0};
    std::array<Index, 2> count_{1, 1};
    std::vector<Index> start_, list_;
};

}  // namespace fibrant::solid

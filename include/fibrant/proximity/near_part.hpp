// SPDX-License-Identifier: MIT
#pragma once
/// @file The part of a segment that is near another one, in closed form.

#include <fibrant/proximity/segment_table.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fibrant::proximity::detail {

/// Part [from, to] of a segment in [0, 1]; none where `to` is below `from`.
struct Part {
    double from = std::numeric_limits<double>::infinity(), to = -std::numeric_limits<double>::infinity();

    void take(double a, double b) noexcept { from = std::min(from, a), to = std::max(to, b); }
    /// Widens [a, b] by it, as numbered from `first` on.
    void add_to(double first, double& a, double& b) const noexcept { a = std::min(a, first + from), b = std::max(b, first + to); }
};

/// Part of a segment that is no further than `threshold` from another one.
///
/// What is so near to a segment is a cylinder between two balls, and a line meets each of the three in an interval; being
/// convex, they make one together.
inline Part near_part(const SegmentRecord& of, const SegmentRecord& other, double threshold) noexcept {
    constexpr double tiny = 1.0e-300;  // as of ClosestCandidates
    const Plain3 u = of.chord, v = other.chord, w = of.start - other.start, end = w - v;
    const double uu = dot(u, u), vv = dot(v, v), square = threshold * threshold;
    Part part;
    if (!(uu > tiny)) {
        part.take(0.0, 1.0);
        return part;
    }
    // Where |x + s d| <= threshold. The lesser of two roots far apart is that of the other one: no digits are lost.
    const auto within = [&](const Plain3& x, const Plain3& d, double& low, double& high) {
        const double a = dot(d, d), b = dot(x, d), c = dot(x, x) - square, root = b * b - a * c;
        if (!(a > tiny)) return c <= 0.0;
        if (!(root >= 0.0)) return false;
        const double sum = b > 0.0 ? -b - std::sqrt(root) : -b + std::sqrt(root), first = sum / a,
                     second = sum != 0.0 ? c / sum : first;
        low = std::max(low, std::min(first, second)), high = std::min(high, std::max(first, second));
        return low <= high;
    };
    double low = 0.0, high = 1.0;
    if (within(w, u, low, high)) part.take(low, high);
    low = 0.0, high = 1.0;
    if (within(end, u, low, high)) part.take(low, high);
    if (!(vv > tiny) || (part.from == 0.0 && part.to == 1.0)) return part;
    const double along = dot(w, v) / vv, slope = dot(u, v) / vv;  // of the foot on the other one, in its lengths
    const Plain3 across{w.x - along * v.x, w.y - along * v.y, w.z - along * v.z},
        turn{u.x - slope * v.x, u.y - slope * v.y, u.z - slope * v.z};
    low = 0.0, high = 1.0;
    if (std::abs(slope) > tiny) {
        const double a = -along / slope, b = (1.0 - along) / slope;
        low = std::max(low, std::min(a, b)), high = std::min(high, std::max(a, b));
    } else if (along < 0.0 || along > 1.0) {
        return part;
    }
    if (within(across, turn, low, high)) part.take(low, high);
    return part;
}

}  // namespace fibrant::proximity::detail

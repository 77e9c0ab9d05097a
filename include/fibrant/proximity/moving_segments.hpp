// SPDX-License-Identifier: MIT
#pragma once
/// @file Segments whose ends move on straight lines: when two of them come close, and which of many may.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/segment_distance.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace fibrant::proximity {

/// A segment whose two ends move on straight lines while the time goes from 0 to 1.
struct MovingSegment {
    Vec3 start, end;                ///< at time 0 [length]
    Vec3 start_motion, end_motion;  ///< until time 1 [length]

    Vec3 start_at(double time) const noexcept { return start + time * start_motion; }
    Vec3 chord_at(double time) const noexcept { return end - start + time * (end_motion - start_motion); }
};

/// Distance of two moving segments at a time in [0, 1] [length].
inline SegmentDistance segment_distance(const MovingSegment& a, const MovingSegment& b, double time) {
    return segment_distance(a.start_at(time), a.chord_at(time), b.start_at(time), b.chord_at(time));
}

/// Greatest relative motion of any point of one against any of the other: it is bilinear in their places, so greatest at ends
/// [length].
inline double relative_motion(const MovingSegment& a, const MovingSegment& b) noexcept {
    return std::sqrt(std::max({(a.start_motion - b.start_motion).squaredNorm(), (a.start_motion - b.end_motion).squaredNorm(),
                               (a.end_motion - b.start_motion).squaredNorm(), (a.end_motion - b.end_motion).squaredNorm()}));
}

/// Where two moving segments are at the first time at which they are as close as asked.
struct Approach {
    bool close = false;
    double time = 0.0;        ///< in [0, 1]
    double s = 0.0, t = 0.0;  ///< closest points then
    double distance = 0.0;    ///< then [length]
};

/// First time at which two moving segments are closer than `near`, or, where excused(s, t) says so of their closest points, than
/// `nearest`. Conservative advancement (Mirtich, Impulse-based dynamic simulation of rigid body systems, 1996): a distance
/// shrinks no faster than the relative motion, so no approach is stepped over, be the segments parallel, crossing or in one
/// plane.
/// @param near     [length], > 0       @param nearest  [length], in (0, near]
template <class Excused>
Approach first_approach(const MovingSegment& a, const MovingSegment& b, double near, double nearest, const Excused& excused) {
    constexpr double slack = 0.02;  // of the distance that is asked for, which need not be met to the last digit
    constexpr int most = 100000;    // steps: beyond, the two are taken for close
    const double motion = relative_motion(a, b);
    Approach at;
    for (int step = 0; step < most; ++step) {
        const SegmentDistance closest = segment_distance(a, b, at.time);
        at.distance = std::sqrt(closest.squared), at.s = closest.s, at.t = closest.t;
        double bound = near;
        if (at.distance <= (1.0 + slack) * near) {
            bound = nearest;
            if (at.distance <= (1.0 + slack) * nearest || !excused(at.s, at.t)) return at.close = true, at;
        }
        if (at.time >= 1.0) return at;
        if (!(at.distance - bound < (1.0 - at.time) * motion)) return at;  // neither will it be
        at.time = std::min(1.0, at.time + (at.distance - bound) / motion);
    }
    return at.close = true, at;
}

/// Tree of boxes that move with what is in them, over segments: which pairs may come close during the motion. What moves
/// together, however far, costs no more than what stands still.
class MovingTree {
public:
    /// @param margins  around each segment: pairs are found that come closer than the sum of their two [length]
    MovingTree(std::span<const MovingSegment> segments, std::span<const double> margins) : order_(segments.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        boxes_.reserve(segments.size());
        for (std::size_t k = 0; k < segments.size(); ++k) boxes_.emplace_back(segments[k], margins[k]);
        if (!segments.empty()) build(0, static_cast<std::int32_t>(segments.size()));
    }

    /// Calls visit(task, k, l) once for each two segments k < l whose moving boxes meet; tasks are run on all threads and
    /// numbered in an order that the data alone give, from 0 below `tasks()`.
    template <class Visit>
    void visit_pairs(const Visit& visit) const {
        core::parallel_for<core::Share::turns>(core::count(tasks_), [&](Index n) {
            std::vector<Pair> stack{tasks_[core::at(n)]};
            while (!stack.empty()) {
                const Pair pair = stack.back();
                stack.pop_back();
                if (leaf(pair))
                    visit_leaves(n, pair, visit);
                else
                    split(pair, stack);
            }
        });
    }
    /// To be called before visit_pairs. @returns how many tasks there are
    Index make_tasks() {
        tasks_.clear();
        if (nodes_.empty()) return 0;
        tasks_.push_back({0, 0});
        for (bool more = true; more && core::count(tasks_) < wanted_tasks;) {
            std::vector<Pair> next;
            more = false;
            for (const Pair& pair : tasks_) {
                if (leaf(pair))
                    next.push_back(pair);
                else
                    split(pair, next), more = true;
            }
            tasks_.swap(next);
        }
        return core::count(tasks_);
    }

private:
    static constexpr std::int32_t leaf_size = 4;
    static constexpr Index wanted_tasks = 64;

    /// Bounds at time 0 and at time 1; those between are on straight lines, since what is in it moves on such.
    struct Box {
        double low[2][3], high[2][3];
        Box(const MovingSegment& segment, double margin) noexcept {
            const Vec3 end = segment.start + segment.start_motion, other = segment.end + segment.end_motion;
            for (int axis = 0; axis < 3; ++axis) {
                low[0][axis] = std::min(segment.start[axis], segment.end[axis]) - margin;
                high[0][axis] = std::max(segment.start[axis], segment.end[axis]) + margin;
                low[1][axis] = std::min(end[axis], other[axis]) - margin;
                high[1][axis] = std::max(end[axis], other[axis]) + margin;
            }
        }
        void add(const Box& other) noexcept {
            for (int time = 0; time < 2; ++time)
                for (int axis = 0; axis < 3; ++axis) {
                    low[time][axis] = std::min(low[time][axis], other.low[time][axis]);
                    high[time][axis] = std::max(high[time][axis], other.high[time][axis]);
                }
        }
        /// Do they overlap at any time?
        bool meets(const Box& other) const noexcept {
            double from = 0.0, to = 1.0;
            for (int axis = 0; axis < 3; ++axis) {
                cut(high[0][axis] - other.low[0][axis], high[1][axis] - other.low[1][axis], from, to);
                cut(other.high[0][axis] - low[0][axis], other.high[1][axis] - low[1][axis], from, to);
            }
            return from <= to;
        }
        double middle(int axis) const noexcept { return low[0][axis] + high[0][axis] + low[1][axis] + high[1][axis]; }

    private:
        /// Keeps the times at which a quantity that goes evenly from `first` to `last` is not negative.
        static void cut(double first, double last, double& from, double& to) noexcept {
            constexpr double rounding = 1e-12;
            if (first >= 0.0 && last >= 0.0) return;
            if (first < 0.0 && last < 0.0) {
                to = -1.0;
                return;
            }
            const double time = first / (first - last);
            if (first < 0.0)
                from = std::max(from, time - rounding);
            else
                to = std::min(to, time + rounding);
        }
    };
    struct Node {
        Box box;
        std::int32_t first, last;  // places in order_
        std::int32_t left = -1, right = -1;
    };
    struct Pair {
        std::int32_t a, b;
    };

    std::int32_t build(std::int32_t first, std::int32_t last) {
        Box box = boxes_[core::at(order_[core::at(first)])];
        double low[3], high[3];
        for (int axis = 0; axis < 3; ++axis) low[axis] = high[axis] = box.middle(axis);
        for (std::int32_t k = first + 1; k < last; ++k) {
            const Box& other = boxes_[core::at(order_[core::at(k)])];
            box.add(other);
            for (int axis = 0; axis < 3; ++axis)
                low[axis] = std::min(low[axis], other.middle(axis)), high[axis] = std::max(high[axis], other.middle(axis));
        }
        const auto number = static_cast<std::int32_t>(nodes_.size());
        nodes_.push_back({box, first, last});
        if (last - first <= leaf_size) return number;
        int axis = 0;
        for (int other = 1; other < 3; ++other)
            if (high[other] - low[other] > high[axis] - low[axis]) axis = other;
        const std::int32_t middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last,
                         [&](std::int32_t a, std::int32_t b) {
                             const double x = boxes_[core::at(a)].middle(axis), y = boxes_[core::at(b)].middle(axis);
                             return x != y ? x < y : a < b;
                         });
        const std::int32_t left = build(first, middle);
        nodes_[core::at(number)].left = left;
        const std::int32_t right = build(middle, last);
        nodes_[core::at(number)].right = right;
        return number;
    }

    bool leaf(const Pair& pair) const noexcept { return nodes_[core::at(pair.a)].left < 0 && nodes_[core::at(pair.b)].left < 0; }

    /// Pairs of children that meet.
    void split(const Pair& pair, std::vector<Pair>& out) const {
        const Node &a = nodes_[core::at(pair.a)], &b = nodes_[core::at(pair.b)];
        const auto keep = [&](std::int32_t p, std::int32_t q) {
            if (p == q || nodes_[core::at(p)].box.meets(nodes_[core::at(q)].box)) out.push_back({p, q});
        };
        if (pair.a == pair.b) {
            keep(a.left, a.left), keep(a.left, a.right), keep(a.right, a.right);
        } else if (a.left >= 0 && (b.left < 0 || a.last - a.first >= b.last - b.first)) {
            keep(a.left, pair.b), keep(a.right, pair.b);
        } else {
            keep(pair.a, b.left), keep(pair.a, b.right);
        }
    }

    template <class Visit>
    void visit_leaves(Index task, const Pair& pair, const Visit& visit) const {
        const Node &a = nodes_[core::at(pair.a)], &b = nodes_[core::at(pair.b)];
        for (std::int32_t p = a.first; p < a.last; ++p)
            for (std::int32_t q = pair.a == pair.b ? p + 1 : b.first; q < b.last; ++q) {
                const std::int32_t k = order_[core::at(p)], l = order_[core::at(q)];
                if (boxes_[core::at(k)].meets(boxes_[core::at(l)])) visit(task, std::min(k, l), std::max(k, l));
            }
    }

    std::vector<std::int32_t> order_;
    std::vector<Box> boxes_;  // of the segments
    std::vector<Node> nodes_;
    std::vector<Pair> tasks_;
};

}  // namespace fibrant::proximity

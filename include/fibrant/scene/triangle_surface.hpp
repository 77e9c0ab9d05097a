// SPDX-License-Identifier: MIT
#pragma once
/// @file A closed surface of triangles, such as a mould or a punch from a CAD program, and the distance of a point from it.

#include <fibrant/scene/places.hpp>
#include <fibrant/scene/tool_surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::scene {

/// A solid body that triangles enclose. Its distance is exact: triangles are found in a tree of boxes, in a time that grows with
/// the logarithm of their number, and the side is told by the pseudonormal of the face, edge or corner that is nearest
/// (Baerentzen and Aanaes, IEEE Transactions on Visualization and Computer Graphics 11, 2005).
///
/// Triangles stand for a smooth surface as a polygon stands for a circle. A fibre feels their edges where they are longer than
/// its radius; the surface is off by a quarter of their length times the angle at their edges.
class TriangleSurface : public ToolSurface {
public:
    using Triangle = std::array<std::uint32_t, 3>;

    /// @param corners    [length]
    /// @param triangles  numbers of corners, all anticlockwise or all clockwise as seen from outside; those of fewer than three
    ///                   different corners are left out
    /// @throws std::invalid_argument for corners that are not finite, numbers without a corner, triangles without an area, and
    ///         edges that do not belong to exactly two triangles: the surface would not be closed
    TriangleSurface(std::vector<Vec3> corners, std::vector<Triangle> triangles)
        : corners_{std::move(corners)}, triangles_{std::move(triangles)} {
        check_corners();
        find_normals();
        close_edges();
        turn_outwards();
        grow_tree();
    }

    const std::vector<Vec3>& corners() const noexcept { return corners_; }
    const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
    double volume() const noexcept { return volume_; }  ///< [length^3], > 0

    ToolDistance distance(const Vec3& x) const override {
        Nearest best;
        std::array<std::int32_t, 64> open;  // of a tree that halves: its depth is below 40 for 2^32 triangles
        std::size_t waiting = 0;
        open[waiting++] = 0;
        while (waiting > 0) {
            const Box& box = boxes_[core::at(open[--waiting])];
            if (box.squared(x) >= best.squared) continue;
            if (box.count > 0) {
                for (std::int32_t k = box.first; k < box.first + box.count; ++k) see(order_[core::at(k)], x, best);
                continue;
            }
            const Box &left = boxes_[core::at(box.first)], &right = boxes_[core::at(box.first + 1)];
            const bool left_first = left.squared(x) <= right.squared(x);  // the nearer one is seen first
            open[waiting++] = box.first + (left_first ? 1 : 0);
            open[waiting++] = box.first + (left_first ? 0 : 1);
        }
        const Vec3 out = pseudonormal(best), arm = x - best.place;
        const double length = arm.norm(), side = arm.dot(out) < 0.0 ? -1.0 : 1.0;
        // On the surface itself the arm has no direction.
        if (length <= rounding * size_) return {side * length, out.normalized()};
        return {side * length, side / length * arm};
    }

private:
    static constexpr double rounding = 8.0 * std::numeric_limits<double>::epsilon();  // of places, over the size of the body
    static constexpr std::int32_t leaf = 4;                                           // triangles of a box that is not halved

    struct Nearest {
        double squared = std::numeric_limits<double>::infinity();
        Vec3 place = Vec3::Zero();
        std::uint32_t triangle = 0;
        int part = 6;  // corner 0 to 2, edge 3 to 5 from corner part - 3 to the next, 6: the face
    };
    struct Box {
        Vec3 low, high;
        std::int32_t first = 0, count = 0;  // of the order; without a count the first of both halves
        double squared(const Vec3& x) const noexcept {
            double sum = 0.0;
            for (Index k = 0; k < 3; ++k) {
                const double beyond = std::max({low[k] - x[k], x[k] - high[k], 0.0});
                sum += beyond * beyond;
            }
            return sum;
        }
    };
    const Vec3& corner(std::size_t triangle, int k) const noexcept { return corners_[triangles_[triangle][core::at(k % 3)]]; }

    void check_corners() {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
        for (const Vec3& one : corners_) {
            if (!one.allFinite()) core::refuse("TriangleSurface.corners", text(one), "finite");
            low = low.cwiseMin(one), high = high.cwiseMax(one);
        }
        std::erase_if(triangles_, [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
        if (triangles_.empty()) core::refuse("TriangleSurface.triangles", "none", "four at least");
        for (const Triangle& t : triangles_)
            for (const std::uint32_t k : t)
                core::require(k < corners_.size(), "TriangleSurface.triangles: corner", static_cast<double>(k),
                              "below their number, " + std::to_string(corners_.size()));
        size_ = (high - low).norm();
    }
    void find_normals() {
        at_corner_.assign(corners_.size(), Vec3::Zero());
        for (std::size_t t = 0; t < triangles_.size(); ++t) {
            const Vec3 a = corner(t, 1) - corner(t, 0), b = corner(t, 2) - corner(t, 0), area = a.cross(b);
            const double twice = area.norm(), longest = std::max({a.norm(), b.norm(), (b - a).norm()});
            if (!(twice > rounding * size_ * longest))
                core::refuse("TriangleSurface.triangles: area of triangle " + std::to_string(t), core::text(0.5 * twice),
                             "> 0: its corners are on one line, at " + text(corner(t, 0)));
            face_.push_back(area / twice);
            for (int k = 0; k < 3; ++k) {
                const Vec3 to = corner(t, k + 1) - corner(t, k), from = corner(t, k + 2) - corner(t, k);
                at_corner_[triangles_[t][core::at(k)]] += std::atan2(to.cross(from).norm(), to.dot(from)) * face_[t];
            }
        }
    }
    /// Finds the other triangle of each edge. Each way along an edge belongs to one triangle, and the other way to another.
    void close_edges() {
        struct Way {
            std::uint32_t low, high, triangle;
            int edge;
            bool forth;
        };
        std::vector<Way> ways;
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            for (int k = 0; k < 3; ++k) {
                const std::uint32_t a = triangles_[t][core::at(k)], b = triangles_[t][core::at((k + 1) % 3)];
                ways.push_back({std::min(a, b), std::max(a, b), static_cast<std::uint32_t>(t), k, a < b});
            }
        std::sort(ways.begin(), ways.end(), [](const Way& a, const Way& b) {
            return std::pair(a.low, a.high) < std::pair(b.low, b.high) ||
                   (a.low == b.low && a.high == b.high && a.triangle < b.triangle);
        });
        at_edge_.assign(triangles_.size(), {});
        for (std::size_t k = 0; k < ways.size();) {
            std::size_t last = k;
            while (last < ways.size() && ways[last].low == ways[k].low && ways[last].high == ways[k].high) ++last;
            if (last - k != 2 || ways[k].forth == ways[k + 1].forth)
                core::refuse(
                    "TriangleSurface.triangles: edge from " + text(corners_[ways[k].low]) + " to " + text(corners_[ways[k].high]),
                    last - k == 2 ? "of two triangles that turn against each other"
                                  : "of " + std::to_string(last - k) + (last - k == 1 ? " triangle" : " triangles"),
                    "of two that turn alike: the surface of a solid body is closed");
            for (const std::size_t one : {k, k + 1})
                at_edge_[ways[one].triangle][core::at(ways[one].edge)] = face_[ways[k].triangle] + face_[ways[k + 1].triangle];
            k = last;
        }
    }
    void turn_outwards() {
        const Vec3 middle = corners_[triangles_.front()[0]];
        for (std::size_t t = 0; t < triangles_.size(); ++t)
            volume_ += (corner(t, 0) - middle).dot((corner(t, 1) - middle).cross(corner(t, 2) - middle)) / 6.0;
        if (!(std::abs(volume_) > rounding * size_ * size_ * size_))
            core::refuse("TriangleSurface.triangles: volume", core::text(volume_), "that of a solid body, not 0");
        if (volume_ > 0.0) return;
        volume_ = -volume_;
        for (Triangle& t : triangles_) std::swap(t[1], t[2]);
        for (Vec3& normal : face_) normal = -normal;
        for (Vec3& normal : at_corner_) normal = -normal;
        for (auto& edges : at_edge_) {
            for (Vec3& normal : edges) normal = -normal;
            std::swap(edges[0], edges[2]);  // a b, b c, c a become a c, c b, b a
        }
    }
    void grow_tree() {
        order_.resize(triangles_.size());
        std::iota(order_.begin(), order_.end(), 0u);
        boxes_.push_back({});
        grow(0, 0, static_cast<std::int32_t>(order_.size()));
    }
    void grow(std::size_t own, std::int32_t first, std::int32_t last) {
        Box box{Vec3::Constant(std::numeric_limits<double>::infinity()), Vec3::Constant(-std::numeric_limits<double>::infinity()),
                first, last - first};
        for (std::int32_t k = first; k < last; ++k)
            for (int c = 0; c < 3; ++c) {
                const Vec3& x = corner(order_[core::at(k)], c);
                box.low = box.low.cwiseMin(x), box.high = box.high.cwiseMax(x);
            }
        if (last - first > leaf) {
            Index axis = 0;
            (box.high - box.low).maxCoeff(&axis);
            const auto place = [&](std::uint32_t t) { return corner(t, 0)[axis] + corner(t, 1)[axis] + corner(t, 2)[axis]; };
            const std::int32_t half = first + (last - first) / 2;
            std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                             [&](std::uint32_t a, std::uint32_t b) { return std::pair(place(a), a) < std::pair(place(b), b); });
            box.first = static_cast<std::int32_t>(boxes_.size()), box.count = 0;
            boxes_.resize(boxes_.size() + 2);
            grow(core::at(box.first), first, half), grow(core::at(box.first + 1), half, last);
        }
        boxes_[own] = box;
    }

    /// The point of a triangle that is nearest (Ericson, Real-Time Collision Detection, 2005, 5.1.5).
    void see(std::uint32_t t, const Vec3& x, Nearest& best) const {
        const Vec3 &a = corner(t, 0), &b = corner(t, 1), &c = corner(t, 2);
        const Vec3 ab = b - a, ac = c - a, ax = x - a, bx = x - b, cx = x - c;
        const auto take = [&](const Vec3& place, int part) {
            const double squared = (x - place).squaredNorm();
            if (squared < best.squared || (squared == best.squared && t < best.triangle)) best = {squared, place, t, part};
        };
        const double d1 = ab.dot(ax), d2 = ac.dot(ax);
        if (d1 <= 0.0 && d2 <= 0.0) return take(a, 0);
        const double d3 = ab.dot(bx), d4 = ac.dot(bx);
        if (d3 >= 0.0 && d4 <= d3) return take(b, 1);
        const double vc = d1 * d4 - d3 * d2;
        if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return take(a + d1 / (d1 - d3) * ab, 3);
        const double d5 = ab.dot(cx), d6 = ac.dot(cx);
        if (d6 >= 0.0 && d5 <= d6) return take(c, 2);
        const double vb = d5 * d2 - d1 * d6;
        if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return take(a + d2 / (d2 - d6) * ac, 5);
        const double va = d3 * d6 - d5 * d4;
        if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return take(b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), 4);
        const double whole = 1.0 / (va + vb + vc);
        take(a + vb * whole * ab + vc * whole * ac, 6);
    }
    Vec3 pseudonormal(const Nearest& at) const {
        if (at.part < 3) return at_corner_[triangles_[at.triangle][core::at(at.part)]];
        if (at.part < 6) return at_edge_[at.triangle][core::at(at.part - 3)];
        return face_[at.triangle];
    }

    std::vector<Vec3> corners_;
    std::vector<Triangle> triangles_;
    double size_ = 0.0, volume_ = 0.0;
    std::vector<Vec3> face_, at_corner_;        // unit; sums of faces by their angles
    std::vector<std::array<Vec3, 3>> at_edge_;  // of each triangle: sums of both faces
    std::vector<std::uint32_t> order_;          // triangles, box by box
    std::vector<Box> boxes_;
};

}  // namespace fibrant::scene

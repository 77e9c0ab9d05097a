// SPDX-License-Identifier: MIT
#pragma once
/// @file The search by nanoflann's kd-tree: a reference and a peer for the grid. Only this header includes nanoflann.

#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/zones.hpp>

#include <nanoflann.hpp>

#include <array>
#include <memory>
#include <utility>

namespace fibrant::proximity {
namespace detail {

/// Middles of segments, as nanoflann reads them.
struct MiddlePoints {
    std::vector<Plain3> points;
    std::size_t kdtree_get_point_count() const noexcept { return points.size(); }
    double kdtree_get_pt(std::size_t k, std::size_t axis) const noexcept {
        const Plain3& p = points[k];
        return axis == 0 ? p.x : axis == 1 ? p.y : p.z;
    }
    template <class Bounds>
    bool kdtree_get_bbox(Bounds&) const noexcept {
        return false;
    }
};

/// Result set of a range search that keeps the points and not their distances.
class PointsInRange {
public:
    using DistanceType = double;
    PointsInRange(double squared_radius, std::vector<std::int32_t>& found) : radius_(squared_radius), found_(found) {}
    bool full() const noexcept { return true; }
    bool addPoint(double squared, std::size_t k) {
        if (squared < radius_) found_.push_back(static_cast<std::int32_t>(k));
        return true;
    }
    double worstDist() const noexcept { return radius_; }

private:
    double radius_;
    std::vector<std::int32_t>& found_;
};

/// Static kd-tree over points.
class PointTree {
public:
    explicit PointTree(std::vector<Plain3> points)
        : points_{std::move(points)}, tree_(3, points_, nanoflann::KDTreeSingleIndexAdaptorParams(leaf)) {
        tree_.buildIndex();
    }
    PointTree(const PointTree&) = delete;
    PointTree& operator=(const PointTree&) = delete;

    /// Appends the points closer than `radius` to x; the same ones for any order of the tree, in the order of the tree.
    void within(const Plain3& x, double radius, std::vector<std::int32_t>& found) const {
        const double query[3] = {x.x, x.y, x.z};
        PointsInRange range(radius * radius, found);
        tree_.findNeighbors(range, query, nanoflann::SearchParams());
    }
    std::size_t size() const noexcept { return points_.points.size(); }

private:
    static constexpr std::size_t leaf = 20;
    using Tree =
        nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<double, MiddlePoints>, MiddlePoints, 3, std::int32_t>;
    MiddlePoints points_;
    Tree tree_;
};

}  // namespace detail

/// Static kd-tree over the middles of segments, searched within half lengths + threshold of each segment.
///
/// The radius of a search must hold the half length of the *other* segment too, so segments stand in classes of length, each
/// within a factor of 2 and with a tree of its own: one long segment does not widen the searches of all others.
class KdTreeSearch {
public:
    using Parameters = core::NoParameters;
    explicit KdTreeSearch(const Parameters& = {}) {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) const {
        const detail::SegmentTable table(fibres, reach);
        if (table.size() == 0) return {};
        const std::vector<detail::SegmentRecord> records = table.records();
        const std::vector<Class> classes = classified(records, reach);
        constexpr Index block = 512;
        std::vector<std::vector<SegmentPair>> part(core::at((table.size() + block - 1) / block));
        core::parallel_for(core::count(part), [&](Index b) {
            std::vector<std::int32_t> found;
            std::vector<detail::Candidate> candidates;
            for (Index k = b * block; k < std::min<Index>(table.size(), (b + 1) * block); ++k) {
                const auto i = static_cast<std::int32_t>(k);
                const detail::Plain3 middle = middle_of(records[core::at(k)]);
                const double own = ball(records[core::at(k)], reach);
                candidates.clear();
                for (const Class& some : classes) {
                    found.clear();
                    some.tree->within(middle, (own + some.ball) * (1.0 + 1.0e-12), found);
                    for (const std::int32_t f : found)
                        if (some.segments[core::at(f)] > i) candidates.push_back({i, some.segments[core::at(f)]});
                }
                std::sort(candidates.begin(), candidates.end(),
                          [](const detail::Candidate& a, const detail::Candidate& c) { return a.b < c.b; });
                detail::keep_close(table, records.data(), candidates, part[core::at(b)]);
            }
        });
        std::vector<SegmentPair> all;
        core::join(part, all);
        return all;
    }

    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) const {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }

private:
    struct Class {
        std::vector<std::int32_t> segments;
        std::unique_ptr<detail::PointTree> tree;
        double ball = 0.0;  // the largest of its segments
    };

    static detail::Plain3 middle_of(const detail::SegmentRecord& r) noexcept {
        return {r.start.x + 0.5 * r.chord.x, r.start.y + 0.5 * r.chord.y, r.start.z + 0.5 * r.chord.z};
    }
    /// Radius of the ball around the middle that holds the segment and half of its threshold.
    static double ball(const detail::SegmentRecord& record, double reach) noexcept {
        return 0.5 * std::sqrt(detail::dot(record.chord, record.chord)) + record.half + 0.5 * reach;
    }

    static std::vector<Class> classified(const std::vector<detail::SegmentRecord>& records, double reach) {
        double largest = 0.0;
        for (const auto& record : records) largest = std::max(largest, ball(record, reach));
        std::array<Class, 24> by_size;  // halving from the largest; the last holds all that are smaller
        std::array<std::vector<detail::Plain3>, by_size.size()> middles;
        for (const auto& record : records) {
            const double size = ball(record, reach);
            const std::size_t c = core::at(std::clamp(std::ilogb(largest) - std::ilogb(size), 0, 23));
            by_size[c].segments.push_back(record.segment);
            by_size[c].ball = std::max(by_size[c].ball, size);
            middles[c].push_back(middle_of(record));
        }
        std::vector<Class> classes;
        for (std::size_t c = 0; c < by_size.size(); ++c)
            if (!by_size[c].segments.empty()) {
                by_size[c].tree = std::make_unique<detail::PointTree>(std::move(middles[c]));
                classes.push_back(std::move(by_size[c]));
            }
        return classes;
    }
};
static_assert(ProximitySearch<KdTreeSearch>);

}  // namespace fibrant::proximity

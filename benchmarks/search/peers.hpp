// SPDX-License-Identifier: MIT
#pragma once
/// @file Searches of other libraries, each as one would write it by hand, with the filter of ours: nanoflann, and, where the
/// build found them, Boost's R-tree, CGAL's intersection of boxes and FCL's dynamic tree. Their pairs are neither sorted nor
/// joined.

#include "measure.hpp"

#include <fibrant/proximity/kd_tree_search.hpp>

#if defined(FIBRANT_BENCHMARK_BOOST)
#include <boost/geometry/geometries/box.hpp>
#include <boost/geometry/geometries/point.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <boost/iterator/function_output_iterator.hpp>
#endif
#if defined(FIBRANT_BENCHMARK_CGAL)
#include <CGAL/Box_intersection_d/Box_with_handle_d.h>
#include <CGAL/box_intersection_d.h>
#endif
#if defined(FIBRANT_BENCHMARK_FCL)
#include <fcl/broadphase/broadphase_dynamic_AABB_tree_array.h>
#include <fcl/geometry/shape/box.h>

#include <memory>
#endif

#include <utility>

namespace fibrant::benchmarks {

/// nanoflann's static kd-tree over the middles of segments, leaves of 20, every search wide enough for the longest segment; what
/// it finds goes to the filter where the balls around both segments meet, as a careful user would have it.
inline Call nanoflann_pairs(std::span<const proximity::Centreline> fibres, double reach) {
    using namespace proximity::detail;
    const SegmentTable table(fibres, reach);
    const std::vector<SegmentRecord> records = table.records();
    std::vector<Plain3> middles;
    middles.reserve(records.size());
    std::vector<double> ball;  // radius around the middle
    ball.reserve(records.size());
    for (const SegmentRecord& r : records) {
        middles.push_back({r.start.x + 0.5 * r.chord.x, r.start.y + 0.5 * r.chord.y, r.start.z + 0.5 * r.chord.z});
        ball.push_back((0.5 * std::sqrt(dot(r.chord, r.chord)) + r.half) * (1.0 + 1e-12));
    }
    const double longest = ball.empty() ? 0.0 : *std::max_element(ball.begin(), ball.end());
    const PointTree tree(middles);
    Call call{.built = time_now()};
    std::vector<std::int32_t> found;
    std::vector<Candidate> candidates;
    for (const SegmentRecord& r : records) {
        found.clear();
        candidates.clear();
        const Plain3& middle = middles[core::at(r.segment)];
        const double own = ball[core::at(r.segment)] + reach * (1.0 + 1e-12);
        tree.within(middle, own + longest, found);
        for (const std::int32_t f : found) {
            if (f <= r.segment) continue;
            const Plain3 apart = middles[core::at(f)] - middle;
            const double bound = own + ball[core::at(f)];
            if (dot(apart, apart) <= bound * bound) candidates.push_back({r.segment, f});
        }
        keep_close(table, records.data(), candidates, call.pairs);
    }
    return call;
}

#if defined(FIBRANT_BENCHMARK_BOOST) || defined(FIBRANT_BENCHMARK_CGAL) || defined(FIBRANT_BENCHMARK_FCL)
namespace detail {

/// Lower and upper corner of a segment, widened by half its threshold.
inline std::pair<Vec3, Vec3> corners(const proximity::detail::SegmentRecord& r, double reach) {
    const Vec3 start(r.start.x, r.start.y, r.start.z), end = start + Vec3(r.chord.x, r.chord.y, r.chord.z);
    const Vec3 wide = Vec3::Constant((r.half + 0.5 * reach) * (1.0 + 1e-12));
    return {start.cwiseMin(end) - wide, start.cwiseMax(end) + wide};
}

}  // namespace detail
#endif

#if defined(FIBRANT_BENCHMARK_BOOST)
/// Boost's R-tree, packed, 8 boxes a node.
inline Call boost_pairs(std::span<const proximity::Centreline> fibres, double reach) {
    namespace geometry = boost::geometry;
    using namespace proximity::detail;
    using Point = geometry::model::point<double, 3, geometry::cs::cartesian>;
    using Entry = std::pair<geometry::model::box<Point>, std::int32_t>;
    const SegmentTable table(fibres, reach);
    const std::vector<SegmentRecord> records = table.records();
    std::vector<Entry> entries;
    for (const SegmentRecord& r : records) {
        const auto [low, high] = detail::corners(r, reach);
        entries.push_back({{Point(low[0], low[1], low[2]), Point(high[0], high[1], high[2])}, r.segment});
    }
    const geometry::index::rtree<Entry, geometry::index::quadratic<8>> tree(entries.begin(), entries.end());
    Call call{.built = time_now()};
    std::vector<Candidate> candidates;
    for (const Entry& entry : entries) {
        candidates.clear();
        tree.query(geometry::index::intersects(entry.first), boost::make_function_output_iterator([&](const Entry& other) {
                       if (other.second > entry.second) candidates.push_back({entry.second, other.second});
                   }));
        keep_close(table, records.data(), candidates, call.pairs);
    }
    return call;
}
#endif

#if defined(FIBRANT_BENCHMARK_CGAL)
/// CGAL's hybrid of segment trees and scans, cutoff 500.
inline Call cgal_pairs(std::span<const proximity::Centreline> fibres, double reach) {
    using namespace proximity::detail;
    using Entry = CGAL::Box_intersection_d::Box_with_handle_d<double, 3, const SegmentRecord*>;
    const SegmentTable table(fibres, reach);
    const std::vector<SegmentRecord> records = table.records();
    std::vector<Entry> entries;
    for (const SegmentRecord& r : records) {
        auto [low, high] = detail::corners(r, reach);
        entries.emplace_back(low.data(), high.data(), &r);
    }
    Call call;
    std::vector<Candidate> candidates;
    CGAL::box_self_intersection_d(
        entries.begin(), entries.end(),
        [&](const Entry& a, const Entry& b) {
            candidates.push_back({a.handle()->segment, b.handle()->segment});
            if (candidates.size() < 4096) return;
            keep_close(table, records.data(), candidates, call.pairs);
            candidates.clear();
        },
        std::ptrdiff_t{500});
    keep_close(table, records.data(), candidates, call.pairs);
    return call;
}
#endif

#if defined(FIBRANT_BENCHMARK_FCL)
/// FCL's dynamic tree of boxes in arrays. Its objects are boxes that are not turned, so that the tree has them as they are.
inline Call fcl_pairs(std::span<const proximity::Centreline> fibres, double reach) {
    using namespace proximity::detail;
    const SegmentTable table(fibres, reach);
    const std::vector<SegmentRecord> records = table.records();
    std::vector<std::unique_ptr<fcl::CollisionObjectd>> boxes;
    std::vector<fcl::CollisionObjectd*> objects;
    for (const SegmentRecord& r : records) {
        const auto [low, high] = detail::corners(r, reach);
        boxes.push_back(std::make_unique<fcl::CollisionObjectd>(std::make_shared<fcl::Boxd>(high - low), Mat3::Identity(),
                                                                0.5 * (low + high)));
        boxes.back()->setUserData(const_cast<SegmentRecord*>(&r));
        objects.push_back(boxes.back().get());
    }
    fcl::DynamicAABBTreeCollisionManager_Arrayd tree;
    tree.registerObjects(objects);
    tree.setup();
    struct Search {
        const SegmentTable& table;
        const std::vector<SegmentRecord>& records;
        std::vector<Candidate> candidates{};
        Call call{.built = time_now()};
        void keep() { keep_close(table, records.data(), candidates, call.pairs), candidates.clear(); }
    } search{table, records};
    tree.collide(&search, [](fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* data) {
        const auto segment = [](const fcl::CollisionObjectd* object) {
            return static_cast<const SegmentRecord*>(object->getUserData())->segment;
        };
        auto& to = *static_cast<Search*>(data);
        to.candidates.push_back({std::min(segment(a), segment(b)), std::max(segment(a), segment(b))});
        if (to.candidates.size() >= 4096) to.keep();
        return false;  // go on
    });
    search.keep();
    return std::move(search.call);
}
#endif

}  // namespace fibrant::benchmarks

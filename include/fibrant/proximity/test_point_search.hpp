// SPDX-License-Identifier: MIT
#pragma once
/// @file The search of the source: test points along the fibres, at the distance that makes it complete.

#include <fibrant/proximity/cell_grid.hpp>
#include <fibrant/proximity/sorted_pairs.hpp>
#include <fibrant/proximity/zones.hpp>

namespace fibrant::proximity {
namespace detail {

/// A point of a fibre, and the segments that hold all of the fibre for which it is the nearest such point.
struct TestPoint {
    Plain3 position;
    double range;              // largest radius + inflation of the fibre
    std::int32_t first, last;  // segments, both included
};

/// Takes pairs of boxes around test points to pairs of test points, and these to pairs of segments.
class TestPointSink {
public:
    TestPointSink(const SegmentTable& table, const SegmentRecord* records, const std::vector<TestPoint>& points, double spacing,
                  const CellGrid& grid, std::vector<SegmentPair>& close)
        : table_(table), records_(records), points_(points), spacing_(spacing), grid_(grid), close_(close) {}

    Candidate* room(std::int32_t n) {
        if (hits_.size() < core::at(n)) hits_.resize(core::at(n));
        return hits_.data();
    }
    void take(const Candidate* end) {
        for (const Candidate* hit = hits_.data(); hit != end; ++hit) {
            const TestPoint& a = points_[core::at(grid_.box(hit->a))];
            const TestPoint& b = points_[core::at(grid_.box(hit->b))];
            const Plain3 difference = a.position - b.position;
            const double closer = (a.range + b.range + table_.reach() + spacing_) * (1.0 + 1.0e-9);
            if (dot(difference, difference) >= closer * closer) continue;
            for (std::int32_t i = a.first; i <= a.last; ++i)
                for (std::int32_t j = b.first; j <= b.last; ++j)
                    if (i != j) candidates_.push_back({i, j});
            if (candidates_.size() > 4096) flush();
        }
    }
    void flush() {
        keep_close(table_, records_, candidates_, close_);
        candidates_.clear();
    }

private:
    const SegmentTable& table_;
    const SegmentRecord* records_;
    const std::vector<TestPoint>& points_;
    double spacing_;
    const CellGrid& grid_;
    std::vector<SegmentPair>& close_;
    std::vector<Candidate> hits_, candidates_;
};

}  // namespace detail

/// Test points every `spacing` of arc length (and at both ends); the segments around two points that are closer than
/// threshold + spacing are candidates, and the exact filter decides.
///
/// Durville, section 15.3.2, with one difference: there test points closer than the threshold itself make a zone, which loses
/// crossings between them. A point of a fibre has a test point within half a spacing, so threshold + spacing loses none.
class TestPointSearch {
public:
    struct Parameters {
        double spacing = core::unset;  ///< h, of the order of an element [length], > 0
        void validate() const { core::require_positive("TestPointSearch.spacing", spacing); }
    };
    explicit TestPointSearch(const Parameters& parameters) : parameters_{core::validated(parameters)} {}

    std::vector<SegmentPair> pairs(std::span<const Centreline> fibres, double reach) const {
        const detail::SegmentTable table(fibres, reach);
        const std::vector<detail::TestPoint> points = test_points(table);
        if (points.empty()) return {};
        const detail::BoxFrame frame(table);
        std::vector<detail::Box> boxes(points.size());
        std::vector<std::int32_t> all(points.size());
        for (std::size_t k = 0; k < points.size(); ++k) {
            const detail::SegmentRecord place{
                points[k].position, {0.0, 0.0, 0.0}, 0.0, points[k].first, table.record(points[k].first).group};
            boxes[k] = frame.box(place, 0.0, 1.0, points[k].range + 0.5 * (reach + parameters_.spacing));
            all[k] = static_cast<std::int32_t>(k);
            if (table.selfish()) boxes[k].group = all[k];
        }
        detail::CellGrid grid;
        grid.build(boxes, all);
        const std::vector<detail::SegmentRecord> records = table.records();
        constexpr std::int32_t together = 256;
        std::vector<std::vector<SegmentPair>> close(core::at((grid.cells() + together - 1) / together));
        core::parallel_for(core::count(close), [&](Index b) {
            detail::TestPointSink sink(table, records.data(), points, parameters_.spacing, grid, close[core::at(b)]);
            const auto first = static_cast<std::int32_t>(b * together);
            grid.overlaps_inside(first, std::min(grid.cells(), first + together), sink);
            sink.flush();
        });
        if (table.selfish()) {  // segments that share their nearest test point
            std::vector<detail::Candidate> candidates;
            for (const detail::TestPoint& point : points)
                for (std::int32_t i = point.first; i < point.last; ++i)
                    for (std::int32_t j = i + 1; j <= point.last; ++j) candidates.push_back({i, j});
            detail::keep_close(table, records.data(), candidates, close.emplace_back());
        }
        return detail::PairSorter{}.sorted(close, table.size(), true);
    }

    std::vector<ProximityZone> find(std::span<const Centreline> fibres, double reach) const {
        return zones_from_pairs(fibres, reach, pairs(fibres, reach));
    }

private:
    std::vector<detail::TestPoint> test_points(const detail::SegmentTable& table) const {
        std::vector<detail::TestPoint> points;
        std::vector<double> arc;
        for (std::int32_t f = 0; f < table.fibres(); ++f) {
            const Centreline& line = table.centreline(f);
            arc.assign(1, 0.0);
            for (std::size_t k = 1; k < line.points.size(); ++k)
                arc.push_back(arc.back() + (line.points[k] - line.points[k - 1]).norm());
            double range = line.radius;
            for (const double inflation : line.inflation) range = std::max(range, line.radius + inflation);
            const double intervals = std::max(1.0, std::ceil(arc.back() / parameters_.spacing));
            if (static_cast<double>(points.size()) + intervals > 2.0e9)
                core::refuse("TestPointSearch.spacing", core::text(parameters_.spacing), "large enough for 2e9 test points");
            const double step = arc.back() / intervals, about = 0.5 * step * (1.0 + 1.0e-9);
            const auto segments = static_cast<std::int32_t>(line.points.size()) - 1;
            std::int32_t first = 0, here = 0, last = 0;
            for (double n = 0.0; n <= intervals; n += 1.0) {
                const double s = n * step;
                const auto forward = [&](std::int32_t& k, double to) {  // the last segment that starts at or before `to`
                    while (k + 1 < segments && arc[core::at(k + 1)] <= to) ++k;
                };
                while (first + 1 < segments && arc[core::at(first + 1)] < s - about) ++first;
                forward(here, s);
                forward(last, s + about);
                const double length = arc[core::at(here + 1)] - arc[core::at(here)];
                const double t = length > 0.0 ? std::min(1.0, (s - arc[core::at(here)]) / length) : 0.0;
                const Vec3 x = (1.0 - t) * line.points[core::at(here)] + t * line.points[core::at(here + 1)];
                points.push_back({detail::plain(x), range, table.first(f) + first, table.first(f) + last});
            }
        }
        return points;
    }

    Parameters parameters_;
};
static_assert(ProximitySearch<TestPointSearch>);

}  // namespace fibrant::proximity

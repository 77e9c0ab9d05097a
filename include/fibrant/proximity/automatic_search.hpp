// SPDX-License-Identifier: MIT
#pragma once
/// @file A search that looks at the fibres and takes the grid or the tree.

#include <fibrant/proximity/bvh_search.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <algorithm>

namespace fibrant::proximity {

/// `BvhSearch` where any segments are much thicker than many others, and where they are long and lie along each other; else
/// `GridSearch`. It looks at the data at each call; both give the same pairs in the same order.
class AutomaticSearch : public detail::InTwoHalves<AutomaticSearch> {
public:
    using Parameters = core::NoParameters;
    explicit AutomaticSearch(const Parameters& = {}) {}

    /// @name The two halves of `pairs`, to be timed apart. The table must be the same.
    /// @{
    void build(const detail::SegmentTable& table) {
        tree_taken_ = wants_tree(table);
        tree_taken_ ? tree_.build(table) : grid_.build(table);
    }
    std::vector<SegmentPair> search(const detail::SegmentTable& table) {
        return tree_taken_ ? tree_.search(table) : grid_.search(table);
    }
    /// @}

    bool takes_tree() const noexcept { return tree_taken_; }  ///< at the last call
    /// Gives its memory back, which the next call takes anew.
    void release() { tree_.release(), grid_.release(); }
    /// Memory that is kept, without the pairs [byte].
    std::size_t bytes() const noexcept { return tree_.bytes() + grid_.bytes(); }

private:
    // From these on the tree was the faster one, in mixtures of fibres of two sizes and in straight bundles. One thick fibre
    // among 2,000 to 20,000 thin ones is enough; a few thin ones among thick ones cost a grid nothing.
    static constexpr double unequal = 4.0;   // thickness of two segments over each other
    static constexpr double several = 0.05;  // of all segments: as many are thin
    static constexpr double slender = 32.0;  // mean length over thickness
    static constexpr double aligned = 0.9;   // of the sum of lengths along one direction

    static bool wants_tree(const detail::SegmentTable& table) {
        std::vector<std::pair<double, double>> thickness;  // and number of segments, of each fibre
        double length = 0.0, wide = 0.0, all = 0.0;
        Mat3 directions = Mat3::Zero();
        for (std::int32_t f = 0; f < table.fibres(); ++f) {
            const Centreline& line = table.centreline(f);
            const auto segments = static_cast<double>(line.points.size() - 1);
            const double thick = 2.0 * line.radius + table.reach();
            thickness.emplace_back(thick, segments);
            // Ends say enough of fibres that are slender and straight, and too little of others, which are not asked for.
            const Vec3 chord = line.points.back() - line.points.front();
            const double span = chord.norm();
            if (span > 0.0) core::add_outer(chord, chord / span, directions);
            length += span, wide += segments * thick, all += segments;
        }
        if (all == 0.0) return false;
        if (length > slender * wide) {
            const core::SymmetricEigen<3> principal(directions);
            if (principal.values()[2] > aligned * principal.values().sum()) return true;
        }
        std::sort(thickness.begin(), thickness.end());
        double thin = 0.0;
        const auto first = std::find_if(thickness.begin(), thickness.end(),
                                        [&](const auto& fibre) { return (thin += fibre.second) >= several * all; });
        return thickness.back().first > unequal * first->first;
    }

    bool tree_taken_ = false;
    GridSearch grid_;
    BvhSearch tree_;
};
static_assert(ProximitySearch<AutomaticSearch>);

}  // namespace fibrant::proximity

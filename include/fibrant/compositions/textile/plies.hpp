// SPDX-License-Identifier: MIT
#pragma once
/// @file Layers of straight yarns in any directions, stitched through their thickness.

#include <fibrant/compositions/textile/interlaced.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Plies of parallel yarns on each other, and threads that go along x, over all plies for a stitch and under all of them for the
/// next.
///
/// Rows of stitches and the places where threads go through count from the middle of the sample, where no yarn lies: yarns of a
/// ply are at odd multiples of half their spacing from it.
struct StitchedPlies {
    std::vector<double> angles_deg{};    ///< of the yarns of each ply to x, from the lowest ply up [degree]
    double yarn_spacing = core::unset;   ///< of a ply, across its yarns [length], > 0
    double length = core::unset;         ///< of the sample along x [length], > 0
    double width = core::unset;          ///< and along y [length], > 0
    double stitch_length = core::unset;  ///< from one place where a thread goes through to the next [length], > 0
    double row_spacing = core::unset;    ///< of neighbouring threads [length], > 0
    double sideways = 0.0;      ///< by which threads go to and fro across from stitch to stitch [length], in [0, row_spacing]
    YarnType yarn{}, thread{};  ///< of the plies, and that stitches them

    void validate() const {
        if (angles_deg.empty()) core::refuse("StitchedPlies.angles_deg", "none", "at least one ply");
        for (const double angle : angles_deg) core::require_finite("StitchedPlies.angles_deg", angle);
        core::require_positive("StitchedPlies.length", length);
        core::require_positive("StitchedPlies.width", width);
        core::require_positive("StitchedPlies.stitch_length", stitch_length);
        core::require_positive("StitchedPlies.row_spacing", row_spacing);
        core::require(sideways >= 0.0 && sideways <= row_spacing, "StitchedPlies.sideways", sideways, "in [0, row_spacing]");
        yarn.validate(), thread.validate();
        const double room = 2.0 * (half_room(yarn) + half_room(thread));
        core::require(std::isfinite(yarn_spacing) && yarn_spacing >= room, "StitchedPlies.yarn_spacing", yarn_spacing,
                      ">= " + core::text(room) + ", for threads to pass between yarns");
        core::require(length >= 2.0 * stitch_length, "StitchedPlies.length", length, ">= two stitches");
        core::require(width >= row_spacing, "StitchedPlies.width", width, ">= row_spacing");
        constexpr double most = 10000.0;  // yarns of a ply, threads, stitches of a thread
        for (const auto& [field, extent] : {std::pair{"StitchedPlies.length", length}, {"StitchedPlies.width", width}})
            core::require(extent <= most * yarn_spacing, field, extent,
                          "<= " + core::text(most * yarn_spacing) + ", 10000 times yarn_spacing");
        core::require(stitch_length * most >= length, "StitchedPlies.stitch_length", stitch_length,
                      ">= " + core::text(length / most) + ", a ten thousandth of length");
        core::require(row_spacing * most >= width, "StitchedPlies.row_spacing", row_spacing,
                      ">= " + core::text(width / most) + ", a ten thousandth of width");
    }
    /// From one ply to the next: a twentieth more than their thickness [length].
    double pitch() const { return 2.1 * half_height(yarn); }
};

namespace detail {
/// As `stitched` says.
inline Textile drawn(const StitchedPlies& plies);

/// A place where a thread goes through a ply nearer to a yarn than both are thick.
struct Pierced {
    Index row = 0, ply = -1;  ///< of the thread, from the middle one; of the ply, -1: there is none
    double at = 0.0;          ///< along x [length]
    double off = 0.0;         ///< from the middle of the yarn [length]
};
/// Numbers of rows and of stitches on either side of the middle.
inline std::array<Index, 2> half_counts(const StitchedPlies& plies) {
    return {static_cast<Index>(std::floor(0.5 * plies.width / plies.row_spacing - 1e-9)),
            static_cast<Index>(std::floor(0.5 * plies.length / plies.stitch_length - 1e-9))};
}
/// How far a thread goes through beside its row [length].
inline double off_row(const StitchedPlies& plies, Index stitch) { return (stitch % 2 == 0 ? 0.5 : -0.5) * plies.sideways; }

inline Pierced first_pierced(const StitchedPlies& plies) {
    const double s = plies.yarn_spacing, reach = half_room(plies.yarn) + half_room(plies.thread);
    const std::array<Index, 2> half = half_counts(plies);
    for (Index row = -half[0]; row <= half[0]; ++row)
        for (Index m = -half[1]; m <= half[1]; ++m)
            for (std::size_t k = 0; k < plies.angles_deg.size(); ++k) {
                const double angle = plies.angles_deg[k] * std::numbers::pi / 180.0,
                             x = plies.stitch_length * static_cast<double>(m),
                             y = plies.row_spacing * static_cast<double>(row) + off_row(plies, m),
                             d = -std::sin(angle) * x + std::cos(angle) * y, off = std::abs(d / s - std::floor(d / s) - 0.5) * s;
                if (off < reach * (1.0 - 1e-9)) return {row, static_cast<Index>(k), x, off};
            }
    return {};
}

/// A number of three digits, which messages can say and users can write.
inline double three_digits(double value) {
    const double unit = std::pow(10.0, std::floor(std::log10(value)) - 2.0);
    return std::round(value / unit) * unit;
}

/// Refuses threads that would go through yarns, with a stitch, a distance of rows and a way aside near to those given that would
/// do, if there are any from half of them to twice as much.
inline void require_gaps(const StitchedPlies& given) {
    const Pierced pierced = first_pierced(given);
    if (pierced.ply < 0) return;
    constexpr Index steps = 100;             // each way, of each length
    constexpr std::size_t most_drawn = 100;  // that are looked at closely
    constexpr double most_places = 1e4;      // of threads: more would take too long
    std::vector<std::pair<Index, StitchedPlies>> fitting;
    if (4.0 * given.length / given.stitch_length * given.width / given.row_spacing <= most_places)
        for (Index a = -steps; a <= steps; ++a)
            for (Index b = -steps; b <= steps; ++b)
                for (const double aside : {given.sideways / given.row_spacing, 0.0, 0.5, 1.0}) {
                    const auto changed = [](double length, Index step) {
                        return three_digits(length * std::exp2(static_cast<double>(step) / static_cast<double>(steps)));
                    };
                    StitchedPlies other = given;
                    other.stitch_length = changed(given.stitch_length, a), other.row_spacing = changed(given.row_spacing, b);
                    other.sideways = aside > 0.0 ? three_digits(aside * other.row_spacing) : 0.0;
                    if (other.length >= 2.0 * other.stitch_length && other.width >= other.row_spacing &&
                        other.sideways <= other.row_spacing && first_pierced(other).ply < 0)
                        fitting.emplace_back(std::abs(a) + std::abs(b), other);
                }
    std::stable_sort(fitting.begin(), fitting.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::string others = "others";
    for (std::size_t k = 0; k < std::min(fitting.size(), most_drawn); ++k) {
        const StitchedPlies& other = fitting[k].second;
        try {
            require_holding(drawn(other));
        } catch (const std::invalid_argument&) {  // too bent, or it comes apart
            continue;
        }
        others +=
            ", as " + core::text(other.stitch_length) + ", " + core::text(other.row_spacing) + ", " + core::text(other.sideways);
        break;
    }
    core::refuse("StitchedPlies.stitch_length, row_spacing, sideways",
                 core::text(given.stitch_length) + ", " + core::text(given.row_spacing) + ", " + core::text(given.sideways),
                 others + ": distance of thread " + std::to_string(pierced.row + half_counts(given)[0]) + " from a yarn of ply " +
                     std::to_string(pierced.ply) + " where it goes through, at x = " + core::text(pierced.at) + ", is " +
                     core::text(pierced.off) + ", where " + core::text(half_room(given.yarn) + half_room(given.thread)) +
                     " is needed, the half thicknesses of both");
}
}  // namespace detail

/// Nothing overlaps. Each ply lies above those below it, and a thread above all plies or below all of them; neighbouring threads
/// take turns. In corners yarns that would not cross two threads are left out: nothing would hold them. Yarns along x are held by
/// threads that go sideways over and under them. One crossing for each two lines of a view from above that meet.
/// @throws std::invalid_argument naming ply, thread and distance, where a thread would go through a yarn
inline Textile stitched(const StitchedPlies& plies) {
    return laid(plies, &StitchedPlies::stitch_length, "StitchedPlies.stitch_length", 0.0,
                {{"length", plies.length}, {"width", plies.width}}, plies.thread,
                [](const StitchedPlies& one) { return detail::drawn(one); });
}

inline Textile detail::drawn(const StitchedPlies& plies) {
    Textile textile;
    textile.name = "stitched plies";
    textile.apart_by.fill({"StitchedPlies.yarn_spacing", plies.yarn_spacing});
    textile.types = {plies.yarn, plies.thread};
    const double s = plies.yarn_spacing, overhang = 0.75 * s;
    const auto half_extent = [&](int axis) { return 0.5 * (axis == 0 ? plies.length : plies.width); };
    const double middle = 0.5 * static_cast<double>(plies.angles_deg.size() - 1);
    double steepest = 0.0;  // sine of the angle of yarns to the threads
    for (std::size_t k = 0; k < plies.angles_deg.size(); ++k) {
        const double angle = plies.angles_deg[k] * std::numbers::pi / 180.0,
                     z = plies.pitch() * (static_cast<double>(k) - middle);
        const Vec3 along(std::cos(angle), std::sin(angle), 0.0), across(-along.y(), along.x(), 0.0);
        constexpr double none = 1e-9;  // sine below which a line is parallel to an edge
        if (std::abs(along.y()) > none) steepest = std::max(steepest, std::abs(along.y()));
        const auto most = static_cast<Index>(std::ceil(std::hypot(plies.length, plies.width) / s));
        for (Index n = -most; n < most; ++n) {
            const double d = s * (static_cast<double>(n) + 0.5);
            double from = -std::numeric_limits<double>::infinity(), to = -from;
            for (int axis = 0; axis < 2; ++axis) {
                const double start = d * across[axis], half = half_extent(axis);
                if (std::abs(along[axis]) <= none) {
                    if (std::abs(start) > half) to = from;
                    continue;
                }
                const double a = (-half - start) / along[axis], b = (half - start) / along[axis];
                from = std::max(from, std::min(a, b)), to = std::min(to, std::max(a, b));
            }
            const double rise = (to - from) * std::abs(along.y());
            if (!(to - from >= 2.0 * s) || (std::abs(along.y()) > none && rise < 2.0 * plies.row_spacing)) continue;
            Path path;
            path.name = "ply " + std::to_string(k) + " yarn " + std::to_string(n + most);
            path.family = static_cast<Index>(k), path.upward = Vec3::UnitZ();
            const Vec3 first = d * across + (from - overhang) * along + z * Vec3::UnitZ();
            const double size = to - from + 2.0 * overhang;
            path.curve = [=](double t) { return Vec3(first + size * t * along); };
            textile.paths.push_back(std::move(path));
        }
    }
    const double high = plies.pitch() * middle + 1.05 * (half_height(plies.yarn) + half_height(plies.thread)),
                 size = plies.length + 2.0 * overhang;
    // Half of the length in which a thread goes through: from the middle of a yarn, or a quarter of the breadth of a yarn of
    // several fibres nearer, to that of the next one.
    const double beside = plies.yarn.fibres > 1 ? 0.5 * half_breadth(plies.yarn) : 0.0;
    const double turn = steepest > 0.0 ? (0.5 * s - beside) / steepest : 2.0 * high;
    core::require(plies.stitch_length >= 2.0 * turn * (1.0 - 1e-9), "StitchedPlies.stitch_length", plies.stitch_length,
                  ">= " + core::text(2.0 * turn) + ", for threads to come up again");
    require_gaps(plies);
    const Index rows = half_counts(plies)[0], stitches = half_counts(plies)[1];
    for (Index row = -rows; row <= rows; ++row) {
        const double y = plies.row_spacing * static_cast<double>(row);
        const std::string name = "thread " + std::to_string(row + rows);
        std::vector<std::pair<double, double>> knots, aside;
        double side = (row % 2 == 0) == (stitches % 2 == 0) ? 1.0 : -1.0;
        for (Index m = -stitches; m <= stitches; ++m, side = -side) {
            const double x = plies.stitch_length * static_cast<double>(m);
            for (const double sense : {-1.0, 1.0}) {
                knots.emplace_back((x + sense * turn + 0.5 * size) / size, -sense * side * high);
                aside.emplace_back(knots.back().first, off_row(plies, m));
            }
        }
        Path path;
        path.name = name, path.type = 1, path.family = core::count(plies.angles_deg), path.upward = Vec3::UnitZ();
        const auto ways = std::make_shared<const detail::HeightLine>(std::move(aside), false);
        path.curve = detail::raised([=](double t) { return Vec3(size * (t - 0.5), y + (*ways)(t), 0.0); }, std::move(knots),
                                    false, textile.view);
        textile.paths.push_back(std::move(path));
    }
    textile.crossings = crossings_of(textile);
    return textile;
}

}  // namespace fibrant::compositions::textile

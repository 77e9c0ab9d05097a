// SPDX-License-Identifier: MIT
#pragma once
/// @file Weft knits from a matrix of stitches, and tricot.

#include <fibrant/compositions/textile/crossings.hpp>
#include <fibrant/compositions/textile/interlaced.hpp>
#include <fibrant/compositions/textile/yarn_fibres.hpp>
#include <fibrant/proximity/grid_search.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace fibrant::compositions::textile {

/// A weft knit on its needles: courses of loops, each drawn through the one below, from the front to the back or the other way.
///
/// A loop of a course is x = W u + a sin 4 pi u, y = -H cos 2 pi u, u in [0, 1], with its feet at u = 0 and 1 and its head in the
/// middle.
struct WeftKnit {
    std::vector<std::string> stitches{"f"};  ///< a text a course, 'f' face or 'r' reverse a wale; repeated both ways
    Index courses = 3, wales = 3;            ///< >= 1
    double wale_spacing = core::unset;       ///< W [length], > 0
    double course_spacing = core::unset;     ///< C [length], > 0
    double loop_height = core::unset;        ///< H, half of a loop's height in the plane [length], > C / 2
    double bulge = core::unset;              ///< a [length]; unset: W / 5
    double height_over_radius = 1.05;  ///< of yarns at crossings out of the middle plane [1], > 0; of several fibres >= 1.05
    YarnType type{};                   ///< of all yarns

    bool face(Index course, Index wale) const {
        const std::string& row = stitches[core::at(course % core::count(stitches))];
        return row[core::at(wale % core::count(row))] == 'f';
    }
    double width() const noexcept { return std::isnan(bulge) ? 0.2 * wale_spacing : bulge; }

    void validate() const {
        if (stitches.empty()) core::refuse("WeftKnit.stitches", "none", "at least one course");
        for (std::size_t k = 0; k < stitches.size(); ++k)
            if (stitches[k].empty() || stitches[k].find_first_not_of("fr") != std::string::npos)
                core::refuse("WeftKnit.stitches[" + std::to_string(k) + "]", "\"" + stitches[k] + "\"",
                             "letters f (face) and r (reverse), at least one");
        core::require_at_least("WeftKnit.courses", courses, 1);
        core::require_at_least("WeftKnit.wales", wales, 1);
        core::require_positive("WeftKnit.wale_spacing", wale_spacing);
        core::require_positive("WeftKnit.course_spacing", course_spacing);
        core::require(loop_height > 0.5 * course_spacing, "WeftKnit.loop_height", loop_height,
                      "> half of course_spacing, or loops do not reach the next course");
        type.validate();
        core::require_positive("WeftKnit.height_over_radius", height_over_radius);
        require_height("WeftKnit.height_over_radius", height_over_radius, type);
        // Beside each other lie courses, and legs of one course: an eighth of a wale and the bulge beside the middle of a foot.
        const double w = half_room(type);
        core::require(course_spacing >= 2.0 * w, "WeftKnit.course_spacing", course_spacing,
                      ">= " + core::text(2.0 * w) + ", the thickness of the yarn");
        if (std::isnan(bulge)) {
            core::require(wale_spacing >= w / 0.175, "WeftKnit.wale_spacing", wale_spacing,
                          ">= " + core::text(w / 0.175) + ", for legs of loops to lie beside each other");
            return;
        }
        const double most = 0.375 * wale_spacing - w;
        core::require(bulge > 0.0 && bulge <= most, "WeftKnit.bulge", bulge,
                      "> 0 and <= " + core::text(most) + ", for legs of loops to lie beside each other");
    }
};

namespace detail {
/// A knit whose loops cross as often as they should: others are refused with the height that would do.
/// @param asked    crossings
/// @param low      that its height is above [length]
/// @param fields   that crossings follow from as well
/// @param draw     draws it, however often it crosses itself
/// @param bend     height at which a loop is as sharp as its yarn is thick [length]
/// @param fits     whether a height that is named would do beside its crossings; null: it would
template <class Knit>
Textile looped(const Knit& knit, Textile (*draw)(const Knit&), const std::string& field, Index asked, double low,
               const std::string& fields, const std::string& why, std::vector<DrawnLength> lengths, double bend = 0.0,
               bool (*fits)(const Knit&) = nullptr) {
    const auto crossed = [&](const Knit& one) {
        const auto fitting = [&](const Knit& changed) {
            Textile other = draw(changed);
            if (fits != nullptr && core::count(other.crossings) == asked && !fits(changed)) other.crossings.clear();
            return other;
        };
        Textile textile = &one == &knit ? draw(one) : fitting(one);
        if (&one != &knit)
            require_crossings(textile, asked, "crossings", why);
        else
            require_crossings(textile, asked, field, one.loop_height, low, fields, why, [&](double height) {
                auto changed = one;
                changed.loop_height = height;
                return fitting(changed);
            });
        return textile;
    };
    const auto require_fibres = [&](const Textile& textile) {
        if (knit.type.fibres == 1 || fibres_cross_rightly(textile)) return;
        Knit thinner = knit;
        constexpr double step = 0.95, thinnest = 0.2;
        while ((thinner.type.radius *= step) > thinnest * knit.type.radius && !fibres_cross_rightly(draw(thinner))) continue;
        core::refuse("YarnType.radius", core::text(knit.type.radius),
                     "<= " + core::text(thinner.type.radius) + " at this " + field.substr(field.find('.') + 1) + ", " + fields +
                         ", for the " + std::to_string(knit.type.fibres) + " fibres of a yarn to cross as their yarns do");
    };
    constexpr double tallest = 8.0;  // over the least height: a loop that is taller crosses those beyond its neighbours
    Textile textile = laid(knit, &Knit::loop_height, field, bend, std::move(lengths), knit.type, crossed, tallest * low);
    require_fibres(textile);
    return textile;
}

/// A weft knit as it is drawn, however often it crosses itself.
inline Textile drawn(const WeftKnit& knit) {
    Textile textile;
    textile.name = "weft knit";
    textile.apart_by.fill({"WeftKnit.course_spacing", knit.course_spacing});
    textile.types = {knit.type};
    const double w = knit.wale_spacing, c = knit.course_spacing, hh = knit.loop_height, a = knit.width(), tail = 0.75 * w;
    const double h = knit.height_over_radius * half_thickness(knit.type);
    constexpr Index per_loop = 32;
    for (Index k = 0; k < knit.courses; ++k) {
        Path path;
        path.name = "course " + std::to_string(k), path.family = k, path.straight = false;
        // Heights along the course, a loop a unit: feet and lower legs by this course's stitch, upper legs and head by that
        // above.
        std::vector<std::pair<double, double>> knots;
        const auto sign = [&](Index course, Index wale) { return knit.face(course, wale) ? h : -h; };
        for (Index m = 0; m < knit.wales; ++m) {
            const double u = static_cast<double>(m), low = sign(k, m), high = sign(k + 1, m);
            for (const auto& [at, height] : {std::pair{0.06, low},
                                             {0.215, -low},
                                             {0.285, -high},
                                             {0.44, high},
                                             {0.56, high},
                                             {0.715, -high},
                                             {0.785, -low},
                                             {0.94, low}})
                knots.emplace_back(u + at, height);
        }
        const double loops = static_cast<double>(knit.wales);
        // HeightLine counts in parameters of [0, 1]: loops are scaled to it.
        for (auto& knot : knots) knot.first /= loops;
        const detail::HeightLine heights(std::move(knots), false);
        std::vector<Vec3> points;
        const double y0 = c * static_cast<double>(k);
        points.emplace_back(-tail, y0 - hh, heights(0.0));
        points.emplace_back(-0.5 * tail, y0 - hh, heights(0.0));
        for (Index n = 0; n <= per_loop * knit.wales; ++n) {
            const double u = static_cast<double>(n) / static_cast<double>(per_loop), f = 2.0 * std::numbers::pi * u;
            points.emplace_back(w * u + a * std::sin(2.0 * f), y0 - hh * std::cos(f), heights(u / loops));
        }
        points.emplace_back(w * loops + 0.5 * tail, y0 - hh, heights(1.0));
        points.emplace_back(w * loops + tail, y0 - hh, heights(1.0));
        const Line line = line_of(points);
        for (Index m = 0; m < knit.wales; ++m) {
            const auto at = [&](Index n) { return line.arc[core::at(n + 2)] / line.arc.back(); };
            if (k == 0 && m > 0) path.guides.push_back({at(per_loop * m)});
            if (k + 1 == knit.courses) path.guides.push_back({at(per_loop * m + per_loop / 2)});
        }
        path.curve = scene::curve_through(std::move(points));
        textile.paths.push_back(std::move(path));
    }
    textile.crossings = crossings_of(textile);
    return textile;
}
}  // namespace detail

/// Four crossings of each loop with that above it: heads over legs, legs under feet, as seen from where feet of face stitches lie
/// in front, and the other way round for reverse ones. The feet of the first course and the heads of the last one are held, as on
/// needles, and so are ends.
inline Textile weft_knit(const WeftKnit& knit) {
    // At the sides of a loop, where cos 4 pi u = -W / 4 pi a, its radius of curvature is (H sin 2 pi u)^2 / 4 a sin 4 pi u.
    const double a = knit.width(), side = -knit.wale_spacing / (4.0 * std::numbers::pi * a);
    const double bend =
        side > -1.0 ? std::sqrt(half_width(knit.type) / 0.95 * 8.0 * a * std::sqrt(1.0 - side * side) / (1.0 - side)) : 0.0;
    return detail::looped(knit, &detail::drawn, "WeftKnit.loop_height", 4 * knit.wales * (knit.courses - 1),
                          0.5 * knit.course_spacing, "wale_spacing, course_spacing and bulge",
                          "four of each loop with that above it",
                          {{"wale_spacing", knit.wale_spacing}, {"course_spacing", knit.course_spacing}, {"bulge", a}}, bend);
}

/// Tricot of one bar: each yarn lays a loop on a needle and on its neighbour by turns, joined by underlaps.
struct Tricot {
    Index needles = 4, courses = 4;       ///< >= 2
    double needle_spacing = core::unset;  ///< W [length], > 0
    double course_spacing = core::unset;  ///< C [length], > 0
    double loop_height = core::unset;     ///< of a loop above its feet [length], > C
    double height_over_radius = 1.05;     ///< of yarns at crossings out of the middle plane [1], > 0; of several fibres >= 1.05
    YarnType type{};                      ///< of all yarns

    void validate() const {
        core::require_at_least("Tricot.needles", needles, 2);
        core::require_at_least("Tricot.courses", courses, 2);
        core::require_positive("Tricot.needle_spacing", needle_spacing);
        core::require_positive("Tricot.course_spacing", course_spacing);
        core::require(loop_height > course_spacing, "Tricot.loop_height", loop_height,
                      "> course_spacing, or loops do not reach the next course");
        type.validate();
        core::require_positive("Tricot.height_over_radius", height_over_radius);
        require_height("Tricot.height_over_radius", height_over_radius, type);
        // Feet lie beside each other, 0.14 of the spacing beside a needle.
        const double w = half_room(type);
        core::require(needle_spacing >= w / 0.14, "Tricot.needle_spacing", needle_spacing,
                      ">= " + core::text(w / 0.14) + ", for feet of loops to lie beside each other");
        core::require(course_spacing >= 2.0 * w, "Tricot.course_spacing", course_spacing,
                      ">= " + core::text(2.0 * w) + ", the thickness of the yarn");
    }
};

namespace detail {
/// A tricot as it is drawn, however often it crosses itself.
inline Textile drawn(const Tricot& knit) {
    Textile textile;
    textile.name = "tricot";
    textile.apart_by.fill({"Tricot.needle_spacing", knit.needle_spacing});
    textile.types = {knit.type};
    const double w = knit.needle_spacing, c = knit.course_spacing, top = knit.loop_height,
                 h = knit.height_over_radius * half_thickness(knit.type);
    const double neck = 0.14 * w, head = 0.30 * w;
    std::vector<scene::Curve> sketched;
    std::vector<Heights> heights;  // of its points
    for (Index m = 0; m < knit.needles; ++m) {
        Path path;
        path.name = "end " + std::to_string(m), path.family = m % 2, path.straight = false;
        std::vector<Vec3> points;
        std::vector<std::size_t> heads;
        for (Index k = 0; k < knit.courses; ++k) {
            const Index odd = k % 2;
            const double x = w * static_cast<double>(m + odd), y = c * static_cast<double>(k), way = odd == 0 ? 1.0 : -1.0;
            if (k == 0) points.emplace_back(x - way * neck, y - 1.5 * c, h);
            // In on the side away from the next needle, out on the side towards it.
            points.emplace_back(x - way * neck, y, h);
            points.emplace_back(x - way * neck, y + 0.30 * top, -h);
            points.emplace_back(x - way * head, y + 0.72 * top, -h);
            points.emplace_back(x - way * 0.68 * head, y + 0.95 * top, h);
            heads.push_back(points.size());
            points.emplace_back(x, y + top, h);
            points.emplace_back(x + way * 0.68 * head, y + 0.95 * top, h);
            points.emplace_back(x + way * head, y + 0.72 * top, -h);
            points.emplace_back(x + way * neck, y + 0.30 * top, -h);
            points.emplace_back(x + way * neck, y, h);
            if (k + 1 == knit.courses) {
                points.emplace_back(x + way * (neck + 0.4 * w), y - 0.2 * c, h);
                continue;
            }
            // Round the foot, then well above the head of its own yarn's loop on the next needle: an underlap that sags lies on
            // that head.
            points.emplace_back(x + way * 0.32 * w, y - 0.07 * c, h);
            points.emplace_back(x + way * 0.65 * w, y + 0.5 * c, h);
            points.emplace_back(x + way * 1.12 * w, y + 0.8 * c, h);
        }
        const Line line = line_of(points);
        path.guides.push_back({line.arc[heads.back()] / line.arc.back()});
        heights.emplace_back();
        for (std::size_t k = 0; k < points.size(); ++k) heights.back().emplace_back(line.arc[k] / line.arc.back(), points[k].z());
        sketched.push_back(scene::curve_through(std::move(points)));
        path.curve = [sketch = sketched.back()](double t) {
            Vec3 place = sketch(t);
            place.z() = 0.0;
            return place;
        };
        textile.paths.push_back(std::move(path));
    }
    // The points say who is above. Yarns lie level where they cross, for what crosses is as broad as it is thick.
    raise(
        textile,
        [&](const PlanCrossing& crossing) {
            const auto height = [&](Index path, double at) { return sketched[core::at(path)](at).z(); };
            return one_above(height(crossing.first, crossing.at_first) > height(crossing.second, crossing.at_second));
        },
        h, heights, 6.0 * h);
    textile.crossings = crossings_of(textile);
    return textile;
}
}  // namespace detail

namespace detail {
/// Whether underlaps lie beside the heads of their own yarns' loops, which they pass two courses above.
inline bool underlaps_beside(const Tricot& given) {
    Tricot knit = given;
    knit.needles = 2, knit.courses = 3;  // all are alike
    const Textile textile = drawn(knit);
    constexpr Index pieces = 400;
    const double length = scene::length_of(textile.paths[0].curve);
    const auto far = static_cast<Index>(2.0 * knit.loop_height / length * static_cast<double>(pieces));  // along the yarn
    std::vector<std::vector<Vec3>> fibres;
    for (const scene::Curve& curve : fibre_curves(textile, 0)) {
        fibres.emplace_back();
        for (Index k = 0; k <= pieces; ++k) fibres.back().push_back(curve(static_cast<double>(k) / static_cast<double>(pieces)));
    }
    std::vector<proximity::Centreline> lines;
    for (const std::vector<Vec3>& fibre : fibres)
        lines.push_back({.points = fibre, .radius = knit.type.radius, .self_skip = 0.0});
    // Points that are near are ends of pieces that are.
    for (const proximity::SegmentPair& pair : proximity::GridSearch{}.pairs(lines, 1e-6 * knit.type.radius))
        for (const Index k : {pair.i % pieces, pair.i % pieces + 1})
            for (const Index l : {pair.j % pieces, pair.j % pieces + 1}) {
                const Vec3 &one = fibres[core::at(pair.i / pieces)][core::at(k)],
                           &other = fibres[core::at(pair.j / pieces)][core::at(l)];
                if (std::abs(k - l) >= far && (one - other).norm() < 2.0 * knit.type.radius) return false;
            }
    return true;
}
}  // namespace detail

/// Yarn m lays its loops on needles m and m + 1 by turns. Loops are closed: feet lie side by side, heads above the legs of the
/// loop that is drawn through them, underlaps and feet above the legs of the loop below.
inline Textile tricot(const Tricot& knit) {
    const std::string others = "needle_spacing and course_spacing";
    const Index asked = 4 * (knit.needles - 1) * (knit.courses - 1);
    Textile textile = detail::looped(knit, &detail::drawn, "Tricot.loop_height", asked, knit.course_spacing, others,
                                     "four of each loop with that drawn through it",
                                     {{"needle_spacing", knit.needle_spacing}, {"course_spacing", knit.course_spacing}}, 0.0,
                                     &detail::underlaps_beside);
    if (detail::underlaps_beside(knit)) return textile;
    const double nearest = nearest_that_holds(knit.loop_height, knit.course_spacing, knit.loop_height, [&](double height) {
        Tricot changed = knit;
        changed.loop_height = height;
        return height > knit.course_spacing && core::count(detail::drawn(changed).crossings) == asked &&
               detail::underlaps_beside(changed);
    });
    const std::string why = ", for underlaps to lie beside the heads of their own yarn's loops";
    if (std::isnan(nearest))
        core::refuse("Tricot.needle_spacing", core::text(knit.needle_spacing),
                     "more at this course_spacing and loop_height" + why);
    core::refuse("Tricot.loop_height", core::text(knit.loop_height), "<= " + core::text(nearest) + " at this " + others + why);
}

}  // namespace fibrant::compositions::textile

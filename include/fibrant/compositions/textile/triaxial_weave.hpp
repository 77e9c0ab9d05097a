// SPDX-License-Identifier: MIT
#pragma once
/// @file Triaxial weaves: three families of straight yarns.

#include <fibrant/compositions/textile/interlaced.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// Three families of straight yarns at 0, 60 and -60 degrees within a circle, no three of which meet at a point.
struct TriaxialWeave {
    double spacing = core::unset;      ///< of a family, across it [length], > 0
    double radius = core::unset;       ///< of the circle within which yarns cross [length], > spacing
    YarnType type{};                   ///< of all yarns
    double height_over_radius = 1.05;  ///< of yarns at crossings out of the middle plane [1], > 0; of several fibres >= 1.05

    void validate() const {
        core::require_positive("TriaxialWeave.spacing", spacing);
        core::require(radius > spacing, "TriaxialWeave.radius", radius, "> spacing");
        constexpr double most = 10000.0;  // yarns of a family
        core::require(radius <= 0.5 * most * spacing, "TriaxialWeave.radius", radius,
                      "<= " + core::text(0.5 * most * spacing) + ", 5000 spacings");
        type.validate();
        core::require_positive("TriaxialWeave.height_over_radius", height_over_radius);
        require_height("TriaxialWeave.height_over_radius", height_over_radius, type);
    }
};

namespace detail {
inline Textile drawn(const TriaxialWeave& weave) {
    Textile textile;
    textile.name = "triaxial weave";
    textile.apart_by.fill({"TriaxialWeave.spacing", weave.spacing});
    textile.types = {weave.type};
    std::vector<Index> family;
    // Half the length of a yarn at a distance from the middle; < 0: there is none.
    const auto half_of = [&](double distance) {
        const double chord = weave.radius * weave.radius - distance * distance, overhang = 0.75 * weave.spacing;
        return chord < 0.25 * weave.spacing * weave.spacing ? -weave.radius : std::sqrt(chord) + overhang;
    };
    // With a quarter of the spacing, and one family by half of it more, lines of three families never meet in one point. By a
    // quarter more all ways from crossing to crossing are alike and as long as can be, which yarns of several fibres need.
    const bool several = weave.type.fibres > 1;
    const auto way_of = [](Index f) {
        const double angle = std::numbers::pi / 3.0 * (f == 0 ? 0.0 : f == 1 ? 1.0 : -1.0);
        return Vec3(std::cos(angle), std::sin(angle), 0.0);
    };
    const auto shift_of = [&](Index f) { return (0.25 + (f == 2 ? (several ? 0.25 : 0.5) : 0.0)) * weave.spacing; };
    for (Index f = 0; f < 3; ++f) {
        const double shift = shift_of(f);
        const Vec3 along = way_of(f), across(-along.y(), along.x(), 0.0);
        const auto most = static_cast<Index>(std::floor(weave.radius / weave.spacing)) + 1;
        for (Index k = -most; k <= most; ++k) {
            const double d = shift + weave.spacing * static_cast<double>(k), half = half_of(d);
            if (half < 0.0) continue;
            Path path;
            path.name = std::string(1, static_cast<char>('A' + f)) + std::to_string(k);
            path.family = f;
            // Where a line of another family crosses it; its next ones are a step further each.
            const auto place = [&](Index other) {
                const Vec3 its_way = way_of(other), beside(-its_way.y(), its_way.x(), 0.0);
                return (shift_of(other) - d * across.dot(beside)) / along.dot(beside);
            };
            const double step = 2.0 * weave.spacing / std::sqrt(3.0);
            double from = -half, to = half;
            if (several) {  // ends lie half way between crossings: some fibres of a yarn would cross another, and some not
                const double first = place(f == 1 ? 2 : 1), way = 0.5 * step;
                for (double* end : {&from, &to}) *end = first + way * (std::floor((*end - first) / way) + 0.5);
            } else {  // an end on a yarn has no side, and one just behind a yarn is drawn in by the pull, and comes off it
                const double one = place((f + 1) % 3), two = place((f + 2) % 3),
                             apart = two - one - step * std::floor((two - one) / step);
                const double wide = std::max(apart, step - apart), start = apart < wide ? two : one,  // of the wider way
                    near = std::min(3.0 * half_width(weave.type), 0.5 * wide);
                const auto beside = [&](double end) {  // of a yarn that is there
                    const Vec3 place = d * across + end * along;
                    for (const Index other : {(f + 1) % 3, (f + 2) % 3}) {
                        const Vec3 its_way = way_of(other), its_side(-its_way.y(), its_way.x(), 0.0);
                        const double e = place.dot(its_side) - shift_of(other),
                                     line = weave.spacing * std::round(e / weave.spacing);
                        const double reach = half_of(shift_of(other) + line);
                        if (std::abs(e - line) < near * std::abs(along.dot(its_side)) &&
                            std::abs(place.dot(its_way)) < reach + near)
                            return true;
                    }
                    return false;
                };
                // It ends before that, at the end of the wider way.
                if (beside(from)) from = start + near - step * std::floor((start + near - from) / step);
                if (beside(to)) to = start + wide - near + step * std::floor((to - start - wide + near) / step);
            }
            const double middle = 0.5 * (from + to), reach = 0.5 * (to - from);
            path.curve = [=](double t) { return Vec3(d * across + (middle + reach * (2.0 * t - 1.0)) * along); };
            textile.paths.push_back(std::move(path));
            family.push_back(f);
        }
    }
    interlace(
        textile,
        [&](const PlanCrossing& crossing) {
            const Index a = family[core::at(crossing.first)], b = family[core::at(crossing.second)];
            return one_above((a + 1) % 3 == b);
        },
        weave.height_over_radius * half_thickness(weave.type));
    return textile;
}
}  // namespace detail

/// Orders are cyclic by families: the first above the second, the second above the third, the third above the first. One crossing
/// a pair that meets.
inline Textile triaxial_weave(const TriaxialWeave& weave) {
    return laid(weave, &TriaxialWeave::spacing, "TriaxialWeave.spacing", 2.0 * half_room(weave.type), {{"radius", weave.radius}},
                weave.type, [](const TriaxialWeave& one) { return detail::drawn(one); });
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file Paths in one surface, a plane or a cylinder, given heights at their crossings by a rule of who is above.

#include <fibrant/compositions/textile/crossings.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// A crossing of two paths in the surface, as a rule sees it.
struct PlanCrossing {
    Index first = -1, second = -1;
    double at_first = 0.0, at_second = 0.0;                        ///< parameters of the two curves, in [0, 1]
    Vec3 place = Vec3::Zero();                                     ///< [length]
    Vec3 along_first = Vec3::Zero(), along_second = Vec3::Zero();  ///< chords of the two paths there [length]
};

/// Heights of the first and of the second path at a crossing, in units that `interlaced` is told; never the same.
using HeightRule = std::function<std::array<double, 2>(const PlanCrossing&)>;

/// The usual rule: the one is as much above as the other is below.
inline std::array<double, 2> one_above(bool first) noexcept { return first ? std::array{1.0, -1.0} : std::array{-1.0, 1.0}; }

namespace detail {

/// Heights over a parameter, joined by arcs of the third degree that are level where they meet.
class HeightLine {
public:
    /// @param per_root  shortest way from one height to another over the root of their difference [1 / length^(1/2)], >= 0: what
    ///                  is left of the way between two knots is level, beside both; infinity: nothing is
    HeightLine(std::vector<std::pair<double, double>> knots, bool repeating,
               double per_root = std::numeric_limits<double>::infinity())
        : repeating_{repeating} {
        std::sort(knots.begin(), knots.end());
        // Crossings of three at one point, however many a path has: of the path, and of the mean distance between crossings.
        constexpr double one_point = 1e-4, of_distance = 0.05;
        const double same = std::min(one_point, of_distance / static_cast<double>(knots.size() + 1));
        for (const auto& knot : knots) {
            if (!knots_.empty() && knot.first - knots_.back().first < same) {
                if (std::abs(knot.second) > std::abs(knots_.back().second)) knots_.back().second = knot.second;
                continue;
            }
            knots_.push_back(knot);
        }
        if (repeating_ && !knots_.empty()) {
            const auto first = knots_.front(), last = knots_.back();
            knots_.insert(knots_.begin(), {last.first - 1.0, last.second});
            knots_.emplace_back(first.first + 1.0, first.second);
        }
        level(per_root);
    }
    double operator()(double t) const {
        if (knots_.empty()) return 0.0;
        if (t <= knots_.front().first) return knots_.front().second;
        if (t >= knots_.back().first) return knots_.back().second;
        const auto after =
            std::upper_bound(knots_.begin(), knots_.end(), t, [](double x, const auto& knot) { return x < knot.first; });
        const auto& [a, low] = *(after - 1);
        const auto& [b, high] = *after;
        const double s = (t - a) / (b - a);
        return low + (high - low) * s * s * (3.0 - 2.0 * s);
    }

private:
    void level(double per_root) {
        constexpr double most = 0.4;  // of the way, on either side
        std::vector<std::pair<double, double>> knots;
        for (std::size_t k = 0; k < knots_.size(); ++k) {
            knots.push_back(knots_[k]);
            if (k + 1 == knots_.size() || knots_[k].second == knots_[k + 1].second) continue;
            const auto [a, low] = knots_[k];
            const auto [b, high] = knots_[k + 1];
            const double part = std::min(most * (b - a), 0.5 * (b - a - per_root * std::sqrt(std::abs(high - low))));
            if (part > 0.0) knots.emplace_back(a + part, low), knots.emplace_back(b - part, high);
        }
        knots_ = std::move(knots);
    }
    std::vector<std::pair<double, double>> knots_;
    bool repeating_;
};

/// A path with its heights out of the surface.
/// @param per_root  as of HeightLine
inline scene::Curve raised(scene::Curve plan, std::vector<std::pair<double, double>> knots, bool repeating, const View& view,
                           double per_root = std::numeric_limits<double>::infinity()) {
    const auto heights = std::make_shared<const HeightLine>(std::move(knots), repeating, per_root);
    const Vec3 axis = view.axis.normalized();
    return [plan = std::move(plan), heights, view, axis](double t) -> Vec3 {
        const Vec3 place = plan(t);
        if (!view.radial) return place + (*heights)(t)*axis;
        Vec3 out = place - view.centre;
        out -= out.dot(axis) * axis;
        return place + (*heights)(t)*out.normalized();
    };
}

}  // namespace detail

/// Makes a path go on as its image.
inline void repeat(Path& path, const Vec3& image) { path.kind = PathKind::periodic, path.image = image; }
inline void require_whole(const std::string& field, double count) {
    core::require(count >= 1.0 && std::abs(count - std::round(count)) <= 1e-12 * count, field, count, "whole, and >= 1");
}

namespace detail {
using Heights = std::vector<std::pair<double, double>>;  ///< parameter of a path in [0, 1], and height there [length]

/// Gives the paths of a textile, all in one surface as yet, their heights at crossings.
/// @param elsewhere  of each path: heights that it has farther than `clear` [length] from its crossings; or none
/// @param level      yarns of several fibres lie level beside their crossings, as far as they may bend: what crosses is as broad
///                   as it is thick
/// @returns the crossings of the rule
inline std::vector<Crossing> raise(Textile& textile, const HeightRule& rule, double height,
                                   const std::vector<Heights>& elsewhere = {}, double clear = 0.0, bool level = false) {
    const std::vector<Line> lines = lines_of(textile);
    const Plan plan(lines, textile.view);
    std::vector<Heights> knots(textile.paths.size());
    std::vector<Crossing> asked;
    for (const Meeting& m : meetings(plan)) {
        const Line &a = lines[core::at(m.line_a)], &b = lines[core::at(m.line_b)];
        const std::size_t i = core::at(m.piece_a), j = core::at(m.piece_b);
        const MeetingPlace place = place_of(m, lines, plan, textile.view);
        PlanCrossing crossing{m.line_a,
                              m.line_b,
                              0.0,
                              0.0,
                              (1.0 - m.part_a) * a.points[i] + m.part_a * a.points[i + 1],
                              a.points[i + 1] - a.points[i],
                              b.points[j + 1] - b.points[j]};
        crossing.at_first = (static_cast<double>(i) + m.part_a) / static_cast<double>(a.points.size() - 1);
        crossing.at_second = (static_cast<double>(j) + m.part_b) / static_cast<double>(b.points.size() - 1);
        const std::array<double, 2> heights = rule(crossing);
        knots[core::at(m.line_a)].emplace_back(crossing.at_first, height * heights[0]);
        knots[core::at(m.line_b)].emplace_back(crossing.at_second, height * heights[1]);
        asked.push_back(heights[0] > heights[1] ? Crossing{m.line_a, m.line_b, place.at_a, place.at_b, place.axis}
                                                : Crossing{m.line_b, m.line_a, place.at_b, place.at_a, place.axis});
    }
    for (std::size_t p = 0; p < textile.paths.size(); ++p) {
        Path& path = textile.paths[p];
        if (!elsewhere.empty()) {
            const double far = clear / lines[p].arc.back();
            const Heights at = knots[p];
            for (const auto& more : elsewhere[p])
                if (std::all_of(at.begin(), at.end(), [&](const auto& knot) { return std::abs(knot.first - more.first) > far; }))
                    knots[p].push_back(more);
        }
        const YarnType& type = textile.type_of(static_cast<Index>(p));
        const bool repeating = path.kind != PathKind::open;
        const scene::Curve plan_curve = path.curve;
        path.curve = raised(plan_curve, knots[p], repeating, textile.view);
        if (!level || type.fibres == 1) continue;
        // A step of the third degree bends by six heights over its length squared, and the plan bends as well.
        const double length = lines[p].arc.back(), shortest = std::sqrt(6.0 * least_bend(type)) / length;
        for (const double longer : {1.05, 1.2, 1.4, 1.7}) {
            Path other = path;
            other.curve = raised(plan_curve, knots[p], repeating, textile.view, longer * shortest);
            if (tightest_bend(other, type, length).first < least_bend(type)) continue;
            path = std::move(other);
            break;
        }
    }
    return asked;
}
}  // namespace detail

/// Gives the paths of a textile, all in one surface as yet, their heights at crossings, and finds the crossings.
/// @param rule    of who is above
/// @param height  unit of its heights [length], > 0
/// @param level   yarns of several fibres lie level beside their crossings
/// @throws std::invalid_argument where the crossings of the raised paths are not those of the rule
inline void interlace(Textile& textile, const HeightRule& rule, double height, bool level = false) {
    core::require_positive("interlace.height", height);
    const std::vector<Crossing> asked = detail::raise(textile, rule, height, {}, 0.0, level);
    textile.crossings = crossings_of(textile);
    const CrossingAudit audit = audit_crossings(asked, textile.crossings);
    if (!audit.clean())
        core::refuse(
            textile.name + ": crossings of " + textile.label(audit.first_path) + " and " + textile.label(audit.second_path),
            std::to_string(audit.wrong) + " wrong, " + std::to_string(audit.missing) + " missing and " +
                std::to_string(audit.extra) + " more",
            "as the rule says");
}

/// A length that a textile is drawn from, and its name.
struct DrawnLength {
    const char* name;
    double value;  ///< [length]
};

namespace detail {
/// Refuses, by its yarn, a path that bends more sharply than that is thick.
inline void require_bends(const Textile& textile) {
    for (Index p = 0; p < core::count(textile.paths); ++p)
        core::with_place([&] { return textile.label(p); },
                         [&] {
                             const Path& path = textile.paths[core::at(p)];
                             require_bends(path, textile.type_of(p), scene::length_of(path.curve, 128), "");
                         });
}

/// As laid() below, of a length and what draws with it.
inline Textile laid(double value, const std::string& field, double low, std::vector<DrawnLength> others, const YarnType& type,
                    const std::function<Textile(double)>& draw, double high) {
    const std::string owner = field.substr(0, field.find('.') + 1);
    std::string why;
    const auto own = [&](const std::invalid_argument& error) {  // names a field of the generator
        return std::string_view(error.what()).substr(0, owner.size()) == owner;
    };
    bool longer = false;
    const auto holds = [&](double x) {
        try {
            require_bends(draw(x));
            return true;
        } catch (const TooLong& error) {
            longer = true, why = error.what();
        } catch (const std::invalid_argument& error) {
            if (why.empty() && !own(error)) why = error.what();
        }
        return false;
    };
    std::string at;
    for (const DrawnLength& other : others)
        at += std::string(at.empty() ? " at " : ", ") + other.name + " = " + core::text(other.value);
    at += " and yarns " + core::text(2.0 * half_width(type)) + " thick";
    try {
        if (value >= low) {
            Textile textile = draw(value);
            require_bends(textile);
            return textile;
        }
    } catch (const TooLong& error) {
        longer = true, why = error.what();
    } catch (const std::invalid_argument& error) {
        if (own(error)) throw;
        why = error.what();
    }
    // Upwards in steps until it holds, then between the last two.
    double bad = value, good = std::max(value, low) * (1.0 + 1e-9);
    bool found = !longer && value < low && good <= high && holds(good);
    for (int k = 0; k < 40 && !found && !longer && good <= high; ++k) bad = good, good *= 1.3, found = holds(good);
    if (longer && !found) {
        others.push_back({field.c_str() + owner.size(), value});
        const DrawnLength& largest = *std::max_element(
            others.begin(), others.end(), [](const DrawnLength& a, const DrawnLength& b) { return a.value < b.value; });
        core::refuse(owner + largest.name, core::text(largest.value),
                     "less with fibres of radius " + core::text(type.radius) + ": " + why);
    }
    if (!found)
        core::refuse(field, core::text(value),
                     (value < low ? ">= " + core::text(low) : std::string("another one")) + at +
                         (why.empty() ? ", for yarns to lie beside each other" : ": " + why));
    while (bad >= low && good - bad > 1e-3 * good) {
        const double middle = 0.5 * (bad + good);
        (holds(middle) ? good : bad) = middle;
    }
    core::refuse(field, core::text(value),
                 ">= " + core::text(good) + at + ", for yarns to lie beside each other" +
                     (why.empty() ? std::string() : " and not too bent: " + why));
}
}  // namespace detail

/// What a generator draws, if its yarns lie beside each other, cross as they should, and bend no more sharply than they are
/// thick.
/// @param length   of the parameters: the one that this follows from most; more of it is better
/// @param field    its name, of the form "Generator.length"
/// @param low      that it has to be at least, or yarns would lie in each other [length]
/// @param others   that this follows from as well
/// @param type     of the yarns
/// @param draw     draw(parameters) is the textile; it is told of what is given by `given` itself
/// @param high     beyond which no value would do [length]
/// @throws std::invalid_argument by the length and the least value near to it that does; what is too long by its largest length
template <class Parameters, class Draw>
Textile laid(const Parameters& given, double Parameters::*length, const std::string& field, double low,
             std::vector<DrawnLength> others, const YarnType& type, const Draw& draw,
             double high = std::numeric_limits<double>::infinity()) {
    given.validate();
    const auto drawn = [&](double x) -> Textile {
        if (x == given.*length) return draw(given);
        Parameters changed = given;
        changed.*length = x;
        return draw(changed);
    };
    return detail::laid(given.*length, field, low, std::move(others), type, drawn, high);
}

}  // namespace fibrant::compositions::textile

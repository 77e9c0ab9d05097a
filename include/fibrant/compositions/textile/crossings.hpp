// SPDX-License-Identifier: MIT
#pragma once
/// @file Where paths cross as seen along an axis or from a line outwards, and which is above: found from their points.

#include <fibrant/compositions/textile/yarn_section.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>
#include <tuple>
#include <vector>

namespace fibrant::compositions::textile {

/// A path as points, with the arc of each from its start.
struct Line {
    std::vector<Vec3> points{};
    std::vector<double> arc{};
};

/// A polyline with the arc length of each of its points [length].
inline Line line_of(std::vector<Vec3> points) {
    Line line{std::move(points), {}};
    line.arc.assign(line.points.size(), 0.0);
    for (std::size_t k = 1; k < line.points.size(); ++k)
        line.arc[k] = line.arc[k - 1] + (line.points[k] - line.points[k - 1]).norm();
    return line;
}

/// A path that is far longer than its fibres are thick.
struct TooLong : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// Points of all paths, about half a radius apart.
/// @param step_over_radius  distance of points [1], > 0
/// @throws TooLong where that would be more points than can be held, or longer than the type of a yarn says
inline std::vector<Line> lines_of(const Textile& textile, double step_over_radius = 0.5) {
    std::vector<Line> lines;
    double taken = 0.0;  // share of what may be drawn
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        const YarnType& type = textile.type_of(p);
        const double over_radius = scene::length_of(path.curve, 128) / type.radius;
        constexpr double most_points = 1e7;  // in all: more is a slip of the unit
        const double most = std::min(type.longest, step_over_radius * most_points), left = (1.0 - taken) * most;
        taken += over_radius / most;
        if (!(taken <= 1.0))
            throw TooLong(textile.label(p) + ": length over the radius of its fibres = " + core::text(over_radius) +
                          ", but it must be <= " + core::text(left) +
                          " beside the yarns before it, for all to be held in memory");
        const double steps = over_radius / step_over_radius;
        const auto pieces = std::max<Index>(64, static_cast<Index>(steps));
        std::vector<Vec3> points;
        for (Index k = 0; k <= pieces; ++k) points.push_back(path.curve(static_cast<double>(k) / static_cast<double>(pieces)));
        if (path.kind == PathKind::closed) points.back() = points.front();
        lines.push_back(line_of(std::move(points)));
    }
    return lines;
}

namespace detail {

/// Lines in the plane that is seen: u, v, and the height out of it. Radially u goes round, and has a period.
struct PlanPoint {
    double u = 0.0, v = 0.0, height = 0.0;
};

/// Lines of a textile seen in plan, by which crossings are found.
struct Plan {
    std::vector<std::vector<PlanPoint>> lines;
    double period = 0.0;  ///< of u; 0: none

    Plan(std::span<const Line> given, const View& view) {
        const Vec3 axis = view.axis.normalized(), e1 = scene::any_perpendicular(axis), e2 = axis.cross(e1);
        double mean = 0.0;
        std::size_t count = 0;
        if (view.radial) {
            for (const Line& line : given)
                for (const Vec3& point : line.points)
                    mean += std::hypot((point - view.centre).dot(e1), (point - view.centre).dot(e2)), ++count;
            mean /= static_cast<double>(std::max<std::size_t>(count, 1));
            period = 2.0 * std::numbers::pi * mean;
        }
        for (std::size_t l = 0; l < given.size(); ++l) {
            // Lines that meet in corners of both have no side: each is seen a billionth of its length beside itself, another way
            // each.
            const double aside = 1e-9 * given[l].arc.back(), turn = 2.399963229728653 * static_cast<double>(l);
            std::vector<PlanPoint> plan;
            for (const Vec3& point : given[l].points) {
                const Vec3 d = view.radial ? Vec3(point - view.centre) : point;
                const double x = d.dot(e1), y = d.dot(e2);
                PlanPoint p = view.radial ? PlanPoint{mean * std::atan2(y, x), d.dot(axis), std::hypot(x, y)}
                                          : PlanPoint{x, y, d.dot(axis)};
                p.u += aside * std::cos(turn), p.v += aside * std::sin(turn);
                if (period > 0.0 && !plan.empty()) p.u -= period * std::round((p.u - plan.back().u) / period);
                plan.push_back(p);
            }
            lines.push_back(std::move(plan));
        }
    }
};

/// One crossing of two pieces: line, piece and part of it for each.
struct Meeting {
    Index line_a, line_b;
    Index piece_a, piece_b;
    double part_a, part_b;
};

/// All crossings of pieces in plan, sorted by lines and places. Pieces are sorted into square cells; time linear in the pieces
/// and in those that share a cell.
inline std::vector<Meeting> meetings(const Plan& plan) {
    struct Entry {
        std::int64_t row, column;
        Index line, piece;
        auto key() const noexcept { return std::tie(row, column, line, piece); }
    };
    double length = 0.0;
    std::size_t pieces = 0;
    for (const auto& line : plan.lines)
        for (std::size_t k = 0; k + 1 < line.size(); ++k)
            length += std::hypot(line[k + 1].u - line[k].u, line[k + 1].v - line[k].v), ++pieces;
    std::vector<Meeting> found;
    if (pieces == 0 || !(length > 0.0)) return found;
    double size = 2.0 * length / static_cast<double>(pieces);
    std::int64_t around = 0;
    if (plan.period > 0.0)
        around = std::max<std::int64_t>(1, static_cast<std::int64_t>(plan.period / size)),
        size = plan.period / static_cast<double>(around);
    const auto wrapped = [&](std::int64_t column) { return around > 0 ? ((column % around) + around) % around : column; };
    std::vector<Entry> entries;
    for (Index l = 0; l < core::count(plan.lines); ++l) {
        const auto& line = plan.lines[core::at(l)];
        for (Index k = 0; k + 1 < core::count(line); ++k) {
            const PlanPoint &p = line[core::at(k)], &q = line[core::at(k + 1)];
            const auto cell = [&](double x) { return static_cast<std::int64_t>(std::floor(x / size)); };
            for (std::int64_t r = cell(std::min(p.v, q.v)); r <= cell(std::max(p.v, q.v)); ++r)
                for (std::int64_t c = cell(std::min(p.u, q.u)); c <= cell(std::max(p.u, q.u)); ++c)
                    entries.push_back({r, wrapped(c), l, k});
        }
    }
    std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.key() < b.key(); });
    const auto side = [](const PlanPoint& from, const PlanPoint& to, double u, double v) {
        return (to.u - from.u) * (v - from.v) - (to.v - from.v) * (u - from.u);
    };
    for (std::size_t first = 0; first < entries.size();) {
        std::size_t last = first;
        while (last < entries.size() && entries[last].row == entries[first].row && entries[last].column == entries[first].column)
            ++last;
        for (std::size_t i = first; i < last; ++i)
            for (std::size_t j = i + 1; j < last; ++j) {
                const Entry &one = entries[i], &two = entries[j];
                if (one.line == two.line && std::abs(one.piece - two.piece) < 2) continue;
                const auto &la = plan.lines[core::at(one.line)], &lb = plan.lines[core::at(two.line)];
                const PlanPoint &p = la[core::at(one.piece)], &q = la[core::at(one.piece + 1)];
                PlanPoint r = lb[core::at(two.piece)], s = lb[core::at(two.piece + 1)];
                if (plan.period > 0.0) {
                    const double shift = plan.period * std::round((p.u - r.u) / plan.period);
                    r.u += shift, s.u += shift;
                }
                // Pieces of one straight run lie on one line but for rounding.
                constexpr double parallel = 1e-9;
                const double du = q.u - p.u, dv = q.v - p.v, eu = s.u - r.u, ev = s.v - r.v;
                if (std::abs(du * ev - dv * eu) <= parallel * std::hypot(du, dv) * std::hypot(eu, ev)) continue;
                const double rp = side(r, s, p.u, p.v), rq = side(r, s, q.u, q.v), pr = side(p, q, r.u, r.v),
                             ps = side(p, q, s.u, s.v);
                if ((rp < 0.0) == (rq < 0.0) || (pr < 0.0) == (ps < 0.0)) continue;
                found.push_back({one.line, two.line, one.piece, two.piece, rp / (rp - rq), pr / (pr - ps)});
            }
        first = last;
    }
    const auto key = [](const Meeting& m) { return std::tie(m.line_a, m.line_b, m.piece_a, m.piece_b); };
    std::sort(found.begin(), found.end(), [&](const Meeting& a, const Meeting& b) { return key(a) < key(b); });
    found.erase(std::unique(found.begin(), found.end(), [&](const Meeting& a, const Meeting& b) { return key(a) == key(b); }),
                found.end());
    return found;
}

/// Where a meeting is on its two lines [length], heights there, and the axis.
struct MeetingPlace {
    double at_a, at_b, height_a, height_b;
    Vec3 axis;
};
inline MeetingPlace place_of(const Meeting& m, std::span<const Line> lines, const Plan& plan, const View& view) {
    const auto between = [](double a, double b, double t) { return (1.0 - t) * a + t * b; };
    const Line &a = lines[core::at(m.line_a)], &b = lines[core::at(m.line_b)];
    const auto &pa = plan.lines[core::at(m.line_a)], &pb = plan.lines[core::at(m.line_b)];
    const std::size_t i = core::at(m.piece_a), j = core::at(m.piece_b);
    MeetingPlace place{between(a.arc[i], a.arc[i + 1], m.part_a), between(b.arc[j], b.arc[j + 1], m.part_b),
                       between(pa[i].height, pa[i + 1].height, m.part_a), between(pb[j].height, pb[j + 1].height, m.part_b),
                       view.axis.normalized()};
    if (view.radial) {
        Vec3 out = (1.0 - m.part_a) * a.points[i] + m.part_a * a.points[i + 1] - view.centre;
        out -= out.dot(place.axis) * place.axis;
        place.axis = out.normalized();
    }
    return place;
}

}  // namespace detail

/// All crossings of lines as they are seen, by first and second line and the place on the first. Of a line that crosses itself
/// both places are told.
inline std::vector<Crossing> crossings_of(std::span<const Line> lines, const View& view) {
    const detail::Plan plan(lines, view);
    std::vector<Crossing> crossings;
    for (const detail::Meeting& m : detail::meetings(plan)) {
        const detail::MeetingPlace place = detail::place_of(m, lines, plan, view);
        const bool first = place.height_a > place.height_b;
        crossings.push_back(first ? Crossing{m.line_a, m.line_b, place.at_a, place.at_b, place.axis}
                                  : Crossing{m.line_b, m.line_a, place.at_b, place.at_a, place.axis});
    }
    return crossings;
}
inline std::vector<Crossing> crossings_of(const Textile& textile, const View& view) {
    return crossings_of(lines_of(textile), view);
}
inline std::vector<Crossing> crossings_of(const Textile& textile) { return crossings_of(textile, textile.view); }

/// What each path is at its crossings, in their order along it: 'o' over, 'u' under.
inline std::vector<std::string> order_words(const std::vector<Crossing>& crossings, Index paths) {
    std::vector<std::vector<std::pair<double, char>>> places(core::at(paths));
    for (const Crossing& crossing : crossings) {
        places[core::at(crossing.above)].emplace_back(crossing.at_above, 'o');
        places[core::at(crossing.below)].emplace_back(crossing.at_below, 'u');
    }
    std::vector<std::string> words;
    for (auto& place : places) {
        std::stable_sort(place.begin(), place.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
        std::string word;
        for (const auto& [at, letter] : place) word += letter;
        words.push_back(word);
    }
    return words;
}

/// How the crossings of settled lines compare with those that were asked for.
struct CrossingAudit {
    Index right = 0;
    Index wrong = 0;                          ///< the other one is above
    Index missing = 0;                        ///< asked for and not found
    Index extra = 0;                          ///< found and not asked for
    Index first_path = -1, second_path = -1;  ///< of the first that is not right; -1 where all are
    bool clean() const noexcept { return wrong == 0 && missing == 0 && extra == 0; }
};

/// Crossings of each pair of paths, in their order along the first, against those asked for: owes nothing to contact. Where a
/// pair has as many as asked for they are compared one by one; else the difference is missing or extra, and of the rest as many
/// are right as their orders are alike.
inline CrossingAudit audit_crossings(std::vector<Crossing> asked, std::vector<Crossing> found) {
    struct Seen {
        Index low, high;
        double at;
        bool low_above;
        auto key() const noexcept { return std::tie(low, high, at); }
    };
    const auto sorted = [](const std::vector<Crossing>& crossings) {
        std::vector<Seen> seen;
        for (const Crossing& c : crossings) {
            const bool first = c.above < c.below || (c.above == c.below && c.at_above < c.at_below);
            seen.push_back({std::min(c.above, c.below), std::max(c.above, c.below), first ? c.at_above : c.at_below, first});
        }
        std::sort(seen.begin(), seen.end(), [](const Seen& a, const Seen& b) { return a.key() < b.key(); });
        return seen;
    };
    const std::vector<Seen> a = sorted(asked), b = sorted(found);
    CrossingAudit audit;
    const auto blame = [&](const Seen& seen) {
        if (audit.first_path < 0) audit.first_path = seen.low, audit.second_path = seen.high;
    };
    for (std::size_t i = 0, j = 0; i < a.size() || j < b.size();) {
        const Seen& next =
            j == b.size() || (i < a.size() && std::tie(a[i].low, a[i].high) <= std::tie(b[j].low, b[j].high)) ? a[i] : b[j];
        const auto of_pair = [&](const Seen& seen) { return seen.low == next.low && seen.high == next.high; };
        std::size_t i_end = i, j_end = j;
        while (i_end < a.size() && of_pair(a[i_end])) ++i_end;
        while (j_end < b.size() && of_pair(b[j_end])) ++j_end;
        const std::size_t wanted = i_end - i, there = j_end - j, both = std::min(wanted, there);
        Index alike = 0;
        if (wanted == there) {
            for (std::size_t k = 0; k < both; ++k) alike += a[i + k].low_above == b[j + k].low_above ? 1 : 0;
        } else {
            Index low_a = 0, low_b = 0;
            for (std::size_t k = i; k < i_end; ++k) low_a += a[k].low_above ? 1 : 0;
            for (std::size_t k = j; k < j_end; ++k) low_b += b[k].low_above ? 1 : 0;
            alike = std::min(low_a, low_b) + std::min(static_cast<Index>(wanted) - low_a, static_cast<Index>(there) - low_b);
        }
        audit.right += alike, audit.wrong += static_cast<Index>(both) - alike;
        audit.missing += static_cast<Index>(wanted - both), audit.extra += static_cast<Index>(there - both);
        if (wanted != there || alike < static_cast<Index>(both)) blame(next);
        i = i_end, j = j_end;
    }
    return audit;
}

/// The value nearest to a given one at which something holds: looked for in steps both ways, then between two steps.
/// @param given       at which it does not hold
/// @param low, high   of all values that are tried
/// @returns NaN where none of them holds
template <class Holds>
double nearest_that_holds(double given, double low, double high, const Holds& holds) {
    constexpr int steps = 40;
    constexpr double close = 1e-3;  // of the given value
    for (int k = 1; k <= steps; ++k)
        for (const double end : {low, high}) {
            const auto at = [&](int n) { return given + (end - given) * static_cast<double>(n) / steps; };
            double good = at(k), bad = at(k - 1);
            if (good == given || !holds(good)) continue;
            while (std::abs(good - bad) > close * std::abs(given)) {
                const double middle = 0.5 * (good + bad);
                (holds(middle) ? good : bad) = middle;
            }
            return good;
        }
    return core::unset;
}

/// Refuses a textile that crosses itself more or less often than its generator says: loops that do not reach each other hold
/// nothing, and those that reach too far lie in their neighbours.
/// @param fields  that the crossings follow from
/// @param why     so many
/// @throws std::invalid_argument
inline void require_crossings(const Textile& textile, Index asked, const std::string& fields, const std::string& why) {
    const Index found = core::count(textile.crossings);
    if (found != asked) core::refuse(fields, std::to_string(found) + " crossings", std::to_string(asked) + ": " + why);
}
/// The same, with a value that would do.
/// @param field   that crossings are most sensitive to, which is `given`, and > low
/// @param others  that they follow from as well
/// @param why     so many
/// @param drawn   the same textile with another value of that field
/// @throws std::invalid_argument naming the nearest value with the right number, if there is one
template <class Drawn>
void require_crossings(const Textile& textile, Index asked, const std::string& field, double given, double low,
                       const std::string& others, const std::string& why, const Drawn& drawn) {
    const Index found = core::count(textile.crossings);
    if (found == asked) return;
    const double start = low > 0.0 ? std::min(given, 4.0 * low) : given;  // far above nothing can hold, and takes long to draw
    const double nearest = nearest_that_holds(start, low, 2.0 * start,
                                              [&](double x) { return x > low && core::count(drawn(x).crossings) == asked; });
    const std::string need = std::to_string(asked) + " crossings, not " + std::to_string(found) + ": " + why;
    if (std::isnan(nearest)) core::refuse(field, core::text(given), "changed, or " + others + ", for " + need);
    core::refuse(field, core::text(given),
                 (nearest < given ? "<= " : ">= ") + core::text(nearest) + " at this " + others + ", for " + need);
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file A textile as data: types of yarn, their paths, and which is above where two of them cross.

#include <fibrant/scene/conditions.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/elastic_material.hpp>
#include <fibrant/scene/spline.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::compositions::textile {

/// What is laid along a path: one fibre, or a packing of several that may be twisted about it.
struct YarnType {
    std::string name = "yarn";    ///< in tables and messages
    Index fibres = 1;             ///< >= 1
    double radius = core::unset;  ///< of a fibre [length], > 0
    double inertia_factor = 1.0;  ///< on second moments, for a fibre that stands for several [1], > 0
    double aspect = 1.0;          ///< width over thickness of the packing [1], >= 1
    double packing_gap = 0.02;    ///< free distance of neighbours over their diameter [1], >= 0
    double twist = 0.0;           ///< of the packing about the path, > 0 right-handed [turns / length]
    scene::ElasticMaterial material{};
    /// Length of all paths over the radius of their fibres, were all of this type [1], > 0: what is longer is not drawn.
    double longest = 5e6;

    void validate() const {
        core::require_at_least("YarnType.fibres", fibres, 1);
        core::require_positive("YarnType.radius", radius);
        core::require_positive("YarnType.inertia_factor", inertia_factor);
        core::require(std::isfinite(aspect) && aspect >= 1.0, "YarnType.aspect", aspect, "finite and >= 1");
        core::require_not_negative("YarnType.packing_gap", packing_gap);
        core::require_finite("YarnType.twist", twist);
        core::require_positive("YarnType.longest", longest);
        material.validate();
    }
};

/// How a yarn's path ends.
enum class PathKind : std::uint8_t {
    open,
    closed,    ///< ends where it begins
    periodic,  ///< ends at the image of its start
};

/// What is done to the two ends of an open path.
enum class Ends : std::uint8_t {
    free,
    held,    ///< keep their places; free to turn
    pulled,  ///< keep their places across the path, and are pulled along it by the tension
};

/// A station of a path whose place is held.
struct Guide {
    double at = 0.0;                     ///< fraction of the length, in [0, 1]
    Mat3 directions = Mat3::Identity();  ///< symmetric projector on what is held
};

/// Where a yarn lies at first.
struct Path {
    std::string name{};
    scene::Curve curve{};
    PathKind kind = PathKind::open;
    Vec3 image = Vec3::Zero();    ///< from the start of a periodic path to its end [length]
    Index type = 0;               ///< of YarnType
    Index family = 0;             ///< of like yarns; for measures and pictures
    Ends ends = Ends::held;       ///< of an open path
    double tension_strain = 0.0;  ///< pull of each fibre over its E A, of ends that are pulled, or of a periodic path [1], >= 0
    Vec3 pull = Vec3::Zero();     ///< direction that an end that is pulled goes in; zero: along the path
    /// Part of an open path at either end that lies in a grip: where it leaves that, it keeps its place across the pull, unless
    /// ends are free [1], in [0, 0.5).
    double grip = 0.0;
    std::vector<Guide> guides{};
    bool straight = true;        ///< at rest, as long as it is drawn; else its rest shape is what is drawn
    Vec3 upward = Vec3::Zero();  ///< thickness of the packing at the start; zero: any
};

/// A place where two paths cross as seen along an axis.
struct Crossing {
    Index above = -1, below = -1;           ///< paths; may be the same one
    double at_above = 0.0, at_below = 0.0;  ///< arc from the start of each, as drawn [length]
    Vec3 axis = Vec3::UnitZ();              ///< from below to above, as it is at the crossing, unit
};

/// From where crossings are seen: along one axis, or from a line outwards.
struct View {
    Vec3 axis = Vec3::UnitZ();   ///< unit: of sight, or of the line
    bool radial = false;         ///< above means farther from the line
    Vec3 centre = Vec3::Zero();  ///< a point of the line [length]
};

/// A length that neighbouring paths are apart by, for messages that say how far they should be.
struct ApartBy {
    std::string field{};         ///< of a generator; none: of its own
    double given = core::unset;  ///< value of it
    double whole = core::unset;  ///< what the distance of paths is proportional to, which is `given` and as much more as ever
    ApartBy() = default;
    ApartBy(std::string name, double value, double more = 0.0) : field{std::move(name)}, given{value}, whole{value + more} {}
};

/// A textile: all that its fibres are made from.
struct Textile {
    std::string name = "textile";
    std::vector<YarnType> types{};
    std::vector<Path> paths{};
    std::vector<Crossing> crossings{};
    View view{};
    /// Periods of the cell that periodic paths repeat in, and which components of its gradient are free (i + 3 j as in
    /// scene::PeriodicCell), under the tension of these paths.
    std::vector<Vec3> lattice{};
    std::array<bool, 9> free_gradient{};
    std::array<ApartBy, 3> apart_by{};  ///< along x, y and z

    /// What repeats along an axis may grow and shrink there, so that tension rules its length.
    void free_lengths() noexcept {
        for (const Vec3& period : lattice)
            for (int k = 0; k < 3; ++k)
                if (period[k] != 0.0) free_gradient[static_cast<std::size_t>(4 * k)] = true;
    }

    const YarnType& type_of(Index path) const { return types[core::at(paths[core::at(path)].type)]; }
    double smallest_radius() const {
        double least = std::numeric_limits<double>::infinity();
        for (const Path& path : paths) least = std::min(least, types[core::at(path.type)].radius);
        return least;
    }
    std::string label(Index path) const { return scene::label("yarn", path, paths[core::at(path)].name); }
};

/// Number of the fibres in all.
inline Index fibre_count(const Textile& textile) {
    Index sum = 0;
    for (Index p = 0; p < core::count(textile.paths); ++p) sum += textile.type_of(p).fibres;
    return sum;
}

/// Half of the greatest extent of a yarn's section, were it packed as densely as circles can be in the ellipse of its aspect
/// [length].
inline double half_width(const YarnType& type) {
    if (type.fibres == 1) return type.radius;
    constexpr double densest = 0.9068996821171089;  // pi / sqrt(12)
    return type.radius * (1.0 + type.packing_gap) * std::sqrt(static_cast<double>(type.fibres) * type.aspect / densest);
}

namespace detail {
/// Least radius of curvature of a curve of which `samples` points are taken, and the parameter where it is.
inline std::pair<double, double> tightest(const scene::Curve& curve, Index samples, bool closed) {
    std::pair<double, double> least{std::numeric_limits<double>::infinity(), 0.0};
    const double h = 1.0 / static_cast<double>(samples);
    for (Index k = closed ? 0 : 1; k < samples; ++k) {
        const double t = h * static_cast<double>(k);
        const Vec3 a = curve(k == 0 ? 1.0 - h : t - h), b = curve(t), c = curve(t + h);
        const double area = (b - a).cross(c - b).norm(), ahead = (b - a).dot(c - b);
        // The circle through three points; of those that go back it would be the wider, the sharper they turn.
        const double radius = ahead > 0.0 ? (b - a).norm() * (c - b).norm() * (c - a).norm() / (2.0 * area)
                                          : 0.5 * ((b - a).norm() + (c - b).norm()) / std::atan2(area, ahead);
        if (radius < least.first) least = {radius, t};
    }
    return least;
}

/// Least radius of curvature that a yarn may have [length]: the outermost fibre of a bend is as thick as it is; a twentieth is
/// left for what bends further while it settles.
inline double least_bend(const YarnType& type) { return half_width(type) / 0.95; }
/// That of a path, and the parameter where it is.
/// @param length  of the path
inline std::pair<double, double> tightest_bend(const Path& path, const YarnType& type, double length) {
    constexpr double per_radius = 4.0;  // points: what steps over a bend has not seen it
    const Index samples = std::clamp<Index>(static_cast<Index>(per_radius * length / type.radius), 64, 400000);
    return tightest(path.curve, samples, path.kind == PathKind::closed);
}

/// Refuses a path that bends more sharply than its yarn is thick.
/// @param length  of the path
/// @param field   that messages begin with
inline void require_bends(const Path& path, const YarnType& type, double length, const std::string& field = "Path.curve: ") {
    const double least = least_bend(type);
    const auto [tight, at] = tightest_bend(path, type, length);
    core::require(tight >= least, field + "radius of curvature at parameter " + core::text(at), tight,
                  ">= " + core::text(least) + ", the half width of the yarn over 0.95");
}
}  // namespace detail

/// Refuses what cannot be laid, by yarn and place: wrong numbers, curves that bend more sharply than their fibres are thick, ends
/// that do not close.
/// @throws std::invalid_argument
inline void validate(const Textile& textile) {
    if (textile.paths.empty()) core::refuse("Textile.paths", "none", "at least one");
    for (Index k = 0; k < core::count(textile.types); ++k)
        core::with_place([&] { return scene::label("type", k, textile.types[core::at(k)].name); },
                         [&] { textile.types[core::at(k)].validate(); });
    for (Index p = 0; p < core::count(textile.paths); ++p) {
        const Path& path = textile.paths[core::at(p)];
        core::with_place([&] { return textile.label(p); },
                         [&] {
                             if (!path.curve) core::refuse("Path.curve", "none", "a curve");
                             if (path.type < 0 || path.type >= core::count(textile.types))
                                 core::refuse("Path.type", std::to_string(path.type), "a type of the textile");
                             core::require_not_negative("Path.tension_strain", path.tension_strain);
                             scene::require_finite("Path.pull", path.pull);
                             if (path.ends == Ends::pulled && path.kind == PathKind::open)
                                 core::require_positive("Path.tension_strain, of ends that are pulled", path.tension_strain);
                             core::require(path.grip >= 0.0 && path.grip < 0.5, "Path.grip", path.grip, ">= 0 and < 0.5");
                             for (const Guide& guide : path.guides) {
                                 core::require_between("Guide.at", guide.at, 0.0, 1.0);
                                 scene::require_projector("Guide.directions", guide.directions);
                             }
                             scene::require_finite("Path.curve: start", path.curve(0.0));
                             scene::require_finite("Path.curve: end", path.curve(1.0));
                             const YarnType& type = textile.types[core::at(path.type)];
                             const double length = scene::length_of(path.curve, 128),
                                          open = (path.curve(1.0) - path.curve(0.0) - path.image).norm();
                             core::require(std::isfinite(length) && length > 0.0, "Path.curve: length", length, "finite and > 0");
                             if (path.kind != PathKind::open)
                                 core::require(open <= 1e-9 * length,
                                               "Path.curve: distance of its end from the image of its start", open, "nothing");
                             if (path.kind == PathKind::closed)
                                 core::require(path.image.norm() == 0.0, "Path.image, of a closed path", path.image.norm(), "0");
                             if (path.kind == PathKind::periodic)
                                 core::require(path.image.norm() > 0.0, "Path.image, of a periodic path", path.image.norm(),
                                               "> 0");
                             detail::require_bends(path, type, length);
                         });
    }
    for (Index c = 0; c < core::count(textile.crossings); ++c) {
        const Crossing& crossing = textile.crossings[core::at(c)];
        core::with_place([&] { return scene::label("crossing", c); },
                         [&] {
                             for (const Index path : {crossing.above, crossing.below})
                                 if (path < 0 || path >= core::count(textile.paths))
                                     core::refuse("Crossing", std::to_string(path), "a yarn of the textile");
                             core::require(std::abs(crossing.axis.norm() - 1.0) <= scene::matrix_rounding,
                                           "Crossing.axis: length", crossing.axis.norm(), "1");
                         });
    }
}

/// Refuses a textile from which yarns can be lifted: those of a set that lie above all others at every crossing.
///
/// No such set exists if and only if the graph "A lies above B" is strongly connected (Clapham 1980, Enns 1984), here in each
/// part that crossings join. Time linear in the crossings. It does not see what holds by ends or by links.
/// @param field  that the crossings follow from
/// @throws std::invalid_argument naming the yarns
inline void require_holding(const Textile& textile, const std::string& field = "Textile.crossings") {
    const Index n = core::count(textile.paths);
    std::vector<std::vector<Index>> down(core::at(n)), up(core::at(n));
    for (const Crossing& crossing : textile.crossings) {
        if (crossing.above == crossing.below) continue;
        down[core::at(crossing.above)].push_back(crossing.below);
        up[core::at(crossing.below)].push_back(crossing.above);
    }
    const auto reached = [&](Index from, const std::vector<std::vector<Index>>& along) {
        std::vector<bool> seen(core::at(n), false);
        std::vector<Index> open{from};
        seen[core::at(from)] = true;
        while (!open.empty()) {
            const Index path = open.back();
            open.pop_back();
            for (const Index next : along[core::at(path)])
                if (!seen[core::at(next)]) seen[core::at(next)] = true, open.push_back(next);
        }
        return seen;
    };
    std::vector<std::vector<Index>> joined = down;
    for (Index k = 0; k < n; ++k)
        joined[core::at(k)].insert(joined[core::at(k)].end(), up[core::at(k)].begin(), up[core::at(k)].end());
    std::vector<bool> done(core::at(n), false);
    for (Index k = 0; k < n; ++k) {
        if (done[core::at(k)]) continue;
        const std::vector<bool> part = reached(k, joined), below = reached(k, down), above = reached(k, up);
        bool lower = false;
        std::vector<Index> set, others;
        for (Index p = 0; p < n; ++p)
            if (part[core::at(p)]) done[core::at(p)] = true, lower = lower || !below[core::at(p)];
        // What is not reached downwards lies above all that is; else what does not reach it lies below.
        for (Index p = 0; p < n; ++p)
            if (part[core::at(p)]) ((lower ? below : above)[core::at(p)] ? others : set).push_back(p);
        if (set.empty()) continue;
        const bool fewer = set.size() <= others.size();  // are named
        const std::vector<Index>& named = fewer ? set : others;
        std::string loose;
        for (std::size_t m = 0; m < std::min<std::size_t>(named.size(), 4); ++m)
            loose += (m > 0 ? ", " : "") + textile.label(named[m]);
        core::refuse(field, "an interlacing that comes apart",
                     "one that holds: " + loose + (named.size() > 4 ? ", ..." : "") + (named.size() == 1 ? " lies " : " lie ") +
                         (lower == fewer ? "above" : "below") + " all that " + (named.size() == 1 ? "it crosses" : "they cross"));
    }
}

}  // namespace fibrant::compositions::textile

// SPDX-License-Identifier: MIT
#pragma once
/// @file True least distance between the surfaces of all fibres.

#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/observe/nodal_curve.hpp>
#include <fibrant/observe/snapshot.hpp>
#include <fibrant/observe/surface_gap.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/proximity/segment_distance.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <vector>

namespace fibrant::observe {

/// The closest two fibres.
struct LeastGap {
    double gap = std::numeric_limits<double>::infinity();  ///< between surfaces, < 0 in penetration [length]
    double gap_over_radius = std::numeric_limits<double>::infinity();  ///< over the smaller radius at rest [1]
    Index fibre_i = -1, fibre_j = -1;
    Vec3 position = Vec3::Zero();  ///< half way between the two axes [length]
};

/// Half extent of a fibre's deformed section along a unit direction [length].
inline double section_extent(const FibreSnapshot& fibre, const NodalCurve& curve, double t,
                             const Vec3& direction) {
    return fibre.section.extent(curve.interpolate(std::span<const Vec3>{fibre.director_1}, t), curve.interpolate(std::span<const Vec3>{fibre.director_2}, t), direction);
}

namespace detail {

/// Parameters of the closest points of two curves within one node interval each, from a first guess.
///
/// Newton's method on the squared distance with a Levenberg-Marquardt damping, which near-parallel curves need, kept in
/// the intervals; the distance never rises.
inline void closest_points(const NodalCurve& a, const NodalCurve& b, double a_from, double b_from, double& t,
                           double& u) {
    const auto half_square = [&](double p, double q) { return 0.5 * (a.position(p) - b.position(q)).squaredNorm(); };
    double value = half_square(t, u), damping = 1e-6;
    for (int iteration = 0; iteration < 40 && damping < 1e6; ++iteration) {
        const Vec3 d = a.position(t) - b.position(u), p = a.tangent(t), q = b.tangent(u);
        double gt = d.dot(p), gu = -d.dot(q);
        double tt = p.squaredNorm() + std::max(0.0, d.dot(a.second(t)));
        double uu = q.squaredNorm() + std::max(0.0, -d.dot(b.second(u)));
        double tu = -p.dot(q);
        // A parameter at its bound that would leave the interval is held there.
        if ((t <= a_from && gt > 0.0) || (t >= a_from + 1.0 && gt < 0.0)) gt = tu = 0.0;
        if ((u <= b_from && gu > 0.0) || (u >= b_from + 1.0 && gu < 0.0)) gu = tu = 0.0;
        tt *= 1.0 + damping;
        uu *= 1.0 + damping;
        const double determinant = tt * uu - tu * tu;
        const double next_t = std::clamp(t - (uu * gt - tu * gu) / determinant, a_from, a_from + 1.0);
        const double next_u = std::clamp(u - (tt * gu - tu * gt) / determinant, b_from, b_from + 1.0);
        const double next = half_square(next_t, next_u);
        if (!(next < value)) {
            damping *= 10.0;
            continue;
        }
        const bool settled = std::abs(next_t - t) + std::abs(next_u - u) < 1e-10;
        t = next_t;
        u = next_u;
        value = next;
        damping = std::max(0.1 * damping, 1e-12);
        if (settled) break;
    }
}

}  // namespace detail

/// Whether a fibre is also held against itself, beyond the arc that contact leaves out.
enum class OwnTurns : std::uint8_t { left_out, counted };

/// The least distance between the surfaces of any two fibres, which owes nothing to contact elements: what lies deeper in
/// another one than they say, beside a crossing or where a mesh is too coarse for a section, is seen here.
///
/// Fibres are those of three-node elements. Their ends are flat, and count.
/// A search over the half elements, inflated by their deviation from the chord, gives the candidates. Round sections are closest
/// where the curves are, along the line that joins these points; others are searched by `PairedPieces`. Candidates
/// whose lower bound exceeds the best gap so far are passed over. Never quadratic: the reach grows from zero until a
/// pair is met.
/// @param own_turns  counted: a fibre against itself, where two places of it beyond that arc are closer than those beside them
template <proximity::ProximitySearch Search>
LeastGap least_gap(const Snapshot& snapshot, Search search, OwnTurns own_turns = OwnTurns::left_out) {
    const auto fibres = core::count(snapshot.fibres);
    std::vector<proximity::Centreline> lines(core::at(fibres));
    std::vector<std::vector<double>> inflation(core::at(fibres)), wide(core::at(fibres));  // of each node interval
    std::vector<Index> first(core::at(fibres) + 1, 0), owner;
    std::vector<FibreSurface> surfaces;
    std::vector<char> round;
    double greatest_radius = 0.0, extent = 0.0;
    for (std::size_t k = 0; k < lines.size(); ++k) {
        const FibreSnapshot& fibre = snapshot.fibres[k];
        surfaces.emplace_back(fibre);
        round.push_back(surfaces.back().round() ? 1 : 0);
        const NodalCurve& curve = surfaces.back().curve();
        double radius = 0.0;  // of the sections as they are deformed
        // Half an element deviates from its chord by |x''| (1/2)^2 / 2, x'' over the parameter of one node interval.
        for (std::size_t piece = 0; piece + 1 < fibre.position.size(); ++piece) {
            inflation[k].push_back(curve.second(static_cast<double>(piece)).norm() / 8.0);
            wide[k].push_back(surfaces.back().greatest_extent(piece));
            radius = std::max(radius, wide[k].back());
            owner.push_back(static_cast<Index>(k));
        }
        lines[k] = {fibre.position, radius, inflation[k], -1};
        lines[k].closed = fibre.closed;
        if (own_turns == OwnTurns::counted)
            lines[k].self_skip = contact::self_contact_arc(fibre.section.radius(), curve.length(0.0, curve.end()) / static_cast<double>(curve.elements()));
        first[k + 1] = core::count(owner);
        greatest_radius = std::max(greatest_radius, radius);
        for (const Vec3& node : fibre.position)
            extent = std::max(extent, (node - snapshot.fibres[0].position[0]).norm());
    }

    LeastGap least;
    double best_reach = 0.0;
    for (double reach = 0.0; std::isinf(least.gap) || least.gap > best_reach;
         reach = std::max({2.0 * reach, 0.1 * greatest_radius, std::isinf(least.gap) ? 0.0 : least.gap})) {
        best_reach = reach;
        struct Candidate {
            double bound, t, u;  ///< parameters of the closest points of the chords
            Index i, j, p, q;    ///< fibres, and node intervals
        };
        const std::vector<proximity::SegmentPair> pairs = search.pairs(lines, reach);
        std::vector<Candidate> candidates(pairs.size());
        core::parallel_for(core::count(pairs), [&](Index n) {
            const proximity::SegmentPair& pair = pairs[core::at(n)];
            const Index i = owner[core::at(pair.i)], j = owner[core::at(pair.j)];
            const Index p = pair.i - first[core::at(i)], q = pair.j - first[core::at(j)];
            const auto &a = lines[core::at(i)].points, &b = lines[core::at(j)].points;
            const Vec3 u = a[core::at(p + 1)] - a[core::at(p)], v = b[core::at(q + 1)] - b[core::at(q)];
            const auto near = proximity::segment_distance(a[core::at(p)], u, b[core::at(q)], v);
            candidates[core::at(n)] = {std::sqrt(near.squared) - inflation[core::at(i)][core::at(p)] -
                                           inflation[core::at(j)][core::at(q)] - wide[core::at(i)][core::at(p)] -
                                           wide[core::at(j)][core::at(q)],
                                       static_cast<double>(p) + near.s,
                                       static_cast<double>(q) + near.t,
                                       i,
                                       j,
                                       p,
                                       q};
        });
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            if (a.bound != b.bound) return a.bound < b.bound;
            return std::tie(a.i, a.p, a.j, a.q) < std::tie(b.i, b.p, b.j, b.q);
        });
        const auto measured = [&](const Candidate& candidate) {
            const FibreSurface &i = surfaces[core::at(candidate.i)], &j = surfaces[core::at(candidate.j)];
            double t = candidate.t, u = candidate.u;
            detail::closest_points(i.curve(), j.curve(), static_cast<double>(candidate.p), static_cast<double>(candidate.q), t, u);
            const Vec3 apart = j.curve().position(u) - i.curve().position(t);
            const double distance = apart.norm();
            const double widest = wide[core::at(candidate.i)][core::at(candidate.p)] + wide[core::at(candidate.j)][core::at(candidate.q)];
            if (distance - widest > least.gap) return SurfaceGap{};
            if (round[core::at(candidate.i)] == 0 || round[core::at(candidate.j)] == 0)
                return PairedPieces(i, j, static_cast<double>(candidate.p), static_cast<double>(candidate.q)).closest(t, u);
            const Vec3 direction = distance > 0.0 ? Vec3(apart / distance) : Vec3(Vec3::UnitZ());
            return SurfaceGap{distance - i.extent(t, direction) - j.extent(u, direction), t, u, direction};
        };
        // Block by block: what is passed over depends on the blocks, and these on nothing else.
        constexpr std::size_t most = 256;
        std::vector<SurfaceGap> found(most);
        std::size_t together = 16;  // the first few show how little is left to look for
        for (std::size_t start = 0, count = 0; start < candidates.size() && candidates[start].bound < least.gap; start += count) {
            count = std::min(together, candidates.size() - start);
            together = std::min(most, 2 * together);
            core::parallel_for<core::Share::turns>(static_cast<Index>(count), [&](Index k) { found[core::at(k)] = measured(candidates[start + core::at(k)]); });
            for (std::size_t k = 0; k < count; ++k) {
                if (!(found[k].gap < least.gap)) continue;
                const Candidate& candidate = candidates[start + k];
                // Of one fibre only what is closest there and not beside, where the arc that is left out begins.
                const double nearest = 1e-6;
                const double p = static_cast<double>(candidate.p), q = static_cast<double>(candidate.q);
                const bool around = snapshot.fibres[core::at(candidate.i)].closed && q - p > 0.5 * surfaces[core::at(candidate.i)].curve().end();
                if (candidate.i == candidate.j && (around ? found[k].t < p + nearest || found[k].u > q + 1.0 - nearest
                                                          : found[k].t > p + 1.0 - nearest || found[k].u < q + nearest))
                    continue;
                const FibreSurface &i = surfaces[core::at(candidate.i)], &j = surfaces[core::at(candidate.j)];
                const scene::CrossSection &one = snapshot.fibres[core::at(candidate.i)].section, &other = snapshot.fibres[core::at(candidate.j)].section;
                const double radius = std::min({one.semi_axis_1, one.semi_axis_2, other.semi_axis_1, other.semi_axis_2});
                const Vec3 middle = 0.5 * (i.curve().position(found[k].t) + j.curve().position(found[k].u));
                least = {found[k].gap, found[k].gap / radius, candidate.i, candidate.j, middle};
            }
        }
        if (reach > 2.0 * extent) break;  // a single fibre
    }
    return least;
}

}  // namespace fibrant::observe

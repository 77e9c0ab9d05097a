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
#include <utility>
#include <vector>

namespace fibrant::observe {

/// The closest two fibres.
struct LeastGap {
    double gap = std::numeric_limits<double>::infinity();              ///< between surfaces, < 0 in penetration [length]
    double gap_over_radius = std::numeric_limits<double>::infinity();  ///< over the smaller radius at rest [1]
    Index fibre_i = -1, fibre_j = -1;
    Vec3 position = Vec3::Zero();  ///< half way between the two axes [length]
    double t = 0.0, u = 0.0;       ///< parameters of the two sections, counted in node intervals
};

/// Half extent of a fibre's deformed section along a unit direction [length].
inline double section_extent(const FibreSnapshot& fibre, const NodalCurve& curve, double t, const Vec3& direction) {
    return fibre.section.extent(curve.interpolate(std::span<const Vec3>{fibre.director_1}, t),
                                curve.interpolate(std::span<const Vec3>{fibre.director_2}, t), direction);
}

namespace detail {

/// Parameters of the closest points of two curves within one node interval each, from a first guess.
///
/// Newton's method on the squared distance with a Levenberg-Marquardt damping, which near-parallel curves need, kept in
/// the intervals; the distance never rises.
inline void closest_points(const NodalCurve& a, const NodalCurve& b, double a_from, double b_from, double& t, double& u) {
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

namespace detail {

/// Pairs of node intervals of a snapshot's fibres, and how close their surfaces are. Of a search over the half elements, inflated
/// by their deviation from the chord.
template <proximity::ProximitySearch Search>
class SurfacePairs {
public:
    struct Candidate {
        double bound, t, u;  ///< of the gap, from below; parameters of the closest points of the chords
        Index i, j, p, q;    ///< fibres, and node intervals
    };

    SurfacePairs(const Snapshot& snapshot, Search search, OwnTurns own_turns) : snapshot_{&snapshot}, search_{std::move(search)} {
        const std::size_t fibres = snapshot.fibres.size();
        lines_.resize(fibres), inflation_.resize(fibres), wide_.resize(fibres), first_.assign(fibres + 1, 0);
        for (std::size_t k = 0; k < fibres; ++k) {
            const FibreSnapshot& fibre = snapshot.fibres[k];
            surfaces_.emplace_back(fibre);
            round_.push_back(surfaces_.back().round() ? 1 : 0);
            const NodalCurve& curve = surfaces_.back().curve();
            double radius = 0.0;  // of the sections as they are deformed
            // Half an element deviates from its chord by |x''| (1/2)^2 / 2, x'' over the parameter of one node interval.
            for (std::size_t piece = 0; piece + 1 < fibre.position.size(); ++piece) {
                inflation_[k].push_back(curve.second(static_cast<double>(piece)).norm() / 8.0);
                wide_[k].push_back(surfaces_.back().greatest_extent(piece));
                radius = std::max(radius, wide_[k].back());
                owner_.push_back(static_cast<Index>(k));
            }
            lines_[k] = {fibre.position, radius, inflation_[k], -1};
            lines_[k].closed = fibre.closed;
            if (own_turns == OwnTurns::counted)
                lines_[k].self_skip = contact::self_contact_arc(
                    fibre.section.radius(), curve.length(0.0, curve.end()) / static_cast<double>(curve.elements()));
            first_[k + 1] = core::count(owner_);
            greatest_radius_ = std::max(greatest_radius_, radius);
            for (const Vec3& node : fibre.position) extent_ = std::max(extent_, (node - snapshot.fibres[0].position[0]).norm());
        }
    }
    SurfacePairs(const SurfacePairs&) = delete;  // lines look at inflations
    SurfacePairs& operator=(const SurfacePairs&) = delete;

    double greatest_radius() const noexcept { return greatest_radius_; }  ///< of any section as it is deformed [length]
    double extent() const noexcept { return extent_; }                    ///< greatest distance from the first node [length]

    /// All within a reach, the closest first.
    std::vector<Candidate> candidates(double reach) {
        const std::vector<proximity::SegmentPair> pairs = search_.pairs(lines_, reach);
        std::vector<Candidate> found(pairs.size());
        core::parallel_for(core::count(pairs), [&](Index n) {
            const proximity::SegmentPair& pair = pairs[core::at(n)];
            const Index i = owner_[core::at(pair.i)], j = owner_[core::at(pair.j)];
            const Index p = pair.i - first_[core::at(i)], q = pair.j - first_[core::at(j)];
            const auto &a = lines_[core::at(i)].points, &b = lines_[core::at(j)].points;
            const Vec3 u = a[core::at(p + 1)] - a[core::at(p)], v = b[core::at(q + 1)] - b[core::at(q)];
            const auto near = proximity::segment_distance(a[core::at(p)], u, b[core::at(q)], v);
            double bound = std::sqrt(near.squared) - inflation_[core::at(i)][core::at(p)] - inflation_[core::at(j)][core::at(q)] -
                           wide_[core::at(i)][core::at(p)] - wide_[core::at(j)][core::at(q)];
            const double t = static_cast<double>(p) + near.s, s = static_cast<double>(q) + near.t;
            const double beside = 0.75;  // square of the cosine: of what crosses the depth is not that of sections
            if (bound < 0.0 && u.dot(v) * u.dot(v) > beside * u.squaredNorm() * v.squaredNorm())
                bound = std::max(bound, least_along_centres(i, j, p, q, t, s));
            found[core::at(n)] = {bound, t, s, i, j, p, q};
        });
        std::erase_if(found, [&](const Candidate& one) { return inside(one.i, one.j) || inside(one.j, one.i); });
        std::sort(found.begin(), found.end(), [](const Candidate& a, const Candidate& b) {
            if (a.bound != b.bound) return a.bound < b.bound;
            return std::tie(a.i, a.p, a.j, a.q) < std::tie(b.i, b.p, b.j, b.q);
        });
        return found;
    }

    /// Round sections are closest where the curves are, along the line that joins these points; others are searched by
    /// `PairedPieces`.
    /// @param most  gap beyond which it is not looked for, and infinite
    SurfaceGap measured(const Candidate& candidate, double most) const {
        const FibreSurface &i = surfaces_[core::at(candidate.i)], &j = surfaces_[core::at(candidate.j)];
        double t = candidate.t, u = candidate.u;
        closest_points(i.curve(), j.curve(), static_cast<double>(candidate.p), static_cast<double>(candidate.q), t, u);
        const Vec3 apart = j.curve().position(u) - i.curve().position(t);
        const double distance = apart.norm();
        const double widest =
            wide_[core::at(candidate.i)][core::at(candidate.p)] + wide_[core::at(candidate.j)][core::at(candidate.q)];
        if (distance - widest > most) return SurfaceGap{};
        const bool round = round_[core::at(candidate.i)] != 0 && round_[core::at(candidate.j)] != 0;
        if (!round && least_along_centres(candidate.i, candidate.j, candidate.p, candidate.q, t, u) > most) return {};
        if (!round) {
            const PairedPieces pieces(i, j, static_cast<double>(candidate.p), static_cast<double>(candidate.q));
            return pieces.closest(t, u, most);
        }
        const Vec3 direction = distance > 0.0 ? Vec3(apart / distance) : Vec3(Vec3::UnitZ());
        return SurfaceGap{distance - i.extent(t, direction) - j.extent(u, direction), t, u, direction};
    }

    /// Of one fibre only what is closest there counts, and not what is closest beside, where the arc that is left out begins.
    bool counts(const Candidate& candidate, const SurfaceGap& found) const {
        if (candidate.i != candidate.j) return true;
        const double nearest = 1e-6;
        const double p = static_cast<double>(candidate.p), q = static_cast<double>(candidate.q);
        const bool around =
            snapshot_->fibres[core::at(candidate.i)].closed && q - p > 0.5 * surfaces_[core::at(candidate.i)].curve().end();
        return !(around ? found.t < p + nearest || found.u > q + 1.0 - nearest
                        : found.t > p + 1.0 - nearest || found.u < q + nearest);
    }

    LeastGap place(const Candidate& candidate, const SurfaceGap& found) const {
        const FibreSurface &i = surfaces_[core::at(candidate.i)], &j = surfaces_[core::at(candidate.j)];
        const scene::CrossSection &one = snapshot_->fibres[core::at(candidate.i)].section,
                                  &other = snapshot_->fibres[core::at(candidate.j)].section;
        const double radius = std::min({one.semi_axis_1, one.semi_axis_2, other.semi_axis_1, other.semi_axis_2});
        const Vec3 middle = 0.5 * (i.curve().position(found.t) + j.curve().position(found.u));
        return {found.gap, found.gap / radius, candidate.i, candidate.j, middle, found.t, found.u};
    }

private:
    /// A fibre in a tube has its wall about it, and no surface of it beside.
    bool inside(Index rod, Index tube) const noexcept {
        const std::vector<Index>& tubes = snapshot_->fibres[core::at(rod)].inside;
        return std::find(tubes.begin(), tubes.end(), tube) != tubes.end();
    }
    /// Least gap of two node intervals along the line between two points of their curves: any one direction bounds the gap from
    /// below. This spares most pairs of fibres side by side the search [length].
    double least_along_centres(Index i, Index j, Index p, Index q, double t, double u) const noexcept {
        const FibreSurface &one = surfaces_[core::at(i)], &other = surfaces_[core::at(j)];
        const Vec3 apart = other.curve().position(u) - one.curve().position(t);
        const double distance = apart.norm();
        if (!(distance > 0.0)) return -std::numeric_limits<double>::infinity();
        const Vec3 across = apart / distance;
        return -one.furthest(core::at(p), across) - other.furthest(core::at(q), -across);
    }
    const Snapshot* snapshot_;
    Search search_;
    std::vector<proximity::Centreline> lines_;
    std::vector<std::vector<double>> inflation_, wide_;  // of each node interval
    std::vector<Index> first_, owner_;
    std::vector<FibreSurface> surfaces_;
    std::vector<char> round_;
    double greatest_radius_ = 0.0, extent_ = 0.0;
};

}  // namespace detail

/// The least distance between the surfaces of any two fibres, which owes nothing to contact elements: what lies deeper in
/// another one than they say, beside a crossing or where a mesh is too coarse for a section, is seen here.
///
/// Fibres are those of three-node elements. Their ends are flat, and count.
/// Candidates whose lower bound exceeds the best gap so far are passed over. Never quadratic: the reach grows from zero until a
/// pair is met.
/// @param own_turns  counted: a fibre against itself, where two places of it beyond that arc are closer than those beside them
/// @param furthest   gap beyond which pairs are not looked for, >= 0 [length]: where none is closer the answer may be infinite
template <proximity::ProximitySearch Search>
LeastGap least_gap(const Snapshot& snapshot, Search search, OwnTurns own_turns = OwnTurns::left_out,
                   double furthest = std::numeric_limits<double>::infinity()) {
    detail::SurfacePairs<Search> surfaces(snapshot, std::move(search), own_turns);
    LeastGap least;
    double best_reach = 0.0;
    for (double reach = 0.0; std::isinf(least.gap) || least.gap > best_reach;
         reach = std::max({2.0 * reach, 0.1 * surfaces.greatest_radius(), std::isinf(least.gap) ? 0.0 : least.gap})) {
        best_reach = reach;
        const auto candidates = surfaces.candidates(reach);
        // Block by block: what is passed over depends on the blocks, and these on nothing else.
        constexpr std::size_t most = 256;
        std::vector<SurfaceGap> found(most);
        std::size_t together = 16;  // the first few show how little is left to look for
        for (std::size_t start = 0, count = 0; start < candidates.size() && candidates[start].bound < least.gap; start += count) {
            count = std::min(together, candidates.size() - start);
            together = std::min(most, 2 * together);
            core::parallel_for<core::Share::turns>(static_cast<Index>(count), [&](Index k) {
                found[core::at(k)] = surfaces.measured(candidates[start + core::at(k)], std::min(least.gap, furthest));
            });
            for (std::size_t k = 0; k < count; ++k)
                if (found[k].gap < least.gap && surfaces.counts(candidates[start + k], found[k]))
                    least = surfaces.place(candidates[start + k], found[k]);
        }
        if (reach > 2.0 * surfaces.extent() || reach >= furthest) break;  // a single fibre, or all that was asked for
    }
    return least;
}

/// Every place where the surfaces of two fibres are deeper in each other than `depth`, the deepest first: of two of the same
/// fibres that are less than a node interval apart on both, the deeper one.
/// @param depth  >= 0 [length]
/// @param apart  the same for places within their node intervals, which are deepest there by themselves: two of a state that is
///               symmetric are mirrored, and equally deep, on either side of a node [node interval], in (0, 1]
template <proximity::ProximitySearch Search>
std::vector<LeastGap> deep_places(const Snapshot& snapshot, Search search, double depth, OwnTurns own_turns = OwnTurns::left_out,
                                  double apart = 1.0) {
    detail::SurfacePairs<Search> surfaces(snapshot, std::move(search), own_turns);
    auto candidates = surfaces.candidates(0.0);
    candidates.resize(
        core::at(std::partition_point(candidates.begin(), candidates.end(), [&](const auto& one) { return one.bound < -depth; }) -
                 candidates.begin()));
    std::vector<SurfaceGap> found(candidates.size());
    core::parallel_for<core::Share::turns>(
        core::count(candidates), [&](Index k) { found[core::at(k)] = surfaces.measured(candidates[core::at(k)], -depth); });
    std::vector<LeastGap> places;
    for (std::size_t k = 0; k < found.size(); ++k)
        if (found[k].gap < -depth && surfaces.counts(candidates[k], found[k]))
            places.push_back(surfaces.place(candidates[k], found[k]));
    const auto deeper = [](const LeastGap& a, const LeastGap& b) {
        return std::tie(a.gap, a.fibre_i, a.fibre_j, a.t, a.u) < std::tie(b.gap, b.fibre_i, b.fibre_j, b.t, b.u);
    };
    // Fibre by fibre, so that each is compared with those of its own pair alone.
    std::sort(places.begin(), places.end(), [&](const LeastGap& a, const LeastGap& b) {
        return std::tie(a.fibre_i, a.fibre_j) != std::tie(b.fibre_i, b.fibre_j)
                   ? std::tie(a.fibre_i, a.fibre_j) < std::tie(b.fibre_i, b.fibre_j)
                   : deeper(a, b);
    });
    std::vector<LeastGap> kept;
    for (const LeastGap& place : places) {
        bool near = false;
        const double on_node = 1e-6;
        const bool within =
            std::abs(place.t - std::round(place.t)) > on_node && std::abs(place.u - std::round(place.u)) > on_node;
        const double bound = within ? apart : 1.0;
        for (auto other = kept.rbegin();
             !near && other != kept.rend() && other->fibre_i == place.fibre_i && other->fibre_j == place.fibre_j; ++other)
            near = std::abs(other->t - place.t) < bound && std::abs(other->u - place.u) < bound;
        if (!near) kept.push_back(place);
    }
    std::sort(kept.begin(), kept.end(), deeper);
    return kept;
}

}  // namespace fibrant::observe

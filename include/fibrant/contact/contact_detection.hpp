// SPDX-License-Identifier: MIT
#pragma once
/// @file Proximity zones of a deformed mesh, by any search policy; forced orders are searched across their axis.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace fibrant::contact {

/// How centrelines are cut into segments for the search, and which fibres may meet themselves.
struct Detection {
    double chord_bound = 0.02;  ///< deviation of a curve from its segments, over the radius [1], > 0
    Index finest_cut = 8;       ///< segments an element, at most; what they miss is added to the reach
    bool self_contact = false;  ///< search each fibre against itself, beyond an arc of max(pi r, 2 elements)
    /// Reach that the motion of an increment asks for, which the loops set [length]. The smallest radius bounds the reach of a
    /// search; that of a thicker fibre is bounded by its own, and a pair reaches as far as the mean of its two.
    double wanted = 0.0;
    void validate() const {
        core::require_positive("Detection.chord_bound", chord_bound);
        core::require_at_least("Detection.finest_cut", finest_cut, 1);
    }
};

/// Which groups are in a forced order: read from a scene once.
class ForcedOrders {
public:
    ForcedOrders() = default;
    template <class B>
    ForcedOrders(const scene::Assembly& assembly, const beam::Mesh<B>& mesh) : orders_(assembly.orders()) {
        const Index groups = core::count(assembly.groups());
        if (orders_.empty()) return;
        group_count_ = groups;
        table_.assign(core::at(groups * groups), -1), next_.assign(orders_.size(), -1);
        std::vector<std::vector<Index>> neighbours(core::at(groups));
        for (Index k = 0; k < core::count(orders_); ++k) {
            const Index above = orders_[core::at(k)].above, below = orders_[core::at(k)].below;
            Index& last = table_[core::at(above * groups + below)];
            if (orders_[core::at(k)].placed()) next_[core::at(k)] = last;
            last = table_[core::at(below * groups + above)] = k;
            neighbours[core::at(above)].push_back(below);
            neighbours[core::at(below)].push_back(above);
        }
        // Two families, if the orders allow it: fibres of one are then never searched against each other.
        std::vector<Index> family(core::at(groups), -1);
        bool two = true;
        for (Index start = 0; start < groups; ++start) {
            if (family[core::at(start)] >= 0 || neighbours[core::at(start)].empty()) continue;
            family[core::at(start)] = 0;
            std::vector<Index> queue{start};
            while (!queue.empty()) {
                const Index group = queue.back();
                queue.pop_back();
                for (const Index next : neighbours[core::at(group)]) {
                    if (family[core::at(next)] < 0) {
                        family[core::at(next)] = 1 - family[core::at(group)];
                        queue.push_back(next);
                    } else if (family[core::at(next)] == family[core::at(group)]) {
                        two = false;
                    }
                }
            }
        }
        for (Index f = 0; f < mesh.line_count(); ++f) {
            const beam::MeshFibre& fibre = mesh.fibre(f);
            // Or the nearest ancestor that is in an order; images keep the side on which they are.
            Index group = fibre.image_of < 0 ? fibre.group : -1;
            while (group >= 0 && neighbours[core::at(group)].empty()) group = assembly.groups()[core::at(group)].parent;
            group_.push_back(group);
            family_.push_back(group >= 0 && two ? family[core::at(group)] : Index{-1});
        }
    }

    bool empty() const noexcept { return orders_.empty(); }
    /// Forced order between two fibres where they cross, or -1: of several that whose places are the nearest, of equally near
    /// ones the last one given.
    /// @param at_i, at_j  of the crossing along both, over their lengths [1]
    Index between(Index i, Index j, double at_i, double at_j) const noexcept {
        if (orders_.empty() || group_[core::at(i)] < 0 || group_[core::at(j)] < 0) return -1;
        Index best = table_[core::at(group_[core::at(i)] * group_count_ + group_[core::at(j)])];
        if (best < 0 || next_[core::at(best)] < 0) return best;
        const auto off = [&](Index order) {
            const scene::ForcedOrder& forced = orders_[core::at(order)];
            const bool i_below = group_[core::at(i)] == forced.below;
            return std::abs(at_i - (i_below ? forced.at_below : forced.at_above)) +
                   std::abs(at_j - (i_below ? forced.at_above : forced.at_below));
        };
        double least = off(best);
        for (Index k = next_[core::at(best)]; k >= 0; k = next_[core::at(k)])
            if (const double own = off(k); own < least) best = k, least = own;
        return best;
    }
    /// Direction from fibre i to fibre j that the order asks for, unit.
    Vec3 direction(Index order, Index i) const noexcept {
        const scene::ForcedOrder& forced = orders_[core::at(order)];
        return group_[core::at(i)] == forced.below ? forced.axis : Vec3(-forced.axis);
    }
    bool takes_part(Index fibre) const noexcept { return !orders_.empty() && group_[core::at(fibre)] >= 0; }
    Index family(Index fibre) const noexcept { return family_[core::at(fibre)]; }
    const Vec3& axis() const noexcept { return orders_.front().axis; }

private:
    std::vector<scene::ForcedOrder> orders_;
    std::vector<Index> table_, next_, group_, family_;  // next_: the order of the same groups given before
    Index group_count_ = 0;
};

/// Radius that a fibre's sections reach in a state: at rest, or as they are pressed flat; what they widen by less than a part of
/// it is left to the reach of a search, and zones end where they do without [length].
template <class B>
double widest_extent(const beam::Mesh<B>& mesh, const Vector& state, Index fibre) noexcept {
    const scene::CrossSection& section = mesh.fibre(fibre).section;
    double widest = section.radius();
    if constexpr (beam::DeformableSections<B>) {
        const double unnoticed = 1.05;  // half of the least margin of a search
        for (Index node = 0; node < mesh.node_count(fibre); ++node) {
            const auto [g_1, g_2] = mesh.directors(state, fibre, static_cast<double>(node) / (B::nodes - 1));
            widest = std::max(widest, section.greatest_extent(g_1, g_2) / unnoticed);
        }
    }
    return widest;
}

/// Polylines of all fibres in a state; owns the points that the centrelines look at.
template <class B>
struct SampledCentrelines {
    std::vector<Vec3> points;
    std::vector<double> inflation;
    std::vector<proximity::Centreline> centrelines;
    std::vector<Index> fibre;  ///< of each centreline
    std::vector<double> cut;   ///< segments an element of each centreline

    /// @param wanted  called with a fibre: is it searched?
    /// @param flat    projector on the space that is searched: identity, or across an axis
    template <class Wanted>
    SampledCentrelines(const beam::Mesh<B>& mesh, const Vector& state, const Detection& detection, const Mat3& flat,
                       const Wanted& wanted) {
        struct Piece {
            Index fibre, cut, first_point, first_segment;
            double bend;
        };
        std::vector<Piece> pieces;
        Index points_total = 0, segments_total = 0;
        for (Index f = 0; f < mesh.line_count(); ++f) {
            if (!wanted(f)) continue;
            double bend = 0.0;  // greatest |x0 - 2 x1 + x2| of the fibre
            for (Index e = 0; e < mesh.fibre(f).elements; ++e) bend = std::max(bend, 0.25 * mesh.greatest_bend(state, f, e));
            const double bound = detection.chord_bound * mesh.fibre(f).section.radius();
            const Index parts =
                std::clamp<Index>(static_cast<Index>(std::ceil(std::sqrt(0.5 * bend / bound))), 1, detection.finest_cut);
            pieces.push_back({f, parts, points_total, segments_total, bend});
            points_total += mesh.fibre(f).elements * parts + 1;
            segments_total += mesh.fibre(f).elements * parts;
        }
        points.resize(core::at(points_total));
        inflation.resize(core::at(segments_total));
        core::parallel_for(
            core::count(pieces),
            [&](Index p) {
                const Piece& piece = pieces[core::at(p)];
                const Index count = mesh.fibre(piece.fibre).elements * piece.cut;
                const double n = static_cast<double>(piece.cut);
                for (Index k = 0; k <= count; ++k)
                    points[core::at(piece.first_point + k)] =
                        flat * mesh.position(state, piece.fibre, static_cast<double>(k) / n);
                for (Index k = 0; k < count; ++k)  // an element's chords deviate by |x''| / (2 n^2)
                    inflation[core::at(piece.first_segment + k)] =
                        0.125 * mesh.greatest_bend(state, piece.fibre, k / piece.cut) / (n * n);
            },
            mesh.grain());
        for (const Piece& piece : pieces) {
            const beam::MeshFibre& fibre_data = mesh.fibre(piece.fibre);
            const Index count = fibre_data.elements * piece.cut;
            proximity::Centreline line;
            line.points = std::span<const Vec3>(points).subspan(core::at(piece.first_point), core::at(count + 1));
            line.inflation = std::span<const double>(inflation).subspan(core::at(piece.first_segment), core::at(count));
            line.radius = widest_extent(mesh, state, piece.fibre);
            line.closed = fibre_data.closed;
            if (fibre_data.image_of >= 0) line.family = 0;  // images do not touch each other
            if (detection.self_contact) line.self_skip = self_contact_arc(fibre_data.section.radius(), fibre_data.element_length);
            centrelines.push_back(line);
            fibre.push_back(piece.fibre);
            cut.push_back(static_cast<double>(piece.cut));
        }
    }

    /// Gives thicker fibres the reach that is wanted, as far as their radius over the smallest one allows.
    void widen(double reach, double wanted) {
        if (!(wanted > reach)) return;
        double least = std::numeric_limits<double>::infinity();
        for (const proximity::Centreline& line : centrelines) least = std::min(least, line.radius);
        std::size_t first = 0;
        for (const proximity::Centreline& line : centrelines) {
            const double more = 0.5 * (std::min(wanted, reach * (line.radius / least)) - reach);
            for (std::size_t k = first; k < first + line.inflation.size() && more > 0.0; ++k) inflation[k] += more;
            first += line.inflation.size();
        }
    }

    /// A zone of the polylines, in fibres and elements of the mesh.
    proximity::ProximityZone in_elements(proximity::ProximityZone zone) const {
        const std::size_t i = core::at(zone.fibre_i), j = core::at(zone.fibre_j);
        zone.a_i /= cut[i], zone.b_i /= cut[i], zone.closest_i /= cut[i];
        zone.a_j /= cut[j], zone.b_j /= cut[j], zone.closest_j /= cut[j];
        zone.fibre_i = fibre[i], zone.fibre_j = fibre[j];
        return zone;
    }
};

/// A fibre meets the image that goes on where it ends: the arc between the closest points is no longer than next to each other.
template <class B>
bool is_joint(const beam::Mesh<B>& mesh, const proximity::ProximityZone& zone) noexcept {
    const beam::MeshFibre& image = mesh.fibre(zone.fibre_j);
    if (image.image_of != zone.fibre_i || image.joins == 0) return false;
    const double end = static_cast<double>(image.elements);
    const double arc = image.joins > 0 ? end - zone.closest_i + zone.closest_j : end - zone.closest_j + zone.closest_i;
    return arc * image.element_length < self_contact_arc(image.section.radius(), image.element_length);
}

/// Clearance of two fibres along the direction that a forced order asks for, where they cross in plan: negative by how deep they
/// are, be they on the wrong side of each other by many radii [length].
template <class B>
double clearance(const beam::Mesh<B>& mesh, const Vector& state, const ForcedOrders& orders, const Zone& zone) noexcept {
    const Vec3 between = mesh.position(state, zone.span.fibre_j, zone.span.closest_j) -
                         mesh.position(state, zone.span.fibre_i, zone.span.closest_i);
    return between.dot(orders.direction(zone.order, zone.span.fibre_i)) - mesh.fibre(zone.span.fibre_i).section.radius() -
           mesh.fibre(zone.span.fibre_j).section.radius();
}

/// Pairs in a forced order that are further apart than this have no zone: two thick bundles that cross have a hundred thousand
/// pairs, of which half are in order from the start, and all but those that face each other in the end [radii].
inline constexpr double clear_over_radius = 2.0;

/// Zones of a state, sorted by fibres and abscissa.
///
/// @param reach   beyond the sum of the radii [length], >= 0
/// @param forced  search pairs in a forced order across its axis, however deep they are on its wrong side, and leave their
///                ordinary zones out
template <class B, proximity::ProximitySearch Search>
std::vector<Zone> find_zones(const beam::Mesh<B>& mesh, const Vector& state, Search& search, const Detection& detection,
                             const ForcedOrders& orders, double reach, bool forced) {
    std::vector<Zone> zones;
    const auto order_of = [&](const proximity::ProximityZone& span) {
        return orders.between(span.fibre_i, span.fibre_j, span.closest_i / static_cast<double>(mesh.fibre(span.fibre_i).elements),
                              span.closest_j / static_cast<double>(mesh.fibre(span.fibre_j).elements));
    };
    SampledCentrelines<B> lines(mesh, state, detection, Mat3::Identity(), [](Index) { return true; });
    lines.widen(reach, detection.wanted);
    // A scene of many crossings has hundreds of megabytes of them: none is there twice.
    const auto add = [&](const std::vector<proximity::ProximityZone>& found, const SampledCentrelines<B>& along,
                         const auto& wanted) {
        Zone zone;
        const auto seen = [&](const proximity::ProximityZone& span) {
            zone.span = along.in_elements(span), zone.order = order_of(zone.span);
            return wanted(zone);
        };
        zones.reserve(zones.size() + core::at(std::count_if(found.begin(), found.end(), seen)));
        for (const proximity::ProximityZone& span : found)
            if (seen(span)) zones.push_back(zone);
    };
    add(search.find(lines.centrelines, reach), lines,
        [&](const Zone& zone) { return !(forced && zone.order >= 0) && !is_joint(mesh, zone.span); });
    if (forced && !orders.empty()) {
        const Mat3 flat = Mat3::Identity() - orders.axis() * orders.axis().transpose();
        SampledCentrelines<B> plan(mesh, state, detection, flat, [&](Index f) { return orders.takes_part(f); });
        for (std::size_t k = 0; k < plan.centrelines.size(); ++k) {
            plan.centrelines[k].family = orders.family(plan.fibre[k]);
            plan.centrelines[k].self_skip = std::numeric_limits<double>::infinity();
            plan.centrelines[k].radius *= 1e-3;  // only where they cross in plan
        }
        const auto middle = static_cast<std::ptrdiff_t>(zones.size());
        add(search.find(plan.centrelines, 0.0), plan, [&](Zone& zone) {
            zone.forced = zone.crossing = zone.order >= 0;
            return zone.forced && clearance(mesh, state, orders, zone) <=
                                      clear_over_radius * std::max(mesh.fibre(zone.span.fibre_i).section.radius(),
                                                                   mesh.fibre(zone.span.fibre_j).section.radius());
        });
        std::inplace_merge(zones.begin(), zones.begin() + middle, zones.end(), [](const Zone& a, const Zone& b) {
            return a.span.fibre_i != b.span.fibre_i ? a.span.fibre_i < b.span.fibre_i : a.span.fibre_j < b.span.fibre_j;
        });
    }
    if constexpr (requires { search.release(); }) search.release();  // contact elements take more, and want it now
    for (Zone& zone : zones) {
        const beam::MeshFibre &i = mesh.fibre(zone.span.fibre_i), &j = mesh.fibre(zone.span.fibre_j);
        zone.reference =
            0.5 * (section_stiffness(i.material, 0.5 * i.element_length) + section_stiffness(j.material, 0.5 * j.element_length));
    }
    return zones;
}

}  // namespace fibrant::contact

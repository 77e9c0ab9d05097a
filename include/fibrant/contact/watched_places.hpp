// SPDX-License-Identifier: MIT
#pragma once
/// @file Places where two fibres were found deeper in each other than contact points say: points of their own, and a stiffer
/// zone.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/allowed_depth.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <vector>

namespace fibrant::contact {

/// Where the surfaces of two fibres are too deep in each other, by a measurement that owes nothing to contact points.
struct DeepPlace {
    Index fibre_i = -1, fibre_j = -1;
    double u_i = 0.0, u_j = 0.0;  ///< abscissae in elements
    double depth = 0.0;           ///< > 0 [length]
};

namespace detail {
/// A place and a station are one if they are no further apart on both fibres [elements]: a sixth of the least spacing.
inline constexpr double same_station = 0.02;

inline bool holds(const proximity::ProximityZone& span, double u_i, double u_j) noexcept {
    const auto [low, high] = std::minmax(span.a_j, span.b_j);
    return u_i >= span.a_i && u_i <= span.b_i && u_j >= low && u_j <= high;
}
/// Whether one of the stations stands at these places [element].
template <class Stations>
bool has_station(const Stations& stations, double u_i, double u_j) noexcept {
    return std::any_of(stations.begin(), stations.end(), [&](const auto& one) {
        return std::abs(one.u_i - u_i) < same_station && std::abs(one.u_j - u_j) < same_station;
    });
}
}  // namespace detail

/// What a new zone takes over from the one before it: the places that are watched, what it may be deep there, and what it does
/// not see.
inline void keep_watch(Zone& zone, const Zone* before) noexcept {
    if (before) zone.watched = before->watched, zone.narrowed = before->narrowed, zone.unseen = before->unseen;
    zone.penetration_factor *= zone.narrowed;
}

/// Adds the watched places of a zone to its stations, in order. Crossings that are followed stand where they are closest.
inline void add_watched(const Zone& zone, std::vector<StationPair>& pairs) {
    if (zone.watched.count == 0 || zone.forced || zone.followed) return;
    const double length = pairs.empty() ? 0.0 : pairs.front().length;
    for (Index k = 0; k < std::min(zone.watched.count, WatchedPlaces::most); ++k) {
        const auto [u_i, u_j] = zone.watched.at[core::at(k)];
        if (!detail::holds(zone.span, u_i, u_j) || detail::has_station(pairs, u_i, u_j)) continue;
        StationPair pair;
        pair.u_i = u_i, pair.u_j = u_j, pair.length = length;
        pairs.push_back(pair);
    }
    sort_along(pairs);
}

/// Mends what is too deep, between two increments: where no contact point stands it gets one, and its zone begins as soft there
/// as what it would meet asks for. Where one stands that sees less, by the evened kinks of a crossing or by sections that bulge
/// beside it, what it misses is taken off its gaps from now on. Where it sees all, the zone may be less deep and becomes stiffer
/// at once.
/// @param allowed  depth of a place that is no deeper [length], > 0
template <class Mesh, class Contacts>
void mend(const Mesh& mesh, Contacts& contacts, std::span<const DeepPlace> places, double allowed) {
    const StiffnessAdaptation& adaptation = contacts.parameters().stiffness;
    const double narrowest = 0.02, least_step = 0.3, greatest_step = 0.95;  // of what a zone is allowed, in all and at once
    const double missed = 0.3, most_unseen = 0.1;  // of what is allowed, from which on a point misses depth; of the radius,
                                                   // beyond which a mesh is too coarse
    for (const DeepPlace& place : places) {
        Zone* found = nullptr;
        double nearest = std::numeric_limits<double>::infinity();
        const auto before = [](const Zone& zone, const DeepPlace& key) {
            return zone.span.fibre_i != key.fibre_i ? zone.span.fibre_i < key.fibre_i : zone.span.fibre_j < key.fibre_j;
        };
        auto& zones = contacts.zones();
        for (auto zone = std::lower_bound(zones.begin(), zones.end(), place, before);
             zone != zones.end() && zone->span.fibre_i == place.fibre_i && zone->span.fibre_j == place.fibre_j; ++zone) {
            const auto [low, high] = std::minmax(zone->span.a_j, zone->span.b_j);
            const double away =
                std::max({zone->span.a_i - place.u_i, place.u_i - zone->span.b_i, low - place.u_j, place.u_j - high, 0.0});
            if (away < nearest) nearest = away, found = &*zone;
        }
        if (!found) continue;  // the next search finds one
        Zone& zone = *found;
        const auto elements = contacts.elements().part(core::at(zone.first), core::at(zone.last));
        const bool open = !mesh.fibre(zone.span.fibre_i).closed && !mesh.fibre(zone.span.fibre_j).closed;
        const double seen = detail::depth_of(contacts, zone),
                     least = std::max(seen, adaptation.allowed_penetration * zone.penetration_factor);
        if (open && !zone.followed && detail::holds(zone.span, place.u_i, place.u_j) &&
            !detail::has_station(elements, place.u_i, place.u_j)) {
            zone.watched.at[core::at(zone.watched.count++ % WatchedPlaces::most)] = {place.u_i, place.u_j};
            zone.stiffness *= std::min(1.0, 2.0 * least / place.depth);
            continue;
        }
        const double radius =
            std::min(mesh.fibre(zone.span.fibre_i).section.radius(), mesh.fibre(zone.span.fibre_j).section.radius());
        const double unseen = std::min(zone.unseen + place.depth - std::max(seen, 0.0), most_unseen * radius);
        if (unseen - zone.unseen > missed * allowed) {
            zone.unseen = unseen;
            continue;
        }
        const double narrowed =
            std::max(narrowest, zone.narrowed * std::clamp(0.9 * allowed / place.depth, least_step, greatest_step));
        zone.penetration_factor *= narrowed / zone.narrowed, zone.narrowed = narrowed;
        zone.stiffness = std::max(zone.stiffness, strictly_adapted_stiffness(adaptation, contacts.normal_law(), zone.stiffness,
                                                                             zone.reference, seen, zone.penetration_factor));
    }
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file Stations of a zone whose crossings are followed: at its closest places, and along the valleys in which its fibres touch.

#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/slid_pair.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/parallel.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// Whether a contact element, or a pair of stations, is followed.
bool is_followed(const auto& pair, const Zone& zone) noexcept {
    return zone.followed && !zone.forced && pair.crossing && !pair.end_i && !pair.end_j;
}

/// Stations of zones whose crossings are followed.
template <class B>
class ValleyStations {
public:
    /// New pairs of stations in the place of that of a crossing: at each place of the zone where its two fibres are closest, near
    /// where they were. Two yarns that clasp each other have two such places in one zone, with normals that are opposite.
    /// @param pairs  the last one is the crossing's
    template <class Memory>
    static void settle(const beam::Mesh<B>& mesh, const Vector& state, Zone& zone, const Memory& memory,
                       std::vector<StationPair>& pairs) {
        const StationPair crossing = pairs.back();
        pairs.pop_back();
        const std::size_t first = pairs.size();
        const std::vector<Place> places = places_of(mesh, state, zone, memory, crossing);
        zone.settled = true;
        for (std::size_t place = 0; place < places.size(); ++place) settle_one(mesh, state, zone, places, place, pairs);
        sort_along(pairs, first);
    }

    /// Zones of the same two fibres that have found the same place, nearer than stations are, become one: stations that stand
    /// twice push twice. A search tells zones apart where fibres turn from along each other to against, as a loop does beside
    /// what it hangs in.
    /// @param zones  sorted by fibres
    template <class Memory>
    static void join(const beam::Mesh<B>& mesh, const Vector& state, const ContactSpacing& points, const Memory& memory,
                     std::vector<Zone>& zones) {
        const auto may = [](const Zone& zone) { return zone.followed && zone.crossing && !zone.forced; };
        std::vector<std::span<Zone>> several;  // of two fibres each
        for (std::size_t first = 0, last = 0; first < zones.size(); first = last) {
            const proximity::ProximityZone& span = zones[first].span;
            Index count = 0;
            for (; last < zones.size() && zones[last].span.fibre_i == span.fibre_i && zones[last].span.fibre_j == span.fibre_j;
                 ++last)
                count += may(zones[last]) ? 1 : 0;
            if (count > 1) several.push_back(std::span(zones).subspan(first, last - first));
        }
        core::parallel_for(
            core::count(several),
            [&](Index k) {
                std::vector<StationPair> pairs;
                const auto found = [&](const Zone& zone) {
                    pairs.clear();
                    if (may(zone)) station_pairs(mesh, state, zone.span, true, points, pairs);
                    return !pairs.empty() && is_followed(pairs.back(), zone) ? places_of(mesh, state, zone, memory, pairs.back())
                                                                             : std::vector<Place>();
                };
                const std::span<Zone> own = several[core::at(k)];
                std::vector<std::vector<Place>> places;
                for (const Zone& zone : own) places.push_back(found(zone));
                for (std::size_t a = 0; a < own.size(); ++a)
                    for (std::size_t b = a + 1; b < own.size(); ++b) {
                        if (!meet(mesh, own[a].span, places[a], places[b])) continue;
                        const Zone one = both(mesh, own[a], own[b]);
                        std::vector<Place> all = found(one);
                        if (!has_all(mesh, one.span, all, places[a]) || !has_all(mesh, one.span, all, places[b])) continue;
                        own[a] = one, places[a].swap(all);
                        own[b].followed = false, own[b].span.fibre_i = -1, places[b].clear();  // is no more
                        b = a;                                                                 // with what both have found
                    }
            },
            core::light_items);
        if (!several.empty()) std::erase_if(zones, [](const Zone& zone) { return zone.span.fibre_i < 0; });
    }

    /// How a station slides.
    static Slide slide_of(const beam::Mesh<B>& mesh, const Zone& zone, std::int8_t slide) noexcept {
        switch (slide) {
            case free:
                return {};
            case on_i:
                return {Slide::along, {1.0, 0.0}};
            case on_j:
                return {Slide::along, {0.0, 1.0}};
            case fixed:
                return {Slide::nowhere, {}};
            default:
                break;
        }
        const double valley = zone.valleys[core::at(slide - across_valley)];
        return {Slide::along,
                {-std::sin(valley) / mesh.fibre(zone.span.fibre_i).element_length,
                 std::cos(valley) / mesh.fibre(zone.span.fibre_j).element_length}};
    }

private:
    /// How a place slides: freely, on one fibre alone, not at all, or across one of its zone's valleys, from this number on.
    enum : std::int8_t { free, on_i, on_j, fixed, across_valley };

    /// A closest place of a zone.
    struct Place {
        Eigen::Vector2d closest;             ///< of the centrelines
        StationPair middle;                  ///< of the stations that it had, or where it has slid to
        std::vector<Eigen::Vector2d> known;  ///< stations that it had
        SlidPair seen;
        Vec3 normal;
    };
    template <class Memory>
    static std::vector<Place> places_of(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Memory& memory,
                                        const StationPair& crossing) {
        const Index i = zone.span.fibre_i, j = zone.span.fibre_j;
        std::vector<Eigen::Vector2d> known;
        // Of a fibre that comes by once more, as a loop does beside what it hangs in, the others are another zone's.
        const double aside = most_beside * spacing * (mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius()) /
                             mesh.fibre(j).element_length;
        const double low = std::min(zone.span.a_j, zone.span.b_j) - aside, high = std::max(zone.span.a_j, zone.span.b_j) + aside;
        if (zone.settled)
            memory.visit_places(zone.span, [&](double u_i, double u_j) {
                if (u_j >= low && u_j <= high) known.emplace_back(u_i, u_j);
            });
        std::vector<Place> places;
        for (const Eigen::Vector2d& place :
             closest_places(mesh, state, zone.span, {crossing.u_i, crossing.u_j}, zone.joined, known))
            places.push_back({place, crossing, {}, {}, Vec3::Zero()});
        for (const Eigen::Vector2d& to : known) {
            const auto nearer = [&](const Place& a, const Place& b) {
                return arc_apart(mesh, zone.span, a.closest, to) < arc_apart(mesh, zone.span, b.closest, to);
            };
            std::min_element(places.begin(), places.end(), nearer)->known.push_back(to);
        }
        for (Place& place : places) {
            StationPair& middle = place.middle;
            middle.u_i = place.closest[0], middle.u_j = place.closest[1];
            if (!place.known.empty()) middle.u_i = median(place.known, 0), middle.u_j = median(place.known, 1);
            place.normal = unit_or(pair_geometry(mesh, state, i, j, middle.u_i, middle.u_j).centres, Vec3::UnitZ());
            place.seen = slid(mesh, state, i, j, {Slide::nowhere, {}}, middle, place.normal);
            if (place.known.size() < 3 || least(place.seen.closeness) > held)
                place.seen = slid(mesh, state, i, j, {}, middle, place.normal);
        }
        return places;
    }
    /// Whether two zones have a place in common.
    static bool meet(const beam::Mesh<B>& mesh, const proximity::ProximityZone& span, const std::vector<Place>& a,
                     const std::vector<Place>& b) {
        const double near = spacing * (mesh.fibre(span.fibre_i).section.radius() + mesh.fibre(span.fibre_j).section.radius());
        for (const Place& one : a)
            for (const Place& other : b)
                if (arc_apart(mesh, span, {one.middle.u_i, one.middle.u_j}, {other.middle.u_i, other.middle.u_j}) < near)
                    return true;
        return false;
    }

    /// The nearer one of two zones, which takes in the other one.
    static Zone both(const beam::Mesh<B>& mesh, const Zone& a, const Zone& b) {
        Zone zone = a.span.distance <= b.span.distance ? a : b;
        const Zone& other = a.span.distance <= b.span.distance ? b : a;
        proximity::ProximityZone &to = zone.span, from = other.span;
        // Around closed fibres to where the nearer one is; of one fibre with itself the parts that are there.
        const auto turned = [&](Index fibre, double u, double near) {
            const double period = static_cast<double>(mesh.fibre(fibre).elements);
            return mesh.fibre(fibre).closed ? near + std::remainder(u - near, period) - u : 0.0;
        };
        const auto away = [&] {
            return std::abs(from.closest_i + turned(from.fibre_i, from.closest_i, to.closest_i) - to.closest_i) +
                   std::abs(from.closest_j + turned(from.fibre_j, from.closest_j, to.closest_j) - to.closest_j);
        };
        const auto swap_parts = [&] {
            std::swap(from.a_i, from.a_j), std::swap(from.b_i, from.b_j), std::swap(from.closest_i, from.closest_j);
            if (from.a_i > from.b_i) std::swap(from.a_i, from.b_i), std::swap(from.a_j, from.b_j);
        };
        if (to.fibre_i == to.fibre_j) {
            const double straight = away();
            swap_parts();
            if (away() >= straight) swap_parts();
        }
        const bool against = to.b_j < to.a_j;
        const double by_i = turned(from.fibre_i, from.closest_i, to.closest_i),
                     by_j = turned(from.fibre_j, from.closest_j, to.closest_j);
        to.a_i = std::min(to.a_i, from.a_i + by_i), to.b_i = std::max(to.b_i, from.b_i + by_i);
        const double low = std::min({to.a_j, to.b_j, from.a_j + by_j, from.b_j + by_j}),
                     high = std::max({to.a_j, to.b_j, from.a_j + by_j, from.b_j + by_j});
        to.a_j = against ? high : low, to.b_j = against ? low : high;
        zone.joined = true;
        if (!zone.settled && other.settled) zone.slanting = other.slanting;
        zone.settled = a.settled || b.settled;
        zone.stiffness = std::max(a.stiffness, b.stiffness), zone.deepest = std::max(a.deepest, b.deepest);
        zone.penetration_factor = std::min(a.penetration_factor, b.penetration_factor);
        zone.narrowed = std::min(a.narrowed, b.narrowed), zone.unseen = std::max(a.unseen, b.unseen);
        return zone;
    }

    /// Whether a zone has the places of one that it takes in, but for what counts as one place, and what is too far for any: none
    /// is to go through unseen.
    static bool has_all(const beam::Mesh<B>& mesh, const proximity::ProximityZone& span, const std::vector<Place>& all,
                        const std::vector<Place>& some) {
        const double touching = mesh.fibre(span.fibre_i).section.radius() + mesh.fibre(span.fibre_j).section.radius();
        return std::all_of(some.begin(), some.end(), [&](const Place& one) {
            const Eigen::Vector2d at(one.middle.u_i, one.middle.u_j);
            return one.seen.gap > (furthest_crossing - 1.0) * touching ||
                   std::any_of(all.begin(), all.end(), [&](const Place& other) {
                       return arc_apart(mesh, span, at, {other.middle.u_i, other.middle.u_j}) < touching ||
                              arc_apart(mesh, span, at, other.closest) < touching;
                   });
        });
    }

    /// Stations of one closest place. Where the fibres are nearly as close beside it, as fibres are that hang in each other at a
    /// slant or are bent around each other by a touching distance, they touch along a line: then there are stations along this
    /// valley too. These slide across it only, and stay where they are from one detection to the next, so that no contact hops;
    /// what touches in two places after it did in one does so on stations that were there before.
    /// @param places  all closest places of the zone, and which of them it is: stations are of the nearest one
    static void settle_one(const beam::Mesh<B>& mesh, const Vector& state, Zone& zone, const std::vector<Place>& places,
                           std::size_t place, std::vector<StationPair>& pairs) {
        const Index i = zone.span.fibre_i, j = zone.span.fibre_j;
        const double touching = mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius();
        const Place& own_place = places[place];
        StationPair middle = own_place.middle;
        const std::vector<Eigen::Vector2d>& known = own_place.known;
        const SlidPair& seen = own_place.seen;
        const Vec3& normal = own_place.normal;
        const PairGeometry& pair = seen.pair;
        const Eigen::Matrix2d& closeness = seen.closeness;
        // Where fibres come close again further on, or lie along each other in all of the zone, they touch there too.
        const auto in_zone = [&](const StationPair& at) {
            const auto off = [&](Index f, double u, double from) {
                return mesh.fibre(f).closed ? std::remainder(u - from, static_cast<double>(mesh.fibre(f).elements)) : u - from;
            };
            const proximity::ProximityZone& span = zone.span;
            const double of_i = off(i, at.u_i, span.closest_i), of_j = off(j, at.u_j, span.closest_j);
            return of_i >= span.a_i - span.closest_i && of_i <= span.b_i - span.closest_i &&
                   of_j >= std::min(span.a_j, span.b_j) - span.closest_j && of_j <= std::max(span.a_j, span.b_j) - span.closest_j;
        };
        const double longest =
            std::max((zone.span.b_i - zone.span.a_i) * pair.speed_i, std::abs(zone.span.b_j - zone.span.a_j) * pair.speed_j);
        const int most =
            std::max(most_beside, static_cast<int>(std::min(longest / (spacing * touching), 1e6)));  // once around closed fibres
        const auto of_another = [&](const StationPair& at) {
            const Eigen::Vector2d here(at.u_i, at.u_j);
            const double own = arc_apart(mesh, zone.span, places[place].closest, here) + 0.25 * spacing * touching;
            for (std::size_t k = 0; k < places.size(); ++k)
                if (k != place && arc_apart(mesh, zone.span, places[k].closest, here) < own) return true;
            return false;
        };
        if (place > 0 && of_another(middle)) return;  // it slid there
        const auto line = [&](const Eigen::Vector2d& way, std::int8_t slide) {
            for (const double side : {-1.0, 1.0}) {
                double last = seen.gap, aside = 0.0;  // aside: of the last station, across the way from the middle [length]
                bool parted = false;
                for (int k = 1; k <= most; ++k) {
                    StationPair other = middle;
                    other.slide = slide;
                    const Eigen::Vector2d ideal = side * k * spacing * touching * way + aside * Eigen::Vector2d(-way[1], way[0]);
                    other.u_i += ideal[0] / pair.speed_i, other.u_j += ideal[1] / pair.speed_j;
                    if ((parted || k > most_beside) && !in_zone(other)) break;
                    // One that was there stays.
                    double nearest = 0.5 * spacing * touching;
                    Eigen::Vector2d kept(other.u_i, other.u_j);
                    for (const Eigen::Vector2d& one : known) {
                        const double off =
                            std::abs(way[0] * (one[0] - other.u_i) * pair.speed_i + way[1] * (one[1] - other.u_j) * pair.speed_j);
                        const double beside =
                            std::abs(way[1] * (one[0] - other.u_i) * pair.speed_i - way[0] * (one[1] - other.u_j) * pair.speed_j);
                        if (off < nearest && beside < near_valley * touching) nearest = off, kept = one;
                    }
                    other.u_i = kept[0], other.u_j = kept[1];
                    if (!inside(mesh, i, other.u_i) || !inside(mesh, j, other.u_j)) break;
                    Vec3 there = normal;
                    const double gap = slid(mesh, state, i, j, slide_of(mesh, zone, slide), other, there).gap;
                    aside = way[0] * (other.u_j - middle.u_j) * pair.speed_j - way[1] * (other.u_i - middle.u_i) * pair.speed_i;
                    if (of_another(other)) break;
                    const bool parts = gap > clear * touching && gap > last;
                    parted = parted || parts;
                    if (!parts) pairs.push_back(other);
                    last = gap;
                }
            }
        };
        // Wide faces are close beside a place without being bent, and would make stations that pass one reaction to and fro.
        const bool not_round = oval_pair(mesh, i, j);
        const double stuck = not_round ? -1e9 : held;
        const double weak = (not_round ? flat_of_ovals : flat) * (known.size() > 1 ? stay : 1.0);
        if (least(closeness) < weak) {
            bool& slants = zone.slanting[place];
            slants = std::abs(closeness(0, 1)) > (known.size() < 2 ? square : slants ? square / leave : square * leave);
            const bool upright = !slants;
            const Eigen::Vector2d of_i(1.0, 0.0), of_j(0.0, 1.0);
            if (upright) {
                const bool weak_i = closeness(0, 0) < weak, weak_j = closeness(1, 1) < weak;
                if (weak_i) line(of_i, on_j);
                if (weak_j) line(of_j, on_i);
                const bool stuck_i = closeness(0, 0) < stuck, stuck_j = closeness(1, 1) < stuck;
                middle.slide = stuck_i && stuck_j ? fixed : stuck_i ? on_j : stuck_j ? on_i : free;
            } else {
                const core::SymmetricEigen<2> parts(closeness);
                const Eigen::Vector2d way = parts.vectors().col(0);
                const auto across = static_cast<std::int8_t>(across_valley + static_cast<int>(place));
                zone.valleys[place] = std::atan2(way[1], way[0]);
                line(way, across);
                middle.slide = parts.values()[0] < stuck ? across : static_cast<std::int8_t>(free);
            }
        }
        pairs.push_back(middle);
    }

    static double least(const Eigen::Matrix2d& closeness) noexcept {
        return 0.5 * (closeness(0, 0) + closeness(1, 1)) - std::hypot(0.5 * (closeness(0, 0) - closeness(1, 1)), closeness(0, 1));
    }
    static double median(const std::vector<Eigen::Vector2d>& places, Index of) {
        std::vector<double> values;
        for (const Eigen::Vector2d& place : places) values.push_back(place[of]);
        std::sort(values.begin(), values.end());
        const std::size_t half = values.size() / 2;
        return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
    }
    static bool inside(const beam::Mesh<B>& mesh, Index fibre, double u) noexcept {
        return u >= mesh.bounds(fibre).first && u <= mesh.bounds(fibre).second;
    }
    static constexpr double square =
        0.1;  ///< cosine of the angle between fibres below which their valleys lie along each of them [1]
    /// Second variation of the closest distance, over the distance, below which there are stations beside a place, and below
    /// which it does not slide along its valley. Hooks that are pulled apart at 30 to 90 degrees hold most often with these, of
    /// 0.02 to 0.1 and spacings of 0.25 to 0.5 [1].
    static constexpr double flat = 0.4, held = 0.05;
    static constexpr double flat_of_ovals = 0.1;  ///< the same of sections that are not round
    /// Where there are stations beside a place, or valleys that slant, there are until these bounds are passed by a factor:
    /// fibres come to rest elsewhere on one contact than on several, and passes would go to and fro between both.
    static constexpr double stay = 1.25, leave = 2.5;
    static constexpr double spacing = valley_spacing,
                            clear = 0.1;  ///< of stations in a valley, and gap beyond which there are none [touching distance]
    static constexpr double near_valley = 2.0;  ///< of a station that stays, across [touching distance]
    static constexpr int most_beside =
        8;  ///< stations to each side that are placed whatever the zone; more of them as far as it goes
};

}  // namespace fibrant::contact

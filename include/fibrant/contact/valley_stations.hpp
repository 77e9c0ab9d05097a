// SPDX-License-Identifier: MIT
#pragma once
/// @file Stations of a zone whose crossings are followed: at its closest places, and along the valleys in which its fibres touch.

#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/slid_pair.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fibrant::contact {

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
        std::vector<Eigen::Vector2d> known;
        if (zone.settled) memory.visit_places(zone.span, [&](double u_i, double u_j) { known.emplace_back(u_i, u_j); });
        zone.settled = true;
        const std::size_t first = pairs.size();
        const std::vector<Eigen::Vector2d> places = closest_places(mesh, state, zone.span, {crossing.u_i, crossing.u_j});
        const auto nearest = [&](const Eigen::Vector2d& to) {
            const auto nearer = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
                return arc_apart(mesh, zone.span, a, to) < arc_apart(mesh, zone.span, b, to);
            };
            return std::min_element(places.begin(), places.end(), nearer) - places.begin();
        };
        for (std::size_t place = 0; place < places.size(); ++place) {
            std::vector<Eigen::Vector2d> own;
            for (const Eigen::Vector2d& one : known)
                if (nearest(one) == static_cast<std::ptrdiff_t>(place)) own.push_back(one);
            StationPair middle = crossing;
            middle.u_i = places[place][0], middle.u_j = places[place][1];
            settle_one(mesh, state, zone, places, place, own, middle, pairs);
        }
        sort_along(pairs, first);
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

    /// Stations of one closest place. Where the fibres are nearly as close beside it, as fibres are that hang in each other at a
    /// slant or are bent around each other by a touching distance, they touch along a line: then there are stations along this
    /// valley too. These slide across it only, and stay where they are from one detection to the next, so that no contact hops;
    /// what touches in two places after it did in one does so on stations that were there before.
    /// @param places  all closest places of the zone, and which of them it is: stations are of the nearest one
    /// @param known   stations that it had
    static void settle_one(const beam::Mesh<B>& mesh, const Vector& state, Zone& zone, const std::vector<Eigen::Vector2d>& places,
                           std::size_t place, const std::vector<Eigen::Vector2d>& known, StationPair middle,
                           std::vector<StationPair>& pairs) {
        const Index i = zone.span.fibre_i, j = zone.span.fibre_j;
        if (!known.empty()) middle.u_i = median(known, 0), middle.u_j = median(known, 1);
        const double touching = mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius();
        Vec3 normal = unit_or(pair_geometry(mesh, state, i, j, middle.u_i, middle.u_j).centres, Vec3::UnitZ());
        SlidPair seen = slid(mesh, state, i, j, {Slide::nowhere, {}}, middle, normal);
        if (known.size() < 3 || least(seen.closeness) > held) seen = slid(mesh, state, i, j, {}, middle, normal);
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
            const double own = arc_apart(mesh, zone.span, places[place], here) + 0.25 * spacing * touching;
            for (std::size_t k = 0; k < places.size(); ++k)
                if (k != place && arc_apart(mesh, zone.span, places[k], here) < own) return true;
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

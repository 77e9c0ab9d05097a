// SPDX-License-Identifier: MIT
#pragma once
/// @file Which crossings of a contact set are followed, and what they push with.

#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/slid_pair.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace fibrant::contact {

/// How far two fibres are bent around each other where a zone of theirs is closest: distance over radius of curvature, of the one
/// that is bent more towards the other [1]. A fibre's mean over a patch has the corner that a force at a node shears it into.
template <class B>
double bend_around(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone) noexcept {
    const PairGeometry pair = pair_geometry(mesh, state, zone.fibre_i, zone.fibre_j, zone.closest_i, zone.closest_j);
    return 1.0 - pair.closeness.diagonal().minCoeff();
}

/// Places of the crossings that are followed, beside the contact elements of a set. Where none is it holds nothing.
template <class B>
class FollowedPlaces {
public:
    explicit FollowedPlaces(Places places) : places_{places} {}

    /// Whether crossings are followed from the next detection on, if it is as needed.
    void follow(bool whether) noexcept { all_ = whether; }
    /// Says whether crossings of a zone are followed. As needed they are wherever fibres are bent around each other as only loops
    /// are, or clasp each other, whatever increments lead there.
    void mark(const beam::Mesh<B>& mesh, const Vector& state, Zone& zone, const Zone* before) const {
        zone.followed = wanted(mesh, state, zone, before);
        zone.settled = zone.followed && before && before->settled;
        if (zone.settled) zone.slanting = before->slanting;
    }
    /// Whether what `follow` says decides about some zone of an attempt, as the fibres lay before it.
    bool matters(const beam::Mesh<B>& mesh, const Vector& state, const std::vector<Zone>& zones) const {
        FollowedPlaces other(places_);
        other.follow(!all_);
        const auto differs = [&](const Zone& zone) {
            return !zone.forced && other.wanted(mesh, state, zone, &zone) != zone.followed;
        };
        return zones.empty() || std::any_of(zones.begin(), zones.end(), differs);
    }
    /// Crossings that are followed go on as one contact element until bent around each other so much that the angle between them
    /// is, but for this part of what it is elsewhere, that of fibres side by side [1].
    static double angle_share(const Zone& zone) noexcept { return zone.followed ? 0.2 : 1.0; }
    /// Of a contact element, or of a pair of stations.
    static bool follows(const auto& pair, const Zone& zone) noexcept {
        return zone.followed && !zone.forced && pair.crossing && !pair.end_i && !pair.end_j;
    }
    bool none() const noexcept { return held_.empty(); }

    /// Gives each element that is followed a place.
    template <class Elements>
    void number(Elements& elements, const std::vector<Zone>& zones, const Vector& accepted) {
        std::int32_t count = 0;
        held_.clear();
        for (auto& element : elements) {
            element.place = follows(element, zones[core::at(element.zone)]) ? count++ : -1;
            if (element.place >= 0) held_.emplace_back();
        }
        if (count > 0) accepted_ = accepted;
    }
    /// What the slips of an increment count from.
    const Vector& accepted() const noexcept { return accepted_; }

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

    /// The closest patches of a state, and the normal from the one to the other.
    template <class Element>
    void follow(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, Element& element) {
        const Vec3 before = element.normal;
        if constexpr (beam::OvalSections<B>) {
            if (oval_pair(mesh, element.fibre_i, element.fibre_j)) {
                Held& one = held_[core::at(element.place)];
                if (!stand(mesh, element, one)) renew(mesh, state, element);
                follow_oval(mesh, state, element.fibre_i, element.fibre_j, one.i, one.j, slide_of(mesh, zone, element.slide),
                            element.u_i, element.u_j, element.normal);
                return;
            }
        }
        const Slide slide = slide_of(mesh, zone, element.slide);
        if (slide.kind == Slide::freely) follow_closest(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        if (slide.kind == Slide::along)
            follow_along(mesh, state, element.fibre_i, element.fibre_j, slide, element.u_i, element.u_j);
        const PairGeometry pair = pair_geometry(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        element.normal = unit_or(slide.kind == Slide::freely ? Vec3(pair.t_i.cross(pair.t_j)) : pair.centres, before);
        if (element.normal.dot(before) < 0.0) element.normal = -element.normal;
    }
    /// What an element pushes with; its cap becomes one that makes its gap that of its patches.
    template <class Element>
    void take(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, Element& element) {
        Held& one = held_[core::at(element.place)];
        if (!stand(mesh, element, one)) renew(mesh, state, element);
        const auto hosts = [](const SlidingPlace<B>& of) {
            return std::array{static_cast<Index>(of.i.count), of.i.vectors[0], static_cast<Index>(of.j.count), of.j.vectors[0]};
        };
        const auto before = hosts(one.place);
        one.place = place_of(mesh, state, zone, element, one);
        if (before[0] > 0 && hosts(one.place) != before) one.rehosted = true;
        if constexpr (beam::TurningSections<B>) {
            element.weights_i.follow(state.segment<beam::Mesh<B>::element_unknowns>(element.first_i));
            element.weights_j.follow(state.segment<beam::Mesh<B>::element_unknowns>(element.first_j));
        }
        element.cap = element.normal.dot(element.offset(state)) - one.place.gap;
    }
    SlidingStiffness stiffness(const auto& element, double reaction, double slope, bool positive) const {
        const SlidingPlace<B>& place = of(element);
        if constexpr (beam::OvalSections<B>)
            if (place.oval) return oval_stiffness(place, element.normal, reaction, slope, positive);
        return sliding_stiffness(place, element.normal, reaction, slope, positive);
    }
    /// Sections anew where an element has slid to, facing each other across its normal. @returns by how much the direction across
    /// them has turned in the section of fibre i [radian]
    /// @param rubs  the plane of its normal stands as well, and counts
    template <class Element>
    double renew(const beam::Mesh<B>& mesh, const Vector& state, const Element& element, bool rubs = false) noexcept {
        Held& one = held_[core::at(element.place)];
        const Index i = element.fibre_i, j = element.fibre_j;
        const StandingSection before = one.i;
        [[maybe_unused]] const double before_j = one.j.u;
        const double half = half_of_patch(mesh, i, j, i);
        one.i = standing_section(mesh, state, i, element.u_i, half, element.normal);
        one.j = standing_section(mesh, state, j, element.u_j, half_of_patch(mesh, i, j, j), Vec3(-element.normal));
        double turn = rubs ? turn_between(one.plane, element.normal) : 0.0;
        one.plane = element.normal;
        if constexpr (beam::DeformableSections<B>) {
            if (!before.stands) return turn;
            if (oval_pair(mesh, i, j)) {
                const auto turned = [&](Index f, double u, double v, double around) {
                    const auto was = mean_directors(mesh, state, f, u, around), is = mean_directors(mesh, state, f, v, around);
                    return std::max(turn_between(was[0], is[0]), turn_between(was[1], is[1]));
                };
                return std::max(
                    {turn, turned(i, before.u, one.i.u, half), turned(j, before_j, one.j.u, half_of_patch(mesh, i, j, j))});
            }
            const auto across = [&](const StandingSection& section) {
                return FacingSection(mean_directors(mesh, state, i, section.u, half), section.facing, mesh.fibre(i).section)
                    .across;
            };
            turn = std::max(turn, turn_between(across(before), across(one.i)));
        }
        return turn;
    }
    /// Elements of the mesh that hold both places.
    template <class Element>
    static void host(const beam::Mesh<B>& mesh, Element& element) {
        element.first_i =
            static_cast<std::int32_t>(mesh.first_unknown(element.fibre_i, mesh.locate(element.fibre_i, element.u_i).first));
        element.first_j =
            static_cast<std::int32_t>(mesh.first_unknown(element.fibre_j, mesh.locate(element.fibre_j, element.u_j).first));
    }
    /// The patches of some place have come to other elements since this was asked last: its tangent couples other unknowns.
    bool rehosted() noexcept {
        bool some = false;
        for (Held& one : held_) some = some || one.rehosted, one.rehosted = false;
        return some;
    }

    template <class Element>
    const SlidingPlace<B>& of(const Element& element) const noexcept {
        return held_[core::at(element.place)].place;
    }
    /// Normal that its element had when sections were renewed.
    template <class Element>
    const Vec3& plane(const Element& element) const noexcept {
        return held_[core::at(element.place)].plane;
    }

private:
    /// How a place slides: freely, on one fibre alone, not at all, or across one of its zone's valleys, from this number on.
    enum : std::int8_t { free, on_i, on_j, fixed, across_valley };
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

    bool wanted(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Zone* before) const {
        if (!beam::DeformableSections<B> && oval_pair(mesh, zone.span.fibre_i, zone.span.fibre_j))
            return false;  // centrelines say too little of where they touch
        if (places_ != Places::as_needed || all_) return places_ != Places::renewed;
        return bend_around(mesh, state, zone.span) > loop - (before && before->followed ? hysteresis : 0.0) ||
               clasped(mesh, state, zone.span);
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
    /// Distance over radius of curvature from which two fibres are a loop around each other: cloths have a tenth. Less by the
    /// second once they are followed.
    static constexpr double loop = 0.25, hysteresis = 0.05;
    /// A section is one of a place, and less than an element away from it.
    static bool stand(const beam::Mesh<B>& mesh, const auto& element, const auto& one) noexcept {
        return near(mesh, element.fibre_i, element.u_i, one.i) && near(mesh, element.fibre_j, element.u_j, one.j);
    }
    static bool near(const beam::Mesh<B>& mesh, Index fibre, double u, const StandingSection& section) noexcept {
        return section.stands && std::abs(u - section.u) < 0.9 && mesh.apart(fibre, u, section.u) < 0.9;
    }
    template <class Element>
    static SlidingPlace<B> place_of(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Element& element,
                                    const auto& one) {
        const Index i = element.fibre_i, j = element.fibre_j;
        const Slide slide = slide_of(mesh, zone, element.slide);
        if constexpr (beam::OvalSections<B>)
            if (oval_pair(mesh, i, j)) {
                const OvalGap gap = oval_gap(mesh, pair_geometry(mesh, state, i, j, element.u_i, element.u_j), i, j,
                                             standing_directors(mesh, state, i, j, one.i, one.j), element.normal);
                return oval_place(mesh, state, i, j, element.u_i, element.u_j, one.i, one.j, gap, slide);
            }
        return sliding_place(mesh, state, i, j, element.u_i, element.u_j, one.i, one.j, element.normal, slide);
    }
    struct Held {
        StandingSection i, j;
        Vec3 plane = Vec3::Zero();
        SlidingPlace<B> place;
        bool rehosted = false;
    };
    Places places_;
    bool all_ = false;
    std::vector<Held> held_;
    Vector accepted_;
};

}  // namespace fibrant::contact

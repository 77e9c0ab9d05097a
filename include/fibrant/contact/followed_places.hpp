// SPDX-License-Identifier: MIT
#pragma once
/// @file Which crossings of a contact set are followed, and what they push with.

#include <fibrant/contact/closest_places.hpp>
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/free_legs.hpp>
#include <fibrant/contact/valley_stations.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace fibrant::contact {

/// How far two fibres are bent around each other where a zone of theirs is closest: distance over radius of curvature, of the one
/// that is bent more towards the other [1]. A fibre's mean over a patch has the corner that a force at a node shears it into.
inline double bend_around(const PairGeometry& pair) noexcept { return 1.0 - pair.closeness.diagonal().minCoeff(); }

/// Places of the crossings that are followed, beside the contact elements of a set. Where none is it holds nothing.
template <class B>
class FollowedPlaces {
public:
    explicit FollowedPlaces(Places places) : places_{places} {}

    /// Whether crossings are followed from the next detection on, if it is as needed.
    void follow(bool whether) noexcept { all_ = whether; }
    /// Says whether crossings of a zone are followed. As needed they are wherever fibres are bent around each other as only loops
    /// are, hang in each other by legs that let them swing aside, or clasp each other, whatever increments lead there.
    /// @param zones  all that there are
    void mark(const beam::Mesh<B>& mesh, const Vector& state, Zone& zone, const Zone* before, const ZonesOfFibres& zones) const {
        zone.followed = wanted(mesh, state, zone, before, all_, zones);
        zone.settled = zone.followed && before && before->settled;
        if (zone.settled) zone.slanting = before->slanting;
    }
    /// Whether what `follow` says decides about some zone of an attempt, as the fibres lay before it.
    bool matters(const beam::Mesh<B>& mesh, const Vector& state, const std::vector<Zone>& zones) const {
        const ZonesOfFibres of_fibres(zones);
        const auto differs = [&](const Zone& zone) {
            return !zone.forced && wanted(mesh, state, zone, &zone, !all_, of_fibres) != zone.followed;
        };
        return zones.empty() || std::any_of(zones.begin(), zones.end(), differs);
    }
    /// Crossings that are followed go on as one contact element until bent around each other so much that the angle between them
    /// is, but for this part of what it is elsewhere, that of fibres side by side [1].
    static double angle_share(const Zone& zone) noexcept { return zone.followed ? 0.2 : 1.0; }
    bool none() const noexcept { return held_.empty(); }

    /// Gives each element that is followed a place.
    template <class Elements>
    void number(Elements& elements, const std::vector<Zone>& zones, const Vector& accepted) {
        std::int32_t count = 0;
        for (auto& element : elements)
            if (element.place >= -1) element.place = is_followed(element, zones[core::at(element.zone)]) ? count++ : -1;
        held_.clear();
        held_.resize(core::at(count));
        if (count > 0) accepted_ = accepted;
    }
    /// What the slips of an increment count from.
    const Vector& accepted() const noexcept { return accepted_; }

    /// The closest patches of a state, and the normal from the one to the other.
    template <class Element>
    void follow(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, Element& element) {
        if constexpr (beam::OvalSections<B>) {
            if (oval_pair(mesh, element.fibre_i, element.fibre_j)) {
                Held& one = held_[core::at(element.place)];
                if (!stand(mesh, element, one)) renew(mesh, state, element);
                follow_oval(mesh, state, element.fibre_i, element.fibre_j, one.i, one.j,
                            ValleyStations<B>::slide_of(mesh, zone, element.slide), element.u_i, element.u_j, element.normal);
                return;
            }
        }
        const Slide slide = ValleyStations<B>::slide_of(mesh, zone, element.slide);
        if (slide.kind == Slide::freely) follow_closest(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        if (slide.kind == Slide::along)
            follow_along(mesh, state, element.fibre_i, element.fibre_j, slide, element.u_i, element.u_j);
        element.normal = normal_of(mesh, state, slide, element);
    }
    /// Normal between the same places of an element in another state. @param zone  of the element
    template <class Element>
    Vec3 normal_in(const beam::Mesh<B>& mesh, const Vector& other, const Zone& zone, const Element& element) const {
        if constexpr (beam::OvalSections<B>) {
            if (oval_pair(mesh, element.fibre_i, element.fibre_j)) {
                const Held& one = held_[core::at(element.place)];
                double u_i = element.u_i, u_j = element.u_j;
                Vec3 normal = element.normal;
                follow_oval(mesh, other, element.fibre_i, element.fibre_j, one.i, one.j, {Slide::nowhere, {}}, u_i, u_j, normal);
                return normal;
            }
        }
        return normal_of(mesh, other, ValleyStations<B>::slide_of(mesh, zone, element.slide), element);
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
    /// To the side on which the element's own normal is.
    template <class Element>
    static Vec3 normal_of(const beam::Mesh<B>& mesh, const Vector& state, const Slide& slide, const Element& element) {
        const PairGeometry pair = pair_geometry(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        const Vec3 normal = unit_or(slide.kind == Slide::freely ? Vec3(pair.t_i.cross(pair.t_j)) : pair.centres, element.normal);
        return normal.dot(element.normal) < 0.0 ? Vec3(-normal) : normal;
    }
    /// @param all  every crossing is
    bool wanted(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Zone* before, bool all,
                const ZonesOfFibres& zones) const {
        if (!beam::DeformableSections<B> && oval_pair(mesh, zone.span.fibre_i, zone.span.fibre_j))
            return false;  // centrelines say too little of where they touch
        if (places_ != Places::as_needed || all) return places_ != Places::renewed;
        const bool followed = before && before->followed;
        const PairGeometry pair =
            pair_geometry(mesh, state, zone.span.fibre_i, zone.span.fibre_j, zone.span.closest_i, zone.span.closest_j);
        return bend_around(pair) > loop - (followed ? hysteresis : 0.0) ||
               swing_of(mesh, state, zone.span, pair, zones) > swing - (followed ? swing_hysteresis : 0.0) ||
               clasped(mesh, state, zone.span);
    }
    /// Distance over radius of curvature from which two fibres are a loop around each other: cloths have a tenth. Less by the
    /// second once they are followed.
    static constexpr double loop = 0.25, hysteresis = 0.05;
    /// The same for the factor by which passes would swing them aside: bending takes up to half of it.
    static constexpr double swing = 0.75, swing_hysteresis = 0.25;
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
        const Slide slide = ValleyStations<B>::slide_of(mesh, zone, element.slide);
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

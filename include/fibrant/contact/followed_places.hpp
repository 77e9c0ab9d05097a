// SPDX-License-Identifier: MIT
#pragma once
/// @file Which crossings of a contact set are followed, and what they push with.

#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/contact_record.hpp>
#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/core/symmetric_eigen.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fibrant::contact {

/// How far two fibres are bent around each other where a zone of theirs is closest: distance over radius of curvature, of the one that is bent more
/// towards the other [1]. A fibre's mean over a patch has the corner that a force at a node shears it into.
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
    /// Crossings of a zone are to be followed. As needed they are wherever fibres are bent around each other as only loops are, whatever increments
    /// lead there.
    bool wanted(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Zone* before) const {
        const auto oval = [&](Index f) { return mesh.fibre(f).section.semi_axis_1 != mesh.fibre(f).section.semi_axis_2; };
        if (oval(zone.span.fibre_i) || oval(zone.span.fibre_j)) return false;  // centrelines say too little of where they touch
        if (places_ != Places::as_needed || all_) return places_ != Places::renewed;
        return bend_around(mesh, state, zone.span) > loop - (before && before->followed ? hysteresis : 0.0);
    }
    /// Crossings that are followed go on as one contact element until bent around each other so much that the angle between them is, but for
    /// this part of what it is elsewhere, that of fibres side by side [1].
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
        for (auto& element : elements) element.place = follows(element, zones[core::at(element.zone)]) ? count++ : -1;
        held_.resize(core::at(count));
        if (count > 0) accepted_ = accepted;
    }
    /// What the slips of an increment count from.
    const Vector& accepted() const noexcept { return accepted_; }

    /// New pairs of stations in the place of that of a crossing: where its two fibres are closest, near where they were. Straight lines are in one
    /// place; fibres that hang in each other at a slant, or are bent around each other by more than a touching distance, in several.
    /// @param pairs  the last one is the crossing's
    template <class Memory>
    static void settle(const beam::Mesh<B>& mesh, const Vector& state, const Zone& zone, const Memory& memory, std::vector<StationPair>& pairs) {
        const Index i = zone.span.fibre_i, j = zone.span.fibre_j;
        StationPair middle = pairs.back();
        pairs.pop_back();
        if (const auto* record = memory.nearest(i, j, middle.u_i, middle.u_j, 1.5)) middle.u_i = record->u_i, middle.u_j = record->u_j;
        follow_closest(mesh, state, i, j, middle.u_i, middle.u_j);
        const PairGeometry pair = pair_geometry(mesh, state, i, j, middle.u_i, middle.u_j);
        const core::SymmetricEigen<2> parts(pair.closeness);
        const std::size_t first = pairs.size();
        if (parts.values()[0] > 0.0) pairs.push_back(middle);
        const double touching = mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius();
        for (int direction = 0; direction < 2; ++direction) {
            if (parts.values()[direction] > sole) continue;  // no other place nearby
            const Eigen::Vector2d way = touching * parts.vectors().col(direction);
            for (const double side : {-1.0, 1.0}) {
                StationPair other = middle;
                other.u_i = std::clamp(middle.u_i + side * way[0] / pair.speed_i, mesh.bounds(i).first, mesh.bounds(i).second);
                other.u_j = std::clamp(middle.u_j + side * way[1] / pair.speed_j, mesh.bounds(j).first, mesh.bounds(j).second);
                follow_closest(mesh, state, i, j, other.u_i, other.u_j);
                const auto same = [&](const StationPair& one) {
                    return std::max(mesh.apart(i, one.u_i, other.u_i) * pair.speed_i, mesh.apart(j, one.u_j, other.u_j) * pair.speed_j) < 0.1 * touching;
                };
                if (std::none_of(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), same)) pairs.push_back(other);
            }
        }
        if (pairs.size() == first) pairs.push_back(middle);
        std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(), [](const StationPair& a, const StationPair& b) { return a.u_i < b.u_i; });
    }

    /// The closest patches of a state, and the normal across both.
    template <class Element>
    void follow(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
        const Vec3 before = element.normal;
        const std::int32_t first_i = element.first_i, first_j = element.first_j;
        follow_closest(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        host(mesh, element);
        if (element.first_i != first_i || element.first_j != first_j) held_[core::at(element.place)].rehosted = true;
        const PairGeometry pair = pair_geometry(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j);
        element.normal = unit_or(pair.t_i.cross(pair.t_j), before);
        if (element.normal.dot(before) < 0.0) element.normal = -element.normal;
    }
    /// What an element pushes with; its cap becomes one that makes its gap that of its patches.
    template <class Element>
    void take(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
        SlidingPlace<B>& place = held_[core::at(element.place)].place;
        place = sliding_place(mesh, state, element.fibre_i, element.fibre_j, element.u_i, element.u_j, element.normal);
        element.cap = element.normal.dot(element.offset(state)) - place.gap;
    }
    /// Elements of the mesh that hold both places.
    template <class Element>
    static void host(const beam::Mesh<B>& mesh, Element& element) {
        element.first_i = static_cast<std::int32_t>(mesh.first_unknown(element.fibre_i, mesh.locate(element.fibre_i, element.u_i).first));
        element.first_j = static_cast<std::int32_t>(mesh.first_unknown(element.fibre_j, mesh.locate(element.fibre_j, element.u_j).first));
    }
    /// Some place has come to another element since this was asked last: its tangent couples other unknowns.
    bool rehosted() noexcept {
        bool some = false;
        for (Held& one : held_) some = some || one.rehosted, one.rehosted = false;
        return some;
    }

    template <class Element>
    const SlidingPlace<B>& of(const Element& element) const noexcept { return held_[core::at(element.place)].place; }

private:
    /// Second variation of the closest distance, over the distance, beyond which no other place is looked for [1].
    static constexpr double sole = 0.4;
    /// Distance over radius of curvature from which two fibres are a loop around each other: cloths have a tenth, fibres that are pressed
    /// together by 8 r over 50 r a third. Less by the second once they are followed.
    static constexpr double loop = 0.4, hysteresis = 0.05;
    struct Held {
        SlidingPlace<B> place;
        bool rehosted = false;
    };
    Places places_;
    bool all_ = false;
    std::vector<Held> held_;
    Vector accepted_;
};

}  // namespace fibrant::contact

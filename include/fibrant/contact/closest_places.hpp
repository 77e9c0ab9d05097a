// SPDX-License-Identifier: MIT
#pragma once
/// @file All places of a zone where its two fibres are closer than beside.

#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/contact/intermediate_geometry.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace fibrant::contact {

/// Of stations that are followed, along a valley of a zone [touching distance].
inline constexpr double valley_spacing = 0.35;
/// Distance of centrelines beyond which a second crossing of a zone has no place [touching distance].
inline constexpr double furthest_crossing = 1.5;

/// Of two pairs of places, at rest: the greater of both ways [length].
template <class B>
double arc_apart(const beam::Mesh<B>& mesh, const proximity::ProximityZone& span, const Eigen::Vector2d& a,
                 const Eigen::Vector2d& b) noexcept {
    const Index i = span.fibre_i, j = span.fibre_j;
    return std::max(mesh.apart(i, a[0], b[0]) * mesh.fibre(i).element_length,
                    mesh.apart(j, a[1], b[1]) * mesh.fibre(j).element_length);
}
/// Places of a zone where its two fibres are closer than beside, as its centrelines stand, the known one first: what a walk along
/// the zone finds, a station's spacing at a time.
/// @param joined    it is two in one: it is walked along and against
/// @param stations  that it has: of a zone that is two in one, where places are beside those ways
template <class B>
std::vector<Eigen::Vector2d> closest_places(const beam::Mesh<B>& mesh, const Vector& state, proximity::ProximityZone span,
                                            const Eigen::Vector2d& known, bool joined = false,
                                            std::span<const Eigen::Vector2d> stations = {}) {
    const Index i = span.fibre_i, j = span.fibre_j;
    const double touching = mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius();
    const double h_i = mesh.fibre(i).element_length, h_j = mesh.fibre(j).element_length;
    std::vector<Eigen::Vector2d> places{known};
    const double length = std::max(std::abs(span.b_i - span.a_i) * h_i, std::abs(span.b_j - span.a_j) * h_j);
    const Index steps = static_cast<Index>(length / (valley_spacing * touching));
    if (steps < 3) return places;
    const auto distance = [&](double u_i, double u_j) { return pair_geometry(mesh, state, i, j, u_i, u_j).centres.norm(); };
    const auto look = [&](const Eigen::Vector2d& near) {
        if (places.size() >= Zone::most_crossings) return;
        Eigen::Vector2d place = near;
        follow_closest(mesh, state, i, j, place[0], place[1]);
        const bool self = i == j && mesh.apart(i, place[0], place[1]) * h_i < self_contact_arc(0.5 * touching, h_i);
        const bool met = std::any_of(places.begin(), places.end(),
                                     [&](const Eigen::Vector2d& one) { return arc_apart(mesh, span, one, place) < touching; });
        // Where it was seen: a search that ran off has found another one, or none.
        if (!self && !met && arc_apart(mesh, span, place, near) < touching &&
            distance(place[0], place[1]) < furthest_crossing * touching)
            places.push_back(place);
    };
    const auto walk = [&] {
        Eigen::Vector2d before = Eigen::Vector2d::Zero();
        double last = 0.0;
        bool falling = false;
        for (Index k = 0; k <= steps; ++k) {
            const double share = static_cast<double>(k) / static_cast<double>(steps);
            Eigen::Vector2d here(mesh.wrapped(i, span.a_i + share * (span.b_i - span.a_i)),
                                 mesh.wrapped(j, span.a_j + share * (span.b_j - span.a_j)));
            follow_along(mesh, state, i, j, Slide{Slide::along, {0.0, 1.0}}, here[0], here[1]);
            const double now = distance(here[0], here[1]);
            if (k > 0 && falling && now > last) look(before);
            falling = k > 0 && now < last;
            last = now, before = here;
        }
    };
    walk();
    if (joined) {
        std::swap(span.a_j, span.b_j), walk();
        for (const Eigen::Vector2d& one : stations) look({mesh.wrapped(i, one[0]), mesh.wrapped(j, one[1])});
    }
    return places;
}

/// Whether two fibres clasp each other in a zone, as legs and heads of a knit do: they cross twice, and come back to the side
/// that they came from, so that normals are opposite. Of straight crossings, and of fibres along each other, the first lines say
/// that they do not.
template <class B>
bool clasped(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& span) {
    const Index i = span.fibre_i, j = span.fibre_j;
    const auto centres = [&](double u_i, double u_j) {
        return Vec3(mesh.position(state, j, mesh.wrapped(j, u_j)) - mesh.position(state, i, mesh.wrapped(i, u_i)));
    };
    if (centres(span.a_i, span.a_j).dot(centres(span.b_i, span.b_j)) <= 0.0) return false;
    const auto sine = [&](double u_i, double u_j) {
        return sine_between(mesh.derivative(state, i, u_i).normalized(), mesh.derivative(state, j, u_j).normalized());
    };
    const double least = 0.5;  // of 30 degrees, above which crossings are one contact
    if (sine(span.closest_i, span.closest_j) < least) return false;
    const std::vector<Eigen::Vector2d> places = closest_places(mesh, state, span, {span.closest_i, span.closest_j});
    const Vec3 first = centres(places[0][0], places[0][1]);
    return std::any_of(places.begin() + 1, places.end(), [&](const Eigen::Vector2d& place) {
        return centres(place[0], place[1]).dot(first) < 0.0 && sine(place[0], place[1]) > least;
    });
}

}  // namespace fibrant::contact

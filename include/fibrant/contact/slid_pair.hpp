// SPDX-License-Identifier: MIT
#pragma once
/// @file A pair of stations that slides to where its fibres are closest, round or not.

#include <fibrant/contact/oval_place.hpp>
#include <fibrant/contact/sliding_place.hpp>
#include <fibrant/contact/station_pairs.hpp>

namespace fibrant::contact {

/// Whether a section of two fibres is not round.
template <class B>
bool oval_pair(const beam::Mesh<B>& mesh, Index i, Index j) noexcept {
    if constexpr (beam::RoundAtRest<B>) return false;
    const auto oval = [&](Index f) { return mesh.fibre(f).section.semi_axis_1 != mesh.fibre(f).section.semi_axis_2; };
    return oval(i) || oval(j);
}

/// What two places are to each other.
struct SlidPair {
    PairGeometry pair;
    Eigen::Matrix2d closeness;  ///< second variation of their distance by both arc lengths, times it [1]
    double gap;                 ///< [length]
};

/// Follows a pair of places to where it has slid to.
/// @param at      in: nearby
/// @param normal  of sections that are not round; in: of the side that they are on
template <class B>
SlidPair slid(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, const Slide& slide, StationPair& at,
              [[maybe_unused]] Vec3& normal) noexcept {
    if constexpr (beam::OvalSections<B>) {
        if (oval_pair(mesh, i, j)) {
            const auto standing = [](double u) { return StandingSection{u, Eigen::Vector2d::UnitX(), true}; };
            const auto follow = [&] {
                return follow_oval(mesh, state, i, j, standing(at.u_i), standing(at.u_j), slide, at.u_i, at.u_j, normal);
            };
            follow();
            const OvalGap found = follow();  // with sections where the first one has led
            return {pair_geometry(mesh, state, i, j, at.u_i, at.u_j), found.closeness, found.gap};
        }
    }
    if (slide.kind == Slide::freely) follow_closest(mesh, state, i, j, at.u_i, at.u_j);
    if (slide.kind == Slide::along) follow_along(mesh, state, i, j, slide, at.u_i, at.u_j);
    const PairGeometry pair = pair_geometry(mesh, state, i, j, at.u_i, at.u_j);
    return {pair, pair.closeness, pair.centres.norm() - (mesh.fibre(i).section.radius() + mesh.fibre(j).section.radius())};
}

}  // namespace fibrant::contact

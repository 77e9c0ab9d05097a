// SPDX-License-Identifier: MIT
#pragma once
/// @file A fibre inside a hollow one: where it touches the wall, and what its normal does within Newton's method.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/particle.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace fibrant::contact {

/// What the place of a contact element says where no crossing is followed: fibres touch from outside, or one is in the other's
/// bore.
inline constexpr std::int32_t no_bore = -1, bore_of_i = -2, bore_of_j = -3;

/// Of a radius: centres that are no further apart say no direction, that is rounding.
inline constexpr double centred = 1e-12;

/// Which of these it is for two fibres.
template <class B>
std::int32_t bore_between(const beam::Mesh<B>& mesh, Index i, Index j) noexcept {
    return beam::is_inside(mesh.fibre(j), i) ? bore_of_i : beam::is_inside(mesh.fibre(i), j) ? bore_of_j : no_bore;
}

/// Unit vector of what a way has across a direction.
/// @param along      unit
/// @param nothing    length of a way that says no direction: what rounding leaves of it may lie along as well
/// @param otherwise  unit and across, where the way is no longer than that
inline Vec3 across_or(const Vec3& way, const Vec3& along, double nothing, const Vec3& otherwise) noexcept {
    const Vec3 across = way - way.dot(along) * along;
    return across.norm() > nothing ? across.normalized() : otherwise;
}

/// The wall pushes inwards: from one centre to the other, across both fibres.
/// @param tangents    of both, that it is across
/// @param otherwise   unit, where both centres are one
/// @returns from fibre i to fibre j as contact has it: against the way from i to j
template <class B, class Element>
Vec3 bore_normal(const beam::Mesh<B>& mesh, const Vector& state, const Element& element, const PairTangents& tangents,
                 const Vec3& otherwise) noexcept {
    const Vec3 centres = mesh.position(state, element.fibre_j, element.u_j) - mesh.position(state, element.fibre_i, element.u_i),
               along = mean_tangent(tangents.i, tangents.j), flat = otherwise - otherwise.dot(along) * along;
    return -across_or(centres, along, centred * mesh.fibre(element.fibre_i).section.radius(),
                      -unit_or(flat, along.unitOrthogonal()));
}

namespace detail {
/// Particle at a distance from the centre of a section; of a section that turns it is there in space, be it in the plane of the
/// section or not, so that a section which leans feels no moment. @returns the cap that stands for it, as support_weights
/// @param distance  along the unit direction; of a section that directors deform in the material [length]
template <class B>
double particle_along(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, Index first, const Vec3& direction,
                      double distance, beam::Particle<B>& weights) {
    const double xi = mesh.locate(fibre, u).second;
    if constexpr (beam::CentreTouched<B>) {
        weights = beam::touched_centre<B>(xi);
        return distance;
    } else if constexpr (beam::TurningSections<B>) {
        const auto element = state.segment<beam::Mesh<B>::element_unknowns>(first);
        weights = B::particle_weights(xi, 0.0, 0.0);
        const Mat3 turn = weights.turn(element);
        weights.shift(turn.inverse() * (distance * direction));  // a mean of two nodes, and no rotation where they differ
        weights.follow(element);
        return 0.0;
    } else {
        const auto [g_1, g_2] = beam::Mesh<B>::element_directors(state, first, xi);
        const Particle at =
            distance > 0.0 ? support_particle(scene::CrossSection{distance, distance}, g_1, g_2, direction, false) : Particle{};
        weights = B::particle_weights(xi, at.xi_1, at.xi_2);
        return at.cap;
    }
}
}  // namespace detail

/// Particle of a centreline.
template <class B>
beam::Particle<B> centre_particle(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, Index first) {
    beam::Particle<B> weights{};
    detail::particle_along(mesh, state, fibre, u, first, Vec3::UnitX(), 0.0, weights);
    return weights;
}

/// Sections that turn feel the wall by its friction alone: the normal force goes through both centres and acts there. At the wall
/// the arms of an element's two nodes would differ a little, and exert moments on them that are no slope of an energy.
template <class B>
inline constexpr bool pushed_at_centres = beam::TurningSections<B>;

/// Adds the normal force of an element on one of its fibres there, against the internal forces.
template <class B, class Element>
void push_centre(const beam::Mesh<B>& mesh, const Element& element, bool of_j, double reaction, Vector& residual) {
    const Index first = of_j ? element.first_j : element.first_i;
    const double xi = mesh.locate(of_j ? element.fibre_j : element.fibre_i, of_j ? element.u_j : element.u_i).second;
    beam::spread(B::centreline_weights(xi), Vec3((of_j ? -reaction : reaction) * element.normal), first, residual);
}

/// Particles of both fibres that touch, for an element in a bore: away from the normal, on the wall and on the rod. Both are half
/// as deep in each other as the fibres are, so that their forces are at one point.
template <class B, class Element>
void follow_in_bore(const beam::Mesh<B>& mesh, const Vector& state, Element& element) {
    const bool of_i = element.place == bore_of_i;
    const Vec3 outwards_i = -element.normal;  // seen from a tube i, and from a rod i it is the other way
    const double tube = mesh.fibre(of_i ? element.fibre_i : element.fibre_j).section.bore,
                 rod = mesh.fibre(of_i ? element.fibre_j : element.fibre_i).section.radius();
    const Vec3 outwards = of_i ? outwards_i : Vec3(-outwards_i);
    const auto stand = [&](double wall, double side) {
        const double cap_i = detail::particle_along(mesh, state, element.fibre_i, element.u_i, element.first_i, outwards,
                                                    of_i ? wall : side, element.weights_i),
                     cap_j = detail::particle_along(mesh, state, element.fibre_j, element.u_j, element.first_j, outwards,
                                                    of_i ? side : wall, element.weights_j);
        element.cap = of_i ? cap_j - cap_i : cap_i - cap_j;
    };
    stand(tube, rod);
    const double gap = element.gap(state);
    if constexpr (!beam::CentreTouched<B>) {
        if (!(gap < 0.0)) return;
        const double half = std::min(-0.5 * gap, 0.5 * rod);  // of what is deeper no particle is beyond the rod's centre
        stand(tube + half, rod - half);
        element.cap = element.normal.dot(element.offset(state)) - gap;
    }
}

/// The state of the last normal pass, where a scene has tubes: within Newton's method normals turn with the fibres, across the
/// tangents of that state, and friction acts in the plane that it had. Where no fibre is in another it holds nothing.
///
/// A rod that slides around the wall is pushed back by R_N over the distance of the centres. That is far stiffer than its bending
/// where the clearance is small: with a normal that stands still it would go astray. With one that turns, the energy of the
/// contact is a convex function of the distance, its tangent is positive, and nothing of it is left out.
class BorePass {
public:
    template <class B>
    explicit BorePass(const beam::Mesh<B>& mesh) {
        for (const beam::MeshFibre& fibre : mesh.fibres()) any_ = any_ || !fibre.inside.empty();
    }
    bool any() const noexcept { return any_; }
    void keep(const Vector& state) {
        if (any_) state_ = state;
    }
    /// Normal of an element in a bore in that state.
    template <class B, class Element>
    Vec3 normal(const beam::Mesh<B>& mesh, const Element& element) const {
        return bore_normal(mesh, state_, element, pair_tangents(mesh, state_, element), element.normal);
    }
    /// Turns the normal of such an element to where it is in a state.
    template <class B, class Element>
    void turn(const beam::Mesh<B>& mesh, const Vector& state, Element& element) const {
        element.normal = bore_normal(mesh, state, element, pair_tangents(mesh, state_, element), element.normal);
    }
    /// Adds what the turn of normals is to the tangent, and their forces where these act on centres: pairs of particles of both
    /// centrelines.
    /// @param contacts  evaluated at `state`
    template <class B, class Contacts, class Points>
    void add_points(const beam::Mesh<B>& mesh, const Vector& state, const Contacts& contacts, Points& points) const {
        if (!any_) return;
        for (Index k = 0; k < core::count(contacts.elements()); ++k) {
            const auto& element = contacts.elements()[core::at(k)];
            const auto& response = contacts.responses()[core::at(k)];
            if (!element.in_bore() || !(response.reaction > 0.0)) continue;
            const PairTangents tangents = pair_tangents(mesh, state_, element);
            const Vec3 along = mean_tangent(tangents.i, tangents.j), around = along.cross(element.normal),
                       centres = mesh.position(state, element.fibre_j, element.u_j) -
                                 mesh.position(state, element.fibre_i, element.u_i);
            const double distance = -centres.dot(element.normal);
            if (!(distance > 0.0)) continue;
            const beam::Particle<B> i = centre_particle(mesh, state, element.fibre_i, element.u_i, element.first_i),
                                    j = centre_particle(mesh, state, element.fibre_j, element.u_j, element.first_j);
            Mat3 stiffness = response.reaction / distance * around * around.transpose();
            if constexpr (pushed_at_centres<B>) stiffness -= response.slope * element.normal * element.normal.transpose();
            points.push_back({element.first_i, element.first_j, element.fibre_i, element.fibre_j, i, j, stiffness});
        }
    }

private:
    bool any_ = false;
    Vector state_;
};

/// Where a point is seen from a tube.
struct BorePlace {
    double u = 0.0;            ///< abscissa of the nearest place of its centreline [element]
    Vec3 from = Vec3::Zero();  ///< from there to the point [length]
    bool beyond = false;       ///< an end of the tube
};

/// The place of a tube's centreline that is nearest to a point.
/// @param u  of one near it
template <class B>
BorePlace place_in_bore(const beam::Mesh<B>& mesh, const Vector& state, Index tube, const Vec3& point, double u) {
    const double end = static_cast<double>(mesh.fibre(tube).elements), settled = 1e-10;
    const int most = 30;  // each takes the distance over the tube's radius of curvature off what is left
    double step = 0.0;
    for (int iteration = 0; iteration < most; ++iteration) {
        const Vec3 along = mesh.derivative(state, tube, u);
        step = (point - mesh.position(state, tube, u)).dot(along) / along.squaredNorm();
        const double next = std::clamp(u + std::clamp(step, -1.0, 1.0), 0.0, end), way = std::abs(next - u);
        u = next;
        if (way < settled) break;
    }
    const bool first = u == 0.0, last = u == end;
    const double off = 1e-6;  // of an element: rounding, of a rod that ends where the tube does
    return {u, point - mesh.position(state, tube, u), (first && step < -off) || (last && step > off)};
}

/// Calls see(u of the fibre, place) along a fibre in a tube, each found from the one before.
/// @param points  an element
template <class B, class See>
void along_bore(const beam::Mesh<B>& mesh, const Vector& state, Index tube, Index rod, Index points, const See& see) {
    double u = 0.0, least = std::numeric_limits<double>::infinity();
    const Vec3 start = mesh.position(state, rod, 0.0);
    for (Index e = 0; e <= mesh.fibre(tube).elements; ++e)
        if (const double square = (mesh.position(state, tube, static_cast<double>(e)) - start).squaredNorm(); square < least)
            least = square, u = static_cast<double>(e);
    for (Index k = 0; k <= points * mesh.fibre(rod).elements; ++k) {
        const double v = static_cast<double>(k) / static_cast<double>(points);
        const BorePlace place = place_in_bore(mesh, state, tube, mesh.position(state, rod, v), u);
        u = place.u;
        see(v, place);
    }
}

/// The least gap between a fibre and the bore that it is in, which owes nothing to contact elements.
struct BoreGap {
    double gap = std::numeric_limits<double>::infinity();  ///< < 0 in penetration [length]
    Index tube = -1, rod = -1;
    Vec3 position = Vec3::Zero();  ///< of the rod's centre [length]
};

/// Of all fibres in tubes; infinite where there are none. Beyond the ends of a tube nothing is looked at.
template <class B>
BoreGap least_bore_gap(const beam::Mesh<B>& mesh, const Vector& state) {
    constexpr Index points = 8;  // an element: twice as many as contact has where its spacing is halved once
    BoreGap least;
    for (Index rod = 0; rod < mesh.fibre_count(); ++rod)
        for (const Index tube : mesh.fibre(rod).inside)
            along_bore(mesh, state, tube, rod, points, [&](double u, const BorePlace& place) {
                if (place.beyond) return;
                const double distance = place.from.norm(), bore = mesh.fibre(tube).section.bore;
                const Vec3 along = mesh.derivative(state, tube, place.u).normalized(),
                           outwards = across_or(place.from, along, centred * bore, along.unitOrthogonal());
                const auto extent = [&](Index fibre, double at, double radius) {
                    const auto [g_1, g_2] = mesh.directors(state, fibre, at);
                    if constexpr (!beam::DeformableSections<B>) return radius;
                    return scene::circular(radius).extent(g_1, g_2, outwards);
                };
                const double gap = extent(tube, place.u, bore) - distance - extent(rod, u, mesh.fibre(rod).section.radius());
                if (gap < least.gap) least = {gap, tube, rod, mesh.position(state, rod, u)};
            });
    return least;
}

/// Throws std::invalid_argument where the axis of a fibre that is to be in a tube is in its wall, or beside it, where a run
/// begins.
template <class B>
void require_in_bores(const beam::Mesh<B>& mesh) {
    const Vector& state = mesh.start_state();
    for (Index rod = 0; rod < mesh.fibre_count(); ++rod)
        for (const Index tube : mesh.fibre(rod).inside)
            along_bore(mesh, state, tube, rod, B::nodes - 1, [&](double u, const BorePlace& place) {
                const double bore = mesh.fibre(tube).section.bore, distance = place.from.norm();
                if (place.beyond || distance < bore) return;
                core::with_place(
                    [&] {
                        return mesh.label(rod) + " in " + mesh.label(tube) + ", at " + scene::text(mesh.position(state, rod, u));
                    },
                    [&] {
                        core::require(false, "Tube.rods: distance from the tube's axis", distance,
                                      "< " + core::text(bore) + ", its bore");
                    });
            });
}

}  // namespace fibrant::contact

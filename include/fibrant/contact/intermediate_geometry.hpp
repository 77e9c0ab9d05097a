// SPDX-License-Identifier: MIT
#pragma once
/// @file Intermediate geometry of two fibres: closest points, sections by a plane, whether they cross or run side by side.

#include <fibrant/contact/contact_tangent.hpp>
#include <fibrant/proximity/proximity_search.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

namespace fibrant::contact {

/// A pair of stations whose sections may touch; abscissae are counted in elements.
struct StationPair {
    double u_i = 0.0, u_j = 0.0;
    bool crossing = false;              ///< the only pair of its zone, or one of a followed valley
    bool end_i = false, end_j = false;  ///< the station is a fibre's end and the contact is with its cap
    double length = 0.0;    ///< of the zone that it stands for [length]; for a crossing the touching length, for a last section 0
    std::int8_t slide = 0;  ///< of a followed crossing: how its place slides (FollowedPlaces)
};

/// Sorts pairs along both fibres. @param first  of those that are sorted
inline void sort_along(std::vector<StationPair>& pairs, std::size_t first = 0) {
    std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end(),
              [](const StationPair& a, const StationPair& b) { return a.u_i != b.u_i ? a.u_i < b.u_i : a.u_j < b.u_j; });
}

/// The pair of closest points near a start, both inside their fibres.
///
/// Newton on (x_j - x_i) . t_i = 0 and (x_j - x_i) . t_j = 0 with the positive part of its matrix, so it also settles
/// where the lines pass through each other; unique if the angle exceeds arccos(1 - 2 r kappa). With the tangents of
/// contact_tangent: closest but for the kinks between elements, in which there would be two closest points.
template <class B>
StationPair closest_points(const beam::Mesh<B>& mesh, const Vector& state, Index i, Index j, double u_i, double u_j) {
    const auto [low_i, end_i] = mesh.bounds(i);
    const auto [low_j, end_j] = mesh.bounds(j);
    for (int iteration = 0; iteration < 30; ++iteration) {
        const Vec3 centres = mesh.position(state, j, u_j) - mesh.position(state, i, u_i);
        const Vec3 d_i = contact_tangent(mesh, state, i, u_i), d_j = contact_tangent(mesh, state, j, u_j);
        const double a = d_i.squaredNorm(), b = -d_i.dot(d_j), c = d_j.squaredNorm();
        const double p = centres.dot(d_i), q = -centres.dot(d_j);  // minus the gradient of |centres|^2 / 2
        // Gauss-Newton step with a bound on each variable: at a bound the other one alone
        const double determinant = std::max(a * c - b * b, 1e-12 * a * c);
        double step_i = (c * p - b * q) / determinant, step_j = (a * q - b * p) / determinant;
        if ((u_i + step_i < low_i || u_i + step_i > end_i)) {
            step_i = std::clamp(u_i + step_i, low_i, end_i) - u_i;
            step_j = (q - b * step_i) / c;
        }
        if ((u_j + step_j < low_j || u_j + step_j > end_j)) {
            step_j = std::clamp(u_j + step_j, low_j, end_j) - u_j;
            step_i = std::clamp(u_i + (p - b * step_j) / a, low_i, end_i) - u_i;
        }
        const double largest = std::max(std::abs(step_i), std::abs(step_j));
        const double shorten = largest > 1.0 ? 1.0 / largest : 1.0;
        u_i = std::clamp(u_i + shorten * step_i, low_i, end_i);
        u_j = std::clamp(u_j + shorten * step_j, low_j, end_j);
        if (largest < 1e-11) break;
    }
    return {u_i, u_j, true, false, false, 0.0};
}

/// Abscissa where the plane through `origin` across `normal` cuts a fibre, near `u`; clamped to the fibre.
template <class B>
double plane_section(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const Vec3& origin,
                     const Vec3& normal) {
    const auto [low, end] = mesh.bounds(fibre);
    for (int iteration = 0; iteration < 12; ++iteration) {
        const double speed = mesh.derivative(state, fibre, u).dot(normal);
        if (speed == 0.0) break;
        const double step = std::clamp((origin - mesh.position(state, fibre, u)).dot(normal) / speed, -1.0, 1.0);
        const double next = std::clamp(u + step, low, end);
        const bool still = std::abs(next - u) < 1e-11;
        u = next;
        if (still) break;
    }
    return u;
}

/// Arc within which a fibre does not touch itself: pi r is the shortest one that can come back to do so, and elements of one
/// contact have no node in common [length].
inline double self_contact_arc(double radius, double element_length) noexcept {
    return std::max(std::numbers::pi * radius, 2.0 * element_length);
}

/// How contact points are placed.
struct ContactSpacing {
    double points_per_element = 2.0;    ///< along near-parallel fibres [1], > 0
    double crossing_angle_deg = 30.0;   ///< of `contact::crossing_angle_deg`, above: one contact element for the zone [degree]
    double angle_hysteresis_deg = 5.0;  ///< a zone keeps its kind within this of the bound [degree]
    /// Depth that may go unseen between two contact points, where fibres slant or bend towards each other; beyond it the
    /// spacing is halved, up to three times [radius], > 0.
    double largest_unseen = 0.005;
    void validate() const {
        core::require_positive("ContactSpacing.points_per_element", points_per_element);
        core::require_positive("ContactSpacing.largest_unseen", largest_unseen);
        core::require_between("ContactSpacing.crossing_angle_deg", crossing_angle_deg, 1.0, 90.0);
        core::require_between("ContactSpacing.angle_hysteresis_deg", angle_hysteresis_deg, 0.0, 20.0);
    }
};

/// Angle between two fibres at the closest points of their zone, less what bending towards each other takes of it; at most that
/// of two lines which part as fast as the two halves of the zone do [degree].
///
/// The distance of their centres is least there and nowhere beside if its second variation is positive: straight fibres at any
/// angle a; bent ones, c from centre to centre and k their curvature vectors, if sin^2 a > c.(k_i - k_j) + (c.k_i)(c.k_j). That
/// is what is taken off sin^2 a: as it goes to zero a second closest place comes up beside the first, and one contact element
/// would hop to and fro. Fibres that run side by side and splay where they end are closest there and at an angle, yet touch all
/// along: their zone is long, and hardly parts. Straight lines part by s sin a or more, and arcs around a line as the second
/// variation says.
/// @param bent  less what bending takes
template <class B>
double crossing_angle_deg(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& zone,
                          bool bent = true) {
    const Vec3 d_i = mesh.derivative(state, zone.fibre_i, zone.closest_i),
               d_j = mesh.derivative(state, zone.fibre_j, zone.closest_j);
    const Vec3 t_i = d_i.normalized(), t_j = d_j.normalized();
    const Vec3 x_i = mesh.position(state, zone.fibre_i, zone.closest_i), x_j = mesh.position(state, zone.fibre_j, zone.closest_j);
    const Vec3 centres = x_j - x_i;
    const auto bend = [&](Index fibre, double u, const Vec3& derivative, const Vec3& tangent) {
        const Vec3 second = mesh.mean_second_derivative(state, fibre, u);
        return centres.dot(second - second.dot(tangent) * tangent) / derivative.squaredNorm();
    };
    const double bend_i = bend(zone.fibre_i, zone.closest_i, d_i, t_i), bend_j = bend(zone.fibre_j, zone.closest_j, d_j, t_j);
    const double taken = bent ? std::max(0.0, bend_i - bend_j + bend_i * bend_j) : 0.0;
    double sine = std::sqrt(std::max(0.0, t_i.cross(t_j).squaredNorm() - taken));
    const double touching = mesh.fibre(zone.fibre_i).section.radius() + mesh.fibre(zone.fibre_j).section.radius();
    for (const bool first : {true, false}) {
        const Vec3 end_i = mesh.position(state, zone.fibre_i, first ? zone.a_i : zone.b_i);
        const Vec3 end_j = mesh.position(state, zone.fibre_j, first ? zone.a_j : zone.b_j);
        const double length = std::max((end_i - x_i).norm(), (end_j - x_j).norm());
        if (length <= 2.0 * touching) continue;  // no room for another contact
        sine = std::min(sine, std::sqrt(std::max(0.0, (end_j - end_i).squaredNorm() - centres.squaredNorm())) / length);
    }
    return std::asin(std::min(1.0, sine)) * 180.0 / std::numbers::pi;
}

}  // namespace fibrant::contact

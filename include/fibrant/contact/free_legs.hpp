// SPDX-License-Identifier: MIT
#pragma once
/// @file How easily a fibre that hangs in another one swings aside, by the legs that hold it.

#include <fibrant/contact/fibre_patch.hpp>
#include <fibrant/contact/normal_direction.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <vector>

namespace fibrant::contact {

/// Numbers of the estimate below.
namespace leg_numbers {
/// Sine of the turn of either leg from which a fibre hangs in another one as a loop does [1]: half of a right angle. Fibres of a
/// cloth turn by less unless it is jammed, and then they are bent around each other by far more than `loop`.
inline constexpr double least_sine = 0.7;
/// Sine of the angle between fibres below which they wind around each other or lie along each other, and do not hang: less than
/// that of `clasped`, so that hooks at 30 degrees are on one side of it [1].
inline constexpr double least_crossing = 0.45;
inline constexpr double least_bend = 0.02;  ///< distance over radius of curvature below which nothing hangs [1]
inline constexpr double carries = 1.05;     ///< distance of other fibres that end a leg [touching distance]
inline constexpr int most_steps = 64;       ///< of a touching distance: a longer leg counts as it is there
}  // namespace leg_numbers

/// The way on one fibre from a crossing to where it bends back, meets another fibre, or ends.
struct FreeLeg {
    double length = 0.0, sine = 0.0;  ///< [length]; of its turn, towards the other fibre of the crossing [1]
};

/// The leg of a crossing on one of its fibres.
/// @param normal  to the other fibre of the crossing, unit
/// @param way     1 or -1, along the fibre
/// @param end     after which it is over [elements]
template <class B>
FreeLeg free_leg(const beam::Mesh<B>& mesh, const Vector& state, Index fibre, double u, const Vec3& normal, double way,
                 double touching, double end = std::numeric_limits<double>::infinity()) noexcept {
    namespace with = leg_numbers;
    const double step = touching / mesh.fibre(fibre).element_length;
    const auto [low, high] = mesh.bounds(fibre);
    end = std::min(end, way > 0.0 ? high - u : u - low);
    if (mesh.fibre(fibre).closed) end = std::min(end, 0.5 * static_cast<double>(mesh.fibre(fibre).elements));
    FreeLeg leg;
    const auto at = [&](double there) { return mesh.wrapped(fibre, there); };
    const Vec3 tangent = mesh.derivative(state, fibre, at(u)).normalized();
    Vec3 from = mesh.position(state, fibre, at(u));
    for (int k = 1; k <= with::most_steps; ++k) {
        const double there = u + way * std::min(k * step, end);
        const Vec3 direction = way * mesh.derivative(state, fibre, at(there)).normalized(),
                   to = mesh.position(state, fibre, at(there));
        const double sine = direction.dot(normal);
        if (!(sine > leg.sine)) break;
        leg.sine = sine, leg.length += (to - from).norm(), from = to;
        if (k * step >= end || way * direction.dot(tangent) <= 0.0) break;
    }
    return leg;
}

/// The zones that each fibre has a part in: a loop looks for its neighbours among its own, be there as many others as may.
class ZonesOfFibres {
public:
    /// @param zones  have to outlive this, where they are
    explicit ZonesOfFibres(std::span<const Zone> zones) : zones_{zones} {
        Index fibres = 0;
        each_part([&](Index fibre, Index) { fibres = std::max(fibres, fibre + 1); });
        first_.assign(core::at(fibres + 1), 0);
        each_part([&](Index fibre, Index) { ++first_[core::at(fibre)]; });
        std::partial_sum(first_.begin(), first_.end(), first_.begin());
        parts_.resize(core::at(first_.back()));
        each_part([&](Index fibre, Index zone) { parts_[core::at(--first_[core::at(fibre)])] = zone; });
    }
    /// Calls body(zone) for each zone of a fibre.
    template <class Body>
    void each(Index fibre, const Body& body) const {
        if (fibre + 1 >= core::count(first_)) return;
        for (Index k = first_[core::at(fibre)]; k < first_[core::at(fibre + 1)]; ++k) body(zones_[core::at(parts_[core::at(k)])]);
    }

private:
    template <class Body>
    void each_part(const Body& body) const {
        for (Index z = 0; z < core::count(zones_); ++z) {
            const proximity::ProximityZone& span = zones_[core::at(z)].span;
            body(span.fibre_i, z);
            if (span.fibre_j != span.fibre_i) body(span.fibre_j, z);
        }
    }
    std::span<const Zone> zones_;
    std::vector<Index> first_, parts_;  // of each fibre in `parts_`, and one more; numbers of zones
};

/// Way along a fibre from a crossing to where it meets another fibre [elements].
/// @param least  nearer places are of the same crossing [elements]
/// @param own    zone of the crossing
template <class B>
double next_on_leg(const beam::Mesh<B>& mesh, Index fibre, double u, double way, double least, const ZonesOfFibres& zones,
                   const proximity::ProximityZone& own) noexcept {
    double next = std::numeric_limits<double>::infinity();
    const auto meets = [&](double there) {
        const double ahead = mesh.wrapped(fibre, way * (there - u));
        if (ahead > least) next = std::min(next, ahead);
    };
    zones.each(fibre, [&](const Zone& zone) {
        const proximity::ProximityZone& span = zone.span;
        const double touching = mesh.fibre(span.fibre_i).section.radius() + mesh.fibre(span.fibre_j).section.radius();
        if (span == own || span.distance > leg_numbers::carries * touching) return;
        if (span.fibre_i == fibre) meets(span.closest_i);
        if (span.fibre_j == fibre) meets(span.closest_j);
    });
    return next;
}

/// By how much a fibre that hangs in another one swings aside in a contact pass, over what it was aside before, if places are
/// renewed outside of Newton's method: force / (radius of curvature x sideways stiffness). The force is 2 T sin(turn) and the
/// stiffness T (1 / l + 1 / m) of legs l and m under a tension T, which falls out. Bending makes it less [1].
/// @param pair   at the closest place of the zone
/// @param zones  all that there are
template <class B>
double swing_of(const beam::Mesh<B>& mesh, const Vector& state, const proximity::ProximityZone& span, const PairGeometry& pair,
                const ZonesOfFibres& zones) noexcept {
    namespace with = leg_numbers;
    const double distance = pair.centres.norm();
    if (!(distance > 0.0) || sine_between(pair.t_i, pair.t_j) < with::least_crossing) return 0.0;
    const double touching = mesh.fibre(span.fibre_i).section.radius() + mesh.fibre(span.fibre_j).section.radius();
    double most = 0.0;
    for (const bool of_j : {false, true}) {
        const Vec3 normal = (of_j ? -1.0 : 1.0) / distance * pair.centres;
        const double curvature = normal.dot(of_j ? pair.bend_j : pair.bend_i);
        if (curvature * distance < with::least_bend) continue;
        const Index fibre = of_j ? span.fibre_j : span.fibre_i;
        const double u = of_j ? span.closest_j : span.closest_i, least = touching / mesh.fibre(fibre).element_length;
        const auto turns = [&](const FreeLeg& leg) { return leg.sine >= with::least_sine; };
        // Fibres of a cloth bend back after a few steps: only what hangs looks for what else it meets.
        if (!turns(free_leg(mesh, state, fibre, u, normal, 1.0, touching))) continue;
        if (!turns(free_leg(mesh, state, fibre, u, normal, -1.0, touching))) continue;
        const auto leg = [&](double way) {
            return free_leg(mesh, state, fibre, u, normal, way, touching, next_on_leg(mesh, fibre, u, way, least, zones, span));
        };
        const FreeLeg one = leg(1.0), other = leg(-1.0);
        if (turns(one) && turns(other))
            most = std::max(most, curvature * 2.0 * std::min(one.sine, other.sine) / (1.0 / one.length + 1.0 / other.length));
    }
    return most;
}

}  // namespace fibrant::contact

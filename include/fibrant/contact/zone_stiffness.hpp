// SPDX-License-Identifier: MIT
#pragma once
/// @file Penalty stiffness of proximity zones: where it starts, and how it adapts to an allowed penetration.

#include <fibrant/core/parameters.hpp>
#include <fibrant/law/normal_law.hpp>
#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

namespace fibrant::contact {

/// Places of a zone that have a contact point of their own, since it was too deep there unseen; of more than it has room for the
/// last ones.
struct WatchedPlaces {
    static constexpr Index most = 4;
    std::array<std::array<double, 2>, most> at{};  ///< abscissae on both fibres
    Index count = 0;                               ///< found so far
};

/// A proximity zone with what it remembers. Abscissae are counted in elements.
struct Zone {
    proximity::ProximityZone span;
    double stiffness = 0.0;  ///< k_N of its elements [force / length]
    double reference = 0.0;  ///< elastic stiffness of a section over an element's length, k_el [force / length]
    bool crossing = false;   ///< carries one contact element
    bool followed = false;   ///< that one is followed to where its fibres are closest
    bool forced = false;     ///< its normal is prescribed by a forced order
    static constexpr std::size_t most_crossings = 4;
    std::array<bool, most_crossings> slanting{};   ///< where it is followed: the next are along neither fibre
    std::array<double, most_crossings> valleys{};  ///< where it is followed: directions in the plane of both arc lengths in which
                                                   ///< its fibres stay closest, of each of its crossings [radian]
    bool settled = false;                          ///< its stations are those of crossings that are followed
    bool joined = false;                           ///< it is two in one, which may run along and against
    double friction_factor = 1.0;                  ///< of its pair of groups, on the law's coefficient [1]
    double penetration_factor = 1.0;               ///< of its pair of groups, on the allowed penetration [1]
    double narrowed = 1.0;  ///< part of it that is left where it is deeper between contact points, in (0, 1]
    double unseen = 0.0;    ///< depth that its contact points miss, taken off their gaps, >= 0 [length]
    WatchedPlaces watched;
    /// In the last accepted state, 0 for a pair that had no zone there, infinite where nothing was accepted yet [length].
    double deepest = std::numeric_limits<double>::infinity();
    Index order = -1;           ///< forced order between the groups of its fibres, or -1
    Index first = 0, last = 0;  ///< its contact elements
};

/// Adaptation of the penalty by zone (Durville, section 15.3.2; the formula is ours): the largest penetration of a zone
/// is brought to a target below the allowed one.
///
/// Penetration biases the result by what it takes off the travel of the contact, not by its ratio to the radius: for a
/// helical wire its radial sink d changes the strain by (d / r_0) cot^2(helix angle).
struct StiffnessAdaptation {
    double allowed_penetration = core::unset;  ///< p_max [length], > 0
    double target_fraction = 0.45;   ///< of p_max that a zone is adapted to, since it is deeper between points [1], in (0, 1)
    double initial_fraction = 0.05;  ///< of k_el, for zones without a predecessor [1], > 0
    double largest_change = 3.0;     ///< factor at one adaptation [1], > 1
    double cap_fraction = 10.0;      ///< of k_el, not exceeded by what is no deeper than allowed [1], > 0
    double reserve = 100.0;          ///< on the cap, for what is deeper than allowed all the same [1], >= 1
    double floor_fraction = 1e-3;    ///< of k_el [1], > 0
    void validate() const {
        core::require_positive("StiffnessAdaptation.allowed_penetration", allowed_penetration);
        core::require_between("StiffnessAdaptation.target_fraction", target_fraction, 0.01, 0.999);
        core::require_positive("StiffnessAdaptation.initial_fraction", initial_fraction);
        core::require(largest_change > 1.0, "StiffnessAdaptation.largest_change", largest_change, "> 1");
        core::require_positive("StiffnessAdaptation.cap_fraction", cap_fraction);
        core::require(reserve >= 1.0, "StiffnessAdaptation.reserve", reserve, ">= 1");
        core::require_positive("StiffnessAdaptation.floor_fraction", floor_fraction);
    }

    /// A penalty whose floor and cap are one is as stiff as a user wants it, and as deep as that makes it.
    bool adapts() const noexcept { return floor_fraction < cap_fraction; }

    /// Stiffness after an increment in which the zone's largest penetration was `penetration` [length]. One that is beyond the
    /// cap stays there until it may be less.
    double adapted(double stiffness, double reference, double penetration, double regularisation_depth) const noexcept {
        if (!(penetration > 0.0)) return stiffness;
        const double lost = std::min(0.5 * regularisation_depth, 0.5 * target_fraction * allowed_penetration);
        const double ratio = std::max(penetration - lost, 0.0) / (target_fraction * allowed_penetration - lost);
        return std::clamp(stiffness * std::clamp(ratio, 1.0 / largest_change, largest_change), floor_fraction * reference,
                          std::max(cap_fraction * reference, adapts() ? stiffness : 0.0));
    }
};

/// Stiffness after an increment. Multipliers converge the faster the stiffer contact is, and take its penetration away: with
/// them it is never lowered.
/// @param factor  on the allowed penetration
template <law::NormalLaw Normal>
double adapted_stiffness(StiffnessAdaptation adaptation, const Normal& normal, double stiffness, double reference,
                         double penetration, double factor = 1.0) noexcept {
    if constexpr (law::SeeingNormal<Normal>) return stiffness;
    adaptation.allowed_penetration *= factor;
    const double adapted = adaptation.adapted(stiffness, reference, penetration, law::regularisation_depth(normal));
    return law::Augmenting<Normal> ? std::max(stiffness, adapted) : adapted;
}

/// The same for what must not be accepted as it is: with the reserve.
template <law::NormalLaw Normal>
double strictly_adapted_stiffness(StiffnessAdaptation adaptation, const Normal& normal, double stiffness, double reference,
                                  double penetration, double factor = 1.0) noexcept {
    if (adaptation.adapts()) adaptation.cap_fraction *= adaptation.reserve;
    return adapted_stiffness(adaptation, normal, stiffness, reference, penetration, factor);
}

/// Compliance of two opposite line loads on a section, as a stiffness over a length: (pi / 2) E / (1 - nu^2) * length
/// [force / length]. A penalty far above it gains nothing physically.
inline double section_stiffness(const scene::ElasticMaterial& material, double length) noexcept {
    if (material.transverse.given()) return 0.5 * std::numbers::pi * material.section_modulus() * length;
    const double nu = material.poisson_ratio;
    return 0.5 * std::numbers::pi * material.young_modulus / (1.0 - nu * nu) * length;
}

/// The lesser of what two zones of the same fibres have in common on either one, around closed fibres; on one fibre with either
/// part first.
inline double common_around(const proximity::ProximityZone& a, const proximity::ProximityZone& b,
                            std::span<const double> periods) noexcept {
    const auto common = [](double a_1, double a_2, double b_1, double b_2, double period) {
        const auto overlap = [&](double by) {
            return std::min(std::max(a_1, a_2) + by, std::max(b_1, b_2)) - std::max(std::min(a_1, a_2) + by, std::min(b_1, b_2));
        };
        double most = overlap(0.0);
        for (const double turns : {-2.0, -1.0, 1.0, 2.0})
            if (period > 0.0) most = std::max(most, overlap(turns * period));
        return most;
    };
    const double period_i = periods[core::at(a.fibre_i)], period_j = periods[core::at(a.fibre_j)];
    const double straight = std::min(common(a.a_i, a.b_i, b.a_i, b.b_i, period_i), common(a.a_j, a.b_j, b.a_j, b.b_j, period_j));
    if (a.fibre_i != a.fibre_j || period_i == 0.0) return straight;
    return std::max(straight,
                    std::min(common(a.a_i, a.b_i, b.a_j, b.b_j, period_i), common(a.a_j, a.b_j, b.a_i, b.b_i, period_j)));
}

/// Zone of an earlier list (sorted by fibres) that overlaps `span` most, or null. Intervals are widened by `slack`.
/// @param periods  of closed fibres, around which intervals may lie: as beam::Mesh::periods
inline const Zone* predecessor(const std::vector<Zone>& zones, const proximity::ProximityZone& span, double slack = 1.0,
                               std::span<const double> periods = {}) {
    const auto before = [](const Zone& zone, const proximity::ProximityZone& key) {
        return zone.span.fibre_i != key.fibre_i ? zone.span.fibre_i < key.fibre_i : zone.span.fibre_j < key.fibre_j;
    };
    const Zone* best = nullptr;
    double most = -slack;
    for (auto it = std::lower_bound(zones.begin(), zones.end(), span, before);
         it != zones.end() && it->span.fibre_i == span.fibre_i && it->span.fibre_j == span.fibre_j; ++it) {
        if (!periods.empty()) {
            const double common = common_around(it->span, span, periods);
            if (common > most) most = common, best = &*it;
            continue;
        }
        const double common_i = std::min(it->span.b_i, span.b_i) - std::max(it->span.a_i, span.a_i);
        const double common_j = std::min(std::max(it->span.a_j, it->span.b_j), std::max(span.a_j, span.b_j)) -
                                std::max(std::min(it->span.a_j, it->span.b_j), std::min(span.a_j, span.b_j));
        const double common = std::min(common_i, common_j);
        if (common > most) most = common, best = &*it;
    }
    return best;
}

}  // namespace fibrant::contact

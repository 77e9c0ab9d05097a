// SPDX-License-Identifier: MIT
#pragma once
/// @file What a settling goes by: radius of the thinnest fibre, and how stiff the softest one is against moving aside.

#include <fibrant/proximity/proximity_search.hpp>
#include <fibrant/scene/assembly.hpp>
#include <fibrant/scene/spline.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace fibrant::simulation {

/// Stiffness of a node against moving aside alone: what a pull makes of the two elements beside it, and what bending makes of a
/// span between crossings. A beam clamped at both ends has 192 E I / L^3 under a force in its middle, one on hinges 48 E I / L^3:
/// fibres turn at crossings.
/// @param pull     along the fibre [force], >= 0
/// @param element  length of one [length], > 0
/// @param bending  E I [force length^2], > 0
/// @param span     from crossing to crossing [length], > 0
/// @returns [force / length]
inline double node_stiffness(double pull, double element, double bending, double span) noexcept {
    return 4.0 * pull / element + 48.0 * bending / (span * span * span);
}

/// Part of a pull, in (0, 1], under which a fibre turns within a third of an element and not less.
///
/// Under a pull T a fibre turns over a length sqrt(E I / T). Where that is a small part of an element, elements kink at every
/// crossing, contact points stand for corners that are none, and Newton's method goes to and fro between them.
inline double parting_part(double pull, double element, double bending) noexcept {
    const double turn = 0.3 * element;  // a third, by trial
    return pull > 0.0 ? std::min(1.0, bending / (pull * turn * turn)) : 1.0;
}

/// How fibres are pulled along themselves while they settle, by a channel whose loads are what is asked for at an amplitude of 1.
struct Pull {
    std::string channel{};  ///< empty: they are not
    bool first =
        false;  ///< they are pulled before they part: right where forced orders part them, drawn fibres may go through each other
    bool drawn =
        false;  ///< of those that are pulled first: fibres begin about where they come to, and are pulled while they part
};

/// A fibre that is to settle.
struct SettledFibre {
    double radius = core::unset;   ///< [length], > 0
    double pull = 0.0;             ///< along it, at an amplitude of 1 [force], >= 0
    double element = core::unset;  ///< length of one [length], > 0
    double bending = core::unset;  ///< E I [force length^2], > 0
    double span = core::unset;     ///< from crossing to crossing [length], > 0
};

/// What a fibre of an assembly resists with: in bending about its softer axis.
/// @param length  of it where the run begins [length], > 0
/// @param span    from crossing to crossing [length], > 0
/// @param pull    along it, at an amplitude of 1 [force], >= 0
inline SettledFibre settled_fibre(const scene::FibreSpecification& fibre, double length, double span, double pull = 0.0) {
    const double moment = std::min(fibre.section.second_moment_1(), fibre.section.second_moment_2());
    return {fibre.section.radius(), pull, length / static_cast<double>(fibre.elements), fibre.material.young_modulus * moment,
            span};
}

/// What a settling goes by.
struct SettlingScales {
    double radius = core::unset;       ///< of the thinnest fibre [length], > 0
    double thickest = core::unset;     ///< radius of the thickest fibre [length], >= radius; unset: as thin
    double slack = core::unset;        ///< `node_stiffness` of the softest fibre without a pull [force / length], > 0
    double taut = core::unset;         ///< and with the pull under which fibres part, or that follows [force / length], >= slack
    std::vector<double> over_softest;  ///< the latter of each fibre over that of the softest [1], >= 1; empty: all are equal
    double parting = 1.0;              ///< part of the pull under which fibres part [1], in (0, 1]
    bool driven = false;               ///< something holds, pulls or straightens fibres: at rest there are forces
    bool ordered = false;              ///< forced orders part fibres
    void validate() const {
        core::require_positive("SettlingScales.radius", radius);
        if (!std::isnan(thickest))
            core::require(thickest >= radius, "SettlingScales.thickest", thickest, ">= radius, " + core::text(radius));
        core::require_positive("SettlingScales.slack", slack);
        core::require(taut >= slack, "SettlingScales.taut", taut, ">= slack, " + core::text(slack));
        core::require_finite("SettlingScales.taut", taut);
        core::require(parting > 0.0 && parting <= 1.0, "SettlingScales.parting", parting, "in (0, 1]");
    }
};

/// Of fibres, all that follows from their numbers.
inline SettlingScales scales_of(const std::vector<SettledFibre>& fibres, bool pulled_first) {
    SettlingScales scales;
    scales.thickest = 0.0;
    scales.radius = scales.slack = scales.taut = std::numeric_limits<double>::infinity();
    if (pulled_first)
        for (const SettledFibre& fibre : fibres)
            scales.parting = std::min(scales.parting, parting_part(fibre.pull, fibre.element, fibre.bending));
    bool equal = true;
    for (const SettledFibre& fibre : fibres) {
        scales.radius = std::min(scales.radius, fibre.radius), scales.thickest = std::max(scales.thickest, fibre.radius);
        scales.slack = std::min(scales.slack, node_stiffness(0.0, fibre.element, fibre.bending, fibre.span));
        const double taut = node_stiffness(scales.parting * fibre.pull, fibre.element, fibre.bending, fibre.span);
        scales.taut = std::min(scales.taut, taut);
        scales.over_softest.push_back(taut);
        equal = equal && taut == scales.over_softest.front();
    }
    for (double& stiffness : scales.over_softest) stiffness /= scales.taut;
    if (equal) scales.over_softest.clear();
    return scales;
}

namespace detail {
/// A fibre as it lies where a run begins, at `pieces` + 1 points.
inline std::vector<Vec3> start_points(const scene::FibreSpecification& fibre, Index pieces) {
    const scene::Curve& curve = fibre.start ? fibre.start : fibre.curve;
    std::vector<Vec3> points;
    for (Index k = 0; k <= pieces; ++k) {
        const double t = static_cast<double>(k) / static_cast<double>(pieces);
        points.push_back(curve ? curve(t) : Vec3((1.0 - t) * fibre.from + t * fibre.to));
    }
    return points;
}

/// Length of a fibre as it begins [length].
inline double start_length(const scene::FibreSpecification& fibre) {
    const scene::Curve& curve = fibre.start ? fibre.start : fibre.curve;
    return curve ? scene::length_of(curve, std::max<Index>(64, 2 * fibre.elements)) : (fibre.to - fibre.from).norm();
}
}  // namespace detail

/// Mean length from crossing to crossing of fibres as they lie where a run begins; at most the shortest fibre, and a quarter of
/// it where none cross [length]. Two fibres cross where they are within half a radius of touching at more than 30 degrees;
/// crossings of a fibre that are closer than its diameter and half are one, so that a bundle counts once.
template <proximity::ProximitySearch Search>
double crossing_span(const scene::Assembly& assembly, Search search) {
    const double apart = std::cos(std::numbers::pi / 6.0), reach_over_radius = 0.5, one_over_radius = 3.0;
    std::vector<std::vector<Vec3>> points;
    std::vector<proximity::Centreline> lines;
    std::vector<std::pair<Index, Index>> segments;  // fibre, and segment of it
    double radius = std::numeric_limits<double>::infinity(), whole = 0.0, shortest = radius;
    for (const scene::FibreSpecification& fibre : assembly.fibres()) {
        const Index pieces = 4 * fibre.elements;
        points.push_back(detail::start_points(fibre, pieces));
        radius = std::min(radius, fibre.section.radius());
        for (Index k = 0; k < pieces; ++k) segments.emplace_back(core::count(points) - 1, k);
        const double length = detail::start_length(fibre);
        whole += length, shortest = std::min(shortest, length);
    }
    for (std::size_t f = 0; f < points.size(); ++f)
        lines.push_back({.points = points[f], .radius = assembly.fibres()[f].section.radius()});
    std::vector<std::vector<double>> places(points.size());
    const auto chord = [&](std::int32_t k) {
        const auto [f, s] = segments[core::at(k)];
        return Vec3(points[core::at(f)][core::at(s + 1)] - points[core::at(f)][core::at(s)]);
    };
    for (const proximity::SegmentPair& pair : search.pairs(lines, reach_over_radius * radius)) {
        const Vec3 a = chord(pair.i), b = chord(pair.j);
        if (std::abs(a.dot(b)) >= apart * a.norm() * b.norm()) continue;
        for (const std::int32_t k : {pair.i, pair.j})
            places[core::at(segments[core::at(k)].first)].push_back(static_cast<double>(segments[core::at(k)].second));
    }
    double crossings = 0.0;
    for (std::size_t f = 0; f < places.size(); ++f) {
        std::sort(places[f].begin(), places[f].end());
        const Vec3 first = points[f][1] - points[f][0];
        const double one = std::max(1.5, one_over_radius * lines[f].radius / std::max(first.norm(), 1e-12 * whole));
        for (std::size_t k = 0; k < places[f].size(); ++k)
            if (k == 0 || places[f][k] - places[f][k - 1] > one) ++crossings;
    }
    return crossings > 0.0 ? std::min(whole / crossings, shortest) : 0.25 * shortest;
}

/// The numbers of any assembly.
/// @throws std::invalid_argument for one without fibres
template <proximity::ProximitySearch Search>
SettlingScales scales_of(const scene::Assembly& assembly, const Pull& pull, const Search& search) {
    if (assembly.fibres().empty()) core::refuse("assembly.fibres", "none", "at least one fibre");
    std::vector<SettledFibre> fibres;
    bool straightened = false;
    const double span = crossing_span(assembly, search);
    for (const scene::FibreSpecification& fibre : assembly.fibres()) {
        fibres.push_back(settled_fibre(fibre, detail::start_length(fibre), span));
        straightened = straightened || fibre.start;
    }
    for (const scene::DeadForce& force : assembly.forces())
        if (!pull.channel.empty() && force.channel == pull.channel && force.vector == scene::NodeVector::position) {
            double& most = fibres[core::at(force.at.fibre)].pull;
            most = std::max(most, force.force.norm());
        }
    SettlingScales scales = scales_of(fibres, pull.first);
    scales.ordered = !assembly.orders().empty();
    const auto any = [](const auto&... lists) { return (!lists.empty() || ...); };
    scales.driven = straightened || any(assembly.holds(), assembly.forces(), assembly.moments(), assembly.pressures(),
                                        assembly.bodies(), assembly.cells(), assembly.tools());
    return scales;
}

}  // namespace fibrant::simulation

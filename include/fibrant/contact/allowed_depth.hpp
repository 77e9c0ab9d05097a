// SPDX-License-Identifier: MIT
#pragma once
/// @file Penetration of contact elements against what is allowed, and zones that are stiffened until it is kept.

#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/zone_stiffness.hpp>

#include <algorithm>
#include <string>
#include <type_traits>

namespace fibrant::contact {

namespace detail {
/// Of the elements of a zone but those whose gap a law limits: these are on their way [length].
template <class Contacts>
double depth_of(const Contacts& contacts, const Zone& zone) {
    double depth = 0.0;
    for (Index k = zone.first; k < zone.last; ++k) {
        const auto& element = contacts.elements()[core::at(k)];
        if (!(element.shift.value() > 0.0))
            depth = std::max(depth, adapting_penetration(element, contacts.responses()[core::at(k)]));
    }
    return depth;
}
}  // namespace detail

/// What is deepest over what it is allowed.
struct DepthOverAllowed {
    double value = 0.0;            ///< [1]
    Index fibre = -1, other = -1;  ///< fibres, or a fibre and a tool; -1 where laws have multipliers
    bool tool = false;
};

/// For a report.
inline std::string text(const DepthOverAllowed& depth) {
    std::string what = "contact";
    if (depth.fibre >= 0) {
        what += " of fibre " + std::to_string(depth.fibre) + " with ";
        what += depth.tool                   ? "tool " + std::to_string(depth.other)
                : depth.fibre == depth.other ? "itself"
                                             : "fibre " + std::to_string(depth.other);
    }
    return what + " is " + core::text(depth.value) + " times as deep as allowed, as stiff as it may be";
}

/// Greatest penetration of what was evaluated last over what is allowed of it: by zone, of laws with multipliers what they leave.
/// Forced orders and limited gaps are not asked: they are on their way.
template <class Contacts>
DepthOverAllowed depth_over_allowed(const Contacts& contacts, const StiffnessAdaptation& adaptation) {
    if constexpr (requires { contacts.normal_law().largest_penetration(); }) {
        return {.value = contacts.misfit() / contacts.normal_law().largest_penetration()};
    } else if constexpr (law::SeeingNormal<std::decay_t<decltype(contacts.normal_law())>>) {
        return {};  // what fibres sink is the law's answer
    } else {
        DepthOverAllowed most;
        for (const Zone& zone : contacts.zones()) {
            if (zone.forced) continue;
            const double over = detail::depth_of(contacts, zone) / (adaptation.allowed_penetration * zone.penetration_factor);
            if (over > most.value) most = {over, zone.span.fibre_i, zone.span.fibre_j, false};
        }
        if constexpr (requires { contacts.tools(); })
            if (const auto deepest = contacts.tools().deepest(); deepest.depth > most.value * adaptation.allowed_penetration)
                most = {deepest.depth / adaptation.allowed_penetration, deepest.fibre, deepest.tool, true};
        return most;
    }
}

/// Stiffens every zone that is deeper than allowed, as after an increment. @returns whether any became stiffer
template <class Contacts>
bool stiffen_deep_zones(Contacts& contacts, const StiffnessAdaptation& adaptation) {
    bool any = false;
    if constexpr (!requires { contacts.normal_law().largest_penetration(); }) {
        for (Zone& zone : contacts.zones()) {
            const double depth = zone.forced ? 0.0 : detail::depth_of(contacts, zone);
            if (!(depth > adaptation.allowed_penetration * zone.penetration_factor)) continue;
            const double before = zone.stiffness;
            zone.stiffness = strictly_adapted_stiffness(adaptation, contacts.normal_law(), before, zone.reference, depth,
                                                        zone.penetration_factor);
            any = any || zone.stiffness > before;
        }
        if constexpr (requires { contacts.tools(); }) any = contacts.tools().stiffen(contacts.normal_law(), adaptation) || any;
    }
    return any;
}

}  // namespace fibrant::contact

// SPDX-License-Identifier: MIT
#pragma once
/// @file What all contact elements of a set come to.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/contact_element.hpp>
#include <fibrant/contact/contact_parameters.hpp>
#include <fibrant/contact/seen_touch.hpp>
#include <fibrant/core/parallel.hpp>

#include <algorithm>

namespace fibrant::contact {

/// Counts, depth, forces and work of contacts that have been evaluated at a state.
template <class Contacts, beam::BeamElement B>
ContactFigures figures(const Contacts& contacts, const beam::Mesh<B>& mesh, const Vector& state) {
    return core::ordered_sum(core::count(contacts.elements()), ContactFigures{}, [&](Index first, Index last) {
        ContactFigures sum;
        sum.elements = last - first;
        for (Index k = first; k < last; ++k) {
            const auto& element = contacts.elements()[core::at(k)];
            const ContactResponse& response = contacts.responses()[core::at(k)];
            if (response.reaction > 0.0) ++sum.active;
            if (element.shift.value() > 0.0) ++sum.shifted;
            sum.greatest_penetration = std::max(sum.greatest_penetration, -element.gap(state));
            sum.work += normal_energy(contacts.normal_law(), mesh, element, response.gap, contacts.stiffness(element));
            sum.reaction_sum += response.reaction;
            sum.dissipated += normal_loss(contacts.normal_law(), mesh, element, response.gap);
            if constexpr (requires { element.friction.bound; })
                sum.work += contacts.frictions()[core::at(k)].stored,
                    sum.dissipated += contacts.frictions()[core::at(k)].dissipated;
        }
        return sum;
    });
}

}  // namespace fibrant::contact

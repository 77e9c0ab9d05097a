// SPDX-License-Identifier: MIT
#pragma once
/// @file Audit of the state that a run has come to, which takes nothing from contact elements: the true least gap, and sections
/// right side out.

#include <fibrant/contact/bore.hpp>
#include <fibrant/observe/least_gap.hpp>
#include <fibrant/observe/swelling.hpp>
#include <fibrant/observe/tool_gap.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/acceptance.hpp>
#include <fibrant/simulation/model.hpp>
#include <fibrant/simulation/snapshot_of.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace fibrant::simulation {

/// True gaps of a state against what is allowed, whatever contact elements say.
struct Audit {
    observe::LeastGap least_gap;  ///< of any two fibres, and of a fibre and itself where contact is asked to see that
    contact::BoreGap bore_gap;    ///< of any fibre in a tube and the wall
    observe::ToolGap tool_gap;    ///< of any fibre and any tool, where the model has tools
    double allowed = 0.0;         ///< how deep those may be [length]
    std::optional<beam::InsideOut> inside_out;
    observe::Swelling swelling;  ///< of sections in turn from node to node, by which a pressed stack gives way

    /// No fibres deeper in each other, in a wall or in a tool than allowed, anywhere, and no section inside out.
    bool clean() const noexcept { return !inside_out && !(std::min({least_gap.gap, tool_gap.gap, bore_gap.gap}) < -allowed); }
};

/// How deep fibres may be in each other between contact points as well, by what the parameters state: the greatest penetration
/// that any pair of groups is allowed, and what contact points may leave unseen between two of them [length].
/// @param radius  of the thinnest fibre [length]
template <class Contacts>
double stated_depth(const Contacts& contacts, const contact::ContactParameters& parameters, double radius) {
    double allowed = parameters.stiffness.allowed_penetration, factor = 1.0;
    if constexpr (requires { contacts.normal_law().largest_penetration(); })
        allowed = contacts.normal_law().largest_penetration();
    for (const contact::Zone& zone : contacts.zones()) factor = std::max(factor, zone.penetration_factor / zone.narrowed);
    return factor * allowed + parameters.spacing.largest_unseen * radius;
}

namespace detail {
/// A state as curves of three-node elements, whatever its beam's elements are: those with other shapes in halves.
template <beam::BeamElement B>
observe::Snapshot curves_of(const beam::Mesh<B>& mesh, const Vector& state) {
    if constexpr (B::nodes == 3) {
        return snapshot_of(mesh, state);
    } else {
        observe::Snapshot shot;
        for (Index f = 0; f < mesh.fibre_count(); ++f) {
            observe::FibreSnapshot fibre;
            fibre.section = mesh.fibre(f).section;
            fibre.group = mesh.fibre(f).group, fibre.closed = mesh.fibre(f).closed, fibre.inside = mesh.fibre(f).inside;
            for (Index k = 0; k <= 4 * mesh.fibre(f).elements; ++k) {
                const double u = 0.25 * static_cast<double>(k);
                const auto [one, two] = mesh.directors(state, f, u);
                fibre.position.push_back(mesh.position(state, f, u));
                fibre.director_1.push_back(one), fibre.director_2.push_back(two);
            }
            shot.fibres.push_back(std::move(fibre));
        }
        return shot;
    }
}
}  // namespace detail

/// Audits the state that a simulator is in.
/// @param allowed  how deep fibres may be in each other anywhere [length]; unset: `stated_depth`
template <class Simulator>
Audit audit(const Simulator& simulator, double allowed = core::unset) {
    const contact::ContactParameters& parameters = simulator.parameters().contact;
    double radius = std::numeric_limits<double>::infinity();
    for (const beam::MeshFibre& fibre : simulator.mesh().fibres()) radius = std::min(radius, fibre.section.radius());
    Audit answer;
    answer.allowed = std::isnan(allowed) ? stated_depth(simulator.contacts(), parameters, radius) : allowed;
    answer.inside_out = beam::first_inside_out(simulator.mesh(), simulator.beam(), simulator.state());
    const observe::Snapshot shot = detail::curves_of(simulator.mesh(), simulator.state());
    answer.least_gap =
        observe::least_gap(shot, proximity::GridSearch{},
                           parameters.detection.self_contact ? observe::OwnTurns::counted : observe::OwnTurns::left_out);
    answer.bore_gap = contact::least_bore_gap(simulator.mesh(), simulator.state());
    if constexpr (Simulator::Beam::nodes == 3) answer.swelling = observe::greatest_swelling(shot);
    if constexpr (requires { simulator.contacts().tools(); })
        answer.tool_gap = observe::least_tool_gap(shot, simulator.contacts().tools());
    return answer;
}

}  // namespace fibrant::simulation

// SPDX-License-Identifier: MIT
#pragma once
/// @file The state of a simulation as plain data.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/contact/contact_set.hpp>
#include <fibrant/observe/snapshot.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fibrant::simulation {

/// Curve of a beam's centreline between its nodes.
template <beam::BeamElement Beam>
inline constexpr observe::Interpolation interpolation = Beam::nodes == 3 ? observe::Interpolation::quadratic : requires {
    Beam::centreline_bend_weights(0.0);
}
? observe::Interpolation::cubic : observe::Interpolation::linear;

/// Fibres at their nodes.
template <beam::BeamElement Beam>
observe::Snapshot snapshot_of(const beam::Mesh<Beam>& mesh, const Vector& state) {
    observe::Snapshot shot;
    shot.fibres.resize(core::at(mesh.fibre_count()));
    core::parallel_for(
        mesh.fibre_count(),
        [&](Index f) {
            observe::FibreSnapshot& fibre = shot.fibres[core::at(f)];
            fibre.interpolation = interpolation<Beam>;
            fibre.section = mesh.fibre(f).section;
            fibre.group = mesh.fibre(f).group, fibre.closed = mesh.fibre(f).closed, fibre.inside = mesh.fibre(f).inside;
            for (Index a = 0; a < mesh.node_count(f); ++a) {
                const double u = static_cast<double>(a) / static_cast<double>(Beam::nodes - 1);
                const Vec3 position = mesh.position(state, f, u);
                const Vec3 first = mesh.derivative(state, f, u), second = mesh.second_derivative(state, f, u);
                fibre.position.push_back(position);
                fibre.displacement.push_back(position - mesh.position(mesh.rest_state(), f, u));
                const auto [director_1, director_2] = mesh.directors(state, f, u);
                fibre.director_1.push_back(director_1);
                fibre.director_2.push_back(director_2);
                fibre.curvature.push_back(first.cross(second).norm() / std::pow(first.norm(), 3));
            }
        },
        mesh.grain());
    return shot;
}

/// Fibres, and contacts that have been evaluated at `state`.
template <beam::BeamElement Beam, class Search, class Normal, class Friction>
observe::Snapshot snapshot_of(const beam::Mesh<Beam>& mesh, const contact::ContactSet<Beam, Search, Normal, Friction>& contacts,
                              const Vector& state) {
    using Mesh = beam::Mesh<Beam>;
    observe::Snapshot shot = snapshot_of(mesh, state);
    shot.contacts.resize(contacts.elements().size());
    core::parallel_for(
        core::count(shot.contacts),
        [&](Index k) {
            const auto& element = contacts.elements()[core::at(k)];
            observe::ContactSnapshot& contact = shot.contacts[core::at(k)];
            contact.fibre_i = mesh.source(element.fibre_i), contact.fibre_j = mesh.source(element.fibre_j);
            contact.abscissa_i = element.u_i * mesh.fibre(element.fibre_i).element_length;
            contact.abscissa_j = element.u_j * mesh.fibre(element.fibre_j).element_length;
            contact.position = 0.5 * (Mesh::point(state, element.first_i, element.weights_i) +
                                      Mesh::point(state, element.first_j, element.weights_j));
            contact.normal = element.normal;
            contact.gap = element.gap(state);
            contact.reaction = contacts.responses()[core::at(k)].reaction;
            if constexpr (core::Active<Friction>) contact.friction = contacts.frictions()[core::at(k)].force;
            contact.stiffness = contacts.stiffness(element);
            contact.crossing = element.crossing;
        },
        core::light_items);
    return shot;
}

/// Contacts with tools that have been evaluated at `state`, as plain data.
template <beam::BeamElement Beam, class Tools>
void add_tools(observe::Snapshot& shot, const beam::Mesh<Beam>& mesh, const Tools& tools, const Vector& state) {
    for (Index k = 0; k < std::min(core::count(tools.elements()), core::count(tools.responses())); ++k) {
        const auto& element = tools.elements()[core::at(k)];
        observe::ToolContactSnapshot one;
        one.fibre = element.fibre, one.tool = element.tool;
        one.abscissa = element.u * mesh.fibre(element.fibre).element_length;
        one.position = element.foot, one.normal = element.normal, one.gap = element.gap(state);
        one.reaction = tools.responses()[core::at(k)].reaction;
        one.friction = tools.force(k) + one.reaction * element.normal;
        one.stiffness = tools.stiffness(element);
        shot.tool_contacts.push_back(one);
    }
}

/// Solids and bonds as plain data.
template <class Solid>
void add_solid(observe::Snapshot& shot, const Solid& solid, const Vector& state) {
    observe::SolidSnapshot& out = shot.solid;
    for (Index n = 0; n < solid.nodes(); ++n) {
        out.position.push_back(state.segment<3>(3 * (solid.first_vector() + n)));
        out.displacement.push_back(out.position.back() - solid.start(n));
    }
    for (Index c = 0; c < solid.cells(); ++c) {
        out.cells.push_back(solid.cell(c));
        const auto mean = solid.mean_state(state, c);
        out.strain.push_back(mean.strain), out.stress.push_back(mean.stress);
    }
    for (std::size_t b = 0; b < solid.bonds().size(); ++b)
        if (!solid.bonds()[b].section)
            out.bonds.push_back({state.segment<3>(3 * solid.bonds()[b].vector),
                                 solid.holds(b) ? solid.bond_force(state, b) : Vec3(Vec3::Zero()), solid.holds(b)});
}

}  // namespace fibrant::simulation

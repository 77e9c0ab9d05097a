// SPDX-License-Identifier: MIT
#pragma once
/// @file Contract of what ties fibre ends together, and the null model: scenes without bodies have no trace of them.

#include <fibrant/beam/mesh.hpp>
#include <fibrant/connection/channels.hpp>

#include <concepts>
#include <span>

namespace fibrant::connection {

/// Ties of a scene to bodies that move, of a model with a part `Connections`. Its coordinates are a function of the state: what
/// the tied vectors say of them.
///
/// - begin(amplitudes): sets what is prescribed; free coordinates start from the accepted ones.
/// - hold(layout, targets): adds single vectors that are tied to what is prescribed, and the held parts that they are to have,
/// and
///   sets what bends images.
/// - place(state, layout): free coordinates that suit the state, and from them the ties of the layout.
/// - add_closing(layout, step): the part of a step that ties prescribe.
/// - add_forces(layout, external): forces on free coordinates.
/// - see_images(layout, forces): forces of contact, before those on images are taken to where they act.
/// - hold_forces(layout, internal) and stiffen(layout, whole): what ties carry, and the stiffness that turning bodies make of it.
/// - accept(): coordinates as they stand.
template <class C, class B>
concept Connection = requires(C connection, const C& constant, std::span<const double> amplitudes, const Vector& state,
                              Vector& forces, scene::DofLayout& layout, std::vector<Vec3>& targets) {
    connection.begin(amplitudes);
    constant.hold(layout, targets);
    connection.place(state, layout);
    connection.accept();
    connection.hold_forces(layout, state);
    connection.see_images(layout, state);
    constant.add_closing(layout, forces);
    constant.add_forces(layout, forces);
    constant.stiffen(layout, true);
};

/// The part `Connections` of a model without one.
struct NoConnections : core::Inactive {
    using Parameters = core::NoParameters;
    explicit NoConnections(const Parameters& = {}) {}
    template <beam::BeamElement B>
    struct Of : core::Inactive {
        Of() = default;
        Of(const scene::Assembly&, const beam::Mesh<B>&, const Channels&) {}
        void begin(std::span<const double>) const noexcept {}
        void hold(scene::DofLayout&, std::vector<Vec3>&) const noexcept {}
        void place(const Vector&, scene::DofLayout&) const noexcept {}
        void accept() const noexcept {}
        void hold_forces(const scene::DofLayout&, const Vector&) const noexcept {}
        void see_images(const scene::DofLayout&, const Vector&) const noexcept {}
        void add_closing(const scene::DofLayout&, Vector&) const noexcept {}
        void add_forces(const scene::DofLayout&, Vector&) const noexcept {}
        void stiffen(scene::DofLayout&, bool) const noexcept {}
    };
};

}  // namespace fibrant::connection

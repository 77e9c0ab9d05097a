// SPDX-License-Identifier: MIT
#pragma once
/// @file What a beam element owes: energy, force and tangent, with stresses that Newton may treat as independent.

#include <fibrant/beam/centre_weights.hpp>
#include <fibrant/core/parameters.hpp>
#include <fibrant/core/types.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/scene/dof_layout.hpp>
#include <fibrant/scene/elastic_material.hpp>

#include <array>
#include <concepts>

namespace fibrant::beam {

/// Unknowns of one element, node by node, each node with its `vectors_per_node` 3-vectors (director beam: x_0 [length],
/// g_1, g_2 [1]); also the forces conjugate to them.
template <class B>
using ElementVector = Eigen::Matrix<double, B::nodes * B::dofs_per_node, 1>;

/// Symmetric, rows and columns as ElementVector.
template <class B>
using ElementMatrix = Eigen::Matrix<double, B::nodes * B::dofs_per_node, B::nodes * B::dofs_per_node>;

/// One scalar for each nodal 3-vector y_a of an element: a point of the fibre is x = sum of w_a y_a.
template <class B>
using ElementWeights = std::array<double, static_cast<std::size_t>(B::nodes* B::vectors_per_node)>;

/// A beam whose particles turn with rotations has a type for them: where they are in a state, and how they move.
template <class B>
concept TurningSections = requires(typename B::Particle particle, const ElementVector<B>& y) {
    { particle.place(y) } -> std::same_as<Vec3>;        // of the particle in a state
    particle.follow(y);                                 // its derivatives are those of this state from now on
    { particle.slope(Index{}) } -> std::same_as<Mat3>;  // derivative of the place by a nodal vector
};
/// Contact acts on the beam's centreline and leaves its sections alone, though it knows them: contact takes the radius off.
template <class B>
concept TouchedOnCentreline = requires(double xi) {
    { B::centre_weights(xi) } -> std::same_as<CentreWeights<B::nodes, B::vectors_per_node>>;
};
namespace detail {
template <class B>
struct ParticleOf {
    using Type = ElementWeights<B>;
};
template <TurningSections B>
struct ParticleOf<B> {
    using Type = typename B::Particle;
};
template <TouchedOnCentreline B>
struct ParticleOf<B> {
    using Type = CentreWeights<B::nodes, B::vectors_per_node>;
};
}  // namespace detail
/// What places a particle that touches: weights of the nodal vectors, unless its sections turn or are not touched.
template <class B>
using Particle = typename detail::ParticleOf<B>::Type;

/// The beam knows its centreline only: contact takes the radius off between centrelines, and needs no director.
template <class B>
concept CentrelineOnly = requires {
    requires B::centreline_particles;
};
/// Particles that touch are those of the centreline: a force has no lever.
template <class B>
concept CentreTouched = CentrelineOnly<B> || TouchedOnCentreline<B>;
/// Weights of the particle that is touched there, at xi in [-1, 1].
template <CentreTouched B>
constexpr auto touched_centre(double xi) noexcept {
    if constexpr (CentrelineOnly<B>)
        return B::centreline_weights(xi);
    else
        return B::centre_weights(xi);
}
/// Contact acts on the contours of sections that directors deform: particles are weighted sums of positions and directors.
template <class B>
concept DeformableSections = !CentrelineOnly<B> && !TurningSections<B> && !TouchedOnCentreline<B>;

/// Sections are circles at rest, and a mesh refuses others: what ovals need is not compiled.
template <class B>
concept RoundAtRest = requires {
    requires B::round_at_rest;
};
/// Contours that are no circles at rest may come.
template <class B>
concept OvalSections = DeformableSections<B> && !RoundAtRest<B>;

/// An element of a fibre: consecutive nodes, one shared by neighbours.
///
/// `Rest` is what an element keeps of its rest shape, section and material; `Stresses` are the conjugates of all its
/// strains at all its points, which Newton may treat as independent unknowns (mixed integration points). Owed beyond the
/// syntax, and checked by tests/beam/beam_element_contract.hpp: force and tangent are derivatives of the energy, a rigid
/// motion changes nothing, the rest shape is free of stress, the predicted stresses are the stresses to first order, and
/// what `without_compression` leaves makes the geometric stiffness positive semidefinite.
template <class B>
concept BeamElement = core::Policy<B> && requires {
    { B::nodes } -> std::convertible_to<int>;
    { B::vectors_per_node } -> std::convertible_to<int>;
    { B::dofs_per_node } -> std::convertible_to<int>;
    { B::reach } -> std::convertible_to<int>;
    { B::kinds[0] } -> std::convertible_to<scene::VectorKind>;
    typename B::Rest;
    typename B::Stresses;
} && requires(const B beam, const scene::CrossSection& section, const scene::ElasticMaterial& material,
              const typename B::Rest& rest, const ElementVector<B>& current, const ElementVector<B>& step,
              const typename B::Stresses& geometric, ElementVector<B>& force, ElementMatrix<B>& tangent) {
    { beam.rest(section, material, current) } -> std::same_as<typename B::Rest>;
    { beam.energy(rest, current) } -> std::same_as<double>;
    { beam.internal_force(rest, current) } -> std::same_as<ElementVector<B>>;
    { beam.tangent_stiffness(rest, current) } -> std::same_as<ElementMatrix<B>>;
    { beam.tangent_stiffness(rest, current, geometric) } -> std::same_as<ElementMatrix<B>>;
    beam.residual_and_tangent(rest, current, geometric, force, tangent);
    { beam.stresses(rest, current) } -> std::same_as<typename B::Stresses>;
    { beam.predicted_stresses(rest, current, step) } -> std::same_as<typename B::Stresses>;
    { B::without_compression(geometric) } -> std::same_as<typename B::Stresses>;
} && requires(double xi) {
    { B::shape(xi)[0] } -> std::convertible_to<double>;
    { B::shape_derivative(xi)[0] } -> std::convertible_to<double>;
    { B::centreline_weights(xi) } -> std::same_as<ElementWeights<B>>;
    { B::centreline_derivative_weights(xi) } -> std::same_as<ElementWeights<B>>;
    requires TouchedOnCentreline<B> || std::same_as<decltype(B::particle_weights(xi, xi, xi)), Particle<B>>;
};

/// A beam whose stresses may bend over: in an iteration its points have strains of their own, predicted by the step, around which
/// force and tangent are those of a linear law (mixed integration points, Magisano, Leonetti, Garcea 2017). The second order of a
/// turn, which is a stretch that the next iteration takes back, would make them yield else.
template <class B>
concept IteratedStrains = BeamElement<B> &&
    requires(const B beam, const typename B::Rest& rest, const ElementVector<B>& current, const typename B::Stresses& iterated) {
    { beam.internal_force(rest, current, iterated) } -> std::same_as<ElementVector<B>>;
};

}  // namespace fibrant::beam

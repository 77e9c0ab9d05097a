// SPDX-License-Identifier: MIT
#pragma once
/// @file A beam and the law of its section, by the names of both.

#include <fibrant/beam/director_beam_with.hpp>
#include <fibrant/beam/rigid_section_rod_with.hpp>

namespace fibrant::beam {

namespace detail {
template <class B, class M>
struct WithLaw;
template <BeamElement B>
struct WithLaw<B, Isotropic> {
    using Type = B;
};
template <int Nodes, DirectorBeamOptions Options, SectionMaterial M>
struct WithLaw<DirectorBeam<Nodes, Options>, M> {
    using Type = DirectorBeamWith<M, Nodes, Options>;
};
template <SectionMaterial M>
struct WithLaw<RigidSectionRod, M> {
    using Type = RigidSectionRodWith<M>;
};
}  // namespace detail

/// `With<DirectorBeam<3>, material::Wire>`: the beam B whose section obeys the law M. With `Isotropic` it is B itself, to the bit
/// and the byte.
template <class B, class M>
using With = typename detail::WithLaw<B, M>::Type;

}  // namespace fibrant::beam

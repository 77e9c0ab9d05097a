// SPDX-License-Identifier: MIT
#pragma once
/// @file What the accuracy benchmarks share: compositions by element and laws, the rod that is loaded, and the clock.

#include "../timing.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <numbers>
#include <vector>

namespace fibrant::benchmarks {

template <beam::BeamElement B, law::FrictionLaw Law = law::Frictionless>
struct Policy {
    using Beam = B;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = Law;
    using Solver = solver::SparseCholesky;
};

inline const double r = 0.0201, young = 7300.0, area = std::numbers::pi * r * r, bending = 0.25 * young * area * r * r;

inline scene::FibreSpecification along_z(double length, Index elements) {
    return {.from = Vec3::Zero(),
            .to = Vec3(0, 0, length),
            .section = scene::circular(r),
            .material = {young, 0.3},
            .elements = elements,
            .director = Vec3::UnitX()};
}
/// Clamped at one end, under an end force P L^2 / EI = 5 across it.
inline scene::Assembly cantilever(double slenderness, Index elements) {
    const double length = slenderness * r;
    scene::Assembly assembly;
    assembly.add(along_z(length, elements));
    assembly.clamp(scene::first_end(0));
    assembly.apply(
        scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(5.0 * bending / (length * length), 0, 0), "load"});
    return assembly;
}
template <simulation::Model M>
simulation::ModelParameters<M> parameters() {
    simulation::ModelParameters<M> all;
    all.normal.regularisation_depth = 1e-3 * r;
    all.contact.stiffness.allowed_penetration = 1e-2 * r;
    all.iteration.step_tolerance = 1e-8, all.iteration.residual_tolerance = 1e-8, all.iteration.linear_tolerance = 1e-9;
    all.iteration.newton_limit = 40;
    if constexpr (core::Active<typename M::Friction>)
        all.friction = {.friction_coefficient = 0.15, .reversible_displacement = 0.02 * r};
    return all;
}

}  // namespace fibrant::benchmarks

// SPDX-License-Identifier: MIT
#pragma once
/// @file Models of fibres whose sections have a law, and what their balance of energies misses.

#include "simulation/scenes.hpp"

#include <fibrant/beam/with_law.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace fibrant::test {

template <class Material>
struct Lawful {
    using Beam = beam::With<beam::DirectorBeam<3>, Material>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
template <class M>
simulation::ModelParameters<M> lawful_parameters(double radius, std::vector<typename M::Beam::Material::Parameters> laws) {
    auto parameters = test::tight_parameters<M>(radius);
    parameters.beam.laws = std::move(laws);
    return parameters;
}
/// The error of the energy balance over the work done.
inline double missing(const simulation::Report& report) {
    return std::abs(report.energy.error()) / std::max(std::abs(report.energy.external), report.energy.elastic);
}

}  // namespace fibrant::test

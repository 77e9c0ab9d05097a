// SPDX-License-Identifier: MIT
// Two crossing fibres, clamped at their ends, are pressed together: prints the force against the approach.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/observe/loading_curve.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/simulation/audit.hpp>
#include <fibrant/simulation/simulator.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <cstdio>

using namespace fibrant;

#ifdef CROSSING_COMPILED  // the same model, compiled once in fibrant::compiled
#include <fibrant/compiled/rough_fibres.hpp>
using Crossing = compiled::RoughFibres;
#else
struct Crossing {
    using Beam = beam::RoundDirectorBeam<3>;  // nothing of oval sections is compiled
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::SparseCholesky;
};
static_assert(simulation::Model<Crossing>);
#endif

int main() {
    const double radius = 0.0201, approach = 0.01;  // lengths in mm, forces in N
    const scene::CrossSection section = scene::circular(radius);
    const scene::ElasticMaterial material{.young_modulus = 7300.0, .poisson_ratio = 0.3};
    const double height = 2.0 * radius;

    scene::Assembly assembly;
    const Index lower =
        assembly.add({.from = {0, -0.5, 0}, .to = {0, 0.5, 0}, .section = section, .material = material, .elements = 16});
    const Index upper = assembly.add(
        {.from = {-0.5, 0, height}, .to = {0.5, 0, height}, .section = section, .material = material, .elements = 16});
    assembly.clamp(scene::first_end(lower));
    assembly.clamp(scene::last_end(lower));
    assembly.clamp(scene::first_end(upper), {0, 0, -approach});
    assembly.clamp(scene::last_end(upper), {0, 0, -approach});

    simulation::ModelParameters<Crossing> parameters;
    parameters.normal.regularisation_depth = 1e-3 * radius;
    parameters.friction = {.friction_coefficient = 0.15, .reversible_displacement = 0.02 * radius};
    parameters.contact.stiffness.allowed_penetration = 1e-2 * radius;

    observe::LoadingCurve curve;
    simulation::Simulator<Crossing> simulator(assembly, parameters);
    const simulation::Report report = simulator.run({.increments = 10}, curve);
    for (const auto& [progress, force] : curve.points()) std::printf("%.4f mm  %.3e N\n", progress * approach, force);
    if (!report.converged) std::printf("stopped: %s\n", report.reason.c_str());
    const simulation::Audit audit = simulation::audit(simulator);
    if (!audit.clean())
        std::printf("fibres %td and %td are %.2e mm deep in each other\n", audit.least_gap.fibre_i, audit.least_gap.fibre_j,
                    -audit.least_gap.gap);
    return report.converged && audit.clean() ? 0 : 1;
}

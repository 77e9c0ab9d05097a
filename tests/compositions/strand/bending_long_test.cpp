// SPDX-License-Identifier: MIT
// Strands with friction, bent to 90 degrees: what holds for any of them.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/bending.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/float_block_cholesky.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace bending_long_test {

namespace strand = compositions::strand;

struct Rough {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solver = solver::DoubleBlockCholesky;
};

struct Bent {
    simulation::Report report;
    strand::BendingState state;
    strand::StrandParameters parameters;
};

Bent bend(Index wires, double mu, double angle) {
    const double r = 1.0;
    Bent bent;
    bent.parameters = strand::regular_strand(wires, r, 12.0, true);
    bent.parameters.length = 100.0 * r;
    bent.parameters.elements = 20;
    bent.parameters.material = {200000.0, 0.3};
    simulation::ModelParameters<Rough> model;
    model.normal.regularisation_depth = 1e-3 * r;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.02 * r};
    model.contact.stiffness.allowed_penetration = 1e-2 * r;
    model.iteration.margin = 4.0, model.iteration.largest_margin = 8.0;  // ends swing far
    simulation::Simulator<Rough> simulator(strand::bent_strand(bent.parameters), model);
    simulation::Stage<Rough> stage;
    stage.ramps = {{strand::bend, angle}};
    stage.increments = 45, stage.most_increments = 900;
    simulation::Loading<Rough> loading;
    loading.stages = {stage};
    bent.report = simulator.run(loading);
    bent.state = strand::measure_bending(simulator, bent.parameters);
    return bent;
}

TEST_CASE("a strand with friction bends to 90 degrees, between its wires' own stiffness and that of a solid") {
    const double angle = 0.5 * std::numbers::pi;
    for (const Index wires : {7, 19}) {
        const Bent smooth = bend(wires, 0.0, angle), rough = bend(wires, 0.1, angle);
        for (const Bent* bent : {&smooth, &rough}) {
            CAPTURE(bent->report.reason);
            REQUIRE(bent->report.converged);
            const double loose = strand::loose_stiffness(bent->parameters) * angle / bent->parameters.length;
            const double solid = strand::solid_stiffness(bent->parameters) * angle / bent->parameters.length;
            std::printf("%td wires: moment %.4e, %.3f of loose wires, %.4f of a solid; dissipated %.3e of %.3e, energy %.1e missing; %td increments, %td rejected, %td iterations, %.1f s\n",
                        wires, bent->state.moment, bent->state.moment / loose, bent->state.moment / solid, bent->report.energy.dissipated,
                        bent->report.energy.external, bent->report.energy.error(), core::count(bent->report.increments), bent->report.rejected_increments,
                        bent->report.counts.newton, bent->report.wall_seconds);
            CHECK(bent->state.angle == doctest::Approx(angle));
            CHECK(bent->state.moment > 0.8 * loose);  // wires at a lay bend a little more easily than straight ones
            CHECK(bent->state.moment < solid);
            CHECK(bent->report.contact.greatest_penetration < 0.02);
            double last = 0.0;
            for (const simulation::IncrementReport& increment : bent->report.increments) {
                CHECK(increment.energy.dissipated >= last);
                last = increment.energy.dissipated;
            }
            CHECK(std::abs(bent->report.energy.error()) < 0.05 * bent->report.energy.external);
        }
        CHECK(rough.state.moment > smooth.state.moment);
        CHECK(smooth.report.energy.dissipated == 0.0);
        CHECK(rough.report.energy.dissipated > 0.0);
    }
}

}  // namespace bending_long_test

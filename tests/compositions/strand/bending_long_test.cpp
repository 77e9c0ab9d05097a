// SPDX-License-Identifier: MIT
// Strands with friction, bent to 90 degrees: what holds for any of them.
#include <compositions/strand/bent_strand.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace bending_long_test {

namespace strand = compositions::strand;

using Rough = test::Bundle;

struct Bent {
    simulation::Report report;
    std::vector<strand::BendingState> states;  ///< after each increment
    strand::StrandParameters parameters;
    double furthest = 0.0;  ///< from its layer

    double over_loose(std::size_t k) const {
        return states[k].moment / (strand::loose_stiffness(parameters) * states[k].angle / parameters.length);
    }
};

/// To 90 degrees in thirty increments.
Bent bend(const strand::StrandParameters& parameters, const strand::Bending& bending, double mu) {
    const double r = 1.0;
    Bent bent;
    bent.parameters = parameters;
    bent.parameters.material = {200000.0, 0.3};
    auto model = test::direct_parameters<Rough>(test::bundle_solver);
    model.normal.regularisation_depth = 1e-2 * r;
    model.friction = {.friction_coefficient = mu, .reversible_displacement = 0.1 * r};
    model.contact.stiffness.allowed_penetration = 2e-2 * r;
    model.iteration.newton_limit = 30;
    model.iteration.margin = 1.0;
    simulation::Simulator<Rough> simulator(strand::bent_strand(bent.parameters, bending), model);
    struct Follow {
        const simulation::Simulator<Rough>& simulator;
        const strand::Bending& bending;
        Bent& bent;
        void accepted(const observe::Snapshot&) {
            bent.states.push_back(strand::measure_bending(simulator, bent.parameters, bending));
        }
    } follow{simulator, bending, bent};
    simulation::Stage<Rough> stage;
    stage.ramps = {{strand::bend, 0.5 * std::numbers::pi}};
    stage.increments = 30, stage.most_increments = 600;
    simulation::Loading<Rough> loading;
    loading.stages = {stage};
    bent.report = simulator.run(loading, follow);
    bent.furthest = strand::furthest_from_layer(simulator, bent.parameters) / r;
    REQUIRE_MESSAGE(bent.report.converged, bent.report.reason);
    std::printf(
        "%td wires, friction %.1f: moment %.4f, %.4f, %.4f of loose wires at 3, 45, 90 degrees, %.4f at the plate alone; wires "
        "%.2f r off their layers; dissipated %.3e of %.3e, energy %.1e missing; "
        "%td increments, %td rejected, %td iterations, %.1f s\n",
        parameters.wires(), mu, bent.over_loose(0), bent.over_loose(14), bent.over_loose(29),
        bent.states[29].at_plate / bent.states[29].moment * bent.over_loose(29), bent.furthest, bent.report.energy.dissipated,
        bent.report.energy.external, bent.report.energy.error(), core::count(bent.report.increments),
        bent.report.rejected_increments, bent.report.counts.newton, bent.report.wall_seconds);
    return bent;
}

/// What holds for any strand, with friction and without.
void check(const Bent& smooth, const Bent& rough, double near_loose) {
    for (const Bent* bent : {&smooth, &rough}) {
        const double solid = strand::solid_stiffness(bent->parameters) / strand::loose_stiffness(bent->parameters);
        REQUIRE(bent->states.size() == 30);  // none was cut
        CHECK(bent->states.back().angle == test::near(0.5 * std::numbers::pi, 1e-5));
        for (std::size_t k = 0; k < 30; ++k) CHECK(bent->over_loose(k) < solid);
        // Nothing presses wires together but bending itself: they are springs side by side, and hundredths come from where they
        // touch.
        for (std::size_t k = 0; k < 30; ++k) CHECK(std::abs(bent->over_loose(k) - 1.0) < near_loose);
        CHECK(std::abs(test::work_of(bent->states) / bent->report.energy.external - 1.0) < 2e-3);  // of thirty increments
        CHECK(bent->report.contact.greatest_penetration < 0.03);
        double last = 0.0;
        for (const simulation::IncrementReport& increment : bent->report.increments) {
            CHECK(increment.energy.dissipated >= last);
            last = increment.energy.dissipated;
        }
        CHECK(std::abs(bent->report.energy.error()) < 2e-3 * bent->report.energy.external);
    }
    CHECK(smooth.report.energy.dissipated == 0.0);
    CHECK(rough.report.energy.dissipated > 0.0);
    // Friction takes work, at every angle, and the moment is work.
    for (std::size_t k = 0; k < 30; ++k) CHECK(rough.states[k].moment > smooth.states[k].moment);
    CHECK(rough.report.energy.external > smooth.report.energy.external + 0.9 * rough.report.energy.dissipated);
}

TEST_CASE("a strand of wires that both plates hold bends to 90 degrees, and friction adds to the moment") {
    for (const Index wires : {7, 19}) {
        strand::StrandParameters parameters = strand::regular_strand(wires, 1.0, 17.4, true, strand::Lay::equal_pitch);
        parameters.length = parameters.pitch(parameters.layers.size() - 1), parameters.elements = 16;
        const Bent smooth = bend(parameters, {}, 0.0), rough = bend(parameters, {}, 0.1);
        check(smooth, rough, 0.03);
    }
}

TEST_CASE("where wires slide through a plate friction adds to the moment, too, but not to what that plate feels") {
    strand::StrandParameters parameters = strand::regular_strand(19, 1.0, 12.0, true);
    parameters.length = 100.0, parameters.elements = 20;
    const strand::Bending bending{.anchor = strand::Anchor::near_plate};
    const Bent smooth = bend(parameters, bending, 0.0), rough = bend(parameters, bending, 0.1);
    check(smooth, rough, 0.04);
    // The moment there is that of wires which no longer bend, with a force across them that does the rest of the work.
    CHECK(smooth.states[29].at_plate < 0.97 * smooth.states[29].moment);
    CHECK(rough.states[29].at_plate < smooth.states[29].at_plate);
}

}  // namespace bending_long_test

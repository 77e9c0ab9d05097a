// SPDX-License-Identifier: MIT
// What a run says of itself at its end.
#include "simulation/scenes.hpp"

#include <fibrant/solver/automatic_solver.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace report_test {

using test::Crossing;
using test::Smooth;

struct Choosing : Smooth {
    using Solver = solver::AutomaticSolver;
};

template <simulation::Model M>
simulation::Report pressed(const simulation::ModelParameters<M>& parameters) {
    simulation::Simulator<M> simulator(Crossing{}.assembly(), parameters);
    simulation::Loading<M> loading;
    loading.increments = 4;
    return simulator.run(loading);
}

TEST_CASE(
    "a run with a solver that chooses says which strategies it used and why it left one, and finds what a direct solver finds") {
    simulation::ModelParameters<Choosing> parameters = test::model_parameters<Choosing>(Crossing{}.radius);
    parameters.solver.few_couplings = 0.0, parameters.solver.two_level_limit = 1;  // one iteration is never enough here
    const simulation::Report chosen = pressed<Choosing>(parameters),
                             direct = pressed<Smooth>(test::model_parameters<Smooth>(Crossing{}.radius));
    REQUIRE(chosen.converged);
    REQUIRE(direct.converged);
    CAPTURE(chosen.solver);
    CHECK(chosen.solver.starts_with("automatic: solves by "));
    CHECK(chosen.solver.find("FloatBlockCholesky") != std::string::npos);
    CHECK(chosen.solver.find("the last: TwoLevelPcg reached a residual of ") != std::string::npos);
    CHECK(direct.solver.empty());
    // Both balance forces to 1e-4.
    CHECK(chosen.contact.reaction_sum == test::near(direct.contact.reaction_sum, 1e-3));
    CHECK(direct.contact.reaction_sum > 0.0);
}

}  // namespace report_test

// SPDX-License-Identifier: MIT
// A repeating cell of plain weave, settled and stretched along both families: its stress found in two ways, and its stiffness.
#include "periodic_cell.hpp"

#include <fibrant/compositions/weave/measures.hpp>
#include <fibrant/compositions/weave/periodic.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/simulation/programme.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <string>

using namespace fibrant;

namespace periodic_long_test {

using namespace fibrant::compositions::weave;

TEST_CASE("the stress of a stretched cell is the same from the ties of its seams and from the forces in fibres and contacts") {
    const FabricParameters fabric = cell_fabric();
    const SettleParameters settle;
    const double r = smallest_radius(fabric);
    const std::string file = "periodic_long_test_checkpoint.bin";
    double crimp_before = 0.0;
    {
        simulation::Simulator<Cell> simulator(periodic_fabric(fabric, CellDrive::tension, settle.tension_strain),
                                              model_parameters<Cell>(fabric, settle));
        auto loading = settling<Cell>(fabric, settle);
        loading.checkpoint = file;
        const simulation::Report report = simulator.run(loading);
        crimp_before = crimp_measures(simulator.snapshot(), fabric).warp;
        const Mat3 gradient = simulator.equilibrium().ties().motion().gradient(0);
        std::printf("settled: %td increments, %td iterations, %.1f s, crimp %.5f, the cell drew in by %.5f and %.5f %s\n",
                    core::count(report.increments), report.counts.newton, report.wall_seconds, crimp_before, -gradient(0, 0),
                    -gradient(1, 1), report.reason.c_str());
        REQUIRE(report.converged);
        CHECK(report.contact.greatest_penetration < 0.02 * r);
    }
    auto parameters = model_parameters<Cell>(fabric, settle);
    parameters.iteration.residual_tolerance = 1e-8, parameters.iteration.step_tolerance = 1e-6,
    parameters.iteration.linear_tolerance = 1e-8;
    // Normals turn once more after the last solution: what that changes has to be as little as what the solution left.
    parameters.iteration.normal_step_tolerance = 1e-6, parameters.iteration.normal_limit = 40, parameters.iteration.inexact = 0.0;
    simulation::Simulator<Cell> simulator(periodic_fabric(fabric, CellDrive::strain, settle.tension_strain), parameters);
    simulator.start_from(file);
    std::remove(file.c_str());
    simulation::LoadProgramme programme;
    programme.stages = {{.name = "stretch",
                         .increments = 10,
                         .ramps = {{"strain_x", 0.01}, {"strain_y", 0.01}},
                         .friction = settle.friction_coefficient,
                         .looseness = 1.0}};
    programme.reversible_displacement = 0.02 * r;
    struct Curve {
        const simulation::Simulator<Cell>& simulator;
        const FabricParameters& fabric;
        std::vector<std::pair<double, double>> points{};
        void reported(const simulation::IncrementReport& increment) {
            const auto& ties = simulator.equilibrium().ties();
            const double strain = ties.motion().gradient(0)(0, 0),
                         force = ties.cell_force(0)(0, 0) / fabric.fibre_length(Family::warp) / 2.0;
            points.emplace_back(strain, force);
            std::printf("strain %.5f force per tow %.5f, of E A strain %.4f; %td iterations, residual %.1e\n", strain, force,
                        force / (fabric.warp.axial_stiffness() * strain), increment.counts.newton, increment.residual);
        }
    } curve{simulator, fabric};
    const simulation::Report report = simulator.run(simulation::loading_of<Cell>(programme), curve);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const Mat3 seams = simulator.equilibrium().ties().cell_force(0), inside = virial(simulator);
    std::printf("stress from seams, and from inside:\n");
    for (int i = 0; i < 3; ++i)
        std::printf("  %12.8f %12.8f %12.8f   %12.8f %12.8f %12.8f\n", seams(i, 0), seams(i, 1), seams(i, 2), inside(i, 0),
                    inside(i, 1), inside(i, 2));
    std::printf("crimp %.5f\n", crimp_measures(simulator.snapshot(), fabric).warp);
    // Nothing but the seams holds the cell, so that shear agrees as well; passes stop when nothing moves by 1e-6 of a radius.
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) CHECK(std::abs(seams(i, j) - inside(i, j)) < 1e-6 * seams(0, 0));
    CHECK(seams(0, 0) == test::near(seams(1, 1), 0.1));  // warp and weft are alike but for their fibres' places
    CHECK(crimp_measures(simulator.snapshot(), fabric).warp < crimp_before);
    const double bound = fabric.warp.axial_stiffness();
    for (std::size_t k = 1; k < curve.points.size(); ++k) {
        const double slope =
            (curve.points[k].second - curve.points[k - 1].second) / (curve.points[k].first - curve.points[k - 1].first);
        CHECK(slope > 0.0);
        CHECK(slope < bound);
    }
}

}  // namespace periodic_long_test

// SPDX-License-Identifier: MIT
// Pieces of one fabric, periodic and finite, out of the state of one cell: how the force of a tow depends on how many there are.
#include "periodic_cell.hpp"

#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/compositions/weave/repeated.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/simulation/programme.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

using namespace fibrant;

namespace repeated_cell_long_test {

using namespace fibrant::compositions::weave;

using Mesh = beam::Mesh<Cell::Beam>;

constexpr double strain = 0.006;  // of the settled period
const std::string settled_file = "repeated_cell_settled.bin", file = "repeated_cell_started.bin";

Mesh mesh_of(const FabricParameters& fabric) {
    scene::Assembly fibres;
    add_flat_fibres(fibres, fabric);
    return Mesh(fibres, Cell::Beam(Cell::Beam::Parameters{}));
}

simulation::LoadProgramme stretch(const std::vector<simulation::Ramp>& ramps, double r) {
    simulation::LoadProgramme programme;
    programme.stages = {{.name = "stretch",
                         .increments = 12,
                         .ramps = ramps,
                         .friction = SettleParameters{}.friction_coefficient,
                         .looseness = 5.0}};
    programme.reversible_displacement = 0.02 * r;
    return programme;
}

simulation::ModelParameters<Cell> parameters(const FabricParameters& fabric) {
    auto answer = model_parameters<Cell>(fabric, SettleParameters{});
    answer.iteration.residual_tolerance = 1e-5, answer.iteration.overshoot = 0.5;
    return answer;
}

/// Force of a tow of a periodic piece of `repeats` cells each way [force].
double periodic_force(Index repeats) {
    const FabricParameters fabric = repeated(cell_fabric(), repeats);
    simulation::Simulator<Cell> simulator(periodic_fabric(fabric, CellDrive::strain, 0.002), parameters(fabric));
    simulator.start_from(file);
    const observe::Snapshot shot = simulator.snapshot();
    const double period = shot.fibres[0].position.back().x() - shot.fibres[0].position.front().x(),
                 length = fabric.fibre_length(Family::warp);
    const double gradient = strain * period / length;  // that of a cell counts over the fibres at rest
    const auto report = simulator.run(
        simulation::loading_of<Cell>(stretch({{"strain_x", gradient}, {"strain_y", gradient}}, smallest_radius(fabric))));
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double force = simulator.equilibrium().ties().cell_force(0)(0, 0) / length / static_cast<double>(fabric.warp_tows);
    std::printf("periodic, %td tows: %.4f a tow; %td iterations, %.1f s\n", fabric.warp_tows, force, report.counts.newton,
                report.wall_seconds);
    return force;
}

/// The same of a finite piece, every fibre end held at its place in its tow end, tow ends moving apart.
double finite_force(Index repeats) {
    const FabricParameters fabric = repeated(cell_fabric(), repeats);
    const Mesh mesh = mesh_of(fabric);
    const LoadCase load = load_case("equibiaxial", simulation::snapshot_of(mesh, simulation::checkpoint_state(file, mesh)),
                                    fabric, TowEnds::fibres);
    simulation::Simulator<Cell> simulator(load.assembly, parameters(fabric));
    simulator.start_from(file);
    const auto report = simulator.run(simulation::loading_of<Cell>(stretch({{strain_channel, strain}}, smallest_radius(fabric))));
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const auto& ties = simulator.equilibrium().ties();
    const Index west = load.bodies.of(Edge::west), east = load.bodies.of(Edge::east);
    CHECK((ties.motion().position(east) - ties.motion().position(west)).x() == test::near((1.0 + strain) * load.width, 1e-12));
    const double force = 0.5 * (ties.wrench(east).force - ties.wrench(west).force).x() / static_cast<double>(fabric.warp_tows);
    std::printf("finite,   %td tows: %.4f a tow; %td iterations, %.1f s\n", fabric.warp_tows, force, report.counts.newton,
                report.wall_seconds);
    return force;
}

TEST_CASE("finite samples come near to periodic ones of the same fabric, the nearer the more tows they have") {
    const FabricParameters cell = cell_fabric();
    {
        simulation::Simulator<Cell> simulator(periodic_fabric(cell, CellDrive::tension, 0.002), model_parameters<Cell>(cell, {}));
        auto loading = settling<Cell>(cell, SettleParameters{});
        loading.checkpoint = settled_file;
        REQUIRE(simulator.run(loading).converged);
    }
    const Mesh cell_mesh = mesh_of(cell);
    const auto stored = simulation::read_state<Cell>(settled_file, cell_mesh);
    std::vector<double> periodic, finite;
    for (const Index repeats : {1, 2, 3, 4}) {
        const Mesh mesh = mesh_of(repeated(cell, repeats));
        const auto larger = repeated<Cell>(stored, cell, cell_mesh, mesh, repeats);
        CHECK(larger.records.size() == core::at(repeats * repeats) * stored.records.size());
        simulation::write_state<Cell>(file, mesh, larger);
        if (repeats == 1) {
            CHECK(larger.state == stored.state);
        } else {
            // Neighbours are alike: the same length and the same rise of every cell of a fibre.
            const observe::Snapshot small = simulation::snapshot_of(cell_mesh, stored.state),
                                    large = simulation::snapshot_of(mesh, larger.state);
            const Vec3 chord = small.fibres[0].position.back() - small.fibres[0].position.front();
            CHECK((large.fibres[0].position.back() - large.fibres[0].position.front() - static_cast<double>(repeats) * chord)
                      .norm() < 1e-12);
            CHECK((large.fibres[0].position[16] - large.fibres[0].position[0] - chord).norm() < 1e-12);
        }
        periodic.push_back(periodic_force(repeats));
        finite.push_back(finite_force(repeats));
    }
    std::remove(settled_file.c_str()), std::remove(file.c_str());
    // The more cells there are, the more ways fibres have to give way; the more tows, the less their ends do.
    for (std::size_t k = 0; k < periodic.size(); ++k) {
        CHECK(finite[k] < periodic[k]);
        if (k == 0) continue;
        CHECK(periodic[k] < periodic[k - 1]);
        CHECK(finite[k] > finite[k - 1]);
    }
    CHECK(periodic[2] - finite[2] < 0.6 * (periodic[0] - finite[0]));
    CHECK(finite[2] > 0.96 * periodic[2]);
    CHECK(finite[3] > 0.97 * periodic[3]);  // what is missing goes about as one over the number of tows
}

}  // namespace repeated_cell_long_test

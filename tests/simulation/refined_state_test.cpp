// SPDX-License-Identifier: MIT
// A state whose elements are cut is the same state: no particle has moved, and contacts go on with what they hold.
#include "refusal.hpp"
#include "simulation/scenes.hpp"

#include <fibrant/simulation/refined_state.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>

using namespace fibrant;

namespace refined_state_test {

using test::Crossing;
using test::Rough;
using Mesh = beam::Mesh<Rough::Beam>;

/// Force that the supports of the lower fibre exert.
Vec3 held(const simulation::Simulator<Rough>& simulator, const Crossing& crossing) {
    return simulator.reaction({crossing.lower(), 0.0}) + simulator.reaction({crossing.lower(), 1.0});
}

/// Where a particle of a fibre is, by its abscissa over the length.
Vec3 place(const Mesh& mesh, const Vector& state, Index f, double share, double xi1, double xi2) {
    const auto [e, xi] = mesh.locate(f, share * static_cast<double>(mesh.fibre(f).elements));
    return Mesh::point(state, mesh.first_unknown(f, e), Rough::Beam::particle_weights(xi, xi1, xi2));
}

TEST_CASE("two fibres that are pressed and dragged go on on a finer mesh with the forces that they had") {
    Crossing crossing;
    crossing.approach = 0.8 * crossing.radius, crossing.drag = 0.05 * crossing.radius;  // friction holds still
    Crossing finer = crossing;
    finer.elements = 2 * crossing.elements;
    const auto parameters = test::tight_parameters<Rough>(crossing.radius);
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_refined_state_test.bin").string();
    simulation::Loading<Rough> loading;
    loading.stages = {{.name = "press", .increments = 3, .ramps = {{"approach", 1.0}}},
                      {.name = "drag", .increments = 2, .ramps = {{"drag", 1.0}}}};
    loading.checkpoint = file;
    simulation::Simulator<Rough> simulator(crossing.assembly(), parameters);
    REQUIRE(simulator.run(loading).converged);
    const Vec3 before = held(simulator, crossing);
    REQUIRE(std::abs(before.x()) > 0.05 * std::abs(before.z()));

    const Mesh mesh(crossing.assembly(), Rough::Beam(parameters.beam)), cut(finer.assembly(), Rough::Beam(parameters.beam));
    const auto stored = simulation::refined(simulation::read_state<Rough>(file, mesh), mesh, cut, 2);
    for (Index f = 0; f < 2; ++f)
        for (const double share : {0.0, 0.11, 0.37, 0.5, 0.83, 1.0})
            for (const double xi : {0.0, 0.7})
                CHECK((place(mesh, simulator.state(), f, share, xi, -xi) - place(cut, stored.state, f, share, xi, -xi)).norm() <
                      1e-15 * crossing.length);
    simulation::write_state<Rough>(file, cut, stored);

    // Supports stay where they are. Halves of elements give way more by what the whole ones left out, a thousandth; contact and
    // friction go on from what they held, where fibres that begin anew would have no friction at all.
    simulation::Simulator<Rough> again(finer.assembly(), parameters);
    again.start_from(file);
    simulation::Loading<Rough> rest;
    rest.stages = {{.name = "rest", .increments = 1, .ramps = {{"approach", 1.0}, {"drag", 1.0}}}};
    REQUIRE(again.run(rest).converged);
    const Vec3 after = held(again, crossing);
    CHECK((after - before).norm() < 2e-3 * before.norm());
    CHECK(std::abs(after.x() - before.x()) < 2e-3 * std::abs(before.x()));
    std::remove(file.c_str());
}

TEST_CASE("a mesh that is not a refinement is refused") {
    Crossing crossing, other;
    other.elements = crossing.elements + 1;
    const auto parameters = test::model_parameters<Rough>(crossing.radius);
    const Mesh mesh(crossing.assembly(), Rough::Beam(parameters.beam)), finer(other.assembly(), Rough::Beam(parameters.beam));
    const simulation::StoredState<Rough> stored{.state = mesh.rest_state()};
    CHECK(test::refusal([&] { simulation::refined(stored, mesh, finer, 2); }).starts_with("refined.finer.fibre(0).elements = 9"));
    CHECK(test::refusal([&] { simulation::refined(stored, mesh, mesh, 0); }).starts_with("refined.parts = 0"));
    CHECK(simulation::refined(stored, mesh, mesh, 1).state == stored.state);
}

}  // namespace refined_state_test

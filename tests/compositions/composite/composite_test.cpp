// SPDX-License-Identifier: MIT
// A strip of fibres and matrix bent between its edges, with bonds that hold and bonds that break.
#include <fibrant/compositions/composite/composite.hpp>

#include "../../refusal.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/connection/bonded_solid.hpp>
#include <fibrant/law/regularised_coulomb.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/solid_pcg.hpp>

#include <doctest/doctest.h>

#include <cstdio>
#include <filesystem>
#include <unistd.h>

using namespace fibrant;
namespace composite = compositions::composite;

namespace {

struct Model {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::RegularisedCoulomb;
    using Solid = connection::BondedSolid<solid::Hexahedron<solid::EnhancedStrains, solid::NeoHookean>, connection::DebondsAtTraction>;
    using Solver = solver::SolidPcg;
};
static_assert(simulation::Model<Model> && simulation::HasSolid<Model>);
using Simulator = simulation::Simulator<Model>;

constexpr double radius = 0.04, length = 4.0, width = 0.4, matrix_modulus = 50.0, fibre_modulus = 5000.0;

composite::LoadParameters bend() {
    composite::LoadParameters load;
    load.angle_deg = 30.0;
    return load;
}

/// Three fibres along x in a layer from z = -0.02 to 0.1.
composite::Composite strip() {
    composite::Composite strip;
    std::vector<std::vector<solid::SectionPlace>> sections;
    std::tie(strip.west, strip.east) = composite::edge_motions(bend(), length, width);
    for (const double y : {-0.12, 0.0, 0.12}) {
        scene::FibreSpecification one;
        one.from = Vec3(-0.5 * length, y, 0), one.to = Vec3(0.5 * length, y, 0);
        one.section = scene::circular(radius), one.material = {fibre_modulus, 0.0}, one.elements = 10, one.director = Vec3::UnitZ();
        const Index f = strip.assembly.add(one);
        sections.push_back({{one.from, radius * Vec3::UnitY(), radius * Vec3::UnitZ()}, {one.to, radius * Vec3::UnitY(), radius * Vec3::UnitZ()}});
        for (const bool east : {false, true}) {
            const composite::EdgeMotion& edge = east ? strip.east : strip.west;
            scene::Hold hold;
            hold.at = east ? scene::last_end(f) : scene::first_end(f), hold.channel = composite::load_channel;
            hold.rotation = edge.rotation, hold.path = edge.path, hold.pivot = edge.pivot;
            strip.assembly.hold(hold);
            hold.path = {}, hold.axes = scene::Axes::section;  // the sections too: moments enter the fibres
            hold.vector = scene::NodeVector::director_1, hold.directions = Vec3(0, 1, 1).asDiagonal();
            strip.assembly.hold(hold);
            hold.vector = scene::NodeVector::director_2, hold.directions = Vec3(1, 0, 1).asDiagonal();
            strip.assembly.hold(hold);
            if (east) strip.east_ends.push_back(hold.at);
        }
    }
    solid::LayerParameters layer;
    layer.low = {-0.5 * length, -0.5 * width}, layer.high = {0.5 * length, 0.5 * width}, layer.cells = {20, 4};
    layer.upper_face = 0.1, layer.penetration_depth = 0.06, layer.least_thickness = 0.05, layer.smoothing = 0;
    layer.sides = solid::Sides::upper, layer.through = 1, layer.material = {matrix_modulus, 0.0};
    const solid::Layers layers = solid::mesh_layers(solid::FibreSurface(sections), layer);
    const solid::Layer& upper = layers.list.front();
    strip.assembly.add(upper.solid);
    for (const bool east : {false, true}) {
        scene::SolidHold hold;
        const composite::EdgeMotion& edge = east ? strip.east : strip.west;
        hold.channel = composite::load_channel, hold.rotation = edge.rotation, hold.path = edge.path, hold.pivot = edge.pivot;
        for (Index k = 0; k <= 1; ++k)
            for (Index j = 0; j <= 4; ++j) hold.nodes.push_back(upper.node(east ? 20 : 0, j, k));
        if (east) strip.east_nodes = hold.nodes;
        strip.assembly.hold(hold);
    }
    return strip;
}

simulation::ModelParameters<Model> parameters(double strength) {
    simulation::ModelParameters<Model> p;
    p.normal.regularisation_depth = 1e-3 * radius;
    p.friction = {.friction_coefficient = 0.15, .reversible_displacement = 1e-3 * radius};
    p.contact.stiffness.allowed_penetration = 1e-2 * radius;
    p.iteration.margin = 1.0, p.iteration.largest_margin = 20.0;
    p.solid.debonding.strength = strength;
    return p;
}

}  // namespace

TEST_CASE("edges move as rigid bodies: on an arc when bent, nearer when twisted") {
    composite::LoadParameters load;
    for (const auto kind : {composite::LoadCase::bending, composite::LoadCase::twisting, composite::LoadCase::tension, composite::LoadCase::shear}) {
        load.load = kind, load.angle_deg = 90.0, load.strain = 0.02;
        const auto [west, east] = composite::edge_motions(load, 3.0, 2.0);
        for (const double a : {0.0, 1e-6, 0.5, 1.0}) {
            const Mat3 turn = east.rotation(a) * west.rotation(a).transpose();
            const bool turns = kind == composite::LoadCase::bending || kind == composite::LoadCase::twisting;
            CHECK(core::rotation_vector(turn).norm() == doctest::Approx(turns ? a * std::acos(0.0) : 0.0).epsilon(1e-9));
            const Vec3 span = east.centre(a) - west.centre(a);
            const double half = 0.5 * a * std::acos(0.0), chord = half > 0.0 ? std::sin(half) / half : 1.0;
            if (kind == composite::LoadCase::bending) CHECK(span.norm() == doctest::Approx(3.0 * chord).epsilon(1e-9));
            if (kind == composite::LoadCase::bending) CHECK((west.rotation(a) * Vec3::UnitX() + east.rotation(a) * Vec3::UnitX()).z() == doctest::Approx(0.0));
            if (kind == composite::LoadCase::twisting) CHECK(span.x() == doctest::Approx(3.0 * (1.0 - std::pow(2.0 * 2.0 * half / 3.0, 2) / 24.0)));
            if (kind == composite::LoadCase::tension) CHECK(span.x() == doctest::Approx(3.0 * (1.0 + 0.02 * a)));
            if (kind == composite::LoadCase::shear) CHECK(span.y() == doctest::Approx(3.0 * 0.02 * a));
        }
    }
}

TEST_CASE("a bonded strip takes the moment of both parts, its energy balances, and bonds that break let it go") {
    const composite::Composite scene = strip();
    const std::string checkpoint = (std::filesystem::temp_directory_path() / ("fibrant_composite_" + std::to_string(::getpid()))).string();
    simulation::Loading<Model> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{composite::load_channel, 1.0}};
    loading.stages[0].increments = 4;
    Simulator held(scene.assembly, parameters(1e6));
    REQUIRE(held.equilibrium().solid().bonds().size() == 63);
    const auto report = held.run(loading);
    REQUIRE_MESSAGE(report.converged, report.reason);
    // Sections stay plane about z = 0, whose length is kept: E b (z_2^3 - z_1^3) / 3 of the layer, and E I of the fibres.
    const double curvature = bend().angle_deg * std::acos(-1.0) / 180.0 / length;
    const double matrix = matrix_modulus * width * (std::pow(0.1, 3) + std::pow(0.02, 3)) / 3.0;
    const double fibres = 3.0 * fibre_modulus * std::acos(-1.0) / 4.0 * std::pow(radius, 4);
    const simulation::Wrench wrench = composite::edge_wrench(held, scene);
    // Beyond the inner face between the fibres, which hangs from their own, strains of 1.3 % stiffen by as much.
    CHECK(wrench.moment.y() == doctest::Approx(curvature * (matrix + fibres)).epsilon(0.02));
    CHECK(std::abs(wrench.moment.x()) + std::abs(wrench.moment.z()) <= 1e-3 * wrench.moment.y());
    // The work is summed by the trapezoidal rule, over steps in which forces turn by 1/15: that squared, over 12.
    CHECK(std::abs(report.energy.error()) <= 2e-3 * report.energy.elastic);
    CHECK(report.energy.external == doctest::Approx(0.5 * curvature * curvature * length * (matrix + fibres)).epsilon(0.03));

    loading.checkpoint = checkpoint;
    Simulator broken(scene.assembly, parameters(1e-9));
    const auto after = broken.run(loading);
    REQUIRE_MESSAGE(after.converged, after.reason);
    Index left = 0;
    for (std::size_t b = 0; b < 63; ++b) left += broken.equilibrium().solid().holds(b) ? 1 : 0;
    CHECK(left <= 6);  // at the ends, where fibre and solid move as one
    CHECK(after.energy.released > 0.0);
    // An increment's work begins with the forces from before the bonds broke.
    CHECK(std::abs(after.energy.error()) <= 1e-2 * after.energy.elastic);
    loading.resume = true;
    Simulator again(scene.assembly, parameters(1e-9));
    REQUIRE(again.run(loading).converged);
    CHECK(again.state() == broken.state());
    CHECK(again.equilibrium().solid().broken() == broken.equilibrium().solid().broken());
    std::remove(checkpoint.c_str());
}

TEST_CASE("a run goes on from where another left the same fibres, and not from elsewhere") {
    composite::Composite scene = strip();
    Simulator first(scene.assembly, parameters(1e6));
    simulation::Loading<Model> loading;
    loading.stages.resize(1);
    loading.stages[0].ramps = {{composite::load_channel, 0.1}};
    loading.stages[0].increments = 1;
    REQUIRE(first.run(loading).converged);
    scene::Assembly next = scene.assembly;
    Vector state = first.state().head(first.mesh().layout().unknowns());
    next.begin_at(state);
    Simulator second(next, parameters(1e6));
    CHECK(second.state().head(state.size()) == state);
    state[0] += 1e-3;
    next.begin_at(state);
    CHECK(test::refusal([&] { Simulator(next, parameters(1e6)).go_on_from(first); }).starts_with("Simulator.state"));
    next.begin_at(Vector::Zero(5));
    CHECK(test::refusal([&] { Simulator(next, parameters(1e6)); }).starts_with("Assembly.start = 5 numbers"));
}

// SPDX-License-Identifier: MIT
// Connections without a run: bonds of fibres with each other and with solids, poses of bodies, images in a plate.
#include <near.hpp>
#include <support/bonded_scene.hpp>
#include <term/term_contract.hpp>

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/connection/body_motion.hpp>
#include <fibrant/connection/bonding.hpp>
#include <fibrant/connection/carriers.hpp>
#include <fibrant/connection/fibre_bonds.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <numbers>
#include <vector>

using namespace fibrant;

namespace unmoved_test {

using Beam = beam::DirectorBeam<3>;
using Cable = beam::KirchhoffCable;
using connection::FibreBonds;
using test::block;
using test::cuts;

TEST_CASE("the moment of a bond is about its own middle, and a checkpoint has what has broken") {
    scene::Assembly assembly;
    for (const double y : {0.0, 0.3}) {
        scene::FibreSpecification one;
        one.from = {5, y, 0}, one.to = {7, y, 0}, one.section = scene::circular(0.01), one.material = {1000.0, 0.3},
        one.elements = 4;
        assembly.add(one);
    }
    const double k = 0.7, span = 0.2, angle = 1e-4;
    FibreBonds::Parameters parameters{{{.i = {0, 0.5}, .j = {1, 0.5}, .stiffness = k, .span = span, .moment_strength = 1.0},
                                       {.i = {0, 0.2}, .j = {1, 0.2}, .stiffness = k, .strength = 1e-9}}};
    test::TermScene<Cable, FibreBonds> scene(assembly, parameters);
    Vector state = scene.mesh.rest_state();
    for (Index node = 0; node < scene.mesh.node_count(1); ++node) {
        const Index place = 3 * scene.mesh.node_vector(1, node, 0), slope = 3 * scene.mesh.node_vector(1, node, 1);
        state[place + 1] += angle * (state[place] - 6.0), state[slope + 1] += angle * state[slope];
    }
    // Of the four springs the two along the bond are stretched by half of the span times the angle, and have that lever.
    CHECK(scene.term.use(0, state) == test::near(0.5 * k * span * span * angle, 1e-3));
    scene.term.accept(state);
    REQUIRE(scene.term.broken(1));
    test::TermScene<Cable, FibreBonds> again(assembly, parameters);
    test::copy_numbers(scene.term, again.term);
    CHECK(again.term.broken(1));
    CHECK_FALSE(again.term.broken(0));
    CHECK(again.term.dissipated(state) == scene.term.dissipated(state));
    CHECK(scene.term.dissipated(state) > 0.0);
    scene.term.accept(state);
    CHECK(scene.term.dissipated(state) == 0.0);  // told once
}

TEST_CASE("bonds have the fibre's surface and volume, and what they carry follows a uniform gradient beyond the block") {
    const std::vector<scene::Solid> solids{block(cuts(0, 2, 4), cuts(-0.5, 0.5, 2), cuts(-0.5, 0.5, 2), {100.0, 0.25})};
    Mat3 gradient;
    gradient << 0.05, 0.02, 0.0, -0.01, -0.03, 0.01, 0.02, 0.0, 0.04;
    scene::Assembly assembly;
    scene::FibreSpecification one;
    one.from = Vec3(0, 0.1, 0.2), one.to = Vec3(2, 0.1, 0.2);
    one.section = scene::circular(0.01), one.material = {1e4, 0.3}, one.elements = 5;
    assembly.add(one);
    const beam::Mesh<Beam> inside(assembly, Beam());
    double surface = 0.0, volume = 0.0;
    for (const connection::Bond& bond : connection::find_bonds(inside, solids, inside.start_state(), 1.0))
        surface += bond.surface, volume += bond.fibre_volume;
    CHECK(surface == test::near(2.0 * std::numbers::pi * 0.01 * 2.0));
    CHECK(volume == test::near(std::numbers::pi * 1e-4 * 2.0));
    // Sections in a cell that is half full are held as those of a dilute suspension, over what is left for the matrix.
    const scene::ElasticMaterial matrix{100.0, 0.25};
    CHECK(connection::section_stiffness(1.0, matrix, 3.0, 0.5) ==
          test::near(2.0 * connection::section_stiffness(1.0, matrix, 3.0, 0.0)));
    one.from = Vec3(-1.0, -0.3, 0.3), one.to = Vec3(2.5, 0.2, -0.1);
    assembly.add(one);
    const beam::Mesh<Beam> mesh(assembly, Beam());
    const Vector& state = mesh.start_state();
    const auto bonds = connection::find_bonds(mesh, solids, state, 1.0);
    const auto carriers = connection::find_carriers(mesh, solids, bonds, state);
    for (Index v = 0; v < mesh.layout().vectors(); ++v) {
        const connection::Carrier& carrier = carriers[core::at(v)];
        REQUIRE(carrier.cell >= 0);
        Vec3 sum = Vec3::Zero();
        for (std::size_t k = 0; k < 8; ++k)
            sum += carrier.weights[static_cast<Index>(k)] *
                   (gradient * solids[0].nodes[core::at(solids[0].cells[core::at(carrier.cell)][k])]);
        CHECK((sum - gradient * state.segment<3>(3 * v)).norm() < 1e-12);
    }
}

TEST_CASE("images in a cell that bends move as its plate does") {
    const Vec3 bends(0.3, -0.2, 0.5), place(0.7, -0.4, 0.1), period(1.1, 0.6, 0.0), director(0.2, 0.9, -0.3);
    const auto tilt = [&](const Vec3& x) {  // (w,y, -w,x, 0)
        return Vec3(bends[1] * x.y() + bends[2] * x.x(), -(bends[0] * x.x() + bends[2] * x.y()), 0.0);
    };
    const auto moved = [&](const Vec3& x) {
        const double w = 0.5 * bends[0] * x.x() * x.x() + 0.5 * bends[1] * x.y() * x.y() + bends[2] * x.x() * x.y();
        return Vec3(x.z() * tilt(x).y(), -x.z() * tilt(x).x(), w);
    };
    CHECK((connection::bend_jump(place, period, false) * bends - (moved(place + period) - moved(place))).norm() < 1e-14);
    CHECK((connection::bend_jump(director, period, true) * bends - (tilt(place + period) - tilt(place)).cross(director)).norm() <
          1e-14);
}

TEST_CASE("free turns go through a checkpoint, and a body turns by what it hangs on, too") {
    scene::Assembly assembly;
    scene::RigidBody base, arm;
    base.rotation[0] = scene::Coordinate::held_at(0.7, "turn");
    arm.parent = assembly.add(base);
    arm.rotation[0] = scene::Coordinate::loose(), arm.rotation[1] = scene::Coordinate::held_at(-0.5, "turn");
    const Index body = assembly.add(arm);
    const connection::Channels channels(assembly);
    connection::BodyMotion motion(assembly, channels), again = motion;
    const std::vector<double> none{0.0}, whole{1.0};
    CHECK(motion.greatest_turn(none, whole).first == test::near(1.2));
    CHECK(motion.greatest_turn(none, whole).second == body);
    motion.begin(whole);
    motion.move(0.3 * Vector::Ones(1));
    motion.accept();
    std::vector<double> kept;
    motion.each_accepted([&](const auto& value) { kept.insert(kept.end(), value.data(), value.data() + value.size()); });
    auto next = kept.begin();
    again.each_accepted([&](auto& value) {
        std::copy_n(next, value.size(), value.data());
        next += value.size();
    });
    again.restore();
    CHECK((again.frame(body) - motion.frame(body)).norm() < 1e-15);
    CHECK((core::rotation(Vec3(0.7, 0, 0)) * core::rotation(Vec3(0.3, 0, 0)) * core::rotation(Vec3(0, -0.5, 0)) -
           motion.frame(body))
              .norm() < 1e-12);
}

}  // namespace unmoved_test

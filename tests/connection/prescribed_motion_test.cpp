// SPDX-License-Identifier: MIT
#include "../support/random_vector.hpp"
#include "refusal.hpp"

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/connection/prescribed_motion.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <numbers>
#include <random>

using namespace fibrant;

namespace prescribed_motion_test {

using test::refusal;
using Beam = beam::DirectorBeam<3>;

constexpr double rounding = 1e-14;

/// A fibre along x with g_1 = y, g_2 = z, and what its holds come to.
struct Scene {
    scene::Assembly assembly;
    Index fibre;
    std::vector<scene::HeldVector> held;
    std::vector<Vec3> target;

    Scene() {
        scene::FibreSpecification f;
        f.from = Vec3(1, 0, 0), f.to = Vec3(3, 0, 0);
        f.section = scene::circular(0.1);
        f.material = {1000.0, 0.3};
        f.elements = 2;
        f.director = Vec3::UnitY();
        fibre = assembly.add(f);
    }
    void hold(const Vec3& direction, const Vec3& displacement, scene::NodeVector vector = scene::NodeVector::position) {
        scene::Hold condition;
        condition.at = scene::last_end(fibre);
        condition.vector = vector;
        condition.directions = direction.normalized() * direction.normalized().transpose();
        condition.displacement = displacement;
        assembly.hold(condition);
    }
    void evaluate(double amplitude) {
        const connection::Channels channels(assembly);
        const Beam beam;
        const beam::Mesh<Beam> mesh(assembly, beam);
        const connection::PrescribedMotion<Beam> motion(assembly, mesh, channels);
        const std::vector<double> amplitudes(channels.names().size(), amplitude);
        motion.at(amplitudes, mesh.rest_state(), held, target);
    }
    /// Is it a symmetric projector of that rank?
    static bool projector(const Mat3& free, int rank) {
        return (free - free.transpose()).norm() < rounding && (free * free - free).norm() < rounding &&
               std::abs(free.trace() - rank) < rounding;
    }
};

TEST_CASE("holds of one vector in any directions leave a projector of what is free, and all of them are met") {
    Scene scene;
    scene.hold(Vec3(1, 0, 0), Vec3(0.3, 5, 5));
    scene.hold(Vec3(1, 1, 0), Vec3(-0.2, 0.4, 7));  // neither along the first nor across it
    scene.evaluate(0.5);
    REQUIRE(scene.held.size() == 1);
    CHECK(Scene::projector(scene.held[0].free, 1));
    CHECK((scene.held[0].free * Vec3::UnitZ() - Vec3::UnitZ()).norm() < rounding);
    const Vec3& target = scene.target[0];
    CHECK(target.x() == test::near(3.0 + 0.15, 1e-12));
    CHECK(Vec3(1, 1, 0).dot(target) == test::near(Vec3(1, 1, 0).dot(Vec3(3.0 - 0.1, 0.2, 0)), 1e-12));
    CHECK(std::abs(target.z()) < rounding);  // free: no part of the target
}

TEST_CASE("where two holds want different things in one direction, the one added first decides") {
    for (const bool swapped : {false, true}) {
        Scene scene;
        scene.hold(swapped ? Vec3(0, 1, 0) : Vec3(1, 0, 0), Vec3(0.1, 0.1, 0));
        scene::Hold all;
        all.at = scene::last_end(scene.fibre);
        all.displacement = Vec3(0.7, 0.7, 0.7);
        scene.assembly.hold(all);
        scene.evaluate(1.0);
        REQUIRE(scene.held.size() == 1);
        CHECK(Scene::projector(scene.held[0].free, 0));
        CHECK((scene.target[0] - (Vec3(3, 0, 0) + (swapped ? Vec3(0.7, 0.1, 0.7) : Vec3(0.1, 0.7, 0.7)))).norm() < rounding);
    }
}

TEST_CASE("a clamp that turns takes the held directions of its directors along, and only stretches stay free") {
    Scene scene;
    const Vec3 pivot(1, 0, 0), turn(0, 0, 0.5 * std::numbers::pi);
    scene.assembly.clamp(scene::last_end(scene.fibre), Vec3(0, 0, 0.5), turn, pivot);
    for (const double amplitude : {0.0, 0.3, 1.0}) {
        scene.evaluate(amplitude);
        REQUIRE(scene.held.size() == 3);
        const Mat3 rotation(Eigen::AngleAxisd(amplitude * turn.norm(), Vec3::UnitZ()));
        CHECK((scene.target[0] - (pivot + rotation * Vec3(2, 0, 0) + amplitude * Vec3(0, 0, 0.5))).norm() < rounding);
        CHECK(Scene::projector(scene.held[0].free, 0));
        for (const int k : {1, 2}) {
            const Vec3 director = rotation * (k == 1 ? Vec3(0, 1, 0) : Vec3(0, 0, 1));
            CHECK(Scene::projector(scene.held[core::at(k)].free, 1));
            CHECK((scene.held[core::at(k)].free * director - director).norm() < rounding);
            CHECK(scene.target[core::at(k)].norm() < rounding);  // the rest director lies in the free direction
        }
    }
}

TEST_CASE("holding the axial rotation holds what turns a section about the fibre and nothing that bends or stretches it") {
    Scene scene;
    scene.assembly.hold_axial_rotation(scene::first_end(scene.fibre));
    scene.evaluate(1.0);
    REQUIRE(scene.held.size() == 2);
    for (const scene::HeldVector& held : scene.held) CHECK(Scene::projector(held.free, 2));
    const Mat3 &free_1 = scene.held[0].free, &free_2 = scene.held[1].free;
    CHECK((free_1 * Vec3::UnitZ()).norm() < rounding);  // g_1 = y would turn towards z
    CHECK((free_2 * Vec3::UnitY()).norm() < rounding);
    CHECK((free_1 * Vec3::UnitX() - Vec3::UnitX()).norm() < rounding);
    CHECK((free_1 * Vec3::UnitY() - Vec3::UnitY()).norm() < rounding);
}

TEST_CASE("a path is followed where motion is not proportional to the amplitude") {
    Scene scene;
    scene::Hold condition;
    condition.at = scene::first_end(scene.fibre);
    condition.path = [](double a) { return Vec3(0, std::sin(a), a * a); };
    scene.assembly.hold(condition);
    scene.evaluate(0.4);
    CHECK((scene.target[0] - Vec3(1, std::sin(0.4), 0.16)).norm() < rounding);
}

TEST_CASE("held vectors are sorted and appear once, however many holds there are and in any order") {
    Scene scene;
    scene.assembly.clamp(scene::last_end(scene.fibre));
    scene.assembly.hold_position({scene.fibre, 0.5});
    scene.assembly.hold_axial_rotation(scene::first_end(scene.fibre));
    scene.hold(Vec3(1, 1, 1), Vec3::Zero());
    scene.evaluate(1.0);
    REQUIRE(scene.held.size() == 6);
    for (std::size_t k = 1; k < scene.held.size(); ++k) CHECK(scene.held[k - 1].vector < scene.held[k].vector);
    CHECK(scene.held[2].vector == 6);  // the middle of five nodes, its position
}

TEST_CASE("what a slanting hold leaves of a whole one goes where the whole one asks, not along with it") {
    // A clamp of an end that is stretched along a slanting fibre: its path across the fibre must not depend on the axes of space.
    const Vec3 along = Vec3(3, 4, 0) / 5.0, across(-0.8, 0.6, 0.0);
    Scene scene;
    scene.hold(along, 0.7 * along);
    scene.assembly.prescribe(scene::last_end(scene.fibre), Vec3(0, 0, 0.2));
    scene.evaluate(1.0);
    const Vec3 moved = scene.target[0] - Vec3(3, 0, 0);
    CHECK(Scene::projector(scene.held[0].free, 0));
    CHECK(moved.dot(along) == test::near(0.7, rounding));
    CHECK(std::abs(moved.dot(across)) < rounding);
    CHECK(moved.z() == test::near(0.2, rounding));
}

TEST_CASE("random holds give projectors, and targets that lie in the held directions") {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int trial = 0; trial < 50; ++trial) {
        Scene scene;
        for (int k = 0; k < 4; ++k) scene.hold(test::random_vector(any, random), Vec3(any(random), any(random), 0));
        scene.evaluate(any(random));
        CHECK(Scene::projector(scene.held[0].free, 0));
        CHECK((scene.held[0].free * scene.target[0]).norm() < rounding);
    }
}

TEST_CASE("a channel that no condition uses is refused, with the names of those that are") {
    Scene scene;
    scene.assembly.prescribe(scene::first_end(scene.fibre), Vec3::UnitX(), "pull");
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), {}, Vec3::UnitX(), "load"});
    const connection::Channels channels(scene.assembly);
    CHECK(channels.names() == std::vector<std::string>{"load", "pull"});
    CHECK(channels.find("load") == 0);
    CHECK(channels.find("pull") == 1);
    CHECK(refusal([&] { channels.find("pul"); }) == "channel = pul, but it must be one that the scene uses (load, pull)");
}

TEST_CASE("a rod's section that is held about its tangent does not spin about it from wherever it stands") {
    using Rod = beam::RigidSectionRod;
    Scene scene;
    scene.assembly.hold_axial_rotation(scene::last_end(scene.fibre));
    const connection::Channels channels(scene.assembly);
    const beam::Mesh<Rod> mesh(scene.assembly, Rod());
    const connection::PrescribedMotion<Rod> motion(scene.assembly, mesh, channels);
    Vector state = mesh.rest_state();
    const Index vector = mesh.node_vector(scene.fibre, mesh.node_count(scene.fibre) - 1, 1);
    state.segment<3>(3 * vector) += Vec3(0.3, -0.5, 0.2);
    motion.at(std::vector<double>(channels.names().size(), 0.0), state, scene.held, scene.target);
    REQUIRE(scene.held.size() == 1);
    CHECK(scene.held[0].vector == vector);
    CHECK(Scene::projector(scene.held[0].free, 2));
    // A step of the rotation vector is the spin T step; free steps have none along x.
    const Mat3 T = core::spin_matrix(state.segment<3>(3 * vector));
    CHECK((Vec3::UnitX().transpose() * T * scene.held[0].free).norm() < 1e-12);
}

TEST_CASE("how far a section is turned counts whole turns") {
    Scene scene;
    scene::Hold condition;
    condition.at = scene::first_end(scene.fibre), condition.vector = scene::NodeVector::director_1;
    condition.rotation = [](double a) { return core::rotation(Vec3(0, 0, 5.0 * std::numbers::pi * a)); };
    scene.assembly.hold(condition);
    const connection::Channels channels(scene.assembly);
    const beam::Mesh<Beam> mesh(scene.assembly, Beam());
    const connection::PrescribedMotion<Beam> motion(scene.assembly, mesh, channels);
    const auto [turn, vector] = motion.greatest_turn(std::vector<double>{0.2}, std::vector<double>{1.0});
    CHECK(turn == test::near(4.0 * std::numbers::pi, 1e-9));
    CHECK(vector == mesh.node_vector(scene.fibre, 0, 1));
}

}  // namespace prescribed_motion_test

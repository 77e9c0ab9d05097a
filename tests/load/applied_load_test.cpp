// SPDX-License-Identifier: MIT
// Loads as terms: their contract, their resultants and what they are to nodes.
#include "load_scene.hpp"

#include <term/term_contract.hpp>

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/load.hpp>
#include <fibrant/load/applied_load.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace applied_load_test {

using Beam = beam::DirectorBeam<3>;
using scene::NodeVector;
using test::fibre;
using Cable = beam::KirchhoffCable;

/// One element along z with its loads.
struct Loaded {
    scene::Assembly assembly;
    Index fibre;
    Loaded() {
        scene::FibreSpecification f;
        f.from = Vec3::Zero(), f.to = Vec3(0, 0, 1);
        f.section = scene::circular(0.1);
        f.material = {1000.0, 0.3};
        f.elements = 1;
        f.director = Vec3::UnitX();
        fibre = assembly.add(f);
    }
    template <class Use>
    void with(const Use& use) const {
        const scene::Channels channels(assembly);
        const Beam beam;
        const beam::Mesh<Beam> mesh(assembly, beam);
        load::AppliedLoad<Beam> load(assembly, mesh, channels);
        load.begin(std::vector<double>(channels.names().size(), 1.0), mesh.rest_state());
        use(load, mesh, channels);
    }
    Vector forces(double amplitude, const Vector& state) const {
        Vector sum = Vector::Zero(state.size());
        with([&](auto& load, const auto&, const auto& channels) {
            load.begin(std::vector<double>(channels.names().size(), amplitude), state);
            load.add_forces(state, sum);
        });
        return sum;
    }
    Vector rest() const {
        Vector state;
        with([&](const auto&, const auto& mesh, const auto&) { state = mesh.rest_state(); });
        return state;
    }
};

constexpr Index last = 2 * 9;  // first unknown of the last node

TEST_CASE("a dead force keeps its direction and size, and grows with its channel only") {
    Loaded scene;
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), NodeVector::position, Vec3(1, 2, 3), "load"});
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), NodeVector::position, Vec3(0, 0, 1), "pull"});
    const Vector rest = scene.rest();
    const Vector random = rest + 0.1 * Vector::LinSpaced(rest.size(), -1.0, 1.0);
    CHECK(scene.forces(0.5, rest) == scene.forces(0.5, random));
    CHECK(scene.forces(0.5, rest).segment<3>(last) == Vec3(0.5, 1.0, 2.0));
    CHECK(scene.forces(1.0, rest).norm() == Vec3(1, 2, 4).norm());
    scene.with([&](auto& load, const auto&, const auto& channels) {
        Vector sum = Vector::Zero(rest.size());
        std::vector<double> amplitudes{0.0, 0.0};
        amplitudes[core::at(channels.find("pull"))] = 2.0;
        load.begin(amplitudes, rest);
        load.add_forces(rest, sum);
        CHECK(sum.segment<3>(last) == Vec3(0, 0, 2));
    });
}

TEST_CASE("a force at a material point off the axis is a force on the position and one on the director") {
    // Virtual work of Q at x_0 + r g_1: Q . dx_0 + r Q . dg_1.
    Loaded scene;
    const Vec3 Q(0.3, -0.2, 0.7);
    const double r = 0.1;
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), NodeVector::position, Q, "load"});
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), NodeVector::director_1, r * Q, "load"});
    const Vector rest = scene.rest();
    const Vector force = scene.forces(1.0, rest);
    const Vector step = Vector::LinSpaced(rest.size(), 0.3, -0.8);
    const Vec3 particle = step.segment<3>(last) + r * step.segment<3>(last + 3);
    CHECK(force.dot(step) == test::near(Q.dot(particle), 1e-14));
}

TEST_CASE("a moment does the work of a moment in a rotation, whatever the length of its director") {
    Loaded scene;
    const Vec3 M(0, 0.7, 0);
    scene.assembly.apply(scene::Moment{scene::last_end(scene.fibre), NodeVector::director_1, M, "load"});
    Vector state = scene.rest();
    for (const double stretch : {1.0, 0.9, 1.2}) {
        for (const double angle : {0.0, 0.4, 2.0}) {
            const Vec3 director = stretch * (Eigen::AngleAxisd(angle, Vec3::UnitY()) * Vec3::UnitX());
            state.segment<3>(last + 3) = director;
            const Vec3 force = scene.forces(1.0, state).segment<3>(last + 3);
            CHECK((director.cross(force) - M).norm() < 1e-14);
            CHECK(std::abs(director.dot(force)) < 1e-15);  // it does not stretch the section
        }
    }
}

TEST_CASE("the stiffness of a moment is minus the derivative of its force, made symmetric") {
    Loaded scene;
    const Vec3 M(0, 0.7, 0);
    scene.assembly.apply(scene::Moment{scene::last_end(scene.fibre), NodeVector::director_1, M, "load"});
    Vector state = scene.rest();
    state.segment<3>(last + 3) = Vec3(0.8, 0.0, -0.7);
    Mat3 differences;
    const double h = 1e-5;  // the error of central differences is of the order of h^2
    for (int k = 0; k < 3; ++k) {
        Vector ahead = state, behind = state;
        ahead[last + 3 + k] += h, behind[last + 3 + k] -= h;
        differences.col(k) = (scene.forces(1.0, behind) - scene.forces(1.0, ahead)).segment<3>(last + 3) / (2.0 * h);
    }
    int calls = 0;
    scene.with([&](const auto& load, const auto& mesh, const auto&) {
        struct {
            std::vector<std::pair<Index, Mat3>> seen;
            void add_diagonal(Index vector, const Mat3& stiffness) { seen.emplace_back(vector, stiffness); }
            void add_element(Index, Index, const double*) {}
        } sink;
        term::Bands bands(sink);
        load.add_bands(state, bands);
        for (const auto& [vector, stiffness] : sink.seen) {
            ++calls;
            CHECK(vector == mesh.node_vector(scene.fibre, 2, 1));
            CHECK((stiffness - 0.5 * (differences + differences.transpose())).norm() < 1e-9);
        }
    });
    CHECK(calls == 1);
    // In the plane in which the director turns the derivative is symmetric by itself: nothing is lost there.
    Mat3 plane = Mat3::Identity();
    plane(1, 1) = 0.0;
    const Mat3 inside = plane * differences * plane;
    CHECK((inside - inside.transpose()).norm() < 1e-9);
}

TEST_CASE("a line pressure has the resultant of its chord across its axis, and moment by where the fibre lies") {
    Loaded scene;
    const Vec3 axis = Vec3(1, 2, 2) / 3.0, from(0.3, -0.2, 0.5), chord(0.1, 0.4, 0.9);
    scene.assembly.apply(scene::LinePressure{.fibre = scene.fibre, .pressure = 0.7, .axis = axis});
    Vector state = scene.rest();
    for (Index node = 0; node < 3; ++node) state.segment<3>(9 * node) = from + 0.5 * static_cast<double>(node) * chord;
    const Vector force = scene.forces(1.0, state);
    Vec3 sum = Vec3::Zero();
    double work = 0.0;
    for (Index node = 0; node < 3; ++node)
        sum += force.segment<3>(9 * node), work += force.segment<3>(9 * node).dot(state.segment<3>(9 * node));
    CHECK((sum - 0.7 * axis.cross(chord)).norm() < 1e-14);
    // x . (axis x d) is the same at all places x of a straight fibre with the chord d.
    CHECK(work == test::near(0.7 * from.dot(axis.cross(chord)), 1e-12));
}

TEST_CASE("a force beside the axis of a rod does the work of the particle that it acts on") {
    using Rod = beam::RigidSectionRod;
    Loaded scene;
    const Vec3 lever = 0.1 * Vec3(0.3, -0.2, 0.7);
    scene.assembly.apply(scene::DeadForce{scene::last_end(scene.fibre), NodeVector::director_1, lever, "load"});
    const beam::Mesh<Rod> mesh(scene.assembly, Rod());
    load::AppliedLoad<Rod> load(scene.assembly, mesh, scene::Channels(scene.assembly));
    Vector state = mesh.rest_state(), force = Vector::Zero(state.size());
    const Index vector = mesh.node_vector(scene.fibre, mesh.node_count(scene.fibre) - 1, 1);
    const Vec3 psi(0.4, -0.3, 0.8);
    state.segment<3>(3 * vector) = psi;
    load.begin(std::vector<double>{1.0}, state);
    load.add_forces(state, force);
    const double h = 1e-5;  // central differences err by its square
    for (int k = 0; k < 3; ++k) {
        const Vec3 step = h * Vec3::Unit(k);
        const double work = lever.dot(core::rotation(psi + step).col(0) - core::rotation(psi - step).col(0)) / (2.0 * h);
        CHECK(std::abs(force[3 * vector + k] - work) < 1e-10);
    }
}

template <class B>
void check_loads() {
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {2, 0, 0}, 2));
    assembly.add(fibre({0, 1, 0}, {1, 2, 0.5}, 3));
    const beam::Mesh<B> mesh(assembly, B());
    const Vector state = mesh.rest_state() + 0.05 * Vector::LinSpaced(mesh.rest_state().size(), -1.0, 1.0).array().sin().matrix();
    load::Gravity::Parameters gravity;
    gravity.weight = Vec3(0.0, 30.0, -900.0);
    test::check_term<B, load::Gravity>(assembly, gravity, state);
    load::LineLoads::Parameters lines;
    lines.loads.push_back({.fibre = 1, .force = {0.3, 0.1, -0.2}, .from = 0.2, .to = 0.7});
    test::check_term<B, load::LineLoads>(assembly, lines, state);
    load::FollowerForces::Parameters followers;
    followers.forces.push_back({.at = scene::last_end(0), .along = 0.7});
    followers.forces.push_back({.at = {1, 0.4}, .along = -0.2});
    test::check_term<B, load::FollowerForces>(assembly, followers, state);
}

TEST_CASE("loads keep the contract of a term, on cables and on beams with directors") {
    check_loads<Cable>();
    check_loads<beam::DirectorBeam<3>>();
}

TEST_CASE("a line load has the resultant and the moment of its force over its length") {
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {2, 0, 0}, 3));
    const Vec3 q(0.3, 0.1, -0.2);
    load::LineLoads::Parameters lines;
    lines.loads.push_back({.fibre = 0, .force = q, .from = 0.25, .to = 0.8});
    test::TermScene<beam::DirectorBeam<3>, load::LineLoads> scene(assembly, lines);
    const Vector force = scene.forces(scene.mesh.rest_state());
    Vec3 sum = Vec3::Zero(), moment = Vec3::Zero();
    for (Index a = 0; a < scene.mesh.node_count(0); ++a) {
        const Vec3 one = force.segment<3>(9 * a), at = scene.mesh.rest_state().segment<3>(9 * a);
        sum += one, moment += at.cross(one);
    }
    CHECK((sum - 1.1 * q).norm() < 1e-14);  // 2 (0.8 - 0.25)
    CHECK((moment - Vec3(1.05, 0, 0).cross(1.1 * q)).norm() < 1e-14);
}

TEST_CASE("loads go with the amplitude of their own channel, and act where they are said to") {
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {2, 0, 0}, 3));
    load::LineLoads::Parameters lines;
    lines.loads.push_back({.fibre = 0, .force = {0, 1, 0}, .channel = "one"});
    lines.loads.push_back({.fibre = 0, .force = {0, 0, 1}, .channel = "two"});
    test::TermScene<Cable, load::LineLoads> scene(assembly, lines);
    const Vector rest = scene.mesh.rest_state();
    const auto sum = [](const Vector& force) {
        Vec3 all = Vec3::Zero();
        for (Index a = 0; 6 * a < force.size(); ++a) all += force.segment<3>(6 * a);
        return all;
    };
    std::vector<double> amplitudes(2);
    amplitudes[core::at(scene.channels.find("one"))] = 0.25, amplitudes[core::at(scene.channels.find("two"))] = 3.0;
    scene.term.begin(amplitudes, rest);
    CHECK((sum(scene.forces(rest)) - Vec3(0, 0.5, 6.0)).norm() < 1e-13);
    test::TermScene<Cable, load::Gravity> heavy(assembly, {.weight = Vec3(0, 0, -900.0)});
    heavy.begin(0.25);
    CHECK(sum(heavy.forces(rest)).z() == test::near(-0.25 * 900.0 * 2.0 * scene::circular(0.01).area()));
    const term::SiteOf<Cable> site(scene.assembly, scene.mesh, scene.channels, scene.mesh.layout());
    for (const double part : {0.0, 0.3, 1.0 / 3.0, 0.8, 1.0})
        CHECK((site.point({0, part}).place(rest) - Vec3(2.0 * part, 0, 0)).norm() < 1e-14);
}

}  // namespace applied_load_test

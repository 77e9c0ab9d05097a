// SPDX-License-Identifier: MIT
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/load/applied_load.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace applied_load_test {

using Beam = beam::DirectorBeam<3>;
using scene::NodeVector;

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

}  // namespace applied_load_test

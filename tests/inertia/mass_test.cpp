// SPDX-License-Identifier: MIT
// Inertia without a run: masses of sections and rings, steps of time, what a checkpoint has of them.
#include <near.hpp>
#include <refusal.hpp>
#include <term/term_contract.hpp>

#include <fibrant/beam/director_beam.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/inertia.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>

using namespace fibrant;

namespace mass_test {

const double pi = std::numbers::pi;

/// A bar along x with g_1 along z.
scene::Assembly bar(const scene::CrossSection& section, Index elements) {
    scene::Assembly assembly;
    assembly.add({.from = {0, 0, 0},
                  .to = {2, 0, 0},
                  .section = section,
                  .material = {1.0, 0.3},
                  .elements = elements,
                  .director = Vec3::UnitZ()});
    return assembly;
}

TEST_CASE("what a step says that it errs by is what it errs by where the acceleration grows evenly") {
    const double t = 0.7, dt = 0.1;
    const auto missed = [&](const inertia::TimeStep& s, double old, double now) {  // of the motion t^3
        return t * t * t + s.by_velocity * 3.0 * t * t + s.by_acceleration * old + s.c2 * now - std::pow(t + dt, 3) -
               (s.error_old * old + s.error_new * now);
    };
    for (const double radius : {0.5, 0.8, 1.0})
        CHECK(std::abs(missed(inertia::GeneralisedAlpha({radius}).step(dt), 6.0 * t, 6.0 * (t + dt))) < 1e-14);
    CHECK(std::abs(missed(inertia::Midpoint().step(dt), 6.0 * t - 3.0 * dt, 6.0 * t + 3.0 * dt)) < 1e-14);
    // Forces of a step are those of a time between its ends, and velocities follow them to the second order.
    const auto gained = [&](const inertia::TimeStep& s) {
        const double late = (1.0 - s.share) * dt;
        return s.old_acceleration * 6.0 * (t - late) + s.new_acceleration * 6.0 * (t + dt - late);
    };
    for (const double radius : {0.5, 0.8, 1.0})
        CHECK(gained(inertia::GeneralisedAlpha({radius}).step(dt)) == test::near(3.0 * dt * (2.0 * t + dt)));
    CHECK(gained(inertia::Midpoint().step(dt)) == test::near(3.0 * dt * (2.0 * t + dt)));
}

TEST_CASE("flat sections turn about each axis with the moment of what they turn, and steps are cut by the third power") {
    const auto check = []<class B>(std::type_identity<B>) {
        const double L = 2.0, density = 3.0, spin = 0.7;
        const scene::CrossSection section = scene::elliptical(0.4, 0.1);
        const scene::Assembly assembly = bar(section, 4);
        const beam::Mesh<B> mesh(assembly, B());
        const Mat3 axes = mesh.frame(0, 0).basis();  // g_1, g_2, tangent
        const double first = section.second_moment_1(), second = section.second_moment_2(),
                     long_way = section.area() * L * L / 12.0;
        REQUIRE(first > 10.0 * second);
        // About g_1 it is g_2 that moves, and the other way round.
        const Vec3 moments(long_way + second, long_way + first, first + second);
        for (int k = 0; k < 3; ++k) {
            test::TermScene<B, inertia::Inertia<>> scene(
                assembly, {.density = density, .starts = {{.spin = spin * axes.col(k), .centre = {0.5 * L, 0, 0}}}});
            CHECK(scene.term.motion(mesh.rest_state()).kinetic ==
                  test::near(0.5 * spin * spin * density * L * moments[k], 1e-10));
        }
        const auto longest = [&](double allowed) {  // growth that a step lets the next one have
            test::TermScene<B, inertia::Inertia<>> scene(assembly, {.density = density, .allowed_error = allowed});
            const Vector rest = mesh.rest_state(), moved = rest + 0.01 * Vector::Ones(rest.size());
            scene.term.accept(rest), scene.begin(1.0);
            CHECK(scene.term.refusal(moved).empty());
            double low = 0.0, high = 1e6;
            while (high - low > 1e-9 * high) (scene.term.may_grow(0.5 * (low + high)) ? low : high) = 0.5 * (low + high);
            return low;
        };
        CHECK(longest(8.0) == test::near(2.0 * longest(1.0), 1e-6));
    };
    check(std::type_identity<beam::DirectorBeam<3>>{});
    check(std::type_identity<beam::RigidSectionRod>{});
}

TEST_CASE("a step may miss a part of the energy that it turns over, and half of what those before it have left") {
    using B = beam::RigidSectionRod;
    const scene::Assembly assembly = bar(scene::circular(0.3), 3);
    const inertia::Inertia<>::Parameters parameters{.density = 3.0, .allowed_loss = 0.1};
    test::TermScene<B, inertia::Inertia<>> scene(assembly, parameters), again(assembly, parameters);
    const Vector rest = scene.mesh.rest_state();
    const auto kept = [&](auto& of, double missed, double turned, double held, double part) {
        return of.term.refusal(term::StepEnergy{missed, turned, held, part}).empty();
    };
    scene.begin(1.0);
    CHECK_FALSE(kept(scene, 0.121, 1.0, 2.0, 0.1));
    CHECK_FALSE(kept(scene, -0.121, 1.0, 2.0, 0.1));  // nor may it gain that
    CHECK(kept(scene, -0.119, 1.0, 2.0, 0.1));
    CHECK_FALSE(scene.term.may_grow(1.1));
    CHECK(kept(scene, 0.02, 1.0, 2.0, 0.1));
    CHECK(scene.term.may_grow(std::sqrt(6.0) - 1e-9));
    CHECK_FALSE(scene.term.may_grow(std::sqrt(6.0) + 1e-9));
    scene.term.accept(rest);
    CHECK(scene.term.missed() == test::near(0.02));
    CHECK(scene.term.may_miss() == test::near(0.12));
    CHECK(kept(scene, 0.049, 0.0, 0.0, 0.1));
    CHECK_FALSE(kept(scene, 0.051, 0.0, 0.0, 0.1));
    test::copy_numbers(scene.term, again.term);  // through a checkpoint as well
    again.begin(1.0);
    CHECK(kept(again, 0.049, 0.0, 0.0, 0.1));
    CHECK_FALSE(kept(again, 0.051, 0.0, 0.0, 0.1));
    // Half of the step misses as much: half of what the rest of the stage may miss goes into it, and what follows makes up for
    // it.
    again.term.last(0.05);
    CHECK_FALSE(again.term.refusal(term::StepEnergy{0.16, 0.0, 1.0, 0.1, 0.9}).empty());
    again.term.last(0.1);
    CHECK_FALSE(again.term.refusal(term::StepEnergy{0.154, 0.0, 1.0, 0.1, 0.9}).empty());  // no shorter than the last
    again.term.last(0.05);
    CHECK_FALSE(again.term.refusal(term::StepEnergy{0.156, 0.0, 1.0, 0.1, 0.9}).empty());
    again.term.last(0.025);
    CHECK(again.term.refusal(term::StepEnergy{0.154, 0.0, 1.0, 0.1, 0.9}).empty());  // 0.1 (0.1 + 0.9/2) and what was left
    again.term.accept(rest);
    CHECK(again.term.missed() > again.term.may_miss());
    CHECK(kept(again, 0.0049, 0.0, 1.0, 0.1));
    CHECK_FALSE(kept(again, 0.0051, 0.0, 1.0, 0.1));
    // What three halvings make hardly less is of no step, and passes, until steps miss little again.
    const auto at = [&](double duration, double missed) {
        again.term.last(duration);
        return again.term.refusal(term::StepEnergy{missed, 0.0, 1.0, 0.1, 0.0}).empty();
    };
    again.term.accept(rest);
    CHECK_FALSE(at(0.8, 8.0));
    CHECK_FALSE(at(0.4, 4.0));
    CHECK_FALSE(at(0.2, 2.0));
    CHECK(at(0.1, 1.0));
    again.term.accept(rest);
    CHECK(at(0.1, 1.4));
    again.term.accept(rest);
    CHECK_FALSE(at(0.1, 1.6));
    CHECK(at(0.1, 0.001));
    again.term.accept(rest);
    CHECK_FALSE(at(0.1, 1.0));
    CHECK_FALSE(at(0.05, 0.3));  // less by more than that
    CHECK_FALSE(at(0.025, 0.15));
    CHECK_FALSE(at(0.0125, 0.075));
    for (const double none : {0.0, -1.0, 1.5}) {
        const auto built = [&] { test::TermScene<B, inertia::Inertia<>>(assembly, {.density = 3.0, .allowed_loss = none}); };
        CHECK(test::refusal(built).find("Inertia.allowed_loss = " + core::text(none) + ", but it must be > 0 and <= 1") !=
              std::string::npos);
    }
}

TEST_CASE("all nodes of a ring of rods have two sides") {
    // Directors across the plane do not move, others as fast as the ring turns: of two rings of one mass per length and one
    // circumference the difference is that of their second moments.
    const double spin = 0.7;
    double kinetic[2], unit[2];
    for (int thick = 0; thick < 2; ++thick) {
        const double r = thick == 0 ? 0.05 : 0.2, density = 1.0 / (pi * r * r);
        scene::Assembly assembly;
        assembly.add({.curve = [](double t) { return Vec3(std::cos(2.0 * pi * t), std::sin(2.0 * pi * t), 0); },
                      .section = scene::circular(r),
                      .material = {1.0, 0.3},
                      .elements = 8,
                      .closed = true});
        test::TermScene<beam::RigidSectionRod, inertia::Inertia<>> scene(
            assembly, {.density = density, .starts = {{.spin = {0, 0, spin}}}});
        kinetic[thick] = scene.term.motion(scene.mesh.rest_state()).kinetic;
        unit[thick] = 0.5 * spin * spin * scene.mesh.fibre(0).length() * 0.25 * r * r;
    }
    CHECK(kinetic[1] - kinetic[0] == test::near(unit[1] - unit[0], 1e-9));
}

TEST_CASE("forces at the start of a step go through a checkpoint and from vectors into space and back") {
    using B = beam::RigidSectionRod;
    const scene::Assembly assembly = bar(scene::circular(0.3), 3);
    test::TermScene<B, inertia::Inertia<>> scene(assembly, {.density = 3.0}), again(assembly, {.density = 3.0});
    const Vector rest = scene.mesh.rest_state();
    const Vector state = rest + 0.3 * Vector::LinSpaced(rest.size(), -1.0, 1.0).array().sin().matrix(),
                 forces = Vector::LinSpaced(rest.size(), 0.2, 1.0), none = Vector::Zero(rest.size());
    const auto there = inertia::Coordinates<B>::in_space(state, forces);
    CHECK((there - forces).norm() > 1e-3);
    CHECK((inertia::Coordinates<B>::from_space(state, there) - forces).norm() < 1e-12);
    Vector sum = none, other = none;
    scene.term.add_averaged(state, forces, sum);
    scene.term.accept(state);
    test::copy_numbers(scene.term, again.term);
    scene.begin(1.0), again.begin(1.0);
    sum.setZero();
    scene.term.add_averaged(state, none, sum), again.term.add_averaged(state, none, other);
    CHECK((sum - (1.0 - scene.term.share()) * forces).norm() < 1e-12);
    CHECK(sum.norm() > 0.1);
    CHECK(other == sum);
}

}  // namespace mass_test

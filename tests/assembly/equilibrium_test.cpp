// SPDX-License-Identifier: MIT
#include "assembly/pressed_fibres.hpp"

#include <near.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cstdio>
#include <random>

using namespace fibrant;

namespace equilibrium_test {

using Rough = test::PressedFibres<law::RegularisedCoulomb>;
using Smooth = test::PressedFibres<law::Frictionless>;
using Centred = test::PressedFibres<law::Frictionless, beam::OnCentreline<beam::DirectorBeam<3>>>;

/// Largest difference between K x and central differences of the residual, relative to K x, over some random x.
template <class Pressed, class Directions>
double derivative_error(Pressed& fibres, const Directions& within) {
    double worst = 0.0;
    for (unsigned seed = 1; seed < 9; ++seed) {
        const Vector x = within(fibres.random_step(seed));
        Vector product(x.size());
        fibres.linearise(fibres.state);
        fibres.equilibrium.system().apply_unheld(x, product);
        // Forces are cubic in the unknowns and contacts smooth while their status stands: differences of the step h are
        // off by h^2 of the geometry (1e-10) and by rounding over h (1e-16 / 1e-5).
        const double h = 1e-5;
        const Vector slope = (fibres.residual(fibres.state + h * x) - fibres.residual(fibres.state - h * x)) / (2.0 * h);
        worst = std::max(worst, within(Vector(product - slope)).norm() / product.norm());
    }
    return worst;
}
const auto everywhere = [](const Vector& x) { return x; };

TEST_CASE_TEMPLATE("the tangent is the derivative of the residual, with contacts active at frozen normals", Pressed, Smooth,
                   Centred) {
    Pressed fibres(false);
    REQUIRE(fibres.active() > 5);
    const double error = derivative_error(fibres, everywhere);
    std::printf("tangent against differences: %.1e, %td active contacts\n", error, fibres.active());
    CHECK(error < 1e-6);
}

TEST_CASE("friction that follows the reaction: the part that is not symmetric completes the derivative") {
    Rough fibres(false);
    fibres.contacts.parameters().friction_bound = contact::FrictionBound::following;
    // Fibres move as wholes, so that no particle moves on its section: how friction's lever changes is in no tangent.
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const auto translation = [&](double size) {
        Vector x = Vector::Zero(fibres.state.size());
        for (Index f = 0; f < fibres.mesh.fibre_count(); ++f) {
            const double a = any(random), b = any(random), c = any(random);
            for (Index n = 0; n < fibres.mesh.node_count(f); ++n)
                x.segment<3>(3 * fibres.mesh.node_vector(f, n, 0)) = size * Vec3(a, b, c);
        }
        return x;
    };
    double worst = 0.0, symmetric = 0.0, sliding = 0.0;
    for (int trial = 0; trial < 8; ++trial) {
        const Vector at = fibres.state + translation(0.03 * fibres.radius), x = translation(fibres.radius);
        fibres.linearise(at);
        const auto& system = fibres.equilibrium.system();
        REQUIRE(system.unsymmetric());
        Vector product(x.size());
        system.apply_unheld(x, product);
        const double h = 1e-6;  // rounding over h: 1e-9 of forces that are differences of some hundred elements'
        const Vector slope = (fibres.residual(at + h * x) - fibres.residual(at - h * x)) / (2.0 * h);
        symmetric = std::max(symmetric, (product - slope).norm() / slope.norm());
        system.apply_skews(x, product);
        worst = std::max(worst, (product - slope).norm() / slope.norm());
        const auto& frictions = fibres.contacts.frictions();
        std::size_t carrying = 0;
        for (std::size_t k = 0; k < frictions.size(); ++k)
            sliding += frictions[k].sliding ? 1.0 : 0.0, carrying += fibres.contacts.carries(static_cast<Index>(k)) ? 1 : 0;
        CHECK(frictions.values() == carrying);  // what carries nothing takes no memory
    }
    std::printf("following friction: %.1e, without its skew part %.1e\n", worst, symmetric);
    CHECK(sliding > 8.0);  // on both branches of the law
    CHECK(symmetric > 0.01);
    CHECK(worst < 1e-5);
}

TEST_CASE("a moment that turns with its section, in its plane") {
    // Fibre 0 lies along x with g_1 = z: the moment about y turns g_1 in the plane y = 0.
    Smooth fibres(false, Vec3(0, 0.05, 0));
    const Index vector = fibres.mesh.node_vector(0, fibres.mesh.node_count(0) - 1, 1);
    fibres.state[3 * vector + 1] = 0.0;
    const auto in_plane = [&](Vector x) {
        x[3 * vector + 1] = 0.0;
        return x;
    };
    const double error = derivative_error(fibres, in_plane);
    std::printf("with a moment: %.1e\n", error);
    CHECK(error < 1e-6);
}

TEST_CASE("contact forces and loads balance: a free system has no resultant but that of its loads") {
    Smooth fibres(false);
    const Vector r = fibres.residual(fibres.state);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    double size = 0.0;
    for (Index v = 0; v < r.size() / 3; ++v) {
        const Vec3 f = r.segment<3>(3 * v), at = fibres.state.segment<3>(3 * v);
        if (v % 3 == 0) force += f, size += f.norm();
        moment += at.cross(f);  // a force on a director at its lever: the director
    }
    CHECK(force.norm() < 1e-12 * size);
    // Each contact's two forces act at its two particles, which are not exactly opposite each other along the normal.
    Vec3 couples = Vec3::Zero();
    for (Index k = 0; k < core::count(fibres.contacts.elements()); ++k)
        couples += fibres.contacts.elements()[core::at(k)].offset(fibres.state).cross(fibres.contacts.force(k));
    CHECK((moment - couples).norm() < 1e-12 * size * 0.4);
}

TEST_CASE("figures compare the free residual with loads, reactions and contact forces") {
    Smooth fibres(true);
    fibres.contacts.evaluate(fibres.state);
    Vector r;
    const assembly::ResidualFigures figures = fibres.equilibrium.residual(fibres.state, r);
    CHECK(figures.residual == test::near(fibres.equilibrium.norm(r), 1e-9));
    CHECK(figures.scale > 0.0);
    CHECK(figures.rounding < 1e-9 * figures.residual);
    for (const scene::HeldVector& held : fibres.equilibrium.system().layout().held) {
        const Vec3 f = r.segment<3>(3 * held.vector);
        CHECK((f - held.free * f).norm() < 1e-14 * r.norm());
        const Vec3 reaction = fibres.equilibrium.reaction().segment<3>(3 * held.vector);
        CHECK((held.free * reaction).norm() < 1e-14 * r.norm());
    }
    assembly::ResidualFigures rounding_only;
    rounding_only.residual = 1e-16, rounding_only.rounding = 1e-15;
    CHECK(rounding_only.relative() == 0.0);
}

TEST_CASE("a residual moved rigidly is rounding only, far from the origin too") {
    for (const double away : {0.0, 100.0}) {
        scene::Assembly assembly;
        assembly.add({.from = {away, 0, 0},
                      .to = {away + 1.0, 0, 0},
                      .section = scene::circular(0.01),
                      .material = {7300.0, 0.3},
                      .elements = 20});
        const beam::DirectorBeam<3> beam;
        const beam::Mesh<beam::DirectorBeam<3>> mesh(assembly, beam);
        const connection::Channels channels(assembly);
        Smooth::Contacts contacts(
            assembly, mesh,
            [] {
                contact::ContactParameters parameters;
                parameters.stiffness.allowed_penetration = 1e-4;
                return parameters;
            }(),
            proximity::BruteSearch{}, law::RegularisedPenalty({.regularisation_depth = 1e-5}), law::Frictionless{});
        Smooth::Equilibrium equilibrium(assembly, mesh, beam, contacts, channels);
        Vector state = mesh.rest_state(), r;
        const Mat3 turn(Eigen::AngleAxisd(1.0, Vec3(1, 2, 3).normalized()));
        for (Index v = 0; v < state.size() / 3; ++v) state.segment<3>(3 * v) = (turn * state.segment<3>(3 * v)).eval();
        equilibrium.begin({}, state);
        contacts.detect(state, state, 0.0, false);
        contacts.evaluate(state);
        const assembly::ResidualFigures figures = equilibrium.residual(state, r);
        std::printf("rigid motion: residual %.1e, taken for rounding %.1e, E A = %.1e\n", figures.residual, figures.rounding,
                    7300.0 * 3.14e-4);
        CHECK(figures.relative() == 0.0);
        CHECK(figures.rounding < 1e-9 * 7300.0 * 3.14e-4);
    }
}

TEST_CASE("prescribed components step onto their targets, the others stay") {
    Smooth fibres(true);
    Vector step;
    fibres.equilibrium.prescribed_step(fibres.state, step);
    const auto& held = fibres.equilibrium.system().layout().held;
    const Vector there = fibres.state + step;
    for (std::size_t k = 0; k < held.size(); ++k) {
        const Vec3 value = there.segment<3>(3 * held[k].vector);
        CHECK((value - held[k].free * value - fibres.equilibrium.targets()[k]).norm() < 1e-15);
        const Vec3 move = step.segment<3>(3 * held[k].vector);
        CHECK((held[k].free * move).norm() < 1e-15);
        step.segment<3>(3 * held[k].vector).setZero();
    }
    CHECK(step.isZero(0.0));
}

TEST_CASE("residuals are measured by what presses and what holds, steps by their displacements") {
    Smooth fibres(true);
    fibres.contacts.evaluate(fibres.state);
    Vector r, pressing = Vector::Zero(fibres.state.size()), turn = pressing;
    const assembly::ResidualFigures figures = fibres.equilibrium.residual(fibres.state, r);
    fibres.contacts.add_forces(pressing);
    const double pressed = fibres.equilibrium.norm(pressing), held = fibres.equilibrium.norm(fibres.equilibrium.reaction());
    CHECK(held > 0.1 * pressed);
    CHECK(figures.scale == test::near(std::hypot(pressed, held), 1e-9));
    turn.segment<3>(3) = Vec3(1, 2, 2);  // of one director
    CHECK(fibres.equilibrium.greatest(turn) < 3.0);
    CHECK(fibres.equilibrium.product(turn, turn) == test::near(std::pow(fibres.equilibrium.greatest(turn), 2), 1e-12));
}

}  // namespace equilibrium_test

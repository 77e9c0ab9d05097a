// SPDX-License-Identifier: MIT
// Rigid bodies on nodes of fibres: they fall, spin, precess and ring as closed forms say.
#include <inertia/moving_fibre.hpp>
#include <near.hpp>
#include <refusal.hpp>
#include <term/term_contract.hpp>

#include <fibrant/beam/kirchhoff_cable.hpp>
#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/fibrant.hpp>
#include <fibrant/inertia.hpp>

#include <Eigen/Eigenvalues>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <type_traits>
#include <vector>

using namespace fibrant;

namespace bodies_test {

const double pi = std::numbers::pi;

/// Keeps energy and momenta, whatever the step.
struct Carrying {
    using Motion = inertia::WithBodies<inertia::Midpoint>;
    using Beam = beam::RigidSectionRod;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
    using Acts = term::List<Motion>;
};
static_assert(simulation::MovesInTime<Carrying>);
using test::along_x;

simulation::ModelParameters<Carrying> parameters(double radius, double density, const inertia::Body& body) {
    simulation::ModelParameters<Carrying> all;
    all.normal.regularisation_depth = 1e-3 * radius;
    all.contact.stiffness.allowed_penetration = 1e-2 * radius;
    all.iteration.step_tolerance = 1e-10, all.iteration.residual_tolerance = 1e-10;
    all.acts.inertia.density = density, all.acts.inertia.bodies = {body};
    return all;
}
simulation::Loading<Carrying> lasting(double duration, Index steps) { return test::lasting<Carrying>(duration, steps, "load"); }
inertia::Motion motion_of(const simulation::Simulator<Carrying>& simulator) {
    return simulator.equilibrium().terms().get<Carrying::Motion>().motion(simulator.state());
}

TEST_CASE("inertia with bodies keeps the contract of a term, on all beams") {
    const auto check = []<class B>(std::type_identity<B>, const Vec3& moments) {
        scene::Assembly assembly;
        assembly.add(along_x(2.0, 0.3, 1.0, 3));
        const beam::Mesh<B> mesh(assembly, B());
        const Vector state =
            mesh.rest_state() + 0.05 * Vector::LinSpaced(mesh.rest_state().size(), -1.0, 1.0).array().sin().matrix();
        inertia::WithBodiesParameters<inertia::GeneralisedAlpha> with;
        with.density = 3.0, with.starts = {{.velocity = {1, 2, 3}, .spin = {0.5, -1, 2}}};
        with.bodies = {{.at = {0, 1.0}, .mass = 5.0, .moments = moments}, {.at = {0, 0.0}, .mass = 2.0}};
        test::check_term<B, inertia::WithBodies<>>(assembly, with, state);
    };
    check(std::type_identity<beam::DirectorBeam<3>>{}, {2.0, 1.0, 3.0});
    check(std::type_identity<beam::KirchhoffCable>{}, Vec3::Zero());
    check(std::type_identity<beam::RigidSectionRod>{}, {2.0, 1.5, 2.5});
}

TEST_CASE("a body that is none, or that its node cannot carry, is refused by name") {
    scene::Assembly assembly;
    assembly.add(along_x(2.0, 0.3, 1.0, 3));
    const auto refusal = [&]<class B>(std::type_identity<B>, const inertia::Body& body) {
        inertia::WithBodiesParameters<inertia::GeneralisedAlpha> with;
        with.density = 1.0, with.bodies = {body};
        return test::refusal([&] { test::TermScene<B, inertia::WithBodies<>>(assembly, with); });
    };
    const std::type_identity<beam::RigidSectionRod> rod;
    CHECK(refusal(rod, {.mass = 0.0}) == "Body.mass = 0, but it must be finite and > 0 (body 0)");
    CHECK(refusal(rod, {.mass = 1.0, .moments = {1.0, 1.0, 3.0}}) ==
          "Body.moments: of axis 3 = 3, but it must be >= 0 and not greater than the others together (body 0)");
    CHECK(refusal(rod, {.at = {0, 0.5}, .mass = 1.0}) == "Body.at: fraction = 0.5, but it must be of a node (body 0)");
    CHECK(refusal(rod, {.at = {1, 0.0}, .mass = 1.0}) == "Station.fibre = 1, but it must be a fibre of this assembly (body 0)");
    CHECK(refusal(std::type_identity<beam::DirectorBeam<3>>{}, {.at = {0, 0.0}, .mass = 1.0, .moments = {1.0, 1.0, 1.0}}) ==
          "Body.moments: the third = 1, but it must be the sum of the others, on sections that deform (body 0)");
    CHECK(refusal(std::type_identity<beam::KirchhoffCable>{}, {.at = {0, 0.0}, .mass = 1.0, .moments = {1.0, 1.0, 1.0}}) ==
          "Body.moments: the third = 1, but it must be 0, as the others, on a cable (body 0)");
}

/// A thrown symmetric top on the end of a rod that weighs next to nothing, and whose waves the steps resolve.
struct Top {
    double mass = 2.0, across = 0.4, about = 0.6, g = 9.81, T = 1.5;  // flat: its third axis is that of symmetry
    Vec3 velocity{0.3, -0.2, 1.0}, spin{4.0, 0.0, 3.0};               // x along that axis
    scene::Assembly assembly;
    simulation::ModelParameters<Carrying> with;
    Top() {
        const double length = 0.05, r = 0.03, density = 1e-8 * mass / (pi * r * r * length), wave = 3.0;
        assembly.add(along_x(length, r, wave * wave * density, 1));
        assembly.apply(scene::DeadForce{.at = {0, 0.0}, .force = {0, 0, -mass * g}});
        with = parameters(r, density, {.at = {0, 0.0}, .mass = mass, .moments = {across, across, about}});
        with.acts.inertia.starts = {{.velocity = velocity, .spin = spin}};
    }
};

TEST_CASE("a thrown top falls as a point does, precesses as Euler says, and keeps its momenta and its energy") {
    double off[2];
    for (const int fine : {0, 1}) {
        const Top top;
        simulation::Simulator<Carrying> simulator(top.assembly, top.with);
        const Vec3 axis = Vec3::UnitX();
        const Vec3 turning(top.about * top.spin.x(), 0.0, top.across * top.spin.z());  // angular momentum
        const inertia::Motion before = motion_of(simulator);
        CHECK((before.angular_momentum - turning).norm() < 1e-7 * turning.norm());  // but for the rod
        CHECK(before.kinetic == test::near(0.5 * top.mass * top.velocity.squaredNorm() + 0.5 * top.spin.dot(turning), 1e-6));
        const simulation::Report report = simulator.run(lasting(top.T, fine == 0 ? 300 : 600));
        REQUIRE_MESSAGE(report.converged, report.reason);
        const Vec3 place = simulator.value({0, 0.0}), g(0, 0, -top.g), end = top.T * top.velocity + 0.5 * top.T * top.T * g;
        const inertia::Motion after = motion_of(simulator);
        const Vec3 own = after.angular_momentum - place.cross(after.momentum);
        // The axis goes round the angular momentum at |L|/I_across.
        const Vec3 here = core::rotation(simulator.value({0, 0.0}, scene::NodeVector::director_1)).col(2),
                   then = core::turn_about(turning.normalized(), turning.norm() / top.across * top.T) * axis;
        off[fine] = (here - then).norm();
        std::printf("top: falls to %.6f of %.6f, axis off by %.2e after %.2f turns, spin by %.1e, energy by %.1e\n", place.z(),
                    end.z(), off[fine], turning.norm() / top.across * top.T / (2.0 * pi), (own - turning).norm() / turning.norm(),
                    report.energy.numerical / report.energy.kinetic);
        CHECK((place - end).norm() < 1e-7 * end.norm());  // the rod behind it has 1e-8 of the mass
        CHECK((own - turning).norm() < 1e-8 * turning.norm());
        CHECK(after.kinetic - before.kinetic == test::near(top.mass * g.dot(end), 1e-7));
        CHECK(std::abs(report.energy.error()) < 1e-10 * report.energy.kinetic);
    }
    CHECK(off[1] < 1e-4);  // the midpoint rule lags by (w dt)^2/12 of an angle
    CHECK(off[1] < 0.3 * off[0]);
}

TEST_CASE("a top that is stopped on its way and resumed goes on to the same bits") {
    const Top top;
    simulation::Simulator<Carrying> whole(top.assembly, top.with), first(top.assembly, top.with), second(top.assembly, top.with);
    simulation::Loading<Carrying> loading = lasting(0.1, 8);
    REQUIRE(whole.run(loading).converged);
    struct Stop {
        void reported(const simulation::IncrementReport& increment) const {
            if (increment.number == 5) throw 5;
        }
    } stop;
    loading.checkpoint = (std::filesystem::temp_directory_path() / "fibrant_bodies_test").string();
    CHECK_THROWS_AS(first.run(loading, stop), int);
    loading.resume = true;
    const simulation::Report resumed = second.run(loading);
    std::filesystem::remove(loading.checkpoint);
    REQUIRE(resumed.converged);
    CHECK(second.state() == whole.state());
    CHECK(motion_of(second).angular_momentum == motion_of(whole).angular_momentum);
    CHECK(motion_of(second).kinetic == motion_of(whole).kinetic);
}

/// Squares of angular frequencies of a fibre that is held at its first node, rising.
template <class B>
Vector modes(const scene::Assembly& assembly, double density, const inertia::Body& body) {
    inertia::WithBodiesParameters<inertia::GeneralisedAlpha> with;
    with.density = density, with.bodies = {body};
    test::TermScene<B, inertia::WithBodies<>> scene(assembly, with);
    const Vector rest = scene.mesh.rest_state();
    const Matrix mass = 0.5 * 0.1 * 0.1 * scene.stiffness(rest);  // the first step has c^2 = dt^2/2
    Matrix stiffness = Matrix::Zero(rest.size(), rest.size());
    constexpr Index size = B::nodes * B::dofs_per_node;
    for (Index e = 0; e < scene.mesh.fibre(0).elements; ++e) {
        const Index first = scene.mesh.first_unknown(0, e);
        stiffness.template block<size, size>(first, first) +=
            B().tangent_stiffness(scene.mesh.rest(0, e), scene.mesh.element(rest, 0, e));
    }
    const Index free = rest.size() - B::dofs_per_node;
    return Eigen::GeneralizedSelfAdjointEigenSolver<Matrix>(stiffness.bottomRightCorner(free, free),
                                                            mass.bottomRightCorner(free, free), Eigen::EigenvaluesOnly)
        .eigenvalues();
}
/// Least positive root of a function that is positive at 0+, by halving.
template <class Function>
double root(const Function& function, double most) {
    double low = 0.0, high = most;
    for (int k = 0; k < 200; ++k) (function(0.5 * (low + high)) > 0.0 ? low : high) = 0.5 * (low + high);
    return 0.5 * (low + high);
}

TEST_CASE("a cantilever with a mass at its tip rings, and a shaft with a disc twists, at the frequency of the closed form") {
    const double r = 1.0, L = 200.0, E = 1.0, density = 1.0, beam = density * pi * r * r * L, EI = E * 0.25 * pi * r * r * r * r;
    for (const double ratio : {0.2, 1.0, 20.0}) {
        scene::Assembly assembly;
        assembly.add(along_x(L, r, E, 8));
        // Euler and Bernoulli: 1 + cos b cosh b = (M/m) b (sin b cosh b - cos b sinh b), w = b^2 sqrt(EI/(m L^3)).
        const double b = root(
            [&](double x) {
                return 1.0 + std::cos(x) * std::cosh(x) - ratio * x * (std::sin(x) * std::cosh(x) - std::cos(x) * std::sinh(x));
            },
            2.0);
        const double exact = b * b * std::sqrt(EI / (beam * L * L * L)),
                     usual = std::sqrt(3.0 * EI / ((ratio * beam + 0.2427 * beam) * L * L * L));
        const inertia::Body tip{.at = {0, 1.0}, .mass = ratio * beam};
        const double cable = std::sqrt(modes<beam::KirchhoffCable>(assembly, density, tip)[0]),
                     director = std::sqrt(modes<beam::DirectorBeam<3>>(assembly, density, tip)[0]);
        std::printf("mass of %.1f beams at the tip: cable %.6f, director beam %.6f of %.6e; usual formula %.4f\n", ratio,
                    cable / exact, director / exact, exact, usual / exact);
        CHECK(cable == test::near(exact, 1e-6));
        CHECK(director == test::near(exact, 1e-3));  // shear: 3 E I/(G A L^2), and its linear directors
        CHECK(cable == test::near(usual, 5e-3));     // its 0.2427 is that of the beam alone, 33/140 of a heavy mass
    }
    // b tan b = J/J_disc, w = b/L sqrt(G/rho); the disc is flat, its third moment is about the shaft.
    const double shaft = density * 0.5 * pi * r * r * r * r * L;
    for (const double ratio : {1.0, 10.0}) {
        scene::Assembly assembly;
        assembly.add(along_x(L, r, E, 8));
        const double b = root([&](double x) { return 1.0 - ratio * x * std::tan(x); }, 0.5 * pi - 1e-9);
        const double exact = b / L * std::sqrt(E / (2.0 * 1.3) / density), J = ratio * shaft;
        const Vector squares = modes<beam::DirectorBeam<3>>(
            assembly, density, {.at = {0, 1.0}, .mass = 1e-9 * beam, .moments = {0.5 * J, 0.5 * J, J}});
        double nearest = 0.0;
        for (Index k = 0; k < squares.size(); ++k)
            if (std::abs(std::sqrt(squares[k]) - exact) < std::abs(nearest - exact)) nearest = std::sqrt(squares[k]);
        std::printf("disc of %.1f shafts: %.7f of the closed form\n", ratio, nearest / exact);
        CHECK(nearest == test::near(exact, 1e-5));
    }
}

TEST_CASE("a mass that a cantilever catches sinks to twice its static deflection, and the balance of energy closes") {
    const double r = 0.02, L = 1.0, E = 1e6, EI = E * 0.25 * pi * r * r * r * r, mass = 1.0, sag = 1e-3 * L,
                 weight = 3.0 * EI / (L * L * L) * sag, period = 2.0 * pi * std::sqrt(mass * sag / weight);
    scene::Assembly assembly;
    assembly.add(along_x(L, r, E, 16));
    assembly.clamp(scene::first_end(0));
    assembly.apply(scene::DeadForce{.at = {0, 1.0}, .force = {0, 0, -weight}});
    simulation::Simulator<Carrying> simulator(assembly,
                                              parameters(r, 1e-6 * mass / (pi * r * r * L), {.at = {0, 1.0}, .mass = mass}));
    struct Lowest {
        const simulation::Simulator<Carrying>* of;
        double depth = 0.0;
        void reported(const simulation::IncrementReport&) { depth = std::min(depth, of->value({0, 1.0}).z()); }
    } lowest{&simulator};
    const simulation::Report report = simulator.run(lasting(period, 100), lowest);
    REQUIRE_MESSAGE(report.converged, report.reason);
    const double back = simulator.value({0, 1.0}).z();
    std::printf("caught mass: sinks by %.6f of %.6f, comes back to %.1e of that; energy misses %.1e of the work\n", -lowest.depth,
                2.0 * sag, -back / (2.0 * sag), report.energy.error() / (2.0 * weight * sag));
    CHECK(-lowest.depth == test::near(2.0 * sag, 3e-3));  // rods of constant strain
    CHECK(std::abs(back) < 1e-3 * 2.0 * sag);
    CHECK(std::abs(report.energy.error()) < 1e-3 * 2.0 * weight * sag);
}

}  // namespace bodies_test

// SPDX-License-Identifier: MIT
// Closed fibres through the whole simulator: thin rings against closed forms, wherever their first node lies.
#include "refusal.hpp"
#include "simulation/closed_rings.hpp"

#include <doctest/doctest.h>

#include <cstdio>

using namespace fibrant;

namespace closed_fibre_test {

using test::pi;
using test::Ring;

template <beam::BeamElement B>
simulation::ModelParameters<test::Every<B>> parameters(const Ring& ring, const std::string& strategy) {
    simulation::ModelParameters<test::Every<B>> p = test::ring_parameters<test::Every<B>>(ring);
    p.solver.strategy = strategy;
    return p;
}

struct Diameters {
    double along = 0.0, across = 0.0;
};

/// Change of the diameters of a ring under two forces F R^2 / EI = `load` apart along y, over F R^3 / EI.
template <beam::BeamElement B>
Diameters pulled(const Ring& ring, double load, const std::string& strategy) {
    using M = test::Every<B>;
    scene::Assembly assembly;
    assembly.add(ring.specification<B>());
    assembly.hold_position(ring.at<B>(0.75));
    assembly.hold_position(ring.at<B>(0.25), Vec3(1, 0, 1).asDiagonal());
    assembly.hold_position(ring.at<B>(0.0), Vec3(0, 0, 1).asDiagonal());
    assembly.apply(scene::DeadForce{.at = ring.at<B>(0.25), .force = Vec3(0, load, 0)});
    simulation::Simulator<M> simulator(assembly, parameters<B>(ring, strategy));
    const auto diameters = [&] {
        return Diameters{simulator.value(ring.at<B>(0.25)).y() - simulator.value(ring.at<B>(0.75)).y(),
                         simulator.value(ring.at<B>(0.0)).x() - simulator.value(ring.at<B>(0.5)).x()};
    };
    const auto to = [&](const char* name, double amplitude) {  // a naturally straight fibre comes to rest first
        simulation::Stage<M> stage;
        stage.name = name, stage.increments = 1, stage.ramps = {{"load", amplitude, false}};
        const simulation::Report report = simulator.run(simulation::Loading<M>{.stages = {stage}});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
    };
    to("rest", 0.0);
    const Diameters before = diameters();
    to("pull", 1.0);
    return {(diameters().along - before.along) / load, (diameters().across - before.across) / load};
}

// Thin rings (r = R / 500), small loads: Timoshenko, Strength of Materials II.
constexpr double growth = pi / 4.0 - 2.0 / pi, loss = 2.0 / pi - 0.5;

TEST_CASE("a ring under two opposite forces is that of thin rings wherever its first node lies, round or straight by nature") {
    for (const bool straight : {false, true}) {
        Diameters first;
        for (const Index shift : {0, 2, 37}) {  // of whole elements
            Ring ring{.elements = 80, .shift = static_cast<double>(2 * shift) / 160.0, .straight = straight};
            const Diameters d = pulled<beam::DirectorBeam<3>>(ring, 1e-4, "sparse_cholesky");
            std::printf("director ring, %s, first node at %.4f: along %.10f (off by %.1e), across %.10f (%.1e)\n",
                        straight ? "straight by nature" : "round", ring.shift, d.along, d.along / growth - 1.0, d.across,
                        -d.across / loss - 1.0);
            CHECK(std::abs(d.along / growth - 1.0) < 1e-4);
            CHECK(std::abs(d.across / -loss - 1.0) < 1e-4);
            if (shift == 0) first = d;
            CHECK(std::abs(d.along / first.along - 1.0) < 1e-7);  // of displacements 1e-5 R, themselves to 1e-12 R
        }
        Ring between{.elements = 80, .shift = 1.0 / 160.0, .straight = straight};  // forces on the middle nodes of elements
        CHECK(std::abs(pulled<beam::DirectorBeam<3>>(between, 1e-4, "sparse_cholesky").along / growth - 1.0) < 1e-4);
    }
    for (const double shift : {0.0, 1.0 / 640.0, 0.2}) {
        const Diameters d = pulled<beam::RigidSectionRod>({.elements = 640, .shift = shift}, 1e-4, "sparse_cholesky");
        std::printf("ring of rigid sections, first node at %.4f: along off by %.1e\n", shift, d.along / growth - 1.0);
        CHECK(std::abs(d.along / growth - 1.0) < 1e-4);
    }
}

TEST_CASE("a ring under large forces, apart and together, is the plane elastica") {
    struct Expected {
        double load, along, across;  // diameters over R, elliptic integrals
    };
    for (const Expected& e : {Expected{0.5, 2.0702675, 1.9331297}, {-0.5, 1.921201, 2.0695799}}) {
        const Diameters d = pulled<beam::DirectorBeam<3>>({.elements = 40}, e.load, "sparse_cholesky");
        CHECK(std::abs((2.0 + e.load * d.along) / e.along - 1.0) < 1e-5);
        CHECK(std::abs((2.0 + e.load * d.across) / e.across - 1.0) < 1e-5);
    }
}

TEST_CASE("all strategies give the same ring") {
    const Ring ring{.elements = 20, .shift = 7.0 / 40.0};
    const Diameters exact = pulled<beam::DirectorBeam<3>>(ring, 1e-2, "sparse_cholesky");
    for (const char* strategy : solver::AnySolver::strategies) {
        const Diameters d = pulled<beam::DirectorBeam<3>>(ring, 1e-2, strategy);
        CAPTURE(strategy);
        CHECK(std::abs(d.along / exact.along - 1.0) < 1e-8);  // linear solutions to 1e-10
        CHECK(std::abs(d.across / exact.across - 1.0) < 1e-8);
    }
}

TEST_CASE("Love's ring: under line pressure an ellipse grows as 1 / (1 - p / p_c), p_c = 3 EI / R^3") {
    using B = beam::DirectorBeam<3>;
    using M = test::Every<B>;
    Ring ring{.elements = 40, .radius = 0.01, .ellipse = 1e-4};
    for (const double load : {1.5, 2.4}) {
        scene::Assembly assembly;
        assembly.add(ring.specification<B>());
        for (const double side : {0.0, 0.5}) assembly.hold_position(ring.at<B>(side), Vec3(0, 1, 1).asDiagonal());
        assembly.hold_position(ring.at<B>(0.25), Vec3(1, 0, 1).asDiagonal());
        assembly.apply(scene::LinePressure{.fibre = 0, .pressure = load});
        auto p = parameters<B>(ring, "automatic");
        p.iteration.step_tolerance =
            1e-5;  // rounding, 1e-16 E A, moves a ring by a thousand times as much that is about to buckle
        simulation::Simulator<M> simulator(assembly, p);
        const auto ellipse = [&] {
            return 0.5 * ((simulator.value(ring.at<B>(0.0)) - simulator.value(ring.at<B>(0.5))).norm() -
                          (simulator.value(ring.at<B>(0.25)) - simulator.value(ring.at<B>(0.75))).norm());
        };
        const double before = ellipse();
        const simulation::Report report = simulator.run({.increments = 4});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const double factor = ellipse() / before, critical = load * factor / (factor - 1.0);
        std::printf("Love's ring at %.1f EI / R^3: an ellipse grows by %.4f, critical pressure %.5f, %td Newton iterations\n",
                    load, factor, critical, report.counts.newton);
        CHECK(std::abs(critical / 3.0 - 1.0) < 2e-3);  // of a ring of 40 elements
        CHECK(report.counts.newton <= 4 * 6);          // the load's own stiffness is in the tangent
    }
}

TEST_CASE("Michell's ring: a straight rod that is closed with a twist leaves its plane beyond sqrt(3) EI / GJ turns") {
    using B = beam::DirectorBeam<3>;
    using M = test::Every<B>;
    // Forces f cos 2 theta across the plane move it by f / (A - B twist^2): two twists tell where that has no bound.
    const auto compliance = [](double turns) {
        Ring ring{.elements = 40, .radius = 0.005, .straight = true, .twist = 2.0 * pi * turns};
        scene::Assembly assembly;
        assembly.add(ring.specification<B>());
        for (const double place : {0.125, 0.375, 0.625}) assembly.hold_position(ring.at<B>(place), Vec3(0, 0, 1).asDiagonal());
        assembly.hold_position(ring.at<B>(0.0), Vec3(1, 0, 0).asDiagonal());
        assembly.hold_position(ring.at<B>(0.25), Vec3(0, 1, 0).asDiagonal());
        const Vec3 tangent = Vec3(-1, 1, 0).normalized();
        assembly.hold_position(ring.at<B>(0.125), tangent * tangent.transpose());
        const double force = 1e-7;
        for (int k = 0; k < 4; ++k)
            assembly.apply(scene::DeadForce{.at = ring.at<B>(0.25 * k), .force = Vec3(0, 0, k % 2 == 0 ? force : -force)});
        simulation::Simulator<M> simulator(assembly, parameters<B>(ring, "two_level_pcg"));
        const simulation::Report report = simulator.run({.increments = 1});
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        double sum = 0.0;
        for (int k = 0; k < 4; ++k) sum += (k % 2 == 0 ? 0.25 : -0.25) * simulator.value(ring.at<B>(0.25 * k)).z();
        return sum / force;
    };
    const double nu = 0.3, critical = std::sqrt(3.0) * (1.0 + nu);
    const double low = 0.5 * critical, high = 0.93 * critical, a = 1.0 / compliance(low), b = 1.0 / compliance(high);
    const double found = std::sqrt((a * high * high - b * low * low) / (a - b));
    std::printf("Michell's ring: leaves its plane at %.5f turns, theory %.5f (%.1e)\n", found, critical, found / critical - 1.0);
    CHECK(std::abs(found / critical - 1.0) < 2e-3);
}

TEST_CASE("a closed fibre is refused where it does not close") {
    Ring ring;
    scene::FibreSpecification fibre = ring.specification<beam::DirectorBeam<3>>();
    fibre.curve = [](double t) { return Vec3(std::cos(3.0 * t), std::sin(3.0 * t), 0.0); };
    scene::Assembly open;
    open.add(fibre);
    CHECK(test::refusal([&] { beam::Mesh<beam::DirectorBeam<3>>(open, beam::DirectorBeam<3>{}); }).find("closed") !=
          std::string::npos);
    fibre.curve = {}, fibre.from = Vec3::Zero(), fibre.to = Vec3::UnitX();
    CHECK(test::refusal([&] { fibre.validate(); }).find("fibre.closed") != std::string::npos);
    fibre = ring.specification<beam::DirectorBeam<3>>();
    fibre.closed = false, fibre.twist = 1.0;
    CHECK(test::refusal([&] { fibre.validate(); }).find("fibre.twist") != std::string::npos);
    fibre.start = fibre.curve;  // which may be turned along itself, if it has an end
    fibre.validate();
    fibre.repeats = true;
    CHECK(test::refusal([&] { fibre.validate(); }).find("fibre.twist") != std::string::npos);
}

}  // namespace closed_fibre_test

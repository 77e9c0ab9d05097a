// SPDX-License-Identifier: MIT
// A strand of a core and six wires, stretched and turned. Reference: the uniform state of the same rods (strand_1_6.json).
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/strand/strand.hpp>
#include <fibrant/law/augmented.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;
namespace strand = compositions::strand;

namespace {

struct Frictionless {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::Augmented<law::RegularisedPenalty>;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};

/// strand_1_6.json, results.director.
struct Case {
    double lay_angle_deg, core_radius, gap, pitch;
    double k11, k12, k22;
    double force, torque;  ///< at a strain of 0.002 without rotation
};
const Case cases[] = {{5, 0.0215, 0.0012808799, 2.98759288626, 65.30866018, 0.1993268143, 0.006043605099, 0.13100943348, 0.00039856740643},
                      {10, 0.0215, 0.00091974097, 1.48236252744, 62.70465544, 0.3838470411, 0.008310736385, 0.12578578517, 0.00076749851545},
                      {15, 0.022, 0.00079252128, 0.98720992227, 59.03860839, 0.5461006516, 0.01206550296, 0.11843163927, 0.0010918674471},
                      {20, 0.0225, 0.00037451152, 0.735399955509, 54.09721363, 0.6704171521, 0.01689073587, 0.10851900842, 0.0013403574948}};

strand::StrandParameters strand_of(const Case& c) {
    strand::StrandParameters parameters;
    parameters.core_radius = c.core_radius;
    parameters.layers = {{.wires = 6, .radius = 0.0201, .lay_angle_deg = c.lay_angle_deg}};
    parameters.material = {7300.0, 0.3};
    return parameters;
}

simulation::ModelParameters<Frictionless> model(double r) {
    simulation::ModelParameters<Frictionless> parameters;
    parameters.normal = {.law = {.regularisation_depth = 1e-4 * r}, .largest_penetration = 1e-6 * r};
    parameters.contact.stiffness.allowed_penetration = 1e-3 * r;
    parameters.contact.stiffness.initial_fraction = 0.2;
    parameters.iteration.step_tolerance = 1e-6;
    parameters.iteration.residual_tolerance = 1e-6;
    parameters.iteration.normal_tolerance = 1e-5;
    parameters.iteration.normal_step_tolerance = 1e-5;
    parameters.iteration.contact_tolerance = 1e-4;
    return parameters;
}

simulation::Loading<Frictionless> to(double strain, double rotation, Index increments) {
    simulation::Stage<Frictionless> stage;
    stage.ramps = {{strand::stretch, strain}, {strand::twist, rotation}};
    stage.increments = increments;
    simulation::Loading<Frictionless> loading;
    loading.stages = {stage};
    return loading;
}

}  // namespace

TEST_CASE("wires lie on the helices of the reference") {
    for (const Case& c : cases) {
        const strand::StrandParameters parameters = strand_of(c);
        CHECK(std::abs(parameters.pitch(0) / c.pitch - 1.0) < 1e-9);
        CHECK(std::abs(parameters.neighbour_gap(0) - c.gap) < 1e-8);
    }
}

TEST_CASE("a strand of one core and six wires is as stiff as the reference says") {
    for (const Case& c : cases) {
        strand::StrandParameters parameters = strand_of(c);
        parameters.length = c.lay_angle_deg < 8.0 ? 0.5 * c.pitch : c.pitch;
        parameters.elements = 24;
        simulation::Simulator<Frictionless> simulator(strand::straight_strand(parameters), model(0.0201));
        const auto run = [&](double strain, double rotation, Index increments) {
            const simulation::Report report = simulator.run(to(strain, rotation, increments));
            REQUIRE_MESSAGE(report.converged, report.reason);
            CHECK(report.contact.greatest_penetration < 1e-6 * 0.0201);
            return strand::measure(simulator, parameters);
        };
        // Little strain and less rotation first: under tension a strand turns more stiffly, by F a^2 / k22 in all.
        const strand::StrandState little = run(2e-4, 0.0, 2), turned = run(2e-4, 0.004, 1), stretched = run(0.002, 0.0, 2);
        const double rotation = turned.rotation - little.rotation, strain = turned.strain - little.strain;
        const double k12 = (turned.force - little.force - c.k11 * strain) / rotation;
        const double k21 = (little.torque - c.k22 * little.rotation) / little.strain;
        // Wires keep their twist all along, so their part of the torque goes with what the ends have turned.
        const double k22 = (turned.torque - little.torque) / 0.004;
        // The middle is not strained quite as the whole is.
        const double force = stretched.force - c.k11 * (stretched.strain - 0.002) - c.k12 * stretched.rotation;
        const double torque = stretched.torque - c.k12 * (stretched.strain - 0.002) - c.k22 * stretched.rotation;
        std::printf("lay %2.0f: F %.8f %+.2e (%+.2e of the whole), M %.4e %+.2e, k12 %+.2e, k21 %+.2e, k22 %+.2e; middle strain %.6f, rotation %.2e, %.3f of what was imposed\n", c.lay_angle_deg,
                    force, force / c.force - 1.0, stretched.force / c.force - 1.0, torque, torque / c.torque - 1.0, k12 / c.k12 - 1.0, k21 / c.k12 - 1.0, k22 / c.k22 - 1.0,
                    stretched.strain, stretched.rotation, rotation / 0.004);
        CHECK(std::abs(force / c.force - 1.0) < 2e-4);
        CHECK(std::abs(stretched.force / c.force - 1.0) < 2e-4);
        CHECK(std::abs(torque / c.torque - 1.0) < 2e-3);  // k12 is a small part of what one wire has
        CHECK(std::abs(k12 / c.k12 - 1.0) < 5e-3);
        CHECK(std::abs(k21 / c.k12 - 1.0) < 5e-3);
        CHECK(std::abs(k22 / c.k22 - 1.0) < 1.5e-2);  // near the ends wires turn more than in the middle, a part of a radius far
    }
}

TEST_CASE("a strand that has no room for its wires, or too few of them, is refused by name") {
    strand::StrandParameters parameters = strand_of(cases[3]);
    parameters.length = 1.0;
    parameters.core_radius = 0.0201;
    CHECK(test::refusal([&] { parameters.validate(); }).find("StrandParameters.layers[0]: gap between neighbours = -0.00") == 0);
    CHECK(test::refusal([] { strand::regular_strand(18, 0.02, 10.0, true); }) == "regular_strand.wires = 18, but it must be 1 + 6 + 12 + ...: 1, 7, 19, 37, 61, 91");
    for (const Index wires : {7, 19, 37, 61, 91}) {
        strand::StrandParameters regular = strand::regular_strand(wires, 0.02, 12.0, true);
        regular.material = {7300.0, 0.3}, regular.length = 1.0;
        CHECK(regular.wires() == wires);
        CHECK_NOTHROW(regular.validate());
        CHECK(regular.core_radius < 1.1 * 0.02);
        CHECK(core::count(strand::wires_of(regular).fibres()) == wires);
    }
}

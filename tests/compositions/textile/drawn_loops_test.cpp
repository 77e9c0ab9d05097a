// SPDX-License-Identifier: MIT
// Loops of a knit that are drawn along its wales: each crosses the one below four times, and clasps it.
#include <support/models.hpp>

#include <fibrant/compositions/textile/knits.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <vector>

using namespace fibrant;

namespace drawn_loops_test {

namespace textile = compositions::textile;

struct Drawn {
    simulation::Report report;
    double force = 0.0;   ///< of the upper row [force]
    bool crossed = true;  ///< each crossing is that of the pattern
};

/// Two rows of two loops, at rest as laid, whose needles go apart by four radii.
Drawn draw(double friction, Index increments) {
    const double r = 0.05;
    textile::WeftKnit knit;
    knit.courses = knit.wales = 2;
    knit.wale_spacing = 10.5 * r, knit.course_spacing = 8.0 * r, knit.loop_height = 7.0 * r;
    knit.type.radius = r, knit.type.material = {1e4, 0.3};
    const textile::Textile laid = textile::weft_knit(knit);
    scene::Assembly assembly;
    std::vector<scene::Station> upper;
    for (Index row = 0; row < 2; ++row) {
        scene::FibreSpecification yarn;
        yarn.section = scene::circular(r), yarn.material = knit.type.material, yarn.elements = 40;
        yarn.curve = laid.paths[core::at(row)].curve;
        const Index fibre = assembly.add(yarn);
        const Vec3 by(0.0, (row == 0 ? -2.0 : 2.0) * r, 0.0);
        std::vector<scene::Station> held{scene::first_end(fibre), scene::last_end(fibre)};
        for (const scene::Station& end : held) assembly.clamp(end, by);
        for (const auto& guide : laid.paths[core::at(row)].guides) {
            held.push_back({fibre, std::round(80.0 * guide.at) / 80.0});  // a node
            assembly.prescribe(held.back(), by);
        }
        if (row == 1) upper = held;
    }
    auto parameters = test::direct_parameters<test::EveryDirector>();
    parameters.normal.regularisation_depth = 1e-3 * r;
    parameters.friction = {.friction_coefficient = friction, .reversible_displacement = 0.02 * r};
    parameters.contact.stiffness.allowed_penetration = 1e-2 * r;
    simulation::Simulator<test::EveryDirector> simulator(assembly, parameters);
    Drawn out;
    out.report = simulator.run({.increments = increments});
    for (const scene::Station& at : upper) out.force += simulator.reaction(at).y();
    std::vector<textile::Line> lines;
    for (Index row = 0; row < 2; ++row) {
        std::vector<Vec3> points;
        for (Index k = 0; k <= 400; ++k)
            points.push_back(simulator.mesh().position(simulator.state(), row, 0.1 * static_cast<double>(k)));
        lines.push_back(textile::line_of(std::move(points)));
    }
    out.crossed = textile::audit_crossings(laid.crossings, textile::crossings_of(lines, laid.view)).clean();
    std::printf("friction %.1f, %td increments: %td Newton iterations, %td attempts given up, force %.5f\n", friction, increments,
                out.report.counts.newton, out.report.rejected_increments, out.force);
    return out;
}

TEST_CASE("loops of a knit that are drawn hold and cross as they were laid, at a force that does not depend on the increments") {
    double last = 0.0;
    for (const double friction : {0.1, 0.5}) {
        const Drawn few = draw(friction, 10), many = draw(friction, 20);
        CAPTURE(friction);
        for (const Drawn* one : {&few, &many}) {
            CHECK_MESSAGE(one->report.converged, one->report.reason);
            CHECK(one->crossed);
        }
        CHECK(std::abs(few.force - many.force) < 0.01 * many.force);
        CHECK(many.force > 1.1 * last);  // friction bears a part
        last = many.force;
    }
}

}  // namespace drawn_loops_test

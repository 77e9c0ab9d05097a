// SPDX-License-Identifier: MIT
// Strands of three lengths, stretched and turned: what their ends take off. Reference: the uniform state (strand_1_6.json).
#include "stretched_strand.hpp"

#include <near.hpp>

#include <Eigen/Dense>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace strand_test {

TEST_CASE("the ends of a strand take off its stiffness what falls with its length, and every stiffness is the reference's") {
    // Wires that the ends hold turn less there than in the middle, or more: a share of the piece, not an error of contact or of
    // the mesh.
    struct Piece {
        std::size_t of;
        double pitches;
        Index elements;
    };
    for (const auto& [of, pitches, elements] :
         {Piece{0, 1, 48}, Piece{1, 2, 48}, Piece{2, 3, 72}, Piece{3, 2, 48}, Piece{3, 4, 96}}) {
        const Case& c = cases[of];
        strand::StrandParameters parameters = strand_of(c);
        parameters.length = pitches * c.pitch, parameters.elements = elements;
        simulation::Simulator<Frictionless> simulator(strand::straight_strand(parameters), model(0.0201));
        const auto run = [&](double rotation, Index increments) {
            const simulation::Report report = simulator.run(to(2e-4, rotation, increments));
            REQUIRE_MESSAGE(report.converged, report.reason);
            return strand::measure(simulator, parameters);
        };
        const strand::StrandState still = run(0.0, 2), on = run(0.001, 1), back = run(-0.001, 1);
        const double rotation = on.rotation - back.rotation, strain = on.strain - back.strain;
        const double k11 = (still.force - c.k12 * still.rotation) / still.strain,
                     k21 = (still.torque - c.k22 * still.rotation) / still.strain;
        const double k12 = (on.force - back.force - c.k11 * strain) / rotation, k22 = (on.torque - back.torque) / 0.002;
        std::printf("lay %2.0f, %.0f pitches: k11 %+.2e, k12 %+.2e, k21 %+.2e, k22 %+.2e\n", c.lay_angle_deg, pitches,
                    k11 / c.k11 - 1.0, k12 / c.k12 - 1.0, k21 / c.k12 - 1.0, k22 / c.k22 - 1.0);
        const double bar =
            of == 3 && pitches < 3 ? 1e-2 : 5e-3;  // 20 degrees: 1.1e-2 with one pitch, half of it with two, a quarter with four
        for (const double error : {k11 / c.k11 - 1.0, k12 / c.k12 - 1.0, k21 / c.k12 - 1.0, k22 / c.k22 - 1.0})
            CHECK(std::abs(error) < bar);
    }
}

}  // namespace strand_test

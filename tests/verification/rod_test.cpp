// SPDX-License-Identifier: MIT
// The rod of rigid sections in the reference problems, and in contact with friction.
#include <verification/capstan_reference.hpp>
#include <verification/capstan_scene.hpp>
#include <verification/elements.hpp>

#include <fibrant/solver/fibre_block_pcg.hpp>
#include <fibrant/solver/two_level_pcg.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace rod_test {

using Model = test::EveryRod;
const double pi = std::numbers::pi;
TEST_CASE("a cantilever of rods converges with the second order at any slenderness") {
    const struct {
        double slenderness, length;
        Eigen::Vector2d tip;  // end_force.json, reissner, P L^2 / EI = 5
    } cases[] = {{20.0, 0.402, {0.28878815435132, 0.24580979130175}}, {1000.0, 20.1, {14.347246478717, 12.308662682769}}};
    for (const auto& c : cases) {
        double error[3];
        for (int k = 0; k < 3; ++k) error[k] = (test::pushed_tip<Model>(c.slenderness, 5.0, 8 << k) - c.tip).norm() / c.length;
        std::printf("L/r %g: %.2e %.2e %.2e of L, order %.2f %.2f\n", c.slenderness, error[0], error[1], error[2],
                    test::order(error[0], error[1]), test::order(error[1], error[2]));
        CHECK(error[0] < 2e-3);
        CHECK(std::abs(test::order(error[1], error[2]) - 2.0) < 0.1);
    }
}

TEST_CASE("a moment rolls a rod to the arc of a circle, whose chords the elements are") {
    // end_moment.json. Positions are on a polygon: sections turn exactly, and a chord is angle^2 / 24 too long.
    for (const Index elements : {8, 16}) {
        const double angle = 0.5 * pi / static_cast<double>(elements);
        CHECK((test::rolled_tip<Model>(0.25, elements, 2) - Eigen::Vector2d(1.2796057424588, 1.2796057424588)).norm() <
              1.1 * angle * angle / 24.0 * 1.81);
    }
}

TEST_CASE("an end that is turned by a whole turn and more closes the rod to a circle, without a force") {
    // Beyond pi the rotation vector of the end is another one of the same rotation.
    const test::ReferenceRod rod{2.01, 32};
    scene::Assembly assembly;
    assembly.add(rod.specification());
    assembly.clamp(scene::first_end(0));
    for (const auto vector : {scene::NodeVector::director_1, scene::NodeVector::director_2}) {
        scene::Hold turn;
        turn.at = scene::last_end(0), turn.vector = vector, turn.channel = "turn";
        turn.rotation = [](double amplitude) { return Mat3(Eigen::AngleAxisd(2.0 * pi * amplitude, Vec3::UnitY())); };
        assembly.hold(turn);
    }
    test::Solved<Model> solved(assembly);
    for (const double turns : {1.0, 1.25}) {
        REQUIRE(solved.run({{"turn", turns}}, 10));
        const double curvature = 2.0 * pi * turns / rod.length, angle = 2.0 * pi * turns;
        const Vec3 tip = solved.simulator.value(scene::last_end(0)),
                   circle = Vec3(1.0 - std::cos(angle), 0.0, std::sin(angle)) / curvature;
        CHECK((tip - circle).norm() < 4e-3 / curvature);  // chords: 14 degrees, (14 degrees)^2 / 24 = 2.5e-3 of the distance
        CHECK(solved.simulator.value(scene::last_end(0), scene::NodeVector::director_1).norm() < pi * (1.0 + 1e-12));
        CHECK(solved.report.energy.elastic == test::near(0.5 * rod.bending() * curvature * curvature * rod.length, 1e-9));
        CHECK(solved.report.energy.external == test::near(solved.report.energy.elastic, 1e-6));  // of a constant rate
    }
}

TEST_CASE("the 45-degree bend of rods converges with the second order to the reference") {
    const struct {
        double side, force;
        Vec3 tip;  // arc45.json
    } cases[] = {{1.0, 300.0, {58.779122489683, 22.244780945368, 40.191891670151}},
                 {1.0, 600.0, {47.150438573629, 15.684800534039, 53.474858791825}},
                 {0.1, 0.06, {47.151285842085, 15.685075385944, 53.468661045426}}};
    for (const auto& c : cases) {
        double error[3];
        for (int k = 0; k < 3; ++k) error[k] = (test::bend_tip<Model>(c.side, c.force, 8 << k) - c.tip).norm() / 100.0;
        std::printf("arc, side %g, force %g: %.2e %.2e %.2e of R, order %.2f %.2f\n", c.side, c.force, error[0], error[1],
                    error[2], test::order(error[0], error[1]), test::order(error[1], error[2]));
        CHECK(error[2] < 3e-4);
        CHECK(std::abs(test::order(error[1], error[2]) - 2.0) < 0.1);
    }
}

TEST_CASE("a stretched rod between clamps has no membrane locking") {
    const struct {
        double slenderness, strain, depth, force;  // prestretched.json, reissner
    } cases[] = {{10.0, 0.01, 0.05, 0.018638640717466},
                 {100.0, 0.0, 2.0, 0.0017101073583669},
                 {1000.0, 0.01, 2.0, 0.00074918537055306},
                 {10000.0, 0.001, 10.0, 3.7334227647816e-05}};
    for (const auto& c : cases) {
        CAPTURE(c.slenderness);
        const double coarse = std::abs(test::sideways_force<Model>(c.slenderness, c.strain, c.depth, 16) / c.force - 1.0);
        const double fine = std::abs(test::sideways_force<Model>(c.slenderness, c.strain, c.depth, 64) / c.force - 1.0);
        std::printf("L/r %g, stretch %g: %.2e %.2e with 16, 64 elements\n", c.slenderness, c.strain, coarse, fine);
        CHECK(coarse < 1.2e-2);
        CHECK(fine < 1e-3);
    }
}

TEST_CASE("a column of rods buckles and bends as the elastica does") {
    const Eigen::Vector2d column = test::buckled_column<Model>(0.10177219073636, 64);  // postbuckling_clamped_clamped_w0.1
    CHECK(column[0] == test::near(0.0023142991053129, 2e-3));
    CHECK(std::abs(column[1]) == test::near(0.402, 1e-3));
}

TEST_CASE("rods with a placed and turned end stand in space as the reference does") {
    const struct {
        Vec3 position, rotation, mid, force;  // spatial.json, placed_end_1 and 2
    } cases[] = {{{0.62, 0.86, 1.54},
                  {-0.95, 0.7, 0.3},
                  {0.19567625582788, 0.20139006978148, 0.94279591911281},
                  {-0.00014422185637306, -0.00042699749898836, -0.00070215538048704}},
                 {{0.2, -0.5, 1.93},
                  {0.5, 0.3, 1.5},
                  {0.066443691456943, -0.24022181191651, 0.97246855207853},
                  {0.0042110889237365, -0.014904423167386, 0.05225184685774}}};
    for (const auto& c : cases) {
        double error[2], force[2];
        for (int k = 0; k < 2; ++k) {
            scene::Assembly assembly;
            assembly.add(test::ReferenceRod{2.0, 32 << k}.specification());
            assembly.clamp(scene::first_end(0));
            // The position goes straight, the section turns about its own centre.
            assembly.clamp(scene::last_end(0), c.position - Vec3(0, 0, 2.0), c.rotation, Vec3(0, 0, 2.0), "end");
            test::Solved<Model> solved(assembly);
            REQUIRE(solved.run({{"end", 1.0}}, 8));
            error[k] = (solved.simulator.value({0, 0.5}) - c.mid).norm() / 2.0;
            force[k] = (solved.simulator.reaction(scene::last_end(0)) - c.force).norm() / c.force.norm();
        }
        std::printf("placed end: mid %.2e %.2e of L, force %.2e %.2e\n", error[0], error[1], force[0], force[1]);
        CHECK(error[1] < 2e-4);
        CHECK(force[1] < 2e-2);
        CHECK(test::order(error[0], error[1]) > 1.8);
    }
}

TEST_CASE("a rod under dead forces on its end and on material points of its end section stands as the reference does") {
    const double r = 0.0201;
    scene::Assembly assembly;  // spatial.json, bend_twist_dead
    test::ReferenceRod rod{5.0, 64};
    assembly.add(rod.specification());
    assembly.clamp(scene::first_end(0));
    assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(4e-05, 8e-05, -4e-05), "load"});
    assembly.apply(
        scene::DeadForce{scene::last_end(0), scene::NodeVector::director_1, 2.0 * r * Vec3(0.0, 0.004, 0.002), "load"});
    test::Solved<Model> solved(assembly);
    REQUIRE(solved.run({{"load", 1.0}}, 8));
    const Vec3 tip = solved.simulator.value(scene::last_end(0));
    const Mat3 end = core::rotation(solved.simulator.value(scene::last_end(0), scene::NodeVector::director_1));
    CHECK((tip - Vec3(-0.23373460421952, 3.0323142223333, 3.6574939250404)).norm() < 1e-3 * 5.0);
    CHECK((end.col(0) - Vec3(0.95207837514211, 0.29726769106261, 0.071963097745033)).norm() < 1e-3);
    CHECK((end.col(2) - Vec3(-0.29094373170536, 0.80767194711716, 0.51285258195833)).norm() < 1e-3);
}

TEST_CASE("a rod that is twisted by three turns counts them") {
    scene::Assembly assembly;
    assembly.add(test::ReferenceRod{2.01, 32}.specification());
    assembly.clamp(scene::first_end(0));
    assembly.clamp(scene::last_end(0), Vec3::Zero(), Vec3(0, 0, 6.0 * pi), Vec3::Zero(), "twist");
    // held straight, it does not buckle to a helix
    for (int node = 1; node < 32; ++node) assembly.hold_position({0, node / 32.0}, Vec3(1, 1, 0).asDiagonal());
    test::Solved<Model> solved(assembly);
    REQUIRE(solved.run({{"twist", 1.0}}, 12));
    const double twist = 6.0 * pi / 2.01, stiffness = 2.0 * test::ReferenceRod::bending() / 2.6;
    CHECK(solved.report.energy.elastic == test::near(0.5 * stiffness * twist * twist * 2.01, 1e-8));
    // The work of the clamp is that energy: the trapezium of 12 increments is exact for a linear torque.
    CHECK(solved.report.energy.external == test::near(solved.report.energy.elastic, 1e-6));
}

TEST_CASE("two crossed rods push each other apart as the rods of the reference do") {
    const struct {
        double length, strain, u, force;  // crossed_fibres.json, reissner
    } cases[] = {
        {1.005, 0.0, 0.0402, 0.00434436794292}, {4.02, 0.002, 0.1608, 0.00260312107061}, {1.005, 0.0, 0.1608, 0.0618080596752}};
    for (const auto& c : cases)
        for (const double angle : {90.0, 35.0}) {
            const test::Pressed pressed = test::pressed_fibres<Model>(c.length, c.strain, c.u, angle, 48);
            std::printf("crossed, L %g, stretch %g, u %g, %g degrees: error %+.2e, lost %.2e r, %td contacts\n", c.length,
                        c.strain, c.u, angle, pressed.force / c.force - 1.0, pressed.lost / 0.0201, pressed.active);
            if (angle < 90.0 && c.u > 0.1 * c.length) {
                // Here r kappa nears sin^2 (angle / 2), and the fibres touch on both sides of the middle: no force on a point any
                // more, as the reference has it.
                CHECK(std::abs(pressed.force / c.force - 1.0) < 1e-2);
                CHECK(pressed.active > 1);
                continue;
            }
            CHECK(std::abs(pressed.force / c.force - 1.0) < 2.5e-3);  // second order: 1/48^2 and a little
            CHECK(pressed.unbalance < 1e-6);
            CHECK(pressed.active == 1);
        }
}

TEST_CASE("a rod drawn half a turn around a rigid cylinder is held back as the reference says") {
    const test::CapstanScene capstan;
    const double r = capstan.fibre, R = capstan.cylinder, mu = 0.15;
    const Index elements = 96;
    const scene::Assembly assembly = capstan.assembly(test::ReferenceRod{2.0 * capstan.half, elements}.specification(), elements);
    simulation::ModelParameters<Model> parameters;
    parameters.normal.regularisation_depth = 1e-3 * r;
    parameters.contact.stiffness.allowed_penetration = 1e-2 * r;
    parameters.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};
    parameters.iteration.contact_tolerance = 2e-3;
    parameters.iteration.margin = 2.0, parameters.iteration.largest_margin = 20.0;
    test::Solved<Model> solved(assembly, parameters);
    REQUIRE(solved.run({{"ends", 1.0}}, 30));
    const auto tensions = [&] {
        return std::pair(solved.simulator.reaction(scene::first_end(0)), solved.simulator.reaction(scene::last_end(0)));
    };
    CHECK(tensions().second.norm() / tensions().first.norm() == test::near(1.0, 1e-3));
    simulation::Stage<Model> draw;
    draw.increments = 24, draw.ramps = {{"ends", 2.0}};
    draw.friction.emplace(law::RegularisedCoulomb::Parameters{mu, 0.02 * r});
    simulation::Loading<Model> loading;
    loading.stages = {draw};
    const simulation::Report report = solved.simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const auto [slack, taut] = tensions();
    const double turned = test::turned_angle(slack, taut), ratio = taut.norm() / slack.norm();
    const double expected = test::capstan_ratio({r, R, test::ReferenceRod::bending(), mu}, slack.norm(), turned);
    std::printf("capstan: ratio %.5f, %.5f expected over %.2f degrees\n", ratio, expected, turned * 180.0 / pi);
    CHECK(ratio == test::near(expected, 5e-3));  // points come on and go off the guide one by one
}

TEST_CASE("every strategy solves the tangent of touching rods, whose points have no scalar weights") {
    // Ends of the upper fibre pushed down and aside, so that friction holds sections too.
    scene::Assembly assembly;
    const double r = 0.0201;
    for (const bool upper : {false, true}) {
        scene::FibreSpecification fibre = test::ReferenceRod{1.005, 24}.specification();
        const Vec3 half = upper ? Vec3(0.5025, 0, 0) : Vec3(0, 0.5025, 0), up = upper ? Vec3(0, 0, 2.0 * r) : Vec3(Vec3::Zero());
        fibre.from = up - half, fibre.to = up + half, fibre.director = Vec3::UnitZ();
        const Index f = assembly.add(fibre);
        for (const double end : {0.0, 1.0}) assembly.clamp({f, end}, upper ? Vec3(0.001, 0.0005, -0.02) : Vec3(Vec3::Zero()));
    }
    simulation::ModelParameters<Model> parameters = test::exact_parameters<Model>();
    parameters.friction.friction_coefficient = 0.3;
    test::Solved<Model> solved(assembly, parameters);
    REQUIRE(solved.run({{"motion", 1.0}}, 4));
    REQUIRE(solved.report.contact.active == 1);
    const auto& system = solved.simulator.equilibrium().system();
    Vector b(system.layout().unknowns()), exact, product;
    for (Index k = 0; k < b.size(); ++k) b[k] = std::sin(1.0 + 3.0 * static_cast<double>(k));
    for (const scene::HeldVector& held : system.layout().held)
        b.segment<3>(3 * held.vector) = (held.free * b.segment<3>(3 * held.vector)).eval();
    const auto solve = [&](auto&& solver, Vector& x) {
        solver.analyse(system);
        REQUIRE(solver.prepare(system) == solver::SolveStatus::converged);
        const solver::SolveReport report = solver.solve(system, b, 1e-10, x);
        CHECK(report.status == solver::SolveStatus::converged);
        return report.iterations;
    };
    solve(solver::SparseCholesky{{}}, exact);
    product.resize(b.size());
    system.apply(exact, product);
    CHECK((product - b).norm() < 1e-8 * b.norm());  // the products and the terms are one matrix
    Vector x;
    solver::TwoLevelPcg::Parameters clusters;
    clusters.fibres_per_cluster = 2;
    const Index two_level = solve(solver::TwoLevelPcg{clusters}, x);
    CHECK((x - exact).norm() < 1e-5 * exact.norm());
    const Index blocks = solve(solver::FibreBlockPcg{{}}, x);
    CHECK((x - exact).norm() < 1e-5 * exact.norm());
    std::printf("iterations: %ld with rigid motions of the sections, %ld with the factors of fibres\n",
                static_cast<long>(two_level), static_cast<long>(blocks));
    CHECK(blocks < 60);
    CHECK(two_level < 60);
}

}  // namespace rod_test

// SPDX-License-Identifier: MIT
// A strand of a core and six wires, stretched and turned. Reference: the uniform state of the same rods (strand_1_6.json).
#include "stretched_strand.hpp"

#include <near.hpp>
#include <refusal.hpp>

#include <Eigen/Dense>
#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace strand_test {

/// Tension over E A strain cos^2 of a wire at a lay, on points it crosses and may not sink below: a beam under its own tension,
/// whose curvature kappa presses it on, T = E A (strain cos^2 - kappa mean sink). No helix but through kappa, no contact but the
/// points.
double tension_between_crossings(double length, double lay_angle_deg, double helix_radius, double r,
                                 const std::vector<double>& crossings, double strain) {
    const double lay = lay_angle_deg * std::numbers::pi / 180.0, c = std::cos(lay),
                 kappa = std::pow(std::sin(lay), 2) / helix_radius;
    const double EA = std::numbers::pi * r * r, EI = 0.25 * EA * r * r;  // over E
    const Index n = 120;
    const double h = length / c / static_cast<double>(n);
    Eigen::Matrix4d bending, pulling;
    bending << 12, 6 * h, -12, 6 * h, 6 * h, 4 * h * h, -6 * h, 2 * h * h, -12, -6 * h, 12, -6 * h, 6 * h, 2 * h * h, -6 * h,
        4 * h * h;
    pulling << 36, 3 * h, -36, 3 * h, 3 * h, 4 * h * h, -3 * h, -h * h, -36, -3 * h, 36, -3 * h, 3 * h, -h * h, -3 * h, 4 * h * h;
    bending *= EI / (h * h * h), pulling /= 30.0 * h;
    const Eigen::Vector4d mean = 0.5 * h * Eigen::Vector4d(1, h / 6, 1, -h / 6);
    const double full = EA * strain * c * c;
    double tension = full;
    for (int k = 0; k < 40; ++k) {
        Eigen::MatrixXd stiffness = Eigen::MatrixXd::Zero(2 * (n + 1), 2 * (n + 1));
        Vector load = Vector::Zero(2 * (n + 1)), average = load;
        for (Index i = 0; i < n; ++i) {
            stiffness.block<4, 4>(2 * i, 2 * i) += bending + tension * pulling;
            load.segment<4>(2 * i) += tension * kappa * mean, average.segment<4>(2 * i) += mean;
        }
        for (const double z : crossings) {
            const Index i = std::min(static_cast<Index>(z / c / h), n - 1);
            const double t = z / c / h - static_cast<double>(i);
            const Eigen::Vector4d shape(1 - 3 * t * t + 2 * t * t * t, h * (t - 2 * t * t + t * t * t), 3 * t * t - 2 * t * t * t,
                                        h * (t * t * t - t * t));
            stiffness.block<4, 4>(2 * i, 2 * i) += 1e4 * EI / (r * r * r) * shape * shape.transpose();
        }
        const Vector sink = stiffness.ldlt().solve(load);
        tension = 0.5 * (tension + full - EA * kappa * average.dot(sink) * c / length);
    }
    return tension / full;
}

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
        std::printf(
            "lay %2.0f: F %.8f %+.2e (%+.2e of the whole), M %.4e %+.2e, k12 %+.2e, k21 %+.2e, k22 %+.2e; middle strain %.6f, "
            "rotation %.2e, %.3f of what was imposed\n",
            c.lay_angle_deg, force, force / c.force - 1.0, stretched.force / c.force - 1.0, torque, torque / c.torque - 1.0,
            k12 / c.k12 - 1.0, k21 / c.k12 - 1.0, k22 / c.k22 - 1.0, stretched.strain, stretched.rotation, rotation / 0.004);
        CHECK(std::abs(force / c.force - 1.0) < 2e-4);
        CHECK(std::abs(stretched.force / c.force - 1.0) < 2e-4);
        CHECK(std::abs(torque / c.torque - 1.0) < 2e-3);  // k12 is a small part of what one wire has
        CHECK(std::abs(k12 / c.k12 - 1.0) < 5e-3);
        CHECK(std::abs(k21 / c.k12 - 1.0) < 5e-3);
        CHECK(std::abs(k22 / c.k22 - 1.0) < 1.5e-2);  // near the ends wires turn more than in the middle, a part of a radius far
    }
}

TEST_CASE("two layers carry E A cos^3 of each wire where they cross at short distances, and less where wires sink in between") {
    // Without Poisson's effect, and with room in each layer, nothing else takes anything off but flattened sections.
    const double r = 0.0201, lay = 12.0;
    for (const bool alternate : {true, false}) {
        strand::StrandParameters parameters = strand::regular_strand(19, r, lay, alternate);
        parameters.core_radius *= 1.05, parameters.layers[1].clearance = 0.0;
        parameters.material = {7300.0, 0.0};
        const double distance =
            std::numbers::pi / 3.0 / std::abs(parameters.turn_rate(0) - parameters.turn_rate(1));  // 6.9 and 21 radii
        parameters.length = alternate ? 40.0 * r : 1.02 * distance, parameters.elements = 16;
        const double strain = alternate ? 0.002 : 0.001;
        simulation::Simulator<Frictionless> simulator(strand::straight_strand(parameters), model(r));
        const simulation::Report report = simulator.run(to(strain, 0.0, 2));
        REQUIRE_MESSAGE(report.converged, report.reason);
        double carried[3] = {0.0, 0.0, 0.0}, full[3] = {0.0, 0.0, 0.0};  // by core and layers
        for (Index wire = 0; wire < parameters.wires(); ++wire) {
            const std::size_t layer = wire == 0 ? 0 : wire < 7 ? 1 : 2;
            const double radius = layer == 0 ? parameters.core_radius : r;
            carried[layer] += simulator.reaction(scene::last_end(wire)).z();
            full[layer] += 7300.0 * std::numbers::pi * radius * radius * strain *
                           (layer == 0 ? 1.0 : std::pow(std::cos(lay * std::numbers::pi / 180.0), 3));
        }
        double sinking = 0.0;
        for (const double phase : {0.0, 0.5}) {  // every other wire of the outer layer lies over one of the inner layer at z = 0
            std::vector<double> crossings;
            for (double z = phase * distance; z <= parameters.length; z += distance) crossings.push_back(z);
            sinking += 0.5 * tension_between_crossings(parameters.length, lay, parameters.helix_radius(1), r, crossings, strain);
        }
        const double whole = (carried[0] + carried[1] + carried[2]) / (full[0] + full[1] + full[2]);
        const double expected = (full[0] + full[1] + sinking * full[2]) / (full[0] + full[1] + full[2]);
        std::printf(
            "%s: crossings %.1f r apart; %.4f of the whole, %.4f expected; inner layer %.4f, outer %.4f, expected %.4f; %td "
            "contacts, %.1f s\n",
            alternate ? "alternating" : "one way", distance / r, whole, expected, carried[1] / full[1], carried[2] / full[2],
            sinking, report.contact.active, report.wall_seconds);
        CHECK(std::abs(carried[0] / full[0] - 1.0 - 1.5 * strain) < 1e-3);  // St Venant-Kirchhoff's law
        CHECK(std::abs(carried[1] / full[1] - 1.0) < 5e-3);
        if (alternate) CHECK(std::abs(whole / expected - 1.0) < 5e-3);
        // Far apart they sink by thirty radii times the strain, and sections at the crossings give way by two more: five
        // hundredths of what is carried.
        if (!alternate) CHECK(std::abs(carried[2] / full[2] - sinking) < 0.05);
        if (!alternate) CHECK(carried[2] < 0.75 * full[2]);
    }
}

TEST_CASE("a strand that has no room for its wires, or too few of them, is refused by name") {
    strand::StrandParameters parameters = strand_of(cases[3]);
    parameters.length = 1.0;
    parameters.core_radius = 0.0201;
    CHECK(test::refusal([&] { parameters.validate(); }).find("StrandParameters.layers[0]: gap between neighbours = -0.00") == 0);
    CHECK(test::refusal([] { strand::regular_strand(18, 0.02, 10.0, true); }) ==
          "regular_strand.wires = 18, but it must be 1 + 6 + 12 + ...: 1, 7, 19, 37, 61, 91");
    for (const Index wires : {7, 19, 37, 61, 91}) {
        strand::StrandParameters regular = strand::regular_strand(wires, 0.02, 12.0, true);
        regular.material = {7300.0, 0.3}, regular.length = 1.0;
        CHECK(regular.wires() == wires);
        CHECK_NOTHROW(regular.validate());
        CHECK(regular.core_radius < 1.1 * 0.02);
        CHECK(core::count(strand::wires_of(regular).fibres()) == wires);
        const strand::StrandParameters together = strand::regular_strand(wires, 0.02, 17.4, true, strand::Lay::equal_pitch);
        for (std::size_t k = 0; k < together.layers.size(); ++k) {
            CHECK(together.pitch(k) == test::near(together.pitch(0), 1e-9));
            CHECK(together.neighbour_gap(k) > -1e-9);
            CHECK((together.layers[k].lay_angle_deg > 0.0) == (k % 2 == 0));
        }
        CHECK(std::abs(together.layers.back().lay_angle_deg) == test::near(17.4, 1e-9));
    }
}

}  // namespace strand_test

// SPDX-License-Identifier: MIT
// Fibres inside hollow ones. References: beams side by side, the rod on a capstan, cylinders that lie in a trough, a column that
// buckles against a wall, and one that winds to a helix.
#include <contact/contact_model.hpp>
#include <near.hpp>
#include <verification/capstan_reference.hpp>

#include <fibrant/simulation/audit.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

using namespace fibrant;

namespace contact_tubes_test {

const double pi = std::numbers::pi;

using Threaded = test::EveryRod;
using Deforming = test::EveryDirector;

scene::FibreSpecification fibre(const Vec3& from, const Vec3& to, const scene::CrossSection& section, double young,
                                Index elements) {
    return {.from = from, .to = to, .section = section, .material = {young, 0.3}, .elements = elements};
}

/// @param allowed  penetration [length]
template <class M>
simulation::ModelParameters<M> parameters(double allowed, double friction = 0.0, double range = 1.0) {
    simulation::ModelParameters<M> all = test::pressed_parameters<M>(allowed);
    all.friction = {.friction_coefficient = friction, .reversible_displacement = range};
    return all;
}

/// A rod in a tube, both clamped at one end, and a force across the tube's other end. Lengths times `unit`, forces times `force`,
/// all turned.
struct Cantilevers {
    double unit = 1.0, force = 1.0;
    Mat3 turn = Mat3::Identity();
    double length = 100.0, wall = 2.0, bore = 1.5, rod = 1.4, young = 1000.0;

    double clearance() const { return (bore - rod) * unit; }
    double tube_stiffness() const {
        return 3.0 * young * 0.25 * pi * (std::pow(wall, 4) - std::pow(bore, 4)) / std::pow(length, 3);
    }
    double rod_stiffness() const { return 3.0 * young * 0.25 * pi * std::pow(rod, 4) / std::pow(length, 3); }
    /// @returns deflection of the tube at each of the loads, a load over what closes the clearance [length unit]
    std::vector<double> deflections(const std::vector<double>& loads) const {
        scene::Assembly assembly;
        const Vec3 end = unit * length * turn.col(0);
        const double modulus = young * force / (unit * unit);
        assembly.add(fibre(Vec3::Zero(), end, scene::hollow(wall * unit, bore * unit), modulus, 40));
        assembly.add(fibre(Vec3::Zero(), end, scene::circular(rod * unit), modulus, 40));
        assembly.add(scene::Tube{0, {1}});
        assembly.clamp(scene::first_end(0)), assembly.clamp(scene::first_end(1));
        const double closing = tube_stiffness() * (bore - rod) * force;
        assembly.apply(scene::DeadForce{.at = scene::last_end(0), .force = -closing * turn.col(2)});
        simulation::Simulator<Threaded> simulator(assembly, parameters<Threaded>(1e-3 * clearance()));
        std::vector<double> found;
        for (const double load : loads) {
            const simulation::Report report = simulator.run(test::stage<Threaded>({{"load", load}}, 4));
            CAPTURE(report.reason);
            REQUIRE(report.converged);
            found.push_back(-(simulator.value(scene::last_end(0)) - end).dot(turn.col(2)) / unit);
            CHECK(simulation::audit(simulator).clean());
        }
        return found;
    }
};

TEST_CASE("a tube bends alone until its clearance is closed, and with the rod inside from there on") {
    const Cantilevers scene;
    const std::vector<double> loads{0.8, 2.0, 5.0}, found = scene.deflections(loads);
    for (std::size_t k = 0; k < loads.size(); ++k) {
        const double tube = scene.tube_stiffness(), rod = scene.rod_stiffness(), c = scene.clearance(),
                     load = loads[k] * tube * c, expected = loads[k] < 1.0 ? load / tube : (load + rod * c) / (tube + rod);
        std::printf("load %.1f: deflection %.6f, %.6f expected, off by %+.1e\n", loads[k], found[k], expected,
                    found[k] / expected - 1.0);
        CHECK(found[k] == test::near(expected, 2e-3));  // shear, straight elements, and the penetration
    }
    // In other units and turned it is the same to what the iteration leaves.
    Cantilevers other;
    other.unit = 1e-3, other.force = 250.0;
    other.turn = core::rotation(Vec3(0.4, -0.7, 1.1));
    const std::vector<double> same = other.deflections(loads);
    for (std::size_t k = 0; k < loads.size(); ++k) {
        std::printf("other units, turned: off by %+.1e\n", same[k] / found[k] - 1.0);
        CHECK(same[k] == test::near(found[k], 1e-6));
    }
}

/// A rod bent to an arc like its tube, which is held all along, drawn through it against a force.
struct Drawn {
    double radius, angle, mu;
    Index elements;
    static constexpr double back = 10.0;

    Vec3 out() const { return {std::cos(angle), std::sin(angle), 0.0}; }
    template <class M>
    scene::Assembly assembly() const {
        const double r = 1.0, bore = 1.2, wall = 1.6, tail = 5.0, arc = radius * angle, whole = arc + 2.0 * tail;
        const auto place = [arc, bend = radius](double s) {  // along the arc, straight on beyond both ends
            const double on = std::clamp(s, 0.0, arc), a = on / bend, off = s - on;
            return Vec3(bend * std::sin(a) + off * std::cos(a), bend * (1.0 - std::cos(a)) + off * std::sin(a), 0.0);
        };
        scene::FibreSpecification tube, rod;
        tube.curve = [=](double t) { return place(t * arc); };
        rod.curve = [=](double t) { return place(t * whole - tail); };
        tube.section = scene::hollow(wall, bore), rod.section = scene::circular(r);
        tube.material = {1000.0, 0.3}, rod.material = {1000.0, 0.3};
        tube.elements = elements, rod.elements = elements + 2;
        scene::Assembly assembly;
        assembly.add(tube), assembly.add(rod), assembly.add(scene::Tube{0, {1}});
        const Index nodes = elements * (M::Beam::nodes - 1);
        for (Index k = 0; k <= nodes; ++k) assembly.clamp_section({0, static_cast<double>(k) / static_cast<double>(nodes)});
        assembly.apply(scene::DeadForce{.at = scene::first_end(1), .force = Vec3(-back, 0, 0)});
        scene::Hold pull;
        pull.at = scene::last_end(1), pull.directions = out() * out().transpose(), pull.displacement = out();
        assembly.hold(pull);
        assembly.hold_axial_rotation(scene::first_end(1));
        return assembly;
    }
    template <class M>
    simulation::Loading<M> loading() const {
        simulation::Loading<M> loading = test::stage<M>({{"load", 1.0}}, 4);
        loading.stages.push_back(test::stage<M>({{"motion", 1.0}}, 10).stages.front());
        loading.stages.back().friction.emplace(law::RegularisedCoulomb::Parameters{mu, 0.01});
        return loading;
    }
    /// Force at the one end over that at the other.
    template <class M>
    double ratio() const {
        const scene::Assembly scene = assembly<M>();
        simulation::Simulator<M> simulator(scene, parameters<M>(0.005, 0.0, 0.01));
        const simulation::Report report = simulator.run(loading<M>());
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        CHECK(simulation::audit(simulator).clean());
        const double found = simulator.reaction(scene::last_end(1)).dot(out()) / back;
        // Where the load is put on, the slack rod leaps to the wall, which gives energy away. While all of it slides none is
        // missing.
        const simulation::EnergyBalance &half = report.increments[report.increments.size() - 6].energy, &end = report.energy;
        const double missing = (end.error() - half.error()) / (end.external - half.external);
        std::printf(
            "radius %.0f, %ld elements: %.5f, off Euler's by %+.1e; %ld Newton, %ld cuts; energy missing %+.1e of the work\n",
            radius, static_cast<long>(elements), found, found / std::exp(mu * angle) - 1.0,
            static_cast<long>(report.counts.newton), static_cast<long>(report.rejected_increments), missing);
        CHECK(std::abs(missing) < 2e-3);  // of second order in the increment
        CHECK(end.dissipated > 0.3 * end.external);
        return found;
    }
};

struct Interruption {};
struct Interrupter {
    Index after;
    void reported(const simulation::IncrementReport& increment) const {
        if (increment.number == after) throw Interruption{};
    }
};

TEST_CASE("a rod that is drawn through a tube goes on to the same bits where it was interrupted") {
    const Drawn scene{100.0, 0.5 * pi, 0.3, 6};
    const scene::Assembly assembly = scene.assembly<Deforming>();
    const simulation::ModelParameters<Deforming> all = parameters<Deforming>(0.005, 0.0, 0.01);
    simulation::Loading<Deforming> loading = scene.loading<Deforming>();
    simulation::Simulator<Deforming> whole(assembly, all), first(assembly, all), second(assembly, all);
    REQUIRE(whole.run(loading).converged);
    const std::filesystem::path file = std::filesystem::temp_directory_path() / "fibrant_contact_tubes_test";
    std::filesystem::remove(file);
    loading.checkpoint = file.string();
    Interrupter stop{9};
    CHECK_THROWS_AS(first.run(loading, stop), Interruption);
    loading.resume = true;
    const simulation::Report resumed = second.run(loading);
    std::filesystem::remove(file);
    REQUIRE(resumed.converged);
    CHECK(second.state() == whole.state());
}

TEST_CASE("a rod drawn through a bent tube is held back by e^(mu theta), whatever the radius") {
    const double mu = 0.3, angle = 0.5 * pi, r = 1.0, clear = 0.2;
    std::vector<double> off;
    for (const double radius : {100.0, 200.0}) {
        // Friction acts a radius of the rod inside of its axis: that takes mu theta r / radius off, by the reference of the
        // capstan.
        const double expected = test::capstan_ratio({r, radius - clear - r, 1e-9, mu}, 10.0, angle);
        double before = 0.0;
        for (const Index elements : {6, 12, 24}) {
            const double found = Drawn{radius, angle, mu, elements}.ratio<Deforming>();
            std::printf("%.5f by the reference, off by %+.1e\n", expected, found / expected - 1.0);
            // The end of the wall takes what is left of friction's moment by a force of mu r / radius of the tension.
            CHECK(found == test::near(expected, mu * mu * r / radius));
            if (elements == 24) CHECK(found == test::near(before, 2e-4));  // it is that of a fine mesh
            before = found;
        }
        off.push_back(before / std::exp(mu * angle) - 1.0);
    }
    CHECK(off[1] / off[0] ==
          test::near(0.5, 0.1));  // what is not Euler's goes with r / radius, and the rest is independent of it
}

TEST_CASE("a column in a bore buckles, and presses the wall in its middle as an elastic line does between two supports") {
    const double length = 100.0, r = 1.0, bore = 1.5, young = 1000.0, clear = bore - r;
    const double bending = young * 0.25 * pi * std::pow(r, 4), euler = pi * pi * bending / (length * length), push = 2.5 * euler,
                 aside = 1e-4 * push;  // says to which side
    const Index elements = 40;
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {length, 0, 0}, scene::hollow(2.0, bore), young, elements));
    assembly.add(fibre({0, 0, 0}, {length, 0, 0}, scene::circular(r), young, elements));
    assembly.add(scene::Tube{0, {1}});
    for (Index k = 0; k <= elements; ++k) {
        const double at = static_cast<double>(k) / static_cast<double>(elements);
        assembly.clamp({0, at});
        if (k > 0 && k < elements) assembly.hold_position({1, at}, Vec3(0, 1, 0).asDiagonal());  // in a plane
    }
    assembly.hold_position({1, 0.0}), assembly.hold_position({1, 1.0}, Vec3(0, 1, 1).asDiagonal());
    assembly.hold_axial_rotation({1, 0.0});
    assembly.apply(scene::DeadForce{.at = {1, 1.0}, .force = Vec3(-push, 0, 0)});
    assembly.apply(scene::DeadForce{.at = {1, 0.5}, .force = Vec3(0, 0, -aside)});
    simulation::Simulator<Threaded> simulator(assembly, parameters<Threaded>(1e-3 * clear));
    simulation::Stage<Threaded> presses = test::stage<Threaded>({{"load", 1.0}}, 10).stages.front();
    presses.damping = 1e-3, presses.damping_decay = 0.1;
    presses.until = [](const simulation::IncrementReport& increment) { return increment.damping < 1e-12; };
    simulation::Loading<Threaded> loading;
    loading.stages = {presses};
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    double wall = 0.0;
    for (const observe::ContactSnapshot& contact : simulator.snapshot().contacts) wall += contact.reaction;
    // w = A sin k x + B x on half of it, w = clear and w' = 0 in the middle; the wall takes 2 P B.
    const double k = std::sqrt(push / bending), half = 0.5 * k * length, a = clear / (std::sin(half) - half * std::cos(half)),
                 expected = -2.0 * push * a * k * std::cos(half) + aside;
    std::printf("the wall takes %.6f, %.6f expected, off by %+.1e; %ld Newton, %ld cuts\n", wall, expected, wall / expected - 1.0,
                static_cast<long>(report.counts.newton), static_cast<long>(report.rejected_increments));
    CHECK(wall == test::near(expected, 1e-3));  // penetration of 1e-3 of the clearance, second order of slopes, shear
    CHECK(simulation::audit(simulator).clean());
}

TEST_CASE("a long column in a bore winds to a helix of the pitch and the pressure that theory says") {
    // Far from its ends a column without weight and without torque has q^2 = F / (2 E I), q its turn over its length, and presses
    // the wall by c q^2 (F - E I q^2) a length, which is c F^2 / (4 E I): A. Lubinski, W. S. Althouse, J. L. Logan, Helical
    // buckling of tubing sealed in packers, Journal of Petroleum Technology 14 (1962).
    const double r = 1.0, bore = 1.5, young = 1000.0, clear = bore - r, pitch = 120.0, length = 4.0 * pitch;
    const double bending = young * 0.25 * pi * std::pow(r, 4), turn = 2.0 * pi / pitch, push = 2.0 * bending * turn * turn;
    const Index elements = 48;
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {length, 0, 0}, scene::hollow(2.0, bore), young, elements));
    scene::FibreSpecification column = fibre({0, 0, 0}, {length, 0, 0}, scene::circular(r), young, elements);
    column.start = [=](double t) {  // a third of the way to the wall, straight at both ends
        const double x = t * length, rise = std::min(1.0, std::min(x, length - x) / (0.5 * pitch)),
                     out = 0.3 * clear * rise * rise * (3.0 - 2.0 * rise);
        return Vec3(x, out * std::cos(turn * x), out * std::sin(turn * x));
    };
    assembly.add(column);
    assembly.add(scene::Tube{0, {1}});
    for (Index k = 0; k <= elements; ++k) assembly.clamp({0, static_cast<double>(k) / static_cast<double>(elements)});
    assembly.hold_position({1, 0.0}), assembly.hold_position({1, 1.0}, Vec3(0, 1, 1).asDiagonal());
    assembly.hold_position({1, 0.5}, Vec3(0, 0, 1).asDiagonal());  // or the helix would turn as a whole
    assembly.hold_axial_rotation({1, 0.0});                        // the other end is free to: no torque
    assembly.apply(scene::DeadForce{.at = {1, 1.0}, .force = Vec3(-push, 0, 0)});
    simulation::Simulator<Deforming> simulator(assembly, parameters<Deforming>(1e-3 * clear));
    simulation::Stage<Deforming> presses = test::stage<Deforming>({{"load", 1.0}}, 8).stages.front();
    presses.damping = 1e-2, presses.damping_decay = 0.1;
    presses.until = [](const simulation::IncrementReport& increment) { return increment.damping < 1e-12; };
    simulation::Loading<Deforming> loading;
    loading.stages = {presses};
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(simulation::audit(simulator).clean());
    // What the middle third does, from the first to the last of its contacts.
    const auto middle = [=](double x) { return x > length / 3.0 && x < 2.0 * length / 3.0; };
    std::vector<std::pair<double, double>> presses_at;
    for (const observe::ContactSnapshot& contact : simulator.snapshot().contacts)
        if (contact.reaction > 0.0 && middle(contact.position.x()))
            presses_at.emplace_back(contact.position.x(), contact.reaction);
    std::sort(presses_at.begin(), presses_at.end());
    REQUIRE(presses_at.size() > 10);
    double wall = -0.5 * (presses_at.front().second + presses_at.back().second), turned = 0.0, from = 0.0, to = 0.0;
    for (const auto& [x, reaction] : presses_at) wall += reaction;
    wall /= presses_at.back().first - presses_at.front().first;
    Vec3 before = Vec3::Zero();
    for (Index k = 0; k <= 2 * elements; ++k) {
        const Vec3 at = simulator.value({1, static_cast<double>(k) / static_cast<double>(2 * elements)});
        if (!middle(at.x())) continue;
        if (before.isZero())
            from = at.x();
        else
            turned += std::atan2(before.cross(at).x(), before.tail<2>().dot(at.tail<2>()));
        before = Vec3(0.0, at.y(), at.z()), to = at.x();
    }
    const double q = std::abs(turned) / (to - from), by_turn = clear * q * q * (push - bending * q * q),
                 free = clear * push * push / (4.0 * bending);
    std::printf("turn over length off by %+.1e; the wall takes %.6f a length, off by %+.1e, by its turn by %+.1e; %ld Newton\n",
                q / turn - 1.0, wall, wall / free - 1.0, wall / by_turn - 1.0, static_cast<long>(report.counts.newton));
    // The column is 1.4e-3 shorter under its load and 4e-4 thicker, a slope of the helix is 2.6e-2.
    CHECK(q == test::near(turn, 1e-2));
    CHECK(wall == test::near(free, 1e-2));
    CHECK(wall == test::near(by_turn, 1e-2));
}

TEST_CASE("two rods in a tube lie side by side at its bottom, and press the wall and each other as cylinders in a trough") {
    const double bore = 1.5, r = 0.6, weight = 0.05;
    const Index elements = 6;
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {30, 0, 0}, scene::hollow(2.0, bore), 1000.0, elements));
    for (const double side : {-1.0, 1.0})
        assembly.add(fibre({0, side * 0.7, -0.4}, {30, side * 0.7, -0.4}, scene::circular(r), 1000.0, elements));
    assembly.add(scene::Tube{0, {1, 2}});
    for (Index k = 0; k <= elements; ++k) {
        const double at = static_cast<double>(k) / static_cast<double>(elements);
        assembly.clamp({0, at});
        for (const Index rod : {1, 2}) {
            assembly.apply(scene::DeadForce{.at = {rod, at}, .force = Vec3(0, 0, -weight)});
            if (k == 0) assembly.hold_position({rod, at}, Vec3(1, 0, 0).asDiagonal()), assembly.hold_axial_rotation({rod, at});
        }
    }
    simulation::Simulator<Threaded> simulator(assembly, parameters<Threaded>(1e-4));
    simulation::Stage<Threaded> falls = test::stage<Threaded>({{"load", 1.0}}, 10).stages.front();
    falls.damping = 0.1, falls.damping_decay = 0.1;
    falls.until = [](const simulation::IncrementReport& increment) { return increment.damping < 1e-9; };
    simulation::Loading<Threaded> loading;
    loading.stages = {falls};
    const simulation::Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(simulation::audit(simulator).clean());
    double wall = 0.0, between = 0.0;
    for (const observe::ContactSnapshot& contact : simulator.snapshot().contacts)
        (contact.fibre_i == 0 ? wall : between) += contact.reaction;
    const double slant = std::asin(r / (bore - r)), all = weight * static_cast<double>(elements + 1);
    std::printf("on the wall %.6f, %.6f expected; between the rods %.6f, %.6f expected\n", wall, 2.0 * all / std::cos(slant),
                between, all * std::tan(slant));
    CHECK(wall == test::near(2.0 * all / std::cos(slant), 1e-3));  // penetrations of 1e-4 turn the slant
    CHECK(between == test::near(all * std::tan(slant), 1e-3));
}

/// A rod whose nodes are all led across its tube.
scene::Assembly led(double start, double way) {
    scene::Assembly assembly;
    assembly.add(fibre({0, 0, 0}, {30, 0, 0}, scene::hollow(2.0, 1.5), 1000.0, 6));
    assembly.add(fibre({-5, 0, start}, {35, 0, start}, scene::circular(1.0), 1000.0, 8));
    assembly.add(scene::Tube{0, {1}});
    for (Index k = 0; k <= 6; ++k) assembly.clamp({0, static_cast<double>(k) / 6.0});
    for (Index k = 0; k <= 8; ++k) assembly.clamp({1, static_cast<double>(k) / 8.0}, {0, 0, way});
    return assembly;
}

TEST_CASE("an audit sees a rod in the wall, and no rod gets through it in silence") {
    const scene::Assembly deep = led(0.8, 0.0);
    const simulation::Simulator<Threaded> lies(deep, parameters<Threaded>(0.01));
    const simulation::Audit seen = simulation::audit(lies);
    CHECK(seen.bore_gap.gap == test::near(-0.3, 1e-9));
    CHECK(seen.bore_gap.rod == 1);
    CHECK(!seen.clean());
    // On the axis no direction is outwards, and what rounding leaves of one may lie along the tube.
    scene::Assembly centred;
    centred.add(fibre({0.1, 0.2, 0.3}, {9.7, 20.3, 30.1}, scene::hollow(2.0, 1.5), 1000.0, 7));
    centred.add(fibre({0.1, 0.2, 0.3}, {9.7, 20.3, 30.1}, scene::circular(1.0), 1000.0, 6));
    centred.add(scene::Tube{0, {1}});
    centred.clamp(scene::first_end(0)), centred.clamp(scene::first_end(1));
    CHECK(simulation::audit(simulation::Simulator<Threaded>(centred, parameters<Threaded>(0.01))).bore_gap.gap ==
          test::near(0.5, 1e-9));
    CHECK(simulation::audit(simulation::Simulator<Deforming>(centred, parameters<Deforming>(0.01))).bore_gap.gap ==
          test::near(0.5, 1e-9));
    const scene::Assembly inside = led(0.3, 0.0);
    CHECK(simulation::audit(simulation::Simulator<Threaded>(inside, parameters<Threaded>(0.01))).clean());

    for (const double way : {3.0, 6.0, 40.0})
        for (const bool soft : {false, true}) {
            const scene::Assembly pushed = led(0.0, way);
            simulation::ModelParameters<Threaded> pressed = parameters<Threaded>(0.01);
            // A penalty that lets a rod as deep as it wants: nothing but its passage is in the way.
            if (soft)
                pressed.contact.stiffness.initial_fraction = pressed.contact.stiffness.floor_fraction =
                    pressed.contact.stiffness.cap_fraction = 1e-6;
            simulation::Simulator<Threaded> simulator(pushed, pressed);
            const simulation::Report report = simulator.run(test::stage<Threaded>({{"motion", 1.0}}, 1));
            CHECK(!report.converged);
            std::printf("led by %.0f: %s; at %.3f\n", way, report.reason.c_str(), simulator.value({1, 0.5}).z());
            CHECK(simulator.value({1, 0.5}).z() < 1.5);
            if (soft) CHECK(report.reason.find("fibre 1 at ") != std::string::npos);
            if (soft) CHECK(report.reason.find("leaves through the wall of fibre 0") != std::string::npos);
        }
}

}  // namespace contact_tubes_test

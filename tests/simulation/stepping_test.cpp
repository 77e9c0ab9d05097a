// SPDX-License-Identifier: MIT
// How a loading is walked: ramps, stages, conditions; steps that are cut, restored and grown; runs that stop.
#include "refusal.hpp"
#include "simulation/scenes.hpp"

#include <near.hpp>

#include <doctest/doctest.h>

using namespace fibrant;

namespace stepping_test {

using simulation::Loading;
using simulation::Ramp;
using simulation::Report;
using simulation::Simulator;
using simulation::Stage;
using test::Crossing;
using test::Record;
using test::Rod;
using test::Rough;
using test::same_bits;
using test::Smooth;

/// Follows the amplitude of a channel.
template <simulation::Model M>
struct Amplitudes {
    const Simulator<M>* simulator;
    std::string channel;
    std::vector<double> values{};
    void reported(const simulation::IncrementReport&) { values.push_back(simulator->amplitude(channel)); }
};

/// Attempts that came to nothing.
struct Failures {
    std::vector<simulation::FailedAttempt> attempts;
    void gave_up(const simulation::FailedAttempt& attempt) { attempts.push_back(attempt); }
};

/// Where a rod comes to that is pushed by P L^2 / EI = 2 at once.
Vector undamped_state(const Rod& rod) {
    Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(simulator.run({.increments = 1}).converged);
    return simulator.state();
}

TEST_CASE("a ramp goes by equal steps or by equal factors, and a channel without a ramp stays") {
    const Rod rod;
    scene::Assembly assembly = rod.pushed(1.0);
    assembly.apply(scene::DeadForce{scene::last_end(0), {}, Vec3(0, 1e-5, 0), "side"});
    Simulator<Smooth> simulator(assembly, test::model_parameters<Smooth>(rod.radius));
    Amplitudes<Smooth> load{&simulator, "load"}, side{&simulator, "side"};
    Loading<Smooth> loading;
    loading.stages = {{.name = "up", .increments = 4, .ramps = {{"load", 2.0}}},
                      {.name = "down", .increments = 3, .ramps = {{"load", 0.016, true}, {"side", -1.0}}},
                      {.name = "off", .increments = 1, .ramps = {{"load", 0.0}}}};
    const Report report = simulator.run(loading, load, side);
    REQUIRE(report.converged);
    const std::vector<double> expected_load{0.5, 1.0, 1.5, 2.0, 0.4, 0.08, 0.016, 0.0};  // factor 1/5 three times
    const std::vector<double> expected_side{0, 0, 0, 0, -1.0 / 3.0, -2.0 / 3.0, -1.0, -1.0};
    REQUIRE(load.values.size() == 8);
    for (std::size_t k = 0; k < 8; ++k) {
        CHECK(load.values[k] == test::near(expected_load[k], 1e-12));
        CHECK(side.values[k] == test::near(expected_side[k], 1e-12));
        CHECK(report.increments[k].stage == (k < 4 ? "up" : k < 7 ? "down" : "off"));
        CHECK(report.increments[k].number == static_cast<Index>(k) + 1);
    }
    CHECK(report.increments[1].stage_progress == 0.5);
    CHECK(report.increments[1].progress == test::near(2.0 / 8.0, 1e-15));  // of 4 + 3 + 1 increments
    CHECK(report.increments[4].progress == test::near(5.0 / 8.0, 1e-15));
    CHECK(report.increments.back().progress == 1.0);
    // Elastic, and nothing remembers: what is left is the side load's small deflection P L^3 / 3 EI.
    const Vec3 tip = simulator.value(scene::last_end(0));
    CHECK(std::abs(tip.x()) < 1e-5 * rod.length);
    CHECK(tip.y() == test::near(-1e-5 * std::pow(rod.length, 3) / (3.0 * rod.bending_stiffness()), 1e-2));
}

TEST_CASE("a stage that goes on until it is at rest counts as the mean of those whose increments are known") {
    std::vector<Stage<Smooth>> stages(3);
    stages[0].increments = 4, stages[1].increments = 1, stages[2].increments = 100;
    stages[1].until = simulation::until_settled(1.0, 1.0);
    CHECK(simulation::part_done(stages, 0, 1.0) == test::near(4.0 / 156.0, 1e-15));
    CHECK(simulation::part_done(stages, 1, 1.0) == test::near(56.0 / 156.0, 1e-15));
    CHECK(simulation::part_done(stages, 2, 0.5) == test::near(106.0 / 156.0, 1e-15));
    CHECK(simulation::part_done(stages, 2, 1.0) == 1.0);
    for (Stage<Smooth>& stage : stages) stage.until = simulation::until_settled(1.0, 1.0);
    CHECK(simulation::part_done(stages, 1, 0.5) == test::near(0.5, 1e-15));  // nothing is known: all alike
}

TEST_CASE("without stages all channels go to 1 together") {
    const Rod rod;
    Simulator<Smooth> simulator(rod.pushed(0.5), test::model_parameters<Smooth>(rod.radius));
    Amplitudes<Smooth> load{&simulator, "load"};
    CHECK(simulator.run({.increments = 4}, load).converged);
    CHECK(load.values == std::vector<double>{0.25, 0.5, 0.75, 1.0});
}

TEST_CASE("a second run goes on where the first one ended") {
    const Rod rod;
    Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    Loading<Smooth> half, whole;
    half.stages = {{.increments = 1, .ramps = {{"load", 0.5}}}};
    whole.stages = {{.increments = 1, .ramps = {{"load", 1.0}}}};
    REQUIRE(simulator.run(half).converged);
    CHECK(simulator.amplitude("load") == 0.5);
    REQUIRE(simulator.run(whole).converged);
    Simulator<Smooth> direct(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(direct.run(whole).converged);
    CHECK((simulator.state() - direct.state()).cwiseAbs().maxCoeff() < 1e-8);
}

TEST_CASE("damping that decays slows a fibre down and leaves no force on it, and what it took is in the balance") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    const Vector undamped = undamped_state(rod);
    Loading<Smooth> loading;
    loading.stages = {{.increments = 1,
                       .ramps = {{"load", 1.0}},
                       .damping = stiffness,
                       .damping_decay = 0.5,
                       .until = simulation::until_settled(1e-3 * rod.radius, 0.0)}};
    Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    Record<Smooth> record(simulator);
    const Report report = simulator.run(loading, record);
    REQUIRE(report.converged);
    CHECK(report.increments.size() >= 10);                                  // ten halvings until there is none
    for (const simulation::IncrementReport& increment : report.increments)  // all but the last tell that the stage goes on
        CHECK(increment.waits == (increment.number < core::count(report.increments)));
    CHECK(record.states.front().isApprox(undamped, 1e-2) == false);
    CHECK((simulator.state() - undamped).cwiseAbs().maxCoeff() < 1e-7);
    // The load does F u, the fibre keeps about half of it, and the damping takes the rest; 12 increments by the trapezoidal rule.
    CHECK(report.energy.damped > 0.1 * report.energy.external);
    CHECK(std::abs(report.energy.error()) < 0.03 * report.energy.external);
    // Damping that does not decay holds the fibre where it stops creeping, short of the equilibrium.
    loading.stages[0].damping_decay = 1.0;
    loading.stages[0].damping = 300.0 * stiffness;
    loading.stages[0].until = simulation::until_settled(1e-2 * rod.length, 0.0);
    Simulator<Smooth> held(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(held.run(loading).converged);
    CHECK((held.state() - undamped).cwiseAbs().maxCoeff() > 1e-2 * rod.length);
}

TEST_CASE("damping is not lowered while fibres still move far, and where they come to rest is the same") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    const Vector undamped = undamped_state(rod);
    Loading<Smooth> loading;
    loading.stages = {{.increments = 1,
                       .ramps = {{"load", 1.0}},
                       .damping = stiffness,
                       .damping_decay = 0.5,
                       .damping_calm = 0.02 * rod.length,
                       .until = simulation::until_settled(1e-3 * rod.radius, 0.0)}};
    Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    const Report report = simulator.run(loading);
    REQUIRE(report.converged);
    // What is left falls by a constant factor while damping stays, and damping falls in ten halvings.
    Index far = 0;
    for (const simulation::IncrementReport& increment : report.increments)
        far += increment.displacement > 0.02 * rod.length ? 1 : 0;
    CHECK(far >= 2);
    CHECK(core::count(report.increments) >= far + 10);
    CHECK((simulator.state() - undamped).cwiseAbs().maxCoeff() < 1e-7);
    // Without a condition a stage ends with its ramps, damped as it is.
    loading.stages[0].until = {};
    Simulator<Smooth> once(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    const Report short_report = once.run(loading);
    REQUIRE(short_report.converged);
    CHECK(short_report.increments.size() == 1);
}

TEST_CASE("damping that is steered to a pace lets a fibre creep evenly to where it leaps to if damping is halved") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    const Vector undamped = undamped_state(rod);
    Loading<Smooth> loading;
    const double pace = 0.05 * rod.length;
    loading.stages = {{.increments = 1,
                       .ramps = {{"load", 1.0}},
                       .damping = 6.0 * stiffness,
                       .damping_decay = 0.5,
                       .until = simulation::until_settled(1e-3 * rod.radius, 0.0)}};
    const auto greatest = [&](double steered) {
        loading.stages[0].damping_pace = steered;
        Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
        const Report report = simulator.run(loading);
        REQUIRE(report.converged);
        CHECK((simulator.state() - undamped).cwiseAbs().maxCoeff() < 1e-7);
        double most = 0.0;
        Index even = 0;
        for (const simulation::IncrementReport& increment : report.increments) {
            most = std::max(most, increment.displacement);
            even += increment.displacement > 0.8 * pace && increment.displacement < 1.2 * pace ? 1 : 0;
        }
        if (steered > 0.0) CHECK(even >= 5);
        return most;
    };
    // Motion grows by no more than damping falls, so an increment overshoots only where the fibre becomes softer meanwhile.
    CHECK(greatest(pace) < 1.2 * pace);
    CHECK(greatest(0.0) > 1.5 * pace);
}

TEST_CASE("springs that are steered to a pace go on below a thousandth of what they were, and do not vanish and come back") {
    // An increment moves as far as the pace under 1e-4 of the springs: what moves in proportion to their inverse comes there.
    constexpr double pace = 0.5, at_pace = 1e-4;
    const auto greatest = [&](double steered) {
        const Stage<Smooth> stage{
            .damping = 1.0, .damping_decay = 0.5, .damping_pace = steered, .until = [](const auto&) { return false; }};
        simulation::Position position;
        position.progress = 1.0;
        double most = 0.0;
        for (Index k = 0; k < 30; ++k) {
            if (position.damping == 0.0) return std::numeric_limits<double>::infinity();  // nothing holds it
            simulation::IncrementReport increment;
            increment.displacement = pace * at_pace / position.damping;
            most = std::max(most, increment.displacement);
            simulation::HalvedSteps().adapt_damping(position, stage, increment, 0.1);
        }
        return most;
    };
    CHECK(greatest(pace) == test::near(pace, 1e-12));
    CHECK(std::isinf(greatest(0.0)));
}

TEST_CASE("what has moved far is solved as loosely as a path is until it is at rest, and what a stage ends with never is") {
    Stage<Smooth> rest{.damping_calm = 0.1, .looseness = 5.0, .looseness_on_the_way = 100.0, .exact_end = true};
    simulation::Position position;
    simulation::IncrementReport far, near;
    far.displacement = 0.2, near.displacement = 0.05, far.use.residual = near.use.residual = 20.0;
    CHECK_FALSE(position.ends(rest, false, near));
    CHECK(position.looseness(rest) == 5.0);
    CHECK_FALSE(position.ends(rest, false, far));  // it leaps
    CHECK(position.looseness(rest) == 100.0);
    CHECK_FALSE(position.ends(rest, false, near));  // and goes on to where it leaps to
    CHECK(position.looseness(rest) == 100.0);
    CHECK_FALSE(position.ends(rest, true, near));  // there, be its forces small: asked for again, exactly
    CHECK(position.looseness(rest) == 1.0);
    CHECK_FALSE(position.ends(rest, false, near));  // it moves on all the same, by little: as exactly
    CHECK(position.looseness(rest) == 1.0);
    CHECK_FALSE(position.ends(rest, false, far));  // and leaps again
    CHECK(position.looseness(rest) == 100.0);
    CHECK_FALSE(position.ends(rest, true, near));
    CHECK(position.looseness(rest) == 1.0);
    CHECK(position.ends(rest, true, near));
    // Where damping waits, three loose increments in a row settle, whatever moves in one of them, and an exact one does.
    rest.damping_waits = true, rest.damping_share = 1e-4;
    position = {};
    near.damping = 0.9e-4, near.residual = 1.1e-4;
    for (const Index row : {1, 2, 3}) {
        CHECK_FALSE(position.ends(rest, true, near));
        CHECK(position.exact == (row == 3));
    }
    CHECK(position.ends(rest, true, near));
    // So does a loose one of which all that forces miss is as little as damping may hold.
    position = {};
    near.residual = 0.9e-4;
    CHECK_FALSE(position.ends(rest, true, near));
    CHECK(position.exact);
    near.damping = 1.1e-4, near.residual = 1.1e-4;
    position = {.within = 2};
    CHECK_FALSE(position.ends(rest, true, near));
    CHECK(position.within == 0);
    CHECK_FALSE(position.exact);
    rest.damping_waits = false;
    // What never comes to rest is not followed loosely for ever.
    position = {.in_stage = rest.most_increments / 2};
    CHECK_FALSE(position.ends(rest, false, far));
    CHECK(position.looseness(rest) == 5.0);
    rest.looseness = 1000.0, position.on_its_way = true;
    CHECK(position.looseness(rest) == 1000.0);
    // What is solved exactly and turns out not to be at rest goes on loosely, if it still moves.
    rest.looseness = 5.0, rest.damping_still = 0.02;
    position = {.exact = true};
    CHECK_FALSE(position.ends(rest, false, near));
    CHECK(position.looseness(rest) == 100.0);
    near.displacement = 0.01;
    position = {.exact = true};
    CHECK_FALSE(position.ends(rest, false, near));
    CHECK(position.looseness(rest) == 1.0);
}

TEST_CASE("increments are passes of one iteration where they are solved loosely, loads stand, and no order parts fibres") {
    Stage<Smooth> stage{.looseness = 10.0};
    simulation::Position position{.progress = 1.0};
    CHECK(position.iterates(stage));
    position.progress = 0.5;
    CHECK_FALSE(position.iterates(stage));
    position.progress = 1.0, position.exact = true;
    CHECK_FALSE(position.iterates(stage));
    position.exact = false, stage.forced_orders = true;
    CHECK_FALSE(position.iterates(stage));
}

TEST_CASE("damping that waits neither falls nor ends a stage after an increment whose forces balance far worse than it holds") {
    Stage<Smooth> stage{.damping = 1.0,
                        .damping_decay = 0.5,
                        .damping_share = 1e-4,
                        .damping_waits = true,
                        .damping_still = 0.02,
                        .until = [](const simulation::IncrementReport&) { return true; }};
    const simulation::HalvedSteps steps;
    simulation::IncrementReport increment;
    increment.displacement = 0.1, increment.damping = 5e-4;
    const auto next = [&](double residual, double damping = 1.0) {  // of a tolerance of 1e-4
        increment.residual = residual, increment.use.residual = residual / 1e-4;
        simulation::Position position;
        position.progress = 1.0, position.damping = damping;
        steps.adapt_damping(position, stage, increment, 0.2);
        return position.damping;
    };
    CHECK(next(4.9e-3) == 0.5);
    CHECK(next(5.1e-3) == 1.0);
    stage.damping_waits = false;
    CHECK(next(5.1e-3) == 0.5);
    stage.damping_waits = true;
    increment.displacement = 0.01;  // hardly any
    CHECK(next(5.1e-3) == 0.5);
    increment.displacement = 0.1, increment.damping = 0.9e-4;
    next(0.9e-3);
    CHECK_FALSE(stage.held(increment));
    next(1.1e-3);  // against what may be held at the end
    CHECK(stage.held(increment));
    // What is nearly little enough stays: the next increments bring it below.
    increment.damping = 1.4e-4;
    CHECK(next(1e-4) == 1.0);
    increment.damping = 1.6e-4;
    CHECK(next(1e-4) == 0.5);
    // Less than half of it lets damping rise, unless forces balance badly, or all is at rest but for the count of increments.
    increment.damping = 0.4e-4;
    CHECK(next(0.9e-3) == 1.0);
    stage.until = [](const simulation::IncrementReport&) { return false; };
    CHECK(next(0.9e-3) == 2.0);
    // Softer than a thousandth it rises by as much, not to there; what has none begins there.
    CHECK(next(0.9e-3, 1e-4) == 2e-4);
    CHECK(next(0.9e-3, 0.0) == 1e-3);
    CHECK(next(1.1e-3) == 1.0);
    // What balances as well as is stated does, however little damping holds.
    stage.damping_share = increment.damping = 1e-7;
    next(0.9e-4);
    CHECK_FALSE(stage.held(increment));
}

TEST_CASE(
    "damping that is carried along does not hold back what is driven steadily, to or fro, and what is not driven it holds") {
    const Rod rod;
    const double step = 0.1 * rod.radius, stiffness = rod.tip_stiffness();
    scene::Assembly assembly;
    assembly.clamp(scene::first_end(assembly.add(rod.specification())), Vec3(0, step, 0), Vec3::Zero(), Vec3::Zero(), "drag");
    assembly.apply(scene::DeadForce{scene::last_end(0), {}, Vec3(0.1 * stiffness * step, 0, 0), "load"});
    struct Drag {
        const Simulator<Smooth>* simulator;
        std::vector<double> forces{}, shares{};
        void reported(const simulation::IncrementReport& increment) {
            forces.push_back(simulator->reaction(scene::first_end(0)).y()), shares.push_back(increment.damping);
        }
    };
    std::vector<Drag> drags;
    Loading<Smooth> loading;
    loading.stages = {{.increments = 4, .ramps = {{"drag", 4.0}}},
                      {.increments = 4, .ramps = {{"drag", 0.0}}},
                      {.increments = 1, .ramps = {{"load", 1.0}}}};
    for (const bool carried : {false, true}) {
        for (Stage<Smooth>& stage : loading.stages) stage.damping = 1e-4 * stiffness, stage.damping_carried = carried;
        Simulator<Smooth> simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
        drags.push_back({&simulator});
        REQUIRE(simulator.run(loading, drags.back()).converged);
    }
    // Each of the nodes is held by the damping times its motion; it bends the fibre by a part of a thousandth of that.
    const double whole = 1e-4 * stiffness * step * static_cast<double>(2 * rod.elements + 1);
    for (std::size_t k = 0; k < 8; ++k) {
        const double sign = k < 4 ? 1.0 : -1.0;
        CHECK(drags[0].forces[k] == test::near(sign * whole, 5e-3));
        CHECK(std::abs(drags[1].forces[k]) < 5e-3 * whole);  // nor the first, of which nothing was known: it is solved twice
    }
    // The other channel bends the fibre; of that, (3 L s^2 - s^3) / 2 L^3 of the tip's motion, a square of s leaves less than a
    // thirtieth.
    CHECK(drags[1].shares[8] < drags[0].shares[8] / 30.0);
}

TEST_CASE("damping that is carried along holds what moves otherwise than its group") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness(),
                 load = 0.01 * stiffness * rod.radius;  // of the tip
    scene::Assembly assembly;
    for (const double beside : {-1.0, 0.0, 1.0}) {  // sums and slopes of 1, -2 and 1 are nothing
        scene::FibreSpecification fibre = rod.specification();
        fibre.from += Vec3(0, 0.1 * beside * rod.length, 0), fibre.to += Vec3(0, 0.1 * beside * rod.length, 0);
        const Index of = assembly.add(fibre);
        assembly.clamp(scene::first_end(of));
        assembly.apply(scene::DeadForce{scene::last_end(of), {}, Vec3((beside == 0.0 ? -2.0 : 1.0) * load, 0, 0), "load"});
    }
    std::vector<Record<Smooth>> records;
    Loading<Smooth> loading;
    loading.stages = {{.increments = 3, .ramps = {{"load", 3.0}}}};
    for (const bool carried : {false, true}) {
        loading.stages[0].damping = stiffness, loading.stages[0].damping_carried = carried;
        Simulator<Smooth> simulator(assembly, test::tight_parameters<Smooth>(rod.radius));
        records.emplace_back(simulator);
        REQUIRE(simulator.run(loading, records.back()).converged);
    }
    for (std::size_t k = 0; k < 3; ++k) {
        CHECK(records[0].increments[k].damping > 0.02);
        CHECK(records[1].increments[k].damping == test::near(records[0].increments[k].damping, 1e-3));
    }
}

TEST_CASE("a mean motion foretells how a long group bends, whichever way it lies") {
    Rod rod;
    const beam::Mesh<Smooth::Beam> mesh(rod.clamped(), Smooth::Beam(test::model_parameters<Smooth>(rod.radius).beam));
    const auto bent = [&](const Vector& state, double part) {
        Vector result = state;
        for (Index a = 0; a < mesh.node_count(0); ++a) {
            const Vec3 x = state.segment<3>(3 * mesh.node_vector(0, a));
            result.segment<3>(3 * mesh.node_vector(0, a)) +=
                part * 1e-3 * Vec3(0.1 * x.z() * x.z() - 0.2 * x.z(), 0.3 - 0.05 * x.z() * x.z(), 0);
        }
        return result;
    };
    simulation::MeanMotion motion(mesh, 1);
    CHECK(!motion.foretells({1.0}));
    const Vector before = mesh.rest_state(), after = bent(before, 1.0);
    motion.learn(mesh, before, after, {1.0});
    CHECK(motion.foretells({0.1}));
    CHECK(!motion.foretells({-0.1}));
    for (const double part : {1.0, 0.5, -1.0})
        CHECK((motion.ahead(mesh, after, {part}) - bent(after, part)).cwiseAbs().maxCoeff() < 1e-12);
    // A last bit is added to what was known: half of that and it. The group's axis has turned by a part of a thousandth
    // meanwhile.
    const Vector further = bent(after, 0.02);
    motion.learn(mesh, after, further, {0.02});
    CHECK((motion.ahead(mesh, further, {0.52}) - bent(further, 0.52)).cwiseAbs().maxCoeff() < 1e-7);
}

TEST_CASE("a mean motion foretells a rigid or affine motion exactly, and in part when channels change by less") {
    const Crossing crossing;
    const scene::Assembly assembly = crossing.assembly();
    const beam::Mesh<Smooth::Beam> mesh(assembly, Smooth::Beam(test::model_parameters<Smooth>(crossing.radius).beam));
    Mat3 map = Mat3::Identity();
    map << 0.9, 0.2, 0.1, -0.3, 1.1, 0.0, 0.05, -0.1, 1.2;
    const Vec3 shift(0.3, -0.2, 0.1);
    const auto moved = [&](const Vector& state, double part) {
        Vector result = state;
        for (Index f = 0; f < mesh.fibre_count(); ++f)
            for (Index a = 0; a < mesh.node_count(f); ++a) {
                const Vec3 x = state.segment<3>(3 * mesh.node_vector(f, a));
                result.segment<3>(3 * mesh.node_vector(f, a)) = x + part * (map * x + shift - x);
            }
        return result;
    };
    simulation::MeanMotion motion(mesh, 2);
    const Vector before = mesh.rest_state(), after = moved(before, 1.0);
    CHECK(same_bits(motion.ahead(mesh, after, {1.0, 0.0}), after));  // nothing has been learnt
    motion.learn(mesh, before, after, {0.5, 0.0});
    const double rounding = 1e-10;  // the fibres lie apart by a twenty-fifth of their length, which the fit squares
    for (const double part : {1.0, 0.25, -1.0})
        CHECK((motion.ahead(mesh, after, {0.5 * part, 0.0}) - moved(after, part)).cwiseAbs().maxCoeff() < rounding);
    CHECK((motion.ahead(mesh, after, {50.0, 0.0}) - moved(after, 2.0)).cwiseAbs().maxCoeff() <
          rounding);  // it is not trusted further
    CHECK(same_bits(motion.ahead(mesh, after, {0.0, 1.0}), after));
    // A last bit the same way does not make it forget, and one to the other side does.
    const Vector further = moved(after, 0.02);
    motion.learn(mesh, after, further, {0.01, 0.0});
    CHECK((motion.ahead(mesh, further, {-0.5, 0.0}) - moved(further, -1.0)).cwiseAbs().maxCoeff() < rounding);
    motion.learn(mesh, after, further, {-0.01, 0.0});
    CHECK((motion.ahead(mesh, further, {-0.01, 0.0}) - moved(further, 0.02)).cwiseAbs().maxCoeff() < rounding);
}

TEST_CASE("a stage may end while its damping holds no more than a share of the forces, and the next one goes on from there") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    Simulator<Smooth> direct(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(direct.run({.increments = 1}).converged);
    const auto always = [](const simulation::IncrementReport&) { return true; };
    Loading<Smooth> loading;
    loading.stages = {{.name = "early",
                       .increments = 1,
                       .ramps = {{"load", 1.0}},
                       .damping = stiffness,
                       .damping_decay = 0.5,
                       .damping_share = 0.01,
                       .until = always},
                      {.name = "late",
                       .increments = 1,
                       .damping = stiffness,
                       .damping_goes_on = true,
                       .damping_decay = 0.5,
                       .damping_share = 1e-6,
                       .until = always}};
    Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
    const Report report = simulator.run(loading);
    REQUIRE(report.converged);
    std::size_t early = 0;
    while (report.increments[early].stage == "early") ++early;
    CHECK(report.increments[early - 2].damping > 0.01);
    CHECK(report.increments[early - 1].damping <= 0.01);
    CHECK(report.increments.back().damping <= 1e-6);
    // Had the damping started anew, the first late increment would be held by about as much as the last early one.
    CHECK(report.increments[early].damping < 0.6 * report.increments[early - 1].damping);
    // Held by a millionth of the load, the fibre is short of equilibrium by about a millionth of its displacement.
    const double sag = std::abs(direct.value(scene::last_end(0)).y()) + std::abs(direct.value(scene::last_end(0)).z());
    CHECK((simulator.state() - direct.state()).cwiseAbs().maxCoeff() < 1e-4 * (sag + rod.length));
}

TEST_CASE(
    "damping that waits rises where forces balance and what a stage waits for is not there yet, and holds no more than it may") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness(), share = 0.05;
    const auto run = [&](bool waits) {
        Loading<Smooth> loading;
        loading.stages = {
            {.increments = 1,
             .ramps = {{"load", 1.0}},
             .damping = stiffness,
             .damping_decay = 0.5,
             .damping_share = share,
             .damping_waits = waits,
             .until = [&](const simulation::IncrementReport& increment) { return increment.displacement <= 1e-4 * rod.length; }}};
        Simulator<Smooth> simulator(rod.pushed(2.0), test::tight_parameters<Smooth>(rod.radius));
        return simulator.run(loading);
    };
    const Report waiting = run(true), falling = run(false);
    REQUIRE(waiting.converged);
    REQUIRE(falling.converged);
    Index rises = 0;
    for (std::size_t k = 1; k < waiting.increments.size(); ++k) {
        const simulation::IncrementReport &before = waiting.increments[k - 1], &now = waiting.increments[k];
        CHECK(now.springs == (before.damping < 0.5 * share ? 2.0 : before.damping <= 1.5 * share ? 1.0 : 0.5) * before.springs);
        rises += before.damping < 0.5 * share ? 1 : 0;
    }
    CHECK(rises > 0);
    for (std::size_t k = 1; k < falling.increments.size(); ++k)
        CHECK(falling.increments[k].springs < falling.increments[k - 1].springs);
    CHECK(waiting.increments.back().damping <= share);
}

TEST_CASE("an increment that moves further than its stage allows is cut") {
    const Rod rod;
    Loading<Smooth> loading;
    loading.stages = {{.increments = 1, .ramps = {{"load", 1.0}}}};
    Simulator<Smooth> free(rod.pushed(2.0), test::model_parameters<Smooth>(rod.radius));
    const Report whole = free.run(loading);
    REQUIRE(whole.converged);
    const double most = 0.6 * whole.increments[0].displacement;
    loading.stages[0].largest_displacement = most;
    Simulator<Smooth> bounded(rod.pushed(2.0), test::model_parameters<Smooth>(rod.radius));
    const Report report = bounded.run(loading);
    REQUIRE(report.converged);
    CHECK(report.rejected_increments > 0);
    for (const simulation::IncrementReport& increment : report.increments) CHECK(increment.displacement <= most);
    CHECK((bounded.state() - free.state()).cwiseAbs().maxCoeff() < 1e-3 * rod.length);
}

TEST_CASE("one fibre of many that goes too far is held alone: increments stay, and the others do not notice") {
    const Rod rod;
    const double stiffness = rod.tip_stiffness();
    Loading<Smooth> loading;
    loading.stages = {{.name = "push",
                       .increments = 4,
                       .ramps = {{"load", 1.0}},
                       .damping = 1e-3 * stiffness,
                       .largest_displacement = 0.02 * rod.length},
                      {.name = "rest",
                       .increments = 1,
                       .damping = 1e-3 * stiffness,
                       .damping_goes_on = true,
                       .damping_decay = 0.5,
                       .largest_displacement = 0.02 * rod.length,
                       .until = simulation::until_settled(1e-4 * rod.radius, 0.0)}};
    const double push =
        0.1;  // each tip goes by a thirtieth of the length, and that of the soft one by tenfold if nothing holds it
    Simulator<Smooth> alone(rod.row(push), test::tight_parameters<Smooth>(rod.radius));
    Record<Smooth> calm(alone);
    REQUIRE(alone.run(loading, calm).converged);
    Simulator<Smooth> both(rod.row(push, 10.0), test::tight_parameters<Smooth>(rod.radius));
    Record<Smooth> record(both);
    const Report report = both.run(loading, record);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(report.rejected_increments > 0);
    const Index first = alone.state().size();
    for (std::size_t k = 0; k < 4; ++k) {
        CHECK(record.increments[k].stage == "push");
        CHECK(record.increments[k].fraction == 1.0);
        CHECK(record.increments[k].displacement <= 0.02 * rod.length);
        CHECK(record.increments[k].springs == 1.0);
        CHECK((record.states[k].head(first) - calm.states[k]).cwiseAbs().maxCoeff() < 1e-9 * rod.length);
    }
    CHECK(record.increments[4].stage == "rest");
    CHECK(record.increments[0].hardest_springs >= 4.0);  // of the fibre that is held alone; the others' are those of the stage
    CHECK(calm.increments[0].hardest_springs == 1.0);
    // In the end nothing holds the soft one either: a thirtieth of the length tenfold, as far as large deflections let it.
    Simulator<Smooth> direct(rod.row(push, 10.0), test::tight_parameters<Smooth>(rod.radius));
    REQUIRE(direct.run({.increments = 1}).converged);
    CHECK(direct.value(scene::last_end(11)).x() > 0.25 * rod.length);
    CHECK((both.state() - direct.state()).cwiseAbs().maxCoeff() < 1e-6 * rod.length);
    // Of twelve that are alike all go too far: the increment is made smaller, as ever.
    Simulator<Smooth> all(rod.row(10.0 * push), test::tight_parameters<Smooth>(rod.radius));
    Record<Smooth> cut(all);
    loading.stages[0].most_increments = 400, loading.stages[1].most_increments = 400;
    REQUIRE(all.run(loading, cut).converged);
    CHECK(cut.increments[0].fraction < 1.0);
    CHECK(cut.increments[0].springs >= 4.0);
}

TEST_CASE("what is driven further than the last increment moved is found by the first search all the same") {
    // Both fibres move by two radii aside, far beyond the least reach of a search, after an increment in which they were at rest.
    Crossing crossing;
    crossing.drag = 8.0 * crossing.radius;
    scene::Assembly assembly;
    const scene::Assembly still = crossing.assembly();
    for (const scene::FibreSpecification& fibre : still.fibres()) assembly.add(fibre);
    for (const Index f : {Index{0}, Index{1}})
        for (const double end : {0.0, 1.0})
            assembly.clamp({f, end}, Vec3(crossing.drag, 0, 0), Vec3::Zero(), Vec3::Zero(), "drag");
    auto parameters = test::model_parameters<Smooth>(crossing.radius);
    parameters.iteration.largest_margin = 8.0;
    Loading<Smooth> loading;
    loading.stages = {{.name = "rest", .increments = 1}, {.name = "drag", .increments = 4, .ramps = {{"drag", 1.0}}}};
    Simulator<Smooth> simulator(assembly, parameters);
    const Report report = simulator.run(loading);
    REQUIRE(report.converged);
    CHECK(report.rejected_increments == 0);
    for (std::size_t k = 1; k < report.increments.size(); ++k) {
        CHECK(report.increments[k].displacement == test::near(2.0 * crossing.radius, 1e-2));
        CHECK(report.increments[k].counts.contact_passes <= 2);  // one that moves them, one that finds nothing else to do
    }
}

TEST_CASE("a stage may allow more penetration than the model, and the next one takes it back at the same force") {
    const Crossing crossing;
    const double allowed = 1e-2 * crossing.radius;
    Loading<Smooth> loading;
    loading.stages = {{.name = "soft", .increments = 8, .ramps = {{"approach", 1.0}}, .allowed_penetration = 8.0 * allowed},
                      {.name = "stiff", .increments = 1, .until = simulation::until_settled(1e-4 * crossing.radius, allowed)}};
    Simulator<Smooth> simulator(crossing.assembly(), test::tight_parameters<Smooth>(crossing.radius));
    const Report report = simulator.run(loading);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    const double soft = report.increments[7].contact.greatest_penetration, stiff = report.contact.greatest_penetration;
    CHECK(soft > 2.0 * allowed);
    CHECK(soft < 8.0 * allowed);
    CHECK(stiff <= allowed);
    CHECK(stiff > 0.2 * allowed);
    // The fibres' supports are a spring in series: what contact gives way less they bend more, by part of the approach.
    const double more = (soft - stiff) / crossing.approach;
    CHECK(report.contact.reaction_sum > report.increments[7].contact.reaction_sum);
    CHECK(report.contact.reaction_sum < report.increments[7].contact.reaction_sum * (1.0 + 2.0 * more));
}

TEST_CASE("a stage with a condition goes on at constant loads until it holds") {
    const Rod rod;
    Simulator<Smooth> simulator(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    Record<Smooth> record(simulator);
    int asked = 0;
    Loading<Smooth> loading;
    loading.stages = {
        {.name = "wait",
         .increments = 2,
         .ramps = {{"load", 1.0}},
         .until = [&](const simulation::IncrementReport& increment) { return ++asked == 4 && increment.number == 5; }},
        {.name = "then", .increments = 1, .ramps = {{"load", 0.5}}}};
    const Report report = simulator.run(loading, record);
    REQUIRE(report.converged);
    CHECK(report.increments.size() == 6);  // two of the ramp; asked at its end and after three more
    CHECK(report.increments[4].stage == "wait");
    CHECK(report.increments[5].stage == "then");
    // Where nothing changes nothing moves, up to the tolerance of the step.
    CHECK(report.increments[4].displacement < 1e-4 * rod.radius);
}

TEST_CASE("a condition that never holds ends the run with a reason") {
    const Rod rod;
    Simulator<Smooth> simulator(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    Loading<Smooth> loading;
    loading.stages = {{.name = "wait", .increments = 1, .until = [](const auto&) { return false; }, .most_increments = 3}};
    const Report report = simulator.run(loading);
    CHECK(!report.converged);
    CHECK(report.reason == "stage wait did not reach its end in 3 increments");
    CHECK(report.increments.size() == 3);
    // Enough is enough, where a stage says so: of what goes on for ever.
    loading.stages[0].enough_increments = 2;
    Simulator<Smooth> patient(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    const Report enough = patient.run(loading);
    CHECK(enough.converged);
    CHECK(enough.increments.size() == 2);
}

TEST_CASE("a step too large is cut, and goes on from the same bits as if it had not been tried") {
    Crossing crossing;
    crossing.approach = 20.0 * crossing.radius;
    crossing.drag = 0.1 * crossing.radius;
    simulation::ModelParameters<Rough> parameters = test::model_parameters<Rough>(crossing.radius);
    parameters.iteration.newton_limit = 2;                 // too few for ten radii at once
    parameters.contact.places = contact::Places::renewed;  // else the increment is tried in another way first
    const auto stage = [](double to) { return Stage<Rough>{.increments = 1, .ramps = {{"approach", to}, {"drag", to}}}; };
    Simulator<Rough> cut(crossing.assembly(), parameters), direct(crossing.assembly(), parameters);
    Record<Rough> cut_record(cut), direct_record(direct);
    Amplitudes<Rough> reached{&cut, "approach"};
    Loading<Rough> large, accepted;
    large.audited = accepted.audited = false;       // what is mended at the end would be an increment more
    large.stages = {stage(0.0625), stage(0.5625)};  // in contact when the large step comes
    Failures failures;
    const Report report = cut.run(large, cut_record, reached, failures);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    REQUIRE(report.rejected_increments > 0);
    REQUIRE(report.increments[0].cuts == 0);
    CHECK(report.increments[0].contact.active > 0);
    CHECK(report.increments[1].cuts == report.rejected_increments);
    CHECK(report.increments[1].fraction == std::pow(0.5, report.rejected_increments));
    REQUIRE(core::count(failures.attempts) == report.rejected_increments);
    Index wasted = 0;
    for (std::size_t k = 0; k < failures.attempts.size(); ++k) {
        const simulation::FailedAttempt& attempt = failures.attempts[k];
        CHECK(attempt.number == 2);
        CHECK(attempt.attempts == static_cast<Index>(k) + 1);
        CHECK(attempt.fraction == std::pow(0.5, static_cast<double>(k)));
        CHECK(!attempt.reason.empty());
        wasted += attempt.newton;
    }
    CHECK(wasted > 0);
    CHECK(wasted < report.increments[1].counts.newton);
    for (const double amplitude : reached.values) accepted.stages.push_back(stage(amplitude));  // exact in binary
    const Report again = direct.run(accepted, direct_record);
    REQUIRE(again.converged);
    CHECK(again.rejected_increments == 0);
    REQUIRE(direct_record.states.size() == cut_record.states.size());
    for (std::size_t k = 0; k < cut_record.states.size(); ++k) CHECK(same_bits(cut_record.states[k], direct_record.states[k]));
}

TEST_CASE("after a cut the steps grow back to their size") {
    const Rod rod;
    simulation::ModelParameters<Smooth> parameters = test::model_parameters<Smooth>(rod.radius);
    parameters.iteration.newton_limit = 6;  // too few for the first steps
    Simulator<Smooth> simulator(rod.pushed(40.0), parameters);
    const Report report = simulator.run({.increments = 8});
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    REQUIRE(report.rejected_increments > 0);
    double sum = 0.0;
    for (std::size_t k = 0; k < report.increments.size(); ++k) {
        const simulation::IncrementReport& now = report.increments[k];
        sum += now.fraction / 8.0;
        if (k == 0) continue;
        const double before = report.increments[k - 1].fraction;
        if (now.cuts == 0) {
            CHECK((now.fraction == before || now.fraction == std::min(1.0, 1.5 * before)));
        } else {
            CHECK(now.fraction <= 0.75 * before);
        }
    }
    CHECK(report.increments.back().fraction > report.increments.front().fraction);
    CHECK(sum >= 1.0 - 1e-12);  // the last one may be shorter than its fraction says
    CHECK(report.increments.back().stage_progress == 1.0);
}

TEST_CASE("a run that does not converge reports why, with figures, and keeps the last accepted state") {
    const Rod rod;
    simulation::ModelParameters<Smooth> parameters = test::model_parameters<Smooth>(rod.radius);
    parameters.iteration.newton_limit = 1;
    Simulator<Smooth> simulator(rod.pushed(5.0), parameters);
    Report report;
    CHECK_NOTHROW(report = simulator.run({.increments = 2}));
    CHECK(!report.converged);
    CHECK(report.increments.empty());
    CHECK(report.rejected_increments == 9);  // fractions 1, 1/2 ... 1/256
    CHECK(report.counts.newton == 9);
    INFO(report.reason);
    CHECK(report.reason.starts_with("stage loading, increment 1: Newton did not converge after 1 iterations, residual "));
    CHECK(report.reason.find(", step ") != std::string::npos);
    CHECK(same_bits(simulator.state(), simulator.mesh().rest_state()));
    CHECK(simulator.amplitude("load") == 0.0);
}

TEST_CASE("where Newton ends because the tangent is indefinite, the report says so, and which fibre gives way where") {
    const Rod rod;  // clamped, pressed along itself by several times what buckles it, and no iterations to find a way out
    const double critical = std::pow(0.5 * std::numbers::pi / rod.length, 2) * rod.bending_stiffness();
    const auto pressed = [&](double times) {
        scene::Assembly assembly = rod.clamped();
        assembly.apply(scene::DeadForce{scene::last_end(0), {}, Vec3(1e-3 * critical, 0.0, -times * critical), "load"});
        simulation::ModelParameters<Smooth> parameters = test::model_parameters<Smooth>(rod.radius);
        parameters.iteration.newton_limit = 3, parameters.iteration.mixed = false;
        Simulator<Smooth> simulator(assembly, parameters);
        return simulator.run({.increments = 1, .smallest_fraction = 0.9});
    };
    const Report report = pressed(4.0);
    INFO(report.reason);
    CHECK(!report.converged);
    CHECK(report.reason.find("; the tangent was not positive definite in ") != std::string::npos);
    CHECK(report.reason.find(" of 3 iterations, fibre 0 moves most, at 1 of its length") != std::string::npos);
}

TEST_CASE("a fibre that nothing holds cannot carry a load: a report, not an exception") {
    Rod rod;
    scene::Assembly assembly;
    assembly.add(rod.specification());
    assembly.apply(scene::DeadForce{scene::last_end(0), {}, Vec3(1e-3, 0, 0), "load"});
    Simulator<Smooth> simulator(assembly, test::model_parameters<Smooth>(rod.radius));
    Report report;
    CHECK_NOTHROW(report = simulator.run({.increments = 1}));
    CHECK(!report.converged);
    CHECK(!report.reason.empty());
    CHECK(simulator.state().allFinite());
}

TEST_CASE("a loading that cannot be walked is refused before any work") {
    const Rod rod;
    Simulator<Smooth> simulator(rod.pushed(1.0), test::model_parameters<Smooth>(rod.radius));
    const auto refused = [&](const Loading<Smooth>& loading) { return test::refusal([&] { simulator.run(loading); }); };
    Loading<Smooth> loading;
    loading.stages = {{.ramps = {{"lod", 1.0}}}};
    CHECK(refused(loading) == "channel = lod, but it must be one that the scene uses (load, motion)");
    CHECK(refused({.increments = 0}) == "Loading.increments = 0, but it must be >= 1");
    CHECK(refused({.smallest_fraction = 2.0}).starts_with("Loading.smallest_fraction = 2,"));
    CHECK(refused({.growth = 1.0}) == "Loading.growth = 1, but it must be > 1");
    loading.stages = {{.increments = 0}};
    CHECK(refused(loading) == "Stage.increments = 0, but it must be >= 1");
    loading.stages = {{.increments = 5, .most_increments = 4}};
    CHECK(refused(loading) == "Stage.most_increments = 4, but it must be >= 5");
    loading.stages = {{.ramps = {{"load", core::unset}}}};
    CHECK(refused(loading) == "Ramp.to = nan, but it must be finite");
    loading.stages = {{.looseness = 0.5}};
    CHECK(refused(loading).starts_with("Stage.looseness = 0.5,"));
    loading.stages = {{.looseness_on_the_way = 2e4}};
    CHECK(refused(loading).starts_with("Stage.looseness_on_the_way = 20000,"));
    loading.stages = {{.allowed_penetration = 0.0}};
    CHECK(refused(loading) == "Stage.allowed_penetration = 0, but it must be finite and > 0");
    loading.stages = {{.damping_calm = 0.0}};
    CHECK(refused(loading) == "Stage.damping_calm = 0, but it must be > 0");
    loading.stages = {{.damping_share = -1.0}};
    CHECK(refused(loading).starts_with("Stage.damping_share = -1,"));
    loading.stages = {{.largest_displacement = 0.0}};
    CHECK(refused(loading) == "Stage.largest_displacement = 0, but it must be > 0");
    loading.stages = {{.ramps = {{"load", 0.5, true}}}};  // from 0: no factor leads there
    CHECK(refused(loading).starts_with("Ramp.to = 0.5, but it must be > 0, from an amplitude > 0"));
    loading.stages = {{.increments = 1, .ramps = {{"load", 0.5}}}, {.ramps = {{"load", -0.1, true}}}};
    CHECK(refused(loading).starts_with("Ramp.to = -0.1,"));
    CHECK(same_bits(simulator.state(), simulator.mesh().rest_state()));
}

TEST_CASE("scenes and parameters that cannot be run are refused by the simulator, by name") {
    const Rod rod;
    const auto refused = [](const scene::Assembly& assembly, const simulation::ModelParameters<Rough>& parameters) {
        return test::refusal([&] { Simulator<Rough>(assembly, parameters); });
    };
    const simulation::ModelParameters<Rough> good = test::model_parameters<Rough>(rod.radius);
    CHECK(refused(rod.clamped(), good).empty());
    CHECK(refused(scene::Assembly{}, good) == "assembly.fibres = none, but it must be at least one fibre");
    simulation::ModelParameters<Rough> bad = good;
    bad.normal = {};
    CHECK(refused(rod.clamped(), bad) == "RegularisedPenalty.regularisation_depth = nan, but it must be finite and > 0");
    bad = good, bad.friction.friction_coefficient = -0.1;
    CHECK(refused(rod.clamped(), bad).starts_with("RegularisedCoulomb.friction_coefficient = -0.1,"));
    bad = good, bad.contact.stiffness = {};
    CHECK(refused(rod.clamped(), bad).starts_with("StiffnessAdaptation.allowed_penetration = nan,"));
    bad = good, bad.iteration.step_tolerance = -1.0;
    CHECK(refused(rod.clamped(), bad).starts_with("IterationParameters.step_tolerance = -1,"));
    bad = good, bad.beam.shear_factor = 0.0;
    CHECK(refused(rod.clamped(), bad).starts_with("DirectorBeam.shear_factor = 0,"));
}

}  // namespace stepping_test

// SPDX-License-Identifier: MIT
// An overhand knot in a straight rod, against the theory of loose knots (overhand_knot.json) with its next term: F R^2 / (E I) =
// 1/2 + (3 sigma / pi) (r / R)^1/2, R the length that the knot takes up over 2 pi; and what friction adds to the pull.
#include <fibrant/compositions/knot/overhand_knot.hpp>

#include <near.hpp>
#include <refusal.hpp>
#include <support/models.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

using namespace fibrant;

namespace overhand_knot_test {

namespace knot = compositions::knot;

using Knotted = test::EveryDirector;
const double r = 0.0201;

knot::KnotParameters tied(double slenderness, Index elements, int crossings = 3) {
    const double R = r / slenderness;
    return {
        .radius = r, .loop_radius = R, .tail = 3.0 * R, .crossings = crossings, .material = {7300.0, 0.3}, .elements = elements};
}

simulation::ModelParameters<Knotted> model(const knot::KnotParameters& parameters) {
    simulation::ModelParameters<Knotted> all = test::direct_parameters<Knotted>();
    all.normal = {.regularisation_depth = 1e-3 * r};
    all.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.02 * r};  // none, but where a stage sets it
    all.contact.stiffness.allowed_penetration = 1e-2 * r;
    all.contact.stiffness.initial_fraction = knot::initial_stiffness_fraction(parameters);
    all.contact.stiffness.floor_fraction = 1e-6;
    all.contact.detection.self_contact = true;
    all.iteration.newton_limit = 30;
    return all;
}

/// A spring of about a hundredth of the loop's own stiffness in all, taken away as it comes to rest.
simulation::Loading<Knotted> settling(const knot::KnotParameters& parameters) {
    simulation::Stage<Knotted> stage;
    stage.name = "settle";
    stage.increments = 2;
    stage.damping = 10.0 * 0.25 * 7300.0 * std::numbers::pi * r * r * r * r / std::pow(parameters.loop_radius, 3) /
                    static_cast<double>(parameters.elements);
    stage.damping_decay = 0.5, stage.damping_share = 1e-3;
    stage.until = simulation::until_settled(0.05 * r, 0.02 * r);
    stage.most_increments = 80;
    simulation::Loading<Knotted> loading;
    loading.stages = {stage};
    return loading;
}

struct Knot {
    knot::KnotParameters parameters;
    simulation::Simulator<Knotted> simulator;
    explicit Knot(const knot::KnotParameters& p) : parameters{p}, simulator{knot::tied_rod(p), model(p)} {}
    knot::KnotState run(const simulation::Loading<Knotted>& loading) {
        const simulation::Report report = simulator.run(loading);
        REQUIRE_MESSAGE(report.converged, report.reason);
        CHECK(report.contact.active > 10);  // or it has come undone
        CHECK(report.contact.greatest_penetration < 0.02 * r);
        const knot::KnotState state = knot::measure(simulator, parameters);
        const double bending = 0.25 * 7300.0 * std::numbers::pi * r * r * r * r, R = state.shortening / (2.0 * std::numbers::pi);
        std::printf(
            "r/R %.5f: F R^2 / EI %.5f (theory %.5f), contact force %.4f (0.4923 in the limit), virial %.1e, imbalance %.1e, %td "
            "contacts, %td increments, %.1f s\n",
            r / R, state.force * R * R / bending, knot::loose_force(3, r / R),
            state.contact_force * std::sqrt(r) * std::pow(R, 1.5) / bending, state.virial, state.imbalance, report.contact.active,
            core::count(report.increments), report.wall_seconds);
        return state;
    }
};

/// A knot that both of the theories below look at, settled once.
struct LooseKnot {
    Knot knot{tied(0.01, 240)};
    knot::KnotState state = knot.run(settling(knot.parameters));
};
LooseKnot& loose_knot() {
    static LooseKnot loose;
    return loose;
}

TEST_CASE("a rod is tied without being stretched, and nothing of it is nearer than a diameter to the rest") {
    for (const int crossings : {3, 5}) {
        const knot::KnotParameters parameters = tied(0.01, 200, crossings);
        const knot::TiedShape shape(parameters);
        const auto frames = scene::reference_frames(shape, 4001);
        double nearest = 1.0;
        for (std::size_t i = 0; i < frames.size(); i += 2)
            for (std::size_t j = i + 60; j < frames.size(); j += 2)
                nearest = std::min(nearest, (frames[i].position - frames[j].position).norm());
        std::printf("%d crossings: nearest %.4f r\n", crossings, nearest / r);
        CHECK(nearest > 1.9 * r);  // strands lean in the braid
        CHECK((shape(1.0) - shape(0.0)).normalized().x() == test::near(1.0, 1e-5));
    }
    knot::KnotParameters parameters = tied(0.1, 200);
    CHECK(test::refusal([&] { parameters.validate(); }).find("KnotParameters.loop_radius = 0.201, but it must be > 20 radii") ==
          0);
    // Of fifteen crossings the strands would begin a third of a radius in each other there.
    parameters = tied(2.0, 200), parameters.crossings = 15, parameters.loop_radius = 50.0 * parameters.radius;
    const std::string told = "KnotParameters.loop_radius = 1.005, but it must be > 20 radii, and > 5.6 radii for each crossing";
    CHECK(test::refusal([&] { parameters.validate(); }).find(told) == 0);
}

TEST_CASE("a loose overhand knot pulls and presses as the theory says, the better the thinner the rod") {
    double last_error = 0.0, last_sigma = 0.0, last_root = 0.0;
    for (const bool thin : {false, true}) {
        const knot::KnotParameters parameters = tied(0.005, 320);
        const knot::KnotState state = thin ? Knot(parameters).run(settling(parameters)) : loose_knot().state;
        const double bending = 0.25 * 7300.0 * std::numbers::pi * r * r * r * r, R = state.shortening / (2.0 * std::numbers::pi),
                     root = std::sqrt(r / R);
        // What is left is of the order of (r / R): 2.4 of it at either radius. The knot is not known any better in closed form.
        const double error = state.force * R * R / bending / knot::loose_force(3, r / R) - 1.0;
        CHECK(std::abs(error) < 3.0 * r / R);
        // Exact, at whatever r / R, but for damping that is left, flattened sections, and curvature by differences.
        CHECK(std::abs(state.virial) < 3e-3);
        CHECK(state.imbalance < 5e-3);
        // Contact forces have the next term in the root, too: a line through both knots meets the theory where the root is 0.
        const double sigma = state.contact_force * std::sqrt(r) * std::pow(R, 1.5) / bending;
        if (last_root > 0.0) {
            const double limit = sigma - (last_sigma - sigma) / (last_root - root) * root;
            std::printf("contact force in the limit %.4f\n", limit);
            CHECK(std::abs(limit / 0.4923009124 - 1.0) < 0.1);    // what is of the second order in the root bends that line
            CHECK(std::abs(error) < 0.6 * std::abs(last_error));  // with r / R, or faster
        }
        last_error = error, last_sigma = sigma, last_root = root;
    }
}

TEST_CASE("friction adds mu times the contact force to the pull that tightens a knot, and takes it off the one that loosens it") {
    Knot& rough = loose_knot().knot;
    const knot::KnotState smooth = loose_knot().state;
    const double mu = 0.05;
    const auto drawn = [&](double to, Index increments) {
        simulation::Stage<Knotted> stage;
        stage.friction.emplace(law::RegularisedCoulomb::Parameters{mu, 0.02 * r});
        stage.ramps = {{knot::draw, to}}, stage.increments = increments, stage.most_increments = 60;
        stage.damping = 1e-3 * settling(rough.parameters).stages[0].damping;
        simulation::Loading<Knotted> loading;
        loading.stages = {stage};
        return rough.run(loading);
    };
    // Every contact has to slide, which the loop's own give delays by about a radius; the knot hardly changes by that.
    const knot::KnotState tight = drawn(1.0 * r, 10), loosened = drawn(-1.0 * r, 16);
    const double added = 0.5 * (tight.force - loosened.force),
                 expected = 0.5 * mu * (tight.contact_force + loosened.contact_force);
    std::printf("friction: pull %.6f, %.6f, %.6f; half of the difference over mu P %.4f\n", loosened.force, smooth.force,
                tight.force, added / expected);
    // Strands slide along each other by what is drawn out, less what goes into the braid's turning: of the order of (r / R)^1/2
    // mu.
    CHECK(std::abs(added / expected - 1.0) < 0.03);
    CHECK(std::abs(0.5 * (tight.force + loosened.force) / smooth.force - 1.0) < 0.06);  // friction moves the contacts a little
}

}  // namespace overhand_knot_test

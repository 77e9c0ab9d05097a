// SPDX-License-Identifier: MIT
// An overhand knot in a straight, frictionless rod, against the theory of loose knots (overhand_knot.json): the pull F and the
// length e that the knot takes up obey F e^2 / (E I) = 2 pi^2, but for terms of the order of (r / R)^1/2.
#include <fibrant/beam/director_beam.hpp>
#include <fibrant/compositions/knot/overhand_knot.hpp>
#include <fibrant/law/frictionless.hpp>
#include <fibrant/law/regularised_penalty.hpp>
#include <fibrant/proximity/grid_search.hpp>
#include <fibrant/solver/sparse_cholesky.hpp>

#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>

using namespace fibrant;
namespace knot = compositions::knot;

namespace {

struct Frictionless {
    using Beam = beam::DirectorBeam<3>;
    using Proximity = proximity::GridSearch;
    using Normal = law::RegularisedPenalty;
    using Friction = law::Frictionless;
    using Solver = solver::SparseCholesky;
};
const double r = 0.0201;

knot::KnotParameters tied(double slenderness, Index elements, int crossings = 3) {
    const double R = r / slenderness;
    return {.radius = r, .loop_radius = R, .tail = 3.0 * R, .crossings = crossings, .material = {7300.0, 0.3}, .elements = elements};
}

simulation::ModelParameters<Frictionless> model(const knot::KnotParameters& parameters) {
    simulation::ModelParameters<Frictionless> all;
    all.normal = {.regularisation_depth = 1e-3 * r};
    all.contact.stiffness.allowed_penetration = 1e-2 * r;
    all.contact.stiffness.initial_fraction = knot::initial_stiffness_fraction(parameters);
    all.contact.stiffness.floor_fraction = 1e-6;
    all.contact.detection.self_contact = true;
    all.iteration.newton_limit = 30;
    return all;
}

/// A spring of about a hundredth of the loop's own stiffness in all, taken away as it comes to rest.
simulation::Loading<Frictionless> settling(const knot::KnotParameters& parameters) {
    simulation::Stage<Frictionless> stage;
    stage.name = "settle";
    stage.increments = 2;
    stage.damping = 10.0 * 0.25 * 7300.0 * std::numbers::pi * r * r * r * r / std::pow(parameters.loop_radius, 3) / static_cast<double>(parameters.elements);
    stage.damping_decay = 0.5, stage.damping_share = 1e-3;
    stage.until = simulation::until_settled(0.05 * r, 0.02 * r);
    stage.most_increments = 80;
    simulation::Loading<Frictionless> loading;
    loading.stages = {stage};
    return loading;
}

}  // namespace

TEST_CASE("a rod is tied without being stretched, and nothing of it is nearer than a diameter to the rest") {
    for (const int crossings : {3, 5}) {
        const knot::KnotParameters parameters = tied(0.01, 200, crossings);
        const knot::TiedShape shape(parameters);
        const auto frames = scene::reference_frames(shape, 4001);
        double nearest = 1.0;
        for (std::size_t i = 0; i < frames.size(); i += 2)
            for (std::size_t j = i + 60; j < frames.size(); j += 2) nearest = std::min(nearest, (frames[i].position - frames[j].position).norm());
        std::printf("%d crossings: nearest %.4f r\n", crossings, nearest / r);
        CHECK(nearest > 1.9 * r);  // strands lean in the braid
        CHECK((shape(1.0) - shape(0.0)).normalized().x() == doctest::Approx(1.0));
    }
    knot::KnotParameters parameters = tied(0.1, 200);
    CHECK(test::refusal([&] { parameters.validate(); }).find("KnotParameters.loop_radius = 0.201, but it must be > 20 radii") == 0);
}

TEST_CASE("the pull of a loose overhand knot goes to that of the theory as the rod gets thinner") {
    double last_error = 0.0, last_root = 0.0;
    for (const double slenderness : {0.01, 0.005}) {
        const knot::KnotParameters parameters = tied(slenderness, slenderness > 0.007 ? 240 : 320);
        simulation::Simulator<Frictionless> simulator(knot::tied_rod(parameters), model(parameters));
        const simulation::Report report = simulator.run(settling(parameters));
        REQUIRE_MESSAGE(report.converged, report.reason);
        const knot::KnotState state = knot::measure(simulator, parameters);
        const double bending = 0.25 * 7300.0 * std::numbers::pi * r * r * r * r, R = state.shortening / (2.0 * std::numbers::pi);
        const double error = 2.0 * state.force * R * R / bending - 1.0, root = std::sqrt(r / R);
        std::printf("r/R %.5f: F R^2 / EI %.5f, %+.1f %%, contact force %.4f (0.4923 in the limit), imbalance %.1e, %td contacts, %td increments, %.1f s\n", r / R,
                    0.5 * (1.0 + error), 100.0 * error, state.contact_force * std::sqrt(r) * std::pow(R, 1.5) / bending, state.imbalance, report.contact.active,
                    core::count(report.increments), report.wall_seconds);
        CHECK(report.contact.active > 10);  // or it has come undone
        CHECK(report.contact.greatest_penetration < 0.02 * r);
        CHECK(state.imbalance < 5e-3);  // exact, at whatever r / R, but for the rest of the damping and curvature by differences
        CHECK(std::abs(error) < 1.4 * root);
        if (last_root > 0.0) {
            const double limit = error - (last_error - error) / (last_root - root) * root;
            std::printf("in the limit %+.1f %%\n", 100.0 * limit);
            CHECK(std::abs(error) < 0.75 * std::abs(last_error));  // as the root, or faster
            CHECK(std::abs(limit) < 0.05);
        }
        last_error = error, last_root = root;
    }
}

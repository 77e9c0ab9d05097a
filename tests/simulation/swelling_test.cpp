// SPDX-License-Identifier: MIT
#include <doctest/doctest.h>

#include "../../examples/tow/stack.hpp"

#include <fibrant/simulation/audit.hpp>

#include <near.hpp>
#include <support/models.hpp>

#include <cmath>
#include <numbers>
#include <utility>

using namespace fibrant;

namespace swelling_test {

using Stack = test::EveryDirector;
constexpr double pi = std::numbers::pi, radius = 0.02, compression = 0.02, depth = 1e-3 * radius;
constexpr Index fibres = 4, elements = 2;
const scene::ElasticMaterial material{7300.0, 0.2};

/// Pressed by a fiftieth of its height. @param slenderness  length of an element over the radius
scene::Assembly stack(double slenderness) {
    return example::stacked(fibres, radius, slenderness * radius * elements, elements, material,
                            compression * 2.0 * radius * fibres);
}

struct Pressed {
    double load_over_closed;  // q 2 r = A S_22 for opposite line loads on a section that stays an ellipse
    simulation::Audit audit;
};
Pressed press(double slenderness) {
    auto parameters = test::direct_parameters<Stack>();
    parameters.normal.regularisation_depth = 0.5 * depth;
    parameters.friction = {.friction_coefficient = 0.2, .reversible_displacement = 0.02 * radius};
    parameters.contact.stiffness.allowed_penetration = depth, parameters.contact.stiffness.cap_fraction = 1e3;
    simulation::Simulator<Stack> simulator(stack(slenderness), parameters);
    simulation::Loading<Stack> loading;
    simulation::Stage<Stack> stage;
    stage.name = "press", stage.increments = 5, stage.most_increments = 100, stage.ramps = {{"press", 1.0}};
    stage.damping = 1e-3 * material.section_modulus() * slenderness * radius, stage.damping_decay = 0.1;
    loading.stages = {stage};
    REQUIRE(simulator.run(loading).converged);
    const double load = simulator.contacts().tools().reaction(1).force.y() / (slenderness * radius * elements);
    return {load / (0.5 * pi * material.section_modulus() * radius * compression), simulation::audit(simulator)};
}

TEST_CASE("a pressed stack whose sections swell and shrink in turn bears too little, and the audit says so by how much they do") {
    const Pressed fine = press(8.0), coarse = press(40.0);
    // What contacts give way, and Green's strain for a change of height, are some per cent.
    CHECK(fine.load_over_closed == test::near(1.0, 0.06));
    CHECK_FALSE(fine.audit.swelling.exceeds(fine.audit.allowed));
    // Sections that bear nothing are shorter by e^2 / 2 on average where they swell by most, and by less elsewhere.
    CHECK(coarse.load_over_closed < 0.2);
    CHECK(coarse.audit.clean());
    CHECK(coarse.audit.swelling.exceeds(coarse.audit.allowed));
    CHECK(0.5 * coarse.audit.swelling.strain * coarse.audit.swelling.strain > compression);
    CHECK(coarse.audit.swelling.strain < 0.5);  // where a section would be flat
}

TEST_CASE("of section strains the part is found that Gauss points do not see, whatever bears it and however it is turned") {
    const double strain = 0.07, bearing = -0.03;
    for (const double tilt : {0.0, 0.4, 1.3}) {
        observe::Snapshot shot;
        for (const bool swells : {false, true}) {
            observe::FibreSnapshot fibre;
            fibre.section = scene::circular(radius);
            for (int node = 0; node < 5; ++node) {
                // (2, -1, 2) times half of it in the second element; the first one has all of the same bearing strain.
                const double own = !swells || node < 2 ? 0.0 : node == 3 ? -0.5 * strain : strain;
                const Vec3 stretched(std::sqrt(1.0 + 2.0 * (bearing + own)), 1.0, 1.0);  // along x
                fibre.position.emplace_back(0, 0, 0.1 * node);
                fibre.director_1.push_back(Vec3(std::cos(tilt), std::sin(tilt), 0).cwiseProduct(stretched));
                fibre.director_2.push_back(Vec3(-std::sin(tilt), std::cos(tilt), 0).cwiseProduct(stretched));
            }
            shot.fibres.push_back(std::move(fibre));
        }
        const observe::Swelling found = observe::greatest_swelling(shot);
        CHECK(found.fibre == 1);
        CHECK(found.element == 1);
        CHECK(found.strain == test::near(strain));
        CHECK(found.approach() == test::near(strain * strain * radius));
    }
}

}  // namespace swelling_test

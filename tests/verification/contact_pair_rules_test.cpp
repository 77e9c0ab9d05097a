// SPDX-License-Identifier: MIT
// A fibre drawn through three pairs of others with three coefficients of friction, by rules for pairs of groups: what the
// supports hold is Coulomb's law, pair by pair.
#include <contact/contact_model.hpp>

#include <near.hpp>

#include <doctest/doctest.h>

#include <array>
#include <cmath>
#include <cstdio>

using namespace fibrant;

namespace contact_pair_rules_test {

using test::Rough;

const double r = 0.02, mu = 0.2, range = 0.02 * r, allowed = 1e-2 * r;

/// Two fibres that squeeze the drawn one at one place along it.
struct Place {
    const char* name;
    double at;                            ///< [length]
    double friction, penetration;         ///< factors that hold there, by the rules of the scene
    std::array<Index, 2> fibres{-1, -1};  ///< below, above
};

TEST_CASE(
    "a fibre drawn through pairs of others is held back by the friction that the rules give to each, and each is as deep as they "
    "allow") {
    std::array places{Place{"no rule", -0.25, 1.0, 1.0}, Place{"rule of the outer group", 0.0, 0.5, 2.0},
                      Place{"rule of the inner group", 0.25, 2.0, 4.0}};
    scene::Assembly assembly;
    const Index passing = assembly.add_group("passing"), other = assembly.add_group("other"), outer = assembly.add_group("outer"),
                inner = assembly.add_group("inner", outer);
    assembly.add(scene::PairRule{passing, outer, 0.5, 2.0});
    assembly.add(scene::PairRule{inner, passing, 2.0, 4.0});  // in the other order
    assembly.add(scene::PairRule{outer, other, 7.0, 7.0});    // of fibres that do not meet
    auto specification = test::straight_fibre({-0.5, 0, 0}, {0.5, 0, 0}, r, 21);
    specification.group = passing;
    const Index drawn = assembly.add(specification);
    assembly.clamp(scene::first_end(drawn), Vec3(range, 0, 0), Vec3::Zero(), Vec3::Zero(), "draw");
    const std::array groups{other, outer, inner};
    for (std::size_t k = 0; k < places.size(); ++k)
        for (const std::size_t above : {std::size_t{0}, std::size_t{1}}) {
            const double side = above == 1 ? 1.0 : -1.0;
            specification = test::straight_fibre({places[k].at, -0.3, side * 2.0 * r}, {places[k].at, 0.3, side * 2.0 * r}, r, 7);
            specification.group = groups[k];
            places[k].fibres[above] = assembly.add(specification);
            for (const double end : {0.0, 1.0})
                assembly.clamp({places[k].fibres[above], end}, Vec3(0, 0, -side * 0.5 * r), Vec3::Zero(), Vec3::Zero(),
                               "squeeze");
        }
    simulation::ModelParameters<Rough> parameters = test::pressed_parameters<Rough>(allowed);
    parameters.friction = {.friction_coefficient = mu, .reversible_displacement = range};
    simulation::Simulator<Rough> simulator(assembly, parameters);
    const simulation::Report squeezed = simulator.run(test::stage<Rough>({{"squeeze", 1.0}}, 8));
    REQUIRE_MESSAGE(squeezed.converged, squeezed.reason);
    const auto support = [&](Index fibre) {
        return Vec3(simulator.reaction(scene::first_end(fibre)) + simulator.reaction(scene::last_end(fibre)));
    };
    for (const double to : {40.0, -40.0}) {  // reversible displacements: fibres give way by a few of them before they slide
        const simulation::Report slid = simulator.run(test::stage<Rough>({{"draw", to}}, 8));
        REQUIRE_MESSAGE(slid.converged, slid.reason);
        double expected = 0.0, worst = 0.0;  // worst: of a single fibre
        for (const Place& place : places)
            for (const Index fibre : place.fibres) {
                const Vec3 held = support(fibre);
                CAPTURE(place.name);
                worst = std::max(worst, std::abs(std::abs(held.x() / held.z()) / (place.friction * mu) - 1.0));
                CHECK(held.x() * to < 0.0);
                expected += place.friction * mu * std::abs(held.z());
            }
        const double pull = simulator.reaction(scene::first_end(drawn)).x();
        std::printf("drawn to %+.0f: pull %.6e, sum of mu_k N_k %.6e, off by %.1e, a single fibre by %.1e\n", to, pull, expected,
                    std::abs(pull) / expected - 1.0, worst);
        CHECK(pull * to > 0.0);
        CHECK(std::abs(std::abs(pull) / expected - 1.0) < 1e-4);
        CHECK(worst < 2e-4);
    }
    for (const Place& place : places) {
        double deepest = 0.0;
        for (std::size_t k = 0; k < simulator.contacts().elements().size(); ++k) {
            const auto& zone = simulator.contacts().zones()[core::at(simulator.contacts().elements()[k].zone)];
            for (const Index fibre : place.fibres)
                if (zone.span.fibre_i == fibre || zone.span.fibre_j == fibre)
                    deepest = std::max(deepest, -simulator.contacts().responses()[k].gap);
        }
        std::printf("%s: %.3f of the allowed penetration\n", place.name, deepest / allowed);
        CHECK(deepest / (place.penetration * allowed) ==
              test::near(0.45, 0.02));  // what stiffness is adapted to (StiffnessAdaptation.target_fraction)
    }
}

}  // namespace contact_pair_rules_test

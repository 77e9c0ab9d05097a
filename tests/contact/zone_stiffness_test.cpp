// SPDX-License-Identifier: MIT
#include <fibrant/contact/zone_stiffness.hpp>
#include <fibrant/law/linear_penalty.hpp>
#include <fibrant/law/regularised_penalty.hpp>

#include <near.hpp>
#include <refusal.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

using namespace fibrant;

namespace zone_stiffness_test {

using contact::StiffnessAdaptation;
using contact::Zone;

/// Penetration at which a law carries a force, by bisection.
template <class Law>
double penetration(const Law& law, double stiffness, double force) {
    double low = 0.0, high = 1e3;
    for (int k = 0; k < 200; ++k) {
        const double middle = 0.5 * (low + high);
        (law.response(-middle, stiffness).reaction < force ? low : high) = middle;
    }
    return high;
}

Zone zone(Index i, Index j, double a_i, double b_i, double a_j, double b_j) {
    Zone z;
    z.span.fibre_i = i, z.span.fibre_j = j;
    z.span.a_i = a_i, z.span.b_i = b_i, z.span.a_j = a_j, z.span.b_j = b_j;
    return z;
}

const double allowed = 1e-3, reference = 100.0;
const StiffnessAdaptation adaptation{.allowed_penetration = allowed};

TEST_CASE("under a given force the stiffness of a zone settles where the penetration is the target") {
    const law::RegularisedPenalty regularised({.regularisation_depth = 0.1 * allowed});
    const law::LinearPenalty linear;
    for (const double force : {1e-3, 1e-2, 0.1}) {
        double k = 0.05 * reference, k_linear = k;
        for (int n = 0; n < 12; ++n) {
            k = adaptation.adapted(k, reference, penetration(regularised, k, force), 0.1 * allowed);
            k_linear = adaptation.adapted(k_linear, reference, penetration(linear, k_linear, force), 0.0);
        }
        CHECK(penetration(regularised, k, force) / allowed == test::near(adaptation.target_fraction, 1e-6));
        CHECK(penetration(linear, k_linear, force) / allowed == test::near(adaptation.target_fraction, 1e-6));
    }
}

TEST_CASE("one adaptation within reach is exact beyond the quadratic start of the law") {
    const law::RegularisedPenalty law({.regularisation_depth = 0.1 * allowed});
    const double k = adaptation.adapted(20.0, reference, allowed, 0.1 * allowed);
    // the same force: 20 (1 - 0.05) = k (target - 0.05), in allowed penetrations
    CHECK(k == test::near(20.0 * 0.95 / (adaptation.target_fraction - 0.05), 1e-14));
    CHECK(law.response(-adaptation.target_fraction * allowed, k).reaction ==
          test::near(law.response(-allowed, 20.0).reaction, 1e-12));
}

TEST_CASE("the stiffness changes by at most the largest factor and stays between floor and cap") {
    CHECK(adaptation.adapted(20.0, reference, 1e3 * allowed, 0.0) == test::near(60.0, 1e-12));
    CHECK(adaptation.adapted(20.0, reference, 1e-3 * allowed, 0.0) == test::near(20.0 / 3.0, 1e-12));
    CHECK(adaptation.adapted(900.0, reference, 1e3 * allowed, 0.0) == test::near(1000.0, 1e-12));
    CHECK(adaptation.adapted(0.2, reference, 1e-3 * allowed, 0.0) == test::near(0.1, 1e-12));
    CHECK(adaptation.adapted(20.0, reference, 0.0, 0.0) == 20.0);
    CHECK(adaptation.adapted(20.0, reference, -1.0, 0.0) == 20.0);
}

TEST_CASE("the reference stiffness is that of a section between two opposite line loads") {
    // E11 = -2 p / (pi r E*): each line moves by r |E11| under the force p h
    const scene::ElasticMaterial material{7300.0, 0.3};
    const double p = 0.7, h = 0.11, r = 0.02, plane = 7300.0 / (1.0 - 0.09);
    const double strain = 2.0 * p / (std::numbers::pi * r * plane);
    CHECK(contact::section_stiffness(material, h) == test::near(p * h / (r * strain), 1e-14));
}

TEST_CASE("a zone takes over from the zone of the same pair that it overlaps most") {
    const std::vector<Zone> old{zone(0, 1, 0, 2, 0, 2), zone(0, 2, 0, 4, 0, 4), zone(0, 2, 6, 9, 6, 9),
                                zone(0, 2, 20, 22, 22, 20), zone(1, 2, 0, 9, 0, 9)};
    CHECK(contact::predecessor(old, zone(0, 2, 3, 9, 3, 9).span) == &old[2]);
    CHECK(contact::predecessor(old, zone(0, 2, 0, 7, 0, 7).span) == &old[1]);
    CHECK(contact::predecessor(old, zone(0, 2, 20, 21, 21, 20).span) == &old[3]);
    CHECK(contact::predecessor(old, zone(0, 2, 9.5, 10, 9.5, 10).span) == &old[2]);  // within the slack
    CHECK(contact::predecessor(old, zone(0, 2, 12, 13, 12, 13).span) == nullptr);
    CHECK(contact::predecessor(old, zone(0, 2, 0, 4, 6, 9).span) == nullptr);  // overlaps on one fibre only
    CHECK(contact::predecessor(old, zone(0, 3, 0, 4, 0, 4).span) == nullptr);
    CHECK(contact::predecessor({}, zone(0, 2, 0, 4, 0, 4).span) == nullptr);
}

TEST_CASE("an adaptation without a bound on the penetration is refused by name") {
    const auto says = [](const StiffnessAdaptation& a) { return test::refusal([&] { core::validated(a); }); };
    CHECK(says({}).find("StiffnessAdaptation.allowed_penetration") != std::string::npos);
    StiffnessAdaptation wrong = adaptation;
    wrong.largest_change = 1.0;
    CHECK(says(wrong).find("StiffnessAdaptation.largest_change") != std::string::npos);
    wrong = adaptation, wrong.target_fraction = 1.0;
    CHECK(says(wrong).find("StiffnessAdaptation.target_fraction") != std::string::npos);
}

}  // namespace zone_stiffness_test

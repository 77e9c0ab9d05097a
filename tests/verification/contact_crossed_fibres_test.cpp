// SPDX-License-Identifier: MIT
// Two fibres clamped at both ends and crossing at mid-span are pressed together. Reference: the boundary-value problem of
// the same director rod under a point force on its centre line.
#include <contact/contact_model.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

using namespace fibrant;

namespace contact_crossed_fibres_test {

using test::Centred;
using test::Rough;
using test::Smooth;

const double r = 0.0201;

struct Case {
    double length, strain, approach;  ///< approach: of the centre lines, less the loss of distance between them
    double force;                     ///< results.director.F of crossed_fibres.json
};
const Case cases[] = {
    {1.005, 0.0, 0.01005, 0.000891765717759},  {1.005, 0.0, 0.0402, 0.00435476149304},   {1.005, 0.0, 0.1608, 0.0633797883783},
    {1.005, 0.002, 0.01005, 0.0013308761241},  {1.005, 0.002, 0.0402, 0.006092824582},   {1.005, 0.002, 0.1608, 0.0697693127822},
    {4.02, 0.0, 0.01005, 1.40955675038e-05},   {4.02, 0.0, 0.0402, 6.87757191388e-05},   {4.02, 0.0, 0.1608, 0.00100444166353},
    {4.02, 0.002, 0.01005, 0.000119498335719}, {4.02, 0.002, 0.0402, 0.000488522645452}, {4.02, 0.002, 0.1608, 0.00261459377761},
};

/// Takes off what a force on the surface does beside one on the centre line: it flattens the section there, and the fibre
/// gets longer by the Poisson effect.
enum class Pinch { kept, relieved };

/// Fibre 0 below; fibre 1 above it at an angle is moved down.
template <class M>
class Crossing {
public:
    Crossing(const Case& c, double angle_deg, Pinch pinch, const simulation::ModelParameters<M>& parameters)
        : case_{c}, pinch_{pinch}, simulator_{scene(c, angle_deg), parameters} {}

    /// Moves the clamps until the centre lines have approached each other by the case's u, beside what contact takes.
    bool press() {
        if (!simulator_.run(test::stage<M>({{"stretch", 1.0}}, 2)).converged) return false;
        for (int n = 0; n < 8; ++n) {
            std::vector<simulation::Ramp> ramps{{"motion", amplitude_}};
            if (pinch_ == Pinch::relieved) ramps.push_back({"relief", 1.0});
            report = simulator_.run(test::stage<M>(ramps, n == 0 ? 4 : 1));
            if (!report.converged) {
                MESSAGE(report.reason);
                return false;
            }
            const double missing = case_.approach - deflections();
            if (std::abs(missing) < 1e-6 * case_.approach) return true;
            amplitude_ += missing / case_.approach;
        }
        return false;
    }
    double deflections() const { return z({0, 0.0}) - z({0, 0.5}) + z({1, 0.5}) - z({1, 0.0}); }
    /// Loss of distance between the centre lines.
    double lost() const { return amplitude_ * case_.approach - deflections(); }
    /// What the supports exert on a fibre.
    Vec3 support(Index fibre) const { return simulator_.reaction({fibre, 0.0}) + simulator_.reaction({fibre, 1.0}); }
    const simulation::Simulator<M>& simulator() const { return simulator_; }
    simulation::Report report;

private:
    static scene::Assembly scene(const Case& c, double angle_deg) {
        const double angle = angle_deg * std::numbers::pi / 180.0;
        scene::Assembly assembly;
        for (const bool upper : {false, true}) {
            const Vec3 along = upper ? Vec3(std::cos(angle), std::sin(angle), 0.0) : Vec3::UnitX();
            const Vec3 centre = upper ? Vec3(0.0, 0.0, 2.0 * r) : Vec3(Vec3::Zero());
            // not shorter than a diameter, and a node in the middle
            scene::FibreSpecification specification = test::straight_fibre(
                centre - 0.5 * c.length * along, centre + 0.5 * c.length * along, r, c.length < 2.0 ? 24 : 32);
            specification.director = Vec3::UnitZ();
            const Index fibre = assembly.add(specification);
            for (const double end : {0.0, 1.0}) {
                scene::Hold axial;
                axial.at = {fibre, end};
                axial.directions = along * along.transpose();
                axial.channel = "stretch";
                axial.displacement = (end - 0.5) * c.strain * c.length * along;
                assembly.hold(axial);
                axial.directions = Mat3::Identity() - axial.directions, axial.channel = "motion";
                axial.displacement = upper ? Vec3(0, 0, -c.approach) : Vec3(Vec3::Zero());
                assembly.hold(axial);
                assembly.hold_rotation({fibre, end});
            }
            assembly.apply(scene::DeadForce{{fibre, 0.5}, scene::NodeVector::director_1, Vec3(0, 0, r * c.force), "relief"});
        }
        return assembly;
    }
    double z(const scene::Station& at) const { return simulator_.value(at).z() - (at.fibre == 1 ? 2.0 * r : 0.0); }

    Case case_;
    Pinch pinch_;
    double amplitude_ = 1.0;
    simulation::Simulator<M> simulator_;
};

const auto smooth = test::pressed_parameters<Smooth>(1e-3 * r);

TEST_CASE("two crossed fibres push each other apart as the rods of the reference do") {
    for (const Case& c : cases) {
        CAPTURE(c.length);
        CAPTURE(c.strain);
        CAPTURE(c.approach);
        Crossing<Smooth> crossing(c, 90.0, Pinch::relieved, smooth), pinched(c, 90.0, Pinch::kept, smooth);
        REQUIRE(crossing.press());
        REQUIRE(pinched.press());
        const double force = crossing.support(0).z();
        std::printf("L/r %3.0f, stretch %.3f, u %.5f: F %.8g, error %+.2e (%+.2e with the pinch), lost %.2e r\n", c.length / r,
                    c.strain, c.approach, force, force / c.force - 1.0, pinched.support(0).z() / c.force - 1.0,
                    crossing.lost() / r);
        CHECK(std::abs(force / c.force - 1.0) < 2e-4);
        // The pinch lengthens a fibre by 1e-4 of a radius or two, which matters where its tension comes from the deflection.
        CHECK(std::abs(pinched.support(0).z() / c.force - 1.0) < (c.length < 2.0 && c.approach > 0.1 ? 4e-3 : 1e-3));
        for (const Crossing<Smooth>* each : {&crossing, &pinched}) {
            // Equal and opposite, in supports and in the contact; residuals are 1e-8 of all reactions.
            CHECK((each->support(0) + each->support(1)).norm() < 1e-6 * c.force);
            CHECK(std::abs(each->report.contact.reaction_sum / each->support(0).z() - 1.0) < 1e-6);
            CHECK(each->report.contact.active == 1);
            CHECK(each->report.contact.greatest_penetration <= 1e-3 * r);  // as allowed
        }
    }
}

TEST_CASE("contact on centrelines needs no relief: the force of the reference is on the line") {
    auto frictionless = test::pressed_parameters<Centred>(1e-3 * r);
    frictionless.friction = {.friction_coefficient = 0.0, .reversible_displacement = 0.01 * r};
    for (const Case& c : cases) {
        CAPTURE(c.length);
        CAPTURE(c.strain);
        CAPTURE(c.approach);
        Crossing<Centred> crossing(c, 90.0, Pinch::kept, frictionless);
        REQUIRE(crossing.press());
        const double force = crossing.support(0).z();
        std::printf("centrelines: L/r %3.0f, stretch %.3f, u %.5f: error %+.2e, lost %.2e r\n", c.length / r, c.strain,
                    c.approach, force / c.force - 1.0, crossing.lost() / r);
        CHECK(std::abs(force / c.force - 1.0) < 3e-5);  // penetration and mesh
        CHECK((crossing.support(0) + crossing.support(1)).norm() < 1e-6 * c.force);
    }
}

TEST_CASE("the angle of the crossing changes nothing") {
    const Case& c = cases[1];
    for (const double angle : {35.0, 60.0, 120.0}) {
        Crossing<Smooth> crossing(c, angle, Pinch::relieved, smooth);
        REQUIRE(crossing.press());
        std::printf("%.0f degrees: error %+.2e\n", angle, crossing.support(0).z() / c.force - 1.0);
        CHECK(std::abs(crossing.support(0).z() / c.force - 1.0) < 2e-4);
    }
}

TEST_CASE("friction takes no part where symmetry leaves nothing to slide") {
    const Case& c = cases[4];
    simulation::ModelParameters<Rough> rough = test::pressed_parameters<Rough>(1e-3 * r);
    rough.friction = {.friction_coefficient = 0.3, .reversible_displacement = 0.01 * r};
    Crossing<Rough> crossing(c, 90.0, Pinch::relieved, rough);
    REQUIRE(crossing.press());
    CHECK(std::abs(crossing.support(0).z() / c.force - 1.0) < 2e-4);
    CHECK(crossing.report.energy.dissipated == 0.0);
}

TEST_CASE("a small approach obeys beam theory") {
    // F = u / (2 L^3 / (192 E I)); shear takes 24 (1 + nu) (r / L)^2 = 7.8e-4 off it, the tension of the deflection adds 1e-6.
    const double length = 4.02, inertia = 0.25 * std::numbers::pi * r * r * r * r, approach = 1e-2 * r;
    const Case c{length, 0.0, approach, 96.0 * 7300.0 * inertia * approach / (length * length * length)};
    simulation::ModelParameters<Smooth> parameters = test::pressed_parameters<Smooth>(1e-3 * r);
    Crossing<Smooth> crossing(c, 90.0, Pinch::kept, parameters);
    REQUIRE(crossing.press());
    std::printf("u 0.01 r: error %+.2e\n", crossing.support(0).z() / c.force - 1.0);
    CHECK(std::abs(crossing.support(0).z() / c.force - 1.0) < 1e-3);
}

}  // namespace contact_crossed_fibres_test

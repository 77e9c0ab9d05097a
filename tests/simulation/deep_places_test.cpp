// SPDX-License-Identifier: MIT
#include "simulation/scenes.hpp"

#include <doctest/doctest.h>

#include <fibrant/beam/rigid_section_rod.hpp>
#include <fibrant/simulation/audit.hpp>

#include <near.hpp>

#include <algorithm>
#include <vector>

using namespace fibrant;

namespace deep_places_test {

constexpr double radius = 0.02, allowed = 0.01 * radius;

// A hard fibre pressed across a soft one of few elements, whose sections it flattens within a part of one: beside the one contact
// element of a crossing they are deeper in each other than that says.
scene::Assembly pressed(double hardness, double half = 0.4, Index elements = 6, double approach = 1.0,
                        double angle = 0.5 * std::numbers::pi) {
    scene::Assembly assembly;
    for (const bool upper : {false, true}) {
        const Vec3 along = upper ? Vec3(std::cos(angle), std::sin(angle), 0.0) : Vec3(Vec3::UnitX()),
                   middle = upper ? Vec3(0.1 * radius, 0.0, 2.0 * radius) : Vec3::Zero();
        scene::FibreSpecification fibre;
        fibre.from = middle - half * along, fibre.to = middle + half * along;
        fibre.section = scene::circular(radius), fibre.material = {upper ? 7300.0 : 7300.0 / hardness, 0.3};
        fibre.elements = elements, fibre.director = Vec3::UnitZ();
        assembly.add(fibre);
        for (const scene::Station& end : {scene::first_end(upper ? 1 : 0), scene::last_end(upper ? 1 : 0)}) {
            assembly.clamp(end, upper ? Vec3(0, 0, -approach * radius) : Vec3(Vec3::Zero()), Vec3::Zero(), Vec3::Zero(), "press");
        }
    }
    return assembly;
}

struct Ended {
    simulation::Report report;
    simulation::Audit audit;
};
Ended run(const scene::Assembly& scene, bool audited, double deepest_over_radius = core::unset) {
    simulation::ModelParameters<test::Smooth> parameters;
    parameters.normal.regularisation_depth = allowed;
    parameters.contact.stiffness.allowed_penetration = allowed;
    simulation::Simulator<test::Smooth> simulator(scene, parameters);
    simulation::Loading<test::Smooth> loading;
    loading.audited = audited, loading.deepest_over_radius = deepest_over_radius;
    Ended ended;
    ended.report = simulator.run(loading);
    ended.audit = simulation::audit(simulator);
    return ended;
}

TEST_CASE("a run that is audited ends once no two fibres are deeper in each other than stated, beside contact points as well") {
    struct Coarse {
        double approach, angle;
    };
    for (const Coarse& coarse : {Coarse{2.0, 0.5 * std::numbers::pi}, Coarse{2.0, 0.7}, Coarse{5.0, 0.7}}) {
        const scene::Assembly scene = pressed(100.0, 0.3, 2, coarse.approach, coarse.angle);
        const Ended unseen = run(scene, false), seen = run(scene, true);
        CHECK(unseen.report.converged);
        CHECK(unseen.report.contact.greatest_penetration < allowed);  // says contact,
        // and is wrong; but for the last scene, whose crossing is followed by patches
        if (coarse.approach < 5.0) CHECK_FALSE(unseen.audit.clean());
        CHECK(seen.report.converged);
        CHECK(seen.audit.clean());
        CHECK(seen.report.increments.size() <= 15);  // it does not take a search
    }
}

// How deep each accepted increment is, and what it says of itself.
struct Meter {
    const simulation::Simulator<test::Smooth>* simulator;
    std::vector<double> over{}, told{};
    void reported(const simulation::IncrementReport& increment) {
        const simulation::Audit audit = simulation::audit(*simulator);
        over.push_back(std::max(0.0, -audit.least_gap.gap / audit.allowed)), told.push_back(increment.use.between);
    }
    double most() const { return *std::max_element(over.begin(), over.end()); }
};

TEST_CASE("every increment that is accepted is no deeper than stated beside contact points as well, and tells how deep it is") {
    struct Coarse {
        double approach, angle;
    };
    for (const Coarse& coarse : {Coarse{2.0, 0.5 * std::numbers::pi}, Coarse{2.0, 0.7}})
        for (const bool each : {false, true}) {
            const scene::Assembly scene = pressed(100.0, 0.3, 2, coarse.approach, coarse.angle);
            simulation::ModelParameters<test::Smooth> parameters;
            parameters.normal.regularisation_depth = parameters.contact.stiffness.allowed_penetration = allowed;
            simulation::Simulator<test::Smooth> simulator(scene, parameters);
            Meter meter{&simulator};
            const simulation::Report report = simulator.run({.increments = 10, .every_increment = each}, meter);
            CAPTURE(report.reason);
            CHECK(report.converged);
            CHECK(report.increments.size() <= 15);
            CHECK(report.rejected_increments == 0);  // mended, not cut
            if (!each) {
                CHECK(meter.most() > 1.1);
                CHECK(report.most_use.between == 0.0);  // not measured
                continue;
            }
            CHECK(meter.most() <= 1.0);
            CHECK(meter.told == meter.over);
            CHECK(report.most_use.between == meter.most());
            CHECK(report.use.between == meter.over.back());
        }
}

TEST_CASE("what a contact was told that its points miss is forgotten once its fibres have parted") {
    simulation::ModelParameters<test::Smooth> parameters;
    parameters.normal.regularisation_depth = parameters.contact.stiffness.allowed_penetration = allowed;
    simulation::Simulator<test::Smooth> simulator(pressed(100.0, 0.3, 2, 2.0), parameters);
    simulation::Loading<test::Smooth> loading;
    loading.stages.resize(2);
    for (const bool back : {false, true})
        loading.stages[back ? 1 : 0].increments = 5, loading.stages[back ? 1 : 0].ramps = {{"press", back ? -0.1 : 1.0}};
    double missed = 0.0;
    struct Unseen {
        const simulation::Simulator<test::Smooth>* simulator;
        double* most;
        void reported(const simulation::IncrementReport&) {
            for (const contact::Zone& zone : simulator->contacts().zones()) *most = std::max(*most, zone.unseen);
        }
    } unseen{&simulator, &missed};
    const simulation::Report report = simulator.run(loading, unseen);
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    CHECK(missed > 0.0);
    for (const contact::Zone& zone : simulator.contacts().zones()) CHECK(zone.unseen == 0.0);
}

TEST_CASE("what is clean is left as it is, and a stricter bound is kept by stiffer contact") {
    const scene::Assembly scene = pressed(10.0);
    const Ended plain = run(scene, false), audited = run(scene, true), strict = run(scene, true, 0.002);
    CHECK(plain.audit.least_gap.gap < -0.004 * radius);  // about half of what is allowed
    CHECK(audited.report.increments.size() == plain.report.increments.size());
    CHECK(audited.audit.least_gap.gap == plain.audit.least_gap.gap);
    CHECK(strict.report.converged);
    CHECK(strict.audit.least_gap.gap >= -0.002 * radius);
}

TEST_CASE("what cannot be reached is told: the fibres, how deep they are, the bound and what to do") {
    const Ended ended = run(pressed(10.0), true, 1e-5);
    CHECK_FALSE(ended.report.converged);
    for (const char* words : {"stage loading did not reach its end in ", ": fibres 0 and 1 stay ",
                              " radii deep in each other at (", "allowed are 1e-05: more elements"})
        CHECK(ended.report.reason.find(words) != std::string::npos);
}

TEST_CASE("an audit sees a fibre to its very ends") {
    // Crossed by another one in the last eighth of either end's element, 1.5 radii away.
    const double r = 0.01, length = 1.0, away = 0.03;
    for (const bool last : {false, true}) {
        scene::Assembly assembly;
        const double x = last ? length - away : away;
        for (const bool across : {false, true}) {
            scene::FibreSpecification fibre;
            fibre.from = across ? Vec3(x, -0.4, 1.5 * r) : Vec3(0, 0, 0),
            fibre.to = across ? Vec3(x, 0.6, 1.5 * r) : Vec3(length, 0, 0);
            fibre.section = scene::circular(r), fibre.material = {7300.0, 0.3}, fibre.elements = 4;
            assembly.add(fibre);
        }
        const beam::Mesh<beam::RigidSectionRod> mesh(assembly, beam::RigidSectionRod());
        const observe::Snapshot curves = simulation::detail::curves_of(mesh, mesh.rest_state());
        // rounding of a difference of lengths
        CHECK(observe::least_gap(curves, proximity::GridSearch{}).gap == test::near(-0.5 * r, 1e-9));
    }
}

}  // namespace deep_places_test

// SPDX-License-Identifier: MIT
// Leaps: an equilibrium ends, and the next one is far.
#include <fibrant/beam/rigid_section_rod.hpp>

#include <near.hpp>
#include <simulation/twisted_rod.hpp>

#include <doctest/doctest.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <type_traits>

using namespace fibrant;

namespace calming_test {

using test::Smooth;
using test::Twisted;

TEST_CASE("a twisted rod that leaps is followed to the equilibrium that a rod damped all the way comes to") {
    const Twisted rod;
    Twisted damped = rod;
    damped.damping = 1e-4;
    simulation::Simulator<Smooth> simulator(rod.assembly(), rod.parameters()), other(damped.assembly(), damped.parameters());
    simulation::Loading<Smooth> stopped = rod.loading();
    stopped.calmed = false;
    const simulation::Report report = simulator.run(rod.loading()), slow = other.run(damped.loading());
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    REQUIRE(slow.converged);
    const double force = simulator.reaction(scene::last_end(0)).x(), expected = other.reaction(scene::last_end(0)).x();
    std::printf("four turns: force %.9f and %.9f, energy %.9f and %.9f, damped %.3e and %.3e, missing %.2e and %.2e\n", force,
                expected, report.energy.elastic, slow.energy.elastic, report.energy.damped, slow.energy.damped,
                report.energy.error(), slow.energy.error());
    // Residuals are at most 1e-4 of the reactions.
    CHECK(force == test::near(expected, 1e-3));
    CHECK(report.energy.elastic == test::near(slow.energy.elastic, 1e-4));
    CHECK(report.energy.damped > 0.0);
    CHECK(report.increments.back().damping == 0.0);
    // Of second order in the increments, less than what damping took: a leap at ends that stand adds nothing unseen.
    CHECK(std::abs(report.energy.error()) < 5e-5 * report.energy.elastic);
    CHECK(std::abs(slow.energy.error()) < 5e-5 * slow.energy.elastic);

    simulation::Simulator<Smooth> alone(rod.assembly(), rod.parameters());
    const simulation::Report cut = alone.run(stopped);
    CHECK(!cut.converged);
    CHECK(cut.reason.find("stage slack") != std::string::npos);
}

TEST_CASE("the softest spring is what a wave over a fibre bends by, over the length of a node, whatever its elements") {
    const Index elements = 6;
    const double r = 0.02, length = 3.0;
    const auto mesh_of = [&]<class B>(std::type_identity<B>, Index own) {
        scene::Assembly assembly;
        scene::FibreSpecification fibre;
        fibre.from = Vec3::Zero(), fibre.to = Vec3(length, 0, 0), fibre.elements = own;
        fibre.section = scene::circular(r), fibre.material = {7300.0, 0.3};
        assembly.add(fibre);
        return simulation::Calming::softest(beam::Mesh<B>(assembly, B()));
    };
    const double bending = 7300.0 * std::numbers::pi / 4.0 * std::pow(r, 4), wave = 2.0 * std::numbers::pi / length;
    const double spring =
        bending * std::pow(wave, 4) * length / static_cast<double>(2 * elements);  // nodes are as far apart in both
    CHECK(mesh_of(std::type_identity<beam::DirectorBeam<3>>(), elements) == test::near(spring));
    CHECK(mesh_of(std::type_identity<beam::RigidSectionRod>(), 2 * elements) == test::near(spring));
}

TEST_CASE("a run that is stopped in the middle of a leap goes on to the same bits") {
    const Twisted rod;
    const std::string file = (std::filesystem::temp_directory_path() / "calming_test_checkpoint.bin").string();
    std::filesystem::remove(file);
    simulation::Simulator<Smooth> whole(rod.assembly(), rod.parameters());
    const simulation::Report report = whole.run(rod.loading());
    REQUIRE(report.converged);
    Index leap = 0;  // an increment within the first leap
    for (const simulation::IncrementReport& increment : report.increments)
        if (leap == 0 && increment.damping > 0.0) leap = increment.number + 3;
    REQUIRE(leap > 0);
    simulation::Loading<Smooth> loading = rod.loading();
    loading.checkpoint = file;
    Index increments = 0;
    loading.stop = [&] { return ++increments == leap; };
    {
        simulation::Simulator<Smooth> first(rod.assembly(), rod.parameters());
        const simulation::Report stopped = first.run(loading);
        REQUIRE(!stopped.converged);
        REQUIRE(stopped.increments.back().damping > 0.0);
    }
    loading.resume = true, loading.stop = {};
    simulation::Simulator<Smooth> second(rod.assembly(), rod.parameters());
    const simulation::Report rest = second.run(loading);
    std::filesystem::remove(file);
    REQUIRE(rest.converged);
    CHECK((second.state() - whole.state()).isZero(0.0));
    CHECK(rest.energy.damped == report.energy.damped);
    CHECK(rest.counts.newton == report.counts.newton);
}

}  // namespace calming_test

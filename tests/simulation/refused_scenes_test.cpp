// SPDX-License-Identifier: MIT
// What a simulator refuses before it moves anything: holds that contradict each other, paths to nowhere, scenes that nothing
// holds.
#include "refusal.hpp"
#include "scenes.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <string>

using namespace fibrant;

namespace refused_scenes_test {

using Model = test::Smooth;
const test::Rod rod;

scene::Assembly free_rod() {
    scene::Assembly assembly;
    scene::FibreSpecification specification = rod.specification();
    specification.name = "mast";
    assembly.add(specification);
    return assembly;
}

std::string refused(const std::function<void(scene::Assembly&)>& change,
                    const simulation::Loading<Model>& loading = {.increments = 2}) {
    scene::Assembly assembly = free_rod();
    change(assembly);
    return test::refusal([&] {
        simulation::Simulator<Model> simulator(assembly, test::model_parameters<Model>(rod.radius));
        simulator.run(loading);
    });
}
bool says(const std::string& message, const std::string& part) {
    CAPTURE(message);
    CAPTURE(part);
    const bool said = message.find(part) != std::string::npos;
    CHECK(said);
    return said;
}

TEST_CASE("holds of one vector that ask for different places are refused by fibre, node and channel") {
    const scene::Station foot = scene::first_end(0);
    // The clamp was there first and decided: the end stayed, and nothing said so.
    says(refused([&](auto& a) { a.clamp(foot), a.prescribe(foot, Vec3(0, 0, 1e-3)); }),
         "Hold: what holds of a position ask for differs by = (0, 0, 0.001), but it must be 0");
    says(refused([&](auto& a) { a.clamp(foot), a.prescribe(foot, Vec3(0, 0, 1e-3)); }), "(fibre 0 'mast', node 0 at (0, 0, 0))");
    says(refused([&](auto& a) { a.clamp(foot), a.prescribe(foot, Vec3(0, 0, 1e-3), "lift"); }), "channel 'lift' = 1");
    says(refused([&](auto& a) { a.clamp(foot), a.clamp(foot, Vec3::Zero(), Vec3(0, 0.1, 0)); }), "director 1");
    says(refused([&](auto& a) {
             a.clamp(foot);
             for (const Vec3& along : {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)}) {  // the third follows from the others
                 scene::Hold hold;
                 hold.at = scene::last_end(0), hold.directions = along * along.transpose() / along.squaredNorm(),
                 hold.displacement = 1e-3 * along.squaredNorm() * along;
                 a.hold(hold);
             }
         }),
         "node 32 at (0, 0, 2.01)");
    // What agrees, or shares no direction, is none of this.
    CHECK(refused([&](auto& a) { a.clamp(foot), a.clamp(foot), a.hold_position(foot); }).empty());
    CHECK(refused([&](auto& a) {
              a.clamp(foot), a.hold_position(scene::last_end(0), Vec3(1, 1, 0).asDiagonal());
              scene::Hold hold;
              hold.at = scene::last_end(0), hold.directions = Vec3(0, 0, 1).asDiagonal(), hold.displacement = Vec3(1, 1, 1e-4);
              a.hold(hold);
          }).empty());
}

TEST_CASE("a path that is nowhere somewhere along the loading is refused before the first increment") {
    const auto guided = [](const std::function<Vec3(double)>& path) {
        return [path](scene::Assembly& assembly) {
            assembly.clamp(scene::first_end(0));
            scene::Hold hold;
            hold.at = scene::last_end(0), hold.path = path;
            assembly.hold(hold);
        };
    };
    const auto root = [](double a) { return Vec3(0, 0, 1e-4 * std::sqrt(0.6 - a)); };
    const std::string message = refused(guided([&](double a) { return Vec3(root(a) - root(0.0)); }), {.increments = 4});
    says(message, "Hold.path(0.75) = (0, 0, ");
    says(message, "(fibre 0 'mast', node 32 at (0, 0, 2.01)) (stage 'loading')");
    CHECK(refused(guided([](double a) { return Vec3(0, 0, 1e-4 * a); })).empty());
}

TEST_CASE("a scene that nothing holds is not begun, and the report says what would hold it; damping does") {
    const auto reason = [](bool guided, double damping) {
        scene::Assembly assembly = free_rod();
        assembly.apply(scene::DeadForce{scene::last_end(0), scene::NodeVector::position, Vec3(1e-6, 0, 0), "load"});
        if (guided) assembly.hold_position(scene::first_end(0), Vec3(1, 1, 0).asDiagonal());
        simulation::Loading<Model> loading;
        loading.stages.resize(1);
        loading.stages[0].ramps = {{"load", 1.0, false}}, loading.stages[0].increments = 2, loading.stages[0].damping = damping;
        simulation::Simulator<Model> simulator(assembly, test::model_parameters<Model>(rod.radius));
        const simulation::Report report = simulator.run(loading);
        CHECK(report.converged == report.reason.empty());
        CHECK((report.converged || report.counts.newton == 0));
        return report.reason;
    };
    says(reason(false, 0.0),
         "stage loading: assembly.holds = none, but it must be such that the scene cannot move as a whole: hold a station");
    says(reason(true, 0.0), "assembly.holds = none along (0, 0, 1)");
    CHECK(reason(false, 1.0).empty());
}

}  // namespace refused_scenes_test

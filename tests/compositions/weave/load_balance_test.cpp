// SPDX-License-Identifier: MIT
// What the edges of a loaded fabric exert on it adds up to nothing, whatever hangs on what.
#include "small_weave.hpp"

#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/simulation/programme.hpp>

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

using namespace fibrant;

namespace load_balance_test {

namespace cloth = fibrant::compositions::weave;

struct Loaded : test::SmallWeave {
    using Connections = connection::RigidBodies;
    using Tools = contact::RigidTools;
};

double figure(const std::vector<cloth::Figure>& figures, const std::string& name) {
    const auto found = std::find_if(figures.begin(), figures.end(), [&](const cloth::Figure& one) { return one.first == name; });
    REQUIRE(found != figures.end());
    return found->second;
}

TEST_CASE("forces and moments of all edges balance to 1e-8 of the load, in a frame too, one of whose bars hangs on another") {
    const cloth::FabricParameters fabric = test::small_fabric();
    const cloth::SettleParameters settle;
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_load_balance_test.bin").string();
    observe::Snapshot settled;
    {
        simulation::Simulator<test::SmallWeave> simulator(cloth::flat_fabric(fabric, settle.tension_strain), cloth::model_parameters<test::SmallWeave>(fabric, settle));
        simulation::Loading<test::SmallWeave> loading = cloth::settling<test::SmallWeave>(fabric, settle);
        loading.checkpoint = file;
        REQUIRE(simulator.run(loading).converged);
        settled = simulator.snapshot();
    }
    struct Case {
        const char* name;
        std::vector<simulation::Ramp> ramps;
    };
    for (const Case& given : {Case{"equibiaxial", {{cloth::strain_channel, 0.002}}}, Case{"uniaxial", {{cloth::strain_channel, 0.002}}},
                              Case{"shear", {{cloth::tension_channel, 5e-4}, {cloth::shear_channel, 0.01}}}, Case{"frame", {{cloth::shear_channel, 0.01}}}}) {
        const std::string name = given.name;
        CAPTURE(name);
        const cloth::LoadCase load = cloth::load_case(name, settled, fabric, cloth::TowEnds::fibres);
        auto parameters = cloth::model_parameters<Loaded>(fabric, settle);
        parameters.iteration.residual_tolerance = 1e-10, parameters.iteration.overshoot = 0.5;
        // Forces of a pair act at one place once their normal stands: what the last pass moved is a lever.
        parameters.iteration.normal_tolerance = parameters.iteration.normal_step_tolerance = parameters.iteration.contact_tolerance = 1e-6;
        parameters.iteration.normal_limit = 40;
        simulation::Simulator<Loaded> simulator(load.assembly, parameters);
        simulator.start_from(file);
        simulation::LoadProgramme programme;
        programme.stages = {{.name = "load", .increments = 2, .ramps = given.ramps, .friction = settle.friction_coefficient, .looseness = 1.0}};
        programme.reversible_displacement = 0.02 * cloth::smallest_radius(fabric);
        const simulation::Report report = simulator.run(simulation::loading_of<Loaded>(programme));
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const auto figures = cloth::load_figures(load, simulator, simulator.snapshot());
        double greatest = 0.0;
        for (const char* edge : {"west", "east", "south", "north"})
            for (const char* axis : {"x", "y", "z"}) greatest = std::max(greatest, std::abs(figure(figures, edge + std::string("_force_") + axis)));
        const auto& ties = simulator.equilibrium().ties();
        Vec3 moment = Vec3::Zero();
        for (Index body = 0; body < core::count(load.assembly.bodies()); ++body)
            if (ties.motion().parent(body) < 0) moment += ties.wrench(body, Vec3::Zero()).moment;
        std::printf("%s: greatest force of an edge %.4g, all together %.2g, moment over that and the width %.2g\n", name.c_str(), greatest,
                    figure(figures, "unbalanced_force"), moment.norm() / (greatest * load.width));
        CHECK(greatest > 1e-3);
        CHECK(figure(figures, "unbalanced_force") < 1e-8 * greatest);
        CHECK(figure(figures, "damping_force") == 0.0);
        CHECK(moment.norm() < 1e-8 * greatest * load.width);
    }
    std::filesystem::remove(file);
}

}  // namespace load_balance_test

// SPDX-License-Identifier: MIT
// What the edges of a loaded fabric exert on it adds up to nothing, whatever hangs on what; the figures of load cases are those
// of bundles whose E A and E I are known, and their work is what the fabric was given.
#include "small_weave.hpp"

#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/connection/rigid_bodies.hpp>
#include <fibrant/contact/contacts_with_tools.hpp>
#include <fibrant/simulation/programme.hpp>
#include <fibrant/simulation/stored_state.hpp>

#include <near.hpp>

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
        simulation::Simulator<test::SmallWeave> simulator(cloth::flat_fabric(fabric, settle.tension_strain),
                                                          cloth::model_parameters<test::SmallWeave>(fabric, settle));
        simulation::Loading<test::SmallWeave> loading = cloth::settling<test::SmallWeave>(fabric, settle);
        loading.checkpoint = file;
        REQUIRE(simulator.run(loading).converged);
        settled = simulator.snapshot();
    }
    struct Case {
        const char* name;
        std::vector<simulation::Ramp> ramps;
    };
    for (const Case& given :
         {Case{"equibiaxial", {{cloth::strain_channel, 0.002}}}, Case{"uniaxial", {{cloth::strain_channel, 0.002}}},
          Case{"shear", {{cloth::tension_channel, 5e-4}, {cloth::shear_channel, 0.01}}},
          Case{"frame", {{cloth::shear_channel, 0.01}}}}) {
        const std::string name = given.name;
        CAPTURE(name);
        const cloth::LoadCase load = cloth::load_case(name, settled, fabric, cloth::TowEnds::fibres);
        auto parameters = cloth::model_parameters<Loaded>(fabric, settle);
        parameters.iteration.residual_tolerance = 1e-10, parameters.iteration.overshoot = 0.5;
        // Forces of a pair act at one place once their normal stands: what the last pass moved is a lever.
        parameters.iteration.normal_tolerance = parameters.iteration.normal_step_tolerance =
            parameters.iteration.contact_tolerance = 1e-6;
        parameters.iteration.normal_limit = 40;
        simulation::Simulator<Loaded> simulator(load.assembly, parameters);
        simulator.start_from(file);
        simulation::LoadProgramme programme;
        programme.stages = {
            {.name = "load", .increments = 2, .ramps = given.ramps, .friction = settle.friction_coefficient, .looseness = 1.0}};
        programme.reversible_displacement = 0.02 * cloth::smallest_radius(fabric);
        const simulation::Report report = simulator.run(simulation::loading_of<Loaded>(programme));
        CAPTURE(report.reason);
        REQUIRE(report.converged);
        const auto figures = cloth::load_figures(load, simulator, simulator.snapshot());
        double greatest = 0.0;
        for (const char* edge : {"west", "east", "south", "north"})
            for (const char* axis : {"x", "y", "z"})
                greatest = std::max(greatest, std::abs(figure(figures, edge + std::string("_force_") + axis)));
        const auto& ties = simulator.equilibrium().ties();
        Vec3 moment = Vec3::Zero();
        for (Index body = 0; body < core::count(load.assembly.bodies()); ++body)
            if (ties.motion().parent(body) < 0) moment += ties.wrench(body, Vec3::Zero()).moment;
        std::printf("%s: greatest force of an edge %.4g, all together %.2g, moment over that and the width %.2g\n", name.c_str(),
                    greatest, figure(figures, "unbalanced_force"), moment.norm() / (greatest * load.width));
        CHECK(greatest > 1e-3);
        CHECK(figure(figures, "unbalanced_force") < 1e-8 * greatest);
        CHECK(figure(figures, "damping_force") == 0.0);
        CHECK(moment.norm() < 1e-8 * greatest * load.width);
    }
    std::filesystem::remove(file);
}

/// A load case on bundles of straight fibres: the weft is lifted off the warp, and nothing touches.
struct Bundles {
    cloth::LoadCase load;
    std::vector<cloth::Figure> figures;
    simulation::EnergyBalance energy;
    double operator[](const char* name) const { return figure(figures, name); }
};

/// @param stretched  of all fibres at the start
/// @param damped     some bodies are free where nothing holds them
/// @param tows       of each family
/// @param outer      stretch of the outermost warp tows at the start, over that of all
Bundles bundles(const std::string& name, const std::vector<simulation::Ramp>& ramps, Index increments, double stretched = 1.0,
                bool damped = false, Index tows = 2, double outer = 1.0) {
    cloth::FabricParameters fabric = test::small_fabric();
    fabric.warp_tows = fabric.weft_tows = tows;
    const std::string file = (std::filesystem::temp_directory_path() / "fibrant_bundles_test.bin").string();
    scene::Assembly fibres;
    cloth::add_flat_fibres(fibres, fabric);
    const beam::Mesh<Loaded::Beam> mesh(fibres, Loaded::Beam(Loaded::Beam::Parameters{}));
    Vector state = mesh.rest_state();
    const Index weft = mesh.first_unknown(fabric.fibre(cloth::Family::weft, 0, 0), 0) / 3;
    const auto first_of = [&](Index tow) { return mesh.first_unknown(fabric.fibre(cloth::Family::warp, tow, 0), 0) / 3; };
    const Index inner = first_of(1), after = first_of(tows - 1);
    for (Index v = 0; v < state.size() / 3; ++v)
        if (mesh.layout().kind[core::at(v)] == scene::VectorKind::position) {
            state.segment<2>(3 * v) *= stretched;
            if (v < inner || (v >= after && v < weft)) state[3 * v] *= outer;
            if (v >= weft) state[3 * v + 2] += 0.5;
        }
    simulation::write_state<Loaded>(file, mesh, {.state = state});
    const cloth::SettleParameters settle;
    auto parameters = cloth::model_parameters<Loaded>(fabric, settle);
    parameters.iteration.residual_tolerance = 1e-9, parameters.iteration.step_tolerance = 1e-7,
    parameters.iteration.linear_tolerance = 1e-10;
    Bundles answer{.load = cloth::load_case(name, simulation::snapshot_of(mesh, state), fabric, cloth::TowEnds::fibres),
                   .figures = {},
                   .energy = {}};
    simulation::Simulator<Loaded> simulator(answer.load.assembly, parameters);
    simulator.start_from(file);
    std::filesystem::remove(file);
    simulation::LoadProgramme programme;
    programme.stages = {
        {.name = "load", .increments = increments, .ramps = ramps, .damping = damped ? 1.0 : 0.0, .looseness = 1.0}};
    programme.damping = 1e-6 * fabric.warp.axial_stiffness() / fabric.fibre_length(cloth::Family::warp);
    const simulation::Report report = simulator.run(simulation::loading_of<Loaded>(programme));
    CAPTURE(report.reason);
    REQUIRE(report.converged);
    answer.figures = cloth::load_figures(answer.load, simulator, simulator.snapshot());
    answer.energy = report.energy;
    return answer;
}

TEST_CASE("bundles of straight fibres are drawn, sheared and bent by what their E A and E I say") {
    const cloth::FabricParameters fabric = test::small_fabric();
    const double EA = fabric.warp.axial_stiffness(), L = fabric.fibre_length(cloth::Family::warp), strain = 0.002,
                 stretch = 1.0 + strain;
    const double tow = EA * 0.5 * (stretch * stretch - 1.0) * stretch;  // St Venant-Kirchhoff, nominal
    const double stored = EA * L * std::pow(stretch * stretch - 1.0, 2) / 8.0;
    for (const char* name : {"equibiaxial", "uniaxial"}) {
        CAPTURE(name);
        const bool both = std::string(name) == "equibiaxial";
        const double pull = 7e-4, across = 2.0 * EA * pull;
        const Bundles drawn =
            bundles(name,
                    both ? std::vector<simulation::Ramp>{{cloth::strain_channel, strain}}
                         : std::vector<simulation::Ramp>{{cloth::strain_channel, strain}, {cloth::tension_channel, pull}},
                    2);
        CHECK(drawn["strain"] == test::near(strain, 1e-9));
        CHECK(drawn["force"] == test::near(2.0 * tow, 1e-6));
        CHECK(drawn["inner_tow_force"] == test::near(tow, 1e-6));
        CHECK(drawn["middle_tow_force"] == test::near(tow, 1e-6));
        CHECK(drawn["middle_strain"] == test::near(strain, 1e-6));
        // Its ends take force over E A, which is the strain but for the three halves of its square.
        CHECK(drawn["woven_strain"] ==
              test::near(strain - 2.0 * fabric.overhang / (L - 2.0 * fabric.overhang) * (tow / EA - strain), 1e-6));
        for (const char* edge : {"north", "south"})
            CHECK(drawn[(edge + std::string("_force_y")).c_str()] ==
                  test::near((edge[0] == 'n' ? 1.0 : -1.0) * (both ? 2.0 * tow : across), 1e-6));
        // Of the tension, whose strain is pull (1 - 1.5 pull), half as well.
        const double given = 2.0 * stored + (both ? 2.0 * stored : across * pull * L / 2.0);
        CHECK(drawn.energy.elastic == test::near(given, both ? 1e-6 : 1e-3));
        CHECK(drawn.energy.external == test::near(given, 2e-3));  // the trapezium's error, of two increments
    }
    {
        // Outermost tows of a sample of four count for the edges, and not for what an inner tow carries.
        const double tighter = 1.001, drawn_outer = stretch * tighter;
        const Bundles drawn = bundles("equibiaxial", {{cloth::strain_channel, strain}}, 1, 1.0, false, 4, tighter);
        const double outer = EA * 0.5 * (drawn_outer * drawn_outer - 1.0) * drawn_outer;
        // Ends are drawn by the strain of the edge, which outer tows move out.
        CHECK(drawn["inner_tow_force"] == test::near(tow, 2e-3));
        CHECK(drawn["middle_tow_force"] == test::near(tow, 2e-3));
        CHECK(drawn["force"] == test::near(2.0 * tow + 2.0 * outer, 2e-3));
        CHECK(outer > 1.4 * tow);
    }
    {
        // Weft tows are strings between two bars: what shears them is their pull times the tangent of the angle.
        const double pull = 5e-4;
        const Bundles sheared = bundles("shear", {{cloth::tension_channel, pull}, {cloth::shear_channel, 0.02}}, 2, 1.0, true);
        const double angle = std::atan2(0.02 * sheared.load.height, sheared["north_y"] - sheared["south_y"]);
        CHECK(sheared["angle_deg"] == test::near(angle * 180.0 / 3.14159265358979323846, 1e-9));
        CHECK(sheared["force"] == test::near(2.0 * EA * pull * std::tan(angle), 3e-4));  // damping holds a ten-thousandth of it
        CHECK(sheared["east_force_x"] == test::near(2.0 * EA * pull, 1e-6));
        CHECK(sheared["west_force_x"] == test::near(-2.0 * EA * pull, 1e-6));
    }
    {
        // Stretched fibres go round with the bars of a frame and keep their length: every bar holds a moment, but all of them
        // take no work.
        const Bundles frame = bundles("frame", {{cloth::shear_channel, 0.02}}, 2, stretch);
        CHECK(frame["angle_deg"] == test::near(0.02 * 180.0 / 3.14159265358979323846, 1e-9));
        CHECK(std::abs(frame["force"]) < 1e-6 * tow);
        const double levers = 2.0 * tow * std::cos(0.02) * 0.5 * frame.load.height;  // of two tows about the corner
        CHECK(frame["east_moment_z"] == test::near(-levers, 1e-6));
        CHECK(frame["north_moment_z"] == test::near(levers, 1e-6));
    }
    {
        // Fibres of a tow whose ends turn as one are flanges of each other.
        const double angle = 0.01;
        double stiffness = 0.0;
        for (const auto& centre : fabric.warp.packing().centres)
            stiffness += 2.0 * fabric.warp.material.young_modulus *
                         (fabric.warp.section().second_moment_1() + fabric.warp.section().area() * centre.y() * centre.y());
        const Bundles bent = bundles("bending", {{cloth::bend_channel, angle}}, 2, 1.0, true);
        CHECK(bent["curvature"] == test::near(2.0 * angle / L, 1e-9));
        CHECK(bent["moment"] == test::near(stiffness * 2.0 * angle / L,
                                           0.04));  // three hundredths are the damping of the weft, which rises along the arc
        CHECK(bent.energy.elastic == test::near(0.5 * stiffness * 4.0 * angle * angle / L, 1e-3));
    }
}

}  // namespace load_balance_test

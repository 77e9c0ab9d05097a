// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a load case as a TOML file: the settled fabric, the case, and a programme with a section a stage.

#include "../support/scene_reader.hpp"
#include "../weave/scene_file.hpp"

#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/exchange/surface_files.hpp>
#include <fibrant/simulation/programme.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fabric_loading {

namespace cloth = fibrant::compositions::weave;
using example::SceneReader;
using fibrant::Index;

/// Everything that a run is told.
struct LoadFile {
    weave::Scene scene;  ///< of the settled fabric
    std::string checkpoint, name;
    cloth::TowEnds tow_ends = cloth::TowEnds::kept;
    Index points_per_element = 0;            ///< spacing of contacts, if it is another
    Index parts = 1;                         ///< that each element of the settled fabric is cut into
    cloth::FabricParameters settled_fabric;  ///< before that
    cloth::FormingParameters forming;        ///< of a case of that name
    fibrant::simulation::LoadProgramme programme;
};

/// Every channel of a load case, with what it may be driven to: beyond that there is no such state of a fabric.
inline std::vector<std::pair<std::string, example::Bound>> channel_bounds(const std::string& load_case) {
    using std::numbers::pi;
    return {{cloth::strain_channel, example::inside(-0.9, 10.0)},
            // Sides of a frame lie on each other at a right angle.
            {cloth::shear_channel, load_case == "frame" ? example::inside(-0.5 * pi, 0.5 * pi) : example::inside(-10.0, 10.0)},
            {cloth::bend_channel, example::between(-pi, pi)},        // of either edge: the arc closes
            {cloth::plate_channel, example::inside(-10.0, 1.0)},     // at 1 they touch each other
            {cloth::punch_channel, example::between(-1e3, 1e3)},     // radii of the hole
            {cloth::holder_channel, example::inside(-10.0, 1.0)},    // as plates
            {cloth::pull_channel, example::between(-1e4, 1e4)},      // spacings: longer than any tow
            {cloth::tension_channel, example::between(-0.2, 0.2)}};  // of E A, as settle.tension_strain
}

/// Refuses what a ramp of the stage, or the way back of its cycles, cannot be driven to.
inline void check_ramps(const SceneReader& file, const fibrant::simulation::ProgrammeStage& stage, const std::string& load_case) {
    const auto bounds = channel_bounds(load_case);
    for (const fibrant::simulation::Ramp& ramp : stage.ramps) {
        const auto found = std::find_if(bounds.begin(), bounds.end(), [&](const auto& one) { return one.first == ramp.channel; });
        if (found == bounds.end()) {
            std::vector<std::string> names;
            for (const auto& one : bounds) names.push_back(one.first);
            const std::string meant = example::nearest_name(ramp.channel, names);
            file.refuse(stage.name, "ramps",
                        "of channels that there are, and " + ramp.channel + " is none" +
                            (meant.empty() ? "" : ": perhaps " + meant + " is meant"));
        }
        file.check(found->second.holds(ramp.to), stage.name, "ramps",
                   "such that " + ramp.channel + " is " + found->second.text());
        file.check(stage.cycles == 0 || found->second.holds(stage.back), stage.name, "back",
                   found->second.text() + ", as " + ramp.channel + " is");
    }
}

/// A ramp as "channel = value".
inline fibrant::simulation::Ramp read_ramp(const SceneReader& file, const std::string& section, const std::string& text) {
    const std::size_t equals = text.find('=');
    fibrant::simulation::Ramp ramp;
    const auto trimmed = [](const std::string& part) {
        const std::size_t first = part.find_first_not_of(' ');
        return first == std::string::npos ? std::string() : part.substr(first, part.find_last_not_of(' ') - first + 1);
    };
    if (equals == std::string::npos) file.refuse(section, "ramps", "a list of texts \"channel = value\"");
    ramp.channel = trimmed(text.substr(0, equals));
    const std::string value = trimmed(text.substr(equals + 1));
    const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), ramp.to);
    if (ramp.channel.empty() || error != std::errc{} || end != value.data() + value.size() || !(std::abs(ramp.to) <= 1e6))
        file.refuse(section, "ramps",
                    "a list of texts \"channel = value\", the value a number from -1000000 to 1000000 and nothing behind it");
    return ramp;
}

/// A section of the file as a stage.
inline fibrant::simulation::ProgrammeStage read_stage(SceneReader& file, const std::string& name) {
    fibrant::simulation::ProgrammeStage stage;
    stage.name = name;
    std::vector<std::string> ramps;
    file.require(name, "increments", stage.increments, example::between(1, 100000), "increments of each ramp");
    file.read(name, "ramps", ramps,
              "what is driven, as texts \"channel = value\": strain, shear, bend, plates, pull, punch, holder or tension, as the "
              "case has them");
    file.read(name, "cycles", stage.cycles, example::between(0, 10000), "how many times there and back; 0: there only");
    file.read(name, "back", stage.back, example::between(-1e6, 1e6), "1", "value at which each cycle ends");
    file.read(name, "rest", stage.rest, "after its ramps, go on until the fabric is at rest");
    file.read(name, "damping", stage.damping, example::between(0.0, 1e6), "1",
              "stiffness of the damping, over that which the tension of settling gave a node");
    file.read(name, "looseness", stage.looseness, example::looseness(), "1", "factor on the tolerances of passes");
    double coefficient = fibrant::core::unset;
    if (file.read(name, "friction_coefficient", coefficient, example::friction(), "1",
                  "coefficient of friction from this stage on; left out: as before"))
        stage.friction = coefficient;
    for (const std::string& text : ramps) stage.ramps.push_back(read_ramp(file, name, text));
    return stage;
}

/// The tools that form a fabric.
inline void read_forming(SceneReader& file, const std::filesystem::path& folder, LoadFile& load) {
    cloth::FormingParameters& forming = load.forming;
    const auto length = example::above(0.0, 1e6);
    std::string punch;
    file.read("forming", "punch", punch, {},
              "STL file of a closed surface that points up along z, from the folder of this file; left out: a ball");
    file.is_a_place("forming", "punch");
    file.read("forming", "punch_radius", forming.punch_radius, length, "length", "radius of the ball, where no punch is given");
    file.read("forming", "hole_radius", forming.hole_radius, length, "length", "radius of the hole of die and holder");
    file.read("forming", "ring_width", forming.ring_width, length, "length", "width of die and holder around the hole");
    file.read("forming", "edge_radius", forming.edge_radius, length, "length", "radius of the edges of die and holder");
    file.names({{"FormingParameters.", "forming."}});
    if (load.name != "forming" || file.describes()) return;
    if (!punch.empty()) forming.punch = fibrant::exchange::read_surface(folder / punch);
    forming.validate();
}

/// @param file  of the load case; paths in it count from its folder
inline LoadFile read_load_file(SceneReader& file, const std::filesystem::path& folder) {
    LoadFile load;
    std::string scene;
    std::vector<std::string> set, stages;
    file.require("settled", "scene", scene, example::any_text(), "scene that was settled, from the folder of this file");
    file.read("settled", "set", set, "values that were given by --set then");
    file.require("settled", "checkpoint", load.checkpoint, example::any_text(),
                 "checkpoint that it left, from the working folder");
    for (const char* key : {"scene", "set", "checkpoint"}) file.is_a_place("settled", key);
    file.read("settled", "parts", load.parts, example::between(1, 8), "how many parts each element is cut into");
    file.require("loading", "case", load.name, cloth::load_case_names(), "what is done to the fabric");
    std::string ends = cloth::tow_ends_names().front();
    file.read(
        "loading", "tow_ends", ends, cloth::tow_ends_names(),
        "what tow ends do along their edge: keep their places, spread as the fabric does, go where they like, or spread with "
        "every fibre end at its place");
    file.require("loading", "stages", stages, "names of the stages, in order; each has a section");
    auto& programme = load.programme;
    double friction = fibrant::core::unset, rest_motion = fibrant::core::unset, rest_share = fibrant::core::unset, largest = 1.0,
           calm = 0.15;
    file.read("loading", "halvings", programme.halvings, example::between(0, 16),
              "how many times all increments of ramps are halved");
    file.read("loading", "friction_coefficient", friction, example::friction(), "1",
              "coefficient of friction from the first stage on; left out: as in the settled scene");
    file.read("loading", "rest_motion_over_radius", rest_motion, example::above(0.0, 10.0), "1",
              "as settle.rest_motion_over_radius; left out: as in the settled scene");
    file.read("loading", "rest_share", rest_share, example::above(0.0, 0.01), "1",
              "as settle.rest_share; left out: as in the settled scene");
    file.read("loading", "largest_displacement_over_radius", largest, example::above(0.0, 1e6), "1",
              "an increment in which a fibre moves further is given up, over the radius");
    file.read("loading", "calm_over_radius", calm, example::above(0.0, 1e6), "1",
              "damping falls after an increment in which nothing moved further, over the radius");
    file.read("contact", "points_per_element", load.points_per_element, example::between(0, 100),
              "contact points along an element; 0: as in settling");
    auto& iteration = load.scene.iteration;
    example::LinearSolver solver = load.scene.linear_solver;
    fibrant::solver::IterationParameters told;
    told.newton_limit = 30;  // near locking solutions take up to 25 iterations, and an attempt that is given up more
    told.overshoot = 0.5;
    weave::read_iteration(file, solver, told);
    file.read("solver", "overshoot", told.overshoot, {.low = 0.0, .high = 1e6, .above = true, .endless = true}, "1",
              "Newton's step is cut where the energy rises at its end by more than this part of the slope at which it fell");
    read_forming(file, folder, load);
    if (file.describes()) read_stage(file, "STAGE");
    const std::vector<std::string> known{"settled", "loading", "contact", "solver",   "output", "forming",
                                         "fabric",  "warp",    "weft",    "material", "settle"};
    for (const std::string& name : stages) {
        if (std::find(known.begin(), known.end(), name) != known.end())
            file.refuse("loading", "stages", "a list of names of stages, and \"" + name + "\" is a section of another kind");
        programme.stages.push_back(read_stage(file, name));
    }
    for (const std::string& name : file.sections_with("increments"))
        read_stage(file, name);  // those that this run leaves out are checked as well
    file.complete();
    file.check(!stages.empty(), "loading", "stages", "a list of at least one name of a stage");
    for (const auto& stage : programme.stages) check_ramps(file, stage, load.name);
    for (const auto& stage : programme.stages)
        file.check(
            static_cast<double>(stage.increments) * std::exp2(static_cast<double>(programme.halvings)) <= 1e6, stage.name,
            "increments",
            "<= 1000000 / 2^loading.halvings = " + fibrant::core::text(1e6 / std::exp2(static_cast<double>(programme.halvings))));
    load.tow_ends = static_cast<cloth::TowEnds>(std::find(cloth::tow_ends_names().begin(), cloth::tow_ends_names().end(), ends) -
                                                cloth::tow_ends_names().begin());
    try {
        load.scene = weave::read_scene((folder / scene).string(), set);
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.file() + ": settled.scene" + (set.empty() ? "" : ", settled.set") + ": " + error.what());
    }
    // What this file says goes before what the settled scene says.
    const auto take = [&](const char* key, auto& to, const auto& from) {
        if (file.given("solver", key)) to = from;
    };
    take("linear_solver", load.scene.linear_solver.strategy, solver.strategy);
    take("subdomains", load.scene.linear_solver.subdomains, solver.subdomains);
    take("petsc_options", load.scene.linear_solver.petsc_options, solver.petsc_options);
    take("step_tolerance", iteration.step_tolerance, told.step_tolerance),
        take("residual_tolerance", iteration.residual_tolerance, told.residual_tolerance);
    take("contact_tolerance", iteration.contact_tolerance, told.contact_tolerance),
        take("linear_tolerance", iteration.linear_tolerance, told.linear_tolerance);
    take("normal_limit", iteration.normal_limit, told.normal_limit),
        take("contact_limit", iteration.contact_limit, told.contact_limit), take("mixed", iteration.mixed, told.mixed);
    iteration.newton_limit = told.newton_limit, iteration.overshoot = told.overshoot;
    const double r = cloth::smallest_radius(load.scene.fabric), allowed = load.scene.settle.allowed_penetration_over_radius * r;
    if (std::isnan(friction)) friction = load.scene.settle.friction_coefficient;
    if (std::isnan(rest_motion)) rest_motion = load.scene.settle.rest_motion_over_radius;
    programme.rest_share = std::isnan(rest_share) ? load.scene.settle.rest_share : rest_share;
    programme.rest_motion = rest_motion * r, programme.rest_penetration = 2.0 * allowed,
    programme.largest_displacement = largest * r;
    programme.calm = calm * r;
    programme.reversible_displacement = fibrant::simulation::reversible_displacement(r, friction, allowed);
    programme.friction_shape = load.scene.settle.friction_shape;
    // Of a length of fibre, however many nodes it has.
    programme.damping =
        cloth::node_stiffness(load.scene.fabric, load.scene.settle.tension_strain) / static_cast<double>(load.parts);
    load.settled_fabric = load.scene.fabric, load.scene.fabric.elements *= load.parts,
    load.scene.fabric.weft_elements *= load.parts;
    example::require_room(file, "settled", "parts", 9.0 * static_cast<double>(load.scene.fabric.nodes()));
    if (!programme.stages.front().friction) programme.stages.front().friction = friction;
    file.names({{"LoadProgramme.", "loading."}, {"load_case.name", "loading.case"}});
    programme.validate();
    return load;
}

/// Refuses ramps of channels that the load case does not have.
inline void require_channels(const SceneReader& file, const LoadFile& load, const std::vector<std::string>& channels) {
    std::string all;
    for (const std::string& name : channels) all += (all.empty() ? "" : ", ") + name;
    for (const auto& stage : load.programme.stages)
        for (const auto& ramp : stage.ramps)
            file.check(std::find(channels.begin(), channels.end(), ramp.channel) != channels.end(), stage.name, "ramps",
                       "of the channels of loading.case = " + load.name + ": " + all);
}

}  // namespace fabric_loading

// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a load case as a TOML file: the settled fabric, the case, and a programme with a section a stage.

#include "../support/toml_reader.hpp"
#include "../weave/scene_file.hpp"

#include <fibrant/compositions/weave/load_cases.hpp>
#include <fibrant/compositions/weave/settle.hpp>
#include <fibrant/simulation/programme.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace fabric_loading {

namespace cloth = fibrant::compositions::weave;
using example::TomlReader;
using fibrant::Index;

/// Everything that a run is told.
struct LoadFile {
    weave::Scene scene;  ///< of the settled fabric
    std::string checkpoint, name;
    cloth::TowEnds tow_ends = cloth::TowEnds::kept;
    Index points_per_element = 0;  ///< spacing of contacts, if it is another
    Index parts = 1;               ///< that each element of the settled fabric is cut into
    cloth::FabricParameters settled_fabric;  ///< before that
    fibrant::simulation::LoadProgramme programme;
};

/// A ramp as "channel = value".
inline fibrant::simulation::Ramp read_ramp(TomlReader& file, const std::string& section, const std::string& text) {
    const std::size_t equals = text.find('=');
    fibrant::simulation::Ramp ramp;
    std::size_t used = 0;
    try {
        if (equals == std::string::npos) throw std::invalid_argument("no =");
        ramp.channel = text.substr(0, text.find_last_not_of(' ', equals - 1) + 1);
        ramp.to = std::stod(text.substr(equals + 1), &used);
    } catch (const std::exception&) {
        file.refuse(section, "ramps", "a list of texts \"channel = value\"");
    }
    return ramp;
}

/// A section of the file as a stage.
inline fibrant::simulation::ProgrammeStage read_stage(TomlReader& file, const std::string& name) {
    fibrant::simulation::ProgrammeStage stage;
    stage.name = name;
    std::vector<std::string> ramps;
    file.require(name, "increments", stage.increments);
    file.read(name, "ramps", ramps);
    file.read(name, "cycles", stage.cycles);
    file.read(name, "back", stage.back);
    file.read(name, "rest", stage.rest);
    file.read(name, "damping", stage.damping);
    file.read(name, "looseness", stage.looseness);
    double coefficient = 0.0;
    if (file.read(name, "friction_coefficient", coefficient)) stage.friction = coefficient;
    for (const std::string& text : ramps) stage.ramps.push_back(read_ramp(file, name, text));
    return stage;
}

/// @param file  of the load case; paths in it count from its folder
inline LoadFile read_load_file(TomlReader& file, const std::filesystem::path& folder) {
    LoadFile load;
    std::string scene;
    std::vector<std::string> set, stages;
    file.require("settled", "scene", scene);
    file.read("settled", "set", set);
    file.require("settled", "checkpoint", load.checkpoint);
    file.read("settled", "parts", load.parts);
    if (load.parts < 1 || load.parts > 8) file.refuse("settled", "parts", ">= 1 and <= 8");
    file.require("loading", "case", load.name);
    std::string ends = cloth::tow_ends_names().front();
    file.read("loading", "tow_ends", ends);
    const auto found = std::find(cloth::tow_ends_names().begin(), cloth::tow_ends_names().end(), ends);
    if (found == cloth::tow_ends_names().end()) file.refuse("loading", "tow_ends", "kept, spread, free or fibres");
    load.tow_ends = static_cast<cloth::TowEnds>(found - cloth::tow_ends_names().begin());
    file.require("loading", "stages", stages);
    load.scene = weave::read_scene((folder / scene).string(), set);
    const double r = cloth::smallest_radius(load.scene.fabric), allowed = load.scene.settle.allowed_penetration_over_radius * r;
    double friction = load.scene.settle.friction_coefficient, rest_motion = load.scene.settle.rest_motion_over_radius, largest = 1.0, calm = 0.15;
    auto& programme = load.programme;
    programme.rest_share = load.scene.settle.rest_share;
    file.read("loading", "halvings", programme.halvings);
    file.read("loading", "friction_coefficient", friction);
    file.read("loading", "rest_motion_over_radius", rest_motion);
    file.read("loading", "rest_share", programme.rest_share);
    file.read("loading", "largest_displacement_over_radius", largest);
    file.read("loading", "calm_over_radius", calm);
    programme.rest_motion = rest_motion * r, programme.rest_penetration = 2.0 * allowed, programme.largest_displacement = largest * r;
    programme.calm = calm * r;
    programme.reversible_displacement = std::max(0.02 * r, friction * allowed);
    // Of a length of fibre, however many nodes it has.
    programme.damping = cloth::node_stiffness(load.scene.fabric, load.scene.settle.tension_strain) / static_cast<double>(load.parts);
    load.settled_fabric = load.scene.fabric, load.scene.fabric.elements *= load.parts;
    file.read("contact", "points_per_element", load.points_per_element);
    file.read("solver", "linear_solver", load.scene.linear_solver);
    file.read("solver", "contact_tolerance", load.scene.iteration.contact_tolerance);
    file.read("solver", "residual_tolerance", load.scene.iteration.residual_tolerance);
    file.read("solver", "step_tolerance", load.scene.iteration.step_tolerance);
    file.read("solver", "linear_tolerance", load.scene.iteration.linear_tolerance);
    load.scene.iteration.newton_limit = 30;  // near locking solutions take up to 25 iterations, and an attempt that is given up more
    file.read("solver", "newton_limit", load.scene.iteration.newton_limit);
    load.scene.iteration.overshoot = 0.5;
    file.read("solver", "overshoot", load.scene.iteration.overshoot);
    for (const std::string& name : stages) programme.stages.push_back(read_stage(file, name));
    if (!stages.empty() && !programme.stages.front().friction) programme.stages.front().friction = friction;
    for (const std::string& name : file.sections_with("increments")) read_stage(file, name);  // those that this run leaves out are checked as well
    file.refuse_unknown();
    programme.validate();
    return load;
}

}  // namespace fabric_loading

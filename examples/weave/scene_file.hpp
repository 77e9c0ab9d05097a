// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a weave as a TOML file: what it may say, what it must say, and what is taken otherwise.

#include "../support/toml_reader.hpp"

#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/solver/newton.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace weave {

using example::TomlReader;
using fibrant::Index;

namespace cloth = fibrant::compositions::weave;

/// Everything that a run is told.
struct Scene {
    cloth::FabricParameters fabric;
    cloth::SettleParameters settle;
    fibrant::solver::IterationParameters iteration;
    std::string linear_solver = "two_level_pcg";  ///< one of solver::AnySolver
    Index threads = 0;                            ///< 0: as many as the machine has
    bool paraview = true;                         ///< write the ParaView files
    Index paraview_every = 1;                     ///< increments
    bool pictures = true;                         ///< write the view and the slices
    std::string unit = "mm";                      ///< of lengths, for the pictures
};

namespace detail {

/// A tow's keys. Macro-fibres are given by their radius and inertia factor, or by the real fibres that they stand for.
inline void read_tow(TomlReader& file, const std::string& section, bool required, cloth::TowParameters& tow) {
    file.read("material", "young_modulus", tow.material.young_modulus);
    file.read("material", "poisson_ratio", tow.material.poisson_ratio);
    if (required) {
        file.require(section, "fibres", tow.fibres);
    } else {
        file.read(section, "fibres", tow.fibres);
    }
    const bool radius = file.read(section, "radius", tow.fibre_radius);
    const bool factor = file.read(section, "inertia_factor", tow.inertia_factor);
    double real_fibres = fibrant::core::unset, real_diameter = fibrant::core::unset;
    const bool count = file.read(section, "real_fibres", real_fibres);
    const bool diameter = file.read(section, "real_diameter", real_diameter);
    file.read(section, "aspect", tow.aspect);
    file.read(section, "packing_gap", tow.packing_gap);
    file.read(section, "young_modulus", tow.material.young_modulus);
    file.read(section, "poisson_ratio", tow.material.poisson_ratio);
    if (!count && !diameter) {
        if (required && !radius) file.require(section, "radius", tow.fibre_radius);
        return;
    }
    if (radius || factor)
        file.refuse(section, radius ? "radius" : "inertia_factor",
                    "left out where real_fibres and real_diameter are given");
    if (!count) file.require(section, "real_fibres", real_fibres);
    if (!diameter) file.require(section, "real_diameter", real_diameter);
    try {
        const fibrant::scene::CrossSection macro =
            fibrant::scene::macro_fibre(real_fibres, real_diameter, static_cast<double>(tow.fibres));
        tow.fibre_radius = macro.semi_axis_1;
        tow.inertia_factor = macro.inertia_factor;
    } catch (const std::invalid_argument& error) {
        file.rethrow(error, {{"macro_fibre.diameter", section + ".real_diameter"},
                             {"macro_fibre.fibres", section + ".real_fibres"},
                             {"macro_fibre.macro_fibres", section + ".fibres"}});
    }
}

}  // namespace detail

/// Reads and checks what a file says of a fabric, before any work; the rest of the file is left.
/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
inline Scene read_fabric(TomlReader& file, const std::string& path, bool all) {
    const std::vector<std::pair<std::string, std::string>> names{
        {"FabricParameters.warp.fibre_radius", "warp.radius"},
        {"FabricParameters.weft.fibre_radius", "weft.radius"},
        {"FabricParameters.warp.material", "material"},
        {"FabricParameters.weft.material", "material"},
        {"FabricParameters.warp.", "warp."},
        {"FabricParameters.weft.", "weft."},
        {"FabricParameters.", "fabric."},
        {"Pattern.", "fabric.pattern."},
        {"Pattern", "fabric.pattern"},
        {"SettleParameters.friction_coefficient", "contact.friction_coefficient"},
        {"SettleParameters.allowed_penetration_over_radius", "contact.allowed_penetration_over_radius"},
        {"SettleParameters.", "settle."},
        {"IterationParameters.overshoot", "settle.overshoot"},
        {"IterationParameters.", "solver."},
        {"Scene.paraview_every", "output.paraview_every"},
        {"Scene.threads", "solver.threads"}};
    Scene scene;
    try {
        cloth::FabricParameters& fabric = scene.fabric;
        std::string name = "plain";
        std::vector<std::string> rows;
        if (file.is_list("fabric", "pattern")) {
            file.read("fabric", "pattern", rows);
            fabric.pattern = cloth::Pattern::from_rows(rows);
        } else {
            file.require("fabric", "pattern", name);
            fabric.pattern = cloth::Pattern::named(name);
        }
        file.require("fabric", "warp_tows", fabric.warp_tows);
        file.require("fabric", "weft_tows", fabric.weft_tows);
        file.require("fabric", "warp_spacing", fabric.warp_spacing);
        fabric.weft_spacing = fabric.warp_spacing;
        file.read("fabric", "weft_spacing", fabric.weft_spacing);
        file.require("fabric", "overhang", fabric.overhang);
        file.require("fabric", "elements", fabric.elements);
        detail::read_tow(file, "warp", true, fabric.warp);
        fabric.weft = fabric.warp;
        detail::read_tow(file, "weft", false, fabric.weft);

        cloth::SettleParameters& settle = scene.settle;
        file.read("settle", "tension_strain", settle.tension_strain);
        file.read("settle", "final_tension_factor", settle.final_tension_factor);
        file.read("settle", "tension_increments", settle.tension_increments);
        file.read("settle", "gap_limit_over_radius", settle.gap_limit_over_radius);
        file.read("settle", "separation_increments", settle.separation_increments);
        file.read("settle", "release_increments", settle.release_increments);
        file.read("settle", "rest_increments", settle.rest_increments);
        file.read("settle", "softness", settle.softness);
        file.read("settle", "looseness", settle.looseness);
        file.read("settle", "rest_motion_over_radius", settle.rest_motion_over_radius);
        file.read("settle", "rest_share", settle.rest_share);
        // Contacts that close and let go in turns send Newton's method to and fro: most of the attempts that a large weave gave up.
        scene.iteration.overshoot = 0.5;
        file.read("settle", "overshoot", scene.iteration.overshoot);
        file.read("contact", "friction_coefficient", settle.friction_coefficient);
        file.read("contact", "allowed_penetration_over_radius", settle.allowed_penetration_over_radius);

        auto& iteration = scene.iteration;
        file.read("solver", "linear_solver", scene.linear_solver,
                  {"automatic", "two_level_pcg", "fibre_block_pcg", "float_block_cholesky", "double_block_cholesky", "sparse_cholesky"});
        file.read("solver", "threads", scene.threads);
        file.read("solver", "step_tolerance", iteration.step_tolerance);
        file.read("solver", "residual_tolerance", iteration.residual_tolerance);
        file.read("solver", "contact_tolerance", iteration.contact_tolerance);
        file.read("solver", "linear_tolerance", iteration.linear_tolerance);
        file.read("solver", "newton_limit", iteration.newton_limit);
        file.read("solver", "normal_limit", iteration.normal_limit);
        file.read("solver", "contact_limit", iteration.contact_limit);
        file.read("solver", "mixed", iteration.mixed);

        file.read("output", "paraview", scene.paraview);
        file.read("output", "paraview_every", scene.paraview_every);
        file.read("output", "pictures", scene.pictures);
        file.read("output", "unit", scene.unit);

        if (all) file.refuse_unknown();
        fabric.validate();
        settle.validate();
        iteration.validate();
        fibrant::core::require_at_least("Scene.paraview_every", scene.paraview_every, 1);
        fibrant::core::require_at_least("Scene.threads", scene.threads, 0);
    } catch (const std::invalid_argument& error) {
        const std::string message = error.what();
        if (message.compare(0, path.size(), path) == 0) throw;
        file.rethrow(error, names);
    }
    return scene;
}

/// Reads and checks a scene, before any work.
/// @param overrides  "section.key=value"
/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
inline Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {}) {
    TomlReader file(path, overrides);
    return read_fabric(file, path, true);
}

}  // namespace weave

// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a weave as a TOML file: what it may say, what it must say, and what is taken otherwise.

#include "../support/room.hpp"
#include "../support/scene_reader.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/compositions/weave/fabric_limits.hpp>
#include <fibrant/compositions/weave/fabric_parameters.hpp>
#include <fibrant/compositions/weave/waved_path.hpp>
#include <fibrant/scene/cross_section.hpp>
#include <fibrant/solver/newton.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace weave {

using example::SceneReader;
namespace scene = fibrant::scene;
using fibrant::Index;

namespace cloth = fibrant::compositions::weave;

/// Everything that a run is told.
struct Scene {
    cloth::FabricParameters fabric;
    cloth::SettleParameters settle;
    /// Fibres of one of the tows are softer across than along.
    bool transverse() const { return fabric.warp.material.transverse.given() || fabric.weft.material.transverse.given(); }
    /// Fibres are softer across than along, or friction is not Coulomb's.
    bool own_laws() const { return transverse() || !settle.friction_shape.coulomb(); }
    fibrant::solver::IterationParameters iteration;
    example::LinearSolver linear_solver;
    Index threads = 0;         ///< 0: as many as the machine has
    bool paraview = true;      ///< write the ParaView files
    Index paraview_every = 1;  ///< increments
    bool pictures = true;      ///< write the view and the slices
    std::string unit = "mm";   ///< of lengths, for the pictures
    std::string told;          ///< what the fabric is and how it is settled, line by line
};

/// Sections that say what the fabric is, and those that say how it is settled as well.
inline const std::vector<std::string> fabric_sections{"fabric", "warp", "weft", "material"};
inline const std::vector<std::string> settled_sections{"fabric", "warp", "weft", "material", "settle", "contact"};

namespace detail {

/// A tow's keys. Macro-fibres are given by their radius and inertia factor, or by the real fibres that they stand for.
inline void read_tow(SceneReader& file, const std::string& section, bool required, cloth::TowParameters& tow) {
    if (required)
        file.require(section, "fibres", tow.fibres, example::between(1, 10000), "computed fibres in a tow");
    else
        file.read(section, "fibres", tow.fibres, example::between(1, 10000),
                  "computed fibres in a tow; left out: as in the warp");
    const bool radius = file.read(section, "radius", tow.fibre_radius, example::positive(), "length",
                                  "radius of a computed fibre; or give real_fibres and real_diameter");
    const bool factor = file.read(section, "inertia_factor", tow.inertia_factor, example::between(1e-9, 1e3), "1",
                                  "factor on the bending stiffness, below 1 for a fibre that stands for several");
    double real_fibres = fibrant::core::unset, real_diameter = fibrant::core::unset;
    const bool count = file.read(section, "real_fibres", real_fibres, example::between(1.0, 1e9), "1",
                                 "real fibres in a tow, for which the computed ones stand");
    const bool diameter =
        file.read(section, "real_diameter", real_diameter, example::positive(), "length", "diameter of a real fibre");
    for (const char* key : {"radius", "inertia_factor", "real_fibres", "real_diameter"})
        file.is_one_of_several_ways(section, key);
    file.read(section, "aspect", tow.aspect, example::between(1.0, 20.0), "1", "width over thickness of the flat tow");
    file.read(section, "packing_gap", tow.packing_gap, example::between(0.0, 1.0), "1",
              "free distance between neighbouring fibres at the start, over their diameter");
    file.read(section, "young_modulus", tow.material.young_modulus, example::positive(), "force/length^2",
              "Young's modulus of these fibres; left out: that of [material]");
    file.read(section, "poisson_ratio", tow.material.poisson_ratio, example::poisson_ratio(), "1",
              "Poisson's ratio of these fibres; left out: that of [material]");
    if (file.describes()) return;
    if (!count && !diameter) {
        if (required && !radius)
            file.require(section, "radius", tow.fibre_radius, example::positive(), "length",
                         "radius of a computed fibre; or give real_fibres and real_diameter");
        return;
    }
    if (radius || factor)
        file.refuse(section, radius ? "radius" : "inertia_factor", "left out where real_fibres and real_diameter are given");
    if (!count) file.require(section, "real_fibres", real_fibres, example::between(1.0, 1e9), "1", "");
    if (!diameter) file.require(section, "real_diameter", real_diameter, example::positive(), "length", "");
    if (!count || !diameter || tow.fibres < 1) return;
    file.check(real_fibres >= static_cast<double>(tow.fibres), section, "real_fibres",
               ">= " + section + ".fibres = " + std::to_string(tow.fibres));
    const fibrant::scene::CrossSection macro =
        fibrant::scene::macro_fibre(real_fibres, real_diameter, static_cast<double>(tow.fibres));
    tow.fibre_radius = macro.semi_axis_1;
    tow.inertia_factor = macro.inertia_factor;
}

}  // namespace detail

/// Tolerances and limits of the iteration; what a program takes otherwise stands in `iteration`.
inline void read_iteration(SceneReader& file, example::LinearSolver& linear_solver,
                           fibrant::solver::IterationParameters& iteration) {
    example::read_linear_solver(file, linear_solver);
    file.read("solver", "step_tolerance", iteration.step_tolerance, example::above(0.0, 1.0), "1",
              "largest last step of Newton's method, over the radius");
    file.read("solver", "residual_tolerance", iteration.residual_tolerance, example::above(0.0, 1.0), "1",
              "largest forces out of balance, over the greatest force");
    file.read("solver", "contact_tolerance", iteration.contact_tolerance, example::above(0.0, 1.0), "1",
              "largest motion of the last contact pass, over the radius");
    file.read("solver", "linear_tolerance", iteration.linear_tolerance, example::above(0.0, 0.01), "1",
              "largest error of a linear system, over its right-hand side");
    file.read("solver", "newton_limit", iteration.newton_limit, example::between(1, 10000), "most iterations of Newton's method");
    file.read("solver", "normal_limit", iteration.normal_limit, example::between(1, 10000), "most passes with new normals");
    file.read("solver", "contact_limit", iteration.contact_limit, example::between(1, 10000), "most passes with new contacts");
    file.read("solver", "mixed", iteration.mixed, "use single precision where it is enough");
}

/// Reads and checks what a file says of a fabric, before any work.
/// @param more  reads what else the file may say
/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
template <class More>
Scene read_fabric(SceneReader& file, const More& more) {
    file.names({{"FabricParameters.warp.fibre_radius", "warp.radius"},
                {"FabricParameters.weft.fibre_radius", "weft.radius"},
                {"FabricParameters.warp.material", "material"},
                {"FabricParameters.weft.material", "material"},
                {"FabricParameters.warp.", "warp."},
                {"FabricParameters.weft.", "weft."},
                {"FabricParameters.", "fabric."},
                {"Pattern.rows", "fabric.pattern"},
                {"Pattern.name", "fabric.pattern"},
                {"Pattern", "fabric.pattern"},
                {"SettleParameters.friction_coefficient", "contact.friction_coefficient"},
                {"SettleParameters.allowed_penetration_over_radius", "contact.allowed_penetration_over_radius"},
                {"SettleParameters.", "settle."},
                {"Loading.damping_of_fibres", "warp, weft: stiffness of a fibre over that of the softest one"},
                {"IterationParameters.overshoot", "settle.overshoot"},
                {"IterationParameters.", "solver."}});
    Scene scene;
    cloth::FabricParameters& fabric = scene.fabric;
    std::string name = "plain";
    std::vector<std::string> rows;
    if (file.is_list("fabric", "pattern"))
        file.read("fabric", "pattern", rows, "one text for each warp tow: 1 where it lies above the weft tow, 0 where below");
    else
        file.require("fabric", "pattern", name, example::any_text(),
                     "plain, twill22, twill31, satin5, satin8, or a list with one text for each warp tow: 1 where it lies above "
                     "the weft tow, 0 where below");
    file.require("fabric", "warp_tows", fabric.warp_tows, example::between(1, 1000), "number of tows along x");
    file.require("fabric", "weft_tows", fabric.weft_tows, example::between(1, 1000), "number of tows along y");
    file.require("fabric", "warp_spacing", fabric.warp_spacing, example::positive(), "length",
                 "distance between the middles of neighbouring warp tows");
    fabric.weft_spacing = fabric.warp_spacing;
    file.read("fabric", "weft_spacing", fabric.weft_spacing, example::positive(), "length",
              "the same for weft tows; left out: warp_spacing");
    file.require("fabric", "overhang", fabric.overhang, example::positive(), "length",
                 "length of a tow beyond its outermost crossings, at each end");
    file.require("fabric", "elements", fabric.elements, example::between(1, 100000), "elements along a fibre");
    file.read("fabric", "weft_elements", fabric.weft_elements, example::between(0, 100000),
              "elements along a weft fibre; 0: as many as along a warp fibre");
    scene::ElasticMaterial material;
    file.read("material", "young_modulus", material.young_modulus, example::positive(), "force/length^2",
              "Young's modulus of the fibres");
    file.read("material", "poisson_ratio", material.poisson_ratio, example::poisson_ratio(), "1",
              "Poisson's ratio of the fibres");
    std::string law = "isotropic";
    example::read_transverse(file, "material", law, material.transverse);
    std::string warp_law = law, weft_law = law;
    fabric.warp.material = material;
    detail::read_tow(file, "warp", true, fabric.warp);
    fabric.weft = fabric.warp;
    example::read_own_transverse(file, "warp", warp_law, fabric.warp.material.transverse);
    if (!std::isnan(material.young_modulus)) fabric.weft.material.young_modulus = material.young_modulus;
    if (!std::isnan(material.poisson_ratio)) fabric.weft.material.poisson_ratio = material.poisson_ratio;
    detail::read_tow(file, "weft", false, fabric.weft);
    example::read_own_transverse(file, "weft", weft_law, fabric.weft.material.transverse);

    cloth::SettleParameters& settle = scene.settle;
    file.read("settle", "tension_strain", settle.tension_strain, example::above(0.0, 0.2), "1",
              "tension of a tow while tows part, over its E A");
    std::string start = "automatic";
    file.read("settle", "start", start, {"automatic", "flat", "waved"},
              "where tows begin: straight in the plane; over and under each other, about as they come to lie; or by which pays");
    settle.start = start == "flat" ? cloth::Start::flat : start == "waved" ? cloth::Start::waved : cloth::Start::automatic;
    file.read("settle", "final_tension_factor", settle.final_tension_factor, example::above(0.0, 1.0), "1",
              "tension at the end, over that while tows part");
    file.read("settle", "tension_increments", settle.tension_increments, example::increments(),
              "increments in which the tension is raised");
    file.read("settle", "gap_limit_over_radius", settle.gap_limit_over_radius, example::above(0.0, 10.0), "1",
              "how far fibres that start in each other part in an increment, over the radius");
    file.read("settle", "separation_increments", settle.separation_increments, example::increments(),
              "most increments until no tows overlap");
    file.read("settle", "release_increments", settle.release_increments, example::increments(),
              "increments in which the tension is lowered");
    file.read("settle", "rest_increments", settle.rest_increments, example::increments(),
              "most increments of each stage that waits for rest");
    file.read("settle", "softness", settle.softness, example::between(1.0, 20.0), "1",
              "penetration allowed on the way, over that at rest");
    file.read("settle", "looseness", settle.looseness, example::looseness(), "1",
              "factor on the tolerances of passes on the way to rest");
    file.read("settle", "rest_motion_over_radius", settle.rest_motion_over_radius, example::above(0.0, 10.0), "1",
              "the fabric is at rest when it moves by less than this in an increment, over the radius; or");
    file.read("settle", "rest_share", settle.rest_share, example::above(0.0, 0.01), "1",
              "when damping holds less than this part of the forces");
    // Contacts that close and let go in turns send Newton's method to and fro: most of the attempts that a large weave gave up.
    scene.iteration.overshoot = 0.5;
    file.read("settle", "overshoot", scene.iteration.overshoot, {.low = 0.0, .high = 1e6, .above = true, .endless = true}, "1",
              "Newton's step is cut where the energy rises at its end by more than this part of the slope at which it fell");
    example::read_friction(file, settle.friction_coefficient, "coefficient of friction, once tows have parted; 0: none");
    example::read_friction_shape(file, settle.friction_shape);
    example::read_allowed_penetration(file, settle.allowed_penetration_over_radius,
                                      "how deep a contact may be at the end, over the radius");
    read_iteration(file, scene.linear_solver, scene.iteration);
    file.read("solver", "threads", scene.threads, example::between(0, 100000), "0: as many as the machine has");
    file.read("output", "paraview", scene.paraview, "files for ParaView");
    file.read("output", "paraview_every", scene.paraview_every, example::increments(),
              "one file for ParaView each so many increments");
    file.read("output", "pictures", scene.pictures, "a view and slices along each tow");
    file.read("output", "unit", scene.unit, example::any_text(), "of lengths, in pictures");
    more();
    file.complete();

    example::check_transverse(file, "material", law);
    example::check_friction_shape(file, settle.friction_shape);
    example::check_transverse(file, "warp", file.given("warp.law", "kind") ? warp_law : "isotropic");
    example::check_transverse(file, "weft", file.given("weft.law", "kind") ? weft_law : "isotropic");
    fabric.pattern = file.is_list("fabric", "pattern") ? cloth::Pattern::from_rows(rows) : cloth::Pattern::named(name);
    if (std::isnan(fabric.warp.material.young_modulus))
        file.refuse("material", "young_modulus", "given, here or as warp.young_modulus");
    if (std::isnan(fabric.warp.material.poisson_ratio))
        file.refuse("material", "poisson_ratio", "given, here or as warp.poisson_ratio");
    const double unknowns = 9.0 * static_cast<double>(fabric.nodes());
    const bool fine = std::max(fabric.elements, fabric.weft_elements) > 100,
               many = fabric.warp_tows > 100 || fabric.weft_tows > 100;
    const char* blamed = many ? fabric.warp_tows > fabric.weft_tows ? "warp_tows" : "weft_tows"
                         : fabric.weft_elements > fabric.elements ? "weft_elements"
                                                                  : "elements";
    if (!fine && !many)
        example::require_room(file, fabric.warp.fibres >= fabric.weft.fibres ? "warp" : "weft", "fibres", unknowns);
    else
        example::require_room(file, "fabric", blamed, unknowns);
    for (const auto& [tow, section] : {std::pair{&fabric.warp, "warp"}, std::pair{&fabric.weft, "weft"}}) {
        const double r = tow->fibre_radius;
        file.check(fabric.overhang <= 1e4 * r && fabric.warp_spacing <= 1e4 * r && fabric.weft_spacing <= 1e4 * r, "fabric",
                   fabric.overhang > 1e4 * r       ? "overhang"
                   : fabric.warp_spacing > 1e4 * r ? "warp_spacing"
                                                   : "weft_spacing",
                   "<= 10000 radii of a " + std::string(section) + " fibre = " + fibrant::core::text(1e4 * r));
    }
    // Springs hold the families by what each resists with: far from each other, one of them would be held by nothing or
    // not at all.
    constexpr double most_stiff = 1e6;
    const double warp = fabric.warp.material.young_modulus, weft = fabric.weft.material.young_modulus;
    if (std::max(warp, weft) > most_stiff * std::min(warp, weft)) {
        const bool own = file.given("weft", "young_modulus"), softer = (own ? weft : warp) < (own ? warp : weft);
        file.refuse(own ? "weft" : "warp", "young_modulus",
                    (softer ? ">= a millionth of " : "<= 1000000 times ") +
                        std::string(own ? "that of the warp, " : "that of the weft, ") + fibrant::core::text(own ? warp : weft));
    }
    file.check(settle.allowed_penetration_over_radius <= settle.gap_limit_over_radius, "contact",
               "allowed_penetration_over_radius",
               "<= settle.gap_limit_over_radius = " + fibrant::core::text(settle.gap_limit_over_radius));
    fabric.validate();
    settle.validate();
    cloth::require_turns(fabric, settle);
    if (settle.start == cloth::Start::waved)
        if (const std::string why = cloth::no_wave(fabric); !why.empty())
            file.refuse("settle", "start", "flat or automatic: " + why);
    scene.iteration.validate();
    scene.told = file.scene(settled_sections);
    return scene;
}

/// Reads and checks a scene, before any work.
/// @param overrides  "section.key=value"
/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
inline Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {}) {
    SceneReader file(path, overrides);
    try {
        return read_fabric(file, [] {});
    } catch (const std::invalid_argument& error) {
        throw std::invalid_argument(file.told(error.what()));
    }
}

}  // namespace weave

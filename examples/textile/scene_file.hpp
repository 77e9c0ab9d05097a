// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a textile as a TOML file: a generator or a file of curves, its yarns, how they are held and settled.

#include "../support/room.hpp"
#include "../support/scene_reader.hpp"
#include "../support/usual_keys.hpp"

#include <fibrant/compositions/textile/braids.hpp>
#include <fibrant/compositions/textile/free_ends.hpp>
#include <fibrant/compositions/textile/imported.hpp>
#include <fibrant/compositions/textile/knits.hpp>
#include <fibrant/compositions/textile/load_cases.hpp>
#include <fibrant/compositions/textile/periodic.hpp>
#include <fibrant/compositions/textile/plies.hpp>
#include <fibrant/compositions/textile/settle.hpp>
#include <fibrant/compositions/textile/strands.hpp>
#include <fibrant/compositions/textile/triaxial_weave.hpp>
#include <fibrant/compositions/textile/weaves.hpp>
#include <fibrant/exchange/files.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace textile {

using example::SceneReader;
using fibrant::Index;
namespace cloth = fibrant::compositions::textile;

/// What is done to the settled textile.
struct Load {
    bool wanted = false;
    bool cell = false;  ///< six small strains of a cell that repeats, in place of a load case
    cloth::LoadCaseParameters parameters{};
    Index increments = 20, cycles = 0;
    double damping = 1e-4, rest_damping = 0.1;  ///< over the stiffness of a node against moving aside
};

/// Unknowns above which fibres that lie on each other in depth are solved by two levels if nothing else is asked for: a factor
/// takes 3.5 times as long for a plied yarn of 17,000 and an orthogonal weave of 52,000, six and ten times for bundles of 23,000
/// and 186,000.
inline constexpr double large_factor = 10000.0;

/// Of few fibres a factor is the fastest, and of loops that hold each other at points; ranks cannot share it.
inline constexpr const char* usual_solver =
#ifdef FIBRANT_WITH_MPI
    "automatic";
#else
    "float_block_cholesky";
#endif

/// Everything that a run is told.
struct Scene {
    std::string generator;
    cloth::Textile textile;
    cloth::SettleParameters settle;
    cloth::Fineness fineness;
    bool own_laws = false;  ///< fibres are softer across than along, or friction is not Coulomb's
    example::LinearSolver linear_solver{.strategy = usual_solver};
    Load load{};
    bool surfaces = false;                                    ///< of yarns are written
    double voxel_spacing = 0.0;                               ///< [length]; 0: none are written
    std::vector<fibrant::exchange::FileCurve> file_curves{};  ///< that the textile is of, as the file has them
};

inline const std::vector<std::string> generators{"flat_braid",     "tubular_braid", "levels",   "leno",
                                                 "triaxial_weave", "weft_knit",     "tricot",   "plied",
                                                 "chain_mail",     "net",           "stitched", "file"};

namespace detail {

/// @param required  its radius is
inline void read_type(SceneReader& file, const std::string& section, bool required, cloth::YarnType& type,
                      const char* left_out = "radius of a fibre; left out: as in [yarn]") {
    const auto length = example::positive();
    if (required)
        file.require(section, "radius", type.radius, length, "length",
                     "radius of a fibre; of a file that has radii it may be left out");
    else
        file.read(section, "radius", type.radius, length, "length", left_out);
    file.read(section, "fibres", type.fibres, example::between(1, 10000), "fibres in a yarn");
    file.read(section, "inertia_factor", type.inertia_factor, example::between(1e-9, 1e3), "1",
              "factor on the bending stiffness, below 1 for a soft thread");
    file.read(section, "aspect", type.aspect, example::between(1.0, 20.0), "1",
              "width over thickness of a yarn of several fibres");
    file.read(section, "packing_gap", type.packing_gap, example::between(0.0, 1.0), "1",
              "free distance between fibres of a yarn at the start, over their diameter");
    file.read(section, "twist", type.twist, example::any_number(), "turn/length",
              "twist of the fibres of a yarn; positive is right-handed");
}

/// The section [loading], which may be left out.
inline void read_load(SceneReader& file, Load& load) {
    load.wanted = file.has_section("loading");
    if (!load.wanted && !file.describes()) return;
    const std::vector<std::string> axes{"x", "y", "z"};
    std::string axis = "x", across = "z";
    std::vector<std::string> cases = cloth::load_case_names();
    cases.push_back("cell");
    file.require("loading", "case", load.parameters.name, cases,
                 "what is done to the settled textile: grips at both ends are pulled apart, moved aside or turned, plates press "
                 "it, or, where ends are periodic, a cell gets six small strains one by one");
    load.cell = load.parameters.name == "cell";
    const bool plates = load.parameters.name == "compaction";
    if (plates) axis = "z", across = "x";
    file.read("loading", "axis", axis, axes, "from one grip to the other, or across the plates; left out: x, and z of plates");
    if (axis == across) across = "x";
    file.read("loading", "across", across, axes,
              "direction of a shear, or in which a bent sample rises; left out: z, and x where axis is z");
    if ((!plates && !load.cell) || file.describes())
        file.require("loading", "grip", load.parameters.grip, example::positive(), "length",
                     "length of either grip along the axis");
    file.require("loading", "amount", load.parameters.amount, example::between(-1e3, 1e3), "1",
                 "strain of the length between the grips, tangent of the shear, angle between the grips [radian], approach of "
                 "the plates over their distance, or strain of a cell, small; its curvatures are this over the radius");
    file.read(
        "loading", "guided", load.parameters.guided,
        "ends that no grip holds, but that were held or pulled, keep their places across the axis in tension, along the third "
        "axis in shear and bending; false: they are free");
    file.read("loading", "increments", load.increments, example::between(1, 100000),
              "increments that take the load to its amount");
    file.read("loading", "cycles", load.cycles, example::between(0, 10000), "times there and back; 0: there only");
    file.read("loading", "damping", load.damping, example::between(0.0, 1e6), "1",
              "stiffness of the damping, over that of a node against moving aside");
    file.read("loading", "rest_damping", load.rest_damping, example::above(0.0, 1e6), "1",
              "the same until the sample is at rest in its grips");
    load.parameters.axis = axis[0] - 'x', load.parameters.across = across[0] - 'x';
    if (file.describes()) return;
    file.check(axis != across, "loading", "across", "another axis than loading.axis");
    // What is missing is told by `complete`.
    if (std::isnan(load.parameters.amount) || (!plates && !load.cell && std::isnan(load.parameters.grip))) return;
    constexpr double largest_strain = 0.1;  // a stiffness is that of small strains: waves of yarns are some tenths themselves
    if (load.cell)
        file.check(load.parameters.amount != 0.0 && std::abs(load.parameters.amount) <= largest_strain, "loading", "amount",
                   "from " + fibrant::core::text(-largest_strain) + " to " + fibrant::core::text(largest_strain) +
                       ", and not 0, of a cell");
    else
        load.parameters.validate();
}

/// @param single  height of yarns of one fibre where the scene says none
inline void read_height(SceneReader& file, const std::string& section, double& height, const cloth::YarnType& yarn, double single,
                        const std::string& more = "") {
    double given = fibrant::core::unset;
    const std::string several = fibrant::core::text(cloth::apart_height),
                      sentence =
                          "height of yarns at crossings above the middle surface, over their half thickness; below 1 they start "
                          "in each other; of yarns of several fibres at least " +
                          several + ". Left out: " + several + ", and of single fibres " + fibrant::core::text(single) + more;
    file.read(section, "height_over_radius", given, example::above(0.0, 10.0), "1", sentence.c_str());
    if (!std::isnan(given))
        height = given;
    else if (yarn.fibres == 1)
        height = single;
}

inline void read_overhang(SceneReader& file, const std::string& section, double& overhang) {
    file.read(section, "overhang", overhang, example::not_negative(), "length",
              "straight ends beyond the outermost crossings; 0: a yarn's way from crossing to crossing and two diameters");
}

/// Refuses a packing that is twisted so much that its outer fibres would lie at more than 63 degrees to the yarn, as plies may.
inline void check_twist(const SceneReader& file, const std::string& section, const cloth::YarnType& type) {
    const double outer = cloth::half_width(type) - type.radius;  // of the packing, to the middle of a fibre
    if (type.fibres == 1 || !(outer > 0.0)) return;
    const double most = 1.0 / (std::numbers::pi * outer);
    file.check(std::abs(type.twist) <= most, section, "twist",
               "from " + fibrant::core::text(-most) + " to " + fibrant::core::text(most) +
                   ", or outer fibres lie at more than 63 degrees to the yarn");
}

/// Reads the section of the generator; all of them where there is no file.
/// @param curves  gets those of a file, if it is one
/// @param periodic  it goes on at its ends
inline cloth::Textile generate(SceneReader& file, const std::string& generator, const cloth::YarnType& yarn,
                               const cloth::YarnType& binder, bool periodic, std::vector<fibrant::exchange::FileCurve>& curves) {
    const bool all = file.describes();
    cloth::Textile made;
    const auto wanted = [&](const char* name) { return all || generator == name; };
    const auto positive = example::positive();
    if (wanted("flat_braid")) {
        cloth::FlatBraid braid;
        braid.type = yarn, braid.periodic = periodic;
        file.require("flat_braid", "yarns", braid.yarns, example::between(3, 1000), "number of yarns");
        file.require("flat_braid", "half_width", braid.half_width, positive, "length", "distance from the middle to an edge");
        file.require("flat_braid", "period", braid.period, positive, "length",
                     "length in which a yarn goes to the other edge and back");
        file.read("flat_braid", "periods", braid.periods, example::above(0.0, 1e4), "1", "number of periods");
        file.read("flat_braid", "over", braid.over, example::between(1, 2), "how many yarns in turn a yarn passes above");
        read_overhang(file, "flat_braid", braid.overhang);
        read_height(file, "flat_braid", braid.height_over_radius, yarn, 0.3,
                    "; of braids of several fibres up to 1.65, as they need");
        if (!all) file.complete(), made = cloth::flat_braid(braid);
    }
    if (wanted("tubular_braid")) {
        cloth::TubularBraid braid;
        braid.type = yarn, braid.periodic = periodic;
        file.require("tubular_braid", "carriers", braid.carriers, example::between(2, 1000), "number of yarns each way round");
        file.require("tubular_braid", "radius", braid.radius, positive, "length",
                     "radius of the tube, to the middle of the yarns");
        file.require("tubular_braid", "pitch", braid.pitch, positive, "length", "length of a full turn along the axis");
        file.read("tubular_braid", "turns", braid.turns, example::above(0.0, 1e4), "1", "number of turns");
        file.read("tubular_braid", "over", braid.over, example::between(1, 100),
                  "how many yarns in turn a yarn passes outside, a divisor of the carriers: 1 for 1x1, 2 for 2x2");
        file.read("tubular_braid", "axials", braid.axials,
                  "add straight yarns along the axis, one for each yarn of one way, where over is 1");
        read_overhang(file, "tubular_braid", braid.overhang);
        read_height(file, "tubular_braid", braid.height_over_radius, yarn, braid.axials ? cloth::apart_height : 0.05,
                    ", 1.05 with axial yarns; of braids of several fibres up to 1.65, as they need");
        if (!all) file.complete(), made = cloth::tubular_braid(braid);
    }
    if (wanted("levels")) {
        cloth::LevelPlan plan;
        std::vector<std::string> rows, lifts;
        std::vector<std::string> kinds;
        plan.warp = plan.weft = yarn, plan.binder = binder, plan.periodic = periodic;
        file.read(
            "levels", "levels", rows,
            "one text for each warp, a digit for each column, a to z for 10 to 35: how many wefts of the column lie below the "
            "warp");
        file.read("levels", "lifts", lifts,
                  "in place of levels: one text for each warp, a digit for each pick: 1 where the warp is up; picks go column by "
                  "column, from the lowest layer up");
        file.read("levels", "kinds", kinds, "one text for each warp, warp or binder; left out: all warp");
        file.is_one_of_several_ways("levels", "levels"), file.is_one_of_several_ways("levels", "lifts");
        file.read("levels", "layers", plan.layers, example::between(1, static_cast<double>(cloth::highest_level)),
                  "number of layers of wefts");
        file.read("levels", "columns", plan.columns, example::between(0, 10000),
                  "number of columns of wefts; 0: as many as are drawn");
        file.require("levels", "column_spacing", plan.column_spacing, positive, "length",
                     "distance of neighbouring columns of wefts");
        file.require("levels", "warp_spacing", plan.warp_spacing, positive, "length", "distance of neighbouring warps");
        file.read("levels", "layer_spacing", plan.layer_spacing, example::not_negative(), "length",
                  "distance of wefts in a column; 0: yarns just do not touch");
        file.read("levels", "overhang", plan.overhang, example::not_negative(), "length",
                  "length of a yarn beyond its outermost crossings; 0: one spacing");
        if (!all) {
            file.complete();
            if (rows.empty() == lifts.empty()) file.refuse("levels", "levels", "given, or levels.lifts, and not both");
            if (!lifts.empty()) {
                std::vector<std::vector<bool>> lift;
                for (const std::string& row : lifts) {
                    lift.emplace_back();
                    for (const char c : row) {
                        if (c != '0' && c != '1') file.refuse("levels", "lifts", "texts of 0 and 1");
                        lift.back().push_back(c == '1');
                    }
                }
                plan.levels = cloth::levels_of_lifts(lift, plan.layers);
            } else {
                plan.levels = cloth::levels_of(rows);
            }
            for (const std::string& kind : kinds) {
                if (kind != "warp" && kind != "binder") file.refuse("levels", "kinds", "texts warp and binder");
                plan.warp_types.push_back(kind == "binder" ? 1 : 0);
            }
            made = cloth::woven(plan);
            cloth::require_wefts_held(plan, lifts.empty() ? "levels.levels" : "levels.lifts");
        }
    }
    if (wanted("leno")) {
        cloth::LenoWeave weave;
        weave.type = yarn;
        file.require("leno", "pairs", weave.pairs, example::between(1, 1000), "number of pairs of a ground and a doup end");
        file.require("leno", "picks", weave.picks, example::between(2, 10000), "number of wefts");
        file.require("leno", "pick_spacing", weave.pick_spacing, positive, "length", "distance of neighbouring wefts");
        file.require("leno", "pair_spacing", weave.pair_spacing, positive, "length", "distance of neighbouring pairs");
        file.require("leno", "aside", weave.aside, positive, "length", "distance of the doup end from its ground end at a weft");
        if (!all) file.complete(), made = cloth::leno(weave);
    }
    if (wanted("triaxial_weave")) {
        cloth::TriaxialWeave weave;
        weave.type = yarn;
        file.require("triaxial_weave", "spacing", weave.spacing, positive, "length",
                     "distance of neighbouring yarns of a family");
        file.require("triaxial_weave", "radius", weave.radius, positive, "length", "radius of the round sample");
        read_height(file, "triaxial_weave", weave.height_over_radius, yarn, 0.5);
        if (!all) file.complete(), made = cloth::triaxial_weave(weave);
    }
    if (wanted("weft_knit")) {
        cloth::WeftKnit knit;
        knit.type = yarn;
        file.read("weft_knit", "stitches", knit.stitches,
                  "one text for each course, a letter for each wale: f (face) or r (reverse); repeated both ways");
        file.require("weft_knit", "courses", knit.courses, example::between(1, 1000), "number of courses");
        file.require("weft_knit", "wales", knit.wales, example::between(1, 1000), "number of wales");
        file.require("weft_knit", "wale_spacing", knit.wale_spacing, positive, "length", "distance of neighbouring wales");
        file.require("weft_knit", "course_spacing", knit.course_spacing, positive, "length", "distance of neighbouring courses");
        file.require("weft_knit", "loop_height", knit.loop_height, positive, "length", "half of a loop's height in the plane");
        file.read("weft_knit", "bulge", knit.bulge, positive, "length",
                  "how much a loop is wider than its neck, on each side; left out: a fifth of wale_spacing");
        read_height(file, "weft_knit", knit.height_over_radius, yarn, 0.9);
        if (!all) file.complete(), made = cloth::weft_knit(knit);
    }
    if (wanted("tricot")) {
        cloth::Tricot knit;
        knit.type = yarn;
        file.require("tricot", "needles", knit.needles, example::between(2, 1000), "number of needles");
        file.require("tricot", "courses", knit.courses, example::between(2, 1000), "number of courses");
        file.require("tricot", "needle_spacing", knit.needle_spacing, positive, "length", "distance of neighbouring needles");
        file.require("tricot", "course_spacing", knit.course_spacing, positive, "length", "distance of neighbouring courses");
        file.require("tricot", "loop_height", knit.loop_height, positive, "length", "height of a loop above its feet");
        read_height(file, "tricot", knit.height_over_radius, yarn, 0.95);
        if (!all) file.complete(), made = cloth::tricot(knit);
    }
    if (wanted("plied")) {
        cloth::Plied rope;
        rope.type = yarn, rope.periodic = periodic;
        file.require("plied", "plies", rope.plies, example::between(2, 6), "number of plies");
        file.require("plied", "pitch", rope.pitch, positive, "length", "length of a full turn of the plies");
        file.read("plied", "strands", rope.strands, example::between(1, 6),
                  "number of strands of so many plies each; 1: a yarn of plies alone");
        file.read("plied", "strand_pitch", rope.strand_pitch, positive, "length",
                  "length of a full turn of the strands, which turn against the plies");
        file.require("plied", "length", rope.length, positive, "length", "length along the axis");
        file.read("plied", "slack", rope.slack, example::between(0.0, 1.0), "1",
                  "free distance of neighbours, over their thickness");
        if (!all) file.complete(), made = cloth::plied(rope);
    }
    if (wanted("chain_mail")) {
        cloth::ChainMail mail;
        mail.type = yarn;
        file.require("chain_mail", "rows", mail.rows, example::between(2, 100), "number of rows");
        file.require("chain_mail", "columns", mail.columns, example::between(2, 100), "number of rings in a row");
        file.require("chain_mail", "ring_radius", mail.ring_radius, positive, "length",
                     "radius of a ring, to the middle of its wire");
        file.read("chain_mail", "pitch", mail.pitch, positive, "length",
                  "distance of rings in a row, of two ring radii and a radius of the wire at least as they are drawn; left out: "
                  "2.6 ring radii");
        file.read("chain_mail", "row_pitch", mail.row_pitch, positive, "length", "distance of rows; left out: 0.9 ring radii");
        file.read("chain_mail", "tilt_deg", mail.tilt_deg, example::above(0.0, 80.0), "degree",
                  "tilt of rings, one way and the other in turn");
        if (!all) file.complete(), made = cloth::chain_mail(mail);
    }
    if (wanted("net")) {
        cloth::Net net;
        net.type = yarn;
        file.require("net", "yarns", net.yarns, example::between(2, 1000), "number of yarns");
        file.require("net", "spacing", net.spacing, positive, "length", "distance of neighbouring yarns");
        file.require("net", "period", net.period, positive, "length", "length of a period of a yarn");
        file.read("net", "periods", net.periods, example::above(0.0, 1e4), "1", "number of periods");
        file.read("net", "overlap", net.overlap, example::not_negative(), "length",
                  "how far yarns reach beyond the turns of their neighbours; 0: four half widths");
        read_height(file, "net", net.height_over_radius, yarn, 0.5);
        if (!all) file.complete(), made = cloth::net(net);
    }
    if (wanted("stitched")) {
        cloth::StitchedPlies plies;
        plies.yarn = yarn, plies.thread = binder;
        std::vector<std::string> angles;
        file.read("stitched", "angles_deg", angles,
                  "a text for each ply, from the lowest up: the angle of its yarns to x in degrees; threads go along x");
        file.require("stitched", "yarn_spacing", plies.yarn_spacing, positive, "length",
                     "distance of neighbouring yarns of a ply");
        file.require("stitched", "length", plies.length, positive, "length", "length of the sample along x");
        file.require("stitched", "width", plies.width, positive, "length", "width of the sample along y");
        file.require("stitched", "stitch_length", plies.stitch_length, positive, "length",
                     "from one place where a thread goes through to the next, counted from the middle, where no yarn lies");
        file.require("stitched", "row_spacing", plies.row_spacing, positive, "length", "distance of neighbouring threads");
        file.read("stitched", "sideways", plies.sideways, example::not_negative(), "length",
                  "by which threads go to and fro across from stitch to stitch: so they hold yarns along x");
        if (!all) {
            file.complete();
            for (const std::string& angle : angles)
                plies.angles_deg.push_back(
                    fibrant::exchange::detail::number<double>(angle, file.file(), "stitched.angles_deg", "an angle"));
            made = cloth::stitched(plies);
        }
    }
    if (wanted("file")) {
        std::string path, seen = "plane";
        double smooth = 0.0;
        fibrant::exchange::CleanParameters clean;
        file.require("file", "path", path, example::any_text(),
                     "file of centrelines, from the folder of the scene: .csv, .vtk, .vtp, .obj, .bcc, .inp or .tg3");
        file.read("file", "scale", clean.scale, positive, "1", "factor on all lengths of the file");
        file.read("file", "smooth", smooth, example::between(0.0, 100.0), "1",
                  "width of the smoothing along a fibre, in points; 0: none");
        file.read("file", "largest_turn_deg", clean.largest_turn_deg, example::above(0.0, 180.0), "degree",
                  "largest turn from one point to the next; more is refused");
        file.read("file", "crossings", seen, {"plane", "tube", "none"},
                  "who is above is seen along z (plane), from the z axis outwards (tube), or not looked for (none): then links "
                  "are compared");
        if (!all) {
            file.complete();
            const std::filesystem::path whole = std::filesystem::path(file.file()).parent_path() / path;
            fibrant::exchange::CleanParameters own = clean;
            if (smooth > 0.0) own.largest_turn_deg = 180.0;  // as they are smoothed
            fibrant::core::with_place([] { return "file.path, smooth, largest_turn_deg"; },
                                      [&] {
                                          curves = fibrant::exchange::read_curves(whole, own);
                                          if (!(smooth > 0.0)) return;
                                          std::vector<fibrant::exchange::FileCurve> after = curves;
                                          for (auto& curve : after)
                                              curve.points = cloth::smoothed(curve.points, smooth, curve.closed);
                                          fibrant::exchange::require_turns(after, whole.string(), clean.largest_turn_deg);
                                      });
            for (const fibrant::exchange::FileCurve& curve : curves)
                if (yarn.fibres == 1 && !std::isnan(yarn.radius) && !std::isnan(curve.radius) && curve.radius != yarn.radius) {
                    std::fprintf(stderr, "textile: note: radii of %s are not used, for yarn.radius is given\n", path.c_str());
                    break;
                }
            made = cloth::textile_of(curves, yarn, {fibrant::Vec3::UnitZ(), seen == "tube", fibrant::Vec3::Zero()}, smooth);
            if (seen == "none") made.crossings.clear();
        }
    }
    return made;
}

/// Refuses free ends of yarns that are straight at rest and come off: nothing but friction holds those.
inline void check_free_ends(const SceneReader& file, const Scene& scene) {
    const std::string drawn = ", or ends.straight_at_rest = false of yarns that are drawn apart: ";
    if (scene.generator == "plied" && scene.textile.paths.front().straight)
        file.refuse("ends", "kind", "held or pulled" + drawn + "plies that are straight at rest unwind");
    const cloth::FrictionNeeded needed = cloth::friction_that_holds(scene.textile);
    if (needed.coefficient <= scene.settle.friction_coefficient) return;
    constexpr double plausible = 2.0;  // friction: more of it is no remedy
    const std::string more = needed.coefficient < plausible
                                 ? ", or contact.friction_coefficient >= " + fibrant::core::text(needed.coefficient)
                                 : std::string();
    file.refuse("ends", "kind",
                "held or pulled" + more + drawn + scene.textile.label(needed.path) +
                    " is straight at rest, and comes off the yarns that bend it");
}

/// Whether fibres lie on each other in depth, and not in a sheet: in layers, in a twisted yarn, side by side in a bundle.
inline bool deep(const Scene& scene) {
    for (const char* generator : {"levels", "plied", "stitched"})
        if (scene.generator == generator) return true;
    return scene.generator == "file" && scene.textile.crossings.empty();
}

}  // namespace detail

/// That a run takes, contacts and solver included.
constexpr double bytes_an_unknown = 6000.0;

/// Reads and checks what a file says, before any work.
inline Scene read_scene(SceneReader& file) {
    file.names({{"FlatBraid.", "flat_braid."},
                {"TubularBraid.", "tubular_braid."},
                {"LevelPlan.warp_types", "levels.kinds"},
                {"LevelPlan.", "levels."},
                {"lift", "levels.lifts: lift"},
                {"levels: ", "levels.levels: "},
                {"LenoWeave.", "leno."},
                {"TriaxialWeave.", "triaxial_weave."},
                {"WeftKnit.", "weft_knit."},
                {"Tricot.", "tricot."},
                {"Plied.", "plied."},
                {"ChainMail.", "chain_mail."},
                {"Net.", "net."},
                {"StitchedPlies.", "stitched."},
                {"YarnType.", "yarn."},
                {"SettleParameters.", "settle."},
                {"Fineness.", "yarn."},
                {"LoadCaseParameters.name", "loading.case"},
                {"LoadCaseParameters.", "loading."},
                {"grid_around: ", "output.voxel_spacing: "},
                {"VoxelGrid.counts: ", "output.voxel_spacing: "}});
    Scene scene;
    cloth::YarnType yarn;
    std::string ends = "held";
    double tension = 0.0;
    bool straight = true;
    file.require("textile", "generator", scene.generator, generators, "what is made; the section of this name has its numbers");
    const bool of_file = scene.generator == "file" && !file.describes();
    if (of_file)
        file.names({{"Path.", "file.path, scale: "},
                    {"yarn ", "file.path, scale: yarn "},
                    {"radius of curve ", "yarn.radius: radius of curve "}});
    detail::read_type(file, "yarn", !of_file, yarn, "radius of a fibre; left out: as the file has it");
    if (of_file && yarn.fibres > 1) file.check(!std::isnan(yarn.radius), "yarn", "radius", "given, of yarns of several fibres");
    example::read_material(file, "yarn", yarn.material);
    std::string law = "isotropic";
    example::read_transverse(file, "yarn", law, yarn.material.transverse);
    scene.own_laws = yarn.material.transverse.given();
    cloth::YarnType binder = yarn;
    // A section that nothing asks for would be as if it were heard.
    const bool has_binder = scene.generator == "levels" || scene.generator == "stitched";
    const bool bound = file.describes() || file.given("binder", "radius") || file.given("binder", "fibres") ||
                       (has_binder && file.has_section("binder"));
    if (bound && !file.describes() && !scene.generator.empty() && !has_binder)
        file.refuse("binder", file.given("binder", "radius") ? "radius" : "fibres",
                    "left out: only levels and stitched have one");
    if (bound) {
        if (file.describes()) binder.radius = fibrant::core::unset;
        detail::read_type(file, "binder", false, binder);
    }
    file.read("yarn", "element_over_radius", scene.fineness.element_over_radius, example::between(0.1, 100.0), "1",
              "greatest length of an element, over the radius");
    file.read("ends", "kind", ends, {"held", "pulled", "free", "periodic"},
              "how ends of open yarns are: held in place, the last one pulled along itself, free, or images of each other: of "
              "flat_braid, tubular_braid, levels and plied, which then are cells that repeat");
    std::string lengths = "free";
    file.read("ends", "lengths", lengths, {"free", "held"}, "of a cell that repeats: ruled by tension_strain, or as drawn");
    file.read("ends", "tension_strain", tension, example::between(0.0, 0.2), "1",
              "pull at ends that are pulled, over E A of a fibre");
    const bool rest_given = file.read(
        "ends", "straight_at_rest", straight,
        "fibres are straight when nothing acts on them; false: they are at rest as drawn. Left out: as the generator has it");
    cloth::SettleParameters& settle = scene.settle;
    example::read_friction(file, settle.friction_coefficient, "coefficient of friction, once yarns have parted");
    if (example::read_friction_shape(file, settle.friction_shape)) scene.own_laws = true;
    example::read_allowed_penetration(file, settle.allowed_penetration_over_radius,
                                      "how deep a contact may be at the end, over the radius");
    file.read("settle", "gap_limit_over_radius", settle.gap_limit_over_radius, example::above(0.0, 1.0), "1",
              "how far fibres that start in each other part in an increment, over the radius");
    file.read("settle", "tension_increments", settle.tension_increments, example::increments(),
              "increments in which the tension is raised");
    file.read("settle", "separation_increments", settle.separation_increments, example::increments(),
              "most increments until no yarns overlap");
    file.read("settle", "rest_increments", settle.rest_increments, example::increments(),
              "most increments of each stage that waits for rest");
    file.read("settle", "rest_motion_over_radius", settle.rest_motion_over_radius, example::above(0.0, 10.0), "1",
              "yarns are at rest when they move by less than this in an increment, over the radius; or");
    file.read("settle", "rest_share", settle.rest_share, example::above(0.0, 0.01), "1",
              "when damping holds less than this part of the forces");
    file.read("settle", "softness", settle.softness, example::between(1.0, 20.0), "1",
              "penetration allowed on the way, over that at rest");
    file.read("settle", "looseness", settle.looseness, example::looseness(), "1",
              "factor on the tolerances of passes on the way to rest");
    file.read("settle", "damping", settle.damping, example::between(1e-6, 1e6), "1",
              "factor on the damping that follows from tension, bending and the distance of crossings");
    file.check(settle.allowed_penetration_over_radius <= settle.gap_limit_over_radius, "contact",
               "allowed_penetration_over_radius",
               "<= settle.gap_limit_over_radius = " + fibrant::core::text(settle.gap_limit_over_radius));
    example::read_linear_solver(file, scene.linear_solver);
    if (scene.generator.empty() && !file.describes()) {
        for (const std::string& name : generators)  // nobody has asked for its section yet
            if (file.has_section(name))
                throw std::invalid_argument(file.file() + ": textile.generator is missing, but it must be given: \"" + name +
                                            "\", as the file has that section");
        file.complete();
    }
    file.read("output", "surfaces", scene.surfaces, "write the yarns as closed surfaces, and their sections as a table");
    file.read("output", "voxel_spacing", scene.voxel_spacing, example::not_negative(), "length",
              "spacing of the voxels that are written, with an Abaqus mesh and maps of the fibre volume fraction; 0: none");
    detail::read_load(file, scene.load);
    if (!file.describes()) example::check_transverse(file, "yarn", law);  // before a generator looks at the material
    const bool periodic = ends == "periodic";
    // What there is no memory for is refused before it is drawn.
    for (cloth::YarnType* type : {&yarn, &binder}) {
        const double an_element = example::unknowns_of(type->fibres, 1) - example::unknowns_of(type->fibres, 0),
                     elements = example::unknowns_in_room(bytes_an_unknown) / an_element;
        type->longest = std::min(type->longest, elements * scene.fineness.element_over_radius);
    }
    scene.textile = detail::generate(file, scene.generator, yarn, binder, periodic, scene.file_curves);
    if (file.describes()) file.complete();
    detail::check_twist(file, "yarn", yarn);
    if (bound) detail::check_twist(file, "binder", binder);
    file.check(!periodic || !scene.textile.lattice.empty(), "ends", "kind",
               "held, pulled or free: only flat_braid, tubular_braid, levels and plied go on");
    file.check(periodic || !file.given("ends", "lengths"), "ends", "lengths", "left out, unless ends.kind = \"periodic\"");
    if (lengths == "free") scene.textile.free_lengths();
    if (scene.load.wanted)
        file.check(scene.load.cell == periodic && (!periodic || scene.textile.lattice.size() == 2), "loading", "case",
                   periodic ? "\"cell\", of what repeats both ways, as levels do" : "another one, unless ends are periodic");
    example::check_friction_shape(file, settle.friction_shape);
    file.check(ends != "pulled" || tension > 0.0, "ends", "tension_strain", "> 0, where ends are pulled");
    file.check(!periodic || lengths != "held" || tension == 0.0, "ends", "tension_strain", "0, where lengths are held");
    for (cloth::Path& path : scene.textile.paths) {
        path.ends = ends == "held" ? cloth::Ends::held : ends == "pulled" ? cloth::Ends::pulled : cloth::Ends::free;
        path.tension_strain = tension;
        if (rest_given) path.straight = straight;
    }
    double unknowns = 0.0;
    for (Index p = 0; p < fibrant::core::count(scene.textile.paths); ++p) {
        const double length = fibrant::scene::length_of(scene.textile.paths[static_cast<std::size_t>(p)].curve, 128);
        unknowns += example::unknowns_of(
            scene.textile.type_of(p).fibres,
            static_cast<Index>(length / (scene.fineness.element_over_radius * scene.textile.type_of(p).radius)) + 8);
    }
    example::require_room(file, "yarn", "element_over_radius", unknowns, bytes_an_unknown, "more");
    if (!file.given("solver", "linear_solver") && unknowns > large_factor && detail::deep(scene))
        scene.linear_solver.strategy = "automatic";
    cloth::validate(scene.textile);
    if (!scene.textile.crossings.empty() && scene.generator != "weft_knit" && scene.generator != "tricot" &&
        scene.generator != "file")
        cloth::require_holding(scene.textile, scene.generator == "stitched" ? "stitched.sideways: crossings"
                                              : scene.generator == "levels" ? "levels.levels: crossings"
                                                                            : "textile.generator: crossings");
    if (ends == "free") detail::check_free_ends(file, scene);
    return scene;
}

}  // namespace textile

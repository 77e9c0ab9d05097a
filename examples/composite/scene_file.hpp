// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a composite as a TOML file: that of the weave, and what is said of the matrix and the load.

#include "../weave/scene_file.hpp"

#include <fibrant/compositions/composite/composite_parameters.hpp>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <numbers>
#include <string>

namespace composite {

namespace parts = fibrant::compositions::composite;

struct Scene {
    weave::Scene weave;
    parts::MatrixParameters matrix;
    parts::LoadParameters load;
    double overshoot = std::numeric_limits<double>::infinity();  ///< of solver::IterationParameters under load
    bool carried = false;  ///< of solver::SolidPcg: pays where bonds are much stiffer than the sheet is in bending
    std::string settled;   ///< checkpoint of the weave's settled state; empty: settled.bin in the folder of results
};

/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
inline Scene read_scene(example::SceneReader& file) {
    Scene scene;
    parts::MatrixParameters& matrix = scene.matrix;
    parts::LoadParameters& load = scene.load;
    std::string sides = "both", kind = "bending";
    bool clip = true;
    const auto keys = [&] {
        file.require("matrix", "young_modulus", matrix.material.young_modulus, example::positive(), "force/length^2",
                     "Young's modulus of the matrix");
        file.require("matrix", "poisson_ratio", matrix.material.poisson_ratio, example::poisson_ratio(), "1",
                     "Poisson's ratio of the matrix");
        file.require("matrix", "cover", matrix.cover, example::positive(), "length",
                     "thickness of matrix beyond the outermost fibre");
        file.require("matrix", "cells_along", matrix.cells_along, example::between(1, 2000), "cells along the warp");
        matrix.cells_across = matrix.cells_along;
        file.read("matrix", "cells_across", matrix.cells_across, example::between(1, 2000),
                  "cells along the weft; left out: cells_along");
        file.read("matrix", "through", matrix.through, example::between(1, 100), "cells through each layer");
        file.read("matrix", "grading", matrix.grading, example::between(0.01, 100.0), "1",
                  "height of the outermost cell over that of the innermost");
        file.read("matrix", "smoothing", matrix.smoothing, example::between(0, 1000), "smoothing passes over the inner faces");
        file.read("matrix", "penetration_depth_over_radius", matrix.penetration_depth_over_radius, example::between(0.0, 1e3),
                  "1", "how far the inner faces reach below the surface of the fibres, over the radius");
        file.read("matrix", "clearance_over_radius", matrix.clearance_over_radius, example::between(1e-6, 1e3), "1",
                  "least distance of the inner faces, over the radius");
        file.read("matrix", "least_thickness_over_cover", matrix.least_thickness_over_cover, example::between(1e-6, 1.0), "1",
                  "least thickness of a layer, over the cover");
        file.read("matrix", "bonding_factor", matrix.bonding_factor, example::between(1e-9, 1e9), "1",
                  "factor on the stiffness of bonds of centrelines");
        file.read("matrix", "section_factor", matrix.section_factor, example::between(0.0, 1e9), "1",
                  "factor on the stiffness of bonds of sections; 0: none");
        file.read("matrix", "lower_fibres", matrix.lower_fibres,
                  "lower the fibres' modulus by that of the matrix, which fills their place too");
        file.read("matrix", "sides", sides, {"both", "upper", "lower"}, "sides of the fabric on which there is matrix");
        file.read("matrix", "clip", clip, "clip inner faces that would cross; false: refuse the scene");
        file.read("load", "case", kind, {"tension", "shear", "bending", "twisting"},
                  "what the two edges across the warp do to each other");
        file.read("load", "strain", load.strain, example::inside(-0.9, 10.0), "1", "strain in tension, or angle of shear");
        file.read("load", "angle_deg", load.angle_deg, example::between(-180.0, 180.0), "degree",
                  "angle between the edges in bending and twisting");
        file.read("load", "increments", load.increments, example::increments(), "increments of the load");
        file.read("load", "looseness", load.looseness, example::looseness(), "1", "factor on the tolerances of passes");
        file.read("load", "rest_damping", load.rest_damping, example::between(0.0, 1e6), "1",
                  "damping until the fabric is at rest between the layers");
        file.read("load", "rest_share", load.rest_share, example::inside(0.0, 1.0), "1",
                  "part of the forces that damping may hold there");
        file.read("load", "damping", load.damping, example::between(0.0, 1e6), "1", "damping under load");
        file.read("load", "patches_across", load.patches_across, example::between(0, 10000),
                  "patches of a layer's edge face, whose means the edge moves; 0: as many as warp tows");
        file.read("load", "one_by_one", load.one_by_one, "edges move every fibre end; false: the mean of each tow");
        file.read("load", "driven", load.driven, "edges follow rigid motions node by node");
        file.read("load", "settled", scene.settled, example::any_text(),
                  "checkpoint of the weave's settled state; empty: settled.bin in the folder of results");
        file.is_a_place("load", "settled");
        file.read("solver", "overshoot", scene.overshoot, {.low = 0.0, .high = 1e6, .above = true, .endless = true}, "1",
                  "as settle.overshoot, under load");
        file.read("solver", "carried", scene.carried, "the part of the preconditioner in which the matrix takes fibres along");
    };
    file.names({{"MatrixParameters.material.", "matrix."}, {"MatrixParameters.", "matrix."}, {"LoadParameters.", "load."}});
    // What only the settled fabric tells of its layers.
    file.names({{"LayerParameters.penetration_depth", "matrix.penetration_depth_over_radius is too large: the depth"},
                {"LayerParameters.upper_face", "matrix.cover is too small: the upper face"},
                {"LayerParameters.lower_face", "matrix.cover is too small: the lower face"},
                {"LayerParameters.low, high", "matrix.cells_along or matrix.cells_across is too small: the grid of nodes"},
                {"Solid.cells", "matrix: cells"}});
    scene.weave = weave::read_fabric(file, keys);
    matrix.sides = sides == "both"    ? fibrant::solid::Sides::both
                   : sides == "upper" ? fibrant::solid::Sides::upper
                                      : fibrant::solid::Sides::lower;
    matrix.crossing = clip ? fibrant::solid::Crossing::clip : fibrant::solid::Crossing::refuse;
    using parts::LoadCase;
    load.load = kind == "tension"   ? LoadCase::tension
                : kind == "shear"   ? LoadCase::shear
                : kind == "bending" ? LoadCase::bending
                                    : LoadCase::twisting;
    const auto& fabric = scene.weave.fabric;
    for (const char* law : {"material.law", "warp.law", "weft.law"})
        file.check(example::has_own_laws || !scene.weave.transverse() || !file.given(law, "kind"), law, "kind",
                   example::no_own_laws);
    file.check(example::has_own_laws || scene.weave.settle.friction_shape.coulomb(), "contact.friction",
               example::told_shape(file), example::no_own_laws);
    const double stiffest = std::min(fabric.warp.material.young_modulus, fabric.weft.material.young_modulus),
                 thickest = std::max(fabric.warp.fibre_radius, fabric.weft.fibre_radius);
    if (matrix.lower_fibres)
        file.check(matrix.material.young_modulus < stiffest, "matrix", "young_modulus",
                   "< that of the fibres, " + fibrant::core::text(stiffest) + ", which matrix.lower_fibres lowers by it");
    file.check(matrix.cover >= 1e-3 * thickest, "matrix", "cover",
               ">= a thousandth of the radius of a fibre = " + fibrant::core::text(1e-3 * thickest));
    file.check(matrix.cover <= 1e4 * thickest, "matrix", "cover",
               "<= 10000 radii of a fibre = " + fibrant::core::text(1e4 * thickest));
    if (load.load == LoadCase::bending) {
        const double length = fabric.fibre_length(fibrant::compositions::weave::Family::warp),
                     sharpest = length / matrix.cover * 180.0 / std::numbers::pi;
        file.check(std::abs(load.angle_deg) < sharpest, "load", "angle_deg",
                   "less than " + fibrant::core::text(sharpest) +
                       " either way, at which the radius of the arc is matrix.cover = " + fibrant::core::text(matrix.cover));
    }
    if (!scene.settled.empty())
        file.check(std::filesystem::is_regular_file(scene.settled), "load", "settled", "a checkpoint that is there");
    const double solid = 6.0 * static_cast<double>(matrix.cells_along + 1) * static_cast<double>(matrix.cells_across + 1) *
                         static_cast<double>(matrix.through + 1);
    example::require_room(file, "matrix", matrix.cells_along >= matrix.cells_across ? "cells_along" : "cells_across", solid,
                          6000.0);
    matrix.validate();
    load.validate();
    return scene;
}

}  // namespace composite

// SPDX-License-Identifier: MIT
#pragma once
/// @file The scene of a composite as a TOML file: that of the weave, and what is said of the matrix and the load.

#include "../weave/scene_file.hpp"

#include <fibrant/compositions/composite/composite_parameters.hpp>

#include <limits>
#include <string>

namespace composite {

namespace parts = fibrant::compositions::composite;

struct Scene {
    weave::Scene weave;
    parts::MatrixParameters matrix;
    parts::LoadParameters load;
    double overshoot = std::numeric_limits<double>::infinity();  ///< of solver::IterationParameters under load
    bool carried = false;  ///< of solver::SolidPcg: pays where bonds are much stiffer than the sheet is in bending
    std::string settled;  ///< checkpoint of the weave's settled state; empty: settled.bin in the folder of results
};

/// Throws std::invalid_argument, "file: section.key = value, but it must be bound".
inline Scene read_scene(example::TomlReader& file, const std::string& path) {
    Scene scene;
    scene.weave = weave::read_fabric(file, path, false);
    parts::MatrixParameters& matrix = scene.matrix;
    parts::LoadParameters& load = scene.load;
    file.require("matrix", "young_modulus", matrix.material.young_modulus);
    file.require("matrix", "poisson_ratio", matrix.material.poisson_ratio);
    file.require("matrix", "cover", matrix.cover);
    file.require("matrix", "cells_along", matrix.cells_along);
    matrix.cells_across = matrix.cells_along;
    file.read("matrix", "cells_across", matrix.cells_across);
    file.read("matrix", "through", matrix.through);
    file.read("matrix", "grading", matrix.grading);
    file.read("matrix", "smoothing", matrix.smoothing);
    file.read("matrix", "penetration_depth_over_radius", matrix.penetration_depth_over_radius);
    file.read("matrix", "clearance_over_radius", matrix.clearance_over_radius);
    file.read("matrix", "least_thickness_over_cover", matrix.least_thickness_over_cover);
    file.read("matrix", "bonding_factor", matrix.bonding_factor);
    file.read("matrix", "section_factor", matrix.section_factor);
    file.read("matrix", "lower_fibres", matrix.lower_fibres);
    std::string sides = "both", kind = "bending";
    bool clip = true;
    file.read("matrix", "sides", sides, {"both", "upper", "lower"});
    file.read("matrix", "clip", clip);
    matrix.sides = sides == "both" ? fibrant::solid::Sides::both : sides == "upper" ? fibrant::solid::Sides::upper : fibrant::solid::Sides::lower;
    matrix.crossing = clip ? fibrant::solid::Crossing::clip : fibrant::solid::Crossing::refuse;
    file.read("load", "case", kind, {"tension", "shear", "bending", "twisting"});
    using parts::LoadCase;
    load.load = kind == "tension" ? LoadCase::tension : kind == "shear" ? LoadCase::shear : kind == "bending" ? LoadCase::bending : LoadCase::twisting;
    file.read("load", "strain", load.strain);
    file.read("load", "angle_deg", load.angle_deg);
    file.read("load", "increments", load.increments);
    file.read("load", "looseness", load.looseness);
    file.read("load", "rest_damping", load.rest_damping);
    file.read("load", "rest_share", load.rest_share);
    file.read("load", "damping", load.damping);
    file.read("load", "patches_across", load.patches_across);
    file.read("load", "one_by_one", load.one_by_one);
    file.read("load", "driven", load.driven);
    file.read("load", "settled", scene.settled);
    file.read("solver", "overshoot", scene.overshoot);
    file.read("solver", "carried", scene.carried);
    file.refuse_unknown();
    try {
        matrix.validate();
        load.validate();
    } catch (const std::invalid_argument& error) {
        file.rethrow(error, {{"MatrixParameters.material.", "matrix."}, {"MatrixParameters.", "matrix."}, {"LoadParameters.", "load."}});
    }
    return scene;
}

}  // namespace composite

// SPDX-License-Identifier: MIT
#pragma once
/// @file What a composite is made of beside its fabric, and how it is loaded.

#include <fibrant/core/parameters.hpp>
#include <fibrant/solid/layer_mesher.hpp>

#include <string>

namespace fibrant::compositions::composite {

/// The two layers of matrix.
struct MatrixParameters {
    scene::ElasticMaterial material{};
    double cover = core::unset;                  ///< of the outer faces beyond the outermost fibre [length], > 0
    double penetration_depth_over_radius = 1.5;  ///< of the inner faces below the fibres' surface [1], >= 0
    double clearance_over_radius = 0.5;          ///< between the inner faces [1], > 0
    double least_thickness_over_cover = 0.2;     ///< of a layer [1], in (0, 1]
    Index cells_along = 0, cells_across = 0;     ///< along the warp and along the weft, >= 1
    Index through = 2;                           ///< of each layer, >= 1
    double grading = 1.5;                        ///< outermost over innermost cell [1]
    Index smoothing = 1;                         ///< passes over the inner faces
    double bonding_factor = 1.0;                 ///< on the bonds' stiffness [1], > 0
    double section_factor = 0.0;                 ///< on that of bonds of sections [1], >= 0; 0: none
    bool lower_fibres = false;                ///< fibres' Young's modulus is lowered by the matrix's, which fills their place too
    solid::Sides sides = solid::Sides::both;  ///< which of the two layers there are
    solid::Crossing crossing = solid::Crossing::clip;  ///< what to do where the inner faces would cross

    void validate() const {
        const std::string name = "MatrixParameters.";
        core::require_positive(name + "material.young_modulus", material.young_modulus);
        core::require(material.poisson_ratio > -1.0 && material.poisson_ratio < 0.5, name + "material.poisson_ratio",
                      material.poisson_ratio, "> -1 and < 0.5");
        core::require_positive(name + "cover", cover);
        core::require_not_negative(name + "penetration_depth_over_radius", penetration_depth_over_radius);
        core::require_positive(name + "clearance_over_radius", clearance_over_radius);
        core::require(least_thickness_over_cover > 0.0 && least_thickness_over_cover <= 1.0, name + "least_thickness_over_cover",
                      least_thickness_over_cover, "> 0 and <= 1");
        core::require_at_least(name + "cells_along", cells_along, 1);
        core::require_at_least(name + "cells_across", cells_across, 1);
        core::require_at_least(name + "through", through, 1);
        core::require_between(name + "grading", grading, 0.01, 100.0);
        core::require_at_least(name + "smoothing", smoothing, 0);
        core::require_positive(name + "bonding_factor", bonding_factor);
        core::require_not_negative(name + "section_factor", section_factor);
    }
};

/// What the two edges across the warp do to each other; the other two edges are free.
enum class LoadCase {
    tension,   ///< they part
    shear,     ///< one moves along itself
    bending,   ///< they turn against each other about themselves
    twisting,  ///< they turn against each other about the warp
};
struct LoadParameters {
    LoadCase load = LoadCase::bending;  ///< what is done to the composite
    double strain = 0.01;               ///< of tension, or angle of shear [1]
    double angle_deg = 90.0;            ///< between the edges in bending and twisting [degree]
    Index increments = 20;              ///< >= 1
    double looseness =
        5.0;              ///< on the tolerances of passes, as where a fabric comes to rest: paths are a means [1], in [1, 1000]
    bool driven = false;  ///< edges follow rigid motions node by node; else bodies take the means of their parts along
    double rest_damping = 0.4;  ///< of a spring from every node to where it was, until the fabric is at rest between the layers,
                                ///< over the stiffness that the tension of settling gave a node [1], >= 0
    double rest_share = 1e-3;   ///< of the forces that it may hold there [1], in (0, 1)
    double damping = 1e-3;      ///< the same spring under load [1], >= 0
    Index patches_across = 0;   ///< of a layer's face, whose means the bodies take along, >= 0; 0: as many as warp tows. A corner
                                ///< of a face is held the less the more cells a patch has
    bool one_by_one = false;  ///< bodies take along every fibre end, and not the mean of each tow's: between cells that are held
                              ///< finely, ends that only share a mean are pushed out of the face, and crush the cells about them

    void validate() const {
        core::require_finite("LoadParameters.strain", strain);
        core::require_between("LoadParameters.angle_deg", angle_deg, -180.0, 180.0);
        core::require_at_least("LoadParameters.increments", increments, 1);
        core::require_between("LoadParameters.looseness", looseness, 1.0, 1000.0);
        core::require_not_negative("LoadParameters.rest_damping", rest_damping);
        core::require(rest_share > 0.0 && rest_share < 1.0, "LoadParameters.rest_share", rest_share, "> 0 and < 1");
        core::require_not_negative("LoadParameters.damping", damping);
        core::require_at_least("LoadParameters.patches_across", patches_across, 0);
    }
};

}  // namespace fibrant::compositions::composite
